"""What judging again cannot show is said: rules and profiles that are not drivelint's, logs that nobody judged, a baseline."""

from __future__ import annotations

import shutil
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from drivelint.pack import VerifyRequest, verify
from drivelint.report.outputs import write
from drivelint.resources import folder
from drivelint.result.gate import Gate
from tests.explain.overtake_check import OVERTAKE, check
from tests.pack.packed import make_pack, sign_anew

if TYPE_CHECKING:
    from pathlib import Path

    from tests.pack.conftest import Packed


@pytest.mark.slow
def test_what_is_the_packs_own_is_said(packed: Packed, tmp_path: Path) -> None:
    """A profile of the pack has the name of one of drivelint's: verdicts by it come out again, and are not what the name says."""
    own = tmp_path / "rules" / "own"
    own.mkdir(parents=True)
    shutil.copy(folder("queries") / "assertions/ukhc/no-collision.sql", own / "touch.sql")
    (own.parent / "profiles.toml").write_text("[nominal]\nstyle = 1\npull_out_angle_deg = 40.0\n", encoding="utf-8")
    (tmp_path / "empty.csv").write_bytes(b"")
    result = check(
        tmp_path / "result",
        traces=(str(OVERTAKE / "collision.csv"), str(tmp_path / "empty.csv")),
        rules=("own.touch",),
        rules_dirs=(own.parent,),
        params=(),
        robustness=False,
    )
    write(replace(result, gate=Gate(confidence=0.5)), tmp_path / "result", overwrite=True)
    pack = make_pack(tmp_path / "result", tmp_path / "pack", packed.key, with_inputs=True)
    found = verify(VerifyRequest(pack, packed.public))
    assert found.problems == []
    assert found.notes == [
        "rules and profiles in data/rules_dirs/0/rules are not drivelint's: read them",
        "not judged when it was checked, nor now: empty.csv",
        "baseline and waivers are as the pack says: they are not checked again",
    ]
    assert "1 drive judged again: the same bytes; it states that the drives broke rules (FAILED)" in found.sentence
    # a rule that is added to those of the pack is named, whoever signs
    shutil.copy(own / "touch.sql", pack / "data/rules/ukhc.sql")
    sign_anew(pack, packed.key)
    assert ("file that nothing names", "data/rules/ukhc.sql") in verify(VerifyRequest(pack, packed.public)).problems
