"""Reads scenarios of ScenarioNet: one drive per pickle, from its tracks, the states of its lights and the ego that it names.

Positions are box centres, except those of nuScenes' ego: they are its rear axle, and are moved to its box centre.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa

from drivelint.arrays import words_of_codes
from drivelint.drive.trace import SIGNAL_STATES, QualityFinding, Recording, States
from drivelint.errors import TraceError
from drivelint.formats.scenarionet import sources
from drivelint.formats.scenarionet.ego_clock import track_at_steps
from drivelint.formats.scenarionet.pickled_numpy import PickleError
from drivelint.formats.scenarionet.scenario import SIGNAL_STATE_BY_WORD, read_scenario, times_s
from drivelint.formats.scenarionet.tracks import Tracks, read_tracks
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from drivelint.arrays import Floats, Mask, Times
    from drivelint.formats.probe import Probe
    from drivelint.formats.scenarionet.scenario import Scenario

formats: Final = {"scenarionet": ("ScenarioNet scenario", "the scenario's sdc_id")}
takes_mapping: Final = False
_PICKLE_PROTOCOLS: Final = (2, 3, 4, 5)
_CODE_BY_LIGHT_WORD: Final = {word: SIGNAL_STATES.index(state) for word, state in SIGNAL_STATE_BY_WORD.items()}


def accepts(probe: Probe) -> bool:
    """Return whether the file begins as a pickle of a known protocol, and has the suffix .pkl or begins with a dict."""
    head = probe.head
    if len(head) < 3 or head[0] != 0x80 or head[1] not in _PICKLE_PROTOCOLS:
        return False
    behind_frame = head[11:12] if head[2] == 0x95 else head[2:3]
    return behind_frame == b"}" or probe.path.suffix.lower() == ".pkl"


def read(probe: Probe) -> Recording:
    """Read a scenario. Errors: `TraceError` for a pickle that is damaged, is not a scenario, or contains more than numbers and texts."""
    content = probe.path.read_bytes()
    try:
        return _recording(read_scenario(content), content)
    except PickleError as error:
        raise TraceError(f"{probe.path}: {error}") from error


def _recording(scenario: Scenario, content: bytes) -> Recording:
    dataset, t_s = scenario.dataset, times_s(scenario.metadata)
    tracks = read_tracks(scenario, t_s)
    findings = [
        *sources.correct_swapped_length_and_width(tracks, dataset),
        *sources.drop_velocities_from_position_differences(tracks),
        *sources.drop_false_zero_last_velocities(tracks),
    ]
    is_interpolated = sources.actors_with_interpolated_positions(tracks, dataset)
    if is_interpolated.any():
        findings += sources.set_velocities_from_keyframes(tracks, is_interpolated, dataset.steps_per_keyframe)
    of_ego, notes = _correct_ego_track(tracks, scenario, is_interpolated)
    if not dataset.sizes:
        tracks.size[:] = np.nan
        notes.append("sizes are guesses of ScenarioNet for this data set: they count as unknown")
    recording = Recording("scenarionet", _states(tracks), findings=[*findings, *of_ego], notes=notes)
    recording.ego_ids = [] if tracks.ego is None else [tracks.ids[tracks.ego]]
    recording.signals, unknown = _signal_states_and_findings(scenario, t_s)
    recording.findings += unknown
    recording.sensor_range_m = dataset.sensor_range_m
    if nation := dataset.nation_of(scenario.place_name):
        recording.conditions["nation"] = nation
    if any("LANE" in str(feature.get("type")) for feature in scenario.features.values()):
        recording.embedded_map = content
    return recording


def _correct_ego_track(
    tracks: Tracks, scenario: Scenario, is_interpolated: Mask
) -> tuple[list[QualityFinding], list[str]]:
    """Correct the times and places of the ego's box, in place; return findings and notes. `is_interpolated`: per actor."""
    dataset, ego = scenario.dataset, tracks.ego
    if ego is None:
        ego_id = scenario.metadata.get("sdc_id")
        return [], [] if ego_id is None else [f"the scenario's ego {str(ego_id)[:100]!r} has no track"]
    findings: list[QualityFinding] = []
    notes: list[str] = []
    if dataset.ego_message_s is not None and not is_interpolated[ego] and tracks.present[ego].all():
        timed = track_at_steps(tracks.place[ego, :, :2], tracks.heading[ego], tracks.t_s, dataset.ego_message_s)
        tracks.place[ego, :, :2], tracks.heading[ego] = timed.place, timed.heading
        tracks.present[ego] = np.isfinite(timed.heading)
        findings = _ego_clock_findings(tracks.ids[ego], timed.lost_messages, timed.shift_s, dataset.ego_message_s)
    if dataset.ego_ahead_m:
        heading = tracks.heading[ego]
        tracks.place[ego, :, 0] += dataset.ego_ahead_m * np.cos(heading)
        tracks.place[ego, :, 1] += dataset.ego_ahead_m * np.sin(heading)
        tracks.place[ego, :, 2] += tracks.size[ego, :, 2] / 2.0
        notes.append(
            "the ego's positions are those of its rear axle on the ground: the middle of its box is "
            f"{dataset.ego_ahead_m:g} m ahead and half its height above"
        )
    return findings, notes


def _ego_clock_findings(
    ego_id: str, lost_messages: int, shift_s: float, message_period_s: float
) -> list[QualityFinding]:
    if not lost_messages and not np.isfinite(shift_s):
        return []
    steps = (
        f"{lost_messages} of its messages are lost, and each lost message makes a step {message_period_s:g} s longer "
        "than the scenario states"
    )
    parts = [steps] if lost_messages else []
    if np.isfinite(shift_s):
        parts.append(
            f"its last positions, which match the annotated frames, show that it begins {round(shift_s, 2) + 0.0:.2f} s after these"
        )
    message = (
        f"the positions of {ego_id} have message numbers instead of times: {'; '.join(parts)}: its positions are moved "
        "to the times of the steps, with an error of about 0.1 s relative to the other actors"
    )
    return [QualityFinding("ego_clock", "warning", message, max(lost_messages, 1), actor_id=ego_id)]


def _states(tracks: Tracks) -> States:
    actor, step = np.nonzero(tracks.present)
    place, velocity, size = (values[actor, step] for values in (tracks.place, tracks.velocity, tracks.size))
    heading = tracks.heading[actor, step]
    numbers = {
        "x_m": place[:, 0], "y_m": place[:, 1], "z_m": place[:, 2], "yaw_rad": heading,
        "vx_mps": velocity[:, 0], "vy_mps": velocity[:, 1],
        "length_m": size[:, 0], "width_m": size[:, 1], "height_m": size[:, 2],
    }  # fmt: skip
    odd = ~np.isfinite(place[:, :2]).all(axis=1) | ~np.isfinite(heading) | np.isinf(velocity).any(axis=1)
    numbers = {name: np.where(np.isinf(values), np.nan, values) for name, values in numbers.items()}
    return States(
        tracks.ids,
        actor.astype(np.int32),
        _nanoseconds(tracks.t_s)[step],
        numbers,
        {"actor_class": tracks.class_codes[actor]},
        odd,
    )


def _nanoseconds(t_s: Floats) -> Times:
    return np.round(t_s * 1e9).astype(np.int64)


def _signal_states_and_findings(scenario: Scenario, t_s: Floats) -> tuple[pa.Table | None, list[QualityFinding]]:
    """Return the states of all lights, one row per light and step, and findings. A light has the id of its lane."""
    scenario.refuse_if_more_values_than_file_bytes(len(scenario.lights) * len(t_s), "states of lights")
    ids, codes = [], []
    known_words: set[Any] = set()
    for name, light in scenario.lights.items():
        state = light.get("state")
        words = state.get("object_state") if isinstance(state, dict) else None
        words = words.tolist() if isinstance(words, np.ndarray) else words
        if not isinstance(words, list) or len(words) != len(t_s) or not {*map(type, words)} <= {str, type(None)}:
            where = f"dynamic_map_states[{name[:100]!r}]['state']['object_state']"
            raise PickleError(f"{where} has not one word per step ({len(t_s)}): write the scenario again")
        ids.append(name)
        codes.append(np.array([_CODE_BY_LIGHT_WORD.get(word, -1) for word in words], np.int8))
        known_words.update(words)
    unread = {
        word[:100] for word in known_words - _CODE_BY_LIGHT_WORD.keys() - {None} if word and "UNKNOWN" not in word
    }
    if not ids:
        return None, []
    lights = np.repeat(np.arange(len(ids), dtype=np.int32), len(t_s))
    table = pa.table(
        {
            "signal_id": words_of_codes(lights, ids),
            "t_ns": np.tile(_nanoseconds(t_s), len(ids)),
            "state": words_of_codes(np.concatenate(codes), SIGNAL_STATES),
        }
    )
    if not unread:
        return table, []
    message = f"lights have states that are not known: {name_list(sorted(unread))}"
    return table, [QualityFinding("unknown_word", "warning", message, len(unread))]
