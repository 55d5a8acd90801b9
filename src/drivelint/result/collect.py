"""The output tables, taken from a database that has been judged: verdicts, findings and one row per drive."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pyarrow as pa

from drivelint.drive.trace import LOSS_CHECKS
from drivelint.reasons.reason_table import make_reason_table
from drivelint.result.schemas import arrow_schema, conform

if TYPE_CHECKING:
    import duckdb

_KEYS: Final = (
    "drive_id, ego_id, rule_id, profile NULLS FIRST, object_id NULLS FIRST, occurrence, ref_id NULLS FIRST, "
    "t_start_ns NULLS FIRST"
)

_ONLY: Final = "coalesce(list_contains($only::VARCHAR[], drive_id), true)"  # no list: every drive

_DRIVES: Final = """
WITH
    way AS (
        SELECT drive_id,
            list({'ego_id': ego_id, 'km': km, 'hours': hours, 'engaged_km': engaged_km, 'engaged_hours': engaged_hours,
                'n_steps': n_steps} ORDER BY ego_id) AS exposure
        FROM exposure WHERE coalesce(list_contains($only::VARCHAR[], drive_id), true) GROUP BY drive_id),
    applied AS (
        SELECT drive_id, rule_id, profile, count(*) AS n, count(*) FILTER (verdict IN ('pass', 'fail')) AS n_judged
        FROM verdict
        WHERE verdict <> 'not_applicable' AND coalesce(list_contains($only::VARCHAR[], drive_id), true) GROUP BY ALL),
    occasion AS (
        SELECT drive_id,
            list({'rule_id': rule_id, 'profile': profile, 'n': n, 'n_judged': n_judged}
                ORDER BY rule_id, profile NULLS FIRST) AS occasions
        FROM applied GROUP BY drive_id),
    defect AS (
        SELECT drive_id, check_id, severity, actor_id, n, t_first_ns, message,
            severity = 'error' OR list_contains($losses, check_id) AS loss
        FROM quality
        UNION ALL
        SELECT l.drive_id, m.check_id, m.severity, NULL, m.n, NULL,
            'map ' || e.name || coalesce(', ' || m.lanelet_id, '') || ': ' || m.message, false
        FROM data_log l JOIN map_quality m USING (environment_id) JOIN environment e USING (environment_id)),
    defects AS (
        SELECT drive_id, bool_or(loss) AS lossy,
            list({'check_id': check_id, 'severity': severity, 'actor_id': actor_id, 'n': n, 't_first_ns': t_first_ns,
                'message': message} ORDER BY check_id, actor_id NULLS FIRST, t_first_ns NULLS FIRST, message) AS quality
        FROM defect GROUP BY drive_id),
    given AS (
        SELECT drive_id, list({'condition': condition, 'value': value, 'source': source} ORDER BY condition) AS conditions
        FROM drive_condition WHERE coalesce(list_contains($only::VARCHAR[], drive_id), true) GROUP BY drive_id),
    gaps AS (
        SELECT drive_id,
            list({'ego_id': ego_id, 'signal': signal, 'reason': words} ORDER BY ego_id, signal) AS not_judged
        FROM capability JOIN _worded ON cause = reason
        WHERE NOT available AND coalesce(list_contains($only::VARCHAR[], drive_id), true) GROUP BY drive_id)
SELECT l.drive_id, l.file_name, l.sha256, l.format, l.environment_id, e.name AS map_name, e.sha256 AS map_sha256,
    e.handedness, e.handedness_source, l.utc_start_ns, l.t_start_ns, (l.t_end_ns - l.t_start_ns) / 1e9 AS duration_s,
    l.lon, l.lat,
    coalesce(list_sum([x.km FOR x IN w.exposure]), 0.0::DOUBLE) AS km, l.n_states,
    coalesce(list_sum([x.n_steps FOR x IN w.exposure]), 0)::BIGINT AS n_steps, coalesce(len(w.exposure), 0) AS n_egos,
    'judged' AS status, NULL::VARCHAR AS status_reason, coalesce(d.lossy, false) AS lossy,
    coalesce(c.conditions, []) AS conditions,
    coalesce(w.exposure, []) AS exposure, coalesce(o.occasions, []) AS occasions, coalesce(d.quality, []) AS quality,
    coalesce(g.not_judged, []) AS not_judged
FROM data_log l
LEFT JOIN environment e USING (environment_id)
LEFT JOIN way w USING (drive_id)
LEFT JOIN occasion o USING (drive_id)
LEFT JOIN defects d USING (drive_id)
LEFT JOIN given c USING (drive_id)
LEFT JOIN gaps g USING (drive_id)
WHERE coalesce(list_contains($only::VARCHAR[], l.drive_id), true)
ORDER BY l.drive_id
"""


def verdicts(con: duckdb.DuckDBPyConnection, only: list[str] | None = None) -> pa.Table:
    """Return the table `verdict`, of these drives or all, totally ordered."""
    return conform(
        con.execute(f"SELECT * FROM verdict WHERE {_ONLY} ORDER BY {_KEYS}", {"only": only}).to_arrow_table(), "verdict"
    )


def findings(con: duckdb.DuckDBPyConnection, only: list[str] | None = None) -> pa.Table:
    """Return the table `finding`, of these drives or all, totally ordered."""
    rows = con.execute(f"SELECT * FROM finding WHERE {_ONLY} ORDER BY {_KEYS}, finding_id", {"only": only})
    return conform(rows.to_arrow_table(), "finding")


def drives(con: duckdb.DuckDBPyConnection, only: list[str] | None = None) -> pa.Table:
    """Return one row of the table `drive` per log in the database, or per named one: judged, and on what; ordered."""
    make_reason_table(con, "SELECT NULL AS rule_no, reason AS cause, 0 AS start_ns FROM capability WHERE NOT available")
    return conform(con.execute(_DRIVES, {"only": only, "losses": LOSS_CHECKS}).to_arrow_table(), "drive")


def unjudged_drive(drive_id: str, file_name: str, reason: str, sha256: str | None = None) -> pa.Table:
    """Return the row of the table `drive` for a log that could not be judged at all, and why."""
    schema = arrow_schema("drive")
    row = dict.fromkeys(schema.names)
    row |= {key: [] for key in ("conditions", "exposure", "occasions", "quality", "not_judged")}
    row |= dict.fromkeys(("n_states", "n_steps", "n_egos"), 0)
    row |= {"drive_id": drive_id, "file_name": file_name, "sha256": sha256, "km": 0.0, "lossy": False}
    row |= {"status": "not_judged", "status_reason": reason}
    return pa.Table.from_pylist([row], schema=schema)
