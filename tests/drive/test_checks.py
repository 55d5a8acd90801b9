"""What a log says about itself that cannot all be true; and who its ego is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.errors import TraceError, UsageError
from tests.formats.logs import LONG, actors, at, cars, mapping, quality, read, states, table

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace


def edited(lines: list[str], actor: str, rows: range, **cells: str) -> list[str]:
    """Return the lines with cells of the chosen rows (by number of the actor's sample) replaced."""
    names = lines[0].split(",")
    out, k = [lines[0]], -1
    for line in lines[1:]:
        parts = line.split(",")
        if parts[1] == actor:
            k += 1
            if k in rows:
                for name, text in cells.items():
                    parts[names.index(name)] = text
        out.append(",".join(parts))
    return out


def load(tmp_path: Path, lines: list[str], text: str = LONG, **options: str) -> Trace:
    return read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path, text), **options)


MOTION = ("x_m", "y_m", "z_m", "yaw_rad", "vx_mps", "vy_mps")


@pytest.mark.parametrize("ghost_first", [True, False])
def test_duplicates_that_differ_make_the_actor_unknown_there(ghost_first: bool, tmp_path: Path) -> None:
    lines, ghosts = cars(), ["0.500,b,99,99,0,0,0", "0.500,b,98,98,0,0,0"]
    trace = load(tmp_path, [lines[0], *ghosts, *lines[1:]] if ghost_first else lines + ghosts)
    row = quality(trace)["duplicate_state"]
    assert (row["severity"], row["n"], row["actor_id"], row["t_first_ns"]) == ("error", 2, "b", 500_000_000)
    assert "(b)" in row["message"]
    assert len(states(trace)) == 40
    assert {at(trace, "b", 0.5)[name] for name in MOTION} == {None}
    assert (at(trace, "b", 0.4)["x_m"], at(trace, "b", 0.6)["x_m"], at(trace, "a", 0.5)["vx_mps"]) == (4.0, 6.0, 10.0)


def test_duplicates_that_are_the_same_count_once(tmp_path: Path) -> None:
    lines = cars()
    trace = load(tmp_path, [*lines, *lines[1:]])
    assert states(trace) == [row | {"drive_id": trace.drive_id} for row in states(load(tmp_path, lines))]
    trace = load(tmp_path, [*lines, *lines[1:]])
    assert (quality(trace)["duplicate_state"]["severity"], quality(trace)["duplicate_state"]["n"]) == ("info", 40)


def test_what_duplicates_do_not_agree_on_is_unknown(tmp_path: Path) -> None:
    """Two classes and lengths of one box at one place: where it is counts, what it is counts from the other samples."""
    words = '\n[class]\ncolumn = "kind"\nvalues = { c = "car", p = "pedestrian" }\n'
    text = LONG.replace("length = 4.5", 'length = "len"') + words
    lines = [line + (",kind,len" if line[0] == "t" else ",c,4.5") for line in cars()]
    trace = load(tmp_path, [lines[0], lines[1].replace(",c,4.5", ",p,0.5"), *lines[1:]], text)
    assert (actors(trace)["a"]["actor_class"], actors(trace)["a"]["length_m"]) == ("car", 4.5)
    assert at(trace, "a", 0.0)["x_m"] == 0.0
    assert quality(trace)["duplicate_state"]["severity"] == "error"


@pytest.mark.parametrize("late", ["0.00", "0.04"])
def test_a_clock_that_starts_again_makes_everybody_unknown_where_it_runs_twice(late: str, tmp_path: Path) -> None:
    """Twenty steps, then the clock is set back to 0.5 s (or a little more: no two stamps are equal) and c joins."""
    again = []
    for line in cars(ids=("a", "b", "c"))[1:]:
        t, rest = line.split(",", 1)
        again.append(f"{0.5 + float(t) + float(late):.3f},{rest}")
    trace = load(tmp_path, [*cars(ids=("a", "b", "d")), *again])
    row = quality(trace)["clock_restart"]
    assert (row["severity"], row["actor_id"]) == ("error", None)
    for state in [*states(trace, "a"), *states(trace, "b")]:
        # the log goes through 0.5 (0.54) to 1.9 s twice; before and after there is one story
        twice = 0.5 + float(late) - 0.001 < state["t_ns"] / 1e9 < 1.901
        assert {state[name] is None for name in ("x_m", "y_m", "yaw_rad", "vx_mps")} == {twice}


def test_late_rows_and_other_orders_are_no_restart(tmp_path: Path) -> None:
    lines = cars(30)
    rows = lines[1:]
    straight = states(load(tmp_path, lines))
    by_actor = sorted(rows, key=lambda line: line.split(",")[1])
    minutes = sorted(rows, key=lambda line: (float(line.split(",")[0]) >= 1.5, line.split(",")[1]))
    for order in (
        rows[:10] + rows[14:30] + rows[10:14] + rows[30:],
        rows[::-1],
        by_actor,
        minutes,
        rows[30:] + rows[:30],
    ):
        trace = load(tmp_path, [lines[0], *order])
        assert [row | {"drive_id": ""} for row in states(trace)] == [row | {"drive_id": ""} for row in straight]
        assert not {"clock_restart", "duplicate_state"} & set(quality(trace))


def test_headings_in_degrees_are_refused_whatever_the_format(tmp_path: Path) -> None:
    """Canonical Parquet has no mapping to correct: along a bend 60 degrees are read as 60 rad."""
    rows = [
        {
            "t_ns": i * 100_000_000, "actor_id": "a", "is_ego": True,
            "x_m": 5.0 * i, "y_m": 8.66 * i, "yaw_rad": 60.0, "vx_mps": 50.0, "vy_mps": 86.6,
        }
        for i in range(30)
    ]  # fmt: skip
    pq.write_table(pa.Table.from_pylist(rows), tmp_path / "d.parquet")
    with pytest.raises(
        TraceError, match=r"d\.parquet: heading is off .*the heading is wrong: record or convert it again"
    ):
        read(tmp_path / "d.parquet")
    pq.write_table(pa.Table.from_pylist([row | {"yaw_rad": 1.0472} for row in rows]), tmp_path / "d.parquet")
    assert "yaw_mismatch" not in quality(read(tmp_path / "d.parquet"))


def test_noise_of_slow_traffic_is_no_wrong_frame(tmp_path: Path) -> None:
    """At 4 m/s and 10 Hz errors of 0.25 m are 3.5 m/s from step to step, and little over a second."""
    rng = np.random.default_rng(3)
    along = np.arange(200) * 0.1
    rows = [
        {
            "t_ns": i * 100_000_000, "actor_id": "a", "is_ego": True, "x_m": 2.8 * t + dx, "y_m": 2.8 * t + dy,
            "yaw_rad": np.pi / 4, "vx_mps": 2.8, "vy_mps": 2.8,
        }
        for i, (t, dx, dy) in enumerate(zip(along, *rng.normal(0, 0.25, (2, len(along))), strict=True))
    ]  # fmt: skip
    pq.write_table(pa.Table.from_pylist(rows), tmp_path / "d.parquet")
    assert quality(read(tmp_path / "d.parquet"))["velocity_mismatch"]["severity"] == "warning"


def test_velocity_that_is_not_the_motion(tmp_path: Path) -> None:
    found = quality(load(tmp_path, edited(cars(), "b", range(4, 6), vx="16.0")))
    assert found["velocity_mismatch"]["severity"] == "warning"
    assert (found["velocity_mismatch"]["n"], found["velocity_mismatch"]["t_first_ns"]) == (3, 400_000_000)
    assert "velocity_mismatch" not in quality(load(tmp_path, edited(cars(), "b", range(4, 6), vx="10.9")))


def test_heading_that_is_not_the_motion(tmp_path: Path) -> None:
    found = quality(load(tmp_path, edited(cars(), "b", range(4, 6), yaw="0.6")))
    assert (found["yaw_mismatch"]["n"], found["yaw_mismatch"]["actor_id"]) == (2, "b")
    assert "yaw_mismatch" not in quality(load(tmp_path, edited(cars(), "b", range(4, 6), yaw="0.5")))


def test_reversing_is_no_wrong_heading(tmp_path: Path) -> None:
    """Forwards for two seconds, then back at 4 m/s."""
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{i / 10},a,{i * 0.4:.3f},0,0,4,0" for i in range(20))]
    lines += [f"{2 + i / 10},a,{7.6 - i * 0.4:.3f},0,0,-4,0" for i in range(15)]
    assert "yaw_mismatch" not in quality(load(tmp_path, lines))


def test_length_below_width(tmp_path: Path) -> None:
    words = '\n[class]\ncolumn = "kind"\nvalues = { c = "car", p = "pedestrian" }\n'
    lines = [line + (",kind" if line[0] == "t" else ",c" if ",a," in line else ",p") for line in cars()]
    text = LONG.replace("length = 4.5", "length = 1.7")
    row = quality(load(tmp_path, lines, text + words))["length_below_width"]
    assert (row["n"], row["actor_id"]) == (1, "a")


def test_unknown_sizes(tmp_path: Path) -> None:
    row = quality(load(tmp_path, cars(), LONG.replace("length = 4.5\n", "")))["no_size"]
    assert (row["n"], row["severity"]) == (2, "warning")
    assert "of a, b is not known:" in row["message"]


def test_a_hole_in_the_log(tmp_path: Path) -> None:
    lines = [line for line in cars() if not 0.45 < float(line.split(",")[0].replace("t", "9")) < 0.95]
    found = quality(load(tmp_path, lines))
    assert (found["gap"]["n"], found["gap"]["t_first_ns"]) == (1, 400_000_000)
    assert "0.6 s" in found["gap"]["message"]
    assert "track_gap" not in found


def test_a_hole_in_one_track(tmp_path: Path) -> None:
    lines = [line for line in cars() if ",b," not in line or not 0.45 < float(line.split(",")[0]) < 0.95]
    found = quality(load(tmp_path, lines))
    assert (found["track_gap"]["actor_id"], found["track_gap"]["t_first_ns"]) == ("b", 400_000_000)
    assert "gap" not in found


def test_two_missing_samples_are_a_gap_and_one_is_not(tmp_path: Path) -> None:
    one = [line for line in cars() if not line.startswith("0.500")]
    two = [line for line in one if not line.startswith("0.600")]
    assert "gap" not in quality(load(tmp_path, one))
    assert "gap" in quality(load(tmp_path, two))


def test_a_jump(tmp_path: Path) -> None:
    found = quality(load(tmp_path, edited(cars(60), "b", range(30, 60), y="12.0")))
    assert (found["teleport"]["n"], found["teleport"]["t_first_ns"]) == (2, 2_900_000_000)
    assert found["track_parted"]["message"].endswith("(b#2)")
    assert "velocity_mismatch" not in found


def test_velocity_is_derived_where_absent(tmp_path: Path) -> None:
    trace = load(tmp_path, cars(), LONG.replace('vx = "vx"\nvy = "vy"\n', ""))
    assert [row["vx_mps"] for row in states(trace)] == pytest.approx([10.0] * 40)
    row = quality(trace)["velocity_derived"]
    assert (row["n"], row["severity"]) == (40, "warning")
    assert "no velocity in the log" in row["message"]


def test_velocity_zero_of_a_moving_actor_is_derived(tmp_path: Path) -> None:
    trace = load(tmp_path, edited(cars(), "b", range(20), vx="0.0"))
    assert at(trace, "b", 1.0)["vx_mps"] == pytest.approx(10.0)
    row = quality(trace)["velocity_derived"]
    assert (row["n"], row["actor_id"]) == (20, "b")


def test_velocity_of_another_motion_is_derived(tmp_path: Path) -> None:
    """Half as fast as the positions, all along: derived. Of a second only: unknown there."""
    trace = load(tmp_path, edited(cars(60), "b", range(60), vx="5.0"))
    assert {row["vx_mps"] for row in states(trace, "a")} == {10.0}
    assert [row["vx_mps"] for row in states(trace, "b")] == pytest.approx([10.0] * 60)
    row = quality(trace)["velocity_derived"]
    assert (row["n"], row["actor_id"], row["severity"]) == (60, "b", "warning")
    assert row["message"].startswith(
        "velocity that does not match the motion of the positions (b): velocity is derived"
    )
    assert "velocity_mismatch" not in quality(trace)
    trace = load(tmp_path, edited(cars(60), "b", range(20, 30), vx="5.0"))
    assert (at(trace, "b", 2.5)["vx_mps"], at(trace, "b", 2.5)["x_m"]) == (None, None)
    assert (
        quality(trace).keys() >= {"velocity_mismatch", "motion_unknown"} > quality(trace).keys() & {"velocity_derived"}
    )


def test_positions_that_tremble_do_not_make_a_velocity_wrong(tmp_path: Path) -> None:
    """Half a metre to and fro at 10 Hz is 10 m/s from step to step, and next to nothing over a second."""
    lines = cars(60)
    for i, line in enumerate(lines):
        cells = line.split(",")
        if cells[1] == "b":
            cells[2] = f"{float(cells[2]) + 0.5 * ((i // 2) % 2):.4f}"
            lines[i] = ",".join(cells)
    trace = load(tmp_path, lines)
    assert {row["vx_mps"] for row in states(trace, "b")} == {10.0}
    assert "velocity_mismatch" in quality(trace)
    assert "velocity_derived" not in quality(trace)


def test_driving_along_an_axis_is_not_standing_still(tmp_path: Path) -> None:
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{i / 10},a,{i / 10},{i},1.5708,0,10.5" for i in range(20))]
    trace = load(tmp_path, lines)
    assert {row["vy_mps"] for row in states(trace)} == {10.5}
    assert "velocity_derived" not in quality(trace)


def test_sizes_that_vary_are_reported(tmp_path: Path) -> None:
    lines = [line + (",len" if line[0] == "t" else ",4.5" if ",a," in line else "") for line in cars(5)]
    lines = [line if line.count(",") == 7 else f"{line},{4 + k % 5}" for k, line in enumerate(lines)]
    trace = load(tmp_path, lines, LONG.replace("length = 4.5", 'length = "len"'))
    sizes = sorted(4 + k % 5 for k, line in enumerate(lines) if ",b," in line)
    assert (actors(trace)["a"]["length_m"], actors(trace)["b"]["length_m"]) == (4.5, sizes[2])
    assert quality(trace)["size_varies"]["actor_id"] == "b"


@pytest.mark.parametrize(
    ("classes", "actor_class"),
    [
        (["object"] + ["car"] * 9, "car"),
        (["object"] * 2 + ["car"] * 8, None),
        (["pedestrian"] * 5 + ["bicycle"] * 5, None),
        (["car"] * 5 + ["truck"] * 5, "vehicle"),
        (["truck"] * 10, "truck"),
    ],
)
def test_a_class_that_changes_is_that_of_nearly_all_samples(
    tmp_path: Path, classes: list[str], actor_class: str | None
) -> None:
    words = '\n[class]\ncolumn = "kind"\n[class.values]\n' + "".join(
        f'{name} = "{name}"\n' for name in {"car", *classes}
    )
    lines = ["t,id,x,y,yaw,vx,vy,kind"]
    for i, kind in enumerate(classes):
        lines += [f"{i / 10},a,{i},0,0,10,0,car", f"{i / 10},b,{i},6,0,10,0,{kind}"]
    trace = load(tmp_path, lines, LONG + words)
    assert actors(trace)["b"]["actor_class"] == actor_class
    assert ("class_varies" in quality(trace)) == (len(set(classes)) > 1)


def test_velocity_zero_of_a_parked_actor_stays(tmp_path: Path) -> None:
    trace = load(tmp_path, edited(cars(), "b", range(20), vx="0.0", x="5.2"))
    assert {row["vx_mps"] for row in states(trace, "b")} == {0.0}
    assert "velocity_derived" not in quality(trace)


def test_nothing_is_derived_across_a_hole(tmp_path: Path) -> None:
    """A sample alone between two holes has no velocity; the one beside a hole takes its other side."""
    keep = {0, 1, 2, 10, 18, 19}
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{i / 10},a,{i * i / 10:.3f},0,0,0,0" for i in range(20) if i in keep)]
    trace = load(tmp_path, lines, LONG.replace('vx = "vx"\nvy = "vy"\n', ""))
    assert [row["vx_mps"] for row in states(trace)] == [
        pytest.approx(v) if v else None for v in (1, 2, 3, None, 37, 37)
    ]


def test_one_sample_is_a_drive(tmp_path: Path) -> None:
    trace = load(tmp_path, ["t,id,x,y,yaw,vx,vy", "0,a,0,0,0,0,0"])
    assert len(states(trace)) == 1


def test_ego_by_option(tmp_path: Path) -> None:
    assert {k: v["is_ego"] for k, v in actors(load(tmp_path, cars(), ego="b")).items()} == {"a": False, "b": True}
    with pytest.raises(TraceError, match=r"d\.csv: no actor 'z' in this log: use --ego ID \(ids: a, b\)"):
        load(tmp_path, cars(), ego="z")


def test_no_ego(tmp_path: Path) -> None:
    unnamed = LONG.replace('[ego]\nids = ["a"]\n', "")
    with pytest.raises(TraceError, match=r"no ego: the log does not name .*: use --ego ID or --ego all \(ids: a, b\)"):
        load(tmp_path, cars(), unnamed)
    with pytest.raises(
        TraceError, match=r"no ego: the log's ego 'q' has no states: use --ego ID or --ego all \(ids: a, b\)"
    ):
        load(tmp_path, cars(), LONG.replace('"a"', '"q"'))
    many = cars(2, ids=tuple(f"{i:02}" for i in range(30)))
    with pytest.raises(TraceError, match=r"\(ids: 00, 01, 02, 03, 04 and 25 more\)"):
        load(tmp_path, many)


def test_every_motor_vehicle_as_ego(tmp_path: Path) -> None:
    words = '\n[class]\ncolumn = "kind"\nvalues = { a = "car", b = "truck", p = "pedestrian", c = "bicycle" }\n'
    lines = cars(5, ids=("a", "b", "p", "c", "u"))
    lines = [line + (",kind" if line[0] == "t" else f",{line.split(',')[1]}") for line in lines]
    trace = load(tmp_path, lines, LONG + words, ego="all")
    assert {k for k, v in actors(trace).items() if v["is_ego"]} == {"a", "b"}
    assert "(u)" in quality(trace)["ego_count"]["message"]
    with pytest.raises(TraceError, match=r"no ego: no actor's class is known"):
        load(tmp_path, cars(), ego="all")


def test_sensor_range(tmp_path: Path) -> None:
    trace = read(table(tmp_path / "d.csv", cars()), mapping=mapping(tmp_path), sensor_range_m=80.0)
    assert trace.tables["data_log"].column("sensor_range_m").to_pylist() == [80.0]
    with pytest.raises(UsageError, match="more than 0 m"):
        read(tmp_path / "d.csv", mapping=mapping(tmp_path), sensor_range_m=-1.0)


def test_lights_are_named_and_counted(tmp_path: Path) -> None:
    row = quality(load(tmp_path, cars()))["no_indicator"]
    assert (row["actor_id"], row["n"], row["severity"]) == ("a", 20, "info")
    assert "(a) is unknown in 20 of 20 states" in row["message"]
