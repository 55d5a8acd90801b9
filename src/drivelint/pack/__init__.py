"""The evidence pack: a result with its rules and data, hashed and signed, so that others can verify it."""

from __future__ import annotations

from drivelint.pack.request import DEFAULT_PACKED_FINDINGS, PackRequest, Verification, VerifyRequest
from drivelint.pack.verify import verify
from drivelint.pack.write import signing_key_of_valid_request, write_pack

__all__ = [
    "DEFAULT_PACKED_FINDINGS",
    "PackRequest",
    "Verification",
    "VerifyRequest",
    "signing_key_of_valid_request",
    "verify",
    "write_pack",
]
