"""A rule that a file of scenes expects and that is not there: the error names what it may be, not all rules."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint.errors import ExitCode, UsageError
from drivelint.scene.judge import scene_test

if TYPE_CHECKING:
    from pathlib import Path

SCENES = """
roads: {{road: {{traffic: both, roads: {{main: {{line: [600]}}}}}}}}
scenes:
- name: alone
  what: the ego alone
  roads: road
  seconds: 2
  actors: {{ego: {{lane: main 1, from: 10, speed: 5}}}}
  expect: {{{rule}: pass}}
"""


@pytest.mark.parametrize(
    ("rule", "words"),
    [
        ("mine.near", "no rule 'mine.near', as there is no pack 'mine': give its folder with --rules-dir"),
        ("ukhx.no-collision", "there is no pack 'ukhx'; did you mean 'ukhc'?: give its folder with --rules-dir"),
        ("ukhc.no-colision", "no rule 'ukhc.no-colision'; did you mean 'ukhc.no-collision'?"),
        ("ukhc.zzzzzz", "no rule 'ukhc.zzzzzz'; drivelint rules list shows them all"),
    ],
)
def test_a_rule_that_is_not_there(tmp_path: Path, rule: str, words: str) -> None:
    path = tmp_path / "scenes.yml"
    path.write_text(SCENES.format(rule=rule), encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        scene_test(path, [], [], print)
    assert str(caught.value).endswith(words)


@pytest.mark.ci
def test_a_log_that_cannot_be_judged_is_told_with_its_reason(tmp_path: Path) -> None:
    path = tmp_path / "scenes.yml"
    text = SCENES.format(rule="ukhc.no-collision").replace("speed: 5", "speed: -9").replace("seconds: 2", "seconds: 4")
    path.write_text(text, encoding="utf-8")
    lines: list[str] = []
    assert scene_test(path, [], [], lines.append) == ExitCode.FAILED
    assert "expected pass, got refused: heading is off the direction of motion" in lines[0]
