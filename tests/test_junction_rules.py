"""Rules on junctions, crossings, stopping and lights over whole scenes: what is planted is found, and nothing else."""

from __future__ import annotations

from functools import cache

import pytest

from tests.crossroads import scenes
from tests.scenes import judged

RULES = tuple(
    f"ukhc.{name}"
    for name in (
        "h2.turn-pedestrian", "h3.no-cut-across", "r112.horn", "r113.headlights", "r115.dipped-headlights", "r116.hazards",
        "r151.side-roads-clear", "r171.safe-gap",
        "r171.stop-sign", "r172.give-way", "r174.box", "r175.amber", "r175.red", "r176.green-exit-clear",
        "r180.corner-cut", "r180.right-turn-gap", "r182.no-pass-before-turn", "r183.keep-in", "r191.no-stopping",
        "r192.keep-clear", "r195.zebra-on", "r195.zebra-waiting", "r196.pelican", "r198.still-crossing",
        "r201.reverse-out", "r239.parked-with-traffic", "r240.no-stopping", "r243.junction-10m", "r248.parked-at-night",
        "r263.no-reverse",
    )
)  # fmt: skip


@cache
def failed(hand: str) -> dict[str, set[str]]:
    """Return drive -> the rules that failed; all drives in one batch."""
    made = [make(name) for name, (make, _) in scenes(hand).items()]
    found: dict[str, set[str]] = {drive.trace.drive_id: set() for drive in made}
    for row in judged(made, rules=RULES):
        assert row["verdict"] != "error", row
        if row["verdict"] == "fail":
            found[row["drive_id"]].add(row["rule_id"].removeprefix("ukhc."))
    return found


@pytest.mark.parametrize("hand", ["lht", "rht"])
@pytest.mark.parametrize("name", list(scenes("lht")))
def test_what_is_planted_is_found_and_nothing_else(name: str, hand: str) -> None:
    assert failed(hand)[name] == set(scenes(hand)[name][1])
