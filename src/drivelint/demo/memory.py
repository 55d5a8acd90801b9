"""A scene as what ingest makes of its log and its map, without files: for tests and for whoever wants tables at once."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

from drivelint.demo.osi_log import mcap
from drivelint.demo.states import HOST_ID, states
from drivelint.drive.finish import finish
from drivelint.drive.trace import Identity, IngestOptions, Recording
from drivelint.engine.batch import Drive
from drivelint.formats import load_map
from drivelint.road.contract import MapSource

if TYPE_CHECKING:
    from drivelint.demo.scene import Scene


def drive(scene: Scene) -> Drive:
    """Return the scene as a drive: its tables with the names and ids that its MCAP would give, and its map."""
    content = sha256(mcap(scene)).hexdigest()
    path = Path(f"{scene.name}.mcap")
    identity = Identity(f"{scene.name}-{content[:8]}", path.name, content)
    trace = finish(path, identity, Recording("osi-mcap", states(scene), ego_ids=[str(HOST_ID)]), IngestOptions())
    return Drive(trace, load_map(MapSource(f"{scene.map_name}.xodr", scene.map_text.encode())))
