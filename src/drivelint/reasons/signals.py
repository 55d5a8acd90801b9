"""Says how to provide a signal that rules require."""

from __future__ import annotations

from typing import Final

from drivelint.drive.conditions import CONDITION_TEXTS, CONDITION_VALUES
from drivelint.drive.declared_events import ON_OFF_EVENTS
from drivelint.formats.registry import FORMATS
from drivelint.phrases import hint

ADVICE: Final = {
    "map": "the road as OpenDRIVE: --map FILE",
    "registration": (
        "the map of this place (--map), where it lies in the log's frame (--map-offset DX,DY), "
        "or the side that is driven on (--handedness)"
    ),
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
        name: f"{CONDITION_TEXTS[name].partition(';')[0]}: --env {name}={words[0]} ({', '.join(words[1:])})"
        for name, words in CONDITION_VALUES.items()
    },
    **{
        f"mode_{mode}": f"when {mode} is on, as declared events {mode} with the values on and off: {{declared_events}}"
        for mode in ON_OFF_EVENTS
    },
    "mode_engaged": (
        "whether the automated driver drives: --env engaged=yes or no for the whole drive, "
        "or declared events engaged with the values on and off: {declared_events}"
    ),
    "mode_headlights": "when the headlights are on: {headlights}",
}
SIGNALS: Final = ADVICE.keys() - CONDITION_VALUES.keys()
"""What a rule may require: the signals of the table `capability`. The others are conditions of a drive."""
SIGNAL_OF_CONDITION: Final = {"road_type": "road_types", "limit": "speed_limits"}
"""Conditions that the map gives under another name."""
_DECLARED = "declared_event.parquet (columns drive_id, actor_id, t_ns, event, value)"
_CONVERTED = "drivelint convert --to parquet, and in its tables "
_TABLES: Final = {
    "indicator": "the column indicator of actor_state.parquet (off, left, right or hazard)",
    "brake_light": "the column brake_light of actor_state.parquet (off, on or strong)",
    "ego_size": "length_m and width_m in actor.parquet",
    "actor_classes": "the column actor_class of actor.parquet",
    "signals": "signal_state.parquet",
    "declared_events": _DECLARED,
    "headlights": f"events headlights in {_DECLARED}, with the values on and off",
}
_OSI: Final = {
    "indicator": "vehicle_classification.light_state.indicator_state of the host vehicle (not UNKNOWN)",
    "brake_light": "vehicle_classification.light_state.brake_light_state of the host vehicle (not UNKNOWN)",
    "ego_size": "base.dimension of the host vehicle",
    "actor_classes": "type and vehicle_classification.type of the moving objects",
    "signals": "traffic_light of the ground truth, with ids as the map has them",
}
_CHANNEL: Final = "a channel of JSON messages drivelint.DeclaredEvent (keys t_ns, actor_id, event, value)"
_NO_CHANNEL: Final = f"a .osi file has no place for them: {_CONVERTED}{_DECLARED}"
_LAMP: Final = (
    "either the signal vehicle_classification.light_state.head_light of the host vehicle (not UNKNOWN), "
    "or, with the values on and off, the declared event headlights: {}"
)
_WHERE: Final = {
    "osi-mcap": {**_OSI, "declared_events": _CHANNEL, "headlights": _LAMP.format(_CHANNEL)},
    "osi-file": {**_OSI, "declared_events": _NO_CHANNEL, "headlights": _LAMP.format(_NO_CHANNEL)},
    "canonical-parquet": _TABLES,
    "mapped": {
        "indicator": "a column of off, left, right and hazard, named under [indicator] in the mapping (check --mapping FILE)",
        "brake_light": "a column of off, on and strong, named under [brake_light] in the mapping (check --mapping FILE)",
        "ego_size": "length and width under [columns] of the mapping (check --mapping FILE), as columns or as numbers",
        "actor_classes": "a column of the log, named under [class] in the mapping (check --mapping FILE)",
    },
}


def problem(signal: str) -> str | None:
    """Return what is wrong with the name of a signal; None: it is one."""
    if signal in SIGNALS:
        return None
    return f"{signal!r} is no signal; {hint(signal, sorted(SIGNALS))}"


def how_to_provide(signal: str, log_format: str) -> str:
    """Return how to provide a signal in a log of this format."""
    name = log_format if log_format in FORMATS else "mapped"
    # what a format has no place for goes into its tables
    where = {key: _CONVERTED + table for key, table in _TABLES.items()} | _WHERE.get(name, {})
    return ADVICE.get(signal, "see what the rules that need it say: drivelint rules show ID").format_map(where)
