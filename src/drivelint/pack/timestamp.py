"""The time stamp of a pack (RFC 3161): an authority states that the signed statement existed at a time.

Another program requests the token. No signature of the pack covers it, because it is made after the signature.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Final, NamedTuple

from cryptography import x509

from drivelint.errors import UsageError
from drivelint.pack.bag import Problem
from drivelint.pack.statement import ENVELOPE

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

FILE: Final = f"{ENVELOPE}.tsr"
_HASHES: Final = {
    "2.16.840.1.101.3.4.2.1": hashlib.sha256,
    "2.16.840.1.101.3.4.2.2": hashlib.sha384,
    "2.16.840.1.101.3.4.2.3": hashlib.sha512,
}
"""Object identifier of an algorithm -> hash function. Algorithms with known collisions are not accepted."""


class StampCheck(NamedTuple):
    """The result of checking a time stamp: its problems, a phrase about its time and authority, and notes on what was not checked."""

    problems: list[Problem]
    description: str = ""
    notes: list[str] = []  # noqa: RUF012 - never modified


def read(path: Path, envelope: bytes) -> bytes:
    """Return the time stamp response in a file. Errors: `UsageError` if the file is not a response, or not for this envelope."""
    try:
        content = path.read_bytes()
        found = look(content, envelope, None)
    except OSError as error:
        raise UsageError(f"--timestamp {path}: cannot be read: {error.strerror or error}") from error
    except ModuleNotFoundError as error:
        raise UsageError(_missing_package_text("--timestamp")) from error
    if found.problems:
        raise UsageError(
            f"--timestamp {path}: {found.problems[0].kind}: pack without it, and let it be made of {ENVELOPE} in that pack"
        )
    return content


def of_pack(folder: Path, roots: Path | None) -> StampCheck:
    """Check the time stamp of a pack. `roots`: certificates (PEM) of trusted authorities; None: no authority is required.

    Errors: `UsageError` for certificates that cannot be read, or if certificates are given and rfc3161-client is not installed.
    """
    if not (folder / FILE).is_file() or not (folder / ENVELOPE).is_file():
        return StampCheck([] if roots is None else [Problem("no time stamp", FILE)])
    try:
        return look((folder / FILE).read_bytes(), (folder / ENVELOPE).read_bytes(), roots)
    except ModuleNotFoundError as error:
        if roots is not None:
            raise UsageError(_missing_package_text("--timestamp-root")) from error
        return StampCheck([], "with a time stamp that was not examined", [_missing_package_text("its time stamp")])


def look(content: bytes, envelope: bytes, roots: Path | None) -> StampCheck:
    """Check that the response of an authority is for this envelope. Errors: `UsageError`, `ModuleNotFoundError`."""
    from rfc3161_client import VerificationError, VerifierBuilder, decode_timestamp_response

    try:
        response = decode_timestamp_response(_in_order(content))
        told = response.tst_info
        imprint, time = told.message_imprint, told.gen_time
    except (ValueError, IndexError, TypeError, AttributeError):
        return StampCheck([Problem("time stamp not readable", FILE)])
    hashed = _HASHES.get(imprint.hash_algorithm.dotted_string)
    if hashed is None or hashed(envelope).digest() != imprint.message:
        return StampCheck([Problem("time stamp of another statement", FILE)])
    shown = f"{time:%Y-%m-%dT%H:%M:%SZ}"
    if roots is None:
        return StampCheck([], f"with a time stamp of {shown} (only --timestamp-root identifies its authority)")
    builder = VerifierBuilder(roots=_certificates(roots))
    try:
        builder.build().verify(response, imprint.message)
    except (VerificationError, ValueError) as error:
        return StampCheck([Problem("time stamp of an authority that is not trusted", f"{FILE}: {error}")])
    return StampCheck([], f"existed by {shown}, as a trusted authority states")


def _in_order(content: bytes) -> bytes:
    """Return a response with its certificates in DER order, which rfc3161-client requires and some authorities do not keep.

    No signature covers that order.
    """
    start, end = 0, len(content)
    # the path of nested elements: response, token, content, signed data, certificates
    for index, wanted in ((0, 0x30), (1, 0x30), (1, 0xA0), (0, 0x30), (3, 0xA0)):
        tag, _, start, end = list(_elements(content, start, end))[index]
        if tag != wanted:
            return content
    certificates = sorted(content[first:last] for _, first, _, last in _elements(content, start, end))
    return content[:start] + b"".join(certificates) + content[end:]


def _elements(content: bytes, start: int, end: int) -> Iterator[tuple[int, int, int, int]]:
    """Yield (tag, start, start of content, end of content) for each DER element between two byte positions."""
    while start < end:
        n, body = content[start + 1], start + 2
        if n & 0x80:
            width = n & 0x7F
            n, body = int.from_bytes(content[body : body + width], "big"), body + width
        yield content[start], start, body, body + n
        start = body + n


def _certificates(path: Path) -> list[x509.Certificate]:
    try:
        return x509.load_pem_x509_certificates(path.read_bytes())
    except (OSError, ValueError) as error:
        raise UsageError(f"--timestamp-root {path}: no certificates in PEM: {error}") from error


def _missing_package_text(subject: str) -> str:
    return f"{subject}: time stamps need the package rfc3161-client: pip install 'drivelint[timestamp]'"
