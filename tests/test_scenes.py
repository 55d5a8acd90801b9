"""The scenes of `tests/scenes`, a file by topic: each gives the verdicts that a careful examiner expects, and no other grave fail.

Scenes of a file are judged as drives of one run, so that they cost rows and not planning.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final

import pytest

from drivelint import catalogue
from drivelint.scene import document
from drivelint.scene.judge import differences, gating_rules, judged, rules_for
from drivelint.scene.scene import scenes_of

FOLDER: Final = Path(__file__).with_name("scenes")
TOPICS: Final = sorted(file.stem for file in FOLDER.glob("*.yml") if document.read(file).scenes)
QUICK: Final = "sample"
"""The topic with a few scenes of each kind, which the quick run judges."""
BY_CI: Final = {"junctions", "overtaking"}


def marks(topic: str) -> list[pytest.MarkDecorator]:
    return [] if topic == QUICK else [pytest.mark.ci if topic in BY_CI else pytest.mark.slow]


@pytest.mark.parametrize("topic", [pytest.param(topic, marks=marks(topic)) for topic in TOPICS])
def test_every_scene_has_the_verdicts_that_it_expects(topic: str, tmp_path: Path) -> None:
    file = document.read(FOLDER / f"{topic}.yml")
    assert file.all_fails
    scenes = scenes_of(file.scenes, file.roads)
    verdicts = judged(scenes, rules_for(file.scenes, all_fails=True), tmp_path / "scenes")
    gating = gating_rules(catalogue.load_rules())
    wrong = {scene.name: lines for scene in scenes if (lines := list(differences(scene, verdicts, gating)))}
    assert not wrong


@cache
def names() -> list[str]:
    return [scene.name for topic in TOPICS for scene in document.read(FOLDER / f"{topic}.yml").scenes]


def test_every_scene_has_a_name_of_its_own_and_asks_for_rules_that_there_are() -> None:
    assert len(set(names())) == len(names())
    rules = catalogue.load_rules()
    for topic in TOPICS:
        for scene in document.read(FOLDER / f"{topic}.yml").scenes:
            assert scene.expect.keys() <= rules.keys(), scene.name
            assert scene.expect, scene.name
