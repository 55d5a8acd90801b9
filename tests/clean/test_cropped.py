"""A map that ends is not a map that says no: planted drives on maps cut off before or behind what was planted."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests import blinding, cropping
from tests.clean.blinded import AFTER_S, BEFORE_S, STORIES, breach, on_the_road
from tests.scenes import verdict_rows

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.engine.batch import Drive
    from tests.blinding import Span
    from tests.clean.planted import Planted

PACKS = ("ukhc", "stvo", "alks-r157")  # what the others ask of needs no map but the lanes that the ego is on
CROPS = (
    20.0,
    -20.0,
)  # also tried: 5 and 100 m either way; every one is another map to prepare, which takes most of the time


def cropped(drive: Drive, span: Span) -> Iterator[tuple[str, Drive]]:
    """Return the drive on maps that end so far ahead of where the ego was at the end of a span, or begin so far behind it then.

    Each once as it is, and once cut to when the ego was on what is left of the map: else it may be that the map does not fit.
    """
    states = drive.trace.tables["actor_state"]
    mine = np.array(states["actor_id"].to_pylist()) == "ego"
    t, x, y, yaw = (states[c].to_numpy(zero_copy_only=False)[mine] for c in ("t_ns", "x_m", "y_m", "yaw_rad"))
    road = drive.environment
    assert road is not None
    for by in CROPS:
        k = int(np.argmin(np.abs(t / 1e9 - span[by > 0])))
        inside = cropping.beyond(float(x[k]), float(y[k]), float(yaw[k]), by)
        less = blinding.on(drive, cropping.cropped(road, f"{road.environment_id} {by}", inside))
        yield f"{by:+.0f}", less
        on = np.flatnonzero(inside(x, y))
        runs = [r for r in np.split(on, np.flatnonzero(np.diff(on) > 1) + 1) if k in r]
        yield f"{by:+.0f} cut", blinding.cut(less, (t[runs[0][0]] / 1e9, t[runs[0][-1]] / 1e9))


@cache
def chapter_verdicts(pack: str, chapter: str) -> dict[str, dict[str, set[str]]]:
    """Return the verdicts on what is planted in a chapter, by rule and how the map was cut."""
    drives: list[Drive] = []
    mine = [p for p in STORIES if (p.pack, p.chapter) == (pack, chapter)]
    for planted in mine:
        _, span = breach(planted)
        whole = on_the_road(planted.drives()[planted.rule]())
        part = blinding.cut(whole, (span[0] - BEFORE_S, span[1] + AFTER_S))
        drives += [blinding.renamed(one, f"{planted.rule}/{what}") for what, one in cropped(part, span)]
    verdicts: dict[str, dict[str, set[str]]] = {p.rule: {} for p in mine}
    for row in verdict_rows(drives, rules=list(verdicts)):
        rule, _, what = row["drive_id"].partition("/")
        if row["rule_id"] == rule:
            verdicts[rule].setdefault(what, set()).add(row["verdict"])
    return verdicts


# (rule, how the map was cut): why the rule need not be broken nor unknown any more
EVIDENCE: dict[tuple[str, str], str] = {}


@pytest.mark.slow
@pytest.mark.parametrize("planted", [p for p in STORIES if p.pack in PACKS], ids=lambda p: p.rule)
def test_what_was_broken_is_broken_or_unknown(planted: Planted) -> None:
    mine = chapter_verdicts(planted.pack, planted.chapter)[planted.rule]
    # what was planted may lie after the end of a log that was cut
    due = {True: {"fail", "unknown", "not_applicable"}, False: {"fail", "unknown"}}
    clear = {what: verdicts for what, verdicts in mine.items() if not verdicts & due["cut" in what]}
    assert clear.keys() == {what for rule, what in EVIDENCE if rule == planted.rule}, clear
