"""Signs a statement with Ed25519 in a DSSE envelope, and checks such a signature."""

from __future__ import annotations

import base64
import binascii
import hashlib
import json
from typing import TYPE_CHECKING, Final, Protocol

from cryptography.exceptions import InvalidSignature, UnsupportedAlgorithm
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey

from drivelint.errors import UsageError
from drivelint.pack.agent import AgentKey

if TYPE_CHECKING:
    from pathlib import Path

PAYLOAD_TYPE: Final = "application/vnd.in-toto+json"
_OPENSSH_PRIVATE_START: Final = b"-----BEGIN OPENSSH PRIVATE KEY-----"
_OPENSSH_PUBLIC_STARTS: Final = (b"ssh-", b"ecdsa-", b"sk-")
_PUBLIC_KEY_STARTS: Final = (*_OPENSSH_PUBLIC_STARTS, b"-----BEGIN PUBLIC KEY-----")


class EnvelopeError(Exception):
    """A file in the place of an envelope is not an envelope."""


class SigningKey(Protocol):
    """A signing key: a private key from a file, or one in ssh-agent."""

    def public_key(self) -> Ed25519PublicKey:
        """Return the public key."""

    def sign(self, data: bytes, /) -> bytes:
        """Return the signature."""


def signing_key(path: Path) -> SigningKey:
    """Return the private key in a file; if the file has a public key, return the matching key in ssh-agent. Errors: `UsageError`."""
    return AgentKey(public_key(path)) if _read_key_file(path).startswith(_PUBLIC_KEY_STARTS) else private_key(path)


def private_key(path: Path) -> Ed25519PrivateKey:
    """Return the private key in a PEM file (PKCS 8 or OpenSSH format). Errors: `UsageError`."""
    content = _read_key_file(path)
    load = (
        serialization.load_ssh_private_key
        if content.startswith(_OPENSSH_PRIVATE_START)
        else serialization.load_pem_private_key
    )
    try:
        key = load(content, password=None)
    except TypeError as error:
        raise UsageError(f"{path}: has a password, which drivelint cannot enter: use a key without one") from error
    except (ValueError, UnsupportedAlgorithm) as error:
        raise UsageError(f"{path}: no private key in PEM: openssl genpkey -algorithm ed25519 makes one") from error
    if not isinstance(key, Ed25519PrivateKey):
        raise UsageError(f"{path}: no Ed25519 key: openssl genpkey -algorithm ed25519 makes one")
    return key


def public_key(path: Path) -> Ed25519PublicKey:
    """Return the public key in a file, in PEM or as a line in OpenSSH format. Errors: `UsageError`."""
    content = _read_key_file(path)
    load = (
        serialization.load_ssh_public_key
        if content.startswith(_OPENSSH_PUBLIC_STARTS)
        else serialization.load_pem_public_key
    )
    try:
        key = load(content)
    except (ValueError, UnsupportedAlgorithm) as error:
        raise UsageError(f"{path}: no public key: openssl pkey -in KEY -pubout writes it") from error
    if not isinstance(key, Ed25519PublicKey):
        raise UsageError(f"{path}: no Ed25519 key")
    return key


def _read_key_file(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror or error}") from error


def public_key_pem(key: Ed25519PublicKey) -> bytes:
    """Return a public key as PEM."""
    return key.public_bytes(serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo)


def key_id(key: Ed25519PublicKey) -> str:
    """Return the hash that identifies a key: SHA-256 of its DER form, hexadecimal."""
    der = key.public_bytes(serialization.Encoding.DER, serialization.PublicFormat.SubjectPublicKeyInfo)
    return hashlib.sha256(der).hexdigest()


def signed_envelope(payload: bytes, key: SigningKey) -> bytes:
    """Return the DSSE envelope of a signed statement. The bytes are always the same, because Ed25519 is deterministic."""
    return _envelope_json(payload, key.sign(_bytes_to_sign(PAYLOAD_TYPE, payload)), key.public_key())


def _envelope_json(payload: bytes, signature: bytes, key: Ed25519PublicKey) -> bytes:
    content = {
        "payloadType": PAYLOAD_TYPE,
        "payload": base64.b64encode(payload).decode(),
        "signatures": [{"keyid": key_id(key), "sig": base64.b64encode(signature).decode()}],
    }
    return (json.dumps(content, indent=2) + "\n").encode()


def payload_of_envelope(envelope_bytes: bytes) -> bytes:
    """Return the payload of an envelope without checking its signature. Errors: `EnvelopeError`."""
    return _parse_envelope(envelope_bytes)[1]


def is_signed_by(envelope_bytes: bytes, key: Ed25519PublicKey) -> bool:
    """Return whether an envelope has a valid signature by a key. Errors: `EnvelopeError`."""
    kind, payload, signatures = _parse_envelope(envelope_bytes)
    for signature in signatures:
        try:
            key.verify(signature, _bytes_to_sign(kind, payload))
        except InvalidSignature:
            continue
        return kind == PAYLOAD_TYPE
    return False


def is_canonical_envelope(envelope_bytes: bytes, key: Ed25519PublicKey) -> bool:
    """Return whether a signed envelope has exactly the text that `signed_envelope` writes: the signature covers only the payload."""
    _, payload, signatures = _parse_envelope(envelope_bytes)
    return len(signatures) == 1 and envelope_bytes == _envelope_json(payload, signatures[0], key)


def _parse_envelope(envelope_bytes: bytes) -> tuple[str, bytes, list[bytes]]:
    try:
        envelope = json.loads(envelope_bytes)
        payload = base64.b64decode(envelope["payload"], validate=True)
        signatures = [base64.b64decode(entry["sig"], validate=True) for entry in envelope["signatures"]]
        return str(envelope["payloadType"]), payload, signatures
    except (ValueError, KeyError, TypeError, RecursionError, binascii.Error) as error:
        raise EnvelopeError(str(error)) from error


def _bytes_to_sign(kind: str, payload: bytes) -> bytes:
    """Return the bytes that DSSE signs: the type and the payload with their lengths, so that the two cannot be confused."""
    return b"DSSEv1 %d %s %d %s" % (len(kind.encode()), kind.encode(), len(payload), payload)
