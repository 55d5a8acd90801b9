"""`drivelint diff` of two audits counts as an audit does: one finding of each event."""

from __future__ import annotations

import duckdb

from drivelint.fleet_report.rows import counted_finding_of_each_finding_sql, query_rows

FINDING = """CREATE TABLE {of}findings AS SELECT * FROM (VALUES
    ('k', 'f1', 'r', 'nominal', 'ego', 'x', 100, 100, 10, 10),
    ('k', 'f2', 'r', 'observed', 'ego', 'x', 100, 100, 10, 10),
    ('k', 'f3', 'r', 'observed', 'ego', 'x', 900, 990, 10, 10),
    ('k', 'f4', 'r', 'nominal', 'ego', 'y', 100, 100, 10, 10),
    ('k', 'f5', 't', NULL, 'ego', 'y', 100, 100, 10, 10),
    ('k', 'f6', 't', NULL, 'y', 'ego', 100, 100, 10, 10)
) f(key, finding_id, rule_id, profile, ego_id, object_id, t_start_ns, t_end_ns, n_copies, n_stays)"""
DIFFERENCE = """CREATE TABLE difference AS SELECT standing, finding_id, profile, rule_id, 'critical' AS severity, why_code, 'none' AS there,
    false AS worse, CASE WHEN standing = 'new' THEN key END AS new_key, CASE WHEN standing = 'lost' THEN key END AS base_key
    FROM (SELECT 'new' AS standing, 'drive_not_checked' AS why_code, * FROM findings
        UNION ALL SELECT 'lost', 'drive_not_checked', * FROM base_findings)"""


def test_an_overtake_under_two_profiles_and_a_touch_of_two_egos_count_once() -> None:
    sides = {"new": "", "base": "base_"}
    with duckdb.connect() as con:
        for of in sides.values():
            con.execute(FINDING.format(of=of))
            con.execute(f"CREATE TABLE {of}rules AS SELECT unnest(['r', 't']) AS rule_id, 'stable' AS status")
        con.execute(DIFFERENCE)
        ids = {row[1]: row[2] for row in con.execute(counted_finding_of_each_finding_sql("")).fetchall()}
        (told,) = query_rows(
            con,
            "gating",
            None,
            **sides,
            new_counted=counted_finding_of_each_finding_sql(""),
            base_counted=counted_finding_of_each_finding_sql("base_"),
        )
    assert {name: ids[name] for name in ("f1", "f2", "f3", "f4")} == {"f1": "f1", "f2": "f1", "f3": "f3", "f4": "f4"}
    assert ids["f5"] == ids["f6"] == "f5"
    assert (told["new"], told["critical"], told["of_new_drives"]) == (4, 4, 4)
    assert (told["lost"], told["gone_critical"], told["fixed"]) == (4, 4, 0)
    assert told["of_profiles"]
