"""Defines what a map reader takes and returns, for all map formats."""

from __future__ import annotations

from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import PurePath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pyarrow as pa


@dataclass(frozen=True)
class MapSource:
    """What is to be read: the bytes of a map, wherever they came from."""

    name: str  # file name, or the log it was embedded in
    content: bytes = field(repr=False)

    @property
    def sha256(self) -> str:
        """Hash of the content, hexadecimal."""
        return sha256(self.content).hexdigest()


@dataclass(frozen=True)
class MapOptions:
    """The options for reading a map: offset, driving side, origin.

    `offset` in metres is added to all coordinates; `handedness` is the user's option (auto, lht, rht); `voted_handedness` is the side
    by whose rule the lanes run as the traces drive (lht, rht; see `MapTables.lanes`), used only where neither option nor map decides.
    `origin`: latitude and longitude (degrees) of the point that is 0,0 in the log, for maps that lie on the globe.
    """

    offset: tuple[float, float] = (0.0, 0.0)
    handedness: str = "auto"
    voted_handedness: str | None = None
    origin: tuple[float, float] | None = None

    @property
    def side(self) -> str | None:
        """The side driven on that the user gives, lht or rht."""
        return None if self.handedness == "auto" else self.handedness


@dataclass(frozen=True)
class MapTables:
    """A map as rows: every table of `schemas/map.sql`, its columns and types exactly, rows totally ordered.

    `lanes`: the side (lht, rht) by whose rule the lanes' directions were read, which on roads of one direction alone need not be
    the side that is driven on; None: the map gives each lane's direction. `lanes_source` tells how it was found, as
    `handedness_source` does; default: a guess that the traces may correct.
    """

    environment_id: str
    handedness: str  # lht | rht
    handedness_source: str  # option | attribute | junctions | traces | default
    tables: dict[str, pa.Table] = field(repr=False)
    lanes: str | None = None
    lanes_source: str | None = None


def environment_id(
    source: MapSource,
    offset: tuple[float, float],
    handedness: str,
    *,
    guessed: bool = False,
    lanes_reversed: bool = False,
) -> str:
    """Return `<map stem>-<first 8 hex of sha256><offset, if any>@<lht or rht>`; the same on every machine.

    A handedness that is only the standard's default has a question mark: the traces of another drive may tell it for sure.
    `lanes_reversed`: the lanes run the other way than its rule says, which the traces may have told; then the id ends in a tilde.
    """
    x, y = (float(v) + 0.0 for v in offset)
    shift = f"{x:+}{y:+}" if x or y else ""
    marks = f"{'?' if guessed else ''}{'~' if lanes_reversed else ''}"
    return f"{PurePath(source.name).stem}-{source.sha256[:8]}{shift}@{handedness}{marks}"
