"""Whatever is changed in a pack is found and named; the script of the guide, which has nothing of drivelint, agrees."""

from __future__ import annotations

import base64
import json
import shutil
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from drivelint.guide import FOLDER
from drivelint.pack import VerifyRequest, verify
from tests.guide.blocks import blocks
from tests.pack.packed import (
    KEY,
    MANIFEST,
    STATEMENT,
    TAG_MANIFEST,
    change_byte,
    change_evidence,
    copied,
    edit,
    inner,
    log_of,
    rehash,
    reseal,
    restate,
    rewrite_reports,
    script,
    sql_of,
)

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.pack.conftest import Packed

VERDICTS, FINDINGS = "data/result/verdicts.parquet", "data/result/findings.parquet"


def set_margins(pack: Path, margin: float) -> None:
    """Let all findings miss by little, in every place that says it."""
    table = pq.read_table(pack / FINDINGS)
    i, n = table.column_names.index("margin"), table.num_rows
    has = pc.is_valid(table["margin"])
    values = pc.if_else(has, pa.array([margin] * n), pa.nulls(n, pa.float64()))
    pq.write_table(table.set_column(i, table.schema.field(i), values), pack / FINDINGS)

    def state_margins(evidence: dict[str, Any]) -> None:
        for row in evidence["findings"]:
            row["margin"] = None if row["margin"] is None else margin

    rewrite_reports(pack)
    change_evidence(pack, state_margins)


def state_passed(statement: dict[str, Any]) -> None:
    statement["predicate"]["result"] = "PASSED"


def other_log(statement: dict[str, Any]) -> None:
    statement["subject"][0]["digest"]["sha256"] = "0" * 64


def no_rule(statement: dict[str, Any]) -> None:
    statement["predicate"]["configuration"].pop()


TAMPERED: dict[str, Callable[[Path, Packed], tuple[str, str]]] = {}
"""Name -> what changes a pack and returns the kind of problem that is found, and what is named."""


def tamper(function: Callable[[Path, Packed], tuple[str, str]]) -> Callable[[Path, Packed], tuple[str, str]]:
    TAMPERED[function.__name__] = function
    return function


@tamper
def byte_of_a_table(pack: Path, _p: Packed) -> tuple[str, str]:
    change_byte(pack / VERDICTS)
    return "file changed", VERDICTS


@tamper
def table_cut(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / FINDINGS).write_bytes((pack / FINDINGS).read_bytes()[:-10])
    return "file changed", FINDINGS


@tamper
def table_removed(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / FINDINGS).unlink()
    return "file removed", FINDINGS


@tamper
def file_added(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / "data/result/more.parquet").write_bytes(b"x")
    return "file added", "data/result/more.parquet"


@tamper
def note_added_beside(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / ".note").write_text("all is well", encoding="utf-8")
    return "file added", ".note"


@tamper
def log_replaced(pack: Path, p: Packed) -> tuple[str, str]:
    shutil.copyfile(log_of(p.other_pack), log_of(pack))
    return "file changed", inner(pack, log_of(pack))


@tamper
def map_changed(pack: Path, _p: Packed) -> tuple[str, str]:
    change_byte(pack / "data/inputs/map/road.xodr")
    return "file changed", "data/inputs/map/road.xodr"


@tamper
def sql_of_a_finding_changed(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(sql_of(pack), "SELECT", "SELECT ")
    return "file changed", inner(pack, sql_of(pack))


@tamper
def finding_renamed(pack: Path, _p: Packed) -> tuple[str, str]:
    folder = sql_of(pack).parent
    folder.rename(folder.with_name("0" * 16))
    return "file removed", inner(pack, folder / "finding.sql")


@tamper
def line_of_the_manifest_removed(pack: Path, _p: Packed) -> tuple[str, str]:
    lines = (pack / MANIFEST).read_text("utf-8").splitlines(keepends=True)
    (pack / MANIFEST).write_text("".join(lines[1:]), encoding="utf-8")
    return "manifest changed", MANIFEST


@tamper
def table_changed_and_manifest(pack: Path, _p: Packed) -> tuple[str, str]:
    change_byte(pack / VERDICTS)
    tags = (pack / TAG_MANIFEST).read_bytes()
    rehash(pack)
    (pack / TAG_MANIFEST).write_bytes(tags)
    return "manifest changed", MANIFEST


@tamper
def rule_changed_and_all_hashes(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / "data/rules/ukhc/no-collision.sql", "title", "titel")
    rehash(pack)
    return "file changed since the statement about it", "manifest-sha256.txt"


@tamper
def tag_manifest_removed(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / TAG_MANIFEST).unlink()
    return "file removed", TAG_MANIFEST


@tamper
def manifest_not_readable(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / MANIFEST, "  data/", " data/")
    rehash(pack, payload=False)
    return "manifest not readable", f"{MANIFEST} line 1"


@tamper
def declaration_changed(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / "bagit.txt", "1.0", "0.9")
    return "file changed", "bagit.txt"


@tamper
def day_added_and_hashed(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / "bag-info.txt", "Bag-Software-Agent", "Bagging-Date: 2020-01-01\nBag-Software-Agent")
    rehash(pack)
    return "file changed since the statement about it", "bag-info.txt"


@tamper
def signature_changed(pack: Path, _p: Packed) -> tuple[str, str]:
    envelope = json.loads((pack / STATEMENT).read_bytes())
    signature = bytearray(base64.b64decode(envelope["signatures"][0]["sig"]))
    signature[3] ^= 1
    envelope["signatures"][0]["sig"] = base64.b64encode(signature).decode()
    (pack / STATEMENT).write_text(json.dumps(envelope), encoding="utf-8")
    rehash(pack)
    return "signature wrong", STATEMENT


@tamper
def statement_says_passed(pack: Path, _p: Packed) -> tuple[str, str]:
    restate(pack, state_passed)
    return "signature wrong", STATEMENT


@tamper
def statement_says_passed_and_signed_by_another(pack: Path, p: Packed) -> tuple[str, str]:
    restate(pack, state_passed, p.other_key)
    return "another key", "signed by"


@tamper
def statement_of_another_pack(pack: Path, p: Packed) -> tuple[str, str]:
    shutil.copyfile(p.other_pack / STATEMENT, pack / STATEMENT)
    rehash(pack)
    return "statement about another log", "subject"


@tamper
def signature_removed(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / STATEMENT).unlink()
    rehash(pack)
    return "not signed", STATEMENT


@tamper
def envelope_emptied(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / STATEMENT).write_text("{}", encoding="utf-8")
    rehash(pack)
    return "signature not readable", STATEMENT


@tamper
def key_replaced(pack: Path, p: Packed) -> tuple[str, str]:
    shutil.copyfile(p.other_public, pack / KEY)
    return "file changed", KEY


def test_the_script_is_short() -> None:
    (block,) = (each for each in blocks(FOLDER / "evidence-pack.md") if each.mark == "file: verify_pack.py")
    assert len([line for line in block.body.splitlines() if line]) <= 30


@pytest.mark.ci
def test_an_untouched_pack(packed: Packed, tmp_path: Path) -> None:
    found = verify(VerifyRequest(packed.pack, packed.public))
    assert (found.problems, found.notes) == ([], [])
    assert "untouched since it was signed" in found.sentence
    assert "signed by the key that was given" in found.sentence
    assert "1 drive judged again: the same bytes" in found.sentence
    assert "\n" not in found.sentence
    done = script(packed.pack, packed.public, tmp_path)
    assert (done.returncode, done.stdout) == (0, "untouched since it was signed\n"), done.stderr


@pytest.mark.sample(0, ci=99)
@pytest.mark.parametrize("name", TAMPERED)
def test_what_was_changed_is_named(name: str, packed: Packed, tmp_path: Path) -> None:
    pack = copied(packed, tmp_path)
    kind, what = TAMPERED[name](pack, packed)
    found = verify(VerifyRequest(pack, packed.public)).problems
    assert any(each.kind == kind and what in each.subject for each in found), found
    done = script(pack, packed.public, tmp_path)
    assert (done.returncode, "untouched" in done.stdout) == (1, False)
    assert done.stdout


def test_there_are_more_than_twenty() -> None:
    assert len(TAMPERED) > 20


@pytest.mark.ci
@pytest.mark.parametrize(
    ("change", "kind"),
    [
        (state_passed, "statement says another result"),
        (other_log, "statement about another log"),
        (no_rule, "statement about another map, rule or parameter"),
    ],
)
def test_a_statement_that_does_not_follow_is_named_whoever_signed_it(
    change: Callable[[dict[str, Any]], None], kind: str, packed: Packed, tmp_path: Path
) -> None:
    pack = copied(packed, tmp_path)
    restate(pack, change, packed.key)
    (found,) = verify(VerifyRequest(pack, packed.public)).problems
    assert found.kind == kind


@pytest.mark.slow
def test_a_result_that_its_signer_changed_is_not_reproduced(packed: Packed, tmp_path: Path) -> None:
    """Every hash and the signature are right: only the log tells."""
    pack = copied(packed, tmp_path)
    set_margins(pack, -0.01)
    reseal(pack, packed.key)
    assert script(pack, packed.public, tmp_path).returncode == 0
    found = verify(VerifyRequest(pack, packed.public)).problems
    assert ("result not reproduced", FINDINGS) in found


@pytest.mark.slow
def test_rows_of_a_finding_that_its_signer_changed_are_not_reproduced(packed: Packed, tmp_path: Path) -> None:
    pack = copied(packed, tmp_path)
    edit(sql_of(pack), "margin, holds", "-0.01 AS margin, holds")
    reseal(pack, packed.key)
    assert verify(VerifyRequest(pack, packed.public)).problems == [("result not reproduced", inner(pack, sql_of(pack)))]


@pytest.mark.ci
def test_a_link_in_the_place_of_a_file_is_named(packed: Packed, tmp_path: Path) -> None:
    pack = copied(packed, tmp_path)
    (pack / VERDICTS).rename(tmp_path / "verdicts.parquet")
    (pack / VERDICTS).symlink_to(tmp_path / "verdicts.parquet")
    assert ("link", VERDICTS) in verify(VerifyRequest(pack, packed.public)).problems


@pytest.mark.ci
def test_a_manifest_that_leads_outside_is_named(packed: Packed, tmp_path: Path) -> None:
    pack = copied(packed, tmp_path)
    with (pack / MANIFEST).open("a", encoding="utf-8") as file:
        file.write(f"{'0' * 64}  data/../../ours.pem\n")
    found = verify(VerifyRequest(pack, packed.public)).problems
    assert ("manifest names a file outside", f"{MANIFEST}: data/../../ours.pem") in found
