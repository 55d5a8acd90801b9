"""Tracks, lights and egos of scenarios, and what data sets write that is no measurement."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from drivelint.drive.trace import Trace
from drivelint.errors import TraceError
from drivelint.formats import expand_traces
from tests.formats.logs import actors, classes, egos, log, read, size, states
from tests.formats.logs import messages as messages_of
from tests.formats.scenarionet.scenario_file import STEP_S, light, line, put, scenario, straight, track


def checks(trace: Trace, check: str) -> list[dict[str, Any]]:
    return [row for row in trace.tables["quality"].to_pylist() if row["check_id"] == check]


def column(trace: Trace, actor: str, name: str) -> np.ndarray:
    return np.array([row[name] for row in states(trace, actor)], np.float64)


def ego_and(path: Path, tracks: dict[str, Any], **more: Any) -> Trace:
    return read(put(path, scenario({"ego": track(straight(41, 10.0)), **tracks}, **more)))


# ---- tracks


def test_a_drive(tmp_path: Path) -> None:
    tracks = {"ego": track(straight(21, 10.0), 0.0), "7": track(straight(21, 5.0, y=4.0), kind="CYCLIST")}
    trace = read(put(tmp_path, scenario(tracks)))
    assert (log(trace)["format"], log(trace)["sensor_range_m"]) == ("scenarionet", 75.0)
    assert (classes(trace), egos(trace)) == ({"ego": "vehicle", "7": "bicycle"}, ["ego"])
    rows = states(trace, "7")
    assert [row["t_ns"] for row in rows] == [i * 100_000_000 for i in range(21)]
    assert (rows[3]["x_m"], rows[3]["y_m"], rows[3]["z_m"]) == pytest.approx((1.5, 4.0, 0.8))
    assert (rows[3]["yaw_rad"], rows[3]["vx_mps"], rows[3]["vy_mps"]) == pytest.approx((0.0, 5.0, 0.0))
    assert size(trace, "7") == (4.5, 1.8, 1.5)
    assert trace.embedded_map is None


def test_steps_that_are_not_valid_do_not_exist(tmp_path: Path) -> None:
    valid = np.ones(41)
    valid[:10] = valid[30:] = 0.0
    other = track(straight(41, 5.0), valid=valid)
    for values in other["state"].values():
        values[valid == 0.0] = 0.0
    trace = ego_and(tmp_path, {"a": other, "never": track(straight(41, 5.0), valid=np.zeros(41, np.bool_))})
    assert [row["t_ns"] for row in states(trace, "a")] == [i * 100_000_000 for i in range(10, 30)]
    assert set(actors(trace)) == {"ego", "a"}


@pytest.mark.parametrize(
    "length",
    [
        np.full(41, 4.5), np.full((41, 1), 4.5), np.full(41, 4.5, np.float32), 4.5, np.float64(4.5), [4.5] * 41, np.array([4.5]),
    ],
)  # fmt: skip
def test_sizes_in_any_shape(tmp_path: Path, length: Any) -> None:
    trace = ego_and(tmp_path, {"a": track(straight(41, 5.0), length=length)})
    assert actors(trace)["a"]["length_m"] == 4.5


@pytest.mark.parametrize(
    ("kind", "dataset_type", "expected"),
    [
        ("VEHICLE", "VEHICLE", "vehicle"),
        ("VEHICLE", "vehicle.car", "car"),
        ("VEHICLE", "vehicle.bus.bendy", "bus"),
        ("VEHICLE", "vehicle.bus.rigid", "bus"),
        ("VEHICLE", "vehicle.truck", "truck"),
        ("VEHICLE", "vehicle.trailer", "trailer"),
        ("VEHICLE", "vehicle.construction", "vehicle"),
        ("CYCLIST", "vehicle.bicycle", "bicycle"),
        ("CYCLIST", "vehicle.motorcycle", "motorcycle"),
        ("PEDESTRIAN", "human.pedestrian.child", "pedestrian"),
        ("TRAFFIC_CONE", "movable_object.trafficcone", "object"),
        ("TRAFFIC_BARRIER", "movable_object.barrier", "object"),
        ("OTHER", "OTHER", None),
        ("UNSET", "UNSET", None),
    ],
)
def test_classes(tmp_path: Path, kind: str, dataset_type: str, expected: str | None) -> None:
    trace = ego_and(tmp_path, {"a": track(straight(41, 0.0, y=9.0), kind=kind, dataset_type=dataset_type)})
    assert classes(trace)["a"] == expected


def test_an_ego_without_a_track(tmp_path: Path) -> None:
    path = put(tmp_path, scenario({"a": track(straight(21, 5.0))}, sdc_id="ego"))
    with pytest.raises(TraceError, match=r"no ego: .*use --ego ID"):
        read(path)
    trace = read(path, ego="a")
    assert actors(trace)["a"]["is_ego"]
    assert trace.notes == ["the scenario's ego 'ego' has no track"]


# ---- sizes that are in each other's place


def test_a_box_that_moves_along_its_short_side_is_turned(tmp_path: Path) -> None:
    swapped: dict[str, Any] = {"length": np.full(41, 1.8), "width": np.full(41, 4.5)}
    trace = ego_and(tmp_path, {"a": track(straight(41, 5.0, y=4.0), **swapped)})
    assert size(trace, "a")[:2] == (4.5, 1.8)
    (row,) = checks(trace, "box_turned")
    assert row["actor_id"] == "a"
    assert "as its motion along the short side shows: this is corrected" in row["message"]


@pytest.mark.parametrize("case", ["standing", "sideways"])
def test_a_wide_box_is_unknown_where_no_motion_tells(tmp_path: Path, case: str) -> None:
    swapped: dict[str, Any] = {"length": np.full(41, 1.8), "width": np.full(41, 4.5)}
    heading = np.pi / 2 if case == "sideways" else 0.0
    trace = ego_and(tmp_path, {"a": track(straight(41, 0.0 if case == "standing" else 2.0, y=4.0), heading, **swapped)})
    assert size(trace, "a")[:2] == (None, None)
    message = "wider than long, and no motion shows which side is the length: a: the size is unknown"
    assert messages_of(trace, "box_turned") == [message]


def test_people_and_barriers_may_be_wider_than_long(tmp_path: Path) -> None:
    others = {
        "p": track(straight(41, 1.0, y=4.0), kind="PEDESTRIAN", length=0.5, width=0.7),
        "b": track(straight(41, 0.0, y=8.0), kind="TRAFFIC_BARRIER", length=0.4, width=3.0),
    }
    trace = ego_and(tmp_path, others)
    assert [size(trace, i)[:2] for i in "pb"] == [(0.5, 0.7), (0.4, 3.0)]
    assert checks(trace, "box_turned") == []


@pytest.mark.parametrize(
    ("width", "expected"),
    [
        (4.08, (4.08, 1.73)),
        (4.5, (None, None)),  # nothing is known of such a box
    ],
)
def test_the_standing_ego_of_nuscenes_has_the_size_that_is_always_exchanged(
    tmp_path: Path, width: float, expected: tuple[float | None, ...]
) -> None:
    ego = track(straight(41, 0.0), dataset_type="vehicle.car", length=1.73, width=width, height=1.56)
    trace = read(put(tmp_path, scenario({"ego": ego}, dataset="nuscenes", map="boston-seaport")))
    assert size(trace)[:2] == expected


# ---- velocities that are differences


def bend(n: int = 41, speed: float = 12.0) -> np.ndarray:
    """Return places of somebody who brakes with 3 m/s2 in a bend."""
    t = np.arange(n) * STEP_S
    brakes = np.minimum(t, speed / 3.0)
    s = speed * brakes - 1.5 * brakes**2
    return np.column_stack([40.0 * np.sin(s / 40.0), 40.0 * (1.0 - np.cos(s / 40.0))])


def forward(place: np.ndarray) -> np.ndarray:
    """Return forward differences, the last of them 0, as ScenarioNet writes them of nuScenes."""
    return np.vstack([np.diff(place, axis=0) / STEP_S, [[0.0, 0.0]]])


def backward(place: np.ndarray) -> np.ndarray:
    """Return backward differences, the first of them 0, as Waymo's tracks have them."""
    return np.vstack([[[0.0, 0.0]], np.diff(place, axis=0) / STEP_S])


@pytest.mark.parametrize(("difference", "when"), [(forward, "early"), (backward, "late")])
def test_velocities_that_are_differences_are_derived_anew(tmp_path: Path, difference: Any, when: str) -> None:
    place = bend()
    trace = ego_and(tmp_path, {"a": track(place, velocity=difference(place))})
    t = np.arange(41) * STEP_S
    speed = np.maximum(12.0 - 3.0 * t, 0.0)
    told = np.hypot(*difference(place).T)
    got = np.hypot(column(trace, "a", "vx_mps"), column(trace, "a", "vy_mps"))
    # half a step of 3 m/s2 is 0.15 m/s, and an end of the track is wholly wrong
    assert np.abs(told - speed)[2:30].min() > 0.1
    assert np.abs(got - speed)[1:39].max() < 0.03
    assert np.abs(got - speed)[[0, 40]].max() < 0.2
    (row,) = checks(trace, "velocity_dropped")
    assert row["message"].startswith(
        f"velocities of the others are differences of the positions, half a step {when} and 0 or repeated"
    )
    assert row["n"] == 41


def test_velocities_that_are_measured_stay(tmp_path: Path) -> None:
    place = bend()
    t = np.arange(41) * STEP_S
    measured = np.column_stack([np.gradient(column, t) for column in place.T]) + 0.05
    trace = ego_and(tmp_path, {"a": track(place, velocity=measured)})
    assert column(trace, "a", "vx_mps") == pytest.approx(measured[:, 0])
    assert checks(trace, "velocity_dropped") == []


def test_the_ego_and_the_others_are_judged_apart(tmp_path: Path) -> None:
    """nuPlan's ego has differences, and its others have measured velocities."""
    place = bend()
    measured = np.gradient(place, STEP_S, axis=0) + 0.05
    tracks = {"ego": track(place, velocity=forward(place)), "a": track(place + 9.0, velocity=measured)}
    trace = read(put(tmp_path, scenario(tracks, dataset="nuplan")))
    assert [row["message"].split(" are ")[0] for row in checks(trace, "velocity_dropped")] == ["velocities of the ego"]
    assert column(trace, "a", "vx_mps") == pytest.approx(measured[:, 0])


def test_a_last_velocity_of_zero_is_unknown(tmp_path: Path) -> None:
    place = straight(41, 8.0, y=4.0)
    velocity = np.column_stack([8.0 + 0.3 * np.sin(np.arange(41)), np.zeros(41)])
    velocity[30] = velocity[40] = 0.0
    stands = track(straight(41, 0.0, y=9.0), velocity=np.zeros((41, 2)))
    trace = ego_and(tmp_path, {"a": track(place, velocity=velocity), "b": stands})
    assert np.isnan(column(trace, "a", "vx_mps")[40])
    assert column(trace, "a", "vx_mps")[39] == pytest.approx(velocity[39, 0])
    assert (column(trace, "b", "vx_mps") == 0.0).all()
    said = [message for message in messages_of(trace, "velocity_unknown") if "last velocity" in message]
    assert said == ["the last velocity of a is 0 although the positions move: it is unknown"]


# ---- nuScenes: boxes twice per second, and an ego that counts messages


def interpolated(place: np.ndarray) -> np.ndarray:
    """Return places of which every fifth is kept, and the others lie evenly between."""
    step = np.arange(len(place))
    return np.column_stack([np.interp(step, step[::5], column[::5]) for column in place.T])


def test_interpolated_boxes_have_the_mean_velocity_of_a_second_and_no_acceleration(tmp_path: Path) -> None:
    place = interpolated(bend())
    ego = track(
        straight(41, 10.0, y=-20.0) + np.random.default_rng(1).normal(0.0, 0.01, (41, 2)), length=1.73, width=4.08
    )
    trace = read(put(tmp_path, scenario({"ego": ego, "a": track(place, velocity=forward(place))}, dataset="nuscenes")))
    key = np.arange(0, 41, 5)
    expected = np.gradient(place[key], 5 * STEP_S, axis=0)
    expected[0], expected[-1] = (place[5] - place[0]) / 0.5, (place[40] - place[35]) / 0.5
    got = np.column_stack([column(trace, "a", name) for name in ("vx_mps", "vy_mps")])
    assert got[key] == pytest.approx(expected)
    assert got[2] == pytest.approx(0.6 * expected[0] + 0.4 * expected[1])
    assert [row["actor_id"] for row in checks(trace, "velocity_filtered")] == ["a"]
    (row,) = checks(trace, "interpolated")
    assert row["message"].startswith(
        "the positions of a are known every 0.5 s and interpolated between: velocities are means over 1 s"
    )
    speed = np.maximum(12.0 - 3.0 * key * STEP_S, 0.0)
    assert np.abs(np.hypot(*got[key].T) - speed)[1:7].max() < 0.1


def test_interpolation_is_told_by_the_positions(tmp_path: Path) -> None:
    """Whoever moves unevenly between keyframes was seen there, whatever the data set is called; and no other data set interpolates."""
    place = bend()
    for dataset, positions in (("nuscenes", place), ("waymo", interpolated(place))):
        trace = ego_and(tmp_path, {"a": track(positions)}, dataset=dataset)
        assert [row for row in checks(trace, "velocity_filtered") if row["actor_id"] == "a"] == []


def messages(t_s: np.ndarray) -> np.ndarray:
    """Return where an ego is that gains 2 m/s2 from 8 m/s."""
    return np.column_stack([8.0 * t_s + t_s**2, 0.02 * (8.0 * t_s + t_s**2)])


LOST_STEPS = (17, 18, 44, 90)
"""Steps over a lost message of 0.02 s; the first two follow each other."""


def counted_ego(*, begins_s: float, tail: int) -> tuple[np.ndarray, np.ndarray]:
    """Return an ego's places of counted messages, and where it was at the steps.

    The last `tail` steps are of the frames: so the converter fills up where messages run short.
    """
    steps = np.arange(121) * STEP_S
    longer = np.isin(np.arange(120), LOST_STEPS)
    place = messages(begins_s + np.r_[0.0, np.cumsum(STEP_S + 0.02 * longer)])
    truth = messages(steps)
    if tail:
        place[-tail:] = truth[-tail:]
    return place, truth


@pytest.mark.parametrize("begins_s", [0.0, 0.06, -0.04])
def test_the_ego_of_nuscenes_is_put_where_it_was_at_the_steps(tmp_path: Path, begins_s: float) -> None:
    place, truth = counted_ego(begins_s=begins_s, tail=3)
    ego = track(place, np.arctan(0.02), length=1.73, width=4.08, height=1.56, velocity=forward(place))
    ego["state"]["position"][:, 2] = 0.0
    trace = read(put(tmp_path, scenario({"ego": ego}, dataset="nuscenes", map="singapore-onenorth")))
    at = np.array([row["t_ns"] for row in states(trace, "ego")]) // 100_000_000
    ahead = 1.385 * np.array([np.cos(np.arctan(0.02)), np.sin(np.arctan(0.02))])
    got = np.column_stack([column(trace, "ego", name) for name in ("x_m", "y_m")])
    # without this, the ego would be 1.3 to 1.9 m too far ahead at the end, and 19 % too fast over the lost messages
    assert np.hypot(*(place - truth)[-4]) > 1.0
    assert np.hypot(*(got - truth[at] - ahead).T).max() < 0.05
    speed = np.hypot(column(trace, "ego", "vx_mps"), column(trace, "ego", "vy_mps"))
    assert np.abs(speed - (8.0 + 2.0 * at * STEP_S) * np.hypot(1.0, 0.02))[1:-1].max() < 0.25
    assert column(trace, "ego", "z_m") == pytest.approx(np.full(len(at), 0.78))
    (row,) = checks(trace, "ego_clock")
    assert "4 of its messages are lost, and each lost message makes a step 0.02 s longer" in row["message"]
    assert f"show that it begins {begins_s:.2f} s after these".replace("-0.00", "0.00") in row["message"]
    assert len(at) >= 118


def test_an_ego_whose_messages_do_not_run_short(tmp_path: Path) -> None:
    place, truth = counted_ego(begins_s=0.0, tail=0)
    ego = track(place, np.arctan(0.02), length=1.73, width=4.08)
    trace = read(put(tmp_path, scenario({"ego": ego}, dataset="nuscenes")))
    got = column(trace, "ego", "x_m") - 1.385 * np.cos(np.arctan(0.02))
    assert np.abs(got - truth[:, 0]).max() < 0.02
    (row,) = checks(trace, "ego_clock")
    assert "begins" not in row["message"]


def test_an_ego_that_brakes_hard_loses_no_message(tmp_path: Path) -> None:
    t = np.arange(81) * STEP_S
    speed = np.clip(20.0 - 8.0 * np.clip(t - 2.0, 0.0, None), 3.0, None)
    place = np.column_stack([np.r_[0.0, np.cumsum(speed[:-1]) * STEP_S], np.zeros(81)])
    trace = read(put(tmp_path, scenario({"ego": track(place, length=1.73, width=4.08)}, dataset="nuscenes")))
    assert checks(trace, "ego_clock") == []
    assert column(trace, "ego", "x_m") == pytest.approx(place[:, 0] + 1.385)


# ---- lights


def test_light_states(tmp_path: Path) -> None:
    words = [
        "LANE_STATE_GO", "LANE_STATE_ARROW_GO", "TRAFFIC_LIGHT_GREEN", "LANE_STATE_STOP", "LANE_STATE_ARROW_STOP",
        "TRAFFIC_LIGHT_RED", "LANE_STATE_CAUTION", "LANE_STATE_ARROW_CAUTION", "TRAFFIC_LIGHT_YELLOW", "LANE_STATE_FLASHING_STOP",
        "LANE_STATE_FLASHING_CAUTION", "LANE_STATE_UNKNOWN", "TRAFFIC_LIGHT_UNKNOWN", None, "NEW_WORD",
    ]  # fmt: skip
    lights = {"9": light(words, 9, (0.0, 0.0, 0.0))}
    trace = read(put(tmp_path, scenario({"ego": track(straight(15, 5.0))}, lights=lights)))
    rows = trace.tables["signal_state"].to_pylist()
    assert [(row["signal_id"], row["t_ns"]) for row in rows] == [("9", i * 100_000_000) for i in range(15)]
    assert [row["state"] for row in rows] == [
        *["green"] * 3, *["red"] * 3, *["amber"] * 3, *["flashing"] * 2, None, None, None, None,
    ]  # fmt: skip
    assert messages_of(trace, "unknown_word") == ["lights have states that are not known: NEW_WORD"]


# ---- what is refused


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ({"a": 1}, "it is not a scenario of ScenarioNet, because it has no dict 'metadata'"),
        ({"metadata": {}, "tracks": {}, "dynamic_map_states": {}}, "has no dict 'map_features'"),
        (scenario({"ego": track(straight(5, 1.0))}, ts=None), "metadata['ts'] is not an array of numbers"),
        (scenario({"ego": track(straight(5, 1.0))}, ts=np.array([np.nan] * 5)), "metadata['ts'] is not a list of times in seconds"),
        (scenario({"ego": track(straight(5, 1.0))}, ts=np.arange(4.0)), "is of the shape (5, 3), and the scenario has 4 steps"),
        (scenario({"ego": track(straight(5, 1.0)), "a": {"state": 5}}), "tracks['a'] has no dict 'state'"),
        (scenario({"ego": track(straight(5, 1.0)), "a": 7}), "tracks['a'] is not a dict"),
        (scenario({"ego": track(straight(5, 1.0), velocity=np.array(["a"] * 5))}), "['state']['velocity'] is not an array of numbers"),
        (scenario({"ego": track(straight(5, 1.0), position=None)}), "['state']['position'] is not an array of numbers"),
        (scenario({"ego": track(straight(5, 1.0))}, lights={"9": light(["LANE_STATE_GO"], 9, (0, 0, 0))}), "has not one word per step (5)"),
        (scenario({"ego": track(straight(5, 1.0))}, ts=np.arange(5.0) * 1e9), "not a list of times in seconds"),
    ],
)  # fmt: skip
def test_what_is_no_scenario(tmp_path: Path, content: Any, says: str) -> None:
    with pytest.raises(TraceError) as error:
        read(put(tmp_path, content))
    assert says in str(error.value)
    assert "sd_made_1.pkl: " in str(error.value)
    assert "\n" not in str(error.value)


def test_a_cut_file_is_one_line(tmp_path: Path) -> None:
    path = put(tmp_path, scenario({"ego": track(straight(50, 5.0))}))
    whole = path.read_bytes()
    for share in (0.02, 0.3, 0.99):
        path.write_bytes(whole[: int(share * len(whole))])
        said = r"sd_made_1\.pkl: it is cut off or damaged at byte \d+ of \d+: copy or write it again"
        with pytest.raises(TraceError, match=said):
            read(path)


def test_a_file_that_is_no_pickle(tmp_path: Path) -> None:
    path = tmp_path / "sd_1.pkl"
    path.write_text("t,x\n0,1\n")
    with pytest.raises(TraceError, match=r"not pkl: it should begin b'\\x80' and begins"):
        read(path)
    put(tmp_path, [1, 2], name="sd_1.pkl")
    with pytest.raises(TraceError, match="is not a scenario of ScenarioNet"):
        read(path)


def test_more_than_the_file_can_hold(tmp_path: Path) -> None:
    """A file may name the same track, light or line again and again."""
    shared, same_line = track(straight(4000, 1.0)), line([[0.0, 0.0]] * 4000)
    same_light = light(["LANE_STATE_GO"] * 4000, 1, (0, 0, 0))
    for content, what in (
        (scenario({str(i): shared for i in range(100)}), "400000 steps of tracks"),
        (scenario({"ego": shared}, lights={str(i): same_light for i in range(100)}), "400000 states of lights"),
        (scenario({"ego": shared}, features={str(i): same_line for i in range(100)}), "800000 points of map features"),
    ):
        with pytest.raises(TraceError, match=f"its {what} are more than the file can hold"):
            read(put(tmp_path, content))


@pytest.mark.parametrize("dataset", ["classes", "lights", "dataset", "sides", 5, None])
def test_a_data_set_of_any_name(dataset: Any, tmp_path: Path) -> None:
    trace = read(put(tmp_path, scenario({"ego": track(straight(21, 5.0))}, dataset=dataset)))
    assert log(trace)["sensor_range_m"] == 50.0


# ---- data sets of which ScenarioNet makes more than they have


def test_the_sizes_of_argoverse_are_guesses(tmp_path: Path) -> None:
    trace = read(put(tmp_path, scenario({"AV": track(straight(21, 5.0))}, dataset="av2")))
    assert actors(trace)["AV"]["length_m"] is None
    assert "sizes are guesses of ScenarioNet for this data set: they count as unknown" in trace.notes


def test_a_data_set_of_which_nothing_is_known(tmp_path: Path) -> None:
    trace = read(put(tmp_path, scenario({"ego": track(straight(21, 5.0))}, dataset="mine")))
    assert log(trace)["sensor_range_m"] == 50.0
    other = read(put(tmp_path, scenario({"ego": track(straight(21, 5.0))}, dataset="nuscenes")))
    assert log(other)["sensor_range_m"] == 40.0


# ---- folders


def test_a_folder_is_searched_for_scenarios_only(tmp_path: Path) -> None:
    content = scenario({"ego": track(straight(5, 1.0))})
    (tmp_path / "nuscenes_0").mkdir()
    names = "12.pkl", "sd_nuscenes_v1.0_scene-1.pkl"
    scenarios = [put(tmp_path / "nuscenes_0", content, name=name) for name in names]
    for name in ("dataset_summary.pkl", "dataset_mapping.pkl", "model.pkl"):
        put(tmp_path / "nuscenes_0", {}, name=name)
    assert expand_traces([str(tmp_path)]) == scenarios
    assert expand_traces([str(tmp_path / "*" / "[ds]*.pkl")]) == scenarios[1:]
    summary = tmp_path / "nuscenes_0" / "dataset_summary.pkl"
    assert expand_traces([str(summary)]) == [summary]
    with pytest.raises(TraceError, match="is not a scenario of ScenarioNet"):
        read(summary)
