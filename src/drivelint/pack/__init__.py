"""The evidence pack: a result that others can check, with what it rests on, hashed and signed."""

from __future__ import annotations

from drivelint.pack.verify import Verification, VerifyRequest, verify
from drivelint.pack.write import PackRequest, write_pack

__all__ = ["PackRequest", "Verification", "VerifyRequest", "verify", "write_pack"]
