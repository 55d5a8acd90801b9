"""Finds the rules that a log and a map cannot decide, and the missing signals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.inspect.model import MissingSignal, Undecided
from drivelint.reasons.signals import SIGNAL_OF_CONDITION, how_to_provide

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.catalogue import Rule

SIGNALS_NEEDING_MAP: Final = frozenset(
    {
        "registration", "handedness", "lane_types", "markings", "speed_limits", "exit_signs", "road_types", "junctions",
        "traffic_lights", "stop_lines", "crossings",
    }
)  # fmt: skip
"""Signals that need a map. Without a map, the missing signal is `map` instead of these."""
REASON_BY_SIGNAL_MISSING_ON_ROUTE: Final = {
    "road_types": "the map does not state the kind of the roads on which the ego drives",
    "speed_limits": "the map has no readable speed limit for the lanes on which the ego drives",
}


def reasons_of_never_known_signals(
    knowledge: Mapping[str, bool], reason_by_missing_signal: Mapping[str, str]
) -> dict[str, str]:
    """Return signal or condition -> reason, for those that are unknown at every step of the ego.

    `reason_by_missing_signal`: signal -> reason, for signals that the whole log or map lacks; its reasons take precedence.
    """
    reasons = {}
    for name in (name for name, is_known in knowledge.items() if not is_known):
        signal = SIGNAL_OF_CONDITION.get(name, name)
        reasons[signal] = reason_by_missing_signal.get(
            signal, REASON_BY_SIGNAL_MISSING_ON_ROUTE.get(signal, f"nothing says the {name.replace('_', ' ')}")
        )
    return reasons


def undecided_rules(
    rules: Sequence[Rule], reason_by_missing_signal: Mapping[str, str], never_known: Mapping[str, str]
) -> list[Undecided]:
    """Return the rules that cannot be decided because a signal is missing or a condition is never known."""
    undecided = []
    for rule in rules:
        conditions = {SIGNAL_OF_CONDITION.get(name, name) for name in rule.applies.restricted_conditions}
        conditions |= {"speed_limits"} if rule.applies.has_speed_limit_condition else set()
        blocking = set(rule.needed_signals) & reason_by_missing_signal.keys() | conditions & never_known.keys()
        lacking = blocking | set(rule.pass_requires) & never_known.keys()
        if "map" in lacking:
            lacking -= SIGNALS_NEEDING_MAP
        if lacking:
            undecided.append(
                Undecided(rule_id=rule.id, title=rule.title, missing_signals=sorted(lacking), breach_only=not blocking)
            )
    return undecided


def missing_signals(
    undecided: Sequence[Undecided],
    reason_by_missing_signal: Mapping[str, str],
    log_format: str,
    advice: Mapping[str, str],
) -> list[MissingSignal]:
    """Return the missing signals with the rules that need them, the signal with most rules first. `advice`: signal -> advice."""
    by_signal: dict[str, list[Undecided]] = {}
    for rule in undecided:
        for signal in rule.missing_signals:
            by_signal.setdefault(signal, []).append(rule)
    signals = [
        MissingSignal(
            signal=signal,
            reason=reason_by_missing_signal[signal],
            provide=how_to_provide(signal, log_format, advice.get(signal)),
            rules=[rule.rule_id for rule in waiting],
            alone=[rule.rule_id for rule in waiting if rule.missing_signals == [signal]],
        )
        for signal, waiting in by_signal.items()
    ]
    return sorted(signals, key=lambda item: (-len(item.rules), item.signal))
