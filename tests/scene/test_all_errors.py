"""All unknown keys of a file of scenes are told at once with their lines, and so are all unknown rules and verdicts."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from drivelint.errors import MAX_PROBLEM_LINES, RuleError, UsageError
from drivelint.scene.judge import scene_test

if TYPE_CHECKING:
    from pathlib import Path

SCENES = """roads:
  country: {traffic: right, roads: {main: {line: [600], limit: 60 mph, kind: rural}}}
scenes:
- name: one
  what: nobody is there
  roads: country
  seconds: 6
  actors:
    ego:
      lane: main 1
      from: 10
    other: {lane: main 1, speed: 3}
  expect: {ukhc.no-collision: pass, ukhc.r124.speed-limit: pass}
"""


def problems(file: Path, changes: dict[str, str]) -> list[str]:
    text = SCENES
    for old, new in changes.items():
        assert text.count(old) == 1
        text = text.replace(old, new)
    file.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        scene_test(file, (), (), print)
    return [line.removeprefix(f"{file}:") for line in str(caught.value).split("\n")]


def test_unknown_keys_and_words(tmp_path: Path) -> None:
    found = problems(
        tmp_path / "scenes.yml",
        {"kind: rural": "knd: rural", "from: 10": "frm: 10", "speed: 3": "sped: 3", "  expect: ": "  expct: "},
    )
    assert found == [
        "2: unknown key 'roads.country.roads.main.knd': did you mean 'kind'?",
        "11: unknown key 'scenes.actors.ego.frm': did you mean 'from'?",
        "12: unknown key 'scenes.actors.other.sped': did you mean 'speed'?",
        "13: unknown key 'scenes.expct': did you mean 'expect'?",
    ]


def test_values_of_a_wrong_kind_and_missing_keys(tmp_path: Path) -> None:
    changes = {
        "limit: 60 mph": "limit: 60",
        "  what: nobody is there\n": "",
        "seconds: 6": "seconds: many",
        "from: 10": "there: [0]",
    }
    assert problems(tmp_path / "scenes.yml", changes) == [
        "2: roads.country.roads.main.limit: 60 is a number: write a list or text (drivelint docs scenes)",
        "4: scenes: the key 'what' is missing (drivelint docs scenes)",
        "6: scenes.seconds: 'many' is text: write a number (drivelint docs scenes)",
        "10: scenes.actors.ego.there: [0] has 1 value: write 2",
    ]


@pytest.mark.parametrize(
    "change",
    [
        {"speed: 3": "speed: []"},
        {"line: [600]": "line: []"},
        {"seconds: 6": "seconds: 0"},
        {"lane: main 1\n": "path: [[1, 2]]\n"},
    ],
    ids=str,
)
def test_what_cannot_be_drawn_is_refused(tmp_path: Path, change: dict[str, str]) -> None:
    assert problems(tmp_path / "scenes.yml", change)


def test_unknown_rules_and_verdicts(tmp_path: Path) -> None:
    found = problems(tmp_path / "scenes.yml", {"no-collision: pass": "no-colision: pass", "limit: pass": "limit: pas"})
    assert found == [
        "4: scene 'one': expect: no rule 'ukhc.no-colision'; did you mean 'ukhc.no-collision'?",
        "4: scene 'one': 'pas' is no verdict: did you mean 'pass'?",
    ]


def test_a_wrong_name_of_a_scene_names_the_nearest(tmp_path: Path) -> None:
    file = tmp_path / "scenes.yml"
    file.write_text(SCENES, encoding="utf-8")
    for name, meant in (("oen", "; did you mean 'one'?"), ("parked", "")):
        with pytest.raises(UsageError) as refused:
            scene_test(file, (name,), (), print)
        assert str(refused.value) == f"{file}: none of its 1 scenes has such a name{meant}"


@pytest.mark.ci
def test_the_command_prints_a_line_per_problem(tmp_path: Path) -> None:
    file = tmp_path / "scenes.yml"
    problems(file, {"from: 10": "frm: 10", "speed: 3": "sped: 3"})
    command = [sys.executable, "-m", "drivelint", "rules", "scene", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert [line.partition(str(file))[0] for line in done.stderr.splitlines()] == ["drivelint: error: ", "  "]


def test_very_many_problems_are_counted() -> None:
    lines = [f"rule.sql:{n}: wrong" for n in range(MAX_PROBLEM_LINES + 7)]
    told = str(RuleError("\n".join(lines))).split("\n")
    assert told == [*lines[:MAX_PROBLEM_LINES], "... and 7 more problems"]
