-- The verdicts: at least one row for every rule and subject (an ego in a drive).
CREATE OR REPLACE TEMP TABLE _closed AS
-- Groups that passed in the first pass (`clean`, see group.sql) are outcomes, too. If a rule failed with an error for a subject, that error
-- is its only row.
WITH _outcome_or_clean_group AS (
    SELECT * FROM _outcome UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, '' AS profile, object_id, t_start_ns, t_end_ns, t_worst_ns,
        t_worst_ns AS t_decides_ns,
        'pass' AS verdict, code, reason, observed, required, margin, n AS n_expected, n AS n_judged
    FROM _group WHERE clean
), _outcome_in_time AS (
    -- A pass within a lost stretch is unknown: the log does not say whose states it lost there. A fail stands.
    FROM _outcome_or_clean_group WHERE verdict IS DISTINCT FROM 'pass'
    UNION ALL BY NAME
    SELECT o.* REPLACE (CASE WHEN l.is_lost THEN 'unknown' ELSE o.verdict END AS verdict, CASE WHEN l.is_lost THEN 'log_hole' ELSE o.code END AS code,
        CASE WHEN l.is_lost THEN NULL ELSE o.reason END AS reason, CASE WHEN l.is_lost THEN NULL ELSE o.margin END AS margin)
    FROM (FROM _outcome_or_clean_group WHERE verdict = 'pass') o
    LEFT JOIN (FROM _segment WHERE is_lost) l ON l.drive_id = o.drive_id AND l.ego_id = o.ego_id
        AND o.t_worst_ns BETWEEN l.t_first_ns AND l.t_last_ns
), _rule_row AS (
    SELECT r.* FROM _outcome_in_time r ANTI JOIN _error e ON e.rule_no = r.rule_no AND e.drive_id = r.drive_id
        AND e.ego_id = r.ego_id
    UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, 'error' AS verdict, min(code) AS code, min(reason) AS reason
        FROM _error GROUP BY ALL
    UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, 'unknown' AS verdict, 'missing_' || signal AS code, reason FROM _gated
    UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, 'not_applicable' AS verdict, 'unrecorded_' || signal AS code, reason FROM _unrecorded
    UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, 'not_applicable' AS verdict, code FROM _excluded
), _blind_stretch_of_rule AS (
    SELECT r.rule_no, b.*, s.max_gap_ns, s.start_ns
    FROM _blind b
    JOIN _subject s ON s.drive_id = b.drive_id AND s.ego_id = b.ego_id
    -- a stretch without steps (no signal) concerns every rule that is no invariant
    JOIN (
        SELECT rule_no, NULL AS signal FROM _rule WHERE kind <> 'invariant'
        UNION
        SELECT rule_no, signal FROM _needs
        UNION
        SELECT rule_no, 'lost' FROM _rule WHERE of_others
    ) r ON r.signal IS NOT DISTINCT FROM b.signal
), _blind_outcome AS (
    -- One unknown outcome per rule and subject for the blind stretches that no unknown or error row of the rule covers already. None if the
    -- rule's conditions never held, or if the automated driver never drives.
    SELECT b.rule_no, b.drive_id, b.ego_id, min(b.a_ns) AS t_start_ns, min({'a': b.a_ns, 'b': b.b_ns}).b AS t_end_ns, 'unknown' AS verdict,
        min({'a': b.a_ns, 'code': CASE signal WHEN 'indicator' THEN 'indicator_unknown' WHEN 'registration' THEN 'ego_not_placed'
            ELSE 'log_hole' END}).code AS code,
        why(min({'a': b.a_ns, 'code': CASE signal WHEN 'indicator' THEN 'indicator_gap' WHEN 'registration' THEN 'ego_place_gap'
                ELSE 'log_gap' END}).code,
            {'from_ns': min(b.a_ns), 'to_ns': min({'a': b.a_ns, 'b': b.b_ns}).b, 'n_more': nullif(count(*) - 1, 0)}) AS reason
    FROM _blind_stretch_of_rule b
    LEFT JOIN _watched w ON w.drive_id = b.drive_id AND w.ego_id = b.ego_id
    LEFT JOIN (
        SELECT rule_no, drive_id, ego_id, bool_and(code IN ('other_nation', 'outside_conditions') OR starts_with(code, 'unrecorded_')) AS elsewhere FROM _rule_row GROUP BY ALL
    ) k ON k.rule_no = b.rule_no AND k.drive_id = b.drive_id AND k.ego_id = b.ego_id
    ANTI JOIN (
        -- an error, or an unknown without times, speaks of the whole drive
        SELECT rule_no, drive_id, ego_id, coalesce(CASE WHEN verdict = 'unknown' THEN t_start_ns END, -9_000_000_000_000_000_000) AS from_ns,
            coalesce(CASE WHEN verdict = 'unknown' THEN t_end_ns END, 9_000_000_000_000_000_000) AS to_ns
        FROM _rule_row WHERE verdict IN ('error', 'unknown')
    ) u ON u.rule_no = b.rule_no AND u.drive_id = b.drive_id AND u.ego_id = b.ego_id
        AND u.from_ns <= b.b_ns + b.max_gap_ns AND u.to_ns >= b.a_ns - b.max_gap_ns
    -- A short lost stretch hides no whole occasion, so only invariants look at it.
    LEFT JOIN _rule q ON q.rule_no = b.rule_no
    WHERE w.never IS DISTINCT FROM true AND k.elsewhere IS DISTINCT FROM true
        AND (b.signal IS DISTINCT FROM 'lost' OR q.kind = 'invariant' OR b.b_ns - b.a_ns >= 1_000_000_000)
    GROUP BY b.rule_no, b.drive_id, b.ego_id
), _outcome_or_blind AS (
    SELECT * FROM _rule_row UNION ALL BY NAME SELECT * FROM _blind_outcome
)
SELECT * FROM _outcome_or_blind UNION ALL BY NAME
SELECT r.rule_no, s.drive_id, s.ego_id, 'not_applicable' AS verdict,
    CASE WHEN w.never THEN 'not_engaged' ELSE 'not_triggered' END AS code
    FROM _rule r CROSS JOIN _subject s LEFT JOIN _watched w ON w.drive_id = s.drive_id AND w.ego_id = s.ego_id
ANTI JOIN _outcome_or_blind k ON k.rule_no = r.rule_no AND k.drive_id = s.drive_id AND k.ego_id = s.ego_id
