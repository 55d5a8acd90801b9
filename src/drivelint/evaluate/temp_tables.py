"""Creates and drops the temporary tables of an evaluation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from drivelint.drive import conditions
from drivelint.sql import store
from drivelint.sql.derivations import with_sources

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb

    from drivelint.evaluate.sql_fragments import Binding

_KEYS = "rule_no INTEGER, drive_id VARCHAR, ego_id VARCHAR"
_TABLES = f"""
CREATE OR REPLACE TEMP TABLE _subject AS
    SELECT c.drive_id, c.ego_id, c.period_ns, c.max_gap_ns, c.t_start_ns, c.t_end_ns, l.sha256, l.sensor_range_m,
        coalesce(l.t_start_ns, 0) AS start_ns
    FROM clock c LEFT JOIN data_log l ON c.drive_id = l.drive_id;
CREATE OR REPLACE TEMP TABLE _segment AS
    SELECT drive_id, ego_id, seg, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns, min(k) AS k_first
        FROM step GROUP BY ALL;
CREATE OR REPLACE TEMP TABLE _rule (rule_no INTEGER, rule_id VARCHAR, rule_version VARCHAR, kind VARCHAR,
    severity VARCHAR,
    sense VARCHAR, unit VARCHAR, observes VARCHAR, near_margin DOUBLE, without_time VARCHAR, without_anchor VARCHAR,
    of_others BOOLEAN, of_hidden BOOLEAN, of_lanes BOOLEAN);
CREATE OR REPLACE TEMP TABLE _needs (rule_no INTEGER, pos INTEGER, signal VARCHAR);
CREATE OR REPLACE TEMP TABLE _law (rule_no INTEGER, nation VARCHAR);
CREATE OR REPLACE TEMP TABLE _error ({_KEYS}, code VARCHAR, reason VARCHAR);
CREATE OR REPLACE TEMP TABLE _group ({_KEYS}, object_id VARCHAR, clean BOOLEAN, t_start_ns BIGINT, t_end_ns BIGINT,
    n BIGINT,
    t_worst_ns BIGINT, observed DOUBLE, required DOUBLE, margin DOUBLE, code VARCHAR, reason VARCHAR);
CREATE OR REPLACE TEMP TABLE _outcome ({_KEYS}, profile VARCHAR, object_id VARCHAR, label VARCHAR, ref_id INTEGER,
    t_ref_ns BIGINT,
    t_start_ns BIGINT, t_end_ns BIGINT, t_worst_ns BIGINT, t_decides_ns BIGINT, verdict VARCHAR, code VARCHAR,
        reason VARCHAR,
    observed DOUBLE, required DOUBLE, margin DOUBLE, bound DOUBLE, asked DOUBLE, n_expected BIGINT, n_judged BIGINT);
CREATE OR REPLACE TEMP TABLE _stretch ({_KEYS}, profile VARCHAR, object_id VARCHAR, ref_id INTEGER, t_start_ns BIGINT,
    t_end_ns BIGINT, t_worst_ns BIGINT, code VARCHAR, reason VARCHAR, observed DOUBLE, required DOUBLE, margin DOUBLE);
CREATE OR REPLACE TEMP TABLE _margin ({_KEYS}, profile VARCHAR, object_id VARCHAR, ref_id INTEGER, t_ns BIGINT,
    observed DOUBLE, required DOUBLE, margin DOUBLE, holds BOOLEAN);
CREATE OR REPLACE TEMP TABLE _course ({_KEYS}, profile VARCHAR, object_id VARCHAR, ref_id INTEGER, t_start_ns BIGINT,
    near BOOLEAN, t_ns BIGINT, observed DOUBLE, required DOUBLE, margin DOUBLE, holds BOOLEAN);
"""

# the law of one nation says nothing about a drive in another; where the nation is not known, it is judged
_FOREIGN = """
CREATE OR REPLACE TEMP TABLE _foreign AS
SELECT r.rule_no, n.drive_id, n.ego_id
FROM (SELECT DISTINCT rule_no FROM _law) r
CROSS JOIN (SELECT DISTINCT drive_id, ego_id, nation FROM ego_condition) n
LEFT JOIN _law l ON l.rule_no = r.rule_no AND l.nation = n.nation
GROUP BY ALL
HAVING bool_and(n.nation IS NOT NULL AND l.nation IS NULL)
"""
# the first of a rule's required signals that the log cannot give; a signal nobody answered for is not there
_GATED = """
CREATE OR REPLACE TEMP TABLE _gated AS
SELECT rule_no, drive_id, ego_id, first.signal AS signal, first.reason AS reason FROM (
    SELECT n.rule_no, s.drive_id, s.ego_id,
        min({'pos': n.pos, 'signal': n.signal,
            'reason': coalesce(c.reason, why('nothing_known', {'signal': n.signal}))}) AS first
    FROM _needs n CROSS JOIN _subject s
    LEFT JOIN capability c ON c.drive_id = s.drive_id AND c.ego_id = s.ego_id AND c.signal = n.signal
    WHERE c.available IS DISTINCT FROM true
    GROUP BY ALL) g
ANTI JOIN _foreign f ON f.rule_no = g.rule_no AND f.drive_id = g.drive_id AND f.ego_id = g.ego_id
"""
_TODO = """
CREATE OR REPLACE TEMP TABLE _todo AS
SELECT r.rule_no, s.drive_id, s.ego_id FROM _rule r CROSS JOIN _subject s
ANTI JOIN _gated g ON g.rule_no = r.rule_no AND g.drive_id = s.drive_id AND g.ego_id = s.ego_id
ANTI JOIN _foreign f ON f.rule_no = r.rule_no AND f.drive_id = s.drive_id AND f.ego_id = s.ego_id
"""
OUTCOME_TABLES = ("_error", "_group", "_outcome", "_stretch", "_course", "_margin")
"""What rules leave behind: what another connection judged is brought together with."""
_NAMES = (
    "_subject", "_watched", "_segment", "_rule", "_needs", "_law", "_error", "_group", "_outcome", "_stretch", "_margin", "_course",
    "_foreign", "_gated",
    "_todo", "_grid_group", "_asked", "_blind", "_closed", "_named", "_failed", "_worded", "_judged",
    "_profile_set", "_raw_reference", "reference", "_occasion",
    "reference_step",
)  # fmt: skip


def create_tables(con: duckdb.DuckDBPyConnection, bindings: Sequence[Binding]) -> dict[int, int]:
    """Create the run's temporary tables and return rule number -> subjects for which it is to be run."""
    con.execute(_TABLES)
    # as Arrow tables: lists bound as parameters took a tenth of a second each
    store.insert(con, "_rule", _rules(bindings))
    store.insert(con, "_needs", _needs(bindings))
    store.insert(con, "_law", _laws(bindings))
    con.execute(_FOREIGN)
    con.execute(_GATED)
    con.execute(_TODO)
    counts = con.execute("SELECT rule_no, count(*) FROM _todo GROUP BY rule_no").fetchall()
    return {int(no): int(n) for no, n in counts}


def _rules(bindings: Sequence[Binding]) -> pa.Table:
    told = ("kind", "severity", "sense", "unit", "observes", "near_margin", "without_time", "without_anchor")
    rows = []
    for binding in bindings:
        rule, sources = binding.rule, with_sources(binding.rule.reads)
        row = {"rule_no": binding.no, "rule_id": rule.id, "rule_version": rule.version}
        row |= {name: getattr(rule, name) for name in told}
        row |= {"of_others": "pair" in sources, "of_hidden": "hidden" in sources}
        rows.append(row | {"of_lanes": "registration" in rule.requires})
    return pa.Table.from_pylist(rows)


def _needs(bindings: Sequence[Binding]) -> pa.Table:
    return pa.Table.from_pylist([
        {"rule_no": b.no, "pos": pos, "signal": signal} for b in bindings for pos, signal in enumerate(b.rule.requires)
    ])  # fmt: skip


def _laws(bindings: Sequence[Binding]) -> pa.Table:
    rows = []
    for b in bindings:
        words = (*conditions.with_narrower_values(b.rule.law), *conditions.broader_values(b.rule.law))
        rows += [{"rule_no": b.no, "nation": word} for word in words]
    return pa.Table.from_pylist(rows)


def drop_tables(con: duckdb.DuckDBPyConnection) -> None:
    """Drop the run's temporary tables."""
    con.execute(";".join(f"DROP TABLE IF EXISTS temp.{name}" for name in _NAMES))
