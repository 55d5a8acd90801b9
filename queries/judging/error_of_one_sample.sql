-- Two measurements make a miss: one alone may be off, and its neighbours contradict it. Where sensors measured the places, a stretch of
-- misses within which the ego, or the object, was measured once only is not decided. A contact may be over before it is seen twice, and
-- the samples beside a detection in a film contradict nothing if they have no detection. In other logs a sample without a place may be one
-- that the program does not believe.
UPDATE _judged SET holds = NULL, code = 'one_sample'
FROM (
    WITH miss AS (
        SELECT j.rule_no, j.drive_id, j.ego_id, j.object_id, j.profile, j.label, j.t_ns, coalesce(nullif(j.who, ''), j.object_id) AS who,
            j.k - row_number() OVER (PARTITION BY j.rule_no, j.drive_id, j.ego_id, j.object_id, j.profile, j.label ORDER BY j.k) AS run
        FROM _judged j
        JOIN _rule r ON r.rule_no = j.rule_no AND r.kind = 'invariant' AND r.sense <> 'holds' AND NOT r.eventually AND NOT r.of_contact
        JOIN data_log g ON g.drive_id = j.drive_id AND g.sensor_range_m IS NOT NULL
        WHERE NOT j.holds
    ), stretch AS (
        SELECT rule_no, drive_id, ego_id, object_id, profile, label, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns, list_distinct(list(who)) AS objects
        FROM miss
        GROUP BY rule_no, drive_id, ego_id, object_id, profile, label, run
    ), side AS (
        SELECT *, unnest([ego_id]) AS actor_id, true AS is_ego FROM stretch
        UNION ALL
        SELECT *, unnest(objects) AS actor_id, false AS is_ego FROM stretch
    )
    SELECT s.* EXCLUDE (actor_id, is_ego, n_samples)
    FROM (
        SELECT s.*, count(*) FILTER (a.x_m IS NOT NULL AND (f.every_ns IS NULL OR is_key_frame(a.t_ns, f.first_ns, f.every_ns))) AS n_samples
        FROM side s
        -- an object may be a place of the map, which is not measured
        SEMI JOIN actor o ON o.drive_id = s.drive_id AND o.actor_id = s.actor_id
        LEFT JOIN _key_frame f ON f.drive_id = s.drive_id AND f.actor_id = s.actor_id
        LEFT JOIN actor_state a ON a.drive_id = s.drive_id AND a.actor_id = s.actor_id AND a.t_ns BETWEEN s.t_start_ns AND s.t_end_ns
        GROUP BY ALL
    ) s
    ASOF LEFT JOIN actor_state b ON b.drive_id = s.drive_id AND b.actor_id = s.actor_id AND b.t_ns < s.t_start_ns
    ASOF LEFT JOIN actor_state n ON n.drive_id = s.drive_id AND n.actor_id = s.actor_id AND n.t_ns > s.t_end_ns
    LEFT JOIN (SELECT DISTINCT drive_id FROM quality WHERE check_id = 'assumed_motion') film ON film.drive_id = s.drive_id
    GROUP BY ALL
    HAVING min(n_samples) < 2 AND NOT bool_or(film.drive_id IS NOT NULL AND b.x_m IS NULL AND n.x_m IS NULL AND coalesce(b.t_ns, n.t_ns) IS NOT NULL)
) x
WHERE NOT _judged.holds AND _judged.rule_no = x.rule_no AND _judged.drive_id = x.drive_id AND _judged.ego_id = x.ego_id AND _judged.object_id = x.object_id
    AND _judged.profile = x.profile AND _judged.label = x.label AND _judged.t_ns BETWEEN x.t_start_ns AND x.t_end_ns
