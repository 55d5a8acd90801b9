"""Says how to provide a signal that rules require."""

from __future__ import annotations

from typing import Final

from drivelint.drive.conditions import CONDITION_TEXTS, CONDITION_VALUES
from drivelint.drive.declared_events import ON_OFF_EVENTS
from drivelint.formats.registry import FORMATS
from drivelint.phrases import hint
from drivelint.resources import facts

TEXTS: Final = facts(__file__, "signals.toml")
"""`advice`: signal -> what to give; `remedies`: reason code -> what to do; `where`: format -> key -> where its logs have it."""
ADVICE: Final[dict[str, str]] = {
    **{
        name: f"{CONDITION_TEXTS[name].partition(';')[0]}: --env {name}={words[0]} ({', '.join(words[1:])})"
        for name, words in CONDITION_VALUES.items()
    },
    **{
        f"mode_{mode}": f"when {mode} is on, as declared events {mode} with the values on and off: {{declared_events}}"
        for mode in ON_OFF_EVENTS
    },
    **TEXTS["advice"],
}
SIGNALS: Final = ADVICE.keys() - CONDITION_VALUES.keys()
"""What a rule may require: the signals of the table `capability`. The others are conditions of a drive."""
SIGNAL_OF_CONDITION: Final = {"road_type": "road_types", "limit": "speed_limits"}
"""Conditions that the map gives under another name."""


def problem(signal: str) -> str | None:
    """Return what is wrong with the name of a signal; None: it is one."""
    if signal in SIGNALS:
        return None
    return f"{signal!r} is no signal; {hint(signal, sorted(SIGNALS))}"


def how_to_provide(signal: str, log_format: str) -> str:
    """Return how to provide a signal in a log of this format."""
    name = log_format if log_format in FORMATS else "mapped"
    # what a format has no place for goes into its tables
    tables = TEXTS["where"]["canonical-parquet"].items()
    where = {key: f"drivelint convert --to parquet, and in its tables {table}" for key, table in tables}
    where |= TEXTS["where"].get(name, {})
    return ADVICE.get(signal, "see what the rules that need it say: drivelint rules show ID").format_map(where)
