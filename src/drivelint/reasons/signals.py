"""Describes how to provide the signals that rules require, and, for each reason code, what would decide an unknown verdict."""

from __future__ import annotations

from typing import Final

from drivelint.drive.conditions import CONDITION_TEXTS, DRIVE_CONDITION_VALUES, RULE_CONDITION_VALUES
from drivelint.drive.declared_events import ON_OFF_EVENTS
from drivelint.facts import toml_beside
from drivelint.phrases import hint

TEXTS: Final = toml_beside(__file__, "signals.toml")
"""`advice`: signal -> what to provide. `remedies`: reason code -> what to do. `where`: format -> key -> its place in such a log."""
ADVICE: Final[dict[str, str]] = {
    **{
        name: f"{CONDITION_TEXTS[name].partition(';')[0]}: --env {name}={words[0]} ({', '.join(words[1:])})"
        for name, words in RULE_CONDITION_VALUES.items()
    },
    **{
        f"mode_{mode}": f"when {mode} is on, as declared events {mode} with the values on and off: {{declared_events}}"
        for mode in ON_OFF_EVENTS
    },
    **TEXTS["advice"],
}
SIGNALS: Final = ADVICE.keys() - RULE_CONDITION_VALUES.keys()
"""The signals that a rule may require, as in the table `capability`; the other keys of `ADVICE` are conditions of a drive."""
MISSING_PREFIX: Final = "missing_"
"""The prefix of the reason code of a rule that is unknown because a signal is missing."""
UNRECORDED_PREFIX: Final = "unrecorded_"
"""The prefix of the reason code of a rule that is not applicable because the log lacks one of `SIGNALS_OF_FEW_LOGS`."""
SIGNALS_OF_FEW_LOGS: Final = {
    "indicator", "brake_light", "declared_events", "modes", *(f"mode_{mode}" for mode in ON_OFF_EVENTS)
}  # fmt: skip
"""Signals that only the ego itself can record. If the log lacks one, a rule that needs it is not applicable; it is unknown if the user
selected the rule by its id."""
SIGNAL_OF_CONDITION: Final = {"road_type": "road_types", "limit": "speed_limits"}
"""Condition -> the signal of the map that provides it, if its name differs."""
DEFAULT_REMEDY: Final = "what is NULL, or has no row, in the rows that it was judged on"
"""The remedy for a reason code without one; the text of the verdict is more specific."""
_MORE_DATA = "a map that goes on, or a longer --sensor-range of check; for a duration, a log that begins earlier"
_AGAIN = "; run drivelint check with it: what else the rule needs is not looked at before"
REMEDIES: Final[dict[str, str]] = TEXTS["remedies"]


def signal_name(reason_code: str) -> str:
    """Return the name of the missing signal in a reason code, or the code itself, with spaces for underscores."""
    return missing_signal(reason_code).removeprefix("mode_").replace("_", " ")


def missing_signal(reason_code: str) -> str:
    """Return the missing signal in a reason code, or the code itself."""
    return reason_code.removeprefix(MISSING_PREFIX).removeprefix(UNRECORDED_PREFIX)


def unknown_signal_message(signal: str) -> str | None:
    """Return why this is not the name of a signal, with a hint; None: it is valid."""
    if signal in SIGNALS:
        return None
    return f"{signal!r} is no signal; {hint(signal, sorted(SIGNALS))}"


def how_to_provide(signal: str, log_format: str, advice: str | None = None) -> str:
    """Return how to provide a signal in a log of this format. `advice`: the advice of the reason why it is missing."""
    if signal == "registration" and advice:
        return advice  # the reason shows that the map is not the problem
    from drivelint.formats.registry import format_title_and_ego  # loads the readers, which the catalogue does not need

    name = "mapped" if format_title_and_ego(log_format) is None else log_format
    # a signal that the format cannot contain can be added to the Parquet tables of a converted log
    tables = TEXTS["where"]["canonical-parquet"].items()
    where = {key: f"drivelint convert --to parquet, and in its tables {table}" for key, table in tables}
    where |= TEXTS["where"].get(name, {})
    return ADVICE.get(signal, "see what the rules that need it say: drivelint rules show ID").format_map(where)


def remedy(code: str, object_id: str | None, log_format: str, advice: str | None = None) -> str:
    """Return what would decide a verdict with this reason code, for a log of this format. `advice`: its cause's advice."""
    if code.startswith((MISSING_PREFIX, UNRECORDED_PREFIX)) and code not in REMEDIES:
        return how_to_provide(missing_signal(code), log_format, advice) + _AGAIN
    condition = code.removesuffix("_unknown")
    if condition in DRIVE_CONDITION_VALUES or condition == "limit":
        return (
            how_to_provide({**SIGNAL_OF_CONDITION, "engaged": "mode_engaged"}.get(condition, condition), log_format)
            + _AGAIN
        )
    return REMEDIES.get(code, "{advice}").format(
        object="the object" if object_id is None else f"object {object_id}",
        advice=advice or (_MORE_DATA if code == "only_a_bound" else DEFAULT_REMEDY),
    )


def unknown_condition_column(code: str) -> str | None:
    """Return the column of `ego_condition` that is unknown according to this reason code; None: the code is not about a condition."""
    condition = code.removesuffix("_unknown")
    if condition == code:
        return None
    return condition if condition in DRIVE_CONDITION_VALUES else "limit_mps" if condition == "limit" else None
