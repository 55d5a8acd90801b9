"""In how many copies a finding stays: against whole copies judged by `explain`, alone and among others, and when copies suffice."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import duckdb
import numpy as np
import pytest

from drivelint import catalogue, demo, run
from drivelint.engine.robustness import N_COPIES, SMALL_MARGIN, SURE_SPREADS, Question
from drivelint.explain import ExplainRequest, MeasurementErrors, explain
from drivelint.report.outputs import write
from drivelint.report.progress import Silent
from drivelint.result.certainty import POSSIBLE, SURE, certainty

RULES = ("ukhc.no-collision", "ukhc.contact-signature", "ukhc.r162.safe-distance-ahead", "ukhc.r126.ds-ov-out-of-av")
Row = dict[str, Any]


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("demo")
    demo.write(folder)
    return folder


def checked(folder: Path, names: tuple[str, ...], out: Path | None = None, **more: Any) -> list[Row]:
    traces = tuple(str(folder / f"{name}.mcap") for name in names)
    result = run.check(
        run.CheckOptions(traces, map=folder / "road.xodr", rules=RULES, out=out, annotate=False, **more), Silent()
    )
    if out is not None:
        write(result, out)
    return [row for row in result.findings.to_pylist() if row["severity"] != "minor"]


@pytest.fixture(scope="module")
def judged(logs: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Row]]:
    out = tmp_path_factory.mktemp("judged")
    return out, checked(logs, ("collision", "near-miss-25mph"), out, keep_db=True)


def test_a_margin_far_beyond_the_errors_stays_and_one_of_two_centimetres_in_about_half(
    judged: tuple[Path, list[Row]],
) -> None:
    told = {(row["rule_id"], row["profile"]): row for row in judged[1] if row["drive_id"].startswith("collision")}
    assert told
    far = [row for row in told.values() if row["rule_id"] != "ukhc.no-collision"]
    assert len(far) == 4
    assert all(row["n_stays"] == row["n_copies"] >= N_COPIES[0] for row in far)
    assert {certainty(row) for row in far} == {SURE}
    contact = told["ukhc.no-collision", None]
    assert -0.03 < contact["margin"] < 0
    assert 0.2 <= contact["n_stays"] / contact["n_copies"] <= 0.8
    assert certainty(contact) == POSSIBLE


def test_windows_tell_what_whole_copies_tell(judged: tuple[Path, list[Row]]) -> None:
    """`explain` judges whole copies of these drives by a path of its own: the same copies keep the finding."""
    folder, rows = judged
    doubtful = [row for row in rows if row["n_stays"] < row["n_copies"] or abs(row["margin"]) < 1.0]
    assert doubtful
    for row in doubtful:
        found = explain(
            ExplainRequest(row["finding_id"], folder, errors=MeasurementErrors(samples=row["n_copies"]))
        ).sensitivity
        assert found is not None
        assert found.counts.get("fail", 0) == row["n_stays"], row["rule_id"]


def test_the_other_drives_of_a_batch_change_nothing(logs: Path, judged: tuple[Path, list[Row]]) -> None:
    alone = checked(logs, ("collision",))
    assert alone == [row for row in judged[1] if row["drive_id"].startswith("collision")]


def test_no_copy_stays_in_the_database(judged: tuple[Path, list[Row]]) -> None:
    with duckdb.connect(str(judged[0] / "drivelint.duckdb"), read_only=True) as con:
        with_drives = con.execute("SELECT table_name FROM duckdb_columns() WHERE column_name = 'drive_id'").fetchall()
        assert len(with_drives) > 50
        for (table,) in with_drives:
            assert con.execute(f"SELECT count(*) FROM {table} WHERE drive_id LIKE '%~%'").fetchone() == (0,), table
        kept = con.execute("SELECT count(*) FROM finding WHERE n_copies IS NOT NULL").fetchone()
        assert kept is not None
        assert kept[0] == len(judged[1])


def test_nothing_is_counted_if_it_is_not_asked_for(logs: Path) -> None:
    rows = checked(logs, ("collision",), robustness=False)
    assert rows
    assert all(row["n_copies"] is None and row["n_stays"] is None for row in rows)


def test_the_spreads_give_the_confidence_that_they_are_said_to() -> None:
    """Draws of a margin of which exactly 95 % are below 0: their spread says "sure" in 10 % of the cases."""
    rng = np.random.default_rng(5)
    for n, spreads in SURE_SPREADS.items():
        drawn = rng.standard_normal((200_000, n)) - 1.6448536
        sure = drawn.mean(axis=1) + spreads * drawn.std(axis=1, ddof=1) <= 0
        assert sure.mean() == pytest.approx(0.1, abs=0.005), n


def question(margin: float | None, rule_id: str = "ukhc.no-collision") -> Question:
    return Question({"margin": margin}, catalogue.load_rules(())[rule_id])


def test_few_copies_come_first_and_more_where_they_do_not_tell() -> None:
    least, twelve, forty, most = N_COPIES
    assert question(-5.0).numbers == range(least + 1)
    for small in (-SMALL_MARGIN["m"], None):
        assert question(small).numbers == range(twelve + 1)
    more = question(-5.0)
    more.known_whole, more.n_copies = True, twelve
    assert more.numbers == range(twelve + 1, forty + 1)

    def settled(n: int, margins: list[float | None]) -> bool:
        asked = question(-5.0)
        asked.n_copies, asked.margins = n, margins
        return asked.is_settled

    assert settled(least, [-5.0, -5.1, -4.9, -5.0, -5.2])
    assert not settled(least, [-0.1, -1.0, -0.5, -2.0, -0.2])  # all stay, but a wider draw would not
    assert not settled(least, [-5.0, -5.1, -4.9, -5.0])  # one of five is lost, which tells little
    assert not settled(least, [None] * least)
    assert settled(twelve, [None] * twelve)
    assert not settled(twelve, [None] * 11)
    assert settled(twelve, [None] * 6)
    assert settled(most, [None] * 97)
