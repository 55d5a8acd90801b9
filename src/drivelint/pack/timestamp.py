"""The time stamp of a pack (RFC 3161): an authority states that the signed statement existed at a time.

Another program requests the token. No signature of the pack covers it, because it is made after the signature.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Final, NamedTuple

from cryptography import x509

from drivelint.errors import UsageError
from drivelint.pack.bag import Problem
from drivelint.pack.statement import ENVELOPE_FILE

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

TIMESTAMP_FILE: Final = f"{ENVELOPE_FILE}.tsr"
_HASH_BY_ALGORITHM_ID: Final = {
    "2.16.840.1.101.3.4.2.1": hashlib.sha256,
    "2.16.840.1.101.3.4.2.2": hashlib.sha384,
    "2.16.840.1.101.3.4.2.3": hashlib.sha512,
}
"""Object identifier of an algorithm -> hash function. Algorithms with known collisions are not accepted."""


class StampCheckResult(NamedTuple):
    """The result of checking a time stamp: its problems, a phrase about its time and authority, and notes on what was not checked."""

    problems: list[Problem]
    description: str = ""
    notes: list[str] = []  # noqa: RUF012 - never modified


def read_response(path: Path, envelope: bytes) -> bytes:
    """Return the time stamp response in a file. Errors: `UsageError` if the file is not a response, or not for this envelope."""
    try:
        content = path.read_bytes()
        outcome = check_response(content, envelope, None)
    except OSError as error:
        raise UsageError(f"--timestamp {path}: cannot be read: {error.strerror or error}") from error
    except ModuleNotFoundError as error:
        raise UsageError(_missing_package_text("--timestamp")) from error
    if outcome.problems:
        raise UsageError(
            f"--timestamp {path}: {outcome.problems[0].kind}: pack without it, and let it be made of {ENVELOPE_FILE} in that pack"
        )
    return content


def check_pack_timestamp(folder: Path, roots_file: Path | None) -> StampCheckResult:
    """Check the time stamp of a pack. `roots_file`: certificates (PEM) of trusted authorities; None: no authority is required.

    Errors: `UsageError` for certificates that cannot be read, or if certificates are given and rfc3161-client is not installed.
    """
    if not (folder / TIMESTAMP_FILE).is_file() or not (folder / ENVELOPE_FILE).is_file():
        return StampCheckResult([] if roots_file is None else [Problem("no time stamp", TIMESTAMP_FILE)])
    try:
        return check_response((folder / TIMESTAMP_FILE).read_bytes(), (folder / ENVELOPE_FILE).read_bytes(), roots_file)
    except ModuleNotFoundError as error:
        if roots_file is not None:
            raise UsageError(_missing_package_text("--timestamp-root")) from error
        return StampCheckResult(
            [], "with a time stamp that was not examined", [_missing_package_text("its time stamp")]
        )


def check_response(content: bytes, envelope: bytes, roots_file: Path | None) -> StampCheckResult:
    """Check that the response of an authority is for this envelope. Errors: `UsageError`, `ModuleNotFoundError`."""
    from rfc3161_client import VerificationError, VerifierBuilder, decode_timestamp_response

    try:
        response = decode_timestamp_response(_response_with_certificates_in_der_order(content))
        info = response.tst_info
        imprint, time = info.message_imprint, info.gen_time
    except (ValueError, IndexError, TypeError, AttributeError):
        return StampCheckResult([Problem("time stamp not readable", TIMESTAMP_FILE)])
    hashed = _HASH_BY_ALGORITHM_ID.get(imprint.hash_algorithm.dotted_string)
    if hashed is None or hashed(envelope).digest() != imprint.message:
        return StampCheckResult([Problem("time stamp of another statement", TIMESTAMP_FILE)])
    time_text = f"{time:%Y-%m-%dT%H:%M:%SZ}"
    if roots_file is None:
        return StampCheckResult(
            [], f"with a time stamp of {time_text} (only --timestamp-root identifies its authority)"
        )
    builder = VerifierBuilder(roots=_read_certificates(roots_file))
    try:
        builder.build().verify(response, imprint.message)
    except (VerificationError, ValueError) as error:
        return StampCheckResult(
            [Problem("time stamp of an authority that is not trusted", f"{TIMESTAMP_FILE}: {error}")]
        )
    return StampCheckResult([], f"existed by {time_text}, as a trusted authority states")


def _response_with_certificates_in_der_order(content: bytes) -> bytes:
    """Return a response with its certificates in DER order, which rfc3161-client requires and some authorities do not keep.

    No signature covers that order.
    """
    start, end = 0, len(content)
    # the path of nested elements: response, token, content, signed data, certificates
    for index, due_tag in ((0, 0x30), (1, 0x30), (1, 0xA0), (0, 0x30), (3, 0xA0)):
        tag, _, start, end = list(_der_elements(content, start, end))[index]
        if tag != due_tag:
            return content
    certificates = sorted(content[first:last] for _, first, _, last in _der_elements(content, start, end))
    return content[:start] + b"".join(certificates) + content[end:]


def _der_elements(content: bytes, start: int, end: int) -> Iterator[tuple[int, int, int, int]]:
    """Yield (tag, start, start of content, end of content) for each DER element between two byte positions."""
    while start < end:
        n, body = content[start + 1], start + 2
        if n & 0x80:
            width = n & 0x7F
            n, body = int.from_bytes(content[body : body + width], "big"), body + width
        yield content[start], start, body, body + n
        start = body + n


def _read_certificates(path: Path) -> list[x509.Certificate]:
    try:
        return x509.load_pem_x509_certificates(path.read_bytes())
    except (OSError, ValueError) as error:
        raise UsageError(f"--timestamp-root {path}: no certificates in PEM: {error}") from error


def _missing_package_text(subject: str) -> str:
    return f"{subject}: time stamps need the package rfc3161-client: pip install 'drivelint[timestamp]'"
