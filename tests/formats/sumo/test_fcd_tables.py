"""Names of columns in SUMO's tables, and its times as clocks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.errors import DriveLintError, TraceError
from drivelint.formats.sumo import clock, fcd_xml
from tests.formats.logs import log, put, read, states
from tests.formats.sumo.fcd_text import ROWS, TYPES, csv, table, xml

MORE = ("pos", "lane", "edge", "slope")


def table_with_header(how: str) -> pa.Table:
    """The columns as `--output.column-header` of SUMO 1.28 has them, or called after a person; two steps of nobody (NULL) come first."""
    names = table().schema.names
    full = table()
    for name in MORE:
        value: Any = "a_0" if name == "lane" else "" if name == "edge" else 0.0
        full = full.append_column(f"vehicle_{name}", pa.array([value] * full.num_rows))
        names = full.schema.names
    bare = {name: name.removeprefix("timestep_").removeprefix("vehicle_") for name in names}
    by_how = {
        "tag": names,
        "plain": list(bare.values()),
        "full": [name if name == "timestep_time" else f"timestep_{name}" for name in names],
        "person": [name.replace("vehicle_", "person_") for name in names],
    }
    full = full.rename_columns(by_how[how])
    empty = pa.table({name: pa.nulls(2, full.schema.field(name).type) for name in full.schema.names})
    empty = empty.set_column(0, full.schema.field(0), pa.array([-0.2, -0.1]))
    return pa.concat_tables([empty, full])


@pytest.mark.parametrize("how", ["tag", "plain", "full", "person"])
@pytest.mark.parametrize("form", ["csv", "parquet"])
@pytest.mark.parametrize("separator", [";", ","])
def test_the_columns_names_are_known(tmp_path: Path, how: str, form: str, separator: str) -> None:
    put(tmp_path / "r.rou.xml", TYPES)
    expected = read(put(tmp_path / "plain.csv", csv()), ego="a.0")
    path = tmp_path / f"a.{form}"
    if form == "parquet":
        pq.write_table(table_with_header(how), path)
    else:
        rows = [
            table_with_header(how).schema.names,
            *([("" if v is None else v) for v in row.values()] for row in table_with_header(how).to_pylist()),
        ]
        put(path, "".join(separator.join(map(str, row)) + "\n" for row in rows))
    trace = read(path, ego="a.0")
    assert log(trace)["format"] == "sumo-fcd"
    own = {"drive_id", "brake_light", "indicator"}  # nobody's signals are known where columns are a person's
    mine, theirs = (
        [{k: v for k, v in row.items() if k not in own} for row in states(each)] for each in (trace, expected)
    )
    assert mine == theirs


def test_a_table_of_another_program_is_not_sumos(tmp_path: Path) -> None:
    path = put(tmp_path / "a.csv", "time,id,x,y,angle\n0.0,a,0.0,0.0,90.0\n0.1,a,1.0,0.0,90.0\n")
    with pytest.raises(DriveLintError, match="mapping"):
        read(path, ego="a")


@pytest.mark.parametrize("form", ["csv", "xml"])
def test_a_log_without_angles_says_so(tmp_path: Path, form: str) -> None:
    rows = [{k: v for k, v in row.items() if k != "angle"} for row in ROWS]
    with pytest.raises(TraceError, match="no heading: no vehicle has an angle"):
        read(put(tmp_path / f"a.{form}", (xml if form == "xml" else csv)(rows)), ego="a.0")


def test_some_states_without_an_angle(tmp_path: Path) -> None:
    rows = [ROWS[0] | {"angle": ""}, *ROWS[1:]]
    trace = read(put(tmp_path / "a.xml", xml(rows)), ego="a.0")
    assert states(trace, "b.0")[0]["x_m"] is None
    assert any(row["check_id"] == "no_angle" and row["n"] == 1 for row in trace.tables["quality"].to_pylist())


def clocks(rows: list[dict[str, Any]], days: int = 0) -> list[dict[str, Any]]:
    """Write times as SUMO's `--human-readable-time` does."""
    found = []
    for row in rows:
        t = float(row["time"]) + 3.0 * 3600 + 59 * 60 + 59
        text = f"{int(t // 3600):02d}:{int(t // 60) % 60:02d}:{t % 60:05.2f}"
        found.append(row | {"time": f"{days}:{text}" if days else text})
    return found


@pytest.mark.parametrize("days", [0, 2])
@pytest.mark.parametrize("form", ["csv", "xml", "parquet"])
def test_clocks_are_times(tmp_path: Path, form: str, days: int) -> None:
    rows = clocks(ROWS, days)
    path = tmp_path / f"a.{form}"
    if form == "parquet":
        whole = table()
        pq.write_table(whole.set_column(0, "timestep_time", pa.array([row["time"] for row in rows])), path)
    else:
        put(path, (xml if form == "xml" else csv_of_clocks)(rows))
    begin = (days * 24 * 3600 + 3 * 3600 + 59 * 60 + 59) * 10**9
    assert [row["t_ns"] - begin for row in states(read(path, ego="a.0"), "a.0")] == [t * 10**8 for t in range(20)]
    if form == "xml":
        assert fcd_xml.columns_from_lines(path.read_bytes()) is not None


def csv_of_clocks(rows: list[dict[str, Any]]) -> str:
    names = table(ROWS).schema.names
    return ";".join(names) + "\n" + "".join(";".join(map(str, row.values())) + "\n" for row in rows)


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("24:00:00.00", 86400.0), ("1:00:00:00.10", 86400.1), ("00:01:04.70", 64.7), ("12.5", 12.5), ("0:00:05", 5.0)],
)
def test_a_clock(text: str, seconds: float) -> None:
    assert clock.seconds(text) == pytest.approx(seconds, abs=1e-9)
    assert clock.seconds_of_texts(pa.array([text, None, "3"])).to_pylist() == [
        pytest.approx(seconds, abs=1e-9),
        None,
        3.0,
    ]


@pytest.mark.parametrize("text", ["1:2", "00:75:00", "a:b:c", "1:2:3:4:5", "-00:00:01"])
def test_what_is_no_clock(text: str) -> None:
    with pytest.raises(pa.ArrowInvalid):
        clock.seconds_of_texts(pa.array([text]))


def test_lights_have_clocks_too(tmp_path: Path) -> None:
    put(tmp_path / "a.fcd.xml", xml(clocks(ROWS)))
    put(tmp_path / "a.tls.xml", '<tlsStates><tlsState time="03:59:59.10" id="c" state="rG"/></tlsStates>')
    rows = read(tmp_path / "a.fcd.xml", ego="a.0").tables["signal_state"].to_pylist()
    assert {(row["signal_id"], row["t_ns"], row["state"]) for row in rows} == {
        ("c_0", 14_399_100_000_000, "red"),
        ("c_1", 14_399_100_000_000, "green"),
    }
