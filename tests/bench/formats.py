"""Reading: how many actor states a CPU second of every format, from the opening of the file to checked tables."""

from __future__ import annotations

import struct
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq
from mcap.reader import make_reader

from drivelint.drive.trace import IngestOptions
from drivelint.formats import read_trace
from tests.bench import ros, traffic
from tests.bench.clock import repeat
from tests.bench.table import Bar, Row
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from tests.bench.place import Place
    from tests.bench.traffic import Floats, Shape

LEAST, LEAST_OSI = 0.3, 1.0
PART = 10
"""Of formats that nobody writes long logs in, a tenth of the reference drive is read."""
LONG = str(ROOT / "fixtures" / "overtake" / "mapping.toml")


class Log(NamedTuple):
    """One log: how it is called in the table, how it is written and what its reader is told."""

    name: str
    write: Callable[[], Path]
    options: IngestOptions = IngestOptions(need_ego=False)
    least: float = LEAST


def formats(place: Place) -> list[Row]:
    """Measure every reader on the states of the reference drive."""
    rows = []
    for log in _logs(place):
        path = log.write()
        n = read_trace(path, log.options).tables["actor_state"].num_rows
        taken = repeat(partial(read_trace, path, log.options), place.sizes.runs)
        size = sum(file.stat().st_size for file in (path.iterdir() if path.is_dir() else [path])) / 1e6
        rate, bar = n / max(taken.cpu, 1e-9) / 1e6, Bar(log.least, at_least=True)
        note = f"{n} states, {size:.1f} MB, {taken.wall:.2f} s by the clock"
        rows.append(Row("formats", log.name, rate, "M states/CPU s", cpu=taken.cpu, bar=bar, note=note))
    return rows


def _logs(place: Place) -> Iterator[Log]:
    home, shape = place.home, place.sizes.reference
    columns = partial(_columns, shape)
    yield Log("OSI in MCAP", lambda: place.reference, least=LEAST_OSI)
    yield Log("OSI trace file", lambda: _osi(place.reference, home / "log.osi"), least=LEAST_OSI)
    yield Log("drivelint's own Parquet", lambda: traffic.write_folder(home / "tables", shape))
    yield Log("omega-prime Parquet", lambda: _parquet(home / "omega.parquet", _omega(columns())))
    yield Log("omega-prime CSV", lambda: _csv(home / "omega.csv", _omega(columns())))
    yield Log("SUMO FCD, Parquet", lambda: _parquet(home / "fcd.parquet", _fcd(columns())))
    yield Log("SUMO FCD, CSV", lambda: _csv(home / "fcd.csv", _fcd(columns()), ";"))
    yield Log("SUMO FCD, XML", lambda: _fcd_xml(home / "fcd.xml", _fcd(columns())))
    yield Log(
        "CSV, a row per actor",
        lambda: _csv(home / "long.csv", _long(columns())),
        IngestOptions(mapping=LONG, need_ego=False),
    )
    yield Log("CARLA test bench CSV", lambda: _csv(home / "carla.csv", _carla(columns())))
    yield Log("esmini CSV, columns per actor", lambda: _esmini(home / "esmini.csv", columns(), shape.actors))
    few = partial(_columns, shape._replace(seconds=shape.seconds / PART))
    yield Log("CommonRoad", lambda: _commonroad(home / "log.xml", few(), shape.hertz))
    steps = round(shape.seconds * shape.hertz)
    for name, write in ros.logs(steps).items():
        yield Log(name, partial(_write_log, write, home / "ros.mcap"))


def _write_log(write: Callable[[Path], None], path: Path) -> Path:
    write(path)
    return path


def _columns(shape: Shape) -> dict[str, Any]:
    """Return the states as columns, by time and then by actor, as recorders write them."""
    rows, _ = traffic.drive(shape)
    order = np.argsort(rows["t_ns"].to_numpy(), kind="stable")
    rows = rows.take(pa.array(order))
    return {name: rows[name].to_numpy() for name in rows.schema.names}


def _osi(log: Path, path: Path) -> Path:
    with log.open("rb") as read, path.open("wb") as write:
        for _, _, message in make_reader(read).iter_messages():
            write.write(struct.pack("<I", len(message.data)) + message.data)
    return path


def _parquet(path: Path, columns: dict[str, Any]) -> Path:
    pq.write_table(pa.table(columns), path)
    return path


def _csv(path: Path, columns: dict[str, Any], delimiter: str = ",") -> Path:
    # to the millimetre: with all their digits the text of numbers would be all that is measured
    rounded = {k: np.round(v, 3) if np.issubdtype(np.asarray(v).dtype, np.floating) else v for k, v in columns.items()}
    options = pa_csv.WriteOptions(delimiter=delimiter, quoting_style="none")
    pa_csv.write_csv(pa.table(rounded), path, options)
    return path


def _omega(of: dict[str, Any]) -> dict[str, Any]:
    n = len(of["t_ns"])
    same = {
        "length": 4.8,
        "width": 1.8,
        "height": 1.5,
        "roll": 0.0,
        "pitch": 0.0,
        "vel_z": 0.0,
        "acc_x": 0.1,
        "acc_y": 0.0,
        "acc_z": 0.0,
    }
    return {
        "total_nanos": of["t_ns"], "idx": of["actor_id"].astype(np.int64), "x": of["x_m"], "y": of["y_m"], "z": of["z_m"],
        "vel_x": of["vx_mps"], "vel_y": of["vy_mps"], "yaw": of["yaw_rad"], **{k: np.full(n, v) for k, v in same.items()},
        **{k: np.full(n, v, np.int64) for k, v in {"type": 2, "role": 0, "subtype": 4}.items()},
    }  # fmt: skip


def _fcd(of: dict[str, Any]) -> dict[str, Any]:
    yaw: Floats = of["yaw_rad"]
    n = len(yaw)
    return {
        "timestep_time": np.round(of["t_ns"] / 1e9, 3), "vehicle_id": of["actor_id"],
        "vehicle_x": np.round(of["x_m"] + 2.5 * np.cos(yaw), 3), "vehicle_y": np.round(of["y_m"] + 2.5 * np.sin(yaw), 3),
        "vehicle_angle": np.round(np.mod(90.0 - np.degrees(yaw), 360.0), 3), "vehicle_type": np.full(n, "DEFAULT_VEHTYPE"),
        "vehicle_speed": np.round(np.hypot(of["vx_mps"], of["vy_mps"]), 3), "vehicle_signals": np.zeros(n, np.int64),
    }  # fmt: skip


def _fcd_xml(path: Path, columns: dict[str, Any]) -> Path:
    names = [name.removeprefix("vehicle_") for name in columns if name != "timestep_time"]
    form = "    <vehicle " + " ".join(f'{name}="%s"' for name in names) + "/>\n"
    times, *values = columns.values()
    with path.open("w", encoding="utf-8") as file:
        file.write("<?xml version='1.0'?>\n<fcd-export>\n")
        last = None
        for t, *row in zip(times, *values, strict=True):
            if t != last:
                file.write(("" if last is None else "  </timestep>\n") + f'  <timestep time="{t:.2f}">\n')
                last = t
            file.write(form % tuple(row))
        file.write("  </timestep>\n</fcd-export>\n")
    return path


def _long(of: dict[str, Any]) -> dict[str, Any]:
    n = len(of["t_ns"])
    return {
        "time_s": of["t_ns"] / 1e9, "actor": of["actor_id"], "kind": np.full(n, "car"), "x_m": of["x_m"], "y_m": of["y_m"],
        "heading_deg": np.degrees(of["yaw_rad"]), "vx_mps": of["vx_mps"], "vy_mps": of["vy_mps"], "indicator": of["indicator"],
    }  # fmt: skip


def _carla(of: dict[str, Any]) -> dict[str, Any]:
    n = len(of["t_ns"])
    zero = np.zeros(n)
    return {
        "testNo": zero, "repeatNo": zero, "agentNo": of["actor_id"], "agentID": of["actor_id"],
        "agentType": np.full(n, "vehicle.audi.tt"), "agentTypeNo": zero, "x": of["x_m"], "y": -of["y_m"], "z": zero,
        "yaw": -of["yaw_rad"], "vel_x": of["vx_mps"], "vel_y": -of["vy_mps"], "vel_z": zero,
        "speed": np.hypot(of["vx_mps"], of["vy_mps"]), "time": of["t_ns"] / 1e9, "sim_time": of["t_ns"] / 1e9, "fps": zero + 60,
    }  # fmt: skip


def _esmini(path: Path, of: dict[str, Any], actors: int) -> Path:
    by_step = {name: np.asarray(values).reshape(-1, actors) for name, values in of.items()}
    zero = np.zeros(len(by_step["t_ns"]))
    columns: dict[str, Any] = {"TimeStamp [s]": by_step["t_ns"][:, 0] / 1e9}
    for k in range(actors):
        yaw = by_step["yaw_rad"][:, k]
        group = {
            "Entity_Name [-]": by_step["actor_id"][:, k], "World_Position_X [m]": by_step["x_m"][:, k] - 1.4 * np.cos(yaw),
            "World_Position_Y [m]": by_step["y_m"][:, k] - 1.4 * np.sin(yaw), "World_Position_Z [m]": zero,
            "Vel_X [m/s]": by_step["vx_mps"][:, k], "Vel_Y [m/s]": by_step["vy_mps"][:, k], "Acc_X [m/s2]": zero, "Acc_Y [m/s2]": zero,
            "World_Heading_Angle [rad]": yaw, "Heading_Angle_Rate [rad/s]": zero, "bb_x [m]": zero + 1.4, "bb_y [m]": zero,
            "bb_z [m]": zero + 0.75, "bb_length [m]": zero + 4.8, "bb_width [m]": zero + 1.8, "bb_height [m]": zero + 1.5,
        }  # fmt: skip
        columns |= {f"#{k + 1} {name}": values for name, values in group.items()}
    _csv(path, columns)
    path.write_text("Version: 2\n" + "x\n" * 5 + path.read_text("utf-8"), "utf-8")
    return path


def _commonroad(path: Path, of: dict[str, Any], hertz: int) -> Path:
    state = (
        "<{tag}><position><point><x>%.3f</x><y>%.3f</y></point></position><orientation><exact>%.4f</exact></orientation>"
        "<time><exact>%d</exact></time><velocity><exact>%.3f</exact></velocity></{tag}>"
    )
    parts = []
    speed = np.hypot(of["vx_mps"], of["vy_mps"])
    for name in dict.fromkeys(of["actor_id"].tolist()):
        mine = of["actor_id"] == name
        rows = zip(
            of["x_m"][mine], of["y_m"][mine], of["yaw_rad"][mine], range(int(mine.sum())), speed[mine], strict=True
        )
        first, *rest = rows
        parts.append(
            f'<dynamicObstacle id="{1000 + int(name)}"><type>car</type><shape><rectangle><length>4.8</length><width>1.8</width>'
            f"</rectangle></shape>{state.format(tag='initialState') % first}<trajectory>"
            + "".join(state.format(tag="state") % row for row in rest)
            + "</trajectory></dynamicObstacle>"
        )
    head = f'<commonRoad timeStepSize="{1 / hertz}" commonRoadVersion="2020a" benchmarkID="ZAM_Bench-1_1_T-1">'
    path.write_text(head + "".join(parts) + "</commonRoad>", "utf-8")
    return path
