"""Makes the tables of a scene in memory, as reading its log and map would."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

from drivelint.drive.finish import finish_trace
from drivelint.drive.trace import Identity, IngestOptions, Recording
from drivelint.engine.batch import Drive
from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.demo.osi_log import HOST_ID, osi_mcap, states

if TYPE_CHECKING:
    from tests.demo.scene import Scene


def drive_of_scene(scene: Scene) -> Drive:
    """Return the scene as a drive: its tables with the names and ids that its MCAP would give, and its map."""
    content = sha256(osi_mcap(scene)).hexdigest()
    path = Path(f"{scene.name}.mcap")
    identity = Identity(f"{scene.name}-{content[:8]}", path.name, content)
    trace = finish_trace(path, identity, Recording("osi-mcap", states(scene), ego_ids=[str(HOST_ID)]), IngestOptions())
    return Drive(trace, load_map(MapSource(f"{scene.map_name}.xodr", scene.map_text.encode())))
