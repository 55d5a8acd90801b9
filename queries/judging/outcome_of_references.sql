-- One row per reference, profile and (combine = each) object present.
INSERT INTO _outcome BY NAME
WITH {coverage}, _judged_count AS (
    SELECT ref_id, drive_id, ego_id, object_id, profile, count(*) AS n_expected, count(holds) AS n_judged,
        count(*) FILTER (NOT holds) AS n_fail, count(*) FILTER (holds) AS n_hold,
        {deciding_step} AS worst, {first_unknown_step} AS unknown
    FROM _judged GROUP BY ALL
), _occasion_with_coverage AS (
    SELECT o.*, {profile} AS profile, coalesce(c.n_points, 0) AS n_points, c.problem, c.t_min, c.t_max, {somebody} AS somebody
    FROM _occasion o {profiles} LEFT JOIN _cover c ON c.ref_id = o.ref_id
), _occasion_with_counts AS (
    SELECT o.* EXCLUDE (object_id), coalesce({object_id}, '') AS object_id,
        coalesce(s.n_expected, 0) AS n_expected, coalesce(s.n_judged, 0) AS n_judged,
        s.n_fail, s.n_hold, s.worst, s.unknown
    FROM _occasion_with_coverage o LEFT JOIN _judged_count s ON s.drive_id = o.drive_id AND s.ego_id = o.ego_id AND s.ref_id = o.ref_no
        AND s.profile = o.profile
), _occasion_with_verdict AS (
    SELECT *, CASE
        WHEN t_ref_ns IS NULL THEN ['unknown', 'reference_time_unknown']
        WHEN NOT applies THEN ['not_applicable', 'outside_conditions']
        WHEN applies IS NULL THEN ['unknown', doubt]
        WHEN $_physical AND n_points = 0 THEN ['not_applicable', 'no_anchor']
        WHEN coalesce(CASE WHEN $_eventually THEN n_hold ELSE n_fail END, 0) > 0
            THEN [CASE WHEN $_eventually THEN 'pass' ELSE 'fail' END, worst.code]
        WHEN problem IS NOT NULL THEN ['unknown', problem]
        WHEN n_expected = 0
            THEN ['not_applicable', CASE WHEN n_points > 0 AND NOT somebody THEN 'nobody_there' ELSE 'outside_conditions' END]
        WHEN n_judged < n_expected THEN ['unknown', unknown.code]
        ELSE [CASE WHEN $_eventually THEN 'fail' ELSE 'pass' END, worst.code] END AS coded
    FROM _occasion_with_counts
), _decided AS (
    SELECT *, coded[1] = 'unknown' AND problem IS NULL AS of_step FROM _occasion_with_verdict
)
SELECT $_no AS rule_no, drive_id, ego_id, profile, {who} AS object_id, ref_no AS ref_id, t_ref_ns,
    coalesce(t_min, a_ns) AS t_start_ns, coalesce(t_max, b_ns) AS t_end_ns, known_time_ns(worst.t) AS t_worst_ns,
    known_time_ns(CASE WHEN of_step THEN unknown.t ELSE worst.t END) AS t_decides_ns,
    coded[1] AS verdict, coalesce(coded[2], CASE coded[1] WHEN 'pass' THEN 'kept' ELSE 'violated' END) AS code,
    CASE WHEN coded[1] IN ('pass', 'fail') THEN worst.reason WHEN coded[1] = 'unknown' AND coded[2] IS NOT DISTINCT
        FROM unknown.code THEN unknown.reason END AS reason,
    finite(worst.observed) AS observed, finite(worst.required) AS required,
    margin_of($_sense, worst.observed, worst.required, worst.holds) AS margin,
    finite(unknown.observed) AS bound, unknown.required AS asked, n_expected, n_judged
FROM _decided
