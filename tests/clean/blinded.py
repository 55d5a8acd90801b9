"""Planted drives of which an actor is hidden for a while."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow.compute as pc

from drivelint.engine.batch import Drive
from tests import blinding
from tests.clean.planted import PLANTED, Planted, planted_verdicts
from tests.clean.story import GARAGE_Y

if TYPE_CHECKING:
    from tests.blinding import Span
    from tests.scenes import Row

BEFORE_S, AFTER_S = 25.0, 17.0  # so much of each drive is looked at, before and after what was planted
LONG = ("ukhc.r239.parked-with-traffic", "ukhc.r248.parked-at-night")  # broken by standing for long

STORIES = [p for p in PLANTED if not p.scene and p.rule not in LONG]


def on_the_road(drive: Drive) -> Drive:
    """Return the drive without those who wait elsewhere for their chapter: far away they have a place, here they are to have none."""
    there = blinding.change_table(
        drive, "actor_state", lambda states: states.filter(pc.greater(states["y_m"], GARAGE_Y / 2))
    )
    left = pc.unique(there.trace.tables["actor_state"]["actor_id"])
    return blinding.change_table(there, "actor", lambda actors: actors.filter(pc.is_in(actors["actor_id"], left)))


def breach(planted: Planted) -> tuple[Row, Span]:
    """Return the (first) row that breaks the rule, and from when to when."""
    row = next(
        r
        for r in planted_verdicts(planted.pack)[planted.rule]
        if r["rule_id"] == planted.rule and r["verdict"] == "fail"
    )
    times = [row[t] / 1e9 for t in ("t_start_ns", "t_end_ns", "t_ref_ns") if row[t] is not None]
    return row, (min(times), max(times))
