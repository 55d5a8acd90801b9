"""What `audit` prints at its end: how sure contacts are, a touch of two egos once, reasons with their number."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.audit import AuditRequest, AuditSummary, JudgeSettings, audit, summary
from drivelint.audit.ask import run_query
from drivelint.audit.compact import create_views, open_database
from drivelint.audit.run import AUDIT_FILE, RULES_FILE
from drivelint.audit.sealed import seal
from drivelint.audit.store import LocalFolder
from drivelint.audit.summary import summary_of_all_drives
from drivelint.audit.text import summary_text
from drivelint.audit.unpacked import SUMMARY_FILE
from drivelint.errors import ExitCode
from drivelint.fleet_report import page
from drivelint.fleet_report.audit_views import open_audits
from drivelint.fleet_report.content import fleet_content
from drivelint.report.progress import Silent
from tests.audit import fleet
from tests.audit.here import InThisProcess, run_audit


@pytest.fixture(scope="module")
def once(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, int]:
    """Return an audit with contacts, and in how many drives; nobody may alter it."""
    home = tmp_path_factory.mktemp("audited")
    few = fleet.write(home / "fleet", 7)
    assert len(few.planted) > 1
    run_audit(few, home / "out")
    return home / "out", len(few.planted)


@pytest.fixture
def audited(once: tuple[Path, int], tmp_path: Path) -> tuple[Path, int]:
    """Return a copy of that audit."""
    shutil.copytree(once[0], tmp_path / "out")
    return tmp_path / "out", once[1]


def findings_line_and_summary(out: Path, *, robust: bool = True) -> tuple[str, AuditSummary]:
    with open_database() as con:
        create_views(con, LocalFolder(out), out)
        audit_summary = replace(summary_of_all_drives(con, 0), robust=robust)
    (line,) = [
        line for line in summary_text(audit_summary, "out", ExitCode.FAILED).splitlines() if line.startswith("findings")
    ]
    return line, audit_summary


def change(out: Path, **columns: object) -> pa.Table:
    """Set columns of the first finding, and let all others stay in 100 of 100 copies."""
    (file,) = (out / "tables" / "findings").iterdir()
    table = pq.read_table(file)
    rows = [row | {"n_copies": 100, "n_stays": 100} for row in table.to_pylist()]
    rows[0] |= columns
    pq.write_table(pa.Table.from_pylist(rows, schema=table.schema), file)
    return table


@pytest.mark.slow
def test_a_contact_that_is_only_possible_is_not_printed_as_one(audited: tuple[Path, int]) -> None:
    out, n = audited
    change(out, n_stays=30)
    line, _ = findings_line_and_summary(out)
    assert line == (
        f"findings: {n} critical, 0 major, 0 minor; CONTACT in {n - 1} drive{'s' * (n > 2)}; possible contact in 1 drive; "
        "certainty: examined: 1 only possible"
    )


def test_where_nobody_looked_the_line_says_how_to(audited: tuple[Path, int]) -> None:
    out, n = audited
    line, _ = findings_line_and_summary(out, robust=False)
    assert line.endswith(f"CONTACT in {n} drives; certainty: not examined (--robustness examines it)")


def test_a_touch_of_two_egos_is_one(audited: tuple[Path, int]) -> None:
    out, n = audited
    (file,) = (out / "tables" / "findings").iterdir()
    table = pq.read_table(file)
    first = table.slice(0, 1).to_pylist()[0]
    other = first | {"ego_id": first["object_id"], "object_id": first["ego_id"], "finding_id": "other"}
    later = other | {"t_start_ns": first["t_end_ns"] + 1, "t_end_ns": first["t_end_ns"] + 2, "finding_id": "later"}
    for added, expected in (([other], n), ([other, later], n + 1)):
        pq.write_table(pa.concat_tables([table, pa.Table.from_pylist(added, schema=table.schema)]), file)
        assert findings_line_and_summary(out)[1].findings == {"critical": expected}


def test_the_surest_finding_of_a_touch_counts(audited: tuple[Path, int]) -> None:
    out, n = audited
    change(out, n_stays=30)
    (file,) = (out / "tables" / "findings").iterdir()
    table = pq.read_table(file)
    first = table.slice(0, 1).to_pylist()[0]
    other = first | {"ego_id": first["object_id"], "object_id": first["ego_id"], "finding_id": "other", "n_stays": 99}
    pq.write_table(pa.concat_tables([table, pa.Table.from_pylist([other], schema=table.schema)]), file)
    audit_summary = findings_line_and_summary(out)[1]
    assert (
        audit_summary.findings,
        audit_summary.possible,
        audit_summary.contacts,
        audit_summary.contacts_possible,
    ) == (
        {"critical": n},
        0,
        n,
        0,
    )


def test_one_reason_of_many_drives_is_told_once_with_its_number(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 4)
    text = few.manifest.read_text(encoding="utf-8").splitlines()
    text = [f"{text[0]},map", *(f"{line},nowhere.xodr" for line in text[1:])]
    few.manifest.write_text("\n".join(text) + "\n", encoding="utf-8")
    lines = summary_text(run_audit(few, tmp_path / "out"), "out", ExitCode.NOT_JUDGED).splitlines()
    assert sum("nowhere.xodr" in line for line in lines) == 1
    assert any(line.startswith("  refused (4 drives, such as ") for line in lines)


def test_the_lists_use_words_and_say_how_many_more_there_are() -> None:
    broken = [{"severity": "major", "rule_id": "a.rule", "n_findings": 2, "n_drives": 1}]
    reasons = [{"reason_code": "missing_step", "n": 3, "n_rules": 1, "n_drives": 2, "reason": "not recorded"}]
    audit_summary = AuditSummary(
        n_drives=5, digest="0", broken=broken, unknown_for=reasons, unknown=9, n_broken=3, n_unknown_for=2
    )
    lines = summary_text(audit_summary, "out", ExitCode.OK).splitlines()
    at = lines.index("  major    a.rule: 2 findings in 1 drive")
    assert lines[at + 1].startswith('  and 2 more rules: drivelint sql out "SELECT ')
    at = lines.index("  3 of 1 rule in 2 drives: not recorded")
    assert lines[at + 1].startswith('  and 1 more reason: drivelint sql out "SELECT ')
    assert "missing_step" not in "\n".join(lines)
    all_told = summary_text(replace(audit_summary, n_broken=1, n_unknown_for=1), "out", ExitCode.OK)
    assert "more rule" not in all_told
    assert "more reason" not in all_told


@pytest.mark.parametrize(
    ("audit_summary", "fail_on", "why"),
    [
        (
            AuditSummary(
                n_drives=3, n_judged=3, digest="0", failed={"critical": 3}, findings={"critical": 2, "major": 4}
            ),
            "critical",
            "exit 1: 2 findings at or above severity critical",
        ),
        (
            AuditSummary(n_drives=3, n_judged=2, n_refused=1, digest="0"),
            "critical",
            "exit 4: 1 of 3 drives could not be judged",
        ),
        (
            AuditSummary(n_drives=9, n_judged=6, n_refused=3, copies=2, copies_not_judged=1, digest="0"),
            "critical",
            "exit 4: 2 of 6 drives could not be judged",
        ),
        (
            AuditSummary(n_drives=1, n_judged=1, digest="0", lossy=1),
            "critical",
            "exit 3: judged on lossy input: parts of a log were lost",
        ),
        (
            AuditSummary(n_drives=1, n_judged=1, digest="0"),
            "major",
            "exit 0: nothing failed at or above severity major",
        ),
    ],
)
def test_the_exit_line_gives_the_reason(audit_summary: AuditSummary, fail_on: str, why: str) -> None:
    text = summary_text(audit_summary, "out", audit_summary.exit_code(fail_on, strict=False), fail_on=fail_on)
    assert why in text.splitlines()


def test_where_nothing_was_judged_there_is_nothing_to_look_at() -> None:
    lost = AuditSummary(n_drives=2, n_refused=2, digest="0")
    for audit_summary, is_shown in ((lost, False), (replace(lost, n_judged=1, n_refused=1), True)):
        lines = summary_text(audit_summary, "out", ExitCode.NOT_JUDGED, fail_on="critical").splitlines()
        assert any(line.startswith(("look ", "ask ", "explain ")) for line in lines) == is_shown


@pytest.mark.slow
def test_the_summary_counts_what_it_does_not_show(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(summary, "MOST_LISTED_RULES", 0)
    few = fleet.write(tmp_path / "fleet", 12)
    audit_summary = run_audit(few, tmp_path / "out")
    assert (audit_summary.broken, audit_summary.n_broken, audit_summary.n_unknown_for) == (
        [],
        1,
        len(audit_summary.unknown_for),
    )
    assert '  and 1 more rule: drivelint sql out "SELECT ' in summary_text(audit_summary, "out", ExitCode.FAILED)


@pytest.mark.slow
@pytest.mark.sample(0, ci=99)
@pytest.mark.parametrize("ego", ["0", "1"])
def test_the_distance_of_the_summary_is_that_of_the_page(tmp_path: Path, ego: str) -> None:
    """A log is judged with ego 0, and again with the same or another one: only another one adds its distance."""
    few = fleet.write(tmp_path / "fleet", 1)
    copy = few.manifest.parent / "logs" / "copy.parquet"
    copy.write_bytes((copy.parent / "drive-00000.parquet").read_bytes())
    few.manifest.write_text(f"log,ego\nlogs/drive-00000.parquet,0\nlogs/copy.parquet,{ego}\n", encoding="utf-8")
    audit_summary = run_audit(few, tmp_path / "out")
    with open_audits(str(tmp_path / "out")) as (con, out, _):
        page = fleet_content(con, out, None, ())
        ways = {
            row[0]: row[1]
            for row in con.sql("SELECT e.ego_id, e.km FROM (SELECT unnest(exposure) AS e FROM drives)").fetchall()
        }
    assert (audit_summary.n_drives, audit_summary.copies, page.totals["egos"]) == (2, 1, len({"0", ego}))
    assert audit_summary.km == page.totals["km"] == pytest.approx(sum(ways[name] for name in {"0", ego}), abs=1e-9)
    assert audit_summary.hours == pytest.approx(fleet.SECONDS / 3600, abs=1e-4)


def test_a_log_that_was_refused_is_named_and_the_others_are_counted() -> None:
    rows = [
        {"log": "a.csv", "status": "refused", "reason": "map nowhere.xodr does not exist", "n": 1},
        {"log": "b.csv", "status": "refused", "reason": "b.csv: the file is empty", "n": 1},
    ]
    audit_summary = AuditSummary(n_drives=5, n_refused=5, digest="0", not_judged=rows)
    lines = summary_text(audit_summary, "out", ExitCode.NOT_JUDGED).splitlines()
    assert "  refused (a.csv): map nowhere.xodr does not exist" in lines
    assert "  refused: b.csv: the file is empty" in lines
    assert any(line.startswith("  and 3 more: drivelint sql out ") for line in lines)


@pytest.mark.slow
@pytest.mark.sample(1, ci=99)
@pytest.mark.parametrize(
    ("tag", "warning"),
    [("weather", "column weather is only a tag"), ("Handednes", "did you mean handedness?"), ("lap", None)],
)
def test_a_tag_with_the_name_of_a_condition_or_nearly_of_a_column_is_said_to_be_none(
    tag: str, warning: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = fleet.write(tmp_path / "fleet", 1)
    header, row, *_ = few.manifest.read_text(encoding="utf-8").splitlines()
    few.manifest.write_text(f"{header},{tag}\n{row},wet\n", encoding="utf-8")
    notes: list[str] = []
    listener = Silent()
    monkeypatch.setattr(listener, "note", notes.append)
    audit(
        AuditRequest(sources=(str(few.manifest),), map=few.road, out=str(tmp_path / "out")), listener, InThisProcess()
    )
    said = [note for note in notes if "only a tag" in note]
    assert len(said) == (warning is not None)
    assert all(str(warning) in note for note in said)


@pytest.mark.slow
def test_copies_are_told_and_counted_once(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 12)
    logs = sorted((tmp_path / "fleet" / "logs").iterdir())
    first = next(log for log in logs if log.name in few.planted)
    copies = [log for log in logs if log.name not in few.planted][:2]
    for copy in copies:
        copy.write_bytes(first.read_bytes())
    audit_summary = run_audit(few, tmp_path / "out")
    lines = summary_text(audit_summary, "out", ExitCode.FAILED).splitlines()
    assert lines[0].startswith("10 drives of ")
    assert lines[1] == "10 judged"
    assert lines[2] == "2 more logs have the same content as another log: logs with the same content count once"
    told_copies = [line.strip().split(": a copy of ") for line in lines if ": a copy of " in line]
    assert len(told_copies) == 2
    assert {Path(name).name for pair in told_copies for name in pair} == {log.name for log in (first, *copies)}
    for copy in copies:
        copy.unlink()
    alone = run_audit(few, tmp_path / "alone", sources=str(tmp_path / "fleet" / "logs"))
    for name in ("km", "hours", "findings", "contacts", "unknown", "broken", "unknown_for"):
        assert getattr(audit_summary, name) == getattr(alone, name), name
    assert audit_summary.findings == {"critical": len(few.planted)}
    with open_audits(str(tmp_path / "out")) as (con, out, _):
        page = fleet_content(con, out, None, ())
    assert sum(each["findings"] for each in page.severities.values()) == len(few.planted)
    assert (page.totals["drives"], page.totals["copies"]) == (10, 2)


@pytest.mark.slow
def test_a_refused_log_counts_once_whatever_its_copies_are_called(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 4)
    damaged = sorted((tmp_path / "fleet" / "logs").iterdir())[:2]
    for log in damaged:
        log.write_bytes(b"PAR1")
    audit_summary = run_audit(few, tmp_path / "out")
    lines = summary_text(audit_summary, "out", ExitCode.NOT_JUDGED).splitlines()
    assert lines[0].startswith("3 drives of ")
    assert lines[1] == "2 judged, 1 refused"
    assert lines[2] == "1 more log has the same content as another log: logs with the same content count once"
    assert [Path(name).name for name in lines[3].strip().split(": a copy of ")] == [damaged[1].name, damaged[0].name]
    assert "not judged: 1 drive" in lines
    with open_audits(str(tmp_path / "out")) as (con, out, _):
        assert fleet_content(con, out, None, ()).n_not_judged == 1


@pytest.mark.slow
@pytest.mark.sample(0, ci=99)
@pytest.mark.parametrize(
    ("column", "value", "words"),
    [
        ("site", "north", "listed again with other tags"),
        ("ego", "1", "judged again, with another ego or map, or under"),
    ],
)
def test_a_log_that_is_listed_twice_says_what_differs(tmp_path: Path, column: str, value: str, words: str) -> None:
    few = fleet.write(tmp_path / "fleet", 1)
    rows = ["logs/drive-00000.parquet,south,0", "logs/drive-00000.parquet,south,0"]
    rows[1] = rows[1].replace("south" if column == "site" else ",0", value if column == "site" else f",{value}")
    few.manifest.write_text("\n".join(["log,site,ego", *rows, ""]), encoding="utf-8")
    text = summary_text(run_audit(few, tmp_path / "out"), "out", ExitCode.OK)
    assert f"drive-00000.parquet: {words}" in text


@pytest.mark.slow
def test_lossy_logs_and_those_off_their_map_are_named(audited: tuple[Path, int]) -> None:
    """On the terminal and on both fleet pages: the first three, of one content one."""
    out, _ = audited
    (file,) = (out / "tables" / "receipts").iterdir()
    rows = pq.read_table(file, partitioning=None)
    told_rows = sorted(rows.to_pylist(), key=lambda row: row["log"])
    for n, row in enumerate(told_rows):
        row |= {"lossy": n < 5, "off_map": n == 6}
    told_rows[1]["log_sha256"] = told_rows[0]["log_sha256"]
    pq.write_table(pa.Table.from_pylist(told_rows, schema=rows.schema), file)
    lossy, off_map = [told_rows[n]["log"] for n in (0, 2, 3)], told_rows[6]["log"]
    with open_database() as con:
        create_views(con, LocalFolder(out), out)
        lines = summary_text(summary_of_all_drives(con, 0), "out", ExitCode.OK).splitlines()
    assert f"  lossy: {', '.join(lossy)} and 1 more" in lines
    assert f"  map does not fit: {off_map}" in lines
    results = LocalFolder(out)
    seal(results, [AUDIT_FILE, RULES_FILE], results.read(SUMMARY_FILE) or b"")
    for kind in ("markdown", "html"):
        name, _ = page.write_fleet_page(str(out), kind, (), None)
        text = (out / name).read_text(encoding="utf-8").replace("`", "").replace("&#45;", "-")
        assert f"4 of the judged drives have logs with lost parts: {', '.join(lossy)} and 1 more." in text
        assert f"1 of the judged drives does not fit its map: {off_map}." in text


def test_the_query_that_is_proposed_gives_the_numbers_that_are_printed(audited: tuple[Path, int]) -> None:
    """A touch of two egos is one in both."""
    out, n = audited
    (file,) = (out / "tables" / "findings").iterdir()
    table = pq.read_table(file)
    first = table.slice(0, 1).to_pylist()[0]
    other = first | {"ego_id": first["object_id"], "object_id": first["ego_id"], "finding_id": "other"}
    pq.write_table(pa.concat_tables([table, pa.Table.from_pylist([other], schema=table.schema)]), file)
    _, audit_summary = findings_line_and_summary(out)
    text = summary_text(replace(audit_summary, n_broken=len(audit_summary.broken) + 1), str(out), ExitCode.FAILED)
    proposed = [re.search(r'"(SELECT .*)"', line) for line in text.splitlines() if " rule_id, count(" in line]
    assert len(proposed) == 2
    for found in proposed:
        assert found is not None
        (row,) = json.loads(run_query(str(out), found[1], "json"))
        assert (row["rule_id"], row["count_star()"]) == (fleet.RULE, n)


@pytest.mark.ci
def test_an_audit_that_decided_nothing_is_no_pass(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 2)
    settings = JudgeSettings(rules=("ukhc.r113.headlights",), memory=200_000_000)
    request = AuditRequest(sources=(str(few.manifest),), out=str(tmp_path / "out"), map=few.road, settings=settings)
    audit_summary = audit(request, Silent(), InThisProcess())
    assert audit_summary.undecided is not None
    assert audit_summary.exit_code("critical", strict=False) == ExitCode.NOT_JUDGED
