"""What stands in a pack: its form, its statement, and SQL that gives each finding's numbers in a DuckDB without drivelint."""

from __future__ import annotations

import base64
import hashlib
import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow.parquet as pq
import pytest
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ec

from drivelint import cli
from drivelint.errors import UsageError
from drivelint.pack import PackRequest, VerifyRequest, signature, verify, write_pack
from drivelint.pack.finding_sql import param_literal
from tests.explain.overtake_check import OVERTAKE, check
from tests.pack.packed import make_key, make_pack, numbers_without_drivelint, statement_of

if TYPE_CHECKING:
    from tests.pack.conftest import Packed


def files(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def by_all_rules(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a pack with a finding of many rules of all kinds."""
    out = tmp_path_factory.mktemp("all")
    collision = str(OVERTAKE / "collision.csv")
    asked: dict[str, Any] = {"rules": ("all",), "params": (), "profiles": ("nominal", "observed")}
    check(out / "result", traces=(collision,), robustness=False, **asked)  # the session's packs have copies
    return make_pack(out / "result", out / "pack")


@pytest.mark.ci
def test_any_duckdb_gives_the_numbers_of_every_finding(by_all_rules: Path) -> None:
    findings = pq.read_table(by_all_rules / "data/result/findings.parquet").to_pylist()
    assert len({row["rule_id"] for row in findings}) >= 10
    assert {row["kind"] for row in findings} >= {"invariant", "execution"}
    told = numbers_without_drivelint(by_all_rules)
    assert sorted(told) == sorted(row["finding_id"] for row in findings)
    for row in findings:
        (found,) = told[row["finding_id"]]
        assert found["holds"] is False
        assert found["t_ns"] == row["t_worst_ns"]
        # to the last bit: JSON gives a float back as it was
        assert [found[key] for key in ("observed", "required", "margin")] == [
            row[key] for key in ("observed", "required", "margin")
        ], row["rule_id"]


@pytest.mark.ci
def test_the_rows_are_few_and_decide(by_all_rules: Path, tmp_path: Path) -> None:
    """A contact is judged by one row of one pair; with another number in that row, the SQL gives another margin."""
    findings = pq.read_table(by_all_rules / "data/result/findings.parquet").to_pylist()
    row = next(row for row in findings if row["rule_id"] == "ukhc.no-collision")
    folder = tmp_path / "findings" / row["finding_id"]
    shutil.copytree(by_all_rules / "data/findings" / row["finding_id"], folder)
    pair = pq.read_table(folder / "pair.parquet")
    assert pair.to_pylist()[0]["t_ns"] == row["t_worst_ns"]
    assert pair.num_rows == 1
    assert pair.schema.field("t_ns").metadata[b"comment"]
    every = {path.stem: pq.read_metadata(path).num_rows for path in (by_all_rules / "data/findings").rglob("*.parquet")}
    assert max(every.values()) < 400


def test_a_number_is_written_with_its_type() -> None:
    import duckdb

    for value in (0.1, 3.0, 1e-7, 1e300, -2.5, 7, True, "it's"):
        (found,) = (
            duckdb.connect()
            .execute(f"SELECT typeof(v), v = ?, v FROM (SELECT {param_literal(value)} AS v)", [value])
            .fetchall()
        )
        assert found[1]
        assert (found[0] == "DOUBLE") == isinstance(value, float)
        assert type(found[2]) is type(value)


@pytest.mark.slow
def test_a_check_packs_its_evidence_in_one_go(packed: Packed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The exit code stays that of the check."""
    command = [
        "check",
        OVERTAKE / "collision.csv",
        "--map",
        OVERTAKE / "road.xodr",
        "--mapping",
        OVERTAKE / "mapping.toml",
    ]
    command += [
        "--rules",
        "ukhc.no-collision",
        "--no-robustness",
        "--no-annotate",
        "--out",
        tmp_path / "result",
        "--evidence",
        tmp_path / "pack",
        "--sign",
        packed.key,
        "--quiet",
    ]
    monkeypatch.setattr("sys.argv", ["drivelint", *map(str, command)])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert ended.value.code == 1
    found = verify(VerifyRequest(tmp_path / "pack", packed.public))
    assert not found.problems
    assert files(tmp_path / "pack") == files(make_pack(tmp_path / "result", tmp_path / "again", packed.key))


@pytest.mark.ci
def test_sha256sum_finds_nothing_wrong(packed: Packed) -> None:
    for manifest in ("manifest-sha256.txt", "tagmanifest-sha256.txt"):
        done = subprocess.run(["sha256sum", "--strict", "--quiet", "-c", manifest], cwd=packed.pack, check=False)
        assert done.returncode == 0
    names = {line[66:] for m in packed.pack.glob("*manifest-*.txt") for line in m.read_text("utf-8").splitlines()}
    assert names == files(packed.pack).keys() - {"tagmanifest-sha256.txt"}
    payload = [path for path in (packed.pack / "data").rglob("*") if path.is_file()]
    info = (packed.pack / "bag-info.txt").read_text("utf-8")
    assert f"Payload-Oxum: {sum(path.stat().st_size for path in payload)}.{len(payload)}\n" in info
    assert "Bagging-Date" not in info
    assert info.startswith("External-Description: A result of drivelint"), "for somebody who has only the pack"
    (command,) = re.findall(r"\? (sha256sum .*)", info)
    assert subprocess.run([*shlex.split(command), "--quiet"], cwd=packed.pack, check=False).returncode == 0
    assert "drivelint verify PACK --key KEY" in info
    assert "No check shows that the log itself is true." in info


@pytest.mark.ci
def test_the_statement_says_what_the_tables_say(packed: Packed) -> None:
    told = statement_of(packed.pack)
    assert told["_type"] == "https://in-toto.io/Statement/v1"
    assert told["predicateType"] == "https://in-toto.io/attestation/test-result/v0.1"
    digest = hashlib.sha256((OVERTAKE / "collision.csv").read_bytes()).hexdigest()
    assert told["subject"] == [{"name": "collision.csv", "digest": {"sha256": digest}}]
    predicate = told["predicate"]
    verdicts = pq.read_table(packed.result / "verdicts.parquet").to_pylist()
    failed = {(row["rule_id"], row["profile"]) for row in verdicts if row["verdict"] == "fail"}
    assert {(name.split()[0], ([*name.split()[3:], None])[0]) for name in predicate["failedTests"]} == failed
    assert predicate["result"] == "FAILED"
    unknown = {row["rule_id"] for row in verdicts if row["verdict"] == "unknown"}
    named = {name.split()[0] for key in ("passedTests", "warnedTests") for name in predicate[key]}
    assert unknown
    assert {name.split()[0] for name in predicate["drivelint_undecidedTests"]} >= unknown - {rule for rule, _ in failed}
    assert not unknown & named
    hashes = {each["name"]: each.get("digest", {}).get("sha256") for each in predicate["configuration"]}
    assert hashes["map road.xodr"] == hashlib.sha256((OVERTAKE / "road.xodr").read_bytes()).hexdigest()
    check = next(each for each in predicate["configuration"] if each["name"] == "check")["annotations"]
    assert check["parameters"]["ukhc.contact-signature.within_m"] == "0.4"
    assert check["profiles"] == ["relaxed", "nominal"]


@pytest.mark.ci
def test_openssl_finds_the_signature_good(packed: Packed, tmp_path: Path) -> None:
    envelope = json.loads((packed.pack / "statement.dsse.json").read_bytes())
    kind, payload = envelope["payloadType"], base64.b64decode(envelope["payload"])
    (tmp_path / "signed").write_bytes(f"DSSEv1 {len(kind)} {kind} {len(payload)} ".encode() + payload)
    (tmp_path / "sig").write_bytes(base64.b64decode(envelope["signatures"][0]["sig"]))
    command = [
        "openssl",
        "pkeyutl",
        "-verify",
        "-pubin",
        "-inkey",
        str(packed.public),
        "-rawin",
        "-in",
        "signed",
        "-sigfile",
        "sig",
    ]
    try:
        done = subprocess.run(command, cwd=tmp_path, check=False, capture_output=True, text=True)
    except FileNotFoundError:
        pytest.skip("openssl is not installed")
    assert "Signature Verified Successfully" in done.stdout, done.stderr


@pytest.mark.ci
def test_the_same_command_gives_the_same_bytes(packed: Packed, tmp_path: Path) -> None:
    again = make_pack(packed.result, tmp_path / "again", packed.key, with_inputs=True)
    assert files(again) == files(packed.pack)


def run_cli(monkeypatch: pytest.MonkeyPatch, *words: object) -> int:
    monkeypatch.setattr(sys, "argv", ["drivelint", *map(str, words)])
    with pytest.raises(SystemExit) as end:
        cli.main()
    return int(end.value.code or 0)


@pytest.mark.ci
def test_commands(
    packed: Packed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1764115200")
    out = tmp_path / "pack"
    assert run_cli(monkeypatch, "pack", packed.result, "--out", out) == 0
    assert capsys.readouterr().out.startswith(f"{out}: not signed; ")
    assert "Bagging-Date: 2025-11-26\n" in (out / "bag-info.txt").read_text("utf-8")
    assert run_cli(monkeypatch, "verify", out) == 0
    told = capsys.readouterr()
    assert told.out.startswith(f"{out}: consistent: ")
    assert "not signed, dated 2025-11-26, not judged again" in told.out
    assert len(told.out.splitlines()) == 1
    assert "--trace" in told.err
    assert run_cli(monkeypatch, "verify", out, "--key", packed.public) == 1
    assert capsys.readouterr().out == "not signed: statement.dsse.json\n"
    assert run_cli(monkeypatch, "pack", packed.result, "--out", out) == 2
    assert "--overwrite" in capsys.readouterr().err
    assert run_cli(monkeypatch, "pack", packed.result, "--out", out, "--overwrite", "--date", "26.11.") == 2


@pytest.mark.ci
def test_incident_sheets_that_stay_out_are_named(
    packed: Packed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    told = {
        "findings": [],
        "incidents": ["data/incidents/d.html"],
        "left_out": ["annotated/d.mcap", "incidents/abc.html"],
    }
    monkeypatch.setattr("drivelint.pack.write_pack", lambda _request: told)
    assert run_cli(monkeypatch, "pack", packed.result, "--out", tmp_path / "pack") == 0
    (first, line) = capsys.readouterr().out.splitlines()
    assert first.endswith("; 1 incident sheet")
    assert line.startswith("  left out of the pack (sheets of findings that the result does not contain")
    assert "PDFs whose page is missing or would be written differently now" in line
    assert line.endswith(": incidents/abc.html")


@pytest.mark.slow
def test_logs_that_were_moved_are_known_by_their_hash(packed: Packed, tmp_path: Path) -> None:
    pack = make_pack(packed.result, tmp_path / "pack", packed.key)
    moved = Path(shutil.copy(OVERTAKE / "collision.csv", tmp_path / "elsewhere.csv"))
    road = Path(shutil.copy(OVERTAKE / "road.xodr", tmp_path / "road.xodr"))
    other = OVERTAKE / "safe.csv"
    with pytest.raises(UsageError, match="another log"):
        verify(VerifyRequest(pack, packed.public, (other,), road))
    with pytest.raises(UsageError, match="another map"):
        verify(VerifyRequest(pack, packed.public, (OVERTAKE / "collision.csv",), other))
    named = moved.rename(tmp_path / "collision.csv")
    found = verify(VerifyRequest(pack, packed.public, (named,), road))
    assert found.problems == []
    assert "judged again: the same bytes" in found.sentence


@pytest.mark.ci
def test_an_out_folder_of_somebody_is_left_alone(packed: Packed, tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(UsageError, match="no evidence pack"):
        write_pack(PackRequest(packed.result, tmp_path, overwrite=True))
    assert (tmp_path / "thesis.txt").read_text("utf-8") == "mine"


@pytest.mark.ci
def test_a_result_that_was_changed_since_is_not_packed(packed: Packed, tmp_path: Path) -> None:
    """Its log is another one now."""
    for name in ("collision.csv", "road.xodr", "mapping.toml"):
        shutil.copy(OVERTAKE / name, tmp_path)
    check(
        tmp_path / "result",
        traces=(str(tmp_path / "collision.csv"),),
        map=tmp_path / "road.xodr",
        mapping=str(tmp_path / "mapping.toml"),
        robustness=False,
    )
    with (tmp_path / "collision.csv").open("a", encoding="utf-8") as file:
        file.write("\n")
    with pytest.raises(UsageError, match="another log than the one that was judged"):
        make_pack(tmp_path / "result", tmp_path / "pack")
    assert not (tmp_path / "pack").exists()
    assert not list(tmp_path.glob(".drivelint.*"))


def test_keys_that_cannot_sign_are_refused(tmp_path: Path) -> None:
    curve = ec.generate_private_key(ec.SECP256R1())
    secret = serialization.BestAvailableEncryption(b"x")
    private, public = make_key(tmp_path, "ours")
    pem, pkcs8 = serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8
    (tmp_path / "curve.pem").write_bytes(curve.private_bytes(pem, pkcs8, serialization.NoEncryption()))
    (tmp_path / "locked.pem").write_bytes(signature.private_key(private).private_bytes(pem, pkcs8, secret))
    for name, words in (("curve.pem", "no Ed25519 key"), ("locked.pem", "password"), ("absent.pem", "cannot be read")):
        with pytest.raises(UsageError, match=words):
            signature.private_key(tmp_path / name)
    with pytest.raises(UsageError, match="no private key"):
        signature.private_key(public)
    with pytest.raises(UsageError, match="no public key"):
        signature.public_key(private)


def test_keys_of_openssh_are_read(tmp_path: Path) -> None:
    private, public = make_key(tmp_path, "ours")
    key = signature.private_key(private)
    (tmp_path / "id").write_bytes(
        key.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.OpenSSH, serialization.NoEncryption())
    )
    (tmp_path / "id.pub").write_bytes(
        key.public_key().public_bytes(serialization.Encoding.OpenSSH, serialization.PublicFormat.OpenSSH)
    )
    envelope = signature.signed_envelope(b"{}", signature.private_key(tmp_path / "id"))
    assert signature.is_signed_by(envelope, signature.public_key(tmp_path / "id.pub"))
    assert signature.is_signed_by(envelope, signature.public_key(public))
