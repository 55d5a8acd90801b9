"""Defines the input and the output of a map reader, for all map formats."""

from __future__ import annotations

from dataclasses import dataclass, field
from hashlib import sha256
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pyarrow as pa


@dataclass(frozen=True)
class MapSource:
    """The input of a map reader: the bytes of a map, wherever they came from."""

    name: str  # file name, or the log it was embedded in
    content: bytes = field(repr=False)

    @property
    def sha256(self) -> str:
        """Hash of the content, hexadecimal."""
        return sha256(self.content).hexdigest()


@dataclass(frozen=True)
class MapOptions:
    """The options for reading a map: offset, driving side, origin.

    `offset` in metres is added to all coordinates; `side` is the driving side that the user gives (lht, rht), `voted_handedness` the side
    by whose rule the lanes run as the traces drive (lht, rht; see `MapTables.lanes`), used only where neither option nor map decides.
    `origin`: latitude and longitude (degrees) of the point that is 0,0 in the log, for maps that lie on the globe.
    """

    offset: tuple[float, float] = (0.0, 0.0)
    side: str | None = None
    voted_handedness: str | None = None
    origin: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class MapTables:
    """A map as rows: every table of `schemas/map.sql`, its columns and types exactly, rows totally ordered.

    `lanes`: the side (lht, rht) by whose rule the lanes' directions were read, which on roads of one direction alone need not be
    the side that is driven on; None: the map gives each lane's direction. `lanes_source` states how it was found, as
    `handedness_source` does; default: a guess that the traces may correct. `nation`: the country of all its roads, as two letters;
    None: the map does not say it.
    """

    environment_id: str
    handedness: str  # lht | rht
    handedness_source: str  # option | attribute | junctions | traces | default
    tables: dict[str, pa.Table] = field(repr=False)
    lanes: str | None = None
    lanes_source: str | None = None
    nation: str | None = None
