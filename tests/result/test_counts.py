"""What counts as one event, in a check and in an audit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import duckdb
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivelint.result.certainty import LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING
from drivelint.result.counts import one_finding_per_event
from drivelint.sql.statements import statement
from tests.report.synthetic import SECOND, finding

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


def ids(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    return [row["finding_id"] for row in rows]


def a_finding(name: str, **over: Any) -> dict[str, Any]:
    return finding(**over) | {"finding_id": name, "n_copies": None, "n_stays": None} | over


@pytest.mark.parametrize(
    ("change", "finding_ids"),
    [
        ({"profile": "observed"}, ["a"]),
        ({"profile": "observed", "t_start_ns": 109 * SECOND, "t_end_ns": 109 * SECOND}, ["a", "b"]),
        ({"profile": "observed", "object_id": "4"}, ["a", "b"]),
        ({"profile": "observed", "rule_id": "another"}, ["a", "b"]),
        ({"profile": "observed", "drive_id": "d2"}, ["a", "b"]),
        ({"occurrence": 1}, ["a", "b"]),
        ({"ego_id": "3", "object_id": "1"}, ["a"]),
        ({"ego_id": "4", "object_id": "1"}, ["a", "b"]),
    ],
)
def test_one_overtake_under_two_profiles_is_one_and_so_is_a_touch_of_two_egos(
    change: dict[str, Any], finding_ids: list[str]
) -> None:
    assert ids(one_finding_per_event([a_finding("a"), a_finding("b", **change)])) == finding_ids


def test_a_sure_finding_stands_for_one_that_is_only_possible() -> None:
    rows = [a_finding("a", n_copies=100, n_stays=50), a_finding("b", profile="observed", n_copies=100, n_stays=99)]
    assert ids(one_finding_per_event(rows)) == ["b"]


finding_columns = st.fixed_dictionaries(
    {
        "ego_id": st.sampled_from("12"),
        "object_id": st.sampled_from("12"),
        "profile": st.sampled_from([None, "nominal", "observed"]),
        "t_start_ns": st.integers(0, 6),
        "n_stays": st.sampled_from([50, 100]),
    }
)


@given(st.lists(finding_columns, max_size=7))
def test_an_audit_counts_as_a_check_does(some: list[dict[str, Any]]) -> None:
    made = [
        a_finding(str(n), **each, n_copies=100) | {"t_end_ns": each["t_start_ns"] + 2, "key": "k"}
        for n, each in enumerate(some)
        if each["ego_id"] != each["object_id"]
    ]
    made.sort(key=lambda row: (row["ego_id"], row["profile"] or "", row["t_start_ns"]))
    # stretches of one rule, profile, ego and object do not overlap
    taken = {(row["ego_id"], row["profile"], row["t_start_ns"] // 4): row for row in made if row["t_start_ns"] % 4 < 2}
    rows = list(taken.values())
    if not rows:
        return
    with duckdb.connect() as con:
        con.register("findings", pa.Table.from_pylist(rows))
        event = statement("fleet/event", of="", least_share=str(LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING))
        counted = {name for (name,) in con.execute(f"SELECT finding_id FROM ({event})").fetchall()}
    assert counted == set(ids(one_finding_per_event(rows)))
