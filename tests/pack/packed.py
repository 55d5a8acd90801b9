"""A result and its pack, and what somebody who tampers with a pack does."""

from __future__ import annotations

import base64
import hashlib
import json
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING, Any, TypeVar

import pyarrow as pa
import pyarrow.parquet as pq
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

from drivelint.guide import FOLDER
from drivelint.pack import PackRequest, write_pack
from drivelint.pack.contents import packed_summary
from drivelint.pack.signature import key_id, private_key, signed_envelope
from drivelint.pack.statement import in_toto_statement
from drivelint.report import summary
from drivelint.report.outputs import REPORT_FORMATS
from drivelint.result.load import load_result
from tests.guide.blocks import blocks

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.pack.conftest import Packed

    Tamper = Callable[[Path, Packed], tuple[str, str]]
    """Changes a pack; returns the kind of problem that is found, and what is named."""

F = TypeVar("F", bound="Callable[..., tuple[str, str]]")
STATEMENT, KEY, INFO = "statement.dsse.json", "public-key.pem", "bag-info.txt"
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
    """Write the manifests anew, with hashlib alone, and with `payload` its size and number of files."""
    if payload:
        sizes = [path.stat().st_size for path in (pack / "data").rglob("*") if path.is_file()]
        info = (pack / INFO).read_text("utf-8").partition("Payload-Oxum")[0]
        (pack / INFO).write_text(f"{info}Payload-Oxum: {sum(sizes)}.{len(sizes)}\n", encoding="utf-8")
    for manifest in (MANIFEST, TAG_MANIFEST)[not payload :]:
        files = [path for path in sorted(pack.rglob("*")) if path.is_file()]
        names = [path.relative_to(pack).as_posix() for path in files]
        wanted = [n for n in names if n.startswith("data/") == (manifest == MANIFEST) and n != TAG_MANIFEST]
        lines = [f"{hashlib.sha256((pack / name).read_bytes()).hexdigest()}  {name}\n" for name in wanted]
        (pack / manifest).write_text("".join(lines), encoding="utf-8")


def rewrite_reports(pack: Path) -> None:
    """Let the summary, the reports and the hashes in `evidence.json` say what the changed tables say."""
    folder = pack / "data/result"
    result = load_result(folder)
    (folder / "summary.json").write_bytes(summary.render(result))
    for name, render in REPORT_FORMATS.values():
        if (folder / name).is_file():
            (folder / name).write_bytes(render(result))
    change_evidence(pack, lambda _evidence: None)


def change_evidence(pack: Path, change: Callable[[dict[str, Any]], None]) -> None:
    """Change what `evidence.json` says, after its hashes of the outputs are right."""
    file = pack / "data/evidence.json"
    evidence = json.loads(file.read_text("utf-8"))
    evidence["outputs"] = {name: hashlib.sha256((pack / name).read_bytes()).hexdigest() for name in evidence["outputs"]}
    change(evidence)
    file.write_text(json.dumps(evidence, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def statement_of(pack: Path) -> dict[str, Any]:
    sealed = json.loads((pack / STATEMENT).read_bytes())
    statement: dict[str, Any] = json.loads(base64.b64decode(sealed["payload"]))
    return statement


def restate(pack: Path, change: Callable[[dict[str, Any]], None], key: Path | None = None) -> None:
    """Change the statement, sign it with a key (None: the old signature stays) and hash the tag files anew."""
    sealed = json.loads((pack / STATEMENT).read_bytes())
    statement = statement_of(pack)
    change(statement)
    payload = (json.dumps(statement, indent=2, ensure_ascii=False) + "\n").encode()
    sealed["payload"] = base64.b64encode(payload).decode()
    if key is not None:
        private = serialization.load_pem_private_key(key.read_bytes(), None)
        assert isinstance(private, Ed25519PrivateKey)
        kind = sealed["payloadType"].encode()
        signature = private.sign(b" ".join([b"DSSEv1", b"%d" % len(kind), kind, b"%d" % len(payload), payload]))
        public = private.public_key()
        sealed["signatures"][0] = {"keyid": key_id(public), "sig": base64.b64encode(signature).decode()}
        (pack / KEY).write_bytes(
            public.public_bytes(serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo)
        )
    (pack / STATEMENT).write_text(json.dumps(sealed, indent=2) + "\n", encoding="utf-8")
    rehash(pack, payload=False)


def sign_anew(pack: Path, key: Path) -> None:
    """Let everything follow from the changed tables, rules and `evidence.json`, and sign it: what the owner of a key can forge."""
    rehash(pack)
    evidence = json.loads((pack / "data/evidence.json").read_text("utf-8"))
    statement = in_toto_statement(pack, load_result(pack / "data/result"), packed_summary(pack), evidence)
    (pack / STATEMENT).write_bytes(signed_envelope(statement, private_key(key)))
    rehash(pack, payload=False)


def reseal(pack: Path, key: Path, change: Callable[[dict[str, Any]], None] = lambda _told: None) -> None:
    """Hash and sign a changed pack anew, as whoever has the key can."""
    rehash(pack)

    def hash_and_change(statement: dict[str, Any]) -> None:
        for each in statement["predicate"]["drivelint_pack"]:
            each["digest"]["sha256"] = hashlib.sha256((pack / each["name"]).read_bytes()).hexdigest()
        change(statement)

    restate(pack, hash_and_change, key)


def change_byte(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def log_of(pack: Path) -> Path:
    (path,) = (pack / "data/inputs/traces").rglob("*.csv")
    return path


def inner(pack: Path, path: Path) -> str:
    return path.relative_to(pack).as_posix()


def sql_of(pack: Path) -> Path:
    return min((pack / "data/findings").rglob("finding.sql"))


def copied(packed: Packed, tmp_path: Path) -> Path:
    return tmp_path / shutil.copytree(packed.pack, tmp_path / "pack").name


def script(pack: Path, key: Path, tmp_path: Path) -> subprocess.CompletedProcess[str]:
    """Run the script of the guide with nothing of drivelint on its path."""
    (block,) = (each for each in blocks(FOLDER / "evidence-pack.md") if each.mark == "file: verify_pack.py")
    file = tmp_path / "verify_pack.py"
    file.write_text(f"import sys\nsys.modules['drivelint'] = None\n{block.body}", encoding="utf-8")
    return subprocess.run(
        [sys.executable, "-I", file, pack, key], check=False, capture_output=True, text=True, timeout=60
    )


def rows_of(pack: Path) -> Path:
    """Return the rows of a contact: one row of one pair."""
    return min((pack / "data/findings").rglob("pair.parquet"))


def change_table(path: Path, column: str, change: Callable[[Any], Any]) -> None:
    """Change the values of a column, and keep its type and comment."""
    table = pq.read_table(path)
    i = table.column_names.index(column)
    field = table.schema.field(i)
    values = pa.array([change(value) for value in table[column].to_pylist()], field.type)
    pq.write_table(table.set_column(i, field, values), path, compression="zstd")


def to_pass(verdict: str) -> str:
    return "pass" if verdict == "fail" else verdict


def change_numbers(path: Path) -> None:
    """Change every number of a table that is a measured one."""
    for field in pq.read_schema(path):
        if pa.types.is_floating(field.type):
            change_table(path, field.name, lambda value: None if value is None else 1.5 * value + 0.1)


def into(table: dict[str, F]) -> Callable[[F], F]:
    def add(function: F) -> F:
        table[function.__name__] = function
        return function

    return add


WITHOUT_DRIVELINT = """
import sys
sys.modules["drivelint"] = None
import json, os
import duckdb
found = {}
for name in sorted(os.listdir(sys.argv[1])):
    os.chdir(os.path.join(sys.argv[1], name))
    with duckdb.connect() as con:
        rows = con.execute(open("finding.sql").read()).fetchall()
        columns = [column[0] for column in con.description]
    found[name] = [dict(zip(columns, row)) for row in rows]
print(json.dumps(found))
"""


def numbers_without_drivelint(pack: Path, inner: str = "data/findings") -> dict[str, list[dict[str, Any]]]:
    done = subprocess.run(
        [sys.executable, "-I", "-c", WITHOUT_DRIVELINT, pack / inner],
        check=False, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    numbers: dict[str, list[dict[str, Any]]] = json.loads(done.stdout)
    return numbers
