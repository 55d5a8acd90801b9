"""A result and its pack, and what somebody who tampers with a pack does."""

from __future__ import annotations

import base64
import hashlib
import json
from typing import TYPE_CHECKING, Any

from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

from drivelint.pack import PackRequest, write_pack

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

STATEMENT, KEY = "statement.dsse.json", "public-key.pem"
MANIFEST, TAG_MANIFEST = "manifest-sha256.txt", "tagmanifest-sha256.txt"


def make_key(folder: Path, name: str) -> tuple[Path, Path]:
    """Write a private and a public key, always the same for a name."""
    key = Ed25519PrivateKey.from_private_bytes(hashlib.sha256(name.encode()).digest())
    plain = serialization.NoEncryption()
    private, public = folder / f"{name}.pem", folder / f"{name}.pub.pem"
    private.write_bytes(key.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, plain))
    public.write_bytes(
        key.public_key().public_bytes(serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo)
    )
    return private, public


def make_pack(result: Path, out: Path, key: Path | None = None, **options: Any) -> Path:
    write_pack(PackRequest(result, out, key, **options))
    return out


def rehash(pack: Path, *, payload: bool = True) -> None:
    """Write the manifests anew, with hashlib alone."""
    for manifest in (MANIFEST, TAG_MANIFEST)[not payload :]:
        files = [path for path in sorted(pack.rglob("*")) if path.is_file()]
        names = [path.relative_to(pack).as_posix() for path in files]
        wanted = [n for n in names if n.startswith("data/") == (manifest == MANIFEST) and n != TAG_MANIFEST]
        lines = [f"{hashlib.sha256((pack / name).read_bytes()).hexdigest()}  {name}\n" for name in wanted]
        (pack / manifest).write_text("".join(lines), encoding="utf-8")


def statement_of(pack: Path) -> dict[str, Any]:
    envelope = json.loads((pack / STATEMENT).read_bytes())
    told: dict[str, Any] = json.loads(base64.b64decode(envelope["payload"]))
    return told


def restate(pack: Path, change: Callable[[dict[str, Any]], None], key: Path | None = None) -> None:
    """Change the statement, sign it with a key (None: the old signature stays) and hash the tag files anew."""
    envelope = json.loads((pack / STATEMENT).read_bytes())
    told = statement_of(pack)
    change(told)
    payload = (json.dumps(told, indent=2, ensure_ascii=False) + "\n").encode()
    envelope["payload"] = base64.b64encode(payload).decode()
    if key is not None:
        private = serialization.load_pem_private_key(key.read_bytes(), None)
        assert isinstance(private, Ed25519PrivateKey)
        kind = envelope["payloadType"].encode()
        signature = private.sign(b" ".join([b"DSSEv1", b"%d" % len(kind), kind, b"%d" % len(payload), payload]))
        envelope["signatures"][0]["sig"] = base64.b64encode(signature).decode()
        (pack / KEY).write_bytes(
            private.public_key().public_bytes(
                serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo
            )
        )
    (pack / STATEMENT).write_text(json.dumps(envelope), encoding="utf-8")
    rehash(pack, payload=False)


def reseal(pack: Path, key: Path, change: Callable[[dict[str, Any]], None] = lambda _told: None) -> None:
    """Hash and sign a changed pack anew, as whoever has the key can."""
    rehash(pack)

    def sealed(told: dict[str, Any]) -> None:
        for each in told["predicate"]["drivelint_pack"]:
            each["digest"]["sha256"] = hashlib.sha256((pack / each["name"]).read_bytes()).hexdigest()
        change(told)

    restate(pack, sealed, key)
