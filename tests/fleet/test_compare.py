"""Two audits: the same answer as the gate's for two results, planted changes and only they, causes apart, and rates that differ."""

from __future__ import annotations

from collections import Counter
from typing import Any

import duckdb
import numpy as np
import pyarrow as pa
import pytest

from drivelint.errors import UsageError
from drivelint.fleet import compare as compare_module
from drivelint.fleet import intervals
from drivelint.fleet.compare import Comparison, compare
from drivelint.fleet.rate_change import RateChange, compare_rates, rate_changes
from drivelint.fleet.rates import rates
from drivelint.gate import diff, match
from drivelint.result.load import load_result
from drivelint.result.model import Result
from tests.fleet import audits
from tests.fleet.conftest import RunCheck
from tests.report.synthetic import drive, finding, result, rule, verdict

SECOND = 1_000_000_000
StandingCounts = Counter[tuple[str, str, str | None, str]]


def add(con: duckdb.DuckDBPyConnection, run: Result, of: str = "", tags: dict[str, str] | None = None) -> None:
    tables = (run.drives, run.verdicts, run.findings, run.rules)
    drives, *rest = (table.to_pylist() for table in tables)
    audits.add_rows(con, [row | {"tags": tags or {}} for row in drives], *rest, of=of)


def by_sql(base: Result, new: Result) -> StandingCounts:
    with duckdb.connect() as con:
        add(con, base)
        add(con, new, "other_")
        compare(con)
        return Counter(con.execute("SELECT standing, finding_id, base_id, there FROM difference").fetchall())


def worse(base: Result, new: Result) -> tuple[Counter[str], Counter[str]]:
    """Return the findings that are worse, by SQL and by the gate."""
    with duckdb.connect() as con:
        add(con, base)
        add(con, new, "other_")
        compare(con)
        told = con.execute("SELECT finding_id FROM difference WHERE worse").fetchall()
    return Counter(name for (name,) in told), Counter(e.finding_id for e in diff.compare(base, new).entries if e.worse)


def by_gate(base: Result, new: Result) -> StandingCounts:
    return Counter((e.standing, e.finding_id, e.base_id, e.there) for e in diff.compare(base, new).entries)


SOME = (
    "no-collision",
    "overtake-zone",
    "r103.signal-means-go",
    "r112.horn",
    "r126.stopping-gap",
    "r162.safe-distance-ahead",
    "r163.cut-in",
)
RULES_OF_BASE = tuple(part for name in SOME for part in ("--rules", f"ukhc.{name}"))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("options", "logs"),
    [
        ((*RULES_OF_BASE, "--param", "ukhc.overtake-zone.margin_s=0.1"), ("safe", "near_miss", "collision")),
        ((*RULES_OF_BASE, "--profile", "relaxed"), ("safe", "near_miss", "collision")),
        (RULES_OF_BASE[:6], ("near_miss", "collision")),
        ((*RULES_OF_BASE, "--env", "engaged=no"), ("safe", "near_miss", "collision")),
    ],
    ids=["parameter", "profile", "fewer-rules-and-logs", "not-engaged"],
)
def test_it_agrees_with_the_gate_on_real_results(
    run_check: RunCheck, options: tuple[str, ...], logs: tuple[str, ...]
) -> None:
    base, new = load_result(run_check(*RULES_OF_BASE)), load_result(run_check(*options, logs=logs))
    for one, other in ((base, new), (new, base)):
        assert by_sql(one, other) == by_gate(one, other)
    assert {standing for standing, *_ in by_sql(base, new)} != {"unchanged"}, "something differs"


def test_its_rules_of_matching_are_the_gates() -> None:
    of_findings = ("MOST_TIME_BETWEEN_MATCHED_FINDINGS_S", "MOST_DISTANCE_BETWEEN_MATCHED_FINDINGS_M")
    assert [getattr(match, name) for name in of_findings] == [getattr(compare_module, name) for name in of_findings]
    of_changes = ("UNCHANGED_MARGIN_TOLERANCE", "UNCHANGED_INTERVAL_TOLERANCE_S")
    assert [getattr(diff, name) for name in of_changes] == [getattr(compare_module, name) for name in of_changes]


def random_stretches(rng: np.random.Generator, start: int) -> list[dict[str, Any]]:
    """Return when actors are recorded: mostly all the time, else in stretches; sometimes one is not there at all."""
    ends = (
        [(0, 25 * SECOND)]
        if rng.random() < 0.6
        else np.sort(rng.integers(0, 50, (3, 2)).ravel()).reshape(3, 2) * SECOND // 2
    )
    return [
        {"actor_id": actor, "t_from_ns": start + int(a), "t_to_ns": start + int(b)}
        for actor in "1234"
        if rng.random() < 0.9
        for a, b in ends
    ]


def random_result(rng: np.random.Generator, n_drives: int, side: str) -> Result:
    """Return drives with crowded findings and verdicts of all kinds, so that every rule of matching decides something."""
    drives: list[dict[str, Any]] = []
    findings: list[dict[str, Any]] = []
    verdicts: list[dict[str, Any]] = []
    for no in range(n_drives):
        name = f"d{no}" if rng.random() < 0.8 else f"d{no}-{side}"
        sha = f"{no}" if rng.random() < 0.5 else f"{no}{side}"
        start = int(rng.integers(0, 3)) * 100 * SECOND
        lost = rng.random() < 0.05
        duration = None if lost else float(rng.choice([4.0, 25.0]))
        drives.append(
            drive(
                name,
                file_name=f"d{no}.csv",
                sha256=sha,
                t_start_ns=start,
                duration_s=duration,
                recorded=random_stretches(rng, start),
                status="not_judged" if lost else "judged",
            )
        )
        for _ in range(0 if lost else rng.integers(0, 10)):
            who: dict[str, Any] = {
                "drive_id": name,
                "ego_id": str(rng.choice(["1"] * 9 + ["2"])),
                "rule_id": str(rng.choice(["r1"] * 4 + ["r2"])),
            }
            who |= {
                "profile": [None, "nominal", "nominal", "nominal"][rng.integers(0, 4)],
                "object_id": [None, "3", "3", "3", "3", "3", "4"][rng.integers(0, 7)],
            }
            first, length = (rng.integers(0, 50, 2) * SECOND) // 5 if rng.random() < 0.5 else (SECOND, 2 * SECOND)
            a, b = start + first, start + first + length
            worst = int(a + length // 2)
            times = {"t_start_ns": int(a), "t_end_ns": int(b), "t_worst_ns": worst, "t_ref_ns": None, "ref_id": None}
            word = str(rng.choice(["fail", "fail", "fail", "pass", "unknown", "not_applicable", "error"]))
            more = {"occurrence": len(verdicts), "n_expected": 3, "n_judged": int(rng.choice([2, 3]))}
            at = {
                "x_m": [None, 0.0, 6.0][rng.integers(0, 3)],
                "y_m": 0.0,
                "margin": float(rng.choice([-6.0, -6.0, -5.995, -5.0])),
            }
            verdicts.append(verdict(word, **(who | times | more)))
            if word == "fail":
                ident = f"{no}-{sum(row['drive_id'] == name for row in findings[-9:])}"
                row = finding(**(who | times | at | {"occurrence": len(findings), "finding_id": ident}))
                findings.append(row | {"severity": str(rng.choice(["critical"] * 9 + ["minor"]))})
    order = ("drive_id", "ego_id", "rule_id", "profile", "object_id", "occurrence")
    findings.sort(key=lambda row: tuple((row[name] is not None, row[name] or 0) for name in order))
    rules = [rule("r1"), *([rule("r2", profiles=[])] if side == "a" else [rule("r2")])]
    return result(verdicts, findings, drives=drives, rules=rules)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_it_agrees_with_the_gate_on_random_results(seed: int) -> None:
    rng = np.random.default_rng(seed)
    base, new = random_result(rng, 800, "a"), random_result(rng, 800, "b")
    found = by_sql(base, new)
    assert found == by_gate(base, new)
    by_sql_, by_gate_ = worse(base, new)
    assert by_sql_ == by_gate_ != Counter()
    assert {standing for standing, *_ in found} == {
        "new",
        "fixed",
        "changed",
        "unchanged",
        "elsewhere",
        "unknown",
        "lost",
    }


@pytest.mark.slow
def test_an_audit_against_itself_has_nothing(run_check: RunCheck) -> None:
    base = load_result(run_check(*RULES_OF_BASE))
    told = by_sql(base, base)
    assert {standing for standing, *_ in told} == {"unchanged"}
    assert told.total() == base.findings.num_rows
    with duckdb.connect() as con:
        add(con, base)
        add(con, base, "other_")
        assert {each.p_value for each in compare_rates(con)} == {None}, "the same logs are no two samples"


def compared(base: Result, new: Result, tags: tuple[dict[str, str], dict[str, str]], **more: Any) -> Comparison:
    with duckdb.connect() as con:
        add(con, base, tags=tags[0])
        add(con, new, "other_", tags=tags[1])
        return compare(con, **more)


@pytest.mark.ci
def test_planted_changes_and_only_they(run_check: RunCheck) -> None:
    base = load_result(run_check(*RULES_OF_BASE))
    rows = base.findings.to_pylist()
    gone, better, added = rows[0], rows[1], dict(rows[2])
    added |= {"finding_id": "planted", "object_id": "planted", "occurrence": 0}
    kept = [row | ({"margin": (row["margin"] or 0) + 5} if row is better else {}) for row in rows if row is not gone]
    key = ("drive_id", "ego_id", "rule_id", "profile", "object_id")
    said = [
        row
        | ({"verdict": "pass"} if row["verdict"] == "fail" and [row[k] for k in key] == [gone[k] for k in key] else {})
        for row in base.verdicts.to_pylist()
    ]
    new = result(said, [*kept, added], drives=base.drives.to_pylist(), rules=base.rules.to_pylist())
    told = by_sql(base, new)
    assert Counter(e[:2] for e in told.elements() if e[0] != "unchanged") == Counter([
        ("fixed", gone["finding_id"]), ("changed", better["finding_id"]), ("new", "planted"),
    ])  # fmt: skip


def test_an_audit_that_does_not_say_when_actors_were_recorded_is_refused() -> None:
    with duckdb.connect() as con:
        add(con, result([]))
        add(con, result([]), "other_")
        con.execute("ALTER TABLE other_drives DROP recorded")
        with pytest.raises(UsageError, match="audit the drives again"):
            compare(con)


@pytest.mark.slow
def test_causes_stand_apart(run_check: RunCheck) -> None:
    base = load_result(run_check(*RULES_OF_BASE))
    new = load_result(run_check(*RULES_OF_BASE, "--param", "ukhc.overtake-zone.margin_s=0.1"))
    found = compared(base, new, ({"release": "1"}, {"release": "1"}), tools=("0.1", "0.1"))
    moved = [each for each in found.differences if each.standing != "unchanged"]
    assert {(each.rule_id, each.causes, each.causes_not_known) for each in moved} == {
        ("ukhc.overtake-zone", ("parameters",), ())
    }
    found = compared(base, base, ({"release": "1"}, {"release": "2"}), tools=("0.1", "0.2"))
    assert {(each.causes, each.causes_not_known) for each in found.differences} == {(("software", "tool"), ())}
    found = compared(base, base, ({}, {"release": "2"}))
    assert {(each.causes, each.causes_not_known) for each in found.differences} == {((), ("software", "tool"))}
    assert (found.drives_both, found.drives_base_only, found.drives_new_only) == (3, 0, 0)


def test_other_logs_and_rules_are_causes_too() -> None:
    def run_of_drive(name: str, **over: Any) -> Result:
        rows = [verdict("fail", drive_id=name)], [finding(drive_id=name)]
        return result(
            *rows,
            drives=[drive(name, sha256=over["sha"], map_sha256=over["map"])],
            rules=[rule(rule_version=over["v"])],
        )

    found = compared(run_of_drive("d", sha="a", map="m", v="1"), run_of_drive("d", sha="b", map="n", v="2"), ({}, {}))
    (only,) = found.differences
    assert (only.standing, only.causes, only.causes_not_known) == (
        "unchanged",
        ("rule", "data", "map"),
        ("software", "tool"),
    )


def test_logs_of_one_name_are_matched_by_their_content() -> None:
    """In a fleet, each drive's log may be called log.mcap."""

    def fleet(order: str) -> Result:
        drives = [drive(f"log-{n}", file_name="log.mcap", sha256=sha) for n, sha in enumerate(order)]
        rows = [finding(drive_id=row["drive_id"], finding_id=row["sha256"]) for row in drives if row["sha256"] != "c"]
        return result([verdict("fail", drive_id=row["drive_id"]) for row in rows], rows, drives=drives)

    assert {(e[0], e[1], e[2]) for e in by_sql(fleet("abc"), fleet("cab"))} == {
        ("unchanged", "a", "a"),
        ("unchanged", "b", "b"),
    }


def test_a_log_that_is_there_twice_is_matched_once_each() -> None:
    def fleet(order: str) -> Result:
        drives = [drive(f"log-{n}", file_name="log.mcap", sha256=sha) for n, sha in enumerate(order)]
        rows = [finding(drive_id=row["drive_id"], finding_id=row["sha256"]) for row in drives]
        return result([verdict("fail", drive_id=row["drive_id"]) for row in rows], rows, drives=drives)

    told = by_sql(fleet("aab"), fleet("baa"))
    assert told == {("unchanged", "a", "a", "fail"): 2, ("unchanged", "b", "b", "fail"): 1}


def test_holm_is_the_textbooks() -> None:
    assert intervals.holm_corrected([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert intervals.holm_corrected([]) == []


RULES, FLEETS, DRIVES = 10, 1000, 8


@pytest.fixture(scope="module")
def seeded() -> duckdb.DuckDBPyConnection:
    """Two audits of the same true rates, as 1,000 fleets by a tag; ten rules of different rates."""
    rng, con = np.random.default_rng(5), duckdb.connect()
    true = rng.uniform(0.001, 0.05, (FLEETS, RULES))
    for of in ("", "other_"):
        audits.add_rows(con, [], [], [], [rule(f"r{n}", profiles=[]) for n in range(RULES)], of=of)
        km = rng.uniform(5, 80, (FLEETS, DRIVES))
        found = rng.poisson(true[:, None, :] * km[:, :, None])
        fleet, _, rule_no = np.indices(found.shape)
        flat = {
            "drive": np.repeat(np.arange(km.size), RULES),
            "fleet": fleet.ravel(),
            "rule_no": rule_no.ravel(),
            "found": found.ravel(),
        }
        con.register(f"{of}flat", pa.table(flat | {"km": np.repeat(km.ravel(), RULES)}))
        con.execute(f"""
            CREATE TABLE {of}made AS SELECT *, '{of}' || drive AS key, 'r' || rule_no AS rule_id FROM {of}flat;
            INSERT INTO {of}drives BY NAME SELECT key, key AS drive_id, key AS sha256, 'judged' AS status,
                [{{'ego_id': '1', 'km': km, 'hours': km, 'engaged_km': km, 'engaged_hours': km, 'n_steps': 1}}] AS exposure,
                [] AS conditions, MAP {{'fleet': fleet::VARCHAR}} AS tags FROM {of}made WHERE rule_no = 0;
            INSERT INTO {of}verdicts BY NAME SELECT key, key AS drive_id, '1' AS ego_id, rule_id, 1 AS n_expected, 1 AS n_judged,
                CASE WHEN found > 0 THEN 'fail' ELSE 'pass' END AS verdict FROM {of}made;
            INSERT INTO {of}findings BY NAME SELECT key, key AS drive_id, '1' AS ego_id, rule_id
                FROM (SELECT *, unnest(range(found)) FROM {of}made);
        """)
    return con


@pytest.fixture(scope="module")
def changes(seeded: duckdb.DuckDBPyConnection) -> list[list[RateChange]]:
    """The changes of each fleet by itself."""
    sides: list[dict[str, list[Any]]] = [{}, {}]
    for side, of in zip(sides, ("", "other_"), strict=True):
        for rate in rates(seeded, "fleet", of=of):
            side.setdefault(str(rate.tag_value), []).append(rate)
    return [rate_changes(sides[0][fleet], sides[1][fleet]) for fleet in sides[0]]


@pytest.mark.slow
def test_a_difference_of_nothing_is_called_in_at_most_5_percent_of_fleets(changes: list[list[RateChange]]) -> None:
    assert len(changes) == FLEETS
    assert {len(fleet) for fleet in changes} == {RULES}
    assert np.mean([any(each.is_significant for each in fleet) for fleet in changes]) <= 0.05
    uncorrected = np.mean([any((each.p_value or 1) <= 0.05 for each in fleet) for fleet in changes])
    assert uncorrected > 0.1, "without the correction it would be: the test can fail"


@pytest.mark.ci
def test_the_exact_test_is_poissons_given_the_sum(changes: list[list[RateChange]]) -> None:
    """Independently: the chances of all ways to share the findings, by two Poisson distributions of the same rate."""
    from scipy.stats import poisson

    for change in changes[0]:
        assert change.base is not None
        assert change.new is not None
        n = change.base.findings + change.new.findings
        ways = np.arange(n + 1)
        chance = poisson.pmf(ways, change.new.km / 100) * poisson.pmf(n - ways, change.base.km / 100)
        chance /= chance.sum()
        rarer = chance[chance <= chance[change.new.findings] * (1 + 1e-7)].sum()
        assert change.p_value == pytest.approx(rarer, rel=1e-6)


@pytest.mark.slow
def test_a_true_difference_is_called_and_shared_logs_are_left_out(seeded: duckdb.DuckDBPyConnection) -> None:
    cursor = seeded.cursor()
    cursor.execute(
        "CREATE OR REPLACE VIEW worse_drives AS FROM other_drives; CREATE OR REPLACE VIEW worse_verdicts AS FROM other_verdicts"
    )
    cursor.execute("CREATE OR REPLACE VIEW worse_rules AS FROM other_rules")
    cursor.execute(
        "CREATE OR REPLACE VIEW worse_findings AS FROM other_findings UNION ALL FROM other_findings WHERE rule_id = 'r3'"
    )
    called = {each.rule_id for each in compare_rates(cursor, base="", new="worse_") if each.is_significant}
    assert called == {"r3"}
    assert not [each for each in compare_rates(cursor, base="other_", new="worse_") if each.is_significant], (
        "the same logs"
    )


@pytest.mark.parametrize("changed_sites", ["ab", "a", ""])
def test_logs_of_one_name_in_two_folders_are_told_apart_by_their_place(changed_sites: str) -> None:
    """Where both were recorded anew, content, id and name do not say which is which."""
    with duckdb.connect() as con:
        for of, version in (("", 1), ("other_", 2)):
            content = {site: f"{site}{version if site in changed_sites else 1}" for site in "ab"}
            drives = [drive(f"cut-in-{content[site]}", file_name="cut-in.csv", sha256=content[site]) for site in "ab"]
            told = result([verdict("pass", drive_id=f"cut-in-{content[site]}") for site in "ab"], drives=drives)
            rows = [row | {"log": f"{row['sha256'][0]}/cut-in.csv", "tags": {}} for row in told.drives.to_pylist()]
            tables = (told.verdicts.to_pylist(), told.findings.to_pylist(), told.rules.to_pylist())
            audits.add_rows(con, rows, *tables, of=of)
        found = compare(con)
        pairs = con.execute("SELECT base_key, new_key, data FROM same_drive ORDER BY 1").fetchall()
    assert (found.drives_both, found.drives_base_only, found.drives_new_only) == (2, 0, 0)
    assert pairs == [(f"cut-in-{s}1", f"cut-in-{s}{2 if s in changed_sites else 1}", s in changed_sites) for s in "ab"]
