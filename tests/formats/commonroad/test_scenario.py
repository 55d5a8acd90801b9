"""CommonRoad scenarios as drives."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

from drivelint.errors import TraceError
from drivelint.formats.commonroad import scenario as commonroad
from tests.formats.logs import actors, at, log, put, quality, read, states
from tests.shared_data import shared

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from drivelint.drive.trace import Trace


def state(tag: str, t: int, x: float, *, v: float = 10.0, yaw: float = 0.0, more: str = "") -> str:
    return (
        f"<{tag}><position><point><x>{x}</x><y>2</y></point></position><orientation><exact>{yaw}</exact></orientation>"
        f"<time><exact>{t}</exact></time><velocity><exact>{v}</exact></velocity>{more}</{tag}>"
    )


def obstacle(
    name: int, kind: str, inner: str, shape: str = "<rectangle><length>4</length><width>2</width></rectangle>"
) -> str:
    return f'<dynamicObstacle id="{name}"><type>{kind}</type><shape>{shape}</shape>{inner}</dynamicObstacle>'


def moving(name: int = 1, kind: str = "car", n: int = 20, yaw: float = 0.0) -> str:
    path = "".join(state("state", t, float(t), yaw=yaw) for t in range(1, n))
    return obstacle(name, kind, state("initialState", 0, 0.0, yaw=yaw) + f"<trajectory>{path}</trajectory>")


def write(tmp_path: Path, *parts: str, attributes: str = 'timeStepSize="0.1"') -> Path:
    return put(tmp_path / "a.xml", f"<?xml version='1.0'?><commonRoad {attributes}>{''.join(parts)}</commonRoad>")


def test_moving_and_standing_obstacles(tmp_path: Path) -> None:
    still = '<staticObstacle id="5"><type>parkedVehicle</type><shape><circle><radius>1</radius></circle></shape>'
    path = write(tmp_path, moving(), still + state("initialState", 0, 40.0, v=0.0) + "</staticObstacle>")
    trace = read(path, ego="1")
    assert (log(trace)["format"], log(trace)["n_states"]) == ("commonroad", 40)
    assert {k: (v["actor_class"], v["length_m"], v["width_m"]) for k, v in actors(trace).items()} == {
        "1": ("car", 4.0, 2.0),
        "5": ("vehicle", 2.0, 2.0),
    }
    row = at(trace, "1", 1.5)
    assert (row["x_m"], row["vx_mps"], row["vy_mps"], row["indicator"]) == (15.0, 10.0, 0.0, None)
    assert at(trace, "5", 1.9)["x_m"] == 40.0
    assert trace.embedded_map is None


def test_velocity_lies_along_the_heading_and_its_slip_angle(tmp_path: Path) -> None:
    slip = "<slipAngle><exact>0.1</exact></slipAngle>"
    inner = (
        state("initialState", 0, 0.0) + "<trajectory>" + state("state", 1, 1.0, yaw=0.5, more=slip) + "</trajectory>"
    )
    row = at(read(write(tmp_path, obstacle(1, "car", inner)), ego="1"), "1", 0.1)
    assert (row["vx_mps"], row["vy_mps"]) == pytest.approx((10 * math.cos(0.6), 10 * math.sin(0.6)))


def test_indicators_of_a_scenario_are_not_known(tmp_path: Path) -> None:
    """The converter of CommonRoad writes indicators that are off for drone recordings, which have none: no lane change is blamed for them.

    Source: seen with commonroad-dataset-converter 2025.1.0 (findings/commonroad-highd-indicators-off.sh).
    """
    off = "<indicatorLeft>false</indicatorLeft><indicatorRight>false</indicatorRight>"
    lights = [f"<time><exact>{t}</exact></time>{off}" for t in range(20)]
    series = "".join(f"<signalState>{light}</signalState>" for light in lights[1:])
    text = moving().replace("<trajectory>", f"<initialSignalState>{lights[0]}</initialSignalState><trajectory>")
    text = text.replace("</trajectory>", f"</trajectory><signalSeries>{series}</signalSeries>")
    trace = read(write(tmp_path, text), ego="1")
    assert log(trace)["n_states"] == 20
    assert {at(trace, "1", k / 10)["indicator"] for k in range(20)} == {None}


def test_intervals_are_not_known(tmp_path: Path) -> None:
    unsure = "<orientation><intervalStart>0</intervalStart><intervalEnd>1</intervalEnd></orientation>"
    inner = (
        state("initialState", 0, 0.0)
        + "<trajectory>"
        + state("state", 1, 1.0).replace("<orientation><exact>0.0</exact></orientation>", unsure)
        + "</trajectory>"
    )
    trace = read(write(tmp_path, obstacle(1, "car", inner)), ego="1")
    assert at(trace, "1", 0.1)["yaw_rad"] is None
    assert "uncertain_value" in quality(trace)


def test_the_older_version_and_the_files_own_map(tmp_path: Path) -> None:
    old = moving().replace("dynamicObstacle", "obstacle").replace("<type>", "<role>dynamic</role><type>")
    trace = read(write(tmp_path, old, '<lanelet id="1"/>'), ego="1")
    assert log(trace)["n_states"] == 20
    assert trace.embedded_map == (tmp_path / "a.xml").read_bytes()


@pytest.mark.parametrize(
    ("parts", "attributes", "why"),
    [
        ([], 'timeStepSize="0.1"', "no obstacles"),
        ([moving()], "", "timeStepSize is None"),
        ([moving()], 'timeStepSize="0"', "positive number"),
        ([moving(), moving()], 'timeStepSize="0.1"', "same id: 1"),
        ([moving().replace("<time><exact>3</exact></time>", "")], 'timeStepSize="0.1"', "without an exact time"),
        (["<x>"], 'timeStepSize="0.1"', "not well-formed"),
        (["</state>"], 'timeStepSize="0.1"', "not well-formed"),
    ],
)
def test_what_is_refused(tmp_path: Path, parts: list[str], attributes: str, why: str) -> None:
    with pytest.raises(TraceError, match=why):
        read(write(tmp_path, *parts, attributes=attributes))


@pytest.mark.parametrize(
    ("name", "ego", "n_actors", "n_states"),
    [
        ("DEU_Gar-1_1_T-1", "200", 4, 84),
        ("OSC_Overtake-1_1_T-1", "256", 2, 402),
        ("OSC_PedestrianCollision-1_1_T-1", "34", 2, 186),
        ("USA_US101-5_1_T-1", "464", 25, 1619),
    ],
)
def test_real_scenarios(name: str, ego: str, n_actors: int, n_states: int) -> None:
    trace = read(shared(f"commonroad/{name}.xml"), ego=ego)
    assert (len(actors(trace)), len(states(trace))) == (n_actors, n_states)
    assert not {"yaw_mismatch", "teleport", "no_size", "gap"} & set(quality(trace))
    assert trace.embedded_map is not None


SLIP = "<slipAngle><exact>0.1</exact></slipAngle>"


@pytest.mark.parametrize(
    ("change", "fast"),
    [
        (lambda text: text, True),
        (lambda text: text.replace("><", ">\n  <"), True),
        (lambda text: text.replace("<dynamicObstacle", "<!-- a & b --><dynamicObstacle"), True),
        (lambda text: text.replace("<dynamicObstacle", "<!-- <trajectory></trajectory> --><dynamicObstacle", 1), False),
        (lambda text: text.replace("<x>5.0</x>", "<x> 5.0 </x>"), True),
        (lambda text: text.replace("</velocity></state>", f"</velocity>{SLIP}</state>"), True),
        (lambda text: text.replace("</velocity></state>", f"</velocity>{SLIP}</state>", 3), False),
        (lambda text: text.replace("<x>5.0</x><y>2</y>", "<y>2</y><x>5.0</x>", 1), False),
        (lambda text: text.replace("<exact>10.0</exact>", "<intervalStart>9</intervalStart><intervalEnd>11</intervalEnd>"), False),
        (lambda text: text.replace("<x>5.0</x>", "<x>five</x>", 1), False),
        (lambda text: text.replace("<x>5.0</x>", "<x>5.0<!-- about --></x>", 1), False),
        (lambda text: text.replace("<x>5.0</x>", "<x>&#53;.0</x>", 1), False),
        (lambda text: text.replace("<trajectory>", "<trajectory><note>x</note>", 1), False),
        (lambda text: text.replace("<trajectory>", '<trajectory kind="a">', 1), False),
        (lambda text: text.replace("</initialState></dynamicObstacle>", "</initialState><trajectory/></dynamicObstacle>"), False),
    ],
)  # fmt: skip
def test_the_text_of_trajectories_is_read_as_their_elements_are(
    change: Callable[[str], str], fast: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path, moving(1), moving(2, "bus", n=7, yaw=0.2), obstacle(3, "car", state("initialState", 0, 9.0)))
    path.write_text(change(path.read_text("utf-8")), "utf-8")
    assert (commonroad.extract_trajectories(path.read_bytes()) is not None) == fast
    first = read(path, ego="1")
    monkeypatch.setattr(commonroad, "extract_trajectories", lambda _content: None)
    second = read(path, ego="1")
    assert first.tables == second.tables
    assert len(states(first)) == 20 + 7 + 1


@pytest.mark.parametrize("name", ["DEU_Gar-1_1_T-1", "OSC_Overtake-1_1_T-1", "USA_US101-5_1_T-1"])
def test_real_trajectories_read_either_way(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    path = shared(f"commonroad/{name}.xml")
    first = read(path, need_ego=False)
    monkeypatch.setattr(commonroad, "extract_trajectories", lambda _content: None)
    assert first.tables == read(path, need_ego=False).tables


def light(name: int, *phases: tuple[int, str], offset: str = "", more: str = "") -> str:
    inner = "".join(f"<cycleElement><duration>{n}</duration><color>{c}</color></cycleElement>" for n, c in phases)
    said = f"<timeOffset>{offset}</timeOffset>" if offset else ""
    return f'<trafficLight id="{name}"><cycle>{inner}{said}</cycle>{more}</trafficLight>'


def lit(trace: Trace) -> list[tuple[str, float, str | None]]:
    rows = trace.tables["signal_state"].to_pylist()
    return [(row["signal_id"], row["t_ns"] / 1e9, row["state"]) for row in rows]


FULL = ((6, "green"), (2, "yellow"), (7, "red"), (1, "redYellow"))


@pytest.mark.parametrize(
    ("of", "expected"),
    [
        (light(7, *FULL), "0.0 green, 0.6 amber, 0.8 red, 1.5 red_amber, 1.6 green"),
        # the cycle begins at step 3: before that it is in the last cycle
        (light(7, *FULL, offset="3"), "0.0 red, 0.2 red_amber, 0.3 green, 0.9 amber, 1.1 red, 1.8 red_amber, 1.9 green"),
        (light(7, *FULL, offset="35"), "0.0 red, 0.2 red_amber, 0.3 green, 0.9 amber, 1.1 red, 1.8 red_amber, 1.9 green"),
        (light(7, *FULL, more="<timeOffset>16</timeOffset>"), "0.0 green, 0.6 amber, 0.8 red, 1.5 red_amber, 1.6 green"),
        (light(7, (400, "green")), "0.0 green"),
        (light(7, (5, "red"), (5, "red")), "0.0 red"),
        (light(7, *FULL, more="<active>false</active>"), "0.0 off"),
        (light(7, *FULL, more="<active>true</active>", offset="-10"), "0.0 red, 0.5 red_amber, 0.6 green, 1.2 amber, 1.4 red"),
        (light(7, (9, "green"), (30, "inactive")), "0.0 green, 0.9 off"),
    ],
)  # fmt: skip
def test_the_cycle_of_a_light_over_the_time_of_the_log(of: str, expected: str, tmp_path: Path) -> None:
    trace = read(write(tmp_path, moving(), of), ego="1")
    assert ", ".join(f"{t} {state}" for _, t, state in lit(trace)) == expected
    assert "signal_cycle" not in quality(trace)


@pytest.mark.parametrize(
    ("of", "expected", "why"),
    [
        (light(7), [], "7 are not known: it has no cycle"),
        (light(7, (0, "green")), [], "has no duration"),
        (light(7, (5, "green"), offset="soon"), [], "time offset is not a number"),
        (light(7, (5, "green"), (90, "blue")), [(0.0, "green"), (0.5, None)], "not known: blue"),
    ],
)
def test_a_light_that_cannot_be_read_is_named(
    of: str, expected: list[tuple[float, str | None]], why: str, tmp_path: Path
) -> None:
    trace = read(write(tmp_path, moving(), of, light(8, (99, "red"))), ego="1")
    assert lit(trace) == [*(("7", t, state) for t, state in expected), ("8", 0.0, "red")]
    (message,) = [row["message"] for row in trace.tables["quality"].to_pylist() if row["check_id"] == "signal_cycle"]
    assert why in message


def test_the_lights_of_a_real_scenario() -> None:
    """Four lights with a cycle of 400 green, 30 yellow, 570 red: offset 590 is step 410 of the cycle at 0, 1090 is step 910."""
    trace = read(shared("commonroad/USA_Peach-4_8_T-1.xml"), need_ego=False)
    assert lit(trace) == [
        ("43918", 0.0, "amber"),
        ("43918", 2.0, "red"),
        ("43919", 0.0, "red"),
        ("43920", 0.0, "amber"),
        ("43920", 2.0, "red"),
        ("43921", 0.0, "red"),
    ]
