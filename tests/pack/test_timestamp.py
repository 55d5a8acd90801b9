"""Time stamps of packs: an authority made on the spot stamps, and openssl agrees with `verify`."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest

from drivelint.errors import UsageError
from drivelint.pack import VerifyRequest, timestamp, verify
from tests.pack.packed import make_pack, rehash, script

if TYPE_CHECKING:
    from tests.pack.conftest import Packed

pytestmark = pytest.mark.ci

CONFIG = """
[req]
distinguished_name = name
prompt = no
[name]
CN = {name}
[root]
basicConstraints = critical, CA:true
keyUsage = critical, keyCertSign
[stamper]
basicConstraints = critical, CA:false
keyUsage = critical, digitalSignature
extendedKeyUsage = critical, timeStamping
[tsa]
default_tsa = test
[test]
serial = {folder}/serial
signer_cert = {folder}/stamper.pem
signer_key = {folder}/stamper.key
certs = {folder}/chain.pem
signer_digest = sha256
default_policy = 1.2.3.4
digests = sha1, sha256, sha512
"""
CURVE = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes")


class Authority:
    """A root certificate, and a certificate of it that may stamp."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir()
        self.root, self.config = folder / "root.pem", folder / "config"
        self.config.write_text(CONFIG.format(name=folder.name, folder=folder), encoding="utf-8")
        (folder / "serial").write_text("01\n", encoding="utf-8")
        config = ("-config", self.config)
        openssl(
            "req", "-x509", *CURVE, *config, "-extensions", "root", "-keyout", folder / "root.key", "-out", self.root
        )
        key, request, stamper = (folder / f"stamper.{end}" for end in ("key", "csr", "pem"))
        openssl("req", "-new", *CURVE, *config, "-keyout", key, "-out", request)
        by_root = ("-CA", self.root, "-CAkey", folder / "root.key", "-CAcreateserial")
        extensions = ("-extfile", self.config, "-extensions", "stamper")
        openssl("x509", "-req", "-in", request, *by_root, *extensions, "-out", stamper)
        self.send(self.root)

    def send(self, *certificates: Path) -> None:
        """Send these along with the stamper's."""
        content = b"".join(path.read_bytes() for path in certificates)
        self.root.with_name("chain.pem").write_bytes(content)

    def stamp(self, data: Path, out: Path, digest: str = "sha256") -> Path:
        query = out.with_suffix(".tsq")
        openssl("ts", "-query", "-data", data, f"-{digest}", "-cert", "-out", query)
        openssl("ts", "-reply", "-config", self.config, "-queryfile", query, "-out", out)
        return out


def openssl(*words: object) -> None:
    done = subprocess.run(["openssl", *map(str, words)], check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


class Stamped(NamedTuple):
    """A signed pack without a time stamp, one with, and who stamped."""

    bare: Path
    pack: Path
    authority: Authority
    other_authority: Authority


@pytest.fixture(scope="module")
def stamped(packed: Packed, tmp_path_factory: pytest.TempPathFactory) -> Stamped:
    pytest.importorskip("rfc3161_client", reason="rfc3161-client is not installed (the extra timestamp)")
    if shutil.which("openssl") is None:
        pytest.skip("openssl is not installed")
    folder = tmp_path_factory.mktemp("stamped")
    authority, other = Authority(folder / "authority"), Authority(folder / "other")
    bare = make_pack(packed.result, folder / "bare", packed.key)
    response = authority.stamp(bare / "statement.dsse.json", folder / "response.tsr")
    pack = make_pack(packed.result, folder / "pack", packed.key, timestamp=response)
    return Stamped(bare, pack, authority, other)


@pytest.mark.slow
def test_a_stamp_is_verified_as_openssl_does(stamped: Stamped, packed: Packed, tmp_path: Path) -> None:
    found = verify(VerifyRequest(stamped.pack, packed.public, timestamp_root=stamped.authority.root))
    assert found.problems == []
    assert ", existed by 20" in found.sentence
    statement, response = stamped.pack / "statement.dsse.json", stamped.pack / timestamp.TIMESTAMP_FILE
    openssl("ts", "-verify", "-data", statement, "-in", response, "-CAfile", stamped.authority.root)
    without = verify(VerifyRequest(stamped.pack, packed.public))
    assert without.problems == []
    assert "only --timestamp-root identifies its authority" in without.sentence
    done = script(stamped.pack, packed.public, tmp_path)
    assert (done.returncode, done.stdout) == (0, "untouched since it was signed\n"), done.stderr
    # nothing else differs from the pack without it but the hashes of the tag files
    names = {path.relative_to(stamped.pack) for path in stamped.pack.rglob("*") if path.is_file()}
    differing = {
        name.as_posix()
        for name in names
        if not (stamped.bare / name).is_file()
        or (stamped.bare / name).read_bytes() != (stamped.pack / name).read_bytes()
    }
    assert differing == {timestamp.TIMESTAMP_FILE, "tagmanifest-sha256.txt"}


def test_another_authority_is_not_trusted(stamped: Stamped, packed: Packed) -> None:
    (found,) = verify(VerifyRequest(stamped.pack, packed.public, timestamp_root=stamped.other_authority.root)).problems
    assert found.kind == "time stamp of an authority that is not trusted"


def test_the_order_in_which_an_authority_sends_its_certificates_does_not_matter(
    stamped: Stamped, tmp_path: Path
) -> None:
    """One of the two is not the order of DER; openssl sends them as they are listed."""
    statement = stamped.pack / "statement.dsse.json"
    roots = [stamped.authority.root, stamped.other_authority.root]
    for no, order in enumerate((roots, roots[::-1])):
        stamped.authority.send(*order)
        content = stamped.authority.stamp(statement, tmp_path / f"{no}.tsr").read_bytes()
        looked = timestamp.check_response(content, statement.read_bytes(), stamped.authority.root)
        assert looked.problems == []
    stamped.authority.send(roots[0])


def test_a_pack_without_a_stamp_where_one_is_asked_for(stamped: Stamped, packed: Packed) -> None:
    (found,) = verify(VerifyRequest(stamped.bare, packed.public, timestamp_root=stamped.authority.root)).problems
    assert found == ("no time stamp", timestamp.TIMESTAMP_FILE)


@pytest.mark.parametrize("roots", [True, False])
@pytest.mark.parametrize("digest", ["sha256", "sha1"])
def test_a_stamp_of_something_else(digest: str, roots: bool, stamped: Stamped, packed: Packed, tmp_path: Path) -> None:
    """Of another pack, though by the same authority; or of this one by a hash that is broken."""
    pack = tmp_path / "pack"
    shutil.copytree(stamped.bare, pack)
    data = packed.other_pack if digest == "sha256" else pack
    stamped.authority.stamp(data / "statement.dsse.json", pack / timestamp.TIMESTAMP_FILE, digest)
    (pack / timestamp.TIMESTAMP_FILE).with_suffix(".tsq").unlink()
    rehash(pack, payload=False)
    root = stamped.authority.root if roots else None
    found = verify(VerifyRequest(pack, packed.public, timestamp_root=root)).problems
    assert found == [("time stamp of another statement", timestamp.TIMESTAMP_FILE)]


def change_all(content: bytes, by: int = 13) -> list[bytes]:
    """Return the bytes with one bit changed, at every thirteenth byte."""
    changed = []
    for i in range(0, len(content), by):
        other = bytearray(content)
        other[i] ^= 1
        changed.append(bytes(other))
    return changed


def test_no_changed_byte_of_a_stamp_gives_another_time(stamped: Stamped) -> None:
    """Most are refused; a certificate that is sent along and not needed is read by nobody. One that is cut or goes on is refused."""
    envelope = (stamped.pack / "statement.dsse.json").read_bytes()
    content = (stamped.pack / timestamp.TIMESTAMP_FILE).read_bytes()
    right = timestamp.check_response(content, envelope, stamped.authority.root)
    assert right.problems == []
    found = [timestamp.check_response(other, envelope, stamped.authority.root) for other in change_all(content)]
    assert {each.description for each in found if not each.problems} <= {right.description}
    assert sum(1 for each in found if each.problems) > len(found) / 2
    for other in (content[:-1], content[: len(content) // 2], b"", content + b"\0"):
        assert timestamp.check_response(other, envelope, stamped.authority.root).problems != []


@pytest.mark.slow
def test_what_is_no_stamp_of_the_pack_is_not_packed(stamped: Stamped, packed: Packed, tmp_path: Path) -> None:
    other = stamped.authority.stamp(packed.other_pack / "statement.dsse.json", tmp_path / "other.tsr")
    (tmp_path / "text.tsr").write_text("yesterday", encoding="utf-8")
    for path, words in (
        (other, "time stamp of another statement"),
        (tmp_path / "text.tsr", "time stamp not readable"),
        (tmp_path / "absent.tsr", "cannot be read"),
    ):
        with pytest.raises(UsageError, match=words):
            make_pack(packed.result, tmp_path / "pack", packed.key, timestamp=path)
    with pytest.raises(UsageError, match="--sign"):
        make_pack(packed.result, tmp_path / "pack", timestamp=other)
    assert not (tmp_path / "pack").exists()
    with pytest.raises(UsageError, match="no certificates"):
        verify(VerifyRequest(stamped.pack, packed.public, timestamp_root=packed.public))


@pytest.mark.slow
def test_without_the_package_a_stamp_is_not_looked_at(
    packed: Packed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It never counts as verified."""
    monkeypatch.setitem(sys.modules, "rfc3161_client", None)
    pack = make_pack(packed.result, tmp_path / "pack", packed.key)
    (pack / timestamp.TIMESTAMP_FILE).write_bytes(b"whatever")
    rehash(pack, payload=False)
    found = verify(VerifyRequest(pack, packed.public))
    assert "with a time stamp that was not examined" in found.sentence
    assert "pip install 'drivelint[timestamp]'" in found.notes[0]
    with pytest.raises(UsageError, match="rfc3161-client"):
        verify(VerifyRequest(pack, packed.public, timestamp_root=packed.public))
    with pytest.raises(UsageError, match="rfc3161-client"):
        timestamp.read_response(pack / timestamp.TIMESTAMP_FILE, b"")


@pytest.mark.slow
def test_a_stamp_of_an_unsigned_pack_is_a_file_that_was_added(packed: Packed, tmp_path: Path) -> None:
    pack = make_pack(packed.result, tmp_path / "pack")
    (pack / timestamp.TIMESTAMP_FILE).write_bytes(b"whatever")
    rehash(pack, payload=False)
    assert verify(VerifyRequest(pack)).problems == [("file added", timestamp.TIMESTAMP_FILE)]
