"""Files that are missing, foreign, broken or hostile: one clear line each; parts that are broken: named."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint.errors import ExitCode, MapError, UsageError
from drivelint.formats import load_map, read_source
from drivelint.formats import map_registry as registry
from drivelint.road.map_reader import MapSource
from tests.formats.maps import checks, lanelets, rows
from tests.formats.opendrive.xodr import LINE, geometry, lane, load, road, section, xodr

if TYPE_CHECKING:
    from pathlib import Path


def refusal(content: bytes | str) -> str:
    content = content.encode() if isinstance(content, str) else content
    with pytest.raises(MapError) as error:
        load_map(MapSource("some.xodr", content))
    assert error.value.exit_code is ExitCode.NOT_JUDGED
    message = str(error.value)
    assert "some.xodr" in message
    assert "\n" not in message
    return message


def test_missing_unreadable_and_empty_files(tmp_path: Path) -> None:
    with pytest.raises(MapError, match=r"does not exist.*--map"):
        read_source(tmp_path / "none.xodr")
    with pytest.raises(MapError, match=r"cannot be read"):
        read_source(tmp_path)
    (tmp_path / "empty.xodr").touch()
    with pytest.raises(MapError, match=r"is empty"):
        read_source(tmp_path / "empty.xodr")


def test_a_file_name_is_exactly_that_file(tmp_path: Path) -> None:
    path = tmp_path / "a[1] x=9.xodr"
    path.write_text(xodr())
    source = read_source(path)
    assert source.name == "a[1] x=9.xodr"
    assert load_map(source).environment_id == f"a[1] x=9-{source.sha256[:8]}@rht?"


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("<OpenSCENARIO/>", "OpenSCENARIO"),
        ("<!DOCTYPE html>\n<html><body>404</body></html>", "HTML"),
        ("<roads/>", "<roads>"),
        (b"\x89MCAP0\r\n", "not XML"),
        ("x,y\n1,2\n", "not XML"),
        *((bytes([tag]) + b"ust a text, no map\n", "neither XML nor OSI") for tag in (0x4A, 0x52, 0x8A, 0x92, 0x9A)),
        (b"", "not XML"),
    ],
)
def test_other_formats_are_told_what_they_look_like(content: bytes | str, says: str) -> None:
    message = refusal(content)
    assert says in message
    assert "OpenDRIVE" in message


def test_malformed_and_truncated_xml() -> None:
    assert "not well-formed" in refusal("<OpenDRIVE><road></OpenDRIVE>")
    assert "not well-formed" in refusal(xodr()[:-40])
    assert "not well-formed" in refusal("<OpenDRIVE>" + "<a>" * 100_000)


@pytest.mark.parametrize(
    "doctype",
    [
        "<!DOCTYPE OpenDRIVE>",
        '<!DOCTYPE OpenDRIVE [<!ENTITY a "x">]>',
        '<!DOCTYPE OpenDRIVE SYSTEM "file:///etc/passwd">',
        '<!DOCTYPE OpenDRIVE [<!ENTITY a SYSTEM "file:///etc/passwd">]>',
        '<!DOCTYPE OpenDRIVE [<!ENTITY a "' + "x" * 5000 + '"><!ENTITY b "' + "&a;" * 5000 + '">]>',
    ],
)
def test_a_doctype_is_refused(doctype: str) -> None:
    body = xodr().replace("<OpenDRIVE>", "<OpenDRIVE>&b;" if "ENTITY b" in doctype else "<OpenDRIVE>")
    assert "DOCTYPE" in refusal(doctype + body)


def test_a_file_that_is_too_large_is_refused_before_it_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "MAX_MAP_BYTES", 100)
    (tmp_path / "some.xodr").write_text(xodr())
    with pytest.raises(MapError, match="but at most 100 are read"):
        read_source(tmp_path / "some.xodr")
    assert "at most 100 are read" in refusal(xodr())


def test_a_map_without_a_lane_says_why() -> None:
    assert "no roads" in refusal("<OpenDRIVE/>")
    assert "<geometry>" in refusal(xodr(road(geometry="<a/>")))


@pytest.mark.parametrize(
    ("broken", "says"),
    [
        (road("2", '<geometry s="0" x="nan" y="0" hdg="0" length="9"><line/></geometry>'), "not a finite number"),
        (road("2", '<geometry s="0" x="1e999" y="0" hdg="0" length="9"><line/></geometry>'), "not a finite number"),
        (road("2", '<geometry s="0" y="0" hdg="0" length="9"><line/></geometry>'), "no attribute x"),
        (road("2", '<geometry s="0" x="0" y="0" hdg="0" length="9"><clothoid/></geometry>'), "clothoid"),
        (road("2", '<geometry s="0" x="0" y="0" hdg="0" length="9"/>'), "is empty"),
        (road("2", '<geometry s="0" x="0" y="0" hdg="0" length="9"><arc curvature="1e9"/></geometry>'), "turns"),
        (road("2", length=1e8), "1e+08 m"),
        (road("2", length=1e12), "larger than any value on a road"),
        (road("2", lanes="<a/>"), "no <laneSection>"),
        (road("2", lanes=section(0, lane(-1), lane(-1))), "same lane twice"),
        (road("1"), "same id"),
    ],
)
def test_a_road_that_cannot_be_read_is_named_and_the_others_stay(broken: str, says: str) -> None:
    environment = load(road("1"), broken)
    assert set(lanelets(environment)) == {"1.0.1", "1.0.-1"}
    row = rows(environment, "map_quality", severity="error", check_id="invalid_road")[0]
    assert says in row["message"]
    assert row["lanelet_id"] == ("1" if broken == road("1") else "2")


def test_a_lane_that_cannot_be_built_is_named_with_those_that_lie_on_it() -> None:
    lanes = section(0, lane(1), lane(-1), lane(-2, '<width sOffset="0" a="wide"/>'), lane(-3), lane(2, ""))
    environment = load(road(lanes=lanes))
    assert set(lanelets(environment)) == {"1.0.1", "1.0.-1"}
    assert sorted(str(name) for name in checks(environment)["invalid_lane"]) == ["1.0.-2", "1.0.-3", "1.0.2"]


@pytest.mark.parametrize("width", ['a="2000"', 'a="3" d="1"', 'a="3" c="1e8"'])
def test_a_lane_wider_than_any_road_costs_its_section_only(width: str) -> None:
    lanes = section(0, lane(-1)) + section(50, lane(-1, f'<width sOffset="0" {width}/>'))
    environment = load(road(lanes=lanes))
    assert set(lanelets(environment)) == {"1.0.-1"}
    assert checks(environment)["invalid_lane"] == ["1.1.-1"]


def test_a_polynomial_that_stands_still_costs_its_section_only() -> None:
    zero = " ".join(f'{c}{axis}="0"' for c in "abcd" for axis in "UV")
    still = geometry(f'<paramPoly3 pRange="arcLength" {zero}/>', 50, (50, 0, 0), 50)
    first = LINE.replace('length="100"', 'length="50"')
    environment = load(road(geometry=first + still, lanes=section(0, lane(-1)) + section(50, lane(-1))))
    assert set(lanelets(environment)) == {"1.0.-1"}
    assert checks(environment)["invalid_lane"] == ["1.1.-1"]


def test_namespaces_and_encodings_do_not_matter() -> None:
    plain = load(road())
    spaced = xodr(road()).replace(
        "<OpenDRIVE>", '<OpenDRIVE xmlns="http://code.asam.net/simulation/standard/opendrive_schema">'
    )
    wide = '<?xml version="1.0" encoding="utf-16"?>' + xodr(road())
    for content in (spaced.encode(), wide.encode("utf-16"), b"\xef\xbb\xbf" + xodr(road()).encode()):
        environment = load_map(MapSource("small.xodr", content))
        assert lanelets(environment).keys() == lanelets(plain).keys()


def test_options_without_a_meaning() -> None:
    with pytest.raises(UsageError, match="handedness 'left'"):
        load(road(), handedness="left")
    with pytest.raises(UsageError, match="offset"):
        load(road(), offset=(float("nan"), 0.0))


@pytest.mark.parametrize(
    ("offset", "offset_text"),
    [
        ((0, 0), ""),
        ((-0.0, 0.0), ""),
        ((2.618, 3.113), "+2.618+3.113"),
        ((-1, 0), "-1.0+0.0"),
        ((1e-7, 0), "+1e-07+0.0"),
    ],
)
def test_environment_ids_are_the_same_everywhere(offset: tuple[float, float], offset_text: str) -> None:
    environment = load(road(), offset=offset, handedness="lht")
    digest = MapSource("small.xodr", xodr(road()).encode()).sha256[:8]
    assert environment.environment_id == f"small-{digest}{offset_text}@lht"
    row = rows(environment, "environment")[0]
    assert (row["offset_x_m"], row["offset_y_m"]) == pytest.approx(offset)
    assert (row["format"], row["name"], row["sha256"][:8]) == ("opendrive", "small.xodr", digest)
