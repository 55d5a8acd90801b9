"""The pack of an audit: a statement about every drive, SQL of the worst findings, and whatever is changed in it is named."""

from __future__ import annotations

import contextlib
import hashlib
import json
import shutil
from typing import TYPE_CHECKING, Any

import duckdb
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint import cli
from drivelint.audit import parts
from drivelint.audit.store import LocalFolder
from drivelint.errors import UsageError
from drivelint.pack import VerifyRequest, verify
from drivelint.result.names import MANIFEST
from tests.pack import audited
from tests.pack.audited import (
    AUDIT,
    CONTACT,
    LOSSY,
    LOSSY_CONTACT,
    N_DRIVES,
    QUARANTINED,
    REFUSED,
    PackedAudit,
    table_of,
)
from tests.pack.packed import (
    STATEMENT,
    change_byte,
    change_evidence,
    change_table,
    into,
    make_pack,
    numbers_without_drivelint,
    rehash,
    reseal,
    script,
    statement_of,
    to_pass,
)

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Tamper = Callable[[Path, PackedAudit], tuple[str, str]]
    """Changes a pack; returns the kind of problem that is found, and what is named."""

pytestmark = pytest.mark.ci


@pytest.fixture(scope="module")
def packed(tmp_path_factory: pytest.TempPathFactory) -> PackedAudit:
    return audited.write_audit(tmp_path_factory.mktemp("audited"))


@pytest.fixture(scope="module")
def without_logs(packed: PackedAudit, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_pack(packed.audit, tmp_path_factory.mktemp("without") / "pack", packed.key)


def copied(packed: PackedAudit, tmp_path: Path) -> Path:
    return tmp_path / shutil.copytree(packed.pack, tmp_path / "pack").name


def evidence_of(pack: Path) -> dict[str, Any]:
    evidence: dict[str, Any] = json.loads((pack / "data/evidence.json").read_text("utf-8"))
    return evidence


def rows_of(pack: Path, table: str) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = pq.read_table(table_of(pack, table)).to_pylist()
    return rows


@pytest.mark.slow
def test_the_statement_names_every_drive_and_what_became_of_it(packed: PackedAudit) -> None:
    predicate = statement_of(packed.pack)["predicate"]
    drives = {drive["log"]: drive for drive in predicate["drivelint_drives"]}
    logs = {path.name: path for path in (packed.drives.manifest.parent / "logs").iterdir()}
    road = hashlib.sha256(packed.drives.road.read_bytes()).hexdigest()
    assert drives.keys() == logs.keys()
    for name, drive in drives.items():
        digest = hashlib.sha256(logs[name].read_bytes()).hexdigest()
        status = {REFUSED: "refused", QUARANTINED: "quarantined"}.get(name, "judged")
        hashes = {"judged": (digest, road), "refused": (digest, None), "quarantined": (None, None)}
        expected = (*hashes[status], status)
        assert (drive["log_sha256"], drive["map_sha256"], drive["status"]) == expected
        assert drive["lossy"] == (name in {LOSSY, LOSSY_CONTACT})
        assert (drive["n_fail"] > 0) == (name in packed.drives.planted)
    assert "not parquet" in drives[REFUSED]["reason"]
    assert "the worker died" in drives[QUARANTINED]["reason"]
    subjects = {each["name"]: each["digest"]["sha256"] for each in statement_of(packed.pack)["subject"]}
    assert subjects == {name: drive["log_sha256"] for name, drive in drives.items() if drive["status"] == "judged"}
    audit = next(each for each in predicate["configuration"] if each["name"] == "audit")["annotations"]
    assert audit["versions"]["duckdb"] == duckdb.__version__


def test_what_was_not_judged_whole_has_passed_nothing(packed: PackedAudit) -> None:
    predicate = statement_of(packed.pack)["predicate"]
    names = {drive["log"]: f"{drive['drive_id']} {drive['key']}" for drive in predicate["drivelint_drives"]}
    assert predicate["failedTests"] == sorted(names[name] for name in (CONTACT, LOSSY_CONTACT))
    assert predicate["drivelint_undecidedTests"] == sorted(names[name] for name in (LOSSY, REFUSED, QUARANTINED))
    assert len(predicate["passedTests"]) == N_DRIVES - 5
    assert (predicate["result"], predicate["drivelint_exit"]) == ("FAILED", {"code": 1, "fail_on": "critical"})
    told = [(row["log"].rpartition("/")[2], row["status"]) for row in evidence_of(packed.pack)["not_judged"]]
    assert told == [(REFUSED, "refused"), (QUARANTINED, "quarantined")]


def test_any_duckdb_gives_the_margin_of_each_finding(packed: PackedAudit) -> None:
    findings = {row["finding_id"]: row for row in rows_of(packed.pack, "findings")}
    told = evidence_of(packed.pack)["findings"]
    assert [row["finding_id"] for row in told] == sorted(findings, key=lambda name: findings[name]["margin"])
    for row in told:
        ((name, (numbers,)),) = numbers_without_drivelint(packed.pack, f"data/findings/{row['key']}").items()
        assert name == row["finding_id"]
        for key in ("observed", "required", "margin"):
            assert numbers[key] == findings[name][key] == row[key]
        assert not numbers["holds"]


@pytest.mark.slow
def test_an_untouched_pack_is_said_to_be_so_in_one_line(
    packed: PackedAudit, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        cli_main("verify", str(packed.pack), "--key", str(packed.public))
    assert ended.value.code == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert "untouched since it was signed" in line
    assert (
        f"2 of {N_DRIVES} drives judged again: the same bytes; it states that the drives broke rules (FAILED)" in line
    )
    found = script(packed.pack, packed.public, tmp_path)
    assert (found.returncode, found.stdout.strip()) == (0, "untouched since it was signed")


@pytest.mark.slow
def test_without_the_logs_the_sql_is_run_and_the_note_says_so(packed: PackedAudit, without_logs: Path) -> None:
    found = verify(VerifyRequest(without_logs, packed.public))
    assert not found.problems
    assert "not judged again; it states that the drives broke rules (FAILED)" in found.sentence
    assert found.notes[0].startswith("2 drives without a log: judged again only with --trace and --map; 2 findings")
    rest = "2 drives without a finding in the pack: not judged again; their rows have the hashes in the receipts"
    assert rest in found.notes
    assert any(note.startswith("not judged when it was audited, nor now:") and REFUSED in note for note in found.notes)
    logs = packed.drives.manifest.parent / "logs"
    one = verify(VerifyRequest(without_logs, packed.public, (logs / CONTACT,)))
    assert not one.problems
    assert f"1 of {N_DRIVES} drives judged again" in one.sentence
    assert one.notes[0].startswith("1 drive without a log")
    with pytest.raises(UsageError, match="no log there belongs to a drive with a finding"):
        verify(VerifyRequest(without_logs, packed.public, (logs / LOSSY,)))


@pytest.mark.slow
def test_only_the_worst_findings_are_packed_where_that_is_asked(
    packed: PackedAudit, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        cli_main("pack", str(packed.audit), "--out", str(tmp_path / "pack"), "--findings", "1")
    assert ended.value.code == 0
    said = capsys.readouterr().out
    assert "1 of 1 finding has SQL that computes the margin; 1 less severe finding left out" in said
    told = evidence_of(tmp_path / "pack")
    worst = min(rows_of(packed.pack, "findings"), key=lambda row: float(row["margin"]))
    assert [row["finding_id"] for row in told["findings"]] == [worst["finding_id"]]
    assert (told["n_findings"], told["findings_left_out"]) == (2, 1)
    found = verify(VerifyRequest(tmp_path / "pack"))
    assert not found.problems
    assert "1 finding of less weight: no rows in the pack" in found.notes


@pytest.mark.slow
def test_the_evidence_of_an_audit_in_one_go_is_that_of_pack(packed: PackedAudit, tmp_path: Path) -> None:
    """The exit code stays that of the audit. The same audit gives the same bytes."""
    asked = packed.drives.command(packed.audit, "--evidence", str(tmp_path / "once"), "--sign", str(packed.key))
    with pytest.raises(SystemExit) as ended:
        cli_main(*asked)
    assert ended.value.code == 1
    again = make_pack(packed.audit, tmp_path / "again", packed.key)
    once, twice = (
        {path.relative_to(pack): path.read_bytes() for path in pack.rglob("*") if path.is_file()}
        for pack in (tmp_path / "once", again)
    )
    assert once == twice
    with pytest.raises(SystemExit) as ended:
        cli_main(*asked)
    assert ended.value.code == 2


def test_an_audit_that_has_not_ended_is_not_packed(packed: PackedAudit, tmp_path: Path) -> None:
    audit = shutil.copytree(packed.audit, tmp_path / "audit")
    parts.record_begin(LocalFolder(audit), parts.ALL_DRIVES)
    with pytest.raises(UsageError, match="the audit has not ended"):
        make_pack(audit, tmp_path / "pack")


def test_tables_that_their_summary_does_not_fit_are_not_packed(packed: PackedAudit, tmp_path: Path) -> None:
    audit = shutil.copytree(packed.audit, tmp_path / "audit")
    audited.change_json(audit / "summary.json", lambda content: content.update(refused=0))
    with pytest.raises(UsageError, match=r"summary\.json: was changed since drivelint audit wrote it"):
        make_pack(audit, tmp_path / "pack")
    (audit / MANIFEST).unlink()
    with pytest.raises(UsageError, match=r"has ended, and files\.json.* is missing"):
        make_pack(audit, tmp_path / "pack")


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (("pack", "s3://fleet/audit", "--out", "pack"), "is in an object store: copy it into a folder"),
        (("pack", "DIR", "--out", "s3://fleet/pack"), "a pack is a folder of this machine"),
        (("pack", "DIR", "--out", "DIR/pack"), "lies in the result that is packed"),
        (("audit", "nothing", "--out", "s3://fleet/audit", "--evidence", "pack"), "is in an object store"),
        (("audit", "nothing", "--out", "a", "--evidence", "pack", "--shard", "1/2"), "run drivelint merge"),
        (("audit", "nothing", "--out", "a", "--sign", "key.pem"), "name its folder with --evidence PACK"),
        (("check", "nothing", "--evidence", "pack"), "use --out, too"),
        (("check", "nothing", "--out", "a", "--evidence", "pack", "--sign", "nothing.pem"), "nothing.pem"),
        (("pack", "DIR", "--out", "pack", "--findings", "most"), "write a number such as 100, or all"),
    ],
    ids=lambda each: " ".join(each) if isinstance(each, tuple) else "",
)
def test_what_cannot_be_packed_is_refused_before_anything_is_judged(
    command: tuple[str, ...], message: str, packed: PackedAudit, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(packed.audit, tmp_path / "DIR")
    with contextlib.chdir(tmp_path), pytest.raises(SystemExit) as ended:
        cli_main(*command)
    assert ended.value.code == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "a").exists()


TAMPERED: dict[str, Tamper] = {}
"""By somebody without the key: the script of the guide finds them, too."""
FORGED: dict[str, Tamper] = {}
"""By the owner of the key, who hashes and signs anew."""


@into(TAMPERED)
def byte_of_a_table(pack: Path, _p: PackedAudit) -> tuple[str, str]:
    change_byte(table_of(pack, "verdicts"))
    return "file changed", f"{AUDIT}/tables/verdicts"


@into(TAMPERED)
def receipts_removed(pack: Path, _p: PackedAudit) -> tuple[str, str]:
    table_of(pack, "receipts").unlink()
    return "file removed", f"{AUDIT}/tables/receipts"


@into(TAMPERED)
def chunk_added(pack: Path, _p: PackedAudit) -> tuple[str, str]:
    shutil.copyfile(table_of(pack, "drives"), pack / AUDIT / "tables/drives/0.parquet")
    return "file added", f"{AUDIT}/tables/drives/0.parquet"


@into(TAMPERED)
def log_replaced(pack: Path, _p: PackedAudit) -> tuple[str, str]:
    one, other = sorted((pack / "data/inputs/traces").rglob("*.parquet"))
    shutil.copyfile(other, one)
    return "file changed", "data/inputs/traces"


@into(TAMPERED)
def refusal_left_out_and_hashed_anew(pack: Path, _p: PackedAudit) -> tuple[str, str]:
    for table in ("drives", "receipts"):
        audited.keep_rows(pack, table, lambda row: REFUSED not in row["log"])
    audited.follow_tables(pack)
    rehash(pack)
    return "file changed since the statement about it", "manifest-sha256.txt"


@into(TAMPERED)
def signed_by_another(pack: Path, p: PackedAudit) -> tuple[str, str]:
    audited.sign_anew(pack, p.other_key)
    return "signature wrong", STATEMENT


@into(FORGED)
def refused_drive_stated_as_judged(pack: Path, p: PackedAudit) -> tuple[str, str]:
    def state_as_judged(statement: dict[str, Any]) -> None:
        next(each for each in statement["predicate"]["drivelint_drives"] if each["log"] == REFUSED)["status"] = "judged"

    reseal(pack, p.key, state_as_judged)
    return "statement says another result", "drivelint_drives"


@into(FORGED)
def undecided_drive_stated_as_passed(pack: Path, p: PackedAudit) -> tuple[str, str]:
    def state_all_passed(statement: dict[str, Any]) -> None:
        predicate = statement["predicate"]
        predicate["passedTests"] = sorted([*predicate["passedTests"], *predicate["drivelint_undecidedTests"]])
        predicate["drivelint_undecidedTests"] = []

    reseal(pack, p.key, state_all_passed)
    return "statement says another result", "passedTests"


@into(FORGED)
def drive_left_out_of_the_statement(pack: Path, p: PackedAudit) -> tuple[str, str]:
    reseal(pack, p.key, lambda statement: statement["subject"].pop())
    return "statement about another log", "subject"


@into(FORGED)
def verdicts_turned_and_the_receipts_left(pack: Path, p: PackedAudit) -> tuple[str, str]:
    change_table(table_of(pack, "verdicts"), "verdict", to_pass)
    audited.follow_tables(pack)
    audited.sign_anew(pack, p.key)
    return "receipts do not match the tables", "counts"


@into(FORGED)
def a_row_moved_by_a_little(pack: Path, p: PackedAudit) -> tuple[str, str]:
    change_table(table_of(pack, "verdicts"), "margin", lambda value: None if value is None else value + 1e-9)
    audited.follow_tables(pack)
    audited.sign_anew(pack, p.key)
    return "receipts do not match the tables", "rows_sha256"


@into(FORGED)
def lossy_drive_said_to_be_whole(pack: Path, p: PackedAudit) -> tuple[str, str]:
    change_table(table_of(pack, "receipts"), "lossy", lambda _value: False)
    audited.follow_tables(pack)
    change_evidence(pack, lambda evidence: evidence.update(n_lossy=0))
    audited.sign_anew(pack, p.key)
    return "receipts do not match the tables", "lossy"


@into(FORGED)
def refused_drive_said_to_be_judged(pack: Path, p: PackedAudit) -> tuple[str, str]:
    change_table(table_of(pack, "receipts"), "status", lambda _value: "judged")
    audited.follow_tables(pack)
    change_evidence(pack, lambda evidence: evidence.update(not_judged=[]))
    audited.sign_anew(pack, p.key)
    return "receipts do not match the tables", "status"


@into(FORGED)
def summary_that_knows_no_refusal(pack: Path, p: PackedAudit) -> tuple[str, str]:
    audited.change_json(pack / AUDIT / "summary.json", lambda content: content.update(refused=0, judged=N_DRIVES))
    change_evidence(pack, lambda _evidence: None)
    audited.sign_anew(pack, p.key)
    return "summary.json does not match the tables", "refused"


@into(FORGED)
def other_rules_in_the_settings(pack: Path, p: PackedAudit) -> tuple[str, str]:
    def change_rules(content: dict[str, Any]) -> None:
        content["settings"]["rules"] = ["ukhc"]

    audited.change_json(pack / AUDIT / "audit.json", change_rules)
    change_evidence(pack, lambda evidence: evidence["audit"]["settings"].update(rules=["ukhc"]))
    audited.sign_anew(pack, p.key)
    return "audit.json does not match the result", "run_id"


@into(FORGED)
def worst_finding_left_out(pack: Path, p: PackedAudit) -> tuple[str, str]:
    def less(evidence: dict[str, Any]) -> None:
        gone = evidence["findings"].pop(0)
        evidence["inputs"] = {
            what: {k: v for k, v in each.items() if k != gone["key"]} for what, each in evidence["inputs"].items()
        }
        evidence["findings_left_out"] = 1
        shutil.rmtree(pack / "data/findings" / gone["key"])

    change_evidence(pack, less)
    audited.sign_anew(pack, p.key)
    return "evidence.json does not match the result", "findings"


@into(FORGED)
def table_beside_the_audit(pack: Path, p: PackedAudit) -> tuple[str, str]:
    (pack / AUDIT / "note.txt").write_text("all is well", encoding="utf-8")
    change_evidence(pack, lambda evidence: evidence["outputs"].update({f"{AUDIT}/note.txt": "0"}))
    change_evidence(pack, lambda _evidence: None)
    audited.sign_anew(pack, p.key)
    return "file that nothing names", f"{AUDIT}/note.txt"


@pytest.mark.sample(6)
@pytest.mark.parametrize("name", [*TAMPERED, *FORGED])
def test_what_is_changed_is_named(name: str, packed: PackedAudit, tmp_path: Path) -> None:
    pack = copied(packed, tmp_path)
    kind, what = (TAMPERED | FORGED)[name](pack, packed)
    found = verify(VerifyRequest(pack, packed.public))
    named = [str(problem.subject) for problem in found.problems if problem.kind == kind]
    assert any(what in each for each in named), found.problems
    assert (script(pack, packed.public, tmp_path).returncode == 1) == (name in TAMPERED)


def turned(pack: Path) -> None:
    """Let the margin of a contact be half as bad, in every place that says it."""
    for table in ("verdicts", "findings"):
        for column in ("observed", "margin"):
            change_table(table_of(pack, table), column, lambda value: value / 2 if value and value < 0 else value)
    audited.follow_rows(pack)
    audited.follow_tables(pack)


@pytest.mark.slow
def test_rows_that_do_not_follow_from_the_log_are_named(packed: PackedAudit, tmp_path: Path) -> None:
    """Everything in the pack agrees: only the log tells."""
    pack = copied(packed, tmp_path)
    turned(pack)

    def half(evidence: dict[str, Any]) -> None:
        rows = {row["finding_id"]: row for row in rows_of(pack, "findings")}
        for row in evidence["findings"]:
            row |= {key: rows[row["finding_id"]][key] for key in ("observed", "margin")}

    change_evidence(pack, half)
    audited.sign_anew(pack, packed.key)
    found = verify(VerifyRequest(pack, packed.public))
    assert {problem.kind for problem in found.problems} == {"result not reproduced"}
    named = {problem.subject.partition(" (")[0] for problem in found.problems if "rows of" in problem.subject}
    assert len(named) == 2


@pytest.mark.slow
def test_rows_of_a_finding_that_do_not_give_its_numbers_are_named(
    packed: PackedAudit, without_logs: Path, tmp_path: Path
) -> None:
    pack = tmp_path / shutil.copytree(without_logs, tmp_path / "pack").name
    pair = min((pack / "data/findings").rglob("pair.parquet"))
    for field in pq.read_schema(pair):
        if pa.types.is_floating(field.type):
            change_table(pair, field.name, lambda value: None if value is None else value + 1)
    reseal(pack, packed.key)
    (problem,) = verify(VerifyRequest(pack, packed.public)).problems
    assert problem == ("finding does not give its numbers", pair.parent.relative_to(pack).as_posix())


def test_rows_that_another_pyarrow_wrote_are_not_said_to_have_their_hashes(
    packed: PackedAudit, without_logs: Path, tmp_path: Path
) -> None:
    pack = tmp_path / shutil.copytree(without_logs, tmp_path / "pack").name
    audited.change_json(pack / AUDIT / "audit.json", lambda content: content["versions"].update(pyarrow="1"))
    change_evidence(pack, lambda evidence: evidence["audit"]["versions"].update(pyarrow="1"))
    audited.sign_anew(pack, packed.key)
    found = verify(VerifyRequest(pack, packed.public))
    assert not found.problems
    assert any("were not compared, as another pyarrow wrote them" in note for note in found.notes)
    assert "audited by other versions of pyarrow" in found.notes


def cli_main(*arguments: str) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", ["drivelint", *arguments])
        cli.main()
