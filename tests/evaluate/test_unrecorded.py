"""A rule that needs a signal of which the log has nothing does not apply, unless it is asked for by its id; it is counted and named."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pyarrow as pa
import pytest

from drivelint.engine.batch import Drive
from drivelint.errors import ExitCode
from drivelint.gate import diff
from drivelint.reasons.reason_text import sentence
from drivelint.report.inputs import input_notes
from drivelint.report.outcome import headline, rule_counts
from drivelint.result.model import exit_status
from tests.report.synthetic import drive as drive_row
from tests.report.synthetic import finding, result, rule, verdict
from tests.scenes import drive, moving, road, saying, times, verdict_rows

HORN, HAZARDS, SIGNAL, DIRECTION = "r112.horn", "r116.hazards", "exit-sign-signal", "r143.direction"


def scene(*, with_map: bool = True, names: bool | None = None) -> Drive:
    """Return a drive without indicators; `names`: whether its mapping names them."""
    way, t = road(), times(3.0)
    found = drive([moving("ego", way, t, 100 + 10 * t, way.ego_d)], way.environment if with_map else None)
    tables = dict(found.trace.tables)
    log, states = tables["data_log"].to_pylist(), tables["actor_state"]
    log[0] |= {"has_indicator": False, "names_indicator": names}
    at = states.schema.get_field_index("indicator")
    tables["data_log"] = pa.Table.from_pylist(log, schema=tables["data_log"].schema)
    tables["actor_state"] = states.set_column(
        at, states.schema.field(at), pa.nulls(len(states), states.schema.field(at).type)
    )
    return replace(found, trace=replace(found.trace, tables=tables))


def outcome_by_rule(drive: Drive, *rules: str) -> dict[str, tuple[str, str]]:
    rows = verdict_rows([drive], rules=rules)
    return {row["rule_id"].removeprefix("ukhc."): (row["verdict"], row["reason_code"]) for row in rows}


NOT_THERE = ("not_applicable", "unrecorded_indicator")


def test_one_of_many_rules_does_not_apply() -> None:
    found = outcome_by_rule(scene(), "ukhc")
    assert (found[HORN], found[HAZARDS], found[SIGNAL]) == (
        ("not_applicable", "unrecorded_mode_horn"),
        NOT_THERE,
        NOT_THERE,
    )
    assert found[DIRECTION] == ("pass", "kept")


def test_a_rule_that_is_asked_for_by_its_id_is_unknown() -> None:
    found = outcome_by_rule(scene(), f"ukhc.{HORN}", f"ukhc.{HAZARDS},severity:minor", "ukhc.exit-*")
    assert found[HORN] == ("unknown", "missing_mode_horn")
    assert found[HAZARDS] == ("unknown", "missing_indicator")
    assert found[SIGNAL] == NOT_THERE


@pytest.mark.ci
@pytest.mark.parametrize("names", [True, False])
def test_a_mapping_that_names_the_signal_asks_for_it(names: bool) -> None:
    found = outcome_by_rule(scene(names=names), "ukhc")
    assert found[HAZARDS] == (("unknown", "missing_indicator") if names else NOT_THERE)
    assert found[HORN] == ("not_applicable", "unrecorded_mode_horn")


@pytest.mark.slow
def test_a_signal_that_the_log_has_is_judged_and_one_of_the_map_stays_unknown() -> None:
    assert outcome_by_rule(saying(scene(), [(0.0, "horn", "off")]), "ukhc")[HORN][0] in {"pass", "not_applicable"}
    assert outcome_by_rule(saying(scene(), [(0.0, "horn", "off")]), "ukhc")[HORN][1] != "unrecorded_mode_horn"
    assert outcome_by_rule(scene(with_map=False), "ukhc")[DIRECTION] == ("unknown", "missing_map")


@pytest.mark.ci
def test_the_law_of_another_nation_is_told_first() -> None:
    assert outcome_by_rule(saying(scene(), nation="de"), "ukhc")[HAZARDS] == ("not_applicable", "other_nation")


@pytest.mark.slow
def test_outside_its_conditions_a_rule_does_not_apply_whatever_the_log_lacks() -> None:
    by_day, by_night = (
        outcome_by_rule(saying(scene(), light=light), "ukhc")["r113.headlights"] for light in ("day", "night")
    )
    assert (by_day, by_night) == (
        ("not_applicable", "outside_conditions"),
        ("not_applicable", "unrecorded_mode_headlights"),
    )


@pytest.mark.ci
def test_the_reason_says_what_the_log_lacks() -> None:
    reasons = {row["rule_id"]: row["reason"] for row in verdict_rows([scene()], rules=("ukhc",))}
    assert sentence(reasons[f"ukhc.{HAZARDS}"]) == "the log has no indicators of the ego"


LACKING = verdict(
    "not_applicable", reason_code="unrecorded_indicator", reason="the log has no indicators", object_id=None
)


def test_it_is_counted_and_named_and_no_pass() -> None:
    """What is not in the log stands on the first screen, and who asks strictly gets exit code 4."""
    rules = [rule(), rule("ukhc.b")]
    both = result([verdict("pass"), LACKING | {"rule_id": "ukhc.b"}], rules=rules)
    assert (rule_counts(both).judged_somewhere, rule_counts(both).unrecorded, rule_counts(both).idle) == (1, 1, 0)
    assert "no findings, but not everything could be judged" in headline(both).sentence
    notes: dict[str, Any] = {note.label: note for note in input_notes(both)}
    assert notes["not recorded"].words == "indicator (needed by 1 rule)"
    assert notes["not recorded"].is_warning
    assert exit_status(both).code == ExitCode.OK
    assert exit_status(replace(both, strict=True)).code == ExitCode.NOT_JUDGED
    assert exit_status(replace(both, required=("ukhc.b",))).code == ExitCode.NOT_JUDGED
    alone = result([LACKING])
    assert headline(alone).label == "UNKNOWN"
    assert "nothing could be decided" in headline(alone).sentence
    assert "nothing could be decided" in exit_status(alone).why
    assert exit_status(alone).code == ExitCode.NOT_JUDGED


def test_a_finding_is_not_fixed_by_a_log_without_the_signal() -> None:
    base = result([verdict("fail")], [finding()])
    times_ = dict.fromkeys(("t_ref_ns", "t_start_ns", "t_end_ns", "t_worst_ns"))
    new = result([LACKING | times_], drives=[drive_row()])
    (entry,) = diff.compare(base, new).entries
    assert entry.standing == "unknown"
