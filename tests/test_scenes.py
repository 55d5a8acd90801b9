"""The scenes of `tests/scenes`, a file by topic: each gives the verdicts that a careful examiner expects, and no other grave fail.

Scenes of a file are judged as drives of one run, so that they cost rows and not planning.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Final

import pytest

from drivelint import catalogue
from drivelint.scene import document
from drivelint.scene.judge import differences, gating_rules, judge_scenes, rule_selectors_for_scenes
from drivelint.scene.scene import Scene, scenes_of
from tests.scene_drives import SCENES, TOPICS

BY_CI: Final = {"crossroads", "overtaking"}


@pytest.mark.parametrize(
    "topic", [pytest.param(topic, marks=pytest.mark.ci if topic in BY_CI else pytest.mark.slow) for topic in TOPICS]
)
def test_every_scene_has_the_verdicts_that_it_expects(topic: str, tmp_path: Path) -> None:
    file = document.read(SCENES / f"{topic}.yml")
    assert file.all_fails
    wrong = differing(scenes_of(file.scenes, file.roads), tmp_path, all_fails=True)
    assert not wrong


def test_the_first_scene_of_each_topic_has_the_verdicts_that_it_expects(tmp_path: Path) -> None:
    """Judged together, by the rules that they name."""
    files = [document.read(SCENES / f"{topic}.yml") for topic in TOPICS]
    scenes = [scenes_of(file.scenes[:1], file.roads)[0] for file in files]
    assert not differing(scenes, tmp_path, all_fails=False)


def differing(scenes: Sequence[Scene], folder: Path, *, all_fails: bool) -> dict[str, list[str]]:
    """Return scene -> how its verdicts differ."""
    verdicts = judge_scenes(
        scenes, rule_selectors_for_scenes([scene.text for scene in scenes], all_fails=all_fails), folder / "scenes"
    )
    gating = gating_rules(catalogue.load_rules()) if all_fails else frozenset[str]()
    return {scene.name: lines for scene in scenes if (lines := list(differences(scene, verdicts, gating)))}


@cache
def names() -> list[str]:
    return [scene.name for topic in TOPICS for scene in document.read(SCENES / f"{topic}.yml").scenes]


def test_every_scene_has_a_name_of_its_own_and_asks_for_rules_that_there_are() -> None:
    assert len(set(names())) == len(names())
    rules = catalogue.load_rules()
    for topic in TOPICS:
        for scene in document.read(SCENES / f"{topic}.yml").scenes:
            assert scene.expect.keys() <= rules.keys(), scene.name
            assert scene.expect, scene.name
