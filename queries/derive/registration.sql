-- Does the trace fit the map? Checked before any blame: on a lane (or a shoulder, where some drives are for most of the time) for at least 80 % of the steps, with the traffic for at least 60 % of
-- those in motion (steps of an overtake in the opposing lane left out: a short drive may be little else), and in the median (of what it drives beside such an overtake, where that is enough) within 1.2 m of the centre line (half a lane: a map shifted by one lane keeps 100 % on a lane);
-- or three of four other vehicles drive with their lanes, and the ego was against its own for longer than an overtake takes: then the map
-- fits, and it is the ego that is on the wrong side; or the ego keeps to the middle of a lane before and after all that, on a road that runs as
-- the other does: the map fits there, and a log does not slip away from it and back.
WITH away AS (
    SELECT DISTINCT x.drive_id, x.ego_id, st.t_ns
    FROM excursion x
    JOIN step st ON st.drive_id = x.drive_id AND st.ego_id = x.ego_id AND st.t_ns >= x.t0_ns AND st.t_ns <= x.t_end_ns
    WHERE x.over_against
),
placed AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, coalesce(e.lanelet_id, a.lanelet_id) AS lanelet_id, coalesce(e.with_direction, a.with_direction) AS with_direction,
        coalesce(abs(e.d_m), a.off_m) AS off_m
    FROM ego_lane e
    LEFT JOIN ego_aside a USING (drive_id, ego_id, t_ns)
),
counted AS (
    SELECT
        st.drive_id, st.ego_id,
        count(s.x_m) AS n_steps,
        count(e.lanelet_id) AS n_on_lane,
        count(*) FILTER (e.lanelet_id IS NOT NULL AND s.speed_mps > 1 AND x.t_ns IS NULL) AS n_moving,
        count(*) FILTER (e.with_direction AND s.speed_mps > 1 AND x.t_ns IS NULL) AS n_with_direction,
        sum(st.dt_ns) FILTER (NOT e.with_direction AND s.speed_mps > 1 AND x.t_ns IS NULL) AS against_ns,
        -- a short log may be half an overtake: what it drives beside that tells, if it is 5 s and a third of the log
        CASE WHEN coalesce(sum(st.dt_ns) FILTER (e.off_m IS NOT NULL AND s.speed_mps > 1 AND x.t_ns IS NULL), 0) >= 5_000_000_000
            AND 3 * count(e.off_m) FILTER (s.speed_mps > 1 AND x.t_ns IS NULL) >= count(s.x_m)
            THEN quantile_disc(e.off_m, 0.5) FILTER (s.speed_mps > 1 AND x.t_ns IS NULL) ELSE quantile_disc(e.off_m, 0.5) END AS lateral_median_m
    FROM step st
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    LEFT JOIN placed e ON e.drive_id = st.drive_id AND e.ego_id = st.ego_id AND e.t_ns = st.t_ns
    LEFT JOIN away x ON x.drive_id = st.drive_id AND x.ego_id = st.ego_id AND x.t_ns = st.t_ns
    GROUP BY ALL
),
judged AS (
    SELECT
        c.*, g.environment_id IS NULL AS no_map,
        CASE
            WHEN g.environment_id IS NULL THEN 'no map'
            WHEN n_steps = 0 THEN 'the ego has no position'
            WHEN n_on_lane < 0.8 * n_steps THEN 'the ego is on a lane of the map in only ' || n_on_lane || ' of ' || n_steps || ' steps: wrong map, offset or frame?'
            WHEN n_with_direction < 0.6 * n_moving THEN 'the ego drives against its lane''s direction in ' || (n_moving - n_with_direction) || ' of ' || n_moving || ' moving steps: wrong handedness or frame?'
            WHEN lateral_median_m > 1.2 THEN 'half of the time the ego is more than ' || round(lateral_median_m, 2)::VARCHAR || ' m from its lane''s centre line: map offset?'
        END AS trouble,
        -- against its lane, the others can tell, unless the log began in the middle of an overtake; off the lanes, it may be just its lane that the map lacks
        n_on_lane >= 0.8 * n_steps AND n_with_direction < 0.6 * n_moving AND against_ns > longest_overtake_ns() AS against
    FROM counted c JOIN data_log g USING (drive_id)
),
-- where the ego drives against its lane, the other vehicles tell whether that is the map's fault or the ego's
driven AS (
    SELECT
        s.drive_id, s.actor_id, s.t_ns, s.speed_mps,
        min({'off_m': abs(o.d_m), 'with_direction': abs(o.heading_diff_rad) < pi() / 2, 'along': abs(o.heading_diff_rad) < turned_off_rad()}) FILTER (o.drivable) AS b
    FROM state_dynamics s
    SEMI JOIN judged j ON j.drive_id = s.drive_id AND NOT j.no_map AND j.against
    JOIN road_user a ON a.drive_id = s.drive_id AND a.actor_id = s.actor_id AND is_vehicle(a.actor_class) AND a.actor_class <> 'bicycle'
    LEFT JOIN lane_occupancy o ON o.drive_id = s.drive_id AND o.actor_id = s.actor_id AND o.t_ns = s.t_ns
    WHERE s.x_m IS NOT NULL
    GROUP BY ALL
),
-- a vehicle that stands in the middle of a lane and along it, as in a queue, vouches as well; a parked one elsewhere says nothing
other AS (
    SELECT
        drive_id, actor_id,
        count(b) >= 0.8 * count(*) AND count(*) FILTER (b.with_direction) >= 0.9 * count(b) AND coalesce(quantile_disc(b.off_m, 0.5) <= 1.2, false) AS fits
    FROM driven
    WHERE speed_mps > 1 OR b.off_m <= 1.2 AND b.along
    GROUP BY ALL
    HAVING max(t_ns) - min(t_ns) >= 3_000_000_000
),
vouching AS (
    SELECT j.drive_id, j.ego_id, count(*) FILTER (o.fits) AS n_fit, count(*) AS n
    FROM judged j
    JOIN other o ON o.drive_id = j.drive_id AND o.actor_id <> j.ego_id
    WHERE j.against
    GROUP BY ALL
    HAVING n_fit > 0 AND n_fit >= 0.75 * n
),
-- step by step, whether the ego is well in its lane, and whether it is anywhere else; the way that its road runs, in twelfths of a half turn
looked AS (
    SELECT
        st.drive_id, st.ego_id, st.t_ns, st.k, st.seg, s.speed_mps, st.dt_ns, floor((s.yaw_rad - pi() * floor(s.yaw_rad / pi())) / (pi() / 12))::INTEGER % 12 AS way,
        CASE WHEN e.with_direction AND s.speed_mps > 1 AND x.t_ns IS NULL THEN e.off_m END AS well_m,
        x.t_ns IS NULL AND (e.lanelet_id IS NULL OR e.off_m > 1.2 OR NOT e.with_direction) AS elsewhere
    FROM step st
    SEMI JOIN judged j ON j.drive_id = st.drive_id AND j.ego_id = st.ego_id AND NOT j.no_map AND j.trouble IS NOT NULL
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    LEFT JOIN placed e ON e.drive_id = st.drive_id AND e.ego_id = st.ego_id AND e.t_ns = st.t_ns
    LEFT JOIN away x ON x.drive_id = st.drive_id AND x.ego_id = st.ego_id AND x.t_ns = st.t_ns
),
-- for long, or closely for some time: neither is a lane change
kept AS (
    SELECT drive_id, ego_id, min(t_ns) AS t_from_ns, max(t_ns) AS t_to_ns, list_distinct(list(way)) AS ways
    FROM (
        SELECT l.*, v.least_s, v.least_m, l.k - row_number() OVER (PARTITION BY l.drive_id, l.ego_id, l.seg, v.within_m ORDER BY l.k) AS run, v.within_m
        FROM looked l
        JOIN (VALUES (0.6, 5, 50), (0.3, 2, 20)) AS v(within_m, least_s, least_m) ON l.well_m <= v.within_m
    )
    GROUP BY drive_id, ego_id, seg, run, within_m, least_s, least_m
    HAVING max(t_ns) - min(t_ns) >= least_s * 1e9 AND sum(speed_mps * dt_ns) >= least_m * 1e9
),
kept_to AS (
    SELECT drive_id, ego_id, min(t_to_ns) AS t_before_ns, max(t_from_ns) AS t_after_ns, list_distinct(flatten(list(ways))) AS ways FROM kept GROUP BY ALL
),
-- a map that lies beside the road fits along it as well: only where the ego kept to two roads that cross is its place known both ways
own AS (
    SELECT l.drive_id, l.ego_id
    FROM looked l
    JOIN kept_to w USING (drive_id, ego_id)
    WHERE l.elsewhere
    GROUP BY l.drive_id, l.ego_id, w.t_before_ns, w.t_after_ns, w.ways
    HAVING min(l.t_ns) > w.t_before_ns AND max(l.t_ns) < w.t_after_ns AND (
        list_bool_or(list_transform(w.ways, a -> list_bool_or(list_transform(w.ways, b -> (a - b + 12) % 12 BETWEEN 3 AND 9))))
        OR count(*) FILTER (list_has_any(w.ways, [l.way, (l.way + 1) % 12, (l.way + 11) % 12])) >= 0.9 * count(*)
    )
)
SELECT
    j.drive_id, j.ego_id, n_steps, n_on_lane, n_moving, n_with_direction, lateral_median_m, trouble IS NULL OR v.n_fit IS NOT NULL OR w.ego_id IS NOT NULL AS ok,
    CASE WHEN v.n_fit IS NOT NULL THEN trouble || ' No: ' || v.n_fit || ' of ' || v.n || ' other vehicles drive in its lanes and with them'
        WHEN trouble IS NOT NULL AND w.ego_id IS NOT NULL THEN trouble || ' No: before and after that it keeps to the middle of its lane'
        ELSE coalesce(trouble, 'on a lane in ' || n_on_lane || ' of ' || n_steps || ' steps, with the traffic in ' || n_with_direction || ' of ' || n_moving || ' moving ones')
    END AS reason
FROM judged j
LEFT JOIN vouching v USING (drive_id, ego_id)
LEFT JOIN own w USING (drive_id, ego_id)
