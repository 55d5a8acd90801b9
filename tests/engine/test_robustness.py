"""In how many copies a finding stays: against whole copies judged by `explain`, alone and among others, and when copies suffice."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from statistics import NormalDist
from typing import Any

import duckdb
import numpy as np
import pytest

from drivelint import catalogue, demo, run
from drivelint.engine.robustness.copies import _standard_normal_draws
from drivelint.engine.robustness.judging import RobustnessJudge
from drivelint.engine.robustness.question import (
    LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING,
    N_COPIES_TO_SETTLE,
    N_LOST_OF_FEW_COPIES_FOR_POSSIBLE_FINDING,
    SMALL_MARGIN_BY_UNIT,
    RobustnessQuestion,
    worst_near_and_other_questions,
)
from drivelint.engine.robustness.window import Window
from drivelint.explain import ExplainRequest, MeasurementErrors, explain
from drivelint.report.outputs import write
from drivelint.report.progress import Silent
from drivelint.result import certainty as certainties
from drivelint.result.certainty import POSSIBLE, SURE, certainty

RULES = ("ukhc.no-collision", "ukhc.contact-signature", "ukhc.r162.safe-distance-ahead", "ukhc.r126.ds-ov-out-of-av")
Row = dict[str, Any]
OVERTAKE = Path(__file__).parents[2] / "fixtures" / "overtake"


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("demo")
    demo.write(folder)
    return folder


def check_findings(folder: Path, names: tuple[str, ...], out: Path | None = None, **more: Any) -> list[Row]:
    more = {"robustness": True} | more
    traces = tuple(str(folder / f"{name}.mcap") for name in names)
    result = run.check(
        run.CheckOptions(traces, map=folder / "road.xodr", rules=RULES, out=out, annotate=False, **more), Silent()
    )
    if out is not None:
        write(result, out)
    return [row for row in result.findings.to_pylist() if row["severity"] != "minor"]


@pytest.fixture(scope="module")
def folder_and_findings(logs: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Row]]:
    out = tmp_path_factory.mktemp("judged")
    return out, check_findings(logs, ("collision", "near-miss-25mph"), out, keep_db=True)


@pytest.mark.slow
def test_a_margin_far_beyond_the_errors_stays_and_one_of_two_centimetres_in_about_half(
    folder_and_findings: tuple[Path, list[Row]],
) -> None:
    told = {
        (row["rule_id"], row["profile"]): row
        for row in folder_and_findings[1]
        if row["drive_id"].startswith("collision")
    }
    assert told
    far = [row for row in told.values() if row["rule_id"] != "ukhc.no-collision"]
    assert len(far) == 4
    assert all(row["n_stays"] == row["n_copies"] == N_COPIES_TO_SETTLE[0] for row in far)
    assert {certainty(row) for row in far} == {SURE}
    contact = told["ukhc.no-collision", None]
    assert -0.03 < contact["margin"] < 0
    assert 0.2 <= contact["n_stays"] / contact["n_copies"] <= 0.8
    assert certainty(contact) == POSSIBLE


@pytest.mark.slow
def test_by_default_the_gravest_finding_of_a_rule_is_judged(
    logs: Path, folder_and_findings: tuple[Path, list[Row]]
) -> None:
    """Two findings of one rule at one time, by two profiles; what is only possible is so after fewer copies, and nothing else differs."""
    told = {
        (row["rule_id"], row["profile"]): row
        for row in folder_and_findings[1]
        if row["drive_id"].startswith("collision")
    }
    rows = {(row["rule_id"], row["profile"]): row for row in check_findings(logs, ("collision",), robustness=None)}
    assert rows.keys() == told.keys()
    left = [key for key, row in rows.items() if row["n_copies"] is None]
    assert [rule for rule, _ in left] == ["ukhc.r162.safe-distance-ahead"]
    counts = {"n_copies", "n_stays"}
    for key in rows.keys() - set(left):
        mine, theirs = rows[key], told[key]
        assert certainty(mine) == certainty(theirs)
        assert {n: v for n, v in mine.items() if n not in counts} == {
            n: v for n, v in theirs.items() if n not in counts
        }
        assert mine["n_copies"] < theirs["n_copies"] if certainty(mine) == POSSIBLE else mine == theirs


@pytest.mark.slow
def test_windows_tell_what_whole_copies_tell(folder_and_findings: tuple[Path, list[Row]]) -> None:
    """`explain` judges whole copies of these drives by a path of its own: the same copies keep the finding."""
    folder, rows = folder_and_findings
    doubtful = [row for row in rows if row["n_stays"] < row["n_copies"] or abs(row["margin"]) < 1.0]
    assert doubtful
    for row in doubtful:
        found = explain(
            ExplainRequest(row["finding_id"], folder, errors=MeasurementErrors(samples=row["n_copies"]))
        ).sensitivity
        assert found is not None
        assert found.counts.get("fail", 0) == row["n_stays"], row["rule_id"]


@pytest.mark.slow
def test_the_other_drives_of_a_batch_change_nothing(logs: Path, folder_and_findings: tuple[Path, list[Row]]) -> None:
    alone = check_findings(logs, ("collision",))
    assert alone == [row for row in folder_and_findings[1] if row["drive_id"].startswith("collision")]


@pytest.mark.ci
def test_no_copy_stays_in_the_database(folder_and_findings: tuple[Path, list[Row]]) -> None:
    with duckdb.connect(str(folder_and_findings[0] / "drivelint.duckdb"), read_only=True) as con:
        with_drives = con.execute("SELECT table_name FROM duckdb_columns() WHERE column_name = 'drive_id'").fetchall()
        assert len(with_drives) > 50
        for (table,) in with_drives:
            assert con.execute(f"SELECT count(*) FROM {table} WHERE drive_id LIKE '%~%'").fetchone() == (0,), table
        kept = con.execute("SELECT count(*) FROM finding WHERE n_copies IS NOT NULL").fetchone()
        assert kept is not None
        assert kept[0] == len(folder_and_findings[1])


@pytest.mark.ci
def test_nothing_is_counted_if_it_is_not_asked_for(logs: Path) -> None:
    rows = check_findings(logs, ("collision",), robustness=False)
    assert rows
    assert all(row["n_copies"] is None and row["n_stays"] is None for row in rows)


@pytest.mark.ci
def test_findings_that_have_their_copies_are_not_judged_again(logs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Copies for all findings, of which the worst is only possible: the others were judged with it, and nothing is left to judge."""
    judge_windows = RobustnessJudge._judge_windows
    settled: list[bool] = []

    def judge_and_note(judge: RobustnessJudge, chunk: list[Window]) -> None:
        settled.extend(question.is_settled for window in chunk for question in window.questions)
        judge_windows(judge, chunk)

    monkeypatch.setattr(RobustnessQuestion, "is_finding_certain", False)
    monkeypatch.setattr(RobustnessJudge, "_judge_windows", judge_and_note)
    rows = check_findings(logs, ("collision",))
    assert len(rows) > len({row["rule_id"] for row in rows})
    assert all(row["n_copies"] for row in rows)
    assert not any(settled)


@cache
def sums_of_errors(n_actors: int) -> Any:
    """Return 400 times, for all copies, the scaled sum of the errors of some actors, which is normally distributed."""
    most = N_COPIES_TO_SETTLE[-1]
    return np.array(
        [
            sum(_standard_normal_draws(range(1, most + 1), seed, f"actor {n}").sum(axis=1) for n in range(n_actors))
            for seed in range(400)
        ]
    ) / math.sqrt(3 * n_actors)


@pytest.mark.parametrize("n_actors", [1, 2, 3])
def test_a_few_copies_call_no_more_findings_sure_than_all_of_them_do(n_actors: int) -> None:
    """Margins that depend on the places and clocks of some actors, and lie above 0 in a share of copies that is below 95 %.

    On average over the shares, the first copies call fewer findings sure; for none of the shares many more.
    """
    few, _ = N_COPIES_TO_SETTLE
    sums = sums_of_errors(n_actors)
    more_sure_by_few = []
    for share in (0.80, 0.85, 0.90, 0.93, 0.9499):
        keeps = sums < NormalDist().inv_cdf(share)
        by_few = keeps[:, :few].all(axis=1)
        by_all = keeps.mean(axis=1) >= LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING
        more_sure_by_few.append(float(by_few.mean() - by_all.mean()))
    assert max(more_sure_by_few) < 0.07
    assert np.mean(more_sure_by_few) < 0


@pytest.mark.parametrize("n_actors", [1, 2, 3])
def test_a_few_copies_call_no_more_findings_only_possible_than_all_of_them_do(n_actors: int) -> None:
    few, _ = N_COPIES_TO_SETTLE
    sums = sums_of_errors(n_actors)
    more_possible_by_few = []
    for share in (0.951, 0.96, 0.98):
        keeps = sums < NormalDist().inv_cdf(share)
        by_few = (~keeps[:, :few]).sum(axis=1) >= N_LOST_OF_FEW_COPIES_FOR_POSSIBLE_FINDING
        by_all = keeps.mean(axis=1) < LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING
        more_possible_by_few.append(float(by_few.mean() - by_all.mean()))
    assert max(more_possible_by_few) < 0.01
    assert np.mean(more_possible_by_few) < 0


def question(margin: float | None, rule_id: str = "ukhc.no-collision") -> RobustnessQuestion:
    times = {"t_ref_ns": None, "t_start_ns": 0, "t_end_ns": 300_000_000, "t_worst_ns": 100_000_000, "profile": None}
    return RobustnessQuestion({"margin": margin, **times}, catalogue.load_rules(())[rule_id])


def test_few_copies_come_first_and_more_where_one_of_them_loses_the_finding() -> None:
    few, most = N_COPIES_TO_SETTLE
    assert question(-SMALL_MARGIN_BY_UNIT["m"]).next_copy_numbers == range(1, few + 1)
    for margin in (-5.0, None):
        asked = question(margin)
        assert asked.next_copy_numbers == range(1, few + 1)
        asked.add_results_of_copies((0, *asked.next_copy_numbers), dict.fromkeys(range(few + 1), margin))
        assert asked.is_settled
        assert (asked.n_stays, asked.n_copies) == (few, few)
    asked = question(-5.0)
    # far from 0 in all copies but one, where it does not apply
    asked.add_results_of_copies((0, *asked.next_copy_numbers), dict.fromkeys(range(few), -5.0))
    assert not asked.is_settled
    assert asked.next_copy_numbers == range(few + 1, most + 1)
    asked.add_results_of_copies((0, *asked.next_copy_numbers), {0: -5.0})
    assert asked.is_settled
    assert (asked.n_stays, asked.n_copies) == (few - 1, most)


@pytest.mark.parametrize(("spread", "suffice"), [(1.9, True), (2.1, False)])
def test_the_first_copies_suffice_where_their_margins_are_far_from_the_threshold(spread: float, suffice: bool) -> None:
    asked = question(-5.0)
    asked.add_results_of_copies(
        (0, *asked.next_copy_numbers),
        {n: -5.0 + (spread if n % 2 else -spread) * (n > 0) for n in range(N_COPIES_TO_SETTLE[0] + 1)},
    )
    assert asked.is_settled is suffice


@pytest.mark.parametrize(("n_lost", "suffice"), [(2, False), (3, True)])
def test_copies_that_show_that_it_is_only_possible_suffice(n_lost: int, suffice: bool) -> None:
    asked = question(-2.0)
    asked.add_results_of_copies(
        (0, *asked.next_copy_numbers), dict.fromkeys(range(len(asked.next_copy_numbers) + 1 - n_lost), -2.0)
    )
    assert asked.is_settled is suffice
    assert not asked.is_finding_certain


def test_a_share_of_ones_own_is_that_of_all_copies() -> None:
    """With `--confidence 0.8`, 14 of the first 20 copies say nothing of 85 of 100."""
    most = N_COPIES_TO_SETTLE[-1]
    asked = question(-2.0)
    asked.ends_early = False
    asked.add_results_of_copies(
        (0, *asked.next_copy_numbers), dict.fromkeys(range(len(asked.next_copy_numbers) - 9), -2.0)
    )
    assert not asked.is_settled
    assert asked.next_copy_numbers.stop == most + 1


def test_of_one_rule_the_gravest_finding_is_judged_and_those_near_the_threshold() -> None:
    of_one = {"drive_id": "d", "ego_id": "0", "rule_id": "ukhc.no-collision"}
    asked = [question(margin) for margin in (-1.0, -0.2, None, -4.0, -2.0)]
    for each in asked:
        each.finding.update(of_one)
    other = question(-0.5)
    other.finding.update(of_one | {"ego_id": "1"})
    gravest, near, others = worst_near_and_other_questions([*asked, other])
    assert ([q.finding["margin"] for q in gravest], [q.finding["margin"] for q in near]) == ([-4.0, -0.5], [-0.2])
    assert sorted(q.finding["margin"] or 0.0 for q in others) == [-2.0, -1.0, 0.0]


def test_a_window_that_does_not_give_the_finding_is_not_believed() -> None:
    few, most = N_COPIES_TO_SETTLE
    asked = question(-5.0)
    asked.add_results_of_copies((0, *range(1, few + 1)), dict.fromkeys(range(few), -5.0))
    asked.add_results_of_copies((0, *range(few + 1, most + 1)), dict.fromkeys((0, *range(few + 1, most + 1)), -4.0))
    assert (asked.size, asked.n_copies, asked.n_stays) == (1, 0, 0)
    asked.add_results_of_copies((0, *range(few + 1, most + 1)), dict.fromkeys((0, *range(few + 1, most + 1)), -5.0))
    assert asked.n_copies == 0  # the copies before these are still to be judged


def long_question() -> RobustnessQuestion:
    """Return a finding whose stretch lasts longer than its first window."""
    asked = question(-2.0)
    asked.finding["t_end_ns"] = 10_000_000_000
    return asked


def test_a_copy_that_does_not_tell_in_a_part_of_a_stretch_is_judged_in_the_whole() -> None:
    few, most = N_COPIES_TO_SETTLE
    kept = dict.fromkeys(range(few), -2.0)  # all but the last
    asked = long_question()
    asked.add_results_of_copies((0, *asked.next_copy_numbers), kept)
    assert (asked.size, asked.n_copies) == (1, 0)
    assert asked.next_copy_numbers == range(1, few + 1)
    asked.add_results_of_copies((0, *asked.next_copy_numbers), dict.fromkeys(range(few + 1), -2.0))
    assert asked.next_copy_numbers == range(few + 1, most + 1)  # some copies lost it before
    passed = long_question()
    passed.add_results_of_copies((0, *range(1, few + 1)), kept, {few})
    assert (passed.size, passed.n_copies, passed.n_stays) == (0, few, few - 1)
    short = question(-2.0)
    short.add_results_of_copies((0, *short.next_copy_numbers), kept)
    assert (short.size, short.n_copies, short.n_stays) == (0, few, few - 1)


def test_a_finding_that_is_only_possible_anyway_needs_no_wider_window() -> None:
    assert LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING == certainties.LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING
    few, _ = N_COPIES_TO_SETTLE
    asked = long_question()
    asked.add_results_of_copies(
        (0, *asked.next_copy_numbers), dict.fromkeys(range(few - 6), -2.0), set(range(few - 6, few))
    )
    assert (asked.size, asked.n_copies, asked.n_stays) == (0, few, few - 7)


def test_copies_judged_at_once_give_what_they_give_one_after_the_other() -> None:
    few, most = N_COPIES_TO_SETTLE
    asked = question(-2.0)
    asked.is_hasty = True
    assert asked.next_copy_numbers == range(1, most + 1)
    asked.add_results_of_copies((0, *range(1, few + 1)), dict.fromkeys(range(few + 1), -2.0))
    asked.add_results_of_copies((0, *range(few + 1, most + 1)), {0: -2.0})
    assert (asked.n_copies, asked.n_stays) == (few, few)


def test_all_copies_of_a_small_margin_count_and_all_parts_of_a_large_window() -> None:
    few, most = N_COPIES_TO_SETTLE
    small = question(-SMALL_MARGIN_BY_UNIT["m"])
    small.add_results_of_copies((0, *range(1, few + 1)), dict.fromkeys(range(few + 1), small.finding["margin"]))
    assert not small.is_settled
    kept = dict.fromkeys((0, *range(few + 2, most + 1)), small.finding["margin"])  # all but one
    small.add_results_of_copies((0, *range(few + 1, most + 1)), kept)
    assert (small.n_copies, small.n_stays) == (most, most - 1)
    large = question(None)
    for numbers in (range(1, 11), range(11, few + 1)):
        large.add_results_of_copies((0, *numbers), dict.fromkeys((0, *numbers)))
    assert (large.n_copies, large.n_stays) == (few, few)


@pytest.mark.slow
def test_the_same_drive_in_another_file_is_as_sure(tmp_path: Path) -> None:
    """Blank lines and the name of the file change the log's hash and the drive's id, and nothing else."""
    csv = (OVERTAKE / "collision.csv").read_bytes()
    told = []
    for name, text in (("one.csv", csv), ("two.csv", csv + b"\n\n")):
        (tmp_path / name).write_bytes(text)
        options = run.CheckOptions(
            (str(tmp_path / name),),
            map=OVERTAKE / "road.xodr",
            mapping=str(OVERTAKE / "mapping.toml"),
            rules=RULES,
            annotate=False,
        )
        rows = run.check(options, Silent()).findings.to_pylist()
        told.append([(row["rule_id"], row["profile"], row["n_copies"], row["n_stays"]) for row in rows])
    assert told[0] == told[1]
    assert any(0 < stays < n for *_, n, stays in told[0])
