"""Pictures of a log's own cameras: what they add to a check of a bag with two cameras and twenty findings."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import drivelint
from tests.bench.clock import repeat
from tests.bench.table import Bar, Row, Skipped

if TYPE_CHECKING:
    from pathlib import Path

    from tests.bench.place import Place

MOST_RATIO = 1.1
"""CPU of a run with pictures, by that of one without, at most (issue 47)."""


def pictures(place: Place) -> list[Row]:
    """Measure checks with and without pictures, of plain frames and of noise, which no encoder makes small."""
    try:
        from tests.pictures.camera_bag import write_bag
    except ImportError as error:
        raise Skipped(f"{error}: pip install rosbags") from error
    rows = []
    for what, noise in (("plain frames", False), ("noise", True)):
        bag = write_bag(place.home / what.replace(" ", "-"), noise=noise, contacts=20)
        _check(bag, place.home / "shown", True)  # what is imported and parsed once is no part of it
        cpu = [
            repeat(partial(_check, bag, place.home / "shown", shown), place.sizes.slow_runs).cpu
            for shown in (True, False)
        ]
        note = f"{cpu[0]:.2f} s of CPU with pictures, {cpu[1]:.2f} s without"
        rows.append(Row("pictures", what, cpu[0] / cpu[1], "x", bar=Bar(MOST_RATIO), note=note))
    return rows


def _check(bag: Path, out: Path, with_pictures: bool) -> None:
    drivelint.check(bag, out=out, overwrite=True, ego_size="4.5,1.8", pictures=with_pictures)
