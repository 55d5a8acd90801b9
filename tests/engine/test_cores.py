"""A batch of few states keeps to one core; one of more, and the database afterwards, has all that it was given."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.engine import batch
from drivelint.engine.batch import Drive
from drivelint.engine.session import JudgingSession
from drivelint.formats import read_trace
from drivelint.sql import store

if TYPE_CHECKING:
    import duckdb

OVERTAKE = Path(__file__).parents[2] / "fixtures" / "overtake"
CORES = 3


def cores(con: duckdb.DuckDBPyConnection) -> int:
    ((found,),) = con.execute("SELECT current_setting('threads')").fetchall()
    return int(found)


def test_few_states_are_judged_on_one_core(monkeypatch: pytest.MonkeyPatch) -> None:
    drive = Drive(read_trace(OVERTAKE / "safe.csv", IngestOptions(mapping=str(OVERTAKE / "mapping.toml"))), None)
    for most, expected in ((drive.n_states, 1), (drive.n_states - 1, CORES)):
        monkeypatch.setattr(batch, "MOST_STATES_ON_ONE_CORE", most)
        seen: list[int] = []
        with store.temporary_database(None, threads=CORES) as con:
            look = [lambda con, _drives, seen=seen, **_part: seen.append(cores(con))]
            JudgingSession(con, (), {}, None, observers=look).judge([drive])
            assert (seen, cores(con)) == ([expected], CORES)


def test_a_batch_that_fails_gives_the_cores_back() -> None:
    drive = Drive(read_trace(OVERTAKE / "safe.csv", IngestOptions(mapping=str(OVERTAKE / "mapping.toml"))), None)

    def fail(*_: object, **_part: bool) -> None:
        raise ValueError("no observer")

    with store.temporary_database(None, threads=CORES) as con:
        with pytest.raises(ValueError, match="no observer"):
            JudgingSession(con, (), {}, None, observers=[fail]).judge([drive])
        assert cores(con) == CORES
