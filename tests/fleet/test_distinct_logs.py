"""What counts once where a log was judged several times: under two names, with other egos, under other conditions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import duckdb
import pytest

from drivelint import fleet
from drivelint.audit.store import LocalFolder
from drivelint.audit.unpacked import AuditProgress
from drivelint.fleet.coverage import coverage
from drivelint.fleet.distinct_logs import COUNTED_PREFIX, create_counted_views
from drivelint.fleet.missing_signals import missing_signals
from drivelint.fleet.rates import rates
from drivelint.fleet_report.audit_views import BASE_PREFIX, Audit
from drivelint.fleet_report.difference import difference
from drivelint.fleet_report.difference_text import to_text
from drivelint.sql.statements import statement
from tests.fleet import audits
from tests.fleet.audits import drive_finding, drive_verdict, ego_drive
from tests.report.synthetic import rule

pytestmark = pytest.mark.ci

RULE = rule(profiles=[])


def way(ego: str, km: float) -> dict[str, Any]:
    return {**ego_drive("", km)["exposure"][0], "ego_id": ego}


def result(name: str, *egos: tuple[str, float], **over: Any) -> dict[str, Any]:
    """Return a result of one and the same log; `egos`: id and distance in km."""
    return ego_drive(name, **({"sha256": "same", "exposure": [way(*ego) for ego in egos]} | over))


def audit_database(
    drives: list[Any], verdicts: list[Any] | None = None, findings: list[Any] | None = None, of: str = ""
) -> Any:
    con = duckdb.connect()
    add(con, drives, verdicts, findings, of)
    create_counted_views(con, of)
    return con


def add(con: Any, drives: list[Any], verdicts: list[Any] | None, findings: list[Any] | None, of: str = "") -> None:
    every = [drive_verdict(row["drive_id"], "pass", ego_id=ego["ego_id"]) for row in drives for ego in row["exposure"]]
    audits.add_rows(con, drives, every if verdicts is None else verdicts, findings or [], [RULE], of=of)


def totals(con: Any) -> dict[str, Any]:
    (row,) = con.execute(statement("fleet/totals")).to_arrow_table().to_pylist()
    return dict(row)


WET = [{"condition": "weather", "value": "wet", "source": "given"}]
TWICE = [
    ([result("a", ("1", 3.0)), result("b", ("1", 3.0))], (1, 1, 3.0)),
    ([result("a", ("1", 3.0)), result("b", ("2", 4.0))], (1, 2, 7.0)),
    ([result("a", ("1", 3.0), ("2", 4.0)), result("b", ("2", 4.0), ("3", 5.0))], (1, 3, 12.0)),
    ([result("a", ("1", 3.0)), result("b", ("1", 3.0), sha256="other")], (2, 2, 6.0)),
    ([result("a", ("1", 3.0)), result("b", ("1", 3.0), conditions=WET)], (1, 1, 3.0)),
]  # fmt: skip


@pytest.mark.parametrize(("drives", "expected"), TWICE)
def test_a_log_and_an_ego_count_once_and_other_egos_each(drives: list[Any], expected: tuple[Any, ...]) -> None:
    told = totals(con := audit_database(drives))
    n, n_egos, km = expected
    assert (told["drives"], told["egos"], told["km"]) == (n, n_egos, km)
    (rate,) = rates(con)
    assert (rate.egos_judged, rate.km) == (n_egos, km)
    covered = coverage(con)
    assert covered.rules[0].drives == n
    weathers = [each for each in covered.situations if each.situation == "traffic"]
    assert (sum(each.egos for each in weathers), sum(each.km for each in weathers)) == (n_egos, km)


def test_what_two_results_share_counts_once_and_what_one_of_them_has_counts() -> None:
    drives = [result("a", ("1", 3.0)), result("b", ("1", 3.0), ("2", 4.0))]
    findings = [
        drive_finding("a"),
        drive_finding("b"),
        drive_finding("b", ego_id="2", finding_id="other ego"),
        drive_finding("b", object_id="9"),
    ]
    con = audit_database(
        drives, [drive_verdict("a", "fail"), drive_verdict("b", "fail"), drive_verdict("b", "unknown")], findings
    )
    rows = con.sql(f"SELECT key, result_key, ego_id, object_id FROM {COUNTED_PREFIX}findings ORDER BY ALL").fetchall()
    assert [row[0] for row in rows] == ["a"] * 3
    assert [row[1] for row in rows] == ["a", "b", "b"]
    assert con.sql(f"SELECT verdict FROM {COUNTED_PREFIX}verdicts ORDER BY ALL").fetchall() == [("fail",), ("unknown",)]


def test_the_first_result_does_not_depend_on_keys() -> None:
    """Keys are hashes of versions too: two audits of the same logs must take the same results."""
    con = audit_database([result("a", ("1", 3.0), file_name="z.mcap"), result("b", ("1", 3.0), file_name="y.mcap")])
    assert con.sql(f"SELECT key FROM {COUNTED_PREFIX}drives").fetchall() == [("b",)]


def test_a_tag_with_several_values_is_not_known_of_a_log() -> None:
    tags = ({"release": "a", "site": "x"}, {"release": "b", "site": "x"}, {"vehicle": "v"})
    con = audit_database([result(name, ("1", 3.0), tags=each) for name, each in zip("abc", tags, strict=True)])
    ((told,),) = con.sql(f"SELECT tags FROM {COUNTED_PREFIX}drives").fetchall()
    assert told == {"site": "x", "vehicle": "v"}
    assert {each.tag_value: each.km for each in rates(con, "release")} == {"a": 3.0, "b": 3.0, None: 3.0}


def test_a_drive_that_could_not_be_judged_stands_for_no_other() -> None:
    lost = result("0", status="not_judged", sha256="same")
    assert [totals(audit_database([lost, result("a", ("1", 3.0))]))[name] for name in ("drives", "judged", "km")] == [
        2,
        1,
        3.0,
    ]


def compared(base: list[Any], new: list[Any]) -> Any:
    """Return the difference of audits of these drives, of which each has one finding per ego."""
    con = duckdb.connect()
    sides = []
    for of, drives in ((BASE_PREFIX, base), ("", new)):
        egos = [(row["drive_id"], ego["ego_id"]) for row in drives for ego in row["exposure"]]
        findings = [drive_finding(name, ego_id=ego, finding_id=f"{name}-{ego}") for name, ego in egos]
        add(con, drives, [drive_verdict(name, "fail", ego_id=ego) for name, ego in egos], findings, of)
        sides.append(Audit(of or "new", LocalFolder(Path(of)), {"settings": {}}, AuditProgress("d")))
    return difference(con, sides[1], sides[0], 50)


ONCE = [result("a", ("1", 3.0))]


@pytest.mark.parametrize("swapped", [False, True])
def test_a_copy_is_neither_new_nor_gone_for_diff(*, swapped: bool) -> None:
    sides = ONCE, [result("a", ("1", 3.0)), result("b", ("1", 3.0)), result("c", ("1", 3.0))]
    told = compared(*(reversed(sides) if swapped else sides))
    assert told.counts == {**dict.fromkeys(told.counts, 0), "unchanged": 1}
    assert (told.n_failing("minor"), told.n_gone_unfixed("minor"), told.base_only, told.new_only) == (0, 0, [], [])
    assert [verdicts["fail"] for verdicts in told.verdicts] == [1, 1]
    assert not any(rate.egos_judged for each in told.rates for rate in (each.base, each.new) if rate)


def test_a_judged_drive_is_compared_with_the_judged_one_of_its_content() -> None:
    told = compared(ONCE, [result("0", status="not_judged"), result("a", ("1", 3.0))])
    assert told.counts == {**dict.fromkeys(told.counts, 0), "unchanged": 1}
    assert (told.no_more_judged, told.new_only) == ([], ["0.csv"])


def test_lists_of_diff_say_how_many_more_there_are_and_use_words() -> None:
    others = [ego_drive(name, sha256=name) for name in "bcdefgh"]
    gone = to_text(compared([*ONCE, *others], ONCE), "minor")
    assert "Only in the base (7 drives): b.csv, c.csv, d.csv, e.csv, f.csv and 2 more\n" in gone
    assert "  drive: 7 not judged now\n" in gone
    assert "lost" not in gone
    assert "Only in the newer audit: 7 drives: `b.csv`, `c.csv`, `d.csv`, `e.csv`, `f.csv` and 2 more" in to_text(
        compared(ONCE, [*ONCE, *others]), "minor", markdown=True
    )
    assert "and 2 more" not in to_text(compared([*ONCE, *others[:5]], ONCE), "minor")


def test_another_ego_of_a_known_log_is_new_for_diff() -> None:
    told = compared(ONCE, [result("a", ("1", 3.0)), result("b", ("2", 3.0))])
    assert told.counts == {**dict.fromkeys(told.counts, 0), "new": 1, "unchanged": 1}
    assert told.n_failing("minor") == 1
    (entry,) = told.entries["new"]
    assert (entry.finding.ego_id, entry.finding.why) == ("2", "the ego was not judged")


def test_the_software_of_a_log_with_two_releases_is_not_known_for_diff() -> None:
    copies = [result(name, ("1", 3.0), tags={"release": name}) for name in "ab"]
    (of_one,) = compared(ONCE, [copies[0]]).comparison.differences
    (of_both,) = compared(ONCE, copies).comparison.differences
    assert "software" not in of_one.causes_not_known
    assert "software" in of_both.causes_not_known


def test_earlier_module_names_are_deprecated() -> None:
    with pytest.warns(DeprecationWarning, match=r"fleet\.counted is deprecated: use drivelint\.fleet\.distinct_logs"):
        assert fleet.counted.create_counted_views is create_counted_views
    with pytest.warns(DeprecationWarning, match="missing is deprecated"):
        assert fleet.missing.missing is missing_signals
    with pytest.raises(AttributeError, match="no attribute 'lost'"):
        fleet.lost  # noqa: B018 - it is looked up
