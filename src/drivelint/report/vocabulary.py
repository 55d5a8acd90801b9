"""What a log can say and what a map must have, for the catalogue page: the words, and the rules that ask for them.

Words come from where they are read; which rules ask for one follows from what they require and from their SQL.
"""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any, Final

from drivelint.drive.conditions import CONDITION_TEXTS, DRIVE_CONDITION_VALUES
from drivelint.drive.declared_events import EVENTS, ON_OFF_EVENTS
from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS, SIGNAL_STATES
from drivelint.road.signcodes import codes_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from drivelint.catalogue import Rule
    from drivelint.drive.declared_events import DeclaredEvent

_MANY = 8  # rules; more are counted
_GIVEN = ("ego_condition", "drive_condition")
_COMMENT = re.compile(r"--.*")
COLUMN_VALUES: Final = {
    "actor_class": ACTOR_CLASSES,
    "indicator": INDICATORS,
    "brake_light": BRAKE_LIGHTS,
    "state of a signal": SIGNAL_STATES,
}
"""Column -> its allowed values."""


@cache
def map_features() -> dict[str, Any]:
    """Return what stands in `map_features.toml`: `name_parts` of signals, and each `feature`."""
    return tomllib.loads((files(__package__) / "map_features.toml").read_text(encoding="utf-8"))


def _sign(kind: str, name_part: str) -> str:
    """Return how a signal of this kind is recognised."""
    codes = "; ".join(f"{country} {', '.join(numbers)}" for country, numbers in codes_of(kind).items())
    return f"`signal` {codes}; or {name_part} in its name"


def condition_table(rules: Sequence[Rule]) -> list[tuple[str, Sequence[str], str, str]]:
    """Return a row per condition: its words, what they say, which rules ask for it."""
    return [
        (name, known, CONDITION_TEXTS[name], "all" if name == "engaged" else _ids(_asking(rules, (name,), _GIVEN)))
        for name, known in DRIVE_CONDITION_VALUES.items()
    ]


def event_table(rules: Sequence[Rule]) -> list[tuple[str, DeclaredEvent, str]]:
    """Return a row per declared event: its value, what it says, which rules ask for it."""
    rows = []
    for name, event in EVENTS.items():
        asking = _asking(rules, (f"'{name}'",), ("ego_mode",) if name in ON_OFF_EVENTS else ("declared_event",))
        rows.append((name, event, "all" if name == "engaged" else _ids(asking)))
    return rows


def map_feature_table(rules: Sequence[Rule]) -> list[tuple[str, str, str]]:
    """Return a row per feature of a map: how OpenDRIVE says it, which rules ask for it."""
    signs = {kind: _sign(kind, part) for kind, part in map_features()["name_parts"].items()}
    return [
        (f["name"], f["drawn"].format_map(signs), _ids(_asking(rules, f["asked"], f.get("reads", ()))))
        for f in map_features()["feature"]
    ]


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
