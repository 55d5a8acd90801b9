"""Scenes for the tests of this folder, from a few lines of YAML."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from drivelint.scene import document
from drivelint.scene.scene import Scene, scenes_of

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.arrays import Floats

HEAD = """
roads:
  country: {traffic: SIDE, roads: {main: {line: [300, [157.08, 100], 300], height: 2}}}
  town: {traffic: SIDE, crossing: {}}
  ring: {traffic: SIDE, roundabout: {}}
scenes:
- name: a
  what: somebody drives
  roads: ROADS
  seconds: 10
  expect: {ukhc.no-collision: pass}
  actors:
"""


def scene_of(folder: Path, *actors: str, roads: str = "country", side: str = "right") -> Scene:
    """Return the scene with these actors, each a line of YAML; who has no name is the ego."""
    lines = [f"    {actor if actor[0] != '{' else f'ego: {actor}'}\n" for actor in actors]
    file = folder / "scenes.yml"
    file.write_text(HEAD.replace("SIDE", side).replace("ROADS", roads) + "".join(lines), encoding="utf-8")
    read = document.read(file)
    return scenes_of(read.scenes, read.roads)[0]


def column(scene: Scene, name: str, actor_id: str = "ego") -> Any:
    """Return a column of an actor's states."""
    table = scene.tables()["actor_state"]
    kept = [
        value
        for value, actor in zip(table[name].to_pylist(), table["actor_id"].to_pylist(), strict=True)
        if actor == actor_id
    ]
    return kept if isinstance(kept[0], str) or None in kept else np.array(kept)


def seconds(scene: Scene, actor_id: str = "ego") -> Floats:
    """Return the times of an actor's states."""
    times: Floats = column(scene, "t_ns", actor_id) / 1e9
    return times
