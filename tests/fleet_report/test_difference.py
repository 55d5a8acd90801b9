"""`drivelint diff` of two audits: what it says of two checks of the same drives, and of planted changes."""

from __future__ import annotations

import json
import re
import shutil
from collections import Counter
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest

from drivelint.audit.run import AUDIT_FILE, RULES_FILE
from drivelint.audit.sealed import seal
from drivelint.audit.store import LocalFolder
from drivelint.audit.unpacked import SUMMARY_FILE
from drivelint.fleet_report import page
from tests.audit import fleet
from tests.audit.here import run_audit
from tests.fleet_report import lake
from tests.fleet_report.command import ran
from tests.fleet_report.conftest import Audited

pytestmark = pytest.mark.ci


def compared(base: Path, new: Path, *more: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(ran("diff", base, new, "--format", "json", *more).out)
    return found


@pytest.fixture(scope="module")
def check_folders(audited: Audited, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Return results of `check` on the drives of both audits."""
    outs = []
    for drives in (audited.base_fleet, audited.new_fleet):
        out = tmp_path_factory.mktemp("checked") / "out"
        logs = drives.manifest.parent / "logs"
        ran(
            "check",
            logs,
            "--map",
            drives.road,
            "--rules",
            fleet.RULE,
            "--no-annotate",
            "--no-robustness",
            "--quiet",
            "--out",
            out,
        )
        outs.append(out)
    return outs


@pytest.mark.slow
def test_it_says_what_diff_says_of_two_checks(audited: Audited, check_folders: list[Path]) -> None:
    ours, theirs = compared(audited.base, audited.new), compared(check_folders[0], check_folders[1])
    assert ours["counts"] == theirs["counts"]
    assert ours["counts"]["new"]
    assert ours["counts"]["fixed"]
    assert (ours["exit"], ours["verdicts"]) == (theirs["exit"], theirs["verdicts"])

    def entries(difference: dict[str, Any]) -> Counter[Any]:
        kept = [each for each in difference["entries"] if each["standing"] != "unchanged"]
        return Counter(
            (e["standing"], e["drive_id"][:11], e["t_s"], e["there"], e["margin"], e["base_margin"]) for e in kept
        )

    assert entries(ours) == entries(theirs)
    changes = [
        {e["drive_id"][:11]: e["why"] for e in found["entries"] if e["standing"] == "changed"}
        for found in (ours, theirs)
    ]
    assert changes[0] == changes[1]


@pytest.mark.slow
def test_the_text_has_the_same_words(audited: Audited, check_folders: list[Path]) -> None:
    ours, theirs = ran("diff", audited.base, audited.new), ran("diff", *check_folders)
    assert ours.code == theirs.code == 1

    def summary_lines(text: str) -> list[str]:
        return [
            line
            for line in text.splitlines()
            if line.startswith(("exit", "New (", "Fixed (", "Changed")) or re.match(r"\d+ new.*, ", line)
        ]

    assert summary_lines(ours.out) == summary_lines(theirs.out)
    assert "differs: data" in ours.out
    assert ran("diff", audited.base, audited.new, "--fail-on", "never").code == 0
    assert ran("diff", audited.base, audited.new, "--format", "markdown").out.startswith(
        f"## drivelint diff: {summary_lines(ours.out)[0][:5]}"
    )


@pytest.mark.slow
def test_an_audit_against_itself_has_nothing(filled: lake.Lake) -> None:
    found = compared(filled.folder, filled.folder)
    assert found["counts"] == {**dict.fromkeys(found["counts"], 0), "unchanged": filled.n_findings}
    assert found["exit"]["code"] == 0
    assert (found["opened"], found["rates"]) == ([], [])


@pytest.mark.slow
def test_lists_are_cut_and_say_so_and_the_rows_are_all_there(filled: lake.Lake, tmp_path: Path) -> None:
    """Other logs of the same names, so that drives are matched and findings are not."""
    other = lake.write(tmp_path / "other", 1_500, seed=1)
    done = ran("diff", filled.folder, other.folder, "--rows", tmp_path / "all.parquet")
    rows = pq.read_table(tmp_path / "all.parquet").to_pydict()
    n = Counter(rows["standing"])
    assert n["new"] > 50
    assert f"New ({n['new']})" in done.out
    assert f"... and {n['new'] - 50} more: --rows FILE contains all" in done.out
    assert sum(line.startswith("  critical: ") for line in done.out.splitlines()) >= 50
    assert "Only in the newer audit (300 drives)" in done.out
    found = compared(filled.folder, other.folder)
    listed = Counter(each["standing"] for each in found["entries"])
    for standing, left in found["left_out"].items():
        assert listed[standing] + left == found["counts"][standing] == n[standing]


@pytest.mark.slow
def test_a_true_difference_of_rates_is_called(
    filled: lake.Lake, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lake, "per_km", lambda number: 0.002 * (1 + number % 7) * (4 if number == 3 else 1))
    other = lake.write(tmp_path / "other", 1_200, seed=2)
    called = {each["rule_id"] for each in compared(filled.folder, other.folder)["rates"] if each["called"]}
    rules = pq.read_table(filled.folder / "rules.parquet")["rule_id"].to_pylist()
    assert called == {rules[3]}


@pytest.mark.slow
def test_more_unknown_is_told_apart_from_fixed(audited: Audited, tmp_path: Path) -> None:
    """The other audit says unknown of everything: nothing is fixed."""
    new = tmp_path / "new"
    shutil.copytree(audited.base, new)
    for name in ("verdicts", "findings"):
        (file,) = (new / "tables" / name).iterdir()
        table = pq.read_table(file)
        if name == "findings":
            pq.write_table(table.slice(0, 0), file)
            continue
        for column, word in (("verdict", "unknown"), ("reason_code", "missing_step"), ("reason", "not recorded")):
            table = table.set_column(
                table.column_names.index(column), table.schema.field(column), [[word] * table.num_rows]
            )
        pq.write_table(table, file)
    results = LocalFolder(new)
    seal(results, [AUDIT_FILE, RULES_FILE], results.read(SUMMARY_FILE) or b"")
    found = compared(audited.base, new)
    n = len(audited.base_fleet.planted)
    assert found["counts"] == {**dict.fromkeys(found["counts"], 0), "unknown": n}
    assert (
        sum(each["n"] for each in found["opened"])
        == found["verdicts"]["unknown"]
        == sum(found["base_verdicts"].values())
    )
    assert "Verdicts that are unknown now and were not before" in ran("diff", audited.base, new).out


@pytest.mark.slow
def test_a_drive_that_cannot_be_judged_any_more_is_listed_though_it_had_no_finding(tmp_path: Path) -> None:
    """Of its map it is not known whether it differs; the exit code is that of two checks."""
    drives = fleet.write(tmp_path / "fleet", 8)
    run_audit(drives, tmp_path / "base")
    for log in (drives.manifest.parent / "logs").iterdir():
        log.write_bytes(log.read_bytes()[:100] + log.name.encode())  # each another content
    run_audit(drives, tmp_path / "new")
    base, new = tmp_path / "base", tmp_path / "new"
    found = compared(base, new, "--fail-on", "never")
    assert [each["base_log"] for each in found["no_more_judged"]] == sorted(
        map(str, (drives.manifest.parent / "logs").iterdir())
    )
    assert all(each["reason"] for each in found["no_more_judged"])
    assert {each["standing"] for each in found["differences"]} == {"unknown"}
    for each in found["differences"]:
        assert "map" not in each["causes"]
        assert "map" in each["causes_not_known"]
    done = ran("diff", base, new, "--fail-on", "never")
    assert "Judged in the base, but not in the newer audit (8 drives)" in done.out
    assert done.out.rstrip().endswith("; judged less than the baseline: 8 drives of the baseline not judged")
    assert done.code == 0
    assert (
        "### Judged in the base, but not in the newer audit (8)" in ran("diff", base, new, "--format", "markdown").out
    )
    assert compared(base, base)["no_more_judged"] == []
    for kind in ("markdown", "html"):
        name, _ = page.write_fleet_page(str(new), kind, (), str(base))
        assert "udged in the baseline, but not in this audit:" in (new / name).read_text(encoding="utf-8")


def test_an_audit_and_a_check_are_not_compared(audited: Audited, check_folders: list[Path]) -> None:
    done = ran("diff", audited.base, check_folders[1])
    assert done.code == 2
    assert "no audit is here" in done.err
    assert ran("diff", *check_folders, "--rows", "x.parquet").code == 2
