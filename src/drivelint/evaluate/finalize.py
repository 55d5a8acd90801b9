"""One closing step for all rules: nobody is left without a verdict; every row gets number, place, sentence and id."""

from __future__ import annotations

from typing import Final

from drivelint.evaluate import coverage_gaps, findings

# a person counts from the drive's first time stamp, as every other output does: the log's clock may be that of 1970
_AT = "format('{:.3f} s', (t_decides_ns - start_ns) / 1e9)"
_OBJECT = "coalesce('object ' || object_id, 'an object')"
_FROM_TO = "(t_start_ns - start_ns) / 1e9, (t_end_ns - start_ns) / 1e9"
_OBSERVED = "format('{:.6g}', observed) || coalesce(' ' || unit, '')"
_REQUIRED = """CASE sense WHEN '>' THEN 'more than ' WHEN '>=' THEN 'at least ' WHEN '<' THEN 'less than '
            ELSE 'at most ' END
        || format('{:.6g}', required) || coalesce(' ' || unit, '')"""
# those of the step that is not decided, not of the worst one that is
_BOUND, _ASKED = _OBSERVED.replace("observed", "bound"), _REQUIRED.replace("required", "asked")
_MARGIN = "format('{:.6g}', abs(margin)) || coalesce(' ' || unit, '')"

_WHAT = "CASE WHEN observes IS NULL THEN '' ELSE upper(observes[1]) || observes[2:] || ' ' END"

_CONDITIONS: Final = {
    "engaged": ("whether the automated driver drives", "the log''s mode flag engaged, or --env engaged=yes"),
    "road_type": (
        "the kind of road",
        "a map that says it, or what it was, such as --env road_type=motorway, rural or town",
    ),
    "carriageway": ("whether this is a single or a dual carriageway", "--env carriageway=single"),
    "area": ("whether this is a built-up area", "a map with road types, or --env area=built_up"),
    "nation": ("in which country this is", "--env nation=gb"),
    "weather": ("the weather", "--env weather=dry"),
    "light": ("whether it is day or night", "--env light=day or light=night"),
    "vehicle_class": ("which class of vehicle the ego is", "--env vehicle_class=car"),
    "limit": ("the speed limit", "a map with speed limits"),
}
"""Condition -> what is not known, and what to give; as SQL text."""
_NOT_KNOWN = "\n        ".join(
    f"WHEN '{name}_unknown' THEN 'Not judged: {what} is not known' || coalesce(' at ' || {_AT}, '') || ': give {remedy}.'"
    for name, (what, remedy) in _CONDITIONS.items()
)

SENTENCE = f"""CASE
    WHEN reason IS NOT NULL AND (verdict <> 'unknown' OR code <> 'applies_unknown') THEN reason
    WHEN verdict = 'unknown' THEN CASE code
        WHEN 'missing_step' THEN 'Not judged: the rule''s data has no row at ' || {_AT} || '.'
        WHEN 'null_value' THEN 'Not judged: a value that it needs is not known at ' || {_AT} || '.'
        WHEN 'only_a_bound' THEN 'Not decided: only a bound is known at ' || {_AT}
            || coalesce(' (' || {_BOUND} || ', required ' || {_ASKED} || ')', '') || '.'
        WHEN 'applies_unknown' THEN 'Not judged: whether the rule applies is not known' || coalesce(' at ' || {_AT}, '')
            || coalesce(': ' || reason, '') || '.'
        {_NOT_KNOWN}
        WHEN 'not_engaged' THEN 'Not judged: the automated driver does not drive' || coalesce(' at ' || {_AT}, '') || '.'
        WHEN 'reference_time_unknown' THEN 'Not judged: '
            || coalesce(without_time, 'the time of the assertion reference point is not known') || '.'
        WHEN 'anchor_unknown' THEN 'Not judged: '
            || coalesce(without_anchor, 'it is not known when or where the condition had to hold') || '.'
        WHEN 'beyond_sensor_range' THEN 'Not judged: nobody was seen at ' || {_AT}
            || ', but the sensors do not reach everywhere.'
        WHEN 'window_truncated' THEN format(
            'Not judged: the rule looks at {{:.3f}} s to {{:.3f}} s, and the log has the ego from {{:.3f}} s to {{:.3f}} s only'
            || ': record the ego, and who is near it, over all of that.',
            {_FROM_TO}, (ego_from_ns - start_ns) / 1e9, (ego_to_ns - start_ns) / 1e9)
        WHEN 'log_hole' THEN format('Not judged: the log has a hole between {{:.3f}} s and {{:.3f}} s.', {_FROM_TO})
        WHEN 'lost_near_ego' THEN 'Not judged: the track of ' || {_OBJECT} || ' ends close to the ego at ' || {_AT}
            || ': record it for as long as the ego.'
        WHEN 'lost_in_range' THEN 'Not judged: the track of ' || {_OBJECT} || ' ends within sensor range at ' || {_AT} || '.'
        WHEN 'lost_on_road' THEN 'Not judged: the track of ' || {_OBJECT} || ' ends on the road at ' || {_AT} || '.'
        ELSE 'Not judged at ' || coalesce({_AT}, 'an unknown time') || ': ' || replace(code, '_', ' ') || '.' END
    WHEN verdict = 'not_applicable' THEN CASE code
        WHEN 'no_anchor' THEN 'Not applicable: the time or place at which it must hold never came.'
        WHEN 'nobody_there' THEN 'Not applicable: nobody was there.'
        WHEN 'not_engaged' THEN 'Not applicable: the automated driver never drives in this drive.'
        WHEN 'other_nation' THEN 'Not applicable: the law of another nation.'
        WHEN 'outside_conditions' THEN 'Not applicable: outside the conditions of the rule.'
        ELSE 'Not applicable: what the rule is about never happened in this drive.' END
    WHEN code = 'nobody_there' THEN 'Nobody was there at ' || {_AT} || '.'
    WHEN sense = 'holds' THEN CASE verdict
        WHEN 'pass' THEN 'Kept: the condition held.'
        ELSE 'The condition did not hold at ' || {_AT} || '.' END
    WHEN observed IS NULL OR required IS NULL THEN CASE verdict
        WHEN 'pass' THEN 'Kept: ' || {_WHAT} || coalesce({_OBSERVED}, 'unlimited') || ' at ' || {_AT} || '.'
        ELSE 'Violated: ' || {_WHAT} || coalesce({_OBSERVED}, 'unlimited') || ' at ' || {_AT} || '.' END
    ELSE {_WHAT} || {_OBSERVED} || ' at ' || {_AT} || ' where ' || {_REQUIRED} || ' is required: '
        || CASE WHEN verdict = 'pass' THEN 'kept by ' || {_MARGIN}
            WHEN margin = 0 THEN 'exactly at the limit, which does not do'
            ELSE 'missed by ' || {_MARGIN} END || '.' END"""

_MEASURES = """coalesce(reason IS NULL AND CASE verdict
        WHEN 'unknown' THEN code = 'only_a_bound' AND bound IS NOT NULL AND asked IS NOT NULL
        WHEN 'not_applicable' THEN false
        ELSE code <> 'nobody_there' AND sense <> 'holds' AND observed IS NOT NULL AND required IS NOT NULL END, false)"""
"""Whether the sentence tells what was observed and what is required."""

# clean groups of the first pass are outcomes too; a subject for which a rule erred has no other row of that rule
_ALL = f"""
CREATE OR REPLACE TEMP TABLE _closed AS
WITH _rows AS (
    SELECT * FROM _outcome UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, '' AS profile, object_id, t_start_ns, t_end_ns, t_worst_ns,
        t_worst_ns AS t_decides_ns,
        'pass' AS verdict, code, reason, observed, required, margin, n AS n_expected, n AS n_judged
    FROM _group WHERE clean
), _kept AS (
    SELECT r.* FROM _rows r ANTI JOIN _error e ON e.rule_no = r.rule_no AND e.drive_id = r.drive_id
        AND e.ego_id = r.ego_id
    UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, 'error' AS verdict, min(code) AS code, min(reason) AS reason
        FROM _error GROUP BY ALL
    UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, 'unknown' AS verdict, 'missing_' || signal AS code, reason FROM _gated
    UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, 'not_applicable' AS verdict, 'other_nation' AS code FROM _foreign
), _seen AS (
    SELECT * FROM _kept UNION ALL BY NAME
    ({coverage_gaps.OUTCOMES})
)
SELECT * FROM _seen UNION ALL BY NAME
SELECT r.rule_no, s.drive_id, s.ego_id, 'not_applicable' AS verdict,
    CASE WHEN w.never THEN 'not_engaged' ELSE 'not_triggered' END AS code
    FROM _rule r CROSS JOIN _subject s LEFT JOIN _watched w ON w.drive_id = s.drive_id AND w.ego_id = s.ego_id
ANTI JOIN _seen k ON k.rule_no = r.rule_no AND k.drive_id = s.drive_id AND k.ego_id = s.ego_id
"""

_PLACE = "LEFT JOIN ego_state p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_worst_ns"

# the first time at which the log loses somebody, and the last at which somebody comes into it
_SIGHT = """
SELECT drive_id, ego_id, min(t_ns) FILTER (lost) AS gone_ns, max(t_ns) FILTER (NOT lost) AS to_come_ns
FROM track_end GROUP BY ALL
"""

_LACKS = """CASE WHEN p.off_level THEN 'off_level' WHEN p.x_m IS NULL OR p.y_m IS NULL THEN 'no_position'
        WHEN p.yaw_rad IS NULL THEN 'no_heading' WHEN p.length_m IS NULL OR p.width_m IS NULL THEN 'no_size' END"""
"""Why an object has no place, as a code."""

_NO_CAUSE = "('missing_step', 'null_value', 'applies_unknown')"
"""Codes that say at what time something is not known, and not why."""

_HIDDEN = """format('where object {} is at that time is not known: {}{}: record it {}', nearest.id,
        CASE nearest.code
            WHEN 'lost' THEN format('its track ends at {:.3f} s', (nearest.to_ns - d.start_ns) / 1e9)
            WHEN 'lost_behind' THEN format('its track ends at {:.3f} s, behind', (nearest.to_ns - d.start_ns) / 1e9)
            WHEN 'appeared' THEN format('its track begins only at {:.3f} s', (nearest.from_ns - d.start_ns) / 1e9)
            ELSE 'it ' || unplaced_words(nearest.code) END,
        CASE WHEN nearest.m >= 1 THEN format(', and it may be as near as {:.0f} m', floor(nearest.m)) ELSE '' END,
        CASE WHEN nearest.code IN ('lost', 'lost_behind') THEN 'for longer' WHEN nearest.code = 'appeared' THEN 'from earlier on'
            ELSE 'at every step' END)"""
_TRACK = "format('the track of object {{}} {0} at {{:.3f}} s: record it {2}', d.object_id, ({1} - d.start_ns) / 1e9)"
_UNBELIEVED = (
    "CASE WHEN c.drive_id IS NOT NULL THEN ' (velocities that contradict the positions are not used): correct or leave out the velocity' "
    "ELSE ': record it' END"
)

# why: the ego lacks something, or the object of the verdict, or somebody near has no place; else an ego that is off the lanes
_CAUSE = f"""
WITH _doubted AS (
    SELECT DISTINCT drive_id, ego_id, start_ns, t_decides_ns AS t_ns, object_id, of_hidden, of_lanes
    FROM _named
    WHERE verdict = 'unknown' AND reason IS NULL AND code IN {_NO_CAUSE}
), _tracked AS (
    SELECT drive_id, ego_id, object_id, min(t_ns) AS from_ns, max(t_ns) AS to_ns
    FROM pair SEMI JOIN _doubted d USING (drive_id, ego_id)
    GROUP BY ALL
), _near AS (
    SELECT drive_id, ego_id, t_ns, min({{
        'm': h.lane_m, 'id': h.object_id, 'code': coalesce(u.code, {_LACKS}, 'off_lanes'), 'from_ns': k.from_ns, 'to_ns': k.to_ns
    }}) AS nearest
    FROM (SELECT DISTINCT drive_id, ego_id, t_ns FROM _doubted WHERE of_hidden)
    JOIN hidden h USING (drive_id, ego_id, t_ns)
    LEFT JOIN unseen u USING (drive_id, ego_id, t_ns, object_id)
    LEFT JOIN _tracked k USING (drive_id, ego_id, object_id)
    LEFT JOIN pair p USING (drive_id, ego_id, t_ns, object_id)
    GROUP BY drive_id, ego_id, t_ns
), _speedless AS (
    -- a measure over some time needs every speed in that time
    SELECT DISTINCT d.drive_id, d.ego_id, d.t_ns
    FROM _doubted d
    JOIN ego_state e ON e.drive_id = d.drive_id AND e.ego_id = d.ego_id AND e.speed_mps IS NULL
        AND e.t_ns >= d.t_ns - 1_000_000_000 AND e.t_ns <= d.t_ns + 1_000_000_000
), _ahead AS (
    -- the nearest actor in the lane ahead that is not known to be a vehicle
    SELECT drive_id, ego_id, t_ns, n.id AS object_id, n.actor_class AS actor_class
    FROM (
        SELECT drive_id, ego_id, t_ns, min({{'s_m': p.rear_s_m, 'id': p.object_id, 'actor_class': p.actor_class}}) AS n
        FROM (SELECT DISTINCT drive_id, ego_id, t_ns FROM _doubted WHERE of_hidden AND of_lanes AND object_id IS NULL)
        JOIN ego_state e USING (drive_id, ego_id, t_ns)
        JOIN pair p USING (drive_id, ego_id, t_ns)
        WHERE is_vehicle(p.actor_class) IS DISTINCT FROM true AND in_lane(p.d_m, p.lat_half_m, p.half_width_m) AND p.front_s_m > e.rear_s_m
        GROUP BY drive_id, ego_id, t_ns
    )
)
SELECT {{'drive_id': d.drive_id, 'ego_id': d.ego_id, 't_ns': d.t_ns, 'object_id': coalesce(d.object_id, ''), 'of_hidden': d.of_hidden,
    'of_lanes': d.of_lanes}} AS key, CASE
    WHEN e.x_m + e.y_m + e.yaw_rad IS NULL THEN ego_lacks(e.x_m + e.y_m, e.yaw_rad, e.lanelet_id, e.front_s_m)
    WHEN p.object_id IS NOT NULL AND {_LACKS} IS NOT NULL THEN format('object {{}} {{}}: record it', p.object_id, unplaced_words({_LACKS}))
    WHEN p.object_id IS NULL AND o.to_ns < d.t_ns THEN {_TRACK.format("ends", "o.to_ns", "for longer")}
    WHEN p.object_id IS NULL AND o.from_ns > d.t_ns THEN {_TRACK.format("begins only", "o.from_ns", "from earlier on")}
    -- a rule that finds its object itself does not know whom
    WHEN n.nearest IS NOT NULL AND d.of_hidden AND d.object_id IS NULL THEN {_HIDDEN}
    WHEN e.speed_mps IS NULL THEN 'the speed of the ego is not known' || {_UNBELIEVED}
    WHEN p.object_id IS NOT NULL AND p.speed_mps IS NULL
        THEN format('the speed of object {{}} is not known{{}}', p.object_id, {_UNBELIEVED})
    WHEN p.object_id IS NOT NULL AND p.actor_class IS NULL THEN format('the class of object {{}} is not known: record it', p.object_id)
    WHEN n.nearest IS NOT NULL AND d.of_hidden THEN {_HIDDEN}
    WHEN d.of_lanes AND (e.lanelet_id IS NULL OR e.front_s_m IS NULL) THEN ego_lacks(e.x_m, e.yaw_rad, e.lanelet_id, e.front_s_m)
    WHEN d.of_lanes AND p.object_id IS NOT NULL AND p.s_m IS NULL
        THEN format('object {{}} has no place along the road: give a map that has its lane', p.object_id)
    WHEN d.of_hidden AND d.of_lanes AND d.object_id IS NULL AND f.object_id IS NOT NULL THEN CASE
        WHEN f.actor_class IS NULL THEN format('object {{}}, ahead in the lane, may be a vehicle: record its class', f.object_id)
        ELSE format('object {{}}, no vehicle, is nearer than any vehicle, and gaps are kept to vehicles: no recording decides that',
            f.object_id) END
    WHEN b.drive_id IS NOT NULL THEN 'the speed of the ego is not known within 1 s of that' || {_UNBELIEVED} END AS because
FROM _doubted d
LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
LEFT JOIN pair p USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN _near n USING (drive_id, ego_id, t_ns)
LEFT JOIN _speedless b USING (drive_id, ego_id, t_ns)
LEFT JOIN _ahead f USING (drive_id, ego_id, t_ns)
LEFT JOIN _tracked o USING (drive_id, ego_id, object_id)
LEFT JOIN (SELECT DISTINCT drive_id FROM quality WHERE check_id = 'velocity_unknown') c USING (drive_id)
"""

_VERDICTS = f"""
INSERT INTO verdict BY NAME
WITH _sight AS ({_SIGHT}),
_named AS (SELECT v.* REPLACE (nullif(v.profile, '') AS profile, nullif(v.object_id, '') AS object_id,
    nullif(v.label, '') AS label), r.* EXCLUDE (rule_no), coalesce(s.start_ns, 0) AS start_ns,
    s.t_start_ns AS ego_from_ns, s.t_end_ns AS ego_to_ns
    FROM _closed v JOIN _rule r USING (rule_no) LEFT JOIN _subject s ON s.drive_id = v.drive_id AND s.ego_id = v.ego_id),
_cause AS ({_CAUSE}),
_numbered AS (
    SELECT *, row_number() OVER (PARTITION BY drive_id, ego_id, rule_id, profile, object_id
        ORDER BY coalesce(t_ref_ns, t_start_ns) NULLS LAST, t_start_ns NULLS LAST, t_end_ns NULLS LAST,
            ref_id NULLS LAST, code) - 1 AS occurrence,
        coalesce(replace(label, '_', ' ') || ': ', '') || {SENTENCE} AS told,
        CASE WHEN because IS NOT NULL AND verdict = 'unknown' AND reason IS NULL AND code IN {_NO_CAUSE}
            THEN format('{{}}; {{}}.', rtrim(told, '.'), because) ELSE told END AS sentence, {_MEASURES} AS reason_measures
    FROM _named n LEFT JOIN _cause c ON c.key.drive_id = n.drive_id AND c.key.ego_id = n.ego_id AND c.key.t_ns = n.t_decides_ns
        AND c.key.object_id = coalesce(n.object_id, '') AND c.key.of_hidden = n.of_hidden AND c.key.of_lanes = n.of_lanes)
SELECT v.drive_id, v.ego_id, rule_id, rule_version, kind, profile, severity, object_id,
    occurrence::INTEGER AS occurrence, ref_id, t_ref_ns, t_start_ns, t_end_ns,
    t_worst_ns, verdict, code AS reason_code, sentence AS reason, reason_measures, observed, required, margin, unit,
    coalesce(verdict = 'pass' AND {findings.NEAR}, false) AS near_miss,
    coalesce(n_expected, 0) AS n_expected, coalesce(n_judged, 0) AS n_judged, p.x_m, p.y_m, p.lanelet_id,
    CASE WHEN of_others AND verdict IN ('pass', 'fail', 'not_applicable') AND code <> 'other_nation'
        AND (coalesce(g.gone_ns <= t_end_ns, g.gone_ns IS NOT NULL) OR coalesce(g.to_come_ns >= t_start_ns, g.to_come_ns IS NOT NULL))
        THEN 'line_of_sight' END AS assumes
FROM _numbered v {_PLACE}
LEFT JOIN _sight g ON g.drive_id = v.drive_id AND g.ego_id = v.ego_id
"""

_FINDINGS = f"""
INSERT INTO finding BY NAME
WITH _named AS (
    SELECT f.* REPLACE (nullif(f.profile, '') AS profile, nullif(f.object_id, '') AS object_id), r.* EXCLUDE (rule_no),
        f.t_worst_ns AS t_decides_ns, 'fail' AS verdict, s.start_ns, s.sha256, s.t_start_ns AS ego_from_ns, s.t_end_ns AS ego_to_ns,
        NULL::DOUBLE AS bound, NULL::DOUBLE AS asked
    FROM _stretch f JOIN _rule r USING (rule_no) JOIN _subject s ON s.drive_id = f.drive_id AND s.ego_id = f.ego_id
    ANTI JOIN _error e ON e.rule_no = f.rule_no AND e.drive_id = f.drive_id AND e.ego_id = f.ego_id
), _numbered AS (
    SELECT *, (row_number() OVER (PARTITION BY drive_id, ego_id, rule_id, profile, object_id
        ORDER BY t_start_ns, t_end_ns, ref_id NULLS LAST) - 1)::INTEGER AS occurrence,
        {SENTENCE} AS sentence, {_MEASURES} AS reason_measures
    FROM _named)
SELECT sha256(to_json([v.sha256, v.ego_id, rule_id, profile, object_id,
    v.occurrence::VARCHAR])::VARCHAR)[:16] AS finding_id,
    v.drive_id, v.ego_id, rule_id, rule_version, kind, profile, severity, object_id, v.occurrence, ref_id,
    v.t_start_ns, v.t_end_ns, t_worst_ns, sentence AS reason, reason_measures, observed, required, margin, unit, p.x_m, p.y_m,
        p.lanelet_id
FROM _numbered v {_PLACE}
"""

_MARGINS = """
INSERT INTO margin BY NAME
SELECT m.* EXCLUDE (rule_no) REPLACE (nullif(m.profile, '') AS profile, nullif(m.object_id, '') AS object_id),
    r.rule_id FROM _margin m JOIN _rule r USING (rule_no)
ANTI JOIN _error e ON e.rule_no = m.rule_no AND e.drive_id = m.drive_id AND e.ego_id = m.ego_id
"""

COURSES = """
INSERT INTO course BY NAME
WITH _named AS (SELECT c.* REPLACE (nullif(c.profile, '') AS profile, nullif(c.object_id, '') AS object_id), r.rule_id
    FROM _course c JOIN _rule r USING (rule_no)), _whose AS (
    SELECT finding_id, drive_id, ego_id, rule_id, profile, object_id, occurrence, ref_id, t_start_ns, false AS near FROM finding
    UNION ALL
    SELECT NULL, drive_id, ego_id, rule_id, profile, object_id, occurrence, ref_id, t_start_ns, true
    FROM verdict WHERE near_miss)
SELECT f.finding_id, f.drive_id, f.ego_id, f.rule_id, f.profile, f.object_id, f.occurrence,
    list(c.t_ns ORDER BY c.t_ns) AS t_ns, list(c.observed ORDER BY c.t_ns) AS observed,
    list(c.required ORDER BY c.t_ns) AS required, list(c.margin ORDER BY c.t_ns) AS margin, list(c.holds ORDER BY c.t_ns) AS holds
FROM _named c
JOIN _whose f ON f.near = c.near AND f.drive_id = c.drive_id AND f.ego_id = c.ego_id AND f.rule_id = c.rule_id
    AND f.profile IS NOT DISTINCT FROM c.profile
    AND f.object_id IS NOT DISTINCT FROM c.object_id AND f.ref_id IS NOT DISTINCT FROM c.ref_id AND f.t_start_ns = c.t_start_ns
GROUP BY f.finding_id, f.drive_id, f.ego_id, f.rule_id, f.profile, f.object_id, f.occurrence
"""
"""Run after these, if the courses of findings and near misses are asked for."""

STATEMENTS = (coverage_gaps.BLIND, _ALL, _VERDICTS, _FINDINGS, _MARGINS)
"""Run in this order once every rule has left its outcomes."""
