"""What to provide so that a signal that rules require is there: one place for all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.conditions import SAYS, WORDS
from drivelint.declared import MODES
from drivelint.inspect.model import Missing, Undecided

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.catalogue import Rule

OF_THE_MAP: Final = frozenset(
    {
        "registration", "handedness", "lane_types", "markings", "speed_limits", "exit_signs", "road_types", "junctions",
        "traffic_lights", "stop_lines", "crossings",
    }
)  # fmt: skip
"""Signals that nobody can have without a map: where there is none, it is what is missing."""
ADVICE: Final = {
    "map": "the road as OpenDRIVE: --map FILE",
    "registration": "the map of this place (--map), or where it lies in the log's frame (--map-offset DX,DY)",
    "handedness": "the side of the road that is driven on: --handedness lht or rht",
    "lane_types": "a map that has the footways, kerbs, borders or shoulders beside the carriageway",
    "markings": "a map with road markings (OpenDRIVE: roadMark)",
    "speed_limits": "a map with speed limits (OpenDRIVE: speed, of a road's type or of a lane)",
    "exit_signs": "a map with its exit signs (OpenDRIVE: signals, such as type 332, 333, 448 or 449)",
    "road_types": "a map with road types (OpenDRIVE: type of a road), or --env road_type=rural (motorway, town, ...)",
    "junctions": "a map with its junctions (OpenDRIVE: junction)",
    "traffic_lights": "a map with its traffic lights (OpenDRIVE: signals, such as type 1000001)",
    "stop_lines": "a map with its stop lines (OpenDRIVE: signal 294, or objects)",
    "crossings": "a map with its pedestrian crossings (OpenDRIVE: objects of type crosswalk)",
    "indicator": "the ego's indicators: {indicator}",
    "brake_light": "the ego's brake lights: {brake_light}",
    "ego_size": "the ego's length and width: {ego_size}",
    "speeds": "a log of positions or speeds: the film's mapping assumes the speeds",
    "actor_classes": "what the others are, such as car or bicycle: {actor_classes}",
    "signals": "the states of the traffic lights: {signals}",
    "declared_events": "the events that the ego declares: {declared_events}",
    "modes": "the ego's modes, as declared events with the values on and off: {declared_events}",
    **{
        name: f"{SAYS[name].partition(';')[0]}: --env {name}={words[0]} ({', '.join(words[1:])})"
        for name, words in WORDS.items()
    },
    **{
        f"mode_{mode}": f"when {mode} is on, as declared events {mode} with the values on and off: {{declared_events}}"
        for mode in MODES
    },
    "mode_headlights": "when the headlights are on: {headlights}",
}
SIGNAL_OF: Final = {"road_type": "road_types", "limit": "speed_limits"}
"""Conditions that the map gives under another name."""
WHERE_IT_IS: Final = {
    "road_types": "the map does not say of what kind the roads are that the ego drives on",
    "speed_limits": "the map gives no limit that can be read for the lanes that the ego drives on",
}
_WHERE: Final = {
    "osi-mcap": {
        "indicator": "vehicle_classification.light_state.indicator_state of the host vehicle (not UNKNOWN)",
        "brake_light": "vehicle_classification.light_state.brake_light_state of the host vehicle (not UNKNOWN)",
        "ego_size": "base.dimension of the host vehicle",
        "actor_classes": "type and vehicle_classification.type of the moving objects",
        "signals": "traffic_light of the ground truth, with ids as the map has them",
        "declared_events": "a channel of JSON messages drivelint.DeclaredEvent",
        "headlights": "vehicle_classification.light_state.head_light of the host vehicle (not UNKNOWN)",
    },
    "canonical-parquet": {
        "indicator": "the column indicator of actor_state.parquet",
        "brake_light": "the column brake_light of actor_state.parquet",
        "ego_size": "length_m and width_m in actor.parquet",
        "actor_classes": "the column actor_class of actor.parquet",
        "signals": "signal_state.parquet",
        "declared_events": "declared_event.parquet",
        "headlights": "events headlights in declared_event.parquet, with the values on and off",
    },
    "": {
        "indicator": "[indicator] in the mapping, and a column to read it from",
        "brake_light": "[brake_light] in the mapping, and a column to read it from",
        "ego_size": "length and width in the mapping's [columns], as columns or as numbers",
        "actor_classes": "[class] in the mapping, and a column to read it from",
        "signals": "drivelint convert --to parquet, and signal_state.parquet beside it",
        "declared_events": "drivelint convert --to parquet, and declared_event.parquet beside it",
        "headlights": "drivelint convert --to parquet, and events headlights in declared_event.parquet beside it, on and off",
    },
}


def provide(signal: str, log_format: str) -> str:
    """Say what to give so that the signal is there, in the words of the log's format."""
    where = _WHERE.get("osi-mcap" if log_format == "osi-file" else log_format, _WHERE[""])
    return ADVICE.get(signal, "see what the rules that need it say: drivelint rules show ID").format_map(where)


def never_known(knowledge: Mapping[str, bool], lacking: Mapping[str, str]) -> dict[str, str]:
    """Return what is known of the ego at no step, signal or condition -> why; `knowledge`: condition, or limit, -> known at some step.

    What the log or the map lacks as a whole, `lacking` says already.
    """
    found = {}
    for name in (name for name, known in knowledge.items() if not known):
        signal = SIGNAL_OF.get(name, name)
        found[signal] = lacking.get(signal, WHERE_IT_IS.get(signal, f"nothing says the {name.replace('_', ' ')}"))
    return found


def undecided(rules: Sequence[Rule], lacking: Mapping[str, str], never: Mapping[str, str]) -> list[Undecided]:
    """Return the rules for which something is lacking (signal -> why), or never known of the ego."""
    found = []
    for rule in rules:
        conditions = {SIGNAL_OF.get(name, name) for name in rule.applies.words}
        conditions |= {"speed_limits"} if rule.applies.limited else set()
        needed = set(rule.requires) & lacking.keys() | conditions & never.keys()
        missing = needed | set(rule.pass_requires) & never.keys()
        if "map" in missing:
            missing -= OF_THE_MAP
        if missing:
            found.append(Undecided(rule_id=rule.id, title=rule.title, missing=sorted(missing), breach_only=not needed))
    return found


def missing(cannot: Sequence[Undecided], lacking: Mapping[str, str], log_format: str) -> list[Missing]:
    """Return the same by signal, that which most rules wait for first."""
    by_signal: dict[str, list[Undecided]] = {}
    for rule in cannot:
        for signal in rule.missing:
            by_signal.setdefault(signal, []).append(rule)
    found = [
        Missing(
            signal=signal,
            reason=lacking[signal],
            provide=provide(signal, log_format),
            rules=[rule.rule_id for rule in waiting],
            alone=[rule.rule_id for rule in waiting if rule.missing == [signal]],
        )
        for signal, waiting in by_signal.items()
    ]
    return sorted(found, key=lambda item: (-len(item.rules), item.signal))
