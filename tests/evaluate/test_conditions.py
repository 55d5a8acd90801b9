"""Where a rule holds: the conditions of its header, three-valued, and whether the automated driver drives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import (
    AFTER,
    EXECUTION,
    INVARIANT,
    brief,
    findings,
    verdicts,
    write,
)

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.catalogue import Rule

SPEED = {"reads": '["ego_state"]', "unit": '"m/s"', "sense": '">="'}
SPEED_SQL = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 10 AS required FROM ego_state"
REFERENCE = "SELECT drive_id, ego_id, t_ns FROM exit_taken"
AT = {"reads": '["ego_state", "exit_taken"]'}

PASS, OUT, NOWHERE = ("pass", "kept"), ("not_applicable", "outside_conditions"), ("not_applicable", "not_triggered")


def invariant(tmp_path: Path, applies: str = "", **header: str) -> Rule:
    return write(
        tmp_path, INVARIANT | SPEED | header, {"condition": SPEED_SQL}, tables=applies and f"[applies]\n{applies}"
    )


def at_event(tmp_path: Path, applies: str = "", kind: dict[str, str] = EXECUTION, **sections: str) -> Rule:
    body = {"reference": REFERENCE, "condition": SPEED_SQL} | sections
    return write(tmp_path, kind | SPEED | AT, body, name="event", tables=applies and f"[applies]\n{applies}")


def drive(speeds: list[Any], *, at: Any = None, **conditions: Any) -> dict[str, Any]:
    """Return a scene at ten steps a second in which these conditions hold."""
    times = [i / 10 for i in range(len(speeds))]
    scene: dict[str, Any] = {
        "ego_state": {"t_s": times, "speed_mps": speeds},
        "ego_condition": {"t_s": times, **conditions},
    }
    return scene | ({} if at is None else {"exit_taken": {"t_s": at}})


@pytest.mark.sample(2, ci=10)
@pytest.mark.parametrize(
    ("applies", "conditions", "expected"),
    [
        ('road_type = ["town"]', {"road_type": "town"}, "in"),
        ('road_type = ["town"]', {"road_type": "townLocal"}, "in"),
        ('road_type = ["townLocal"]', {"road_type": "town"}, "road_type_unknown"),
        ('road_type = ["town"]', {"road_type": "rural"}, "out"),
        ('road_type = ["town"]', {"road_type": None}, "road_type_unknown"),
        ('road_type = ["town", "rural"]', {"road_type": "rural"}, "in"),
        ('carriageway = ["dual"]', {"carriageway": "single"}, "out"),
        ('carriageway = ["dual"]', {}, "carriageway_unknown"),
        ('area = ["built_up"]', {"area": "built_up"}, "in"),
        ('area = ["open"]', {"area": "built_up"}, "out"),
        ('nation = ["gb"]', {"nation": "gb-sct"}, "in"),
        ('nation = ["gb-sct"]', {"nation": "gb"}, "nation_unknown"),
        ('nation = ["gb-sct"]', {"nation": "gb-eng"}, "out"),
        ('nation = ["gb-sct", "gb"]', {"nation": "gb"}, "in"),
        ('nation = ["de"]', {"nation": "gb"}, "out"),
        ('nation = ["de"]', {}, "nation_unknown"),
        ('weather = ["wet", "ice"]', {"weather": "ice"}, "in"),
        ('weather = ["wet", "ice"]', {"weather": "dry"}, "out"),
        ('light = ["night"]', {"light": "day"}, "out"),
        ('vehicle_class = ["car"]', {"vehicle_class": "car_towing"}, "out"),
        ('vehicle_class = ["car"]', {}, "vehicle_class_unknown"),
        ("limit_min_mps = 13.41", {"limit_mps": 13.4112}, "in"),
        ("limit_min_mps = 13.42", {"limit_mps": 13.4112}, "in"),  # rounding of mph and km/h
        ("limit_min_mps = 13.5", {"limit_mps": 13.4112}, "out"),
        ("limit_max_mps = 13.41", {"limit_mps": 13.4112}, "in"),
        ("limit_max_mps = 13.3", {"limit_mps": 13.4112}, "out"),
        ("limit_min_mps = 13\nlimit_max_mps = 18", {"limit_mps": 17.88}, "in"),
        ("limit_min_mps = 13\nlimit_max_mps = 18", {"limit_mps": 22.35}, "out"),
        ("limit_min_mps = 13\nlimit_max_mps = 18", {"limit_mps": 8.94}, "out"),
        ("limit_min_mps = 13", {}, "limit_unknown"),
        # all together: one that is false settles it, whatever is not known
        ('weather = ["wet"]\nlight = ["night"]', {"weather": "wet", "light": "night"}, "in"),
        ('weather = ["wet"]\nlight = ["night"]', {"weather": "wet", "light": "day"}, "out"),
        ('weather = ["wet"]\nlight = ["night"]', {"weather": None, "light": "day"}, "out"),
        ('weather = ["wet"]\nlight = ["night"]', {"weather": "wet", "light": None}, "light_unknown"),
        ('weather = ["wet"]\nlight = ["night"]', {}, "weather_unknown"),
        # and the driver's engagement with them
        ('weather = ["wet"]', {"weather": None, "engaged": False}, "never"),
        ('weather = ["wet"]', {"weather": "dry", "engaged": None}, "out"),
        ('weather = ["wet"]', {"weather": "wet", "engaged": None}, "engaged_unknown"),
        ("", {"engaged": True}, "in"),
        ("", {"engaged": False}, "never"),
        ("", {"engaged": None}, "engaged_unknown"),
    ],
)
def test_a_rule_holds_where_all_its_conditions_do(
    tmp_path: Path, applies: str, conditions: dict[str, Any], expected: str
) -> None:
    scene = drive([12, 12, 12], at=0.1, **conditions)
    ends = {"in": (PASS, PASS), "out": (NOWHERE, OUT), "never": (("not_applicable", "not_engaged"), OUT)}
    wanted = ends.get(expected, (("unknown", expected), ("unknown", expected)))
    rules = invariant(tmp_path, applies), at_event(tmp_path, applies)
    assert tuple(brief(verdicts(rule, scene)) for rule in rules) == tuple([end] for end in wanted)


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize(
    ("law", "nation", "is_judged"),
    [
        ("de", "de", True),
        ("de", "gb", False),
        ("de", "gb-sct", False),
        ("de", None, True),
        ("gb", "gb-sct", True),
        ("gb-sct", "gb", True),  # may be Scotland
        ("gb-sct", "gb-eng", False),
        ("gb", "fr", False),
    ],
)
def test_the_law_of_a_nation_is_not_applied_in_another(
    tmp_path: Path, law: str, nation: str | None, is_judged: bool
) -> None:
    """What fails there fails still where the nation is not known; a signal that is missing too does not matter."""
    scene = drive([9, 12, 9], at=0.2, nation=nation)
    rules = invariant(tmp_path, law=f'["{law}"]'), at_event(tmp_path, kind=EXECUTION | {"law": f'["{law}"]'})
    foreign = ("not_applicable", "other_nation")
    for rule in rules:
        (row,) = verdicts(rule, scene)
        assert (row["verdict"], row["reason_code"]) == (("fail", row["reason_code"]) if is_judged else foreign)
        assert len(findings(rule, scene)) == is_judged
    needs = invariant(tmp_path, law=f'["{law}"]', requires='["map"]')
    (row,) = verdicts(needs, scene, missing_signals=("map",))
    assert (row["verdict"], row["reason_code"]) == (("unknown", "missing_map") if is_judged else foreign)


@pytest.mark.parametrize(
    ("applies", "conditions", "expected"),
    [
        ('light = ["night"]', {"light": "day"}, OUT),
        ('light = ["night"]', {"light": ["day", "day", "day"]}, OUT),
        ('light = ["night"]', {"light": ["day", "night", "day"]}, None),
        ('light = ["night"]', {"light": ["day", None, "day"]}, None),
        ('light = ["night"]', {"light": "night"}, None),
        ('light = ["night"]', {}, None),
        ('road_type = ["townLocal"]', {"road_type": "town"}, None),  # may be one
        ('weather = ["wet"]\nlight = ["night"]', {"light": "day"}, OUT),
        # at each step another condition is not met
        (
            'weather = ["wet"]\nlight = ["night"]',
            {"light": ["day", "night", "day"], "weather": ["wet", "dry", "dry"]},
            OUT,
        ),
        ("limit_min_mps = 13.5", {"limit_mps": 13.4112}, OUT),
        ("limit_min_mps = 13.41", {"limit_mps": 13.4112}, None),
        ("limit_max_mps = 13.3", {"limit_mps": [13.4112, None, 13.4112]}, None),
        ('light = ["night"]\nlimit_max_mps = 13.3', {"limit_mps": 13.4112}, OUT),
    ],
)
def test_a_signal_is_not_missed_where_known_conditions_exclude_the_rule(
    tmp_path: Path, applies: str, conditions: dict[str, Any], expected: tuple[str, str] | None
) -> None:
    """`expected` None: the missing signal leaves the rule unknown."""
    needed = {"requires": '["map"]'}
    rules = invariant(tmp_path, applies, **needed), at_event(tmp_path, applies, EXECUTION | needed)
    for rule in rules:
        found = verdicts(rule, drive([9, 12, 9], at=0.2, **conditions), missing_signals=("map",))
        assert brief(found) == [expected or ("unknown", "missing_map")]
        assert found[0]["assumes"] is None


# ---- the automated driver's engagement


@pytest.mark.sample(2, ci=3)
@pytest.mark.parametrize(
    ("quantifier", "speeds", "engaged", "expected"),
    [
        ("always", [12, 12, 12, 12], [True, True, True, True], ("pass", "kept")),
        ("always", [12, 12, 12, 12], [True, True, True, False], ("unknown", "not_engaged")),
        ("always", [12, 12, 12, 9], [True, True, True, False], ("unknown", "not_engaged")),
        ("always", [12, 12, 12, 9], [True, True, True, None], ("unknown", "engaged_unknown")),
        ("always", [12, 12, 9, 9], [True, True, True, False], ("fail", "violated")),
        ("always", [12, 12, 12, 12], [False, True, True, True], ("pass", "kept")),
        ("always", [12, 12, 12, 12], [True, False, True, True], ("not_applicable", "outside_conditions")),
        ("eventually", [9, 9, 9, 12], [True, True, True, False], ("unknown", "not_engaged")),
        ("eventually", [9, 9, 12, 9], [True, True, True, False], ("pass", "kept")),
        ("eventually", [9, 9, 9, 9], [True, True, True, True], ("fail", "violated")),
    ],
)
def test_a_window_in_which_the_human_takes_over(
    tmp_path: Path, quantifier: str, speeds: list[int], engaged: list[Any], expected: tuple[str, str]
) -> None:
    kind = AFTER | {"window_s": "0.2", "quantifier": f'"{quantifier}"'}
    rule = at_event(tmp_path, kind=kind)
    assert brief(verdicts(rule, drive(speeds, at=0.1, engaged=engaged))) == [expected]
