-- One row per reference, profile and (combine = each) object present, of the rules with reference points.
INSERT INTO _outcome BY NAME
WITH _window_extent AS (
    SELECT o.rule_no, o.ref_id, any_value(o.a_ns) AS a_ns, any_value(o.b_ns) AS b_ns, any_value(s.max_gap_ns) AS max_gap_ns,
        any_value(s.t_start_ns) AS t_start_ns, any_value(s.t_end_ns) AS t_end_ns, count(p.ref_id) AS n_points,
        min(p.t_ns) AS t_min, max(p.t_ns) AS t_max, min(p.seg) AS seg_min, max(p.seg) AS seg_max, coalesce(bool_or(g.is_lost), false) AS is_lost
    FROM _occasion o JOIN _subject s ON s.drive_id = o.drive_id AND s.ego_id = o.ego_id
        LEFT JOIN _reference_step p ON p.rule_no = o.rule_no AND p.ref_id = o.ref_id
        LEFT JOIN _segment g ON g.drive_id = p.drive_id AND g.ego_id = p.ego_id AND g.seg = p.seg
    GROUP BY o.rule_no, o.ref_id
), _cover AS (
    -- What keeps a window from being seen whole; a rule without a window has nothing that could be seen in part only.
    SELECT rule_no, ref_id, n_points, CASE WHEN r.subtype = 'temporal' THEN a_ns ELSE t_min END AS t_min,
        CASE WHEN r.subtype = 'temporal' THEN b_ns ELSE t_max END AS t_max, CASE
        WHEN r.subtype IS DISTINCT FROM 'temporal' THEN NULL
        WHEN n_points = 0 AND (a_ns < t_start_ns OR b_ns > t_end_ns) THEN 'window_truncated'
        WHEN n_points = 0 THEN 'log_hole'
        WHEN w.t_min - a_ns > max_gap_ns AND w.t_min <= t_start_ns THEN 'window_truncated'
        WHEN b_ns - w.t_max > max_gap_ns AND w.t_max >= t_end_ns THEN 'window_truncated'
        WHEN w.t_min - a_ns > max_gap_ns OR b_ns - w.t_max > max_gap_ns OR seg_min <> seg_max OR is_lost THEN 'log_hole' END AS problem
    FROM _window_extent w JOIN _rule r USING (rule_no)
), _judged_count AS (
    SELECT rule_no, ref_id, drive_id, ego_id, object_id, profile, count(*) AS n_expected, count(holds) AS n_judged,
        count(*) FILTER (NOT holds) AS n_fail, count(*) FILTER (holds) AS n_hold,
        deciding_step(eventually, sense, holds, gain, t_ns, who, observed, required, code, reason) AS worst, first_unknown_step(holds, t_ns, who, observed, required, code, reason) AS unknown
    FROM (SELECT j.*, r.eventually, r.sense FROM _judged j JOIN _rule r ON r.rule_no = j.rule_no AND r.kind <> 'invariant')
    GROUP BY rule_no, ref_id, drive_id, ego_id, object_id, profile
), _seen AS (
    -- the reference points of a condition about objects at which an object is there
    SELECT DISTINCT p.rule_no, p.ref_id FROM _reference_step p
    SEMI JOIN (SELECT DISTINCT rule_no FROM _occasion WHERE crowd) o ON o.rule_no = p.rule_no
    SEMI JOIN pair q ON q.drive_id = p.drive_id AND q.ego_id = p.ego_id AND q.t_ns = p.t_ns
), _occasion_with_coverage AS (
    SELECT o.*, coalesce(p.profile, '') AS profile, coalesce(c.n_points, 0) AS n_points, c.problem, c.t_min, c.t_max,
        NOT o.crowd OR q.ref_id IS NOT NULL AS somebody, r.eventually, r.sense, r.subtype, r.by_object
    FROM _occasion o JOIN _rule r USING (rule_no)
    LEFT JOIN _profile_set p ON p.rule_no = o.rule_no AND p.drive_id = o.drive_id AND p.ego_id = o.ego_id
    LEFT JOIN _cover c ON c.rule_no = o.rule_no AND c.ref_id = o.ref_id
    LEFT JOIN _seen q ON q.rule_no = o.rule_no AND q.ref_id = o.ref_id
), _occasion_with_counts AS (
    SELECT o.* EXCLUDE (object_id), coalesce(CASE WHEN o.crowd AND o.by_object THEN s.object_id ELSE o.object_id END, '') AS object_id,
        coalesce(s.n_expected, 0) AS n_expected, coalesce(s.n_judged, 0) AS n_judged,
        s.n_fail, s.n_hold, s.worst, s.unknown
    FROM _occasion_with_coverage o LEFT JOIN _judged_count s ON s.rule_no = o.rule_no AND s.drive_id = o.drive_id AND s.ego_id = o.ego_id
        AND s.ref_id = o.ref_no AND s.profile = o.profile
), _occasion_with_verdict AS (
    SELECT *, CASE
        WHEN t_ref_ns IS NULL THEN ['unknown', 'reference_time_unknown']
        WHEN NOT applies THEN ['not_applicable', 'outside_conditions']
        WHEN applies IS NULL THEN ['unknown', doubt]
        WHEN subtype = 'physical' AND n_points = 0 THEN ['not_applicable', 'no_anchor']
        WHEN coalesce(CASE WHEN eventually THEN n_hold ELSE n_fail END, 0) > 0
            THEN [CASE WHEN eventually THEN 'pass' ELSE 'fail' END, worst.code]
        WHEN problem IS NOT NULL THEN ['unknown', problem]
        WHEN n_expected = 0
            THEN ['not_applicable', CASE WHEN n_points > 0 AND NOT somebody THEN 'nobody_there' ELSE 'outside_conditions' END]
        WHEN n_judged < n_expected THEN ['unknown', unknown.code]
        ELSE [CASE WHEN eventually THEN 'fail' ELSE 'pass' END, worst.code] END AS coded
    FROM _occasion_with_counts
), _decided AS (
    SELECT *, coded[1] = 'unknown' AND problem IS NULL AS of_step FROM _occasion_with_verdict
)
SELECT rule_no, drive_id, ego_id, profile,
    CASE WHEN by_object THEN object_id WHEN of_step THEN unknown.who ELSE worst.who END AS object_id, ref_no AS ref_id, t_ref_ns,
    coalesce(t_min, a_ns) AS t_start_ns, coalesce(t_max, b_ns) AS t_end_ns, known_time_ns(worst.t) AS t_worst_ns,
    known_time_ns(CASE WHEN of_step THEN unknown.t ELSE worst.t END) AS t_decides_ns,
    coded[1] AS verdict, coalesce(coded[2], CASE coded[1] WHEN 'pass' THEN 'kept' ELSE 'violated' END) AS code,
    CASE WHEN coded[1] IN ('pass', 'fail') THEN worst.reason WHEN coded[1] = 'unknown' AND coded[2] IS NOT DISTINCT
        FROM unknown.code THEN unknown.reason END AS reason,
    finite(worst.observed) AS observed, finite(worst.required) AS required,
    margin_of(sense, worst.observed, worst.required, worst.holds) AS margin,
    finite(unknown.observed) AS bound, unknown.required AS asked, n_expected, n_judged
FROM _decided
