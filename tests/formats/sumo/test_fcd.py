"""SUMO's floating car data: three forms of one log, its frame and angles, vehicle types, what is damaged."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyarrow.csv as pa_csv
import pyarrow.parquet as pq
import pytest

from drivelint.engine.batch import Drive
from drivelint.errors import TraceError, UsageError
from drivelint.formats.sumo import fcd_xml
from tests.formats.logs import actors, at, log, put, quality, read, states
from tests.formats.sumo.fcd_text import ROWS, TYPES, csv, table, xml
from tests.scenes import verdict_rows

if TYPE_CHECKING:
    from pathlib import Path


def test_xml_csv_and_parquet_are_one_log(tmp_path: Path) -> None:
    put(tmp_path / "r.rou.xml", TYPES)
    pq.write_table(table(), tmp_path / "a.parquet")
    put(tmp_path / "a.csv", csv())
    put(tmp_path / "a.xml", xml())
    found = [read(tmp_path / f"a.{form}", ego="a.0") for form in ("xml", "csv", "parquet")]
    rows = [[{k: v for k, v in row.items() if k != "drive_id"} for row in states(trace)] for trace in found]
    assert rows[0] == rows[1] == rows[2]
    assert len(rows[0]) == 40
    assert {log(trace)["format"] for trace in found} == {"sumo-fcd"}


@pytest.mark.parametrize(
    ("option", "is_selection"),
    [
        ('<device.fcd.probability value="0.1"/>', True),
        ('<device.fcd.probability value="0"/>', True),
        ('<device.fcd.explicit value="a.0,b.0"/>', True),
        ('<person-device.fcd.probability value="0.5"/>', True),
        ('<fcd-output.filter-edges.input-file value="edges.txt"/>', True),
        ('<fcd-output.filter-shapes value="area"/>', True),
        ('<person-fcd-output value="persons.xml"/>', True),
        ('<device.fcd.probability value="1.0"/>', False),
        ('<device.fcd.probability value="-1"/>', False),
        ('<device.fcd.explicit value=""/>', False),
        ('<device.fcd.radius value="50"/>', False),
        ('<fcd-output.acceleration value="true"/>', False),
    ],
)
def test_rules_about_others_are_unknown_if_only_some_road_users_were_written(
    tmp_path: Path, option: str, is_selection: bool
) -> None:
    put(tmp_path / "r.rou.xml", TYPES)
    text = xml().replace("<sumoConfiguration/>", f"<sumoConfiguration><output>{option}</output></sumoConfiguration>")
    trace = read(put(tmp_path / "a.xml", text), ego="a.0")
    assert ("road_users_left_out" in quality(trace)) == is_selection
    (found,) = verdict_rows([Drive(trace, None)], rules=["ukhc.no-collision"])
    assert (found["verdict"], found["reason_code"]) == (
        ("unknown", "missing_road_users") if is_selection else ("pass", "kept")
    )


def test_line_by_line_is_what_the_parser_reads(tmp_path: Path) -> None:
    """Steps without vehicles, several vehicles a step: the fast way is taken, and reads the same."""
    text = xml(ROWS[:6]).replace("<fcd-export>\n", '<fcd-export>\n  <timestep time="0.00"/>\n')
    text = text.replace(
        "</fcd-export>", '  <timestep time="7.00"/>\n  <timestep time="8.00">\n  </timestep>\n</fcd-export>'
    )
    path = put(tmp_path / "a.xml", text)
    fast = fcd_xml.columns_from_lines(path.read_bytes())
    assert fast is not None
    assert fast["time"].to_pylist() == [float(row["time"]) for row in ROWS[:6]]
    slow, kind = fcd_xml.parse_columns_and_kinds(path, path.read_bytes())
    assert slow.keys() - fast.keys() == {"vehicle"}
    assert fast["time"].to_pylist() == [float(t) for t in slow["time"].to_pylist()]
    assert all(fast[name].to_pylist() == slow[name].to_pylist() for name in fast.keys() - {"time"})
    assert kind.tolist() == [0] * 6


_ROW = '<vehicle id="a.0" x="1.0" y="3.5" angle="90.0" type="quick" speed="10.0" signals="2" acceleration="0.5"/>\n'


@pytest.mark.parametrize(
    ("part", "replacement"),
    [
        ("  </timestep>\n  <timestep", "  </timestep><timestep"),
        ("  </timestep>\n", "  </timestep>\n    " + _ROW),
        ("<fcd-export>\n", '<fcd-export>\n  <timestep time="0.00"/>\n    ' + _ROW),
        ("<fcd-export>\n", "<fcd-export>\n    " + _ROW),
        ("<fcd-export>\n", '<fcd-export><timestep time="9.0">\n    ' + _ROW + "</timestep>\n"),
        ("  </timestep>\n  <timestep", "  </timestep> <!--\n  --><timestep"),
        ("  </timestep>\n", "  </timestep> <!-- -->\n"),
        ("</fcd-export>", "</fcd-export><!-- </fcd-export>"),
        ("/>\n    <vehicle", "/><vehicle"),
        ('/>\n    <vehicle id="a.0"', '><param key="a"/></vehicle>\n    <vehicle id="a.0"'),
        ('id="b.0"', 'id="b.0" id="c.0"'),
        ('id="b.0"', 'id="b<0"'),
        ('id="b.0"', 'id="b\t0"'),
        ("vehicle id=", "v:vehicle id="),
        ("<fcd-export>", '<!DOCTYPE a [<!ATTLIST vehicle lane CDATA "b">]><fcd-export>'),
        ("<?xml version='1.0'?>", "<?xml version='1.0' encoding='latin1'?>"),
        (' y="3.5"', " y='3.5'"),
        (' y="3.5"', ' y = "3.5"'),
        (' y="3.5"', ' y="3.5" x'),
        ('time="0.10"', 'time="0.10" a="b"'),
        ('time="0.10"', "time='0.10'"),
        ('time="0.10"', 'time="1_0"'),
        ('<timestep time="0.10"', '<TIMESTEP time="0.10"'),
        ("    <vehicle", "    <![CDATA[<a/>]]><vehicle"),
    ],
)
@pytest.mark.parametrize("n", [1, -1])
def test_what_is_not_line_by_line_is_left_to_the_parser(part: str, replacement: str, n: int) -> None:
    text = xml(ROWS[:6]).replace(part, replacement, n)
    assert replacement in text
    assert fcd_xml.columns_from_lines(text.encode()) is None


@pytest.mark.parametrize("form", ["csv", "xml"])
@pytest.mark.parametrize(
    ("cell", "message"),
    [
        ({"x": "abc"}, "x of vehicles: Failed to parse string: 'abc'"),
        ({"time": "12:3"}, "time of vehicles: "),
        ({"time": ""}, "without a valid time: "),
        ({"time": "1e300"}, "without a valid time: "),
    ],
)
def test_a_cell_that_is_no_number_is_refused(tmp_path: Path, form: str, cell: dict[str, str], message: str) -> None:
    rows = [*ROWS[:6], ROWS[6] | cell]
    text = xml(rows) if form == "xml" else csv(ROWS[:6]) + ";".join(map(str, rows[6].values())) + "\n"
    with pytest.raises(TraceError, match=message):
        read(put(tmp_path / f"a.{form}", text), ego="a.0")


def test_csv_written_anew_with_quotes(tmp_path: Path) -> None:
    plain = put(tmp_path / "a.csv", csv())
    head, rest = csv().split("\n", 1)
    quoted = '"' + head.replace(";", '";"') + '"\n' + rest
    (tmp_path / "b.csv").write_text(quoted, "utf-8-sig")
    assert states(read(tmp_path / "b.csv", ego="a.0"))[0]["x_m"] == states(read(plain, ego="a.0"))[0]["x_m"]
    assert log(read(tmp_path / "b.csv", ego="a.0"))["format"] == "sumo-fcd"


def test_front_bumper_and_compass(tmp_path: Path) -> None:
    put(tmp_path / "r.rou.xml", TYPES)
    seen = []
    for angle in (90.0, 0.0, 180.0, 270.0):
        stands = [row | {"angle": angle, "x": 0.0, "speed": 0.0} for row in ROWS[1:8:2]]
        row = states(read(put(tmp_path / f"{angle}.xml", xml(stands)), ego="a.0"))[0]
        seen.append((row["x_m"], row["y_m"], round(row["yaw_rad"], 6)))
    assert seen == [
        (pytest.approx(-2.0), pytest.approx(3.5), 0.0),
        (pytest.approx(0.0), pytest.approx(1.5), 1.570796),
        (pytest.approx(0.0), pytest.approx(5.5), -1.570796),
        (pytest.approx(2.0), pytest.approx(3.5), pytest.approx(-3.141593)),
    ]
    north = [row | {"angle": 0.0, "x": 0.0, "y": 3.5 + t} for t, row in enumerate(ROWS[1:8:2])]
    row = states(read(put(tmp_path / "north.xml", xml(north)), ego="a.0"))[1]
    assert (row["vx_mps"], row["vy_mps"], row["ay_mps2"]) == pytest.approx((0.0, 10.0, 0.5), abs=1e-9)


def test_types_classes_and_lights(tmp_path: Path) -> None:
    types = put(tmp_path / "given.xml", TYPES)
    trace = read(put(tmp_path / "a.xml", xml()), ego="a.0", mapping=str(types))
    assert {k: (v["actor_class"], v["length_m"], v["width_m"]) for k, v in actors(trace).items()} == {
        "a.0": ("car", 4.0, 1.7),
        "b.0": ("bus", 12.0, 2.5),
    }
    assert (at(trace, "a.0", 0.5)["indicator"], at(trace, "a.0", 0.5)["brake_light"]) == ("left", "off")
    assert (at(trace, "b.0", 0.5)["indicator"], at(trace, "b.0", 0.5)["brake_light"]) == ("off", "on")
    assert not trace.notes


def test_without_signals_the_lights_are_unknown(tmp_path: Path) -> None:
    rows = [{k: v for k, v in row.items() if k != "signals"} for row in ROWS]
    trace = read(put(tmp_path / "a.xml", xml(rows)), ego="a.0")
    assert {(row["indicator"], row["brake_light"]) for row in states(trace)} == {(None, None)}


def test_an_infinite_cell_is_unknown_and_said(tmp_path: Path) -> None:
    rows = [ROWS[0], ROWS[1] | {"acceleration": "inf"}, *ROWS[2:]]
    trace = read(put(tmp_path / "a.xml", xml(rows)), ego="a.0")
    assert at(trace, "a.0", 0.0)["ax_mps2"] is None
    assert quality(trace)["not_finite"]["n"] == 1


@pytest.mark.parametrize("form", ["csv", "xml"])
def test_a_log_without_types(tmp_path: Path, form: str) -> None:
    rows = [{k: v for k, v in row.items() if k != "type"} for row in ROWS]
    trace = read(put(tmp_path / f"a.{form}", (xml if form == "xml" else csv)(rows)), ego="a.0")
    assert actors(trace)["a.0"]["actor_class"] is None


def test_sizes_that_nobody_says_are_unknown(tmp_path: Path) -> None:
    trace = read(put(tmp_path / "a.xml", xml()), ego="a.0")
    assert actors(trace)["a.0"]["length_m"] is None
    assert "the sizes of the vehicle types bus, quick are not known" in quality(trace)["bumper_position"]["message"]


def test_sumos_default_types_are_known(tmp_path: Path) -> None:
    rows = [row | {"type": "DEFAULT_VEHTYPE"} for row in ROWS]
    trace = read(put(tmp_path / "a.xml", xml(rows)), ego="a.0")
    assert (actors(trace)["a.0"]["length_m"], actors(trace)["a.0"]["actor_class"]) == (5.0, "car")


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace('id="b.0"', 'id="b&amp;c"'),
        lambda text: text.replace(' signals="8"', "", 1),
        lambda text: text.replace('id="b.0" x="50.0"', 'x="50.0" id="b.0"', 1),
        lambda text: text.replace('<vehicle id="b.0"', '<person id="b.0"'),
    ],
)  # fmt: skip
def test_vehicles_that_do_not_look_alike_are_parsed(tmp_path: Path, change: Any) -> None:
    text = change(xml())
    assert text != xml()
    trace = read(put(tmp_path / "a.xml", text), ego="a.0")
    assert len(states(trace)) == 40
    assert states(trace, "a.0") == states(read(put(tmp_path / "a.xml", text), ego="a.0"), "a.0")
    assert set(actors(trace)) in ({"a.0", "b.0"}, {"a.0", "b&c"})


@pytest.mark.parametrize("n_letters", [1, 30, 500])
def test_a_file_that_breaks_off_is_refused(tmp_path: Path, n_letters: int) -> None:
    with pytest.raises(TraceError, match="not well-formed"):
        read(put(tmp_path / "a.xml", xml().rstrip()[:-n_letters]), ego="a.0")


@pytest.mark.parametrize("alike", [True, False])
def test_a_file_that_lacks_its_end_tag_alone_is_read_and_said_to_be_cut(tmp_path: Path, *, alike: bool) -> None:
    """The writer was killed between two steps. `alike`: all its vehicles have the same attributes, so that it is read by lines."""
    text = xml() if alike else xml().replace('id="b.0" x="50.0"', 'x="50.0" id="b.0"', 1)
    cut = read(put(tmp_path / "cut.xml", text.rstrip().removesuffix("</fcd-export>")), ego="a.0")
    whole = read(put(tmp_path / "a.xml", text), ego="a.0")
    mine, wanted = (trace.tables["actor_state"].drop_columns("drive_id") for trace in (cut, whole))
    assert mine.equals(wanted)
    lost = quality(cut)["lost_time"]
    assert "ends without </fcd-export>" in lost["message"]
    assert (lost["severity"], lost["t_first_ns"]) == ("error", max(row["t_ns"] for row in states(cut)))


def test_a_log_without_vehicles(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match="no vehicle"):
        read(put(tmp_path / "a.xml", "<fcd-export><timestep time='0'/></fcd-export>"), ego="a")


def test_a_types_file_without_types(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="has no vType"):
        read(put(tmp_path / "a.xml", xml()), ego="a.0", mapping=str(put(tmp_path / "t.xml", "<routes/>")))


@pytest.mark.parametrize("form", ["csv", "parquet"])
def test_a_step_at_which_nobody_is_there_is_no_loss(tmp_path: Path, form: str) -> None:
    """SUMO 1.28 writes a row with the time alone; a row with a place and no name is a loss."""
    put(tmp_path / "r.rou.xml", TYPES)

    def write_with_row(**row: Any) -> str:
        text = csv() + ";".join(str(row.get(name, "")) for name in ("time", *list(ROWS[0])[1:])) + "\n"
        put(tmp_path / "a.csv", text)
        if form == "parquet":
            parsed = pa_csv.read_csv(tmp_path / "a.csv", parse_options=pa_csv.ParseOptions(delimiter=";"))
            pq.write_table(parsed, tmp_path / "a.parquet")
        return f"a.{form}"

    empty = read(tmp_path / write_with_row(time=5.0), ego="a.0")
    assert "dropped_row" not in quality(empty)
    assert len(states(empty)) == 40
    assert quality(read(tmp_path / write_with_row(time=5.0, x=3.0), ego="a.0"))["dropped_row"]["n"] == 1
