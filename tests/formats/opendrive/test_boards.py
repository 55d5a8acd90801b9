"""Signs on boards, signs that are crossed out, and signs that do not always apply."""

from __future__ import annotations

import pytest

from tests.formats.maps import checks, messages, rows, values
from tests.formats.opendrive.signal_text import signal
from tests.formats.opendrive.xodr import LINE, lane, load, road, section

TOWN = '<type s="0" type="town"><speed max="50" unit="km/h"/></type>'
LANES = section(0, lane(1), lane(-1), lane(-2))
LIMIT_30 = '<sign id="30" type="274" subtype="-1" country="DE" dynamic="no" value="30" unit="km/h" {}>{}</sign>'
BAN = '<sign id="ban" type="276" subtype="-1" country="DE" dynamic="no"/>'


def limits(*signals: str) -> dict[str, tuple[float | None, str]]:
    """Return lanelet -> the limit (km/h) at its end and its source, on a road with these signals and a limit of 50 km/h."""
    environment = load(road(lanes=LANES, more=f"{TOWN}<signals>{''.join(signals)}</signals>"))
    return {
        row["lanelet_id"]: (row["limit_mps"] and round(3.6 * row["limit_mps"], 3), row["source"])
        for row in sorted(rows(environment, "speed_limit"), key=lambda row: float(row["s_end_m"]))
    }


DEFAULT, READ, UNREAD = (50.0, "road_type"), (30.0, "sign"), (None, "unread")


def board(kind: str, *signs: str, inside: str = "") -> str:
    content = f"<staticBoard>{''.join(signs)}</staticBoard>" if signs else ""
    return signal(30, inside=content + inside, type=kind, country="", id="board")


def test_the_signs_on_a_static_board_apply_at_its_place() -> None:
    environment = load(
        road(lanes=LANES, more=f"<signals>{board('staticBoard', LIMIT_30.format('', ''), BAN)}</signals>")
    )
    found = values(environment, "traffic_signal", "signal_id kind value lanelet_id lane_s_m x_m")
    assert [row for row in found if row[0] != "board"] == [
        ("30", "speed_limit", 30.0, "1.0.-1", 30.0, 30.0), ("30", "speed_limit", 30.0, "1.0.-2", 30.0, 30.0),
        ("ban", "no_overtaking", None, "1.0.-1", 30.0, 30.0), ("ban", "no_overtaking", None, "1.0.-2", 30.0, 30.0),
    ]  # fmt: skip
    assert "signs_unmapped" not in checks(environment)


def test_a_sign_on_a_board_may_apply_to_one_lane() -> None:
    of_one_lane = LIMIT_30.format("", '<validity fromLane="-2" toLane="-2"/>')
    assert limits(board("staticBoard", of_one_lane)) == {"1.0.1": DEFAULT, "1.0.-1": DEFAULT, "1.0.-2": READ}


def test_a_reference_to_a_board_states_the_lanes_of_its_signs() -> None:
    defined = board("staticBoard", LIMIT_30.format("", '<validity fromLane="-2" toLane="-2"/>'))
    reference = '<signalReference id="board" s="40" t="0" orientation="+"><validity fromLane="-1" toLane="-1"/></signalReference>'
    environment = load(
        road(lanes=LANES, more=f"<signals>{defined}</signals>"),
        road("2", LINE.replace('x="0"', 'x="100"'), lanes=LANES, more=f"<signals>{reference}</signals>"),
    )
    assert values(environment, "traffic_signal", "lanelet_id lane_s_m", signal_id="30") == [
        ("1.0.-2", 30.0), ("2.0.-1", 40.0),
    ]  # fmt: skip


@pytest.mark.parametrize("kind", ["vmsBoard", "multiBoard"])
def test_a_board_that_changes_may_show_a_limit(kind: str) -> None:
    assert limits(board(kind)) == {"1.0.1": DEFAULT, "1.0.-1": UNREAD, "1.0.-2": UNREAD}


def test_a_sign_that_is_crossed_out_does_not_apply() -> None:
    thirty = {"type": "274", "value": "30", "unit": "km/h"}
    assert limits(signal(30, **thirty))["1.0.-1"] == READ
    assert limits(signal(30, **thirty, invalidated="false"))["1.0.-1"] == READ
    assert limits(signal(30, **thirty, invalidated="true"))["1.0.-1"] == DEFAULT
    assert limits(board("staticBoard", LIMIT_30.format('invalidated="1"', "")))["1.0.-1"] == DEFAULT
    environment = load(road(more=f"<signals>{signal(30, **thirty, invalidated='true')}</signals>"))
    assert "signal_without_lane" not in checks(environment)


HOURS = '<semantics><lane type="noOvertakeCars"/><supplementaryTime type="time" value="7"/></semantics>'
PLATE = signal(30, type="1042", id="8")


@pytest.mark.parametrize(
    ("signs", "conditional"),
    [
        (signal(30, type="276"), []),
        (signal(30, type="276") + PLATE, []),
        (signal(30, inside=HOURS, type="276"), ["1.0.-1", "1.0.-2"]),
        (signal(30, inside='<dependency id="8"/>', type="276") + PLATE, ["1.0.-1", "1.0.-2"]),
        # no rule looks at the conditions of other signs
        (signal(30, inside='<dependency id="8"/>', type="206") + PLATE, []),
    ],
)
def test_when_a_ban_with_a_plate_applies_is_not_known(signs: str, conditional: list[str]) -> None:
    environment = load(road(lanes=LANES, more=f"<signals>{signs}</signals>"))
    assert checks(environment).get("sign_condition_unread", []) == conditional
    assert all(
        message == "signal 7 applies only as its plates state (semantics or dependency): when it applies is not known"
        for message in messages(environment, "sign_condition_unread")
    )
