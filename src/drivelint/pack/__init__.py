"""The evidence pack: a result with its rules and data, hashed and signed, so that others can verify it."""

from __future__ import annotations

from drivelint.pack.request import MOST_FINDINGS, PackRequest, Verification, VerifyRequest
from drivelint.pack.verify import verify
from drivelint.pack.write import ready, write_pack

__all__ = ["MOST_FINDINGS", "PackRequest", "Verification", "VerifyRequest", "ready", "verify", "write_pack"]
