"""The pack of an audit counts findings as the audit does: logs with the same content once."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any, NamedTuple

import pyarrow.parquet as pq
import pytest

from drivelint import cli
from drivelint.pack import VerifyRequest, verify
from tests.audit import fleet
from tests.audit.here import InThisProcess, run_audit
from tests.pack.audited import table_of
from tests.pack.packed import make_key, make_pack

pytestmark = pytest.mark.ci
N_COPIES, N_REFUSED = 3, 2


class CopiedFleet(NamedTuple):
    """An audit of two drives with a contact, one of them under several names, and of logs that cannot be read; its pack and its summary."""

    audit: Path
    pack: Path
    summary: dict[str, Any]
    evidence: dict[str, Any]


@pytest.fixture(scope="module")
def copied(tmp_path_factory: pytest.TempPathFactory) -> CopiedFleet:
    folder = tmp_path_factory.mktemp("copied")
    drives = fleet.write(folder / "fleet", 6, seed=12)
    logs = folder / "fleet/logs"
    kept = sorted(drives.planted)
    names = [
        *kept,
        *(f"copy-{n}.parquet" for n in range(N_COPIES)),
        *(f"refused-{n}.parquet" for n in range(N_REFUSED)),
    ]
    for name in names[2:5]:
        shutil.copyfile(logs / kept[0], logs / name)
    for name in names[5:]:
        (logs / name).write_bytes(f"<html>{name}</html>".encode())
    drives.manifest.write_text("log\n" + "".join(f"logs/{name}\n" for name in names), encoding="utf-8")
    run_audit(drives, folder / "audit", InThisProcess())
    pack = make_pack(folder / "audit", folder / "pack", make_key(folder, "ours")[0], with_inputs=True)
    told = [json.loads(path.read_bytes()) for path in (folder / "audit/summary.json", pack / "data/evidence.json")]
    return CopiedFleet(folder / "audit", pack, *told)


def test_a_pack_has_as_many_findings_as_its_audit(copied: CopiedFleet) -> None:
    rows = pq.read_table(table_of(copied.pack, "findings")).num_rows
    n = sum(copied.summary["findings"].values())
    assert rows > n == 2
    assert copied.evidence["n_findings"] == n == len(copied.evidence["findings"])
    assert (copied.evidence["n_copies"], copied.evidence["findings_left_out"]) == (N_COPIES, 0)
    assert len({row["finding_id"] for row in copied.evidence["findings"]}) == n


def test_copies_are_not_said_to_be_judged_or_without_findings(copied: CopiedFleet) -> None:
    found = verify(VerifyRequest(copied.pack))
    assert not found.problems
    assert f"2 of {2 + N_REFUSED} drives judged again" in found.sentence
    copies = f"{N_COPIES} logs with the content of another log, counted once: not judged again; their rows have the hashes in the receipts"
    assert copies in found.notes
    assert not [note for note in found.notes if "without a finding" in note]


def test_of_copies_in_a_folder_the_log_with_the_name_is_judged_again(copied: CopiedFleet, tmp_path: Path) -> None:
    pack = make_pack(copied.audit, tmp_path / "pack", make_key(tmp_path, "ours")[0])
    logs = copied.audit.parent / "fleet/logs"
    (first,) = [
        row["log"]
        for row in pq.read_table(table_of(pack, "receipts")).to_pylist()
        if row["key"] == copied.evidence["findings"][0]["key"]
    ]
    found = verify(VerifyRequest(pack, traces=(logs,)))
    assert not found.problems
    assert f"2 of {2 + N_REFUSED} drives judged again: the same bytes" in found.sentence
    name = Path(first).name
    renamed = shutil.copy(logs / name, tmp_path / "renamed.parquet")
    (problem,) = verify(VerifyRequest(pack, traces=(Path(renamed),))).problems
    assert problem.subject.endswith(f"renamed.parquet was named {name} when it was judged: give it this name")


def test_the_line_of_pack_counts_as_the_audit_does(
    copied: CopiedFleet, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = ["drivelint", "pack", str(copied.audit), "--out", str(tmp_path / "pack"), "--findings", "1"]
    monkeypatch.setattr("sys.argv", asked)
    with pytest.raises(SystemExit):
        cli.main()
    said = capsys.readouterr().out
    assert "1 of 1 finding has SQL that computes the margin; 1 less severe finding left out" in said
    assert f"{N_COPIES} logs with the content of another log: counted once" in said
    assert not verify(VerifyRequest(tmp_path / "pack")).problems
