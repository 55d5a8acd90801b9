"""Where a rule holds: the conditions of its header, three-valued, and whether the automated driver drives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import (
    AFTER,
    EXECUTION,
    INVARIANT,
    MEASURED,
    PLACE_BEFORE,
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
PAIR = {"reads": '["pair"]'}
PAIR_SQL = "SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, 1 AS required FROM pair"

PASS, OUT, NOWHERE = ("pass", "kept"), ("not_applicable", "outside_conditions"), ("not_applicable", "not_triggered")


def invariant(tmp_path: Path, applies: str = "", **header: str) -> Rule:
    return write(
        tmp_path, INVARIANT | SPEED | header, {"condition": SPEED_SQL}, tables=applies and f"[applies]\n{applies}"
    )


def at_event(tmp_path: Path, applies: str = "", kind: dict[str, str] = EXECUTION, **sections: str) -> Rule:
    body = {"reference": REFERENCE, "condition": SPEED_SQL} | sections
    return write(tmp_path, kind | SPEED | AT, body, name="event", tables=applies and f"[applies]\n{applies}")


def drive(speeds: list[Any], *, at: Any = None, **given: Any) -> dict[str, Any]:
    """Return a scene at ten steps a second in which these conditions hold."""
    times = [i / 10 for i in range(len(speeds))]
    scene: dict[str, Any] = {"ego_state": {"t_s": times, "speed_mps": speeds}, "ego_condition": {"t_s": times, **given}}
    return scene | ({} if at is None else {"exit_taken": {"t_s": at}})


@pytest.mark.sample(2, ci=10)
@pytest.mark.parametrize(
    ("applies", "given", "expected"),
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
    tmp_path: Path, applies: str, given: dict[str, Any], expected: str
) -> None:
    scene = drive([12, 12, 12], at=0.1, **given)
    ends = {"in": (PASS, PASS), "out": (NOWHERE, OUT), "never": (("not_applicable", "not_engaged"), OUT)}
    wanted = ends.get(expected, (("unknown", expected), ("unknown", expected)))
    rules = invariant(tmp_path, applies), at_event(tmp_path, applies)
    assert tuple(brief(verdicts(rule, scene)) for rule in rules) == tuple([end] for end in wanted)


@pytest.mark.parametrize(
    ("applies", "words"),
    [
        ('nation = ["de"]', "The country is not known: give --env nation=gb."),
        (
            'vehicle_class = ["car"]',
            "The ego's class of vehicle is not known: give --env vehicle_class=car.",
        ),
    ],
)
def test_the_words_of_an_unknown_condition(tmp_path: Path, applies: str, words: str) -> None:
    (row,) = verdicts(at_event(tmp_path, applies), drive([12, 12, 12], at=0.1))
    assert row["reason"] == words


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize(
    ("law", "nation", "judged"),
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
    tmp_path: Path, law: str, nation: str | None, judged: bool
) -> None:
    """What fails there fails still where the nation is not known; a signal that is missing too does not matter."""
    scene = drive([9, 12, 9], at=0.2, nation=nation)
    rules = invariant(tmp_path, law=f'["{law}"]'), at_event(tmp_path, kind=EXECUTION | {"law": f'["{law}"]'})
    foreign = ("not_applicable", "other_nation")
    for rule in rules:
        (row,) = verdicts(rule, scene)
        assert (row["verdict"], row["reason_code"]) == (("fail", row["reason_code"]) if judged else foreign)
        assert len(findings(rule, scene)) == judged
    needs = invariant(tmp_path, law=f'["{law}"]', requires='["map"]')
    (row,) = verdicts(needs, scene, missing=("map",))
    assert (row["verdict"], row["reason_code"]) == (("unknown", "missing_map") if judged else foreign)


@pytest.mark.parametrize(
    ("applies", "given", "expected"),
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
    tmp_path: Path, applies: str, given: dict[str, Any], expected: tuple[str, str] | None
) -> None:
    """`expected` None: the missing signal leaves the rule unknown."""
    needed = {"requires": '["map"]'}
    rules = invariant(tmp_path, applies, **needed), at_event(tmp_path, applies, EXECUTION | needed)
    for rule in rules:
        found = verdicts(rule, drive([9, 12, 9], at=0.2, **given), missing=("map",))
        assert brief(found) == [expected or ("unknown", "missing_map")]
        assert found[0]["assumes"] is None


@pytest.mark.ci
def test_each_drive_has_its_own_nation(tmp_path: Path) -> None:
    scene = {
        "ego_state": [{"ego_id": e, "t_s": [0.0, 0.1], "speed_mps": [9, 12]} for e in "abc"],
        "ego_condition": [{"ego_id": e, "t_s": [0.0, 0.1], "nation": n} for e, n in (("a", "de"), ("b", "gb"))],
    }
    rows = verdicts(invariant(tmp_path, law='["de"]'), scene)
    assert [(r["ego_id"], r["verdict"]) for r in rows] == [("a", "fail"), ("b", "not_applicable"), ("c", "fail")]


def test_what_is_not_known_is_named_and_how_to_give_it(tmp_path: Path) -> None:
    said = {
        "weather_unknown": "The weather is not known at 0.000 s: give --env weather=dry",
        "engaged_unknown": "Whether the automated driver drives is not known at 0.000 s: give the log's mode flag engaged",
    }
    rule = invariant(tmp_path, 'weather = ["wet"]')
    for given in ({}, {"weather": "wet", "engaged": None}):
        (row,) = verdicts(rule, drive([12, 12], **given))
        assert said[row["reason_code"]] in row["reason"]


def test_observes_stands_in_the_sentence(tmp_path: Path) -> None:
    rule = invariant(tmp_path, observes='"speed on the ramp"')
    (kept,), (failed,) = (verdicts(rule, drive([v, v])) for v in (12, 9))
    assert kept["reason"] == "Speed on the ramp 12 m/s at 0.000 s where at least 10 m/s is required: kept by 2 m/s."
    assert failed["reason"] == "Speed on the ramp 9 m/s at 0.000 s where at least 10 m/s is required: missed by 1 m/s."


def test_a_step_without_conditions_is_a_step_at_which_they_are_not_known(tmp_path: Path) -> None:
    scene = drive([12, 12, 12], weather="wet")
    scene["ego_condition"] = {"t_s": [0.0, 0.2], "weather": "wet"}
    (row,) = verdicts(invariant(tmp_path, 'weather = ["wet"]'), scene)
    assert (row["verdict"], row["reason_code"], row["n_judged"]) == ("unknown", "weather_unknown", 2)


@pytest.mark.ci
def test_only_the_steps_at_which_a_condition_holds_are_judged(tmp_path: Path) -> None:
    wet = ["dry", "wet", "wet", "wet", "dry", "dry", "dry", "wet"]
    rows = verdicts(invariant(tmp_path, 'weather = ["wet"]'), drive([9, 12, 9, 12, 9, 9, 9, 12], weather=wet))
    assert [(r["verdict"], r["t_start_ns"], r["t_end_ns"], r["n_expected"]) for r in rows] == [
        ("fail", 10**8, 3 * 10**8, 3), ("pass", 7 * 10**8, 7 * 10**8, 1),
    ]  # fmt: skip


# ---- the automated driver's engagement


def test_what_the_human_did_is_not_judged(tmp_path: Path) -> None:
    """Steps 0 to 2 and 5 to 7 are driven by hand: what fails there is nobody's finding."""
    engaged = [False, False, False, True, True, False, False, False, True, True]
    scene = drive([9, 9, 9, 12, 12, 9, 9, 9, 12, 9], engaged=engaged)
    rule = invariant(tmp_path)
    rows = verdicts(rule, scene)
    assert [(r["verdict"], r["t_start_ns"], r["t_end_ns"], r["n_expected"]) for r in rows] == [
        ("pass", 3 * 10**8, 4 * 10**8, 2), ("fail", 8 * 10**8, 9 * 10**8, 2),
    ]  # fmt: skip
    assert [(f["t_start_ns"], f["t_end_ns"]) for f in findings(rule, scene)] == [(9 * 10**8, 9 * 10**8)]


def test_where_it_is_not_known_who_drove_a_failure_is_unknown(tmp_path: Path) -> None:
    scene = drive([9, 12, 12], engaged=[None, True, True])
    (row,) = verdicts(invariant(tmp_path), scene)
    assert (row["verdict"], row["reason_code"], row["n_judged"]) == ("unknown", "engaged_unknown", 2)
    assert findings(invariant(tmp_path), scene) == []


def test_objects_beside_a_human_are_not_judged(tmp_path: Path) -> None:
    rule = write(tmp_path, INVARIANT | MEASURED | PAIR, {"condition": PAIR_SQL})
    times = [0.0, 0.1, 0.2, 0.3]
    scene = {
        "step": {"t_s": times},
        "pair": [{"t_s": times, "object_id": who, "clearance_m": [0, 2, 2, 2]} for who in "ab"],
        "ego_condition": {"t_s": times, "engaged": [False, True, True, True]},
        "lost_object": {"object_id": "c", "t_from_s": 0.0, "t_to_s": 0.3, "code": "lost_near_ego"},
    }
    assert [(r["object_id"], r["verdict"], r["n_expected"]) for r in verdicts(rule, scene)] == [
        ("a", "pass", 3), ("b", "pass", 3),
    ]  # fmt: skip
    scene["ego_condition"] = {"t_s": times, "engaged": [True, True, True, False]}
    assert [(r["object_id"], r["verdict"]) for r in verdicts(rule, scene)] == [
        ("a", "fail"), ("b", "fail"), ("c", "unknown"),
    ]  # fmt: skip


def test_one_ego_by_hand_leaves_the_others_alone(tmp_path: Path) -> None:
    """Also a reference time that is no step: unknown only for the ego of which there is something to know."""
    scene = {
        "ego_state": [{"ego_id": e, "t_s": [0.0, 0.1, 0.2], "speed_mps": [9, 12, 12]} for e in "ab"],
        "ego_condition": {"ego_id": "a", "t_s": [0.0, 0.1, 0.2], "engaged": [False, True, True]},
        "exit_taken": [{"ego_id": e, "t_s": 0.15} for e in "ab"],
    }
    assert [(r["ego_id"], r["verdict"], r["n_expected"]) for r in verdicts(invariant(tmp_path), scene)] == [
        ("a", "pass", 2), ("b", "fail", 3),
    ]  # fmt: skip
    assert [(r["ego_id"], r["reason_code"]) for r in verdicts(at_event(tmp_path), scene)] == [
        ("a", "engaged_unknown"), ("b", "missing_step"),
    ]  # fmt: skip


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


@pytest.mark.ci
def test_an_anchor_that_the_human_drove_past_is_unknown(tmp_path: Path) -> None:
    rule = at_event(tmp_path, kind=PLACE_BEFORE, anchor="SELECT ref_id, t_ns - 200000000 AS t_ns FROM reference")
    for engaged, expected in ((True, ("pass", "kept")), (False, ("unknown", "not_engaged"))):
        scene = drive([12, 12, 12], at=0.2, engaged=[engaged, True, True])
        assert brief(verdicts(rule, scene)) == [expected]


@pytest.mark.ci
def test_nobody_beside_a_human_is_not_claimed(tmp_path: Path) -> None:
    reads = {"reads": '["exit_taken", "pair"]', "combine": '"all"', "window_s": "0.1"}
    rule = write(tmp_path, AFTER | MEASURED | reads, {"reference": REFERENCE, "condition": PAIR_SQL})
    scene: dict[str, Any] = {"step": {"t_s": [0.0, 0.1, 0.2]}, "exit_taken": {"t_s": 0.1}}
    assert brief(verdicts(rule, scene)) == [("pass", "nobody_there")]
    scene["ego_condition"] = {"t_s": [0.0, 0.1, 0.2], "engaged": [True, True, False]}
    assert brief(verdicts(rule, scene)) == [("unknown", "not_engaged")]
