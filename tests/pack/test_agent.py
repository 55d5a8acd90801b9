"""Signing by ssh-agent: a real one, and sockets that do not answer as one does."""

from __future__ import annotations

import base64
import json
import os
import shutil
import signal
import socket
import struct
import subprocess
import threading
from typing import TYPE_CHECKING

import pytest
from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ec

from drivelint.errors import UsageError
from drivelint.pack import VerifyRequest, signature, verify
from tests.pack.packed import make_key, make_pack, statement_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.pack.conftest import Packed

OPENSSH = serialization.Encoding.OpenSSH, serialization.PublicFormat.OpenSSH


@pytest.fixture
def agent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Start an agent of our own that holds no keys."""
    if shutil.which("ssh-agent") is None or shutil.which("ssh-add") is None:
        pytest.skip("ssh-agent and ssh-add (openssh-client) are not installed")
    place = tmp_path / "agent"
    with subprocess.Popen(["ssh-agent", "-D", "-a", place], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert str(place) in process.stdout.readline()
        monkeypatch.setenv("SSH_AUTH_SOCK", str(place))
        yield
        process.send_signal(signal.SIGTERM)


def add(folder: Path, name: str, *words: str) -> Path:
    """Give a key to the agent and remove its file; return the public key, as OpenSSH writes it."""
    private, public = make_key(folder, name)
    key = signature.private_key(private)
    file, line = folder / name, folder / f"{name}.pub"
    no_password = serialization.NoEncryption()
    file.write_bytes(key.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.OpenSSH, no_password))
    file.chmod(0o600)
    line.write_bytes(key.public_key().public_bytes(*OPENSSH) + b" a comment\n")
    subprocess.run(["ssh-add", "-q", *words, file], check=True)
    file.unlink()
    private.unlink()
    assert public.is_file()
    return line


@pytest.mark.slow
@pytest.mark.usefixtures("agent")
def test_an_agent_signs_as_the_key_itself_does(packed: Packed, tmp_path: Path) -> None:
    """Ed25519 has no random part: the pack is the same, byte by byte. The signature is of the PAE, and openssl is content with it."""
    add(tmp_path, "another")
    line = add(tmp_path, "ours")
    pack = make_pack(packed.result, tmp_path / "pack", line, with_inputs=True)
    for path in packed.pack.rglob("*"):
        if path.is_file():
            assert (pack / path.relative_to(packed.pack)).read_bytes() == path.read_bytes()
    envelope = json.loads((pack / "statement.dsse.json").read_bytes())
    payload, kind = base64.b64decode(envelope["payload"]), envelope["payloadType"]
    pae = f"DSSEv1 {len(kind)} {kind} {len(payload)} ".encode() + payload
    public = signature.public_key(packed.public)
    public.verify(base64.b64decode(envelope["signatures"][0]["sig"]), pae)
    with pytest.raises(InvalidSignature):
        public.verify(base64.b64decode(envelope["signatures"][0]["sig"]), payload)
    assert statement_of(pack)["predicate"]["result"] == "FAILED"
    unjudged = make_pack(packed.result, tmp_path / "unjudged", line)
    for key in (packed.public, line):
        found = verify(VerifyRequest(unjudged, key))
        assert found.problems == []
        assert "signed by the key that was given" in found.sentence
    assert verify(VerifyRequest(unjudged, packed.other_public)).problems[0].kind == "another key"


@pytest.mark.usefixtures("agent")
def test_a_public_key_in_pem_names_the_same_key(tmp_path: Path) -> None:
    add(tmp_path, "ours")
    key = signature.signing_key(tmp_path / "ours.pub.pem")
    assert signature.is_signed_by(signature.signed_envelope(b"{}", key), key.public_key())


@pytest.mark.usefixtures("agent")
def test_a_key_that_the_agent_does_not_hold_is_refused(tmp_path: Path) -> None:
    add(tmp_path, "theirs")
    _, public = make_key(tmp_path, "ours")
    with pytest.raises(UsageError, match=r"ssh-agent has 1 key, and not this one: add it with ssh-add"):
        signature.signing_key(public)
    curve = ec.generate_private_key(ec.SECP256R1()).public_key()
    (tmp_path / "curve.pub").write_bytes(curve.public_bytes(*OPENSSH))
    with pytest.raises(UsageError, match=r"no public key|no Ed25519 key"):
        signature.signing_key(tmp_path / "curve.pub")


@pytest.mark.usefixtures("agent")
def test_an_agent_where_nobody_confirms_is_said_to_refuse(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A key added with -c is used only after a person agreed, and nobody is there to ask."""
    key = signature.signing_key(add(tmp_path, "ours", "-c"))
    with pytest.raises(UsageError, match="refused"):
        key.sign(b"content")


def test_without_an_agent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _, public = make_key(tmp_path, "ours")
    monkeypatch.delenv("SSH_AUTH_SOCK", raising=False)
    with pytest.raises(UsageError, match="SSH_AUTH_SOCK names no agent"):
        signature.signing_key(public)
    monkeypatch.setenv("SSH_AUTH_SOCK", str(tmp_path / "nothing"))
    with pytest.raises(UsageError, match="cannot be reached"):
        signature.signing_key(public)


def answering(path: str, *answers: bytes) -> threading.Thread:
    """Answer one connection after the other with these bytes."""
    server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    server.bind(path)
    server.listen()

    def serve() -> None:
        with server:
            for answer in answers:
                peer, _ = server.accept()
                with peer:
                    peer.recv(1 << 16)
                    peer.sendall(answer)

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    return thread


def message(kind: int, *strings: bytes, head: bytes = b"") -> bytes:
    body = bytes([kind]) + head + b"".join(struct.pack(">I", len(each)) + each for each in strings)
    return struct.pack(">I", len(body)) + body


def test_what_is_no_signature_of_the_key_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    private, public = make_key(tmp_path, "ours")
    key = signature.private_key(private)
    raw = key.public_key().public_bytes(serialization.Encoding.Raw, serialization.PublicFormat.Raw)
    blob = message(0, b"ssh-ed25519", raw)[5:]
    holds = message(12, blob, b"comment", head=struct.pack(">I", 1))
    wrong = message(14, message(0, b"ssh-ed25519", key.sign(b"something else"))[5:])
    cut, huge = message(14, b"\0\0\0\x0bssh"), struct.pack(">I", 1 << 30)
    for no, (answer, words) in enumerate([
        (wrong, "not an Ed25519 signature"), (cut, "not an Ed25519 signature"), (huge, "does not answer"), (b"\0\0", "before the end")
    ]):  # fmt: skip
        path = os.path.join(tmp_path, str(no))  # noqa: PTH118 - a socket's address is text
        thread = answering(path, holds, answer)
        monkeypatch.setenv("SSH_AUTH_SOCK", path)
        with pytest.raises(UsageError, match=words):
            signature.signing_key(public).sign(b"content")
        thread.join(10)
    thread = answering(str(tmp_path / "list"), message(12, head=b"\0\0\0\x01\0\0\0\xff"))
    monkeypatch.setenv("SSH_AUTH_SOCK", str(tmp_path / "list"))
    with pytest.raises(UsageError, match="is cut"):
        signature.signing_key(public)
    thread.join(10)
