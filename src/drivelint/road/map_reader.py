"""Defines the types of the input and the output of a map reader, for all map formats."""

from __future__ import annotations

from dataclasses import dataclass, field
from hashlib import sha256
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pyarrow as pa


@dataclass(frozen=True)
class MapSource:
    """The input of a map reader: the bytes of a map, from a file or a log."""

    name: str  # the file name; a fixed name for a map in a log
    content: bytes = field(repr=False)

    @property
    def sha256(self) -> str:
        """The hash of the content, hexadecimal."""
        return sha256(self.content).hexdigest()


@dataclass(frozen=True)
class MapOptions:
    """The options for reading a map: offset, driving side, origin.

    `offset` (metres) is added to all coordinates. `side`: the driving side that the user gives (lht, rht). `voted_handedness`: the side for
    which the lanes' directions fit the traces (lht, rht; see `MapTables.lanes`), used only if neither option nor map decides. `origin`:
    latitude and longitude (degrees) of the point that is 0,0 in the log, for maps in degrees.
    """

    offset: tuple[float, float] = (0.0, 0.0)
    side: str | None = None
    voted_handedness: str | None = None
    origin: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class MapTables:
    """A map as tables: every table of `schemas/map.sql`, with exactly its columns and types, and sorted rows.

    `lanes`: the side (lht, rht) that was assumed to find the lanes' directions; on one-way roads it may differ from the driving side. None:
    the map states each lane's direction. `lanes_source`: the source of `lanes`, with the words of `handedness_source`; `default` is a guess
    that the traces may correct. `nation`: the country of all roads of the map, as two letters; None: unknown.
    """

    environment_id: str
    handedness: str  # lht | rht
    handedness_source: str  # option | attribute | junctions | traces | default
    tables: dict[str, pa.Table] = field(repr=False)
    lanes: str | None = None
    lanes_source: str | None = None
    nation: str | None = None
