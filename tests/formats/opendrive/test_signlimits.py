"""Speed limits that signs give, and limits that cannot be read."""

from __future__ import annotations

from typing import Any

import pytest

from drivelint.formats import load_map, read_source
from drivelint.report.progress import Silent
from drivelint.run import CheckOptions, check
from tests.formats.maps import messages
from tests.formats.opendrive.signal_text import WIDTH, signal
from tests.formats.opendrive.xodr import LINE, checks, lane, load, road, rows, section
from tests.shared_data import shared


def limits(environment: Any) -> list[tuple[str, float, float, float | None, str]]:
    return [
        (
            r["lanelet_id"], round(r["s_start_m"], 3), round(r["s_end_m"], 3),
            None if r["limit_mps"] is None else round(3.6 * r["limit_mps"], 3), r["source"],
        )
        for r in rows(environment, "speed_limit")
    ]  # fmt: skip


FIFTY = {"type": "274", "value": "50", "unit": "km/h"}


def two_roads(*signs: str, recorded: str = "", first: str = "") -> Any:
    """Two roads of 100 m, one after the other; the signs stand on the first."""
    one, two = (
        (
            section(0, lane(-1, f'<link><{end} id="-1"/></link>{WIDTH}')),
            f'<{end} elementType="road" elementId="{other}" {at}/>',
        )
        for end, other, at in (("successor", "2", 'contactPoint="start"'), ("predecessor", "1", 'contactPoint="end"'))
    )
    return load(
        road(lanes=one[0], link=one[1], more=f"{first}<signals>{''.join(signs)}</signals>"),
        road("2", LINE.replace('x="0"', 'x="100"'), lanes=two[0], link=two[1], more=recorded),
    )


def test_signs_give_limits_where_the_map_records_none() -> None:
    environment = two_roads(signal(30, **FIFTY), signal(60, type="274", value="30", unit="mph"))
    assert limits(environment) == [
        ("1.0.-1", 30.0, 60.0, 50.0, "sign"), ("1.0.-1", 60.0, 100.0, 48.28, "sign"), ("2.0.-1", 0.0, 100.0, 48.28, "sign"),
    ]  # fmt: skip


def test_a_limit_ends_at_the_sign_that_ends_it_and_a_recorded_one_counts_instead() -> None:
    assert limits(two_roads(signal(30, **FIFTY), signal(60, type="278"))) == [("1.0.-1", 30.0, 60.0, 50.0, "sign")]
    recorded = '<type s="0" type="rural"><speed max="100" unit="km/h"/></type>'
    assert limits(two_roads(signal(30, **FIFTY), recorded=recorded)) == [
        ("1.0.-1", 30.0, 100.0, 50.0, "sign"), ("2.0.-1", 0.0, 100.0, 100.0, "road_type"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("attributes", "cause"),
    [
        ({"value": ""}, "it has no number, or does not always apply"),
        ({"unit": "", "country": ""}, "its number has no known unit"),
        ({"unit": "", "country": "OpenDRIVE"}, "its number has no known unit"),
        ({"unit": "", "value": "55"}, "its number has no known unit"),  # no German sign
        ({"unit": "kn"}, "its number has no known unit"),
        ({"dynamic": "yes"}, "what it shows changes"),
    ],
)
def test_a_limit_sign_that_cannot_be_read_gives_an_unread_limit(attributes: dict[str, str], cause: str) -> None:
    environment = two_roads(signal(30, **{**FIFTY, **attributes}))
    assert limits(environment) == [("1.0.-1", 30.0, 100.0, None, "unread"), ("2.0.-1", 0.0, 100.0, None, "unread")]
    (message,) = messages(environment, "limit_sign_unread")
    assert f"the first, 7: {cause})" in message


@pytest.mark.parametrize(
    ("country", "code", "subtype", "value", "kmh"),
    [
        # the numbers of German signs are km/h: no sign shows their number in m/s
        ("DE", "274", "-1", "50", 50.0),
        ("deu", "274-50", "50", "50.0", 50.0),
        ("de", "274.1", "-1", "30", 30.0),
        # in esmini's catalogue, the value is the last part of the code: C31-5
        ("se", "c", "31", "5", 50.0),
        ("SE", "c", "31", "110", 110.0),
        ("se", "c", "31", "10", None),  # 10 or 100 km/h
        ("se", "c", "31", "1", None),
    ],
)
def test_a_number_without_a_unit_is_read_where_the_code_leaves_only_one(
    country: str, code: str, subtype: str, value: str, kmh: float | None
) -> None:
    environment = one_road(signal(30, country=country, type=code, subtype=subtype, value=value))
    assert limits(environment)[1][3:] == (kmh, "unread" if kmh is None else "sign")
    assert ("limit_sign_unread" in checks(environment)) == (kmh is None)
    assert "signs_unmapped" not in checks(environment)


def test_the_signs_of_a_map_of_esmini_state_the_limits_of_its_road() -> None:
    """Swedish signs stand at 0 and 100 m and a German one at 200 m, all without a unit; the type of the road changes at 100 m."""
    environment = load_map(read_source(shared("maps/straight_500m_signs.xodr")))
    assert [row for row in limits(environment) if row[0].endswith("-1")] == [
        ("1.0.-1", 0.0, 100.0, 50.0, "sign"), ("1.1.-1", 0.0, 100.0, 30.0, "sign"), ("1.1.-1", 100.0, 400.0, 50.0, "sign"),
    ]  # fmt: skip


def test_a_lane_limit_that_cannot_be_read_is_not_that_of_the_road() -> None:
    lanes = section(0, lane(-1, WIDTH + '<speed sOffset="0" max="fast" unit="mph"/>'))
    environment = load(road(more='<type s="0" type="town"><speed max="50" unit="km/h"/></type>', lanes=lanes))
    assert limits(environment) == [("1.0.-1", 0.0, 100.0, None, "unread")]


RURAL = '<type s="0" type="rural"><speed max="60" unit="mph"/></type>'
LANE_80 = '<speed sOffset="0" max="80" unit="km/h"/>'


def one_road(*signs: str, default: str = RURAL, inside: str = "") -> Any:
    """A road of 100 m in two lane sections of 50 m, with a lane to each side."""
    lanes = "".join(
        section(s, lane(1, WIDTH), lane(-1, f'<link><{end} id="-1"/></link>{WIDTH}{inside}'))
        for s, end in ((0, "successor"), (50, "predecessor"))
    )
    return load(road(lanes=lanes, more=f"{default}<signals>{''.join(signs)}</signals>"))


@pytest.mark.parametrize(("value", "unit", "kmh"), [("50", "km/h", 50.0), ("30", "mph", 48.28), ("10", "m/s", 36.0)])
def test_a_sign_goes_before_the_default_of_the_road_type(value: str, unit: str, kmh: float) -> None:
    """It holds from where it stands, in its direction, over the lane sections that follow."""
    environment = one_road(signal(30, type="274", value=value, unit=unit))
    assert [row for row in limits(environment) if row[0].endswith("-1")] == [
        ("1.0.-1", 0.0, 30.0, 96.561, "road_type"),
        ("1.0.-1", 30.0, 50.0, kmh, "sign"),
        ("1.1.-1", 0.0, 50.0, kmh, "sign"),
    ]
    assert {row[3:] for row in limits(environment) if row[0].endswith(".1")} == {(96.561, "road_type")}


SWEDISH = {"country": "SE", "type": "C31", "subtype": "3"}
SPEED = '<semantics><speed type="{}" value="30" unit="km/h"/>{}</semantics>'
DEFAULT, READ, UNREAD = (96.561, "road_type"), (30.0, "sign"), (None, "unread")


@pytest.mark.parametrize(
    ("inside", "attributes", "limit"),
    [
        (SPEED.format("maximum", ""), {}, READ),
        (SPEED.format("zone", ""), {}, READ),
        ('<semantics><speed type="maximum"/></semantics>', {"value": "30", "unit": "km/h"}, READ),
        (SPEED.format("recommended", ""), {"value": "30", "unit": "km/h"}, DEFAULT),
        (SPEED.format("minimum", ""), {}, DEFAULT),
        ("", {}, DEFAULT),
        # A speed on a sign whose code is not known may be a limit.
        ("", {"value": "30", "unit": "km/h"}, UNREAD),
        ("", {"value": "30", "unit": "t"}, DEFAULT),
        # Limits for some hours, some weather or some vehicles.
        (SPEED.format("maximum", '<supplementaryTime type="time" value="7"/>'), {}, UNREAD),
        (SPEED.format("maximum", '<supplementaryEnvironment type="rain"/>'), {}, UNREAD),
        (SPEED.format("maximum", '<supplementaryDistance type="for" value="500" unit="m"/>'), {}, READ),
    ],
)
def test_what_a_sign_means_is_read_or_its_limit_is_unknown(
    inside: str, attributes: dict[str, str], limit: tuple[float | None, str]
) -> None:
    environment = one_road(signal(30, inside=inside, **SWEDISH, **attributes))
    assert [row[3:] for row in limits(environment) if row[0].endswith("-1")][1:] == [limit] * (
        1 if limit == DEFAULT else 2
    )


def test_an_unread_speed_ends_the_limit_before_it() -> None:
    environment = one_road(signal(10, **FIFTY), signal(30, **SWEDISH, id="8", value="30", unit="km/h"))
    assert [row[1:] for row in limits(environment) if row[0] == "1.0.-1"] == [
        (0.0, 10.0, *DEFAULT), (10.0, 30.0, 50.0, "sign"), (30.0, 50.0, *UNREAD),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("plate", "inside", "limit"),
    [
        ({"type": "1042", "id": "8"}, '<dependency id="8"/>', UNREAD),
        ({"type": "1042", "id": "8", "inside": '<dependency id="7"/>'}, "", UNREAD),
        ({"type": "1000001", "id": "8", "dynamic": "yes"}, '<dependency id="8"/>', (50.0, "sign")),
        ({"type": "1042", "id": "8"}, "", (50.0, "sign")),
    ],
)
def test_a_limit_with_a_plate_that_is_not_read_is_unknown(
    plate: dict[str, str], inside: str, limit: tuple[float | None, str]
) -> None:
    environment = one_road(signal(30, inside=inside, **FIFTY), signal(30, **plate))
    assert [row[3:] for row in limits(environment) if row[0] == "1.1.-1"] == [limit]


def test_behind_the_end_of_a_limit_the_default_holds_again() -> None:
    environment = one_road(signal(30, **FIFTY), signal(40, type="278"))
    assert [row[1:] for row in limits(environment) if row[0] == "1.0.-1"] == [
        (0.0, 30.0, 96.561, "road_type"), (30.0, 40.0, 50.0, "sign"), (40.0, 50.0, 96.561, "road_type"),
    ]  # fmt: skip


def test_a_sign_goes_before_the_record_of_a_lane_and_the_difference_is_named() -> None:
    environment = one_road(signal(30, **FIFTY), inside=LANE_80)
    assert [row for row in limits(environment) if row[0].endswith("-1")] == [
        ("1.0.-1", 0.0, 30.0, 80.0, "lane"), ("1.0.-1", 30.0, 50.0, 50.0, "sign"), ("1.1.-1", 0.0, 50.0, 50.0, "sign"),
    ]  # fmt: skip
    assert checks(environment)["limit_contradicted"] == ["1.0.-1"]
    agreeing = one_road(signal(30, **{**FIFTY, "value": "80"}), inside=LANE_80)
    assert "limit_contradicted" not in checks(agreeing)


def test_a_sign_that_cannot_be_read_makes_the_default_unknown_but_not_the_record_of_the_lane() -> None:
    unread = signal(30, **{**FIFTY, "dynamic": "yes"})
    assert [row for row in limits(one_road(unread)) if row[0].endswith("-1")] == [
        ("1.0.-1", 0.0, 30.0, 96.561, "road_type"), ("1.0.-1", 30.0, 50.0, None, "unread"), ("1.1.-1", 0.0, 50.0, None, "unread"),
    ]  # fmt: skip
    assert {row[3:] for row in limits(one_road(unread, inside=LANE_80)) if row[0].endswith("-1")} == {(80.0, "lane")}


def test_a_sign_holds_on_a_road_that_follows_and_has_the_same_default() -> None:
    def two(second: str) -> Any:
        environment = two_roads(signal(30, **FIFTY), recorded=second, first=RURAL)
        return [row[1:] for row in limits(environment) if row[0] == "2.0.-1"]

    assert two(RURAL) == [(0.0, 100.0, 50.0, "sign")]
    assert two(RURAL.replace("60", "40")) == [(0.0, 100.0, 64.374, "road_type")]


def test_the_map_of_a_public_report() -> None:
    """After the OpenDRIVE schema: 60 mph is the road type's default; signs at 100, 200 and, the other way, 300 m go before it."""
    environment = load_map(read_source(shared("reported/opendrive_signs/offset.xodr")))
    assert [row for row in limits(environment) if row[0] in {"1.0.-1", "1.0.1"}] == [
        ("1.0.-1", 0.0, 100.0, 96.561, "road_type"), ("1.0.-1", 100.0, 200.0, 48.28, "sign"), ("1.0.-1", 200.0, 400.0, 50.0, "sign"),
        ("1.0.1", 0.0, 100.0, 96.561, "road_type"), ("1.0.1", 100.0, 400.0, 70.0, "sign"),
    ]  # fmt: skip


@pytest.mark.ci
def test_the_drive_of_a_public_report_is_too_fast() -> None:
    """It keeps 72 km/h all along: from 4.5 s on, at s = 100 m, 30 mph is the limit."""
    folder = shared("reported/opendrive_signs")
    options = CheckOptions(
        (str(folder / "d.csv"),), mapping=str(folder / "d.toml"), map=folder / "offset.xodr", rules=("ukhc.r124.speed-limit",),
        robustness=False,
    )  # fmt: skip
    result = check(options, Silent())
    assert result.verdicts.column("verdict").to_pylist() == ["fail"]
    (finding,) = result.findings.to_pylist()
    assert finding["t_start_ns"] == 4_500_000_000
