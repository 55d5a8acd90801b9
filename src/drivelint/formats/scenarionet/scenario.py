"""A scenario as ScenarioNet defines it (MetaDrive's `ScenarioDescription`): its parts, checked, and the facts about its data set."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from drivelint.facts import toml_beside
from drivelint.formats.scenarionet.pickle_shortcuts import Points
from drivelint.formats.scenarionet.pickled_numpy import PickleError
from drivelint.formats.scenarionet.unpickle import load
from drivelint.road.countries import side_of_nation

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.arrays import Floats

_FACTS: Final = toml_beside(__file__, "datasets.toml")
ACTOR_CLASS_BY_TYPE: Final[dict[str, str]] = _FACTS["classes"]
SIGNAL_STATE_BY_WORD: Final[dict[str, str]] = _FACTS["lights"]
_LARGEST_TIME_S: Final = 1e9


class DatasetFacts(NamedTuple):
    """The facts about a data set; the defaults are for an unknown one. See datasets.toml.

    `sensor_range_m`: the range within which every actor is recorded. `steps_per_keyframe`: boxes are interpolated between keyframes
    this many steps apart (0: they are not). `ego_message_s`: the ego's positions are every n-th message of a stream with this period,
    counted and not timed.
    `ego_ahead_m`: how far the middle of the ego's box is ahead of its position. `ego_box_m`: the ego's length and width. `nations`: start
    of a place's name -> country. The other fields: whether the values are from the data set, or are constants of the converter.
    """

    sensor_range_m: float = 50.0
    steps_per_keyframe: int = 0
    ego_message_s: float | None = None
    ego_ahead_m: float = 0.0
    ego_box_m: tuple[float, ...] = ()
    sizes: bool = True
    markings: bool = True
    speed_limits: bool = True
    heights: bool = True
    stop_points: bool = True
    nations: Mapping[str, str] = {}

    def nation_of(self, place_name: str) -> str | None:
        """Return the country, as two letters, of the place that the scenario names; None: not known."""
        return next((nation for begin, nation in self.nations.items() if place_name.startswith(begin)), None)

    def side_driven_on(self, place_name: str) -> str | None:
        """Return the side that is driven on, lht or rht, at the place that the scenario names; None: not known."""
        nation = self.nation_of(place_name)
        return None if nation is None else side_of_nation(nation)


class Scenario(NamedTuple):
    """The parts of a scenario, and the size of its file in bytes; each track, light and feature is a dict."""

    file_size: int
    dataset: DatasetFacts
    metadata: dict[str, Any]
    tracks: dict[str, dict[str, Any]]
    lights: dict[str, dict[str, Any]]
    features: dict[str, dict[str, Any]]

    @property
    def place_name(self) -> str:
        """The name of the place, such as singapore-onenorth; empty: not known."""
        return str(self.metadata.get("map", ""))

    def refuse_if_more_values_than_file_bytes(self, n: int, kind: str) -> None:
        """Raise `PickleError` if there are more than `file_size` values: many references to one value could exceed any limit of memory."""
        if n > self.file_size:
            raise PickleError(f"its {n} {kind} are more than the file can hold: write the scenario again")


def read_scenario(content: bytes) -> Scenario:
    """Return the scenario in a pickle. Errors: `PickleError` if the pickle is damaged, or is not a scenario."""
    content_dict = load(content)
    parts = {
        name: _dict_in_scenario(content_dict, name)
        for name in ("metadata", "tracks", "dynamic_map_states", "map_features")
    }
    facts = _FACTS["dataset"].get(str(parts["metadata"].get("dataset", "")).lower(), {})
    dicts = [_dicts_in_part(parts[name], name) for name in ("tracks", "dynamic_map_states", "map_features")]
    scenario = Scenario(len(content), DatasetFacts(**facts), parts["metadata"], *dicts)
    scenario.refuse_if_more_values_than_file_bytes(
        sum(map(_n_points, scenario.features.values())), "points of map features"
    )
    return scenario


def _n_points(feature: Mapping[str, Any]) -> int:
    """Return how many points a feature has."""
    n = 0
    for value in (feature.get("polyline"), feature.get("polygon")):
        if isinstance(value, (list, tuple)):
            n += len(value)
        elif isinstance(value, (Points, np.ndarray)):
            n += value.n if isinstance(value, Points) else value.size
    return n


def _dict_in_scenario(content: Any, name: str) -> dict[str, Any]:
    if not isinstance(content, dict) or not isinstance(content.get(name), dict):
        raise PickleError(f"it is not a scenario of ScenarioNet, because it has no dict {name!r}: give a file sd_*.pkl")
    return dict(content[name])


def _dicts_in_part(part: dict[Any, Any], name: str) -> dict[str, dict[str, Any]]:
    for key, value in part.items():
        if not isinstance(value, dict):
            raise PickleError(f"{name}[{str(key)[:100]!r}] is not a dict: write the scenario again")
    return {str(key): value for key, value in part.items()}


def times_s(metadata: Mapping[str, Any]) -> Floats:
    """Return the times of the steps (T,) in seconds. Errors: `PickleError`."""
    t_s = number_array(metadata.get("ts"), "metadata['ts']").reshape(-1)
    if not len(t_s) or not (np.abs(t_s) < _LARGEST_TIME_S).all():
        raise PickleError("metadata['ts'] is not a list of times in seconds: write the scenario again")
    return t_s


def number_array(value: Any, where: str) -> Floats:
    """Return a number, or several numbers, as an array. Errors: `PickleError` that names their place in the file, `where`."""
    try:
        if isinstance(value, (int, float)):
            return np.array(value, np.float64)
        if isinstance(value, np.ndarray) and value.dtype.kind in "biuf":
            return value.astype(np.float64)
        if isinstance(value, (list, tuple)):
            plain = all(isinstance(item, (int, float)) for item in value)
            return np.array(value, np.float64) if plain else point_array(value, where)
        if isinstance(value, Points):
            return value.array
    except OverflowError:
        pass  # an integer beyond any float
    raise PickleError(f"{where} is not an array of numbers: write the scenario again")


def point_array(value: Any, where: str) -> Floats:
    """Return points (n, k), given as an array or a list. Errors: `PickleError` that names their place in the file, `where`."""
    if isinstance(value, Points):
        return value.array
    if isinstance(value, np.ndarray) and value.dtype.kind in "biuf" and value.ndim == 2:
        return value.astype(np.float64)
    rows = value if isinstance(value, (list, tuple)) else ()
    rows = [row.tolist() if isinstance(row, np.ndarray) and row.size <= 3 else row for row in rows]
    widths = {len(row) if isinstance(row, (list, tuple)) else 0 for row in rows}
    if len(widths) == 1 and (k := widths.pop()) in {1, 2, 3}:
        try:
            return np.fromiter(chain.from_iterable(rows), np.float64, len(rows) * k).reshape(-1, k)
        except (TypeError, ValueError, OverflowError):
            pass  # a text, a list of lists, or an integer beyond any float
    raise PickleError(f"{where} is not a list of points: write the scenario again")
