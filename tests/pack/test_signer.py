"""What the owner of the key signs though it is not so: hashes, signature and statement are right, and the script is content.

Without the log, only what does not agree within the pack can be found; with it, everything that follows from the log.
"""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING, Any

import pyarrow.parquet as pq
import pytest

from drivelint.pack import VerifyRequest, verify
from tests.pack.packed import (
    change_evidence,
    change_numbers,
    change_table,
    copied,
    edit,
    inner,
    into,
    log_of,
    make_pack,
    rewrite_reports,
    rows_of,
    script,
    sign_anew,
    sql_of,
    to_pass,
)

if TYPE_CHECKING:
    from pathlib import Path

    from tests.pack.conftest import Packed
    from tests.pack.packed import Tamper

pytestmark = pytest.mark.ci
VERDICTS, SUMMARY, EVIDENCE = "data/result/verdicts.parquet", "data/result/summary.json", "data/evidence.json"
BY_SIGNER: dict[str, Tamper] = {}


@into(BY_SIGNER)
def report_says_otherwise(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / "data/result/report.html", "FAIL", "PASS")
    change_evidence(pack, lambda _evidence: None)
    return "report does not match the tables", "data/result/report.html"


@into(BY_SIGNER)
def failures_left_out_of_the_test_report(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / "data/result/junit.xml", "<failure", "<system-out")
    change_evidence(pack, lambda _evidence: None)
    return "report does not match the tables", "data/result/junit.xml"


@into(BY_SIGNER)
def counts_changed(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / SUMMARY, '"fail": ', '"fail": 1')
    change_evidence(pack, lambda _evidence: None)
    return "summary.json does not match the tables", "verdicts"


@into(BY_SIGNER)
def count_added(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / SUMMARY, '"near_misses"', '"approved": true,\n  "near_misses"')
    change_evidence(pack, lambda _evidence: None)
    return "summary.json does not match the tables", "approved"


@into(BY_SIGNER)
def parameter_edited(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / EVIDENCE, '"ukhc.contact-signature.within_m": "0.4"', '"ukhc.contact-signature.within_m": "0.1"')
    return "evidence.json does not match the result", "parameters"


@into(BY_SIGNER)
def rule_edited(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / "data/rules/ukhc/no-collision.sql", "title", "titel")
    return "evidence.json does not match the result", "rules"


@into(BY_SIGNER)
def margin_in_the_rows_edited(pack: Path, _p: Packed) -> tuple[str, str]:
    change_numbers(rows_of(pack))
    return "finding does not give its numbers", inner(pack, rows_of(pack).parent)


@into(BY_SIGNER)
def margin_of_a_finding_edited(pack: Path, _p: Packed) -> tuple[str, str]:
    path = pack / "data/result/findings.parquet"
    change_table(path, "margin", lambda margin: None if margin is None else margin / 2)
    margins = pq.read_table(path)["margin"].to_pylist()

    def state_margins(evidence: dict[str, Any]) -> None:
        for row, margin in zip(evidence["findings"], margins, strict=True):
            row["margin"] = margin

    rewrite_reports(pack)
    change_evidence(pack, state_margins)
    return "finding does not give its numbers", "data/findings/"


@into(BY_SIGNER)
def sql_edited(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(sql_of(pack), "margin, holds", "-0.01 AS margin, holds")
    return "finding does not give its numbers", inner(pack, sql_of(pack).parent)


@into(BY_SIGNER)
def sql_that_would_write_a_file(pack: Path, _p: Packed) -> tuple[str, str]:
    """`verify` never runs the SQL of a pack."""
    with sql_of(pack).open("a", encoding="utf-8") as file:
        file.write(f"COPY (SELECT 1) TO '{pack.parent}/written.csv';\n")
    return "finding does not give its numbers", inner(pack, sql_of(pack).parent)


@into(BY_SIGNER)
def rows_cut(pack: Path, _p: Packed) -> tuple[str, str]:
    rows_of(pack).write_bytes(rows_of(pack).read_bytes()[:-10])
    return "finding does not give its numbers", inner(pack, rows_of(pack).parent)


@into(BY_SIGNER)
def finding_denied(pack: Path, _p: Packed) -> tuple[str, str]:
    """The list says that it has no SQL, and that lies there."""
    name = sql_of(pack).parent.name

    def deny_sql(evidence: dict[str, Any]) -> None:
        next(row for row in evidence["findings"] if row["finding_id"] == name).update(sql=None)

    change_evidence(pack, deny_sql)
    return "file that nothing names", inner(pack, sql_of(pack))


@into(BY_SIGNER)
def letter_added(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / "data/result/approval.json").write_text("{}", encoding="utf-8")
    change_evidence(pack, lambda evidence: evidence["outputs"].update({"data/result/approval.json": ""}))
    change_evidence(pack, lambda _evidence: None)
    return "file that nothing names", "data/result/approval.json"


@into(BY_SIGNER)
def all_the_payload_named_as_mapping(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / "data/letter.txt").write_text("approved", encoding="utf-8")
    change_evidence(pack, lambda evidence: evidence.update(mapping="data"))
    return "file that nothing names", "data/letter.txt"


@into(BY_SIGNER)
def something_said_twice(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / EVIDENCE, "{", '{\n  "drives": [],')
    return "result not readable", "says something twice"


@into(BY_SIGNER)
def something_more_said(pack: Path, _p: Packed) -> tuple[str, str]:
    change_evidence(pack, lambda evidence: evidence.update(approved_by="the ministry"))
    return "evidence.json does not match the result", "approved_by"


@into(BY_SIGNER)
def form_of_the_future(pack: Path, _p: Packed) -> tuple[str, str]:
    change_evidence(pack, lambda evidence: evidence.update(evidence=2))
    return "result not readable", "form 2"


@into(BY_SIGNER)
def rules_from_outside(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / "data/result/run.json", '"rules_dirs": []', '"rules_dirs": ["/tmp"]')
    change_evidence(pack, lambda _evidence: None)
    return "evidence.json does not match the result", "rules_dirs"


@into(BY_SIGNER)
def places_that_are_no_places(pack: Path, _p: Packed) -> tuple[str, str]:
    change_evidence(pack, lambda evidence: evidence.update(inputs=[1]))
    return "result not readable", ""


@into(BY_SIGNER)
def reason_beside_the_sql(pack: Path, _p: Packed) -> tuple[str, str]:
    change_evidence(pack, lambda evidence: evidence["findings"][0].update(without_sql_because="it is not needed"))
    return "evidence.json does not match the result", "sql"


@into(BY_SIGNER)
def parameter_of_the_check_edited(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / "data/result/run.json", "within_m=0.4", "within_m=0.1")
    change_evidence(pack, lambda _evidence: None)
    return "run.json does not match the result", "parameters"


@into(BY_SIGNER)
def parameter_of_the_check_that_is_none(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / "data/result/run.json", "within_m=0.4", "width_m=0.4")
    change_evidence(pack, lambda _evidence: None)
    return "run.json does not match the result", "width_m"


@into(BY_SIGNER)
def title_of_a_rule_edited(pack: Path, _p: Packed) -> tuple[str, str]:
    """Its file has another one."""
    change_table(pack / "data/result/rules.parquet", "title", lambda title: title.replace("No ", "Little "))
    rewrite_reports(pack)
    return "run.json does not match the result", "rules"


@pytest.fixture(scope="session")
def unjudged(packed: Packed, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the pack without logs: nothing is judged again, so it is verified in a moment."""
    return make_pack(packed.result, tmp_path_factory.mktemp("unjudged") / "pack", packed.key)


@pytest.mark.slow
@pytest.mark.sample(8)
@pytest.mark.parametrize("name", BY_SIGNER)
def test_what_the_signer_forged_is_named(name: str, unjudged: Path, packed: Packed, tmp_path: Path) -> None:
    pack = tmp_path / "pack"
    shutil.copytree(unjudged, pack)
    kind, what = BY_SIGNER[name](pack, packed)
    sign_anew(pack, packed.key)
    assert script(pack, packed.public, tmp_path).returncode == 0
    found = verify(VerifyRequest(pack, packed.public)).problems
    assert any(each.kind == kind and what in each.subject for each in found), found
    assert not (tmp_path / "written.csv").exists()


def test_what_is_signed_anew_without_a_change_is_the_same(unjudged: Path, packed: Packed, tmp_path: Path) -> None:
    """So that it is the change that the tests above find."""
    pack = tmp_path / "pack"
    shutil.copytree(unjudged, pack)
    rewrite_reports(pack)
    sign_anew(pack, packed.key)
    found = verify(VerifyRequest(pack, packed.public))
    assert found.problems == []
    (note,) = found.notes
    assert "4 findings gave their numbers from the rows in the pack" in note
    assert found.sentence.endswith("not judged again; it states that the drives broke rules (FAILED)")
    for path in unjudged.rglob("*"):
        if path.is_file():
            assert (pack / path.relative_to(unjudged)).read_bytes() == path.read_bytes(), path


def test_a_log_that_its_signer_replaced(packed: Packed, tmp_path: Path) -> None:
    pack = copied(packed, tmp_path)
    shutil.copyfile(log_of(packed.other_pack), log_of(pack))
    sign_anew(pack, packed.key)
    (found,) = verify(VerifyRequest(pack, packed.public)).problems
    assert found.kind == "inputs do not match the result"
    assert "another log" in found.subject


def test_a_map_that_its_signer_replaced(packed: Packed, tmp_path: Path) -> None:
    pack = copied(packed, tmp_path)
    edit(pack / "data/inputs/map/road.xodr", "<road ", "<road  ")
    sign_anew(pack, packed.key)
    (found,) = verify(VerifyRequest(pack, packed.public)).problems
    assert found.kind == "inputs do not match the result"
    assert "another map" in found.subject


def test_a_log_outside_of_the_pack_is_not_read(packed: Packed, tmp_path: Path) -> None:
    pack = copied(packed, tmp_path)
    shutil.copyfile(log_of(pack), tmp_path / "outside.csv")

    def outside(evidence: dict[str, Any]) -> None:
        evidence["inputs"]["traces"] = dict.fromkeys(evidence["inputs"]["traces"], "data/../../outside.csv")

    change_evidence(pack, outside)
    log_of(pack).unlink()
    sign_anew(pack, packed.key)
    (found,) = verify(VerifyRequest(pack, packed.public)).problems
    assert found == ("evidence.json not readable", "data/evidence.json leads out of the pack: data/../../outside.csv")


@pytest.mark.slow
def test_a_verdict_that_its_signer_flipped_is_not_reproduced(packed: Packed, tmp_path: Path) -> None:
    """Everything follows from it, and the statement says so: only the log tells."""
    pack = copied(packed, tmp_path)
    change_table(pack / VERDICTS, "verdict", to_pass)
    rewrite_reports(pack)
    sign_anew(pack, packed.key)
    assert script(pack, packed.public, tmp_path).returncode == 0
    assert ("result not reproduced", VERDICTS) in verify(VerifyRequest(pack, packed.public)).problems


def test_another_version_that_a_signer_names_is_said(unjudged: Path, packed: Packed, tmp_path: Path) -> None:
    """Which version judged, nothing in a pack can show: it is a note."""
    pack = tmp_path / "pack"
    shutil.copytree(unjudged, pack)
    edit(pack / SUMMARY, '"version": "', '"version": "0.0.')
    told = json.loads((pack / SUMMARY).read_text("utf-8"))["tool"]
    change_evidence(pack, lambda evidence: evidence.update(tool=told))
    sign_anew(pack, packed.key)
    found = verify(VerifyRequest(pack, packed.public))
    assert any(f"judged by drivelint {told['version']}, and this is" in note for note in found.notes)
