"""Scenes of `tests/scenes` as drives in memory, for tests that look at tables or alter what a log holds."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from drivelint.drive.trace import IngestOptions
from drivelint.engine.batch import Drive
from drivelint.formats import load_map, read_trace
from drivelint.road.map_reader import MapSource
from drivelint.scene import document
from drivelint.scene.scene import MAP_FILE, scenes_of

SCENES: Final = Path(__file__).with_name("scenes")
TOPICS: Final = sorted(file.stem for file in SCENES.glob("*.yml") if "\nscenes:\n" in file.read_text(encoding="utf-8"))
"""The files that have scenes; they are not parsed while tests are collected."""


def scene_drive(topic: str, name: str, folder: Path) -> Drive:
    """Write a scene of a topic's file into the folder, and return what is read of that; where both hands are drawn: the right one."""
    file = document.read(SCENES / f"{topic}.yml")
    scene = scenes_of([text for text in file.scenes if text.name == name], file.roads)[0]
    folder.mkdir(parents=True)
    files = scene.files()
    for each, content in files.items():
        (folder / each).write_bytes(content)
    return Drive(read_trace(folder, IngestOptions()), load_map(MapSource(MAP_FILE, files[MAP_FILE])))
