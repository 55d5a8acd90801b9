"""Signs with an Ed25519 key in `ssh-agent`. The private key never leaves the agent.

https://datatracker.ietf.org/doc/html/draft-ietf-sshm-ssh-agent
"""

from __future__ import annotations

import os
import socket
import struct
from typing import TYPE_CHECKING, Final

from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives.serialization import Encoding, PublicFormat

from drivelint.errors import UsageError
from drivelint.phrases import plural

if TYPE_CHECKING:
    from collections.abc import Iterator

    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

_IDENTITIES, _IDENTITIES_ANSWER, _SIGN, _SIGN_ANSWER = 11, 12, 13, 14
_KEY_TYPE: Final = b"ssh-ed25519"
_LONGEST_MESSAGE_BYTES: Final = 1 << 18  # OpenSSH's limit for the length of a message
_AGENT_TIMEOUT_S: Final = 300.0
"""Timeout of the agent in seconds: an agent may ask the user to confirm (ssh-add -c)."""


class AgentKey:
    """A key in the agent at `SSH_AUTH_SOCK`. It has the same methods for signing as `Ed25519PrivateKey`."""

    def __init__(self, public: Ed25519PublicKey) -> None:
        """Find the key in the agent. Errors: `UsageError` if there is no agent, or the agent does not have the key."""
        self._public = public
        self._blob = _with_length_prefix(_KEY_TYPE) + _with_length_prefix(
            public.public_bytes(Encoding.Raw, PublicFormat.Raw)
        )
        answer = _ask_agent(bytes([_IDENTITIES]), _IDENTITIES_ANSWER)
        try:
            blobs = list(_strings_in_message(answer[4:]))[::2]  # each key is followed by its comment
        except ValueError as error:
            raise UsageError("--sign: the list of keys from ssh-agent is cut off") from error
        if self._blob not in blobs:
            raise UsageError(
                f"--sign: ssh-agent has {plural(len(blobs), 'key')}, and not this one: add it with ssh-add"
            )

    def public_key(self) -> Ed25519PublicKey:
        """Return the public key."""
        return self._public

    def sign(self, content: bytes) -> bytes:
        """Return the signature of 64 bytes. Errors: `UsageError` if the agent refuses, or its answer is not a signature by this key."""
        request = bytes([_SIGN]) + _with_length_prefix(self._blob) + _with_length_prefix(content) + struct.pack(">I", 0)
        try:
            (whole,) = _strings_in_message(_ask_agent(request, _SIGN_ANSWER))
            kind, signature = _strings_in_message(whole)
            self._public.verify(signature, content)
        except (ValueError, InvalidSignature) as error:
            raise UsageError("--sign: the answer of ssh-agent is not an Ed25519 signature by this key") from error
        if kind != _KEY_TYPE:
            raise UsageError(
                f"--sign: ssh-agent returned a signature of another kind ({kind.decode('ascii', 'replace')})"
            )
        return signature


def _ask_agent(request: bytes, answer_type: int) -> bytes:
    """Send a message to the agent, and return the answer without its type byte. Errors: `UsageError`."""
    path = os.environ.get("SSH_AUTH_SOCK")
    if not path or not hasattr(socket, "AF_UNIX"):
        raise UsageError(
            "--sign: a public key signs by ssh-agent, but SSH_AUTH_SOCK names no agent: use the private key"
        )
    try:
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as agent:
            agent.settimeout(_AGENT_TIMEOUT_S)
            agent.connect(path)
            agent.sendall(_with_length_prefix(request))
            (length,) = struct.unpack(">I", _receive_bytes(agent, 4))
            if not 0 < length <= _LONGEST_MESSAGE_BYTES:
                raise UsageError(f"--sign: {path} does not answer like ssh-agent")
            answer = _receive_bytes(agent, length)
    except OSError as error:
        raise UsageError(f"--sign: ssh-agent at {path} cannot be reached: {error.strerror or error}") from error
    if answer[0] != answer_type:
        raise UsageError("--sign: ssh-agent refused: it is locked, or the use was not confirmed")
    return answer[1:]


def _receive_bytes(agent: socket.socket, n_bytes: int) -> bytes:
    content = b""
    while len(content) < n_bytes:
        part = agent.recv(n_bytes - len(content))
        if not part:
            raise OSError("it closed the connection before the end of its answer")
        content += part
    return content


def _with_length_prefix(content: bytes) -> bytes:
    """Return bytes with their length in front, as in the protocol."""
    return struct.pack(">I", len(content)) + content


def _strings_in_message(content: bytes) -> Iterator[bytes]:
    """Yield the byte strings of a message, without their lengths. Errors: `ValueError` if the message is cut off."""
    while content:
        n = int.from_bytes(content[:4], "big")
        if len(content) < 4 + n:
            raise ValueError("cut")
        yield content[4 : 4 + n]
        content = content[4 + n :]
