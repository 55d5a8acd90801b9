"""Objects at other rates than the ego's: interpolated at its steps, unknown in holes, left alone where nothing is to be gained."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.formats import read_trace
from tests.formats.logs import LONG, mapping, put, quality, states, table

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from drivelint.drive.trace import Trace

MS = 1_000_000


def load(tmp_path: Path, tracks: dict[str, NDArray[np.int64]], ego: str = "a") -> Trace:
    """Return a log in which everybody drives on a circle of 50 m at 10 m/s, sampled at these milliseconds."""
    lines = ["t,id,x,y,yaw,vx,vy"]
    for name, times in tracks.items():
        for t in times:
            turn = 10.0 * t / 1000 / 50.0
            place = f"{50 * np.sin(turn):.6f},{-50 * np.cos(turn):.6f},{np.angle(np.exp(1j * turn)):.6f}"
            lines.append(f"{t},{name},{place},{10 * np.cos(turn):.6f},{10 * np.sin(turn):.6f}")
    text = LONG.replace('column = "t"', 'column = "t"\nunit = "ms"')
    return read_trace(table(tmp_path / "d.csv", lines), IngestOptions(mapping=mapping(tmp_path, text), ego=ego))


def times(trace: Trace, actor: str) -> list[int]:
    return [row["t_ns"] // MS for row in states(trace, actor)]


def off(row: dict[str, Any]) -> float:
    """Return how far a state is from where it should be."""
    turn = 10.0 * row["t_ns"] / 1e9 / 50.0
    return float(np.hypot(row["x_m"] - 50 * np.sin(turn), row["y_m"] + 50 * np.cos(turn)))


def test_a_rarer_object_has_a_state_at_every_step_of_the_ego(tmp_path: Path) -> None:
    """50 Hz and 10 Hz over 20 s, round the circle more than half: the heading passes half a turn."""
    trace = load(tmp_path, {"a": np.arange(0, 20_000, 20), "b": np.arange(33, 20_000, 100)})
    assert times(trace, "b") == list(range(0, 20_000, 20))
    for row in states(trace, "b"):
        turn = 10.0 * row["t_ns"] / 1e9 / 50.0
        assert off(row) < 0.02
        assert abs(np.angle(np.exp(1j * (row["yaw_rad"] - turn)))) < 0.02
        assert np.hypot(row["vx_mps"], row["vy_mps"]) == pytest.approx(10.0, abs=0.01)
    found = quality(trace)["aligned"]
    assert (found["severity"], found["actor_id"], found["n"]) == ("info", "b", 1)
    assert "samples no more than 0.25 s apart" in found["message"]
    assert "track_gap" not in quality(trace)


@pytest.mark.parametrize("period_ms", [60, 100, 250])
def test_the_velocity_of_a_rarer_object_is_derived_from_its_own_samples(tmp_path: Path, period_ms: int) -> None:
    lines = ["t,id,x,y,yaw"]
    for name, step_ms, speed in (("a", 20, 10.0), ("b", period_ms, 8.0)):
        lines += [f"{t},{name},{speed * t / 1000:.4f},0,0" for t in range(0, 10_000, step_ms)]
    text = LONG.replace('column = "t"', 'column = "t"\nunit = "ms"').replace('vx = "vx"\nvy = "vy"\n', "")
    trace = read_trace(table(tmp_path / "d.csv", lines), IngestOptions(mapping=mapping(tmp_path, text), ego="a"))
    assert [row["vx_mps"] for row in states(trace, "b")] == pytest.approx([8.0] * len(states(trace, "b")))
    assert len(states(trace, "b")) > 480


def test_a_jump_of_a_rarer_object_is_found(tmp_path: Path) -> None:
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{t},a,{10 * t / 1000:.4f},0,0,10,0" for t in range(0, 6_000, 20))]
    lines += [f"{t},b,{10 * t / 1000:.4f},{3.5 if t < 3_000 else 15.5},0,10,0" for t in range(0, 6_000, 100)]
    text = LONG.replace('column = "t"', 'column = "t"\nunit = "ms"')
    trace = read_trace(table(tmp_path / "d.csv", lines), IngestOptions(mapping=mapping(tmp_path, text), ego="a"))
    assert quality(trace)["teleport"]["t_first_ns"] == 2_900 * MS
    assert quality(trace)["track_parted"]["message"].endswith("(b#2)")


def test_in_a_hole_it_has_none(tmp_path: Path) -> None:
    b = np.arange(33, 4_000, 100)
    trace = load(tmp_path, {"a": np.arange(0, 4_000, 20), "b": b[(b < 1_000) | (b > 1_500)]})
    found = times(trace, "b")
    assert [t for t in found if 900 < t < 1_600][:3] == [920, 1_540, 1_560]
    assert found[-1] == 3_980
    hole = quality(trace)["track_gap"]
    assert (hole["actor_id"], hole["n"], hole["t_first_ns"]) == ("b", 1, 933 * MS)
    short = load(tmp_path, {"a": np.arange(0, 4_000, 20), "b": b[(b < 1_000) | (b > 1_100)]})
    assert times(short, "b") == list(range(0, 4_000, 20))  # one sample is missing: 0.2 s


def test_nobody_is_there_before_its_first_sample_or_after_its_last(tmp_path: Path) -> None:
    trace = load(tmp_path, {"a": np.arange(0, 4_000, 20), "b": np.arange(1_033, 2_000, 100)})
    assert (times(trace, "b")[0], times(trace, "b")[-1]) == (1_040, 1_920)
    assert max(off(row) for row in states(trace, "b")) < 0.02


def test_a_track_goes_on_to_the_ends_of_the_log(tmp_path: Path) -> None:
    """At 50 ms and at 3,970 ms only the next frame lacks."""
    trace = load(tmp_path, {"a": np.arange(0, 4_000, 20), "b": np.arange(50, 3_971, 100)})
    assert (times(trace, "b")[0], times(trace, "b")[-1]) == (0, 3_980)
    assert max(off(row) for row in states(trace, "b")) < 0.02


def test_the_ego_under_another_id_is_not_there_before(tmp_path: Path) -> None:
    """The ego's id changes after 2 s: its successor has no state at its last step."""
    trace = load(
        tmp_path, {"a": np.arange(0, 2_000, 50), "b": np.arange(2_000, 4_000, 50), "c": np.arange(0, 4_000, 50)}
    )
    placed = [row["t_ns"] // MS for row in states(trace, "a") if row["x_m"] is not None]
    assert placed[-1] == 1_950
    assert times(trace, "b") == list(range(2_000, 4_000, 50))
    assert "aligned" not in quality(trace)


@pytest.mark.parametrize(
    "b",
    [
        np.arange(0, 4_000, 20),  # the ego's times
        np.arange(1_000, 2_000, 20),  # some of them
        np.delete(np.arange(0, 4_000, 20), slice(20, 150)),  # with a hole
        np.arange(0, 4_000, 10),  # more of them
        np.arange(33, 4_000, 400),  # too rarely
        np.array([1_033]),  # once
    ],
)
def test_who_is_left_alone(tmp_path: Path, b: NDArray[np.int64]) -> None:
    trace = load(tmp_path, {"a": np.arange(0, 4_000, 20), "b": b})
    assert times(trace, "b") == b.tolist()
    assert "aligned" not in quality(trace)


def test_a_finer_track_keeps_its_samples(tmp_path: Path) -> None:
    b = np.arange(3, 4_000, 20)
    trace = load(tmp_path, {"a": np.arange(0, 4_000, 100), "b": b})
    assert times(trace, "b") == sorted({*b.tolist(), *range(0, 4_000, 100)})


def test_all_egos_keep_their_own_samples(tmp_path: Path) -> None:
    text = LONG + '[class]\ncolumn = "id"\ndefault = "car"\n'
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{i / 50},a,{i / 5},0,0,10,0" for i in range(100))]
    lines += [f"{0.003 + i / 10},b,{0.03 + i},4,0,10,0" for i in range(20)]
    put(tmp_path / "m.toml", text)
    trace = read_trace(table(tmp_path / "d.csv", lines), IngestOptions(mapping=str(tmp_path / "m.toml"), ego="all"))
    assert len(states(trace, "b")) == 20
