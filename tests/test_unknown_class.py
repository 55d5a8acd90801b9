"""An unknown class is any class: whoever loses its class turns verdicts into unknown, and makes none of them a pass or a fail."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pytest

from tests import blinding
from tests.clean.blinded import on_the_road
from tests.clean.judging import PACKS, stable, story_drive
from tests.clean.planted import PLANTED
from tests.scenes import verdict_rows

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.engine.batch import Drive

UNSAID = (None, "object", "vehicle")
CHAPTERS = sorted({(p.nation, p.chapter) for p in PLANTED if p.chapter})
# what is planted between the ego and somebody else
BETWEEN = {
    *(
        "gap",
        "gap_s",
        "oncoming_m",
        "oncoming_s",
        "behind_m",
        "ahead_m",
        "clearance",
        "horse",
        "aside",
        "forced",
        "speeds_up",
    ),
    *("goes_on", "walker", "walker_s", "cyclist_s", "passes", "blocked", "yields", "queue"),
}
# An animal is not overtaken, a vehicle is: of one that may be either, what the ego did to the others on the road is judged all the same.
OVERTAKING = {
    "declared.r162.go-before-overtaking",
    "declared.r166.confidence-at-commit",
    "ukhc.r126.ds-vbp-out-of-av",
    "ukhc.r128.back-before-solid",
    "ukhc.r162.not-being-overtaken",
    "ukhc.r162.return-gap",
}


def classed(drive: Drive, actor_id: str, word: str | None) -> Drive:
    """Return the drive with this class of an actor."""

    def change(actors: pa.Table) -> pa.Table:
        rows = [row | {"actor_class": word} if row["actor_id"] == actor_id else row for row in actors.to_pylist()]
        return pa.Table.from_pylist(rows, schema=actors.schema)

    return blinding.change_table(drive, "actor", change)


def unsaid(drive: Drive) -> Iterator[tuple[str, Drive]]:
    """Return the drive with one other's class not said, in every way in which less can be said than it is."""
    for actor in drive.trace.tables["actor"].to_pylist():
        for word in UNSAID:
            walks = word == "vehicle" and actor["actor_class"] in {"pedestrian", "animal"}
            if actor["actor_id"] != "ego" and not walks:
                yield f"{actor['actor_id']} {word}", classed(drive, actor["actor_id"], word)


@pytest.mark.ci
@pytest.mark.parametrize(
    ("nation", "chapter"),
    [
        pytest.param(*one, marks=[] if one == ("gb", "zebra") else [pytest.mark.slow], id="-".join(one))
        for one in CHAPTERS
    ],
)
def test_no_pass_and_no_fail_from_a_class_that_is_not_known(nation: str, chapter: str) -> None:
    """Everybody in a chapter and in what is planted there, by every stable rule."""
    changes: list[dict[str, Any]] = [{}]
    for planted in PLANTED:
        about = (planted.nation, planted.chapter) == (nation, chapter) and BETWEEN & planted.change.keys()
        if about and planted.change not in changes:
            changes.append(planted.change)
    drives = []
    for n, change in enumerate(changes):
        whole = on_the_road(story_drive("d", nation, [chapter], change))
        drives.append(blinding.renamed(whole, f"{n}/"))
        drives += [blinding.renamed(less, f"{n}/{what}") for what, less in unsaid(whole)]
    said: dict[str, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for row in verdict_rows(drives, rules=stable(PACKS[nation])):
        said[row["drive_id"]][row["rule_id"]].add(row["verdict"])
    wrong = []
    for name, rules in said.items():
        for rule, now in rules.items():
            was = said[name.partition("/")[0] + "/"][rule]
            new = now - was - {"unknown", "not_applicable"}
            if rule in OVERTAKING and was == {"not_applicable"}:
                new -= {"pass"}
            lost = was & {"fail"} and not now & {"fail", "unknown"}
            if new or lost:
                wrong.append((changes[int(name.partition("/")[0])], name, rule, was, now))
    assert not wrong
