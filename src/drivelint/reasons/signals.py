"""Describes how to provide a signal that rules require, and by reason code what would decide an unknown verdict."""

from __future__ import annotations

from typing import Final

from drivelint.drive.conditions import CONDITION_TEXTS, CONDITION_VALUES, DRIVE_CONDITION_VALUES
from drivelint.drive.declared_events import ON_OFF_EVENTS
from drivelint.facts import toml_beside
from drivelint.phrases import hint

TEXTS: Final = toml_beside(__file__, "signals.toml")
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
"""The signals that a rule may require: those of the table `capability`. The others are conditions of a drive."""
MISSING_PREFIX: Final = "missing_"
"""Begins the reason code of a rule that is unknown for want of a signal."""
UNRECORDED_PREFIX: Final = "unrecorded_"
"""Begins the reason code of a rule that is not applicable because the log has nothing of a signal that few logs have."""
SIGNALS_OF_FEW_LOGS: Final = {
    "indicator", "brake_light", "declared_events", "modes", *(f"mode_{mode}" for mode in ON_OFF_EVENTS)
}  # fmt: skip
"""What the ego itself would have to record: a rule that needs it asks nothing of a log that has none, unless it is asked for by its id."""
SIGNAL_OF_CONDITION: Final = {"road_type": "road_types", "limit": "speed_limits"}
"""Conditions that the map gives under another name."""
WHAT_IS_NULL: Final = "what is NULL, or has no row, in the rows that it was judged on"
"""The remedy of a reason that has none of its own: the verdict's own words say more."""
_A_MAP_THAT_GOES_ON = "a map that goes on, or a longer --sensor-range of check"
_AGAIN = "; run drivelint check with it: what else the rule needs is not looked at before"
REMEDIES: Final[dict[str, str]] = TEXTS["remedies"]


def signal_name(reason_code: str) -> str:
    """Return in words the signal that a verdict lacks, or the reason code of one that lacks none."""
    return (
        reason_code.removeprefix(MISSING_PREFIX).removeprefix(UNRECORDED_PREFIX).removeprefix("mode_").replace("_", " ")
    )


def problem(signal: str) -> str | None:
    """Return the problem of the name of a signal; None: it is one."""
    if signal in SIGNALS:
        return None
    return f"{signal!r} is no signal; {hint(signal, sorted(SIGNALS))}"


def how_to_provide(signal: str, log_format: str, advice: str | None = None) -> str:
    """Return how to provide a signal in a log of this format. `advice`: that of the reason why it is missing."""
    if signal == "registration" and advice:
        return advice  # the map is not at fault
    from drivelint.formats.registry import format_words  # the readers, which the catalogue needs not

    name = "mapped" if format_words(log_format) is None else log_format
    # what a format cannot hold is given in the Parquet tables of a converted log
    tables = TEXTS["where"]["canonical-parquet"].items()
    where = {key: f"drivelint convert --to parquet, and in its tables {table}" for key, table in tables}
    where |= TEXTS["where"].get(name, {})
    return ADVICE.get(signal, "see what the rules that need it say: drivelint rules show ID").format_map(where)


def remedy(code: str, object_id: str | None, log_format: str, advice: str | None = None) -> str:
    """Return what would decide an unknown verdict with this reason code, for a log of this format. `advice`: that of its cause."""
    if code.startswith((MISSING_PREFIX, UNRECORDED_PREFIX)) and code not in REMEDIES:
        return (
            how_to_provide(code.removeprefix(MISSING_PREFIX).removeprefix(UNRECORDED_PREFIX), log_format, advice)
            + _AGAIN
        )
    condition = code.removesuffix("_unknown")
    if condition in DRIVE_CONDITION_VALUES or condition == "limit":
        return (
            how_to_provide({**SIGNAL_OF_CONDITION, "engaged": "mode_engaged"}.get(condition, condition), log_format)
            + _AGAIN
        )
    return REMEDIES.get(code, "{advice}").format(
        object="the object" if object_id is None else f"object {object_id}",
        advice=advice or (_A_MAP_THAT_GOES_ON if code == "only_a_bound" else WHAT_IS_NULL),
    )


def condition_of(code: str) -> str | None:
    """Return the column of `ego_condition` that a reason code says is not known; None: it is about none."""
    condition = code.removesuffix("_unknown")
    if condition == code:
        return None
    return condition if condition in DRIVE_CONDITION_VALUES else "limit_mps" if condition == "limit" else None
