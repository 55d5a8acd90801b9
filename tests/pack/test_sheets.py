"""The incident sheets of a result go into its pack, and `verify` writes their pages again."""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING

import pytest

from drivelint.incident import IncidentRequest, write_sheet
from drivelint.pack import VerifyRequest, verify
from tests.pack.packed import change_evidence, edit, make_pack, reseal

if TYPE_CHECKING:
    from pathlib import Path

    from tests.pack.conftest import Packed

pytestmark = pytest.mark.ci


@pytest.fixture(scope="module")
def result(packed: Packed) -> Path:
    """Return a result with the sheets of two findings, one with a PDF, and one of no finding."""
    # beside the other, so that it finds log, map and mapping
    folder = shutil.copytree(packed.result, packed.result.parent / "with_sheets")
    for name in ("no-collision", "safe-distance-ahead"):
        (page,) = write_sheet(IncidentRequest(name, folder))
        page.with_suffix(".pdf").write_bytes(b"%PDF of " + page.stem.encode())
    edit(page, "Incident sheet", "Incident sheet without blame")
    (page.parent / "0000000000000000.html").write_text("of another run", encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def pack(packed: Packed, result: Path) -> Path:
    return make_pack(result, result.parent / "with_sheets.pack", packed.key, with_inputs=True)


@pytest.fixture
def pack_copy(pack: Path, tmp_path: Path) -> Path:
    return shutil.copytree(pack, tmp_path / "pack")


def sheets(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted((folder / "incidents").iterdir())}


@pytest.mark.slow
def test_sheets_go_into_the_pack(pack: Path, result: Path) -> None:
    there, packed_sheets = sheets(result), sheets(pack / "data")
    evidence = json.loads((pack / "data/evidence.json").read_text("utf-8"))
    assert evidence["incidents"] == [f"data/incidents/{name}" for name in packed_sheets]
    assert [name.rpartition(".")[2] for name in packed_sheets].count("html") == 2
    (changed,) = [name for name, page in there.items() if b"without blame" in page]
    assert b"without blame" not in packed_sheets[changed], "it is written anew"
    same = packed_sheets.keys() - {changed}
    assert {name: there[name] for name in same} == {name: packed_sheets[name] for name in same}
    left = sorted(there.keys() - packed_sheets.keys())
    assert left == ["0000000000000000.html", changed.replace("html", "pdf")]
    assert [name for name in evidence["left_out"] if "incidents/" in name] == [f"incidents/{name}" for name in left]


@pytest.mark.slow
def test_verify_writes_the_pages_again(packed: Packed, pack_copy: Path) -> None:
    """The one page that was changed is found; the other is as it is written again."""
    page = min((pack_copy / "data/incidents").glob("*.html"))
    edit(page, "How sure", "How certain")
    reseal(pack_copy, packed.key)
    found = verify(VerifyRequest(pack_copy, packed.public))
    assert [(each.kind, each.subject) for each in found.problems] == [
        ("result not reproduced", f"data/incidents/{page.name}")
    ]
    assert "an incident sheet as PDF is as the pack says: the page beside it is what is written again" in found.notes


@pytest.mark.slow
def test_a_sheet_that_evidence_does_not_name(packed: Packed, pack_copy: Path) -> None:
    shutil.copy(min((pack_copy / "data/incidents").glob("*.html")), pack_copy / "data/incidents/more.html")
    reseal(pack_copy, packed.key)
    (problem,) = verify(VerifyRequest(pack_copy, packed.public)).problems
    assert (problem.kind, problem.subject) == ("file that nothing names", "data/incidents/more.html")


@pytest.mark.parametrize("name", ["data/incidents/more.html", "data/result/run.json"])
def test_a_sheet_of_no_finding(packed: Packed, pack_copy: Path, name: str) -> None:
    shutil.copy(min((pack_copy / "data/incidents").glob("*.html")), pack_copy / "data/incidents/more.html")
    change_evidence(pack_copy, lambda evidence: evidence["incidents"].extend({name, "data/incidents/more.html"}))
    reseal(pack_copy, packed.key)
    found = verify(VerifyRequest(pack_copy, packed.public)).problems
    assert {(each.kind, each.subject) for each in found} == {
        ("evidence.json does not match the result", each) for each in (name, "data/incidents/more.html")
    }
    assert all(each.kind == "evidence.json does not match the result" for each in found)


@pytest.mark.slow
def test_without_the_logs_it_says_that_pages_are_not_written_again(
    packed: Packed, result: Path, tmp_path: Path
) -> None:
    pack = make_pack(result, tmp_path / "pack", packed.key)
    found = verify(VerifyRequest(pack, packed.public))
    assert found.problems == []
    assert "its incident sheets are as the pack says: they are written again only with the logs" in found.notes
