"""Invariants: judged on every step of a grid, one verdict per continuous applicable episode and object.

Groups that are whole and kept are settled by one aggregation without a join; only the others are laid over the grid.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.evaluate import applicability, sql_fragments

if TYPE_CHECKING:
    from drivelint.catalogue import Rule

OBJECT_STEPS_TABLE = "pair"
STEPS_TABLE = "step"

_SAME = "a.drive_id = b.drive_id AND a.ego_id = b.ego_id AND a.t_ns = b.t_ns"
_GROUP = "drive_id, ego_id, object_id"
_OBJECT = "drive_id, ego_id, object_id, profile"
_SERIES = f"{_OBJECT}, label"


_WALK = f"""), _linked AS (
    SELECT *, lag(t_ns) OVER w AS t_last_ns, lag(seg) OVER w AS seg_last
        FROM ({{source}}) WINDOW w AS (PARTITION BY {_SERIES} ORDER BY t_ns)
), _walked AS (
    SELECT l.* EXCLUDE (t_last_ns, seg_last), sum(CASE WHEN seg_last = seg AND t_ns - t_last_ns <= s.max_gap_ns THEN 0
        ELSE 1 END)
        OVER (PARTITION BY {", ".join("l." + c.strip() for c in _SERIES.split(","))}
            ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS episode
    FROM _linked l JOIN _subject s ON s.drive_id = l.drive_id AND s.ego_id = l.ego_id"""
"""CTE text (it closes the CTE before it and leaves its last one open): rows of a source numbered by episode."""


def default_steps_table(rule: Rule) -> str | None:
    """Return the table that is an invariant's default grid; None: it brings its own, or needs each step looked at."""
    if (
        rule.kind != "invariant"
        or "applies" in rule.sections
        or applicability.has_conditions(rule)
        or rule.per_profile
        or rule.exempt_after_s != 0
    ):
        return None
    return OBJECT_STEPS_TABLE if rule.per_object else STEPS_TABLE


def _default_grid(per_object: bool) -> str:
    """SQL of the default grid with k and seg: every ego step, times the objects present."""
    if not per_object:
        return "SELECT a.drive_id, a.ego_id, a.t_ns, NULL::VARCHAR AS object_id, a.k, a.seg FROM step a"
    return f"SELECT a.drive_id, a.ego_id, a.t_ns, a.object_id, b.k, b.seg FROM pair a JOIN step b ON {_SAME}"


CREATE_STEP_GROUPS = f"""
CREATE OR REPLACE TEMP TABLE _grid_group AS
WITH _seen AS (
    SELECT grid, {_GROUP}, count(*) AS n, sum(hash(t_ns)::HUGEINT) AS signature,
        min(seg) = max(seg) AND max(k) - min(k) + 1 = count(*) AS unbroken
    FROM (SELECT 'step' AS grid, * FROM ({_default_grid(False)})
        UNION ALL SELECT 'pair', * FROM ({_default_grid(True)}) WHERE $_objects)
    GROUP BY ALL)
SELECT g.* EXCLUDE (unbroken), g.unbroken AND w.ego_id IS NULL AS whole
FROM _seen g LEFT JOIN _watched w ON w.drive_id = g.drive_id AND w.ego_id = g.ego_id
"""
"""Per group of the default grids: its size, an order-free signature of its time stamps, and whether all of it must be judged,
without a gap: the automated driver is engaged at every step."""


def first_pass_sql(rule: Rule, partial: bool) -> str:
    """Return the SQL that appends to `_group` the groups that pass on all their steps without a gap.

    Just its grid: the same number of rows and the same sum of the time stamps' 64-bit hashes, which a lost or a doubled
    row cannot keep. Groups that are whole and nowhere applicable are left out; all others wait for the second pass.
    """
    numbers = sql_fragments.measure_columns(rule, "s.worst.")
    who = " AND g.object_id = s.object_id" if rule.per_object else ""
    return f"""
INSERT INTO _group BY NAME
WITH {sql_fragments.condition_ctes(rule)}, _seen AS (
    SELECT {_GROUP}, count(*) AS n, sum(hash(t_ns)::HUGEINT) AS signature, count(*) FILTER (applies
        AND holds) AS n_kept,
        count(*) FILTER (NOT applies) AS n_out, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns,
            {sql_fragments.deciding_step(rule)} AS worst
    FROM _state GROUP BY ALL)
SELECT $_no AS rule_no, g.drive_id, g.ego_id, g.object_id, coalesce(g.whole AND s.n_kept = s.n, false) AS clean,
    s.t_start_ns, s.t_end_ns, g.n, s.worst.t AS t_worst_ns, {numbers}, coalesce(s.worst.code, 'kept') AS code,
        s.worst.reason AS reason
FROM _grid_group g
LEFT JOIN _seen s ON g.drive_id = s.drive_id AND g.ego_id = s.ego_id{who} AND g.n = s.n AND g.signature = s.signature
{sql_fragments.subject_join(partial, "g")}
WHERE g.grid = '{OBJECT_STEPS_TABLE if rule.per_object else STEPS_TABLE}' AND s.n_out IS DISTINCT FROM g.n
"""


def profile_set_sql(rule: Rule) -> str:
    """SQL for `_profile_set`: per subject the profiles asked for and those that the condition returns, or ''."""
    return f"""
CREATE OR REPLACE TEMP TABLE _profile_set AS
WITH {sql_fragments.condition_ctes(rule)}, _known AS (
    SELECT s.drive_id, s.ego_id, p.profile FROM _subject s CROSS JOIN (SELECT profile FROM profile WHERE selected) p
    UNION SELECT drive_id, ego_id, profile FROM _state WHERE profile IS NOT NULL)
SELECT * FROM _known UNION ALL
SELECT s.drive_id, s.ego_id, '' FROM _subject s ANTI JOIN _known k ON s.drive_id = k.drive_id AND s.ego_id = k.ego_id
"""


def _grid(rule: Rule, partial: bool, unsettled: bool, check_engagement: bool) -> str:
    """CTEs ending in `_grid`: drive_id, ego_id, t_ns, object_id, label, k, seg, applies, doubt and why (the code and the author's
    reason where it is NULL)."""
    if "applies" not in rule.sections:
        first = "_base AS (SELECT *, NULL::VARCHAR AS label, true AS applies, NULL::VARCHAR AS why"
        first += f" FROM ({_default_grid(rule.per_object)}))"
    else:
        own = rule.columns["applies"]
        who = "object_id" if "object_id" in own else "NULL::VARCHAR AS object_id"
        label = "episode::VARCHAR AS label" if "episode" in own else "NULL::VARCHAR AS label"
        three = "applies" if "applies" in own else "true"
        why = f"min(reason) FILTER (({three}) IS NULL)" if "reason" in own else "NULL::VARCHAR"
        crowd = rule.per_object and "object_id" not in own
        first = f"""_applies AS (
{rule.sections["applies"]}
), _distinct AS (
    SELECT drive_id, ego_id, t_ns, {who}, {label}, CASE WHEN bool_or(coalesce({three}, false)) THEN true
        WHEN bool_or({three} IS NULL) THEN NULL
        ELSE false END AS applies, {why} AS why
    FROM _applies GROUP BY ALL
), _base AS (
    SELECT a.drive_id, a.ego_id, a.t_ns, {"p" if crowd else "a"}.object_id, a.label, b.k, b.seg, a.applies, a.why
    FROM _distinct a LEFT JOIN step b ON {_SAME}
    {"JOIN pair p ON a.drive_id = p.drive_id AND a.ego_id = p.ego_id AND a.t_ns = p.t_ns" if crowd else ""})"""
    keep = ""
    if unsettled:
        keep = " SEMI JOIN (SELECT * FROM _group WHERE rule_no = $_no AND NOT clean) _u"
        keep += " ON a.drive_id = _u.drive_id AND a.ego_id = _u.ego_id"
        keep += " AND a.object_id = _u.object_id" if rule.per_object else ""
    joins = applicability.condition_joins(rule, "a", "a.t_ns", check_engagement)
    if not joins:
        return f"""{first}, _grid AS (SELECT a.*, CASE WHEN a.applies IS NULL THEN 'applies_unknown' END AS doubt
            FROM _base a
    {sql_fragments.subject_join(partial, "a")}{keep} WHERE a.applies IS DISTINCT FROM false)"""
    return f"""{first}, _restricted AS (
    SELECT a.* EXCLUDE (applies), a.applies AND {applicability.in_force_sql(rule, check_engagement)} AS applies,
        CASE WHEN a.applies IS NULL THEN 'applies_unknown'
            ELSE {applicability.unknown_reason_sql(rule, check_engagement)} END AS doubt
    FROM _base a
    {joins}
), _grid AS (SELECT a.* FROM _restricted a{sql_fragments.subject_join(partial, "a")}{keep} WHERE a.applies IS DISTINCT FROM false)"""


def steps_to_judge_sql(rule: Rule, partial: bool, check_engagement: bool) -> str:
    """Return the SQL for `_asked`: the grid of a rule without a first pass; empty where nothing is to be judged."""
    return f"CREATE OR REPLACE TEMP TABLE _asked AS WITH {_grid(rule, partial, False, check_engagement)} SELECT * FROM _grid"


def second_pass_sql(rule: Rule, partial: bool, unsettled: bool, check_engagement: bool) -> str:
    """SQL for `_judged`: every step of the grid, judged or not; '' stands for no object, profile or label.

    The grid is what a first pass left unsettled, or `_asked`.

    The conditions are left-joined to the grid on keys alone: a row that the author's join lost is an unknown step.
    """
    who = ""
    if rule.per_object:
        # an author's own grid may hold a step at which it is not known which object is meant
        who = (
            " AND g.object_id IS NOT DISTINCT FROM v.object_id"
            if "applies" in rule.sections
            else " AND g.object_id = v.object_id"
        )
    profile = " AND p.profile = v.profile" if rule.per_profile else ""
    profiles = "JOIN _profile_set p ON g.drive_id = p.drive_id AND g.ego_id = p.ego_id" if rule.per_profile else ""
    final = ") SELECT * FROM _steps"
    if rule.exempt_after_s != 0:
        # an episode whose beginning was not seen (the log's start, a hole) has no known age: none of it is exempt
        final = f"""{_WALK.format(source="SELECT * FROM _steps WHERE applies IS DISTINCT FROM false")}
), _aged AS (
    SELECT *, first_value(t_ns) OVER w AS t_begin_ns, first_value(k) OVER w AS k_begin FROM _walked
    WINDOW w AS (PARTITION BY {_SERIES}, episode ORDER BY t_ns))
SELECT a.* EXCLUDE (t_begin_ns, k_begin, episode) FROM _aged a
LEFT JOIN _segment s ON s.drive_id = a.drive_id AND s.ego_id = a.ego_id AND s.seg = a.seg
WHERE s.seg IS NULL OR k_begin = s.k_first OR t_ns - t_begin_ns >= $_exempt_ns"""
    grid = _grid(rule, partial, True, check_engagement) if unsettled else "_grid AS (SELECT * FROM _asked)"
    return f"""
CREATE OR REPLACE TEMP TABLE _judged AS
WITH {sql_fragments.condition_ctes(rule)}, {grid}, _joined AS (
    SELECT g.drive_id, g.ego_id, coalesce(g.object_id, '') AS object_id,
        {"p.profile" if rule.per_profile else "''"} AS profile,
        coalesce(g.label, '') AS label, NULL::INTEGER AS ref_id, g.t_ns, g.k, g.seg,
        g.applies AND (v.t_ns IS NULL OR v.applies) AS applies, v.holds, v.gain, v.observed, v.required,
        CASE WHEN g.applies IS NULL THEN g.doubt WHEN v.t_ns IS NULL THEN 'missing_step'
            WHEN v.applies IS NULL THEN coalesce(v.code, 'applies_unknown') ELSE v.code END AS code,
        CASE WHEN g.applies THEN v.reason WHEN g.applies IS NULL AND g.doubt = 'applies_unknown' THEN g.why END AS reason
    FROM _grid g {profiles}
    LEFT JOIN _state v ON g.drive_id = v.drive_id AND g.ego_id = v.ego_id AND g.t_ns = v.t_ns{who}{profile}
), _steps AS (SELECT * REPLACE (CASE WHEN applies THEN holds END AS holds) FROM _joined
{final}
"""


INSERT_ERRORS = """
INSERT INTO _error
SELECT $_no, drive_id, ego_id, 'rule_error', CASE WHEN max(n_rows) > 1
    THEN format('the condition returned {} rows for one step (first at {:.3f} s): it must return one', max(n_rows),
        min(t_ns) FILTER (n_rows > 1) / 1e9)
    ELSE format('@applies returned the time {:.3f} s, which is no step of the ego', min(t_ns) / 1e9) END
FROM (SELECT drive_id, ego_id, object_id, profile, label, t_ns, count(*) AS n_rows, min(k) AS k
    FROM _judged GROUP BY ALL)
WHERE n_rows > 1 OR k IS NULL
GROUP BY drive_id, ego_id
"""
"""Appends to `_error` the subjects for which the rule's rows are not one per step of the ego."""


def episodes_sql(rule: Rule) -> str:
    """Return the SQL that appends to `_outcome` one row per episode of `_judged`."""
    return f"""
INSERT INTO _outcome BY NAME
WITH _live AS (SELECT * FROM _judged WHERE applies IS DISTINCT FROM false
), _flagged AS (
    SELECT {_SERIES}, count(*) <> max(k) - min(k) + 1 OR min(seg) <> max(seg) AS broken FROM _live GROUP BY ALL
{_WALK.format(source=f"SELECT l.* FROM _live l SEMI JOIN (FROM _flagged WHERE broken) f USING ({_SERIES})")}
), _rows AS (
    SELECT * FROM _walked UNION ALL BY NAME
    SELECT l.*, 0 AS episode FROM _live l SEMI JOIN (SELECT * FROM _flagged WHERE NOT broken) f USING ({_SERIES})
), _all AS (
    SELECT {_SERIES}, episode, count(*) AS n_expected, count(holds) AS n_judged, count(*) FILTER (NOT holds) AS n_fail,
        min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns, {sql_fragments.deciding_step(rule)} AS worst,
        {sql_fragments.first_unknown_step(rule)} AS unknown
    FROM _rows GROUP BY ALL
), _decided AS (SELECT *, CASE WHEN n_fail > 0 THEN 'fail' WHEN n_judged < n_expected THEN 'unknown'
    ELSE 'pass' END AS verdict FROM _all)
SELECT $_no AS rule_no, {_SERIES}, t_start_ns, t_end_ns, worst.t AS t_worst_ns, verdict,
    CASE verdict WHEN 'unknown' THEN unknown.t ELSE worst.t END AS t_decides_ns,
    CASE verdict WHEN 'unknown' THEN unknown.code WHEN 'fail' THEN coalesce(worst.code, 'violated')
        ELSE coalesce(worst.code, 'kept') END AS code,
    CASE verdict WHEN 'unknown' THEN unknown.reason ELSE worst.reason END AS reason,
    {sql_fragments.measure_columns(rule, "worst.")},
    {sql_fragments.finite_or_null("unknown.observed")} AS bound, unknown.required AS asked, n_expected, n_judged
FROM _decided
"""


INSERT_HOLES = f"""
INSERT INTO _outcome BY NAME
WITH _across AS (
    SELECT {_OBJECT}, t_ns, seg, lag(t_ns) OVER w AS t_prev_ns, lag(seg) OVER w AS seg_prev
    FROM _judged WHERE applies IS DISTINCT FROM false WINDOW w AS (PARTITION BY {_OBJECT} ORDER BY t_ns)
), _ends AS (
    SELECT j.drive_id, j.ego_id, j.object_id, j.profile, j.seg_prev, j.seg,
        p.t_last_ns - j.t_prev_ns <= s.max_gap_ns AS from_edge, j.t_ns - q.t_first_ns <= s.max_gap_ns AS to_edge,
            s.period_ns
    FROM _across j JOIN _subject s USING (drive_id, ego_id)
    JOIN _segment p ON p.drive_id = j.drive_id AND p.ego_id = j.ego_id AND p.seg = j.seg_prev
    JOIN _segment q ON q.drive_id = j.drive_id AND q.ego_id = j.ego_id AND q.seg = j.seg
    WHERE j.seg_prev <> j.seg
), _holes AS (
    SELECT e.*, p.t_last_ns AS t_start_ns, q.t_first_ns AS t_end_ns FROM _ends e
    JOIN _segment p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.seg = CASE WHEN from_edge THEN seg_prev
        ELSE e.seg - 1 END
    JOIN _segment q ON q.drive_id = e.drive_id AND q.ego_id = e.ego_id AND q.seg = CASE WHEN to_edge THEN e.seg
        ELSE seg_prev + 1 END
    WHERE from_edge OR to_edge)
SELECT $_no AS rule_no, {_OBJECT}, t_start_ns, t_end_ns, t_start_ns AS t_worst_ns, t_start_ns AS t_decides_ns,
    'unknown' AS verdict,
    'log_hole' AS code, greatest(1, (t_end_ns - t_start_ns) // greatest(period_ns, 1) - 1) AS n_expected, 0 AS n_judged
FROM _holes
"""
"""Appends a row of its own for each hole between two applicable steps that the rule reaches from either side."""


def lost_objects_sql(rule: Rule, partial: bool, check_engagement: bool) -> str:
    """SQL that appends one unknown row per object whose track ends while it could still have been there."""
    profiles = "JOIN _profile_set p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id" if rule.per_profile else ""
    return f"""
INSERT INTO _outcome BY NAME
SELECT $_no AS rule_no, l.drive_id, l.ego_id, l.object_id, {"p.profile" if rule.per_profile else "''"} AS profile,
    l.t_from_ns AS t_start_ns, l.t_to_ns AS t_end_ns, t.t_ns AS t_worst_ns, t.t_ns AS t_decides_ns, 'unknown' AS verdict, l.code,
    why('recorded_too_short', {{'object_id': l.object_id, 'to_ns': t.t_ns,
        'far_m': CASE WHEN q.clearance_is_bound THEN q.distance_m ELSE coalesce(q.clearance_m, q.distance_m) END,
        'ego_to_ns': s.t_end_ns}}) AS reason,
    greatest(1, (l.t_to_ns - t.t_ns) // greatest(s.period_ns, 1)) AS n_expected, 0 AS n_judged
FROM lost_object l JOIN _subject s ON s.drive_id = l.drive_id AND s.ego_id = l.ego_id {profiles}
CROSS JOIN LATERAL (SELECT l.t_from_ns - 1 AS t_ns) t
LEFT JOIN pair q ON q.drive_id = l.drive_id AND q.ego_id = l.ego_id AND q.object_id = l.object_id AND q.t_ns = t.t_ns
{applicability.condition_joins(rule, "l", "l.t_from_ns", check_engagement)}
{sql_fragments.subject_join(partial, "l")}
WHERE ({applicability.in_force_sql(rule, check_engagement)}) IS DISTINCT FROM false
"""
