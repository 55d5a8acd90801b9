"""Builds the SQL of rules with reference points: executions, preconditions and postconditions.

References come first; where there is none the rule stops. Then the points that must be judged (`reference_step`), the
conditions left-joined to them on keys alone (`_judged`), and one outcome per reference, profile and object (unless combined).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.evaluate import applicability, sql_fragments

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.catalogue import Rule

_SERIES = "ref_id, drive_id, ego_id, object_id, profile"


def raw_references_sql(rule: Rule, partial: bool) -> str:
    """SQL for `_raw_reference`: the author's reference points of the subjects that are to be judged."""
    return f"""
CREATE OR REPLACE TEMP TABLE _raw_reference AS
WITH _author AS (
{rule.sections["reference"]}
) SELECT r.* FROM _author r SEMI JOIN _subject s ON r.drive_id = s.drive_id
    AND r.ego_id = s.ego_id{sql_fragments.subject_join(partial, "r")}
"""


def references_sql(columns: Sequence[str]) -> str:
    """SQL for `reference`, the table that conditions and anchors see: `ref_id` is 0.. over all subjects."""
    others = [c.replace('"', '""') for c in columns if c not in {"drive_id", "ego_id", "t_ns", "object_id"}]
    rest = [f'"{c}" NULLS LAST' for c in others]
    who = ["object_id NULLS LAST"] if "object_id" in columns else []
    order = ", ".join(["drive_id", "ego_id", "t_ns NULLS LAST", *who, *rest])
    return f"""
CREATE OR REPLACE TEMP TABLE reference AS
SELECT (row_number() OVER (ORDER BY {order}) - 1)::INTEGER AS ref_id, * FROM _raw_reference
"""


def windows_sql(rule: Rule, own_object: bool, check_engagement: bool) -> str:
    """Return the SQL for `_occasion`: each reference point with its window, and whether the rule applies there."""
    start, end = {
        "precondition": ("r.t_ns - $_window_ns", "r.t_ns"),
        "postcondition": ("r.t_ns", "r.t_ns + $_window_ns"),
        "execution": ("r.t_ns", "r.t_ns"),
    }[rule.kind]
    if rule.subtype == "physical":
        start = end = "r.t_ns"
    return f"""
CREATE OR REPLACE TEMP TABLE _occasion AS
SELECT r.ref_id, r.ref_id - min(r.ref_id) OVER (PARTITION BY r.drive_id, r.ego_id) AS ref_no,
    r.drive_id::VARCHAR AS drive_id,
    r.ego_id::VARCHAR AS ego_id, {"r.object_id" if own_object else "NULL"}::VARCHAR AS object_id,
        r.t_ns::BIGINT AS t_ref_ns,
    ({start})::BIGINT AS a_ns, ({end})::BIGINT AS b_ns, {applicability.in_force_sql(rule, check_engagement)} AS applies,
    {applicability.unknown_reason_sql(rule, check_engagement)} AS doubt
FROM reference r
{applicability.condition_joins(rule, "r", "r.t_ns", check_engagement)}
"""


def reference_steps_sql(rule: Rule) -> str:
    """SQL for `reference_step`: where each reference is judged; t_ns is NULL for an anchor that is not known."""
    keys = "o.ref_id, o.ref_no, o.drive_id, o.ego_id, o.object_id"
    asked = "o.applies AND o.t_ref_ns IS NOT NULL"
    if rule.subtype == "temporal":
        # time buckets as long as the window turn the range join into an equi-join: a window touches two of them
        return f"""
CREATE OR REPLACE TEMP TABLE reference_step AS
WITH _bucket AS (
    SELECT *, unnest([a_ns // greatest($_window_ns, 1), a_ns // greatest($_window_ns, 1) + 1]) AS bucket
        FROM _occasion o WHERE {asked})
SELECT {keys}, s.t_ns, s.seg FROM _bucket o
JOIN step s ON s.drive_id = o.drive_id AND s.ego_id = o.ego_id AND s.t_ns // greatest($_window_ns, 1) = o.bucket
    AND s.t_ns >= o.a_ns AND s.t_ns <= o.b_ns
"""
    source = f"(SELECT {keys}, o.t_ref_ns AS t_ns FROM _occasion o WHERE {asked})"
    author = ""
    if rule.subtype == "physical":
        author = f"WITH _anchor AS (\n{rule.sections['anchor']}\n)"
        source = f"""(SELECT DISTINCT {keys}, a.t_ns::BIGINT AS t_ns
    FROM _anchor a JOIN _occasion o ON a.ref_id = o.ref_id WHERE {asked})"""
    return f"""
CREATE OR REPLACE TEMP TABLE reference_step AS
{author} SELECT p.*, s.seg FROM {source} p
LEFT JOIN step s ON s.drive_id = p.drive_id AND s.ego_id = p.ego_id AND s.t_ns = p.t_ns
"""


def judged_steps_sql(rule: Rule, own_object: bool, check_engagement: bool) -> str:
    """SQL for `_judged`: every expected point, judged or not; combined over objects where the rule says so.

    A point of a window at which the automated driver does not drive is not judged: what happens there is not its doing.
    """
    crowd = rule.per_object and not own_object
    combined = rule.combine != "each"
    source = "SELECT *, false AS nobody, NULL::DOUBLE AS sensor_range_m, NULL::VARCHAR AS lost FROM reference_step"
    if crowd:
        source = _crowd(combined)
    on = "g.drive_id = v.drive_id AND g.ego_id = v.ego_id AND g.t_ns = v.t_ns"
    on += " AND g.ref_id = v.ref_id" if rule.has_column("ref_id") else ""
    on += " AND g.object_id IS NOT DISTINCT FROM v.object_id" if rule.per_object else ""
    on += " AND p.profile = v.profile" if rule.per_profile else ""
    # where nobody is, "all" is kept and "any" is missed by as much as can be
    edge = "'inf'::DOUBLE" if rule.combine == "all" else "'-inf'::DOUBLE"
    human, why = "false", ""
    if check_engagement:
        human = f"({applicability.ENGAGED}) IS DISTINCT FROM true"
        why = f"WHEN {human} THEN CASE WHEN NOT e.engaged THEN 'not_engaged' ELSE 'engaged_unknown' END"
    empty = f"CASE WHEN g.sensor_range_m IS NULL THEN {'true' if rule.combine == 'all' else 'false'} END"
    return f"""
CREATE OR REPLACE TEMP TABLE _judged AS
WITH {sql_fragments.condition_ctes(rule)}, _grid AS ({source}
), _joined AS (
    SELECT g.ref_no AS ref_id, g.drive_id, g.ego_id, g.object_id, {"p.profile" if rule.per_profile else "''"} AS profile,
        g.t_ns, g.seg, v.t_ns IS NULL OR v.applies AS applies, v.observed, v.required,
        CASE WHEN g.nobody THEN {edge} ELSE v.gain END AS gain,
        CASE WHEN {human} THEN NULL WHEN g.nobody THEN {empty} WHEN v.applies AND g.lost IS NULL THEN v.holds END AS holds,
        CASE WHEN g.lost IS NOT NULL THEN g.lost WHEN g.t_ns IS NULL THEN 'anchor_unknown' {why}
            WHEN g.nobody AND g.sensor_range_m IS NULL THEN 'nobody_there'
            WHEN g.nobody THEN 'beyond_sensor_range' WHEN v.t_ns IS NULL THEN 'missing_step'
            WHEN v.applies IS NULL THEN coalesce(v.code, 'applies_unknown') ELSE v.code END AS code,
        CASE WHEN NOT ({human}) THEN v.reason END AS reason
    FROM _grid g {"JOIN _profile_set p ON g.drive_id = p.drive_id AND g.ego_id = p.ego_id" if rule.per_profile else ""}
    LEFT JOIN _state v ON {on}
    {applicability.condition_joins(rule, "g", "g.t_ns", True) if check_engagement else ""}
), _expected AS (SELECT * FROM _joined WHERE applies IS DISTINCT FROM false
){_combination(rule) if combined else ", _series AS (SELECT *, object_id AS who, 1 AS n_same FROM _expected)"}
SELECT * REPLACE (coalesce(object_id, '') AS object_id, coalesce(who, '') AS who), row_number()
    OVER (PARTITION BY {_SERIES} ORDER BY t_ns) AS n FROM _series
"""


def _crowd(combined: bool) -> str:
    """SQL of the points times the objects present, and those that were lost and could still be there (`lost`: why)."""
    # an anchor without a time is unknown whoever is there; nobody is a row only where the objects are combined
    return f"""SELECT p.* REPLACE (q.object_id AS object_id), q.object_id IS NULL AND p.t_ns IS NOT NULL AS nobody,
        s.sensor_range_m, NULL::VARCHAR AS lost
    FROM reference_step p JOIN _subject s ON s.drive_id = p.drive_id AND s.ego_id = p.ego_id
    LEFT JOIN pair q ON q.drive_id = p.drive_id AND q.ego_id = p.ego_id AND q.t_ns = p.t_ns
    WHERE {"true" if combined else "q.object_id IS NOT NULL OR p.t_ns IS NULL"}
    UNION ALL BY NAME
    SELECT p.* REPLACE (l.object_id AS object_id), false AS nobody, NULL::DOUBLE AS sensor_range_m, min(l.code) AS lost
    FROM reference_step p JOIN lost_object l ON l.drive_id = p.drive_id AND l.ego_id = p.ego_id
        AND p.t_ns >= l.t_from_ns AND p.t_ns <= l.t_to_ns
    ANTI JOIN pair q ON q.drive_id = p.drive_id AND q.ego_id = p.ego_id AND q.t_ns = p.t_ns AND q.object_id = l.object_id
    GROUP BY ALL"""


def _combination(rule: Rule) -> str:
    """CTE `_series`: the objects of one point as one step, by three-valued all or any; `who` decided it."""
    decides = sql_fragments.step_by_rank(2, 0, 1) if rule.combine == "all" else sql_fragments.step_by_rank(0, 2, 1, "-")
    decides = decides.replace("'observed': observed", "'who': object_id, 'gain': gain, 'observed': observed")
    return f""", _same AS (
    SELECT ref_id, drive_id, ego_id, profile, t_ns, seg, count(*) - count(DISTINCT coalesce(object_id,
        '')) + 1 AS n_same, {decides} AS d
    FROM _expected GROUP BY ALL
), _series AS (
    SELECT ref_id, drive_id, ego_id, NULL::VARCHAR AS object_id, profile, t_ns, seg, d.observed AS observed,
        d.required AS required,
        d.gain AS gain, d.holds AS holds, d.code AS code, d.reason AS reason, d.who AS who, n_same
    FROM _same)"""


INSERT_ERRORS = f"""
INSERT INTO _error
SELECT $_no, drive_id, ego_id, 'rule_error',
    format('the condition returned {{}} rows for one step (first at {{:.3f}} s): it must return one', max(n_rows),
        min(t_ns) / 1e9)
FROM (SELECT {_SERIES}, t_ns, greatest(count(*), max(n_same)) AS n_rows FROM _judged GROUP BY ALL)
WHERE n_rows > 1
GROUP BY drive_id, ego_id
"""
"""Appends to `_error` the subjects for which the condition returned more than one row for a key."""


def _coverage(rule: Rule) -> str:
    """CTE `_cover`: per reference what keeps its window from being seen whole; NULL: nothing."""
    if rule.subtype != "temporal":
        return """_cover AS (
    SELECT ref_id, count(*) AS n_points, NULL::VARCHAR AS problem, min(t_ns) AS t_min, max(t_ns) AS t_max
    FROM reference_step GROUP BY ref_id)"""
    return """_seen AS (
    SELECT o.ref_id, any_value(o.a_ns) AS a_ns, any_value(o.b_ns) AS b_ns, any_value(s.max_gap_ns) AS max_gap_ns,
        any_value(s.t_start_ns) AS t_start_ns,
        any_value(s.t_end_ns) AS t_end_ns, count(p.t_ns) AS n_points, min(p.t_ns) AS t_min, max(p.t_ns) AS t_max,
            min(p.seg) AS seg_min, max(p.seg) AS seg_max
    FROM _occasion o JOIN _subject s ON s.drive_id = o.drive_id AND s.ego_id = o.ego_id
        LEFT JOIN reference_step p ON p.ref_id = o.ref_id
    GROUP BY o.ref_id
), _cover AS (
    SELECT ref_id, n_points, a_ns AS t_min, b_ns AS t_max, CASE
        WHEN n_points = 0 AND (a_ns < t_start_ns OR b_ns > t_end_ns) THEN 'window_truncated'
        WHEN n_points = 0 THEN 'log_hole'
        WHEN t_min - a_ns > max_gap_ns AND t_min <= t_start_ns THEN 'window_truncated'
        WHEN b_ns - t_max > max_gap_ns AND t_max >= t_end_ns THEN 'window_truncated'
        WHEN t_min - a_ns > max_gap_ns OR b_ns - t_max > max_gap_ns OR seg_min <> seg_max THEN 'log_hole' END AS problem
    FROM _seen)"""


def outcomes_sql(rule: Rule, own_object: bool) -> str:
    """SQL that appends to `_outcome` one row per reference, profile and (combine = each) object present."""
    crowd = rule.per_object and not own_object
    decided = "coalesce(n_hold, 0) > 0" if rule.quantifier == "eventually" else "coalesce(n_fail, 0) > 0"
    early, late = ("pass", "fail") if rule.quantifier == "eventually" else ("fail", "pass")
    unseen = "coded[1] = 'unknown' AND problem IS NULL"
    who = f"CASE WHEN {unseen} THEN unknown.who ELSE worst.who END" if rule.combine != "each" else "object_id"
    none = (
        "CASE WHEN n_points > 0 AND NOT somebody THEN 'nobody_there' ELSE 'outside_conditions' END"
        if crowd
        else "'outside_conditions'"
    )
    profiles = "JOIN _profile_set p ON o.drive_id = p.drive_id AND o.ego_id = p.ego_id" if rule.per_profile else ""
    somebody = (
        "o.ref_id IN (SELECT ref_id FROM reference_step JOIN pair USING (drive_id, ego_id, t_ns))" if crowd else "true"
    )
    return f"""
INSERT INTO _outcome BY NAME
WITH {_coverage(rule)}, _steps AS (
    SELECT {_SERIES}, count(*) AS n_expected, count(holds) AS n_judged, count(*) FILTER (NOT holds) AS n_fail,
        count(*) FILTER (holds) AS n_hold,
        {sql_fragments.deciding_step(rule)} AS worst, {sql_fragments.first_unknown_step(rule)} AS unknown
    FROM _judged GROUP BY ALL
), _all AS (
    SELECT o.*, {"p.profile" if rule.per_profile else "''"} AS profile, coalesce(c.n_points, 0) AS n_points, c.problem,
        c.t_min, c.t_max,
        {somebody} AS somebody
    FROM _occasion o {profiles} LEFT JOIN _cover c ON c.ref_id = o.ref_id
), _state AS (
    SELECT o.* EXCLUDE (object_id), coalesce({"s.object_id" if crowd and rule.combine == "each" else "o.object_id"},
        '') AS object_id,
         coalesce(s.n_expected, 0) AS n_expected, coalesce(s.n_judged, 0) AS n_judged,
        s.n_fail, s.n_hold, s.worst, s.unknown
    FROM _all o LEFT JOIN _steps s ON s.drive_id = o.drive_id AND s.ego_id = o.ego_id AND s.ref_id = o.ref_no
        AND s.profile = o.profile
), _coded AS (
    SELECT *, CASE
        WHEN t_ref_ns IS NULL THEN ['unknown', 'reference_time_unknown']
        WHEN NOT applies THEN ['not_applicable', 'outside_conditions']
        WHEN applies IS NULL THEN ['unknown', doubt]
        WHEN {"n_points = 0" if rule.subtype == "physical" else "false"} THEN ['not_applicable', 'no_anchor']
        WHEN {decided} THEN ['{early}', worst.code]
        WHEN problem IS NOT NULL THEN ['unknown', problem]
        WHEN n_expected = 0 THEN ['not_applicable', {none}]
        WHEN n_judged < n_expected THEN ['unknown', unknown.code]
        ELSE ['{late}', worst.code] END AS coded
    FROM _state
)
SELECT $_no AS rule_no, drive_id, ego_id, profile, {who} AS object_id, ref_no AS ref_id, t_ref_ns,
    coalesce(t_min, a_ns) AS t_start_ns, coalesce(t_max, b_ns) AS t_end_ns, nullif(worst.t,
        {sql_fragments.UNKNOWN_TIME_NS}) AS t_worst_ns,
    nullif(CASE WHEN {unseen} THEN unknown.t
        ELSE worst.t END, {sql_fragments.UNKNOWN_TIME_NS}) AS t_decides_ns,
    coded[1] AS verdict, coalesce(coded[2], CASE coded[1] WHEN 'pass' THEN 'kept' ELSE 'violated' END) AS code,
    CASE WHEN coded[1] IN ('pass', 'fail') THEN worst.reason WHEN coded[1] = 'unknown' AND coded[2] IS NOT DISTINCT
        FROM unknown.code THEN unknown.reason END AS reason,
    {sql_fragments.measure_columns(rule, "worst.")},
    {sql_fragments.finite_or_null("unknown.observed")} AS bound, unknown.required AS asked, n_expected, n_judged
FROM _coded
"""
