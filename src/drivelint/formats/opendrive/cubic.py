"""Piecewise cubic polynomials, the way OpenDRIVE describes every profile along a road."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drivelint.formats.opendrive.xml import number

if TYPE_CHECKING:
    from collections.abc import Iterable

    from lxml import etree

    from drivelint.arrays import Floats


@dataclass(frozen=True, eq=False)
class Cubics:
    """Records a + b ds + c ds^2 + d ds^3, ds counted from each record's start; 0 before the first record."""

    start: Floats  # (n,) road station, ascending
    coef: Floats  # (n, 4)

    def evaluate(self, s: Floats, at: Floats) -> tuple[Floats, Floats]:
        """Return values and first derivatives at stations `s`, taking the records that hold at stations `at`.

        `at` differs from `s` at the ends of a section, where the record on the section's own side is wanted.
        """
        if not len(self.start):
            return np.zeros_like(s), np.zeros_like(s)
        k = np.searchsorted(self.start, at, side="right") - 1
        before = k < 0
        k = np.maximum(k, 0)
        ds = s - self.start[k]
        a, b, c, d = self.coef[k].T
        value = ((d * ds + c) * ds + b) * ds + a
        slope = (3 * d * ds + 2 * c) * ds + b
        if before.any():
            value, slope = np.where(before, 0.0, value), np.where(before, 0.0, slope)
        return value, slope


def cubics(elements: Iterable[etree._Element], station: str, origin: float = 0.0) -> Cubics:
    """Read polynomial records; `station` is the attribute with their start, `origin` what it counts from.

    Of records with the same start the last one holds.
    """
    rows = [(origin + number(e, station, 0.0), *(number(e, c, 0.0) for c in "abcd")) for e in elements]
    rows.sort(key=lambda row: row[0])
    table = np.array(rows, dtype=np.float64).reshape(-1, 5)
    return Cubics(table[:, 0].copy(), table[:, 1:].copy())
