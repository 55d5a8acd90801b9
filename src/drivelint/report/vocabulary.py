"""What a log can say and what a map must have, for the catalogue page: the words, and the rules that ask for them.

Words come from where they are read; which rules ask for one follows from what they require and from their SQL.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from drivelint.drive.conditions import CONDITION_TEXTS, DRIVE_CONDITION_VALUES
from drivelint.drive.declared_events import EVENTS, ON_OFF_EVENTS
from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS, SIGNAL_STATES
from drivelint.road.signcodes import codes_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.catalogue import Rule

Table = tuple[tuple[str, ...], Sequence[Sequence[str]]]
"""Head and rows."""
_MANY = 8  # rules; more are counted
_GIVEN = ("ego_condition", "drive_condition")
_COMMENT = re.compile(r"--.*")


class MapFeature(NamedTuple):
    """A feature that a map may have: how OpenDRIVE expresses it, and which signals or words of SQL show that a rule needs it.

    `asked`: signals that a rule requires, or words of its SQL; `reads`: tables of which it must read one, if any are named.
    """

    name: str
    drawn: str
    asked: tuple[str, ...]
    reads: tuple[str, ...] = ()


SIGNAL_NAME_PARTS = {
    "traffic_light": "traffic_light",
    "stop_line": "stop_line",
    "stop": "stop",
    "give_way": "give_way",
    "no_overtaking": "no_overtaking",
    "no_overtaking_end": "overtaking_end",
    "exit": "exit",
}
"""Kind of signal -> a word in its name by which it is recognised too."""


def _sign(kind: str) -> str:
    """Return how a signal of this kind is recognised."""
    codes = "; ".join(f"{country} {', '.join(numbers)}" for country, numbers in codes_of(kind).items())
    return f"`signal` {codes}; or {SIGNAL_NAME_PARTS[kind]} in its name"


_WAYS_IN = ("stop_line_crossing", "junction_passage", "traffic_signal")
MAP_FEATURES = (
    MapFeature("side driven on", '`rule="LHT"` or `"RHT"` of each `road`', ("handedness",)),
    MapFeature("speed limit", "`speed` of a road's `type`, or of a lane", ("speed_limits", "limit_mps")),
    MapFeature("kind of road", "`type` of a `road`: motorway, rural, town, ...", ("road_types", "road_type")),
    MapFeature(
        "lines", "`roadMark` of lane 0 and of the lanes: broken, solid, `solid solid`, `broken solid`", ("markings",)
    ),
    MapFeature(
        "footway, shoulder", "lanes of the type sidewalk, walking, curb, border, shoulder", ("lane_types", "'shoulder'")
    ),
    MapFeature(
        "junction", "`junction`, with a `connection` and its `laneLink` for every way through", ("junction_passage",)
    ),
    MapFeature(
        "traffic light",
        f"{_sign('traffic_light')}. It holds for the lanes of its `validity` and `orientation`, and governs a stop line within 30 m; "
        "its `id` is the log's `signal_id`",
        ("traffic_lights",),
    ),
    MapFeature(
        "stop line",
        f"{_sign('stop_line')}; or `object` of the type stopLine, or stopline in its name; across half of the lane or more",
        ("stop_lines", "stop_line_crossing"),
    ),
    MapFeature("stop sign", f"{_sign('stop')}; within 30 m of its stop line", ("'stop'",), _WAYS_IN),
    MapFeature("give-way sign", f"{_sign('give_way')}; at most 50 m before the junction", ("'give_way'",), _WAYS_IN),
    MapFeature(
        "no-overtaking sign", f"{_sign('no_overtaking')}. Its end: {_sign('no_overtaking_end')}", ("no_overtaking",)
    ),
    MapFeature("exit", f"lane of the type exit or offRamp; {_sign('exit')}; on the lane beside it", ("exit_signs",)),
    MapFeature(
        "pedestrian crossing",
        "`object` of the type crosswalk, or crosswalk or zebra in its name; with an outline, or `length` and `width`, across the lanes",
        ("crossing_passage", "crossing_id"),
    ),
    MapFeature(
        "zebra",
        "a crossing with **zebra in its `name` or `subtype`**; any other may be one, and whether way was due is then not known",
        ("'zebra'",),
    ),
    MapFeature(
        "signalled crossing",
        "a crossing with signal in its `name` or `subtype`, or with a traffic light from 15 m before to 30 m behind it",
        ("'signalled'",),
    ),
    MapFeature(
        "island on a crossing",
        "not read: a wait of over 3 s between the two halves counts as one; whether one parts them is else not known",
        ("coming_id",),
    ),
)


def column_value_lines() -> list[str]:
    """Return one line per column that lists its allowed values."""
    known = (
        ("actor_class", ACTOR_CLASSES),
        ("indicator", INDICATORS),
        ("brake_light", BRAKE_LIGHTS),
        ("state of a signal", SIGNAL_STATES),
    )
    return [f"* `{name}`: {', '.join(said)}" for name, said in known]


def condition_table(rules: Sequence[Rule]) -> Table:
    """Return a row per condition: its words, what they say, which rules ask for it."""
    rows = [
        (
            f"`{name}`",
            ", ".join(f"`{word}`" for word in known),
            CONDITION_TEXTS[name],
            "all" if name == "engaged" else _ids(_asking(rules, (name,), _GIVEN)),
        )
        for name, known in DRIVE_CONDITION_VALUES.items()
    ]
    return ("condition", "values", "says", "asked for by"), rows


def event_table(rules: Sequence[Rule]) -> Table:
    """Return a row per declared event: its value, what it says, which rules ask for it."""
    rows = []
    for name, event in EVENTS.items():
        asking = _asking(rules, (f"'{name}'",), ("ego_mode",) if name in ON_OFF_EVENTS else ("declared_event",))
        rows.append((f"`{name}`", event.value, event.says, "all" if name == "engaged" else _ids(asking)))
    return ("event", "value", "says", "asked for by"), rows


def map_feature_table(rules: Sequence[Rule]) -> Table:
    """Return a row per feature of a map: how OpenDRIVE says it, which rules ask for it."""
    rows = [(f.name, f.drawn, _ids(_asking(rules, f.asked, f.reads))) for f in MAP_FEATURES]
    return ("what", "in OpenDRIVE", "asked for by"), rows


def _asking(rules: Iterable[Rule], asked: Sequence[str], reads: Sequence[str] = ()) -> list[Rule]:
    """Return the rules that require or are restricted by one of these, or read one of the tables and name one in their SQL."""
    named = re.compile("|".join(rf"(?<!\w){re.escape(word)}(?!\w)" for word in asked))
    return [
        rule
        for rule in rules
        if not {*rule.requires, *rule.applies.restricting}.isdisjoint(asked)
        or ((not reads or not {*rule.reads}.isdisjoint(reads)) and named.search(_sql(rule)))
    ]


def _sql(rule: Rule) -> str:
    return _COMMENT.sub("", "\n".join(rule.sections.values()))


def _ids(rules: Sequence[Rule]) -> str:
    """Return the rules' ids, or how many there are."""
    if len(rules) > _MANY:
        return f"{len(rules)} rules"
    return ", ".join(f"`{rule.id}`" for rule in sorted(rules, key=lambda rule: rule.id)) or "no rule yet"
