"""The tracks of a scenario as arrays over actors and steps: an invalid state is absent, whatever numbers it has."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.drive.trace import ACTOR_CLASSES
from drivelint.formats.scenarionet.pickled_numpy import PickleError
from drivelint.formats.scenarionet.scenario import ACTOR_CLASS_BY_TYPE, number_array

if TYPE_CHECKING:
    from drivelint.arrays import Codes, Floats, Mask
    from drivelint.formats.scenarionet.scenario import Scenario

_SIZE_NAMES: Final = ("length", "width", "height")


@dataclass
class Tracks:
    """The tracks of n actors over T steps. `ego`: the index of the ego; None: no track is the ego.

    `t_s` (T,), `present` (n, T), `place` (n, T, 3), `heading` (n, T), `velocity` (n, T, 2), `size` (n, T, 3): length, width, height;
    NaN where not known. `class_codes` (n,): indices of ACTOR_CLASSES, -1: not known.
    """

    ids: list[str]
    ego: int | None
    t_s: Floats
    present: Mask
    place: Floats
    heading: Floats
    velocity: Floats
    size: Floats
    class_codes: Codes

    @cached_property
    def displacements_m(self) -> Floats:
        """The displacement of each actor (n, T - 1, 2) from step to step, as read; NaN unless it is present at both steps."""
        steps: Floats = np.diff(self.place[..., :2], axis=1)
        return steps


def read_tracks(scenario: Scenario, t_s: Floats) -> Tracks:
    """Return the tracks of a scenario. Errors: `PickleError` for a track whose arrays are not as long as the scenario."""
    ids, n, steps = list(scenario.tracks), len(scenario.tracks), len(t_s)
    scenario.refuse_if_more_values_than_file_bytes(n * steps, "steps of tracks")
    ego = str(scenario.metadata.get("sdc_id"))
    tracks = Tracks(
        ids,
        ids.index(ego) if ego in scenario.tracks else None,
        t_s,
        np.zeros((n, steps), np.bool_),
        place=np.full((n, steps, 3), np.nan),
        heading=np.full((n, steps), np.nan),
        velocity=np.full((n, steps, 2), np.nan),
        size=np.full((n, steps, 3), np.nan),
        class_codes=np.array([_class_code(track) for track in scenario.tracks.values()], np.int8),
    )
    for i, (name, track) in enumerate(scenario.tracks.items()):
        state = track.get("state")
        if not isinstance(state, dict):
            raise PickleError(f"tracks[{name[:100]!r}] has no dict 'state': write the scenario again")
        _fill_track(tracks, i, state, f"tracks[{name[:100]!r}]['state']")
    absent = ~tracks.present
    for values in (tracks.place, tracks.heading, tracks.velocity, tracks.size):
        values[absent] = np.nan
    return tracks


def _fill_track(tracks: Tracks, i: int, state: dict[str, Any], where: str) -> None:
    steps = len(tracks.t_s)
    place = _state_array(state, "position", steps, where)
    tracks.place[i, :, : place.shape[1]] = place[:, :3]
    tracks.heading[i] = _state_array(state, "heading", steps, where)[:, 0]
    if "velocity" in state:
        tracks.velocity[i] = _state_array(state, "velocity", steps, where)[:, :2]
    tracks.present[i] = _state_array(state, "valid", steps, where)[:, 0] > 0.5 if "valid" in state else True
    for k, name in enumerate(_SIZE_NAMES):
        if name in state:
            tracks.size[i, :, k] = _state_array(state, name, steps, where)[:, 0]


def _state_array(state: dict[str, Any], name: str, steps: int, where: str) -> Floats:
    """Return an array of a state as (steps, k); a single number is repeated for every step. Errors: `PickleError`."""
    values = number_array(state.get(name), f"{where}[{name!r}]")
    least = {"position": 2, "velocity": 2}.get(name, 1)
    if least == 1 and values.size == 1:
        return np.broadcast_to(values.reshape(1, 1), (steps, 1))
    if values.ndim not in {1, 2} or len(values) != steps or values.size < steps * least:
        shape = f"of the shape {values.shape}"
        raise PickleError(f"{where}[{name!r}] is {shape}, and the scenario has {steps} steps: write it again")
    return values.reshape(steps, -1)


def _class_code(track: dict[str, Any]) -> int:
    """Return a track's class, by the data set's own type if `ACTOR_CLASS_BY_TYPE` has it, else by ScenarioNet's type; -1: not known."""
    metadata = track.get("metadata")
    words = (metadata.get("type") if isinstance(metadata, dict) else None, track.get("type"))
    actor_class = next(
        (ACTOR_CLASS_BY_TYPE[word] for word in words if isinstance(word, str) and word in ACTOR_CLASS_BY_TYPE), None
    )
    return -1 if actor_class is None else ACTOR_CLASSES.index(actor_class)
