-- Whether the trace fits the map, checked before any rule judges the ego. The map fits if three conditions hold. First, the ego is on a
-- lane (or on a shoulder, where some drives mostly are) in at least 80 % of the steps. Second, it drives in the lane's direction in at
-- least 60 % of the moving steps (on a lane for both directions, either way). Steps of an overtake in the opposing lane are left out,
-- because a short drive may contain little else. Third, its median distance from the centre line is at most 1.2 m (half a lane), outside
-- such an overtake if enough steps lie outside. This condition is needed because with a map that is shifted by one lane, 100 % of the steps
-- are still on a lane.
--
-- The map also fits if at least three quarters of the other vehicles drive with their lanes, and the ego was against its own lane for
-- longer than an overtake takes: then the ego is on the wrong side. A one-way road has no overtaking in the opposing lane: there the ego is
-- on the wrong way if the map states the driving side and no other vehicle contradicts the map.
--
-- The ego may be off the lanes or far from their middle for a while. The map still fits if the ego keeps to the middle of a lane before and
-- after that time, on a road of the same direction or on two roads that cross: a log is never shifted against its map for a while only.
-- lifetime: run
CREATE TABLE registration (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    n_steps BIGINT NOT NULL,          -- number of ego steps with a position
    n_on_lane BIGINT NOT NULL,        -- steps with the centre on a drivable lane, or on a shoulder, lay-by, border, parking, restricted or cycle lane
    n_moving BIGINT NOT NULL,         -- steps on a lane, with a heading, faster than 1 m/s, and not in an overtake in an opposing lane
    n_with_direction BIGINT NOT NULL, -- steps of n_moving with a heading within 90 degrees of the lane's direction, or on a lane that is driven in both directions
    lateral_median_m DOUBLE,          -- median distance from the centre line of the lane, of the steps faster than 1 m/s (in a log without such steps: of all steps); if enough of them lie outside an overtake in the opposing lane, only of those; NULL: never on a lane
    is_aside BOOLEAN NOT NULL,        -- lateral_median_m is so great, over meaningful steps, that the map may be shifted against the log
    ok BOOLEAN NOT NULL,              -- the map fits well enough for the rules that need it. One of: the ego fits; the ego is against its lane, but three of four other vehicles are with theirs; the ego keeps to the middle of a lane before and after the time elsewhere (within 0.6 m for 5 s and 50 m, or 0.3 m for 2 s and 20 m; on a road of the same direction or on two roads that cross)
    reason VARCHAR NOT NULL           -- why ok is true or false, as JSON from the macro why
);

INSERT INTO registration BY NAME
WITH opposing_step AS (
    SELECT DISTINCT x.drive_id, x.ego_id, st.t_ns
    FROM excursion x
    JOIN step st ON st.drive_id = x.drive_id AND st.ego_id = x.ego_id AND st.t_ns >= x.t0_ns AND st.t_ns <= x.t_end_ns
    WHERE x.over_against
),
-- Lanes with an adjacent lane of the other direction. Any other lane outside a junction is one-way: no vehicle can be on the opposing side.
two_way_lane AS (SELECT DISTINCT environment_id, lanelet_id FROM lane_beside WHERE drivable AND against),
ego_place AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, coalesce(e.lanelet_id, e.aside_id) AS lanelet_id, coalesce(e.with_traffic, e.aside_with_direction) AS with_traffic,
        coalesce(abs(e.d_m), e.aside_off_m) AS off_m
    FROM ego_lane e
),
step_count AS (
    SELECT
        st.drive_id, st.ego_id,
        min(s.actor_class) AS actor_class,
        count(s.x_m) AS n_steps,
        count(e.lanelet_id) AS n_on_lane,
        -- A step without a heading does not show whether the ego drives in the lane's direction.
        count(*) FILTER (e.with_traffic IS NOT NULL AND s.speed_mps > 1 AND x.t_ns IS NULL) AS n_moving,
        count(*) FILTER (e.with_traffic AND s.speed_mps > 1 AND x.t_ns IS NULL) AS n_with_direction,
        sum(st.dt_ns) FILTER (NOT e.with_traffic AND s.speed_mps > 1 AND x.t_ns IS NULL) AS against_ns,
        sum(st.dt_ns) FILTER (NOT e.with_traffic AND s.speed_mps > 1 AND x.t_ns IS NULL AND n.drivable AND n.junction_id IS NULL AND w.lanelet_id IS NULL) AS against_one_way_ns,
        -- A short log may be half an overtake. The steps outside the overtake decide if they last at least 5 s and are at least a third of
        -- the log.
        coalesce(sum(st.dt_ns) FILTER (e.off_m IS NOT NULL AND s.speed_mps > 1 AND x.t_ns IS NULL), 0) >= 5_000_000_000
            AND 3 * count(e.off_m) FILTER (s.speed_mps > 1 AND x.t_ns IS NULL) >= count(s.x_m) AS outside_decides,
        CASE WHEN outside_decides THEN quantile_disc(e.off_m, 0.5) FILTER (s.speed_mps > 1 AND x.t_ns IS NULL)
            -- A standing ego at the kerb gives no evidence about the map.
            ELSE coalesce(quantile_disc(e.off_m, 0.5) FILTER (s.speed_mps > 1), quantile_disc(e.off_m, 0.5)) END AS lateral_median_m,
        -- A log that is only an overtake, or in which the ego stands at the kerb, does not show that its map is shifted.
        coalesce(lateral_median_m > aside_of_lane_m(), false)
            AND (outside_decides OR coalesce(sum(st.dt_ns) FILTER (s.speed_mps > 1) > longest_overtake_ns(), false)) AS is_aside
    FROM step st
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    LEFT JOIN ego_place e ON e.drive_id = st.drive_id AND e.ego_id = st.ego_id AND e.t_ns = st.t_ns
    LEFT JOIN opposing_step x ON x.drive_id = st.drive_id AND x.ego_id = st.ego_id AND x.t_ns = st.t_ns
    LEFT JOIN data_log g ON g.drive_id = st.drive_id
    LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = e.lanelet_id
    LEFT JOIN two_way_lane w ON w.environment_id = g.environment_id AND w.lanelet_id = e.lanelet_id
    GROUP BY ALL
),
map_check AS (
    SELECT
        c.*, g.environment_id IS NULL AS has_no_map,
        CASE
            WHEN g.environment_id IS NULL THEN why('without_map')
            WHEN n_steps = 0 THEN why('ego_never_placed')
            WHEN n_on_lane < 0.8 * n_steps AND NOT may_be_vehicle(actor_class) THEN why('ego_not_a_vehicle', {'actor_class': actor_class, 'n_on_lane': n_on_lane, 'n_steps': n_steps})
            WHEN n_on_lane < 0.8 * n_steps THEN why('seldom_on_lane', {'n_on_lane': n_on_lane, 'n_steps': n_steps})
            WHEN n_with_direction < 0.6 * n_moving THEN why('often_against_lane', {'n_against': n_moving - n_with_direction, 'n_moving': n_moving})
            WHEN lateral_median_m > 1.2 THEN why('far_from_centre_line', {'lateral_m': lateral_median_m})
        END AS trouble,
        -- There is no overtaking in the opposing lane of a one-way road, and a map that states the driving side also states its directions.
        coalesce(n_on_lane >= 0.8 * n_steps AND n_with_direction < 0.6 * n_moving AND lateral_median_m <= 1.2 AND m.handedness_source = 'attribute'
            AND against_one_way_ns > one_way_ns() AND against_one_way_ns >= 0.8 * against_ns, false) AS is_against_one_way,
        -- If the ego is against its lane, the other vehicles decide, unless the log began in the middle of an overtake. If the ego is off
        -- the lanes, the map may lack just its lane.
        n_on_lane >= 0.8 * n_steps AND n_with_direction < 0.6 * n_moving AND against_ns > CASE WHEN is_against_one_way THEN one_way_ns() ELSE longest_overtake_ns() END AS is_against,
        -- If the ego is far from the middle of its lane because the map is shifted sideways, the other vehicles are as well. An ego that
        -- mostly stands may be parked beside its lane.
        n_on_lane >= 0.8 * n_steps AND NOT n_with_direction < 0.6 * n_moving AND lateral_median_m > 1.2 AND 2 * n_moving >= n_steps AS is_far
    FROM step_count c
    JOIN data_log g USING (drive_id)
    LEFT JOIN environment m ON m.environment_id = g.environment_id
),
-- If the ego drives against its lane, or far from its middle, the other vehicles show whether the map or the ego is wrong.
vehicle_place AS (
    SELECT
        s.drive_id, s.actor_id, s.t_ns, s.speed_mps,
        min({'off_m': abs(o.d_m), 'with_traffic': n.bidirectional OR abs(o.heading_diff_rad) < pi() / 2, 'is_along': abs(o.heading_diff_rad) < turned_off_rad()}) FILTER (o.drivable) AS b
    FROM state_dynamics s
    SEMI JOIN map_check j ON j.drive_id = s.drive_id AND NOT j.has_no_map AND (j.is_against OR j.is_far)
    JOIN data_log g ON g.drive_id = s.drive_id
    JOIN road_user a ON a.drive_id = s.drive_id AND a.actor_id = s.actor_id AND is_vehicle(a.actor_class) AND a.actor_class <> 'bicycle'
    LEFT JOIN lane_occupancy o ON o.drive_id = s.drive_id AND o.actor_id = s.actor_id AND o.t_ns = s.t_ns
    LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
    WHERE s.x_m IS NOT NULL
    GROUP BY ALL
),
-- A vehicle that stands in the middle of a lane and along it, as in a queue, is a witness as well. A vehicle parked elsewhere is none.
other_vehicle AS (
    SELECT
        drive_id, actor_id,
        count(b) >= 0.8 * count(*) AND count(*) FILTER (b.with_traffic) >= 0.9 * count(b) AND coalesce(quantile_disc(b.off_m, 0.5) <= 1.2, false) AS is_fitting
    FROM vehicle_place
    WHERE speed_mps > 1 OR b.off_m <= 1.2 AND b.is_along
    GROUP BY ALL
    HAVING max(t_ns) - min(t_ns) >= 3_000_000_000
),
-- One or two vehicles that also drive beside the middle may make a shifted map seem to fit: for a sideways shift, three are needed.
witness_count AS (
    SELECT j.drive_id, j.ego_id, count(*) FILTER (o.is_fitting) AS n_fit, count(*) AS n_witnesses
    FROM map_check j
    JOIN other_vehicle o ON o.drive_id = j.drive_id AND o.actor_id <> j.ego_id
    WHERE j.is_against OR j.is_far
    GROUP BY j.drive_id, j.ego_id, j.is_far
    HAVING n_fit >= CASE WHEN j.is_far THEN 3 ELSE 1 END AND n_fit >= 0.75 * n_witnesses
),
-- Other vehicles that do not keep to their lanes: if there is one, the map may also be wrong about the one-way road.
misfit AS (
    SELECT DISTINCT j.drive_id, j.ego_id
    FROM map_check j
    JOIN other_vehicle o ON o.drive_id = j.drive_id AND o.actor_id <> j.ego_id
    WHERE j.is_against_one_way AND NOT o.is_fitting
),
-- At each step: the ego's distance from the middle of its lane, whether it is elsewhere, and the direction of its road in twelfths of a
-- half turn.
ego_step AS (
    SELECT
        st.drive_id, st.ego_id, st.t_ns, st.k, st.seg, s.speed_mps, st.dt_ns, (floor(s.yaw_rad / (pi() / 12))::INTEGER % 12 + 12) % 12 AS direction_no,
        CASE WHEN e.with_traffic AND s.speed_mps > 1 AND x.t_ns IS NULL THEN e.off_m END AS off_in_lane_m,
        x.t_ns IS NULL AND (e.lanelet_id IS NULL OR e.off_m > 1.2 OR NOT e.with_traffic) AS is_elsewhere
    FROM step st
    SEMI JOIN map_check j ON j.drive_id = st.drive_id AND j.ego_id = st.ego_id AND NOT j.has_no_map AND j.trouble IS NOT NULL
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    LEFT JOIN ego_place e ON e.drive_id = st.drive_id AND e.ego_id = st.ego_id AND e.t_ns = st.t_ns
    LEFT JOIN opposing_step x ON x.drive_id = st.drive_id AND x.ego_id = st.ego_id AND x.t_ns = st.t_ns
),
-- Stretches in which the ego keeps to the middle of its lane for long, or closely for some time. Neither can happen in a lane change.
lane_keeping AS (
    SELECT drive_id, ego_id, min(t_ns) AS t_from_ns, max(t_ns) AS t_to_ns, list_distinct(list(direction_no)) AS direction_nos
    FROM (
        SELECT l.*, v.least_s, v.least_m, l.k - row_number() OVER (PARTITION BY l.drive_id, l.ego_id, l.seg, v.within_m ORDER BY l.k) AS run_no, v.within_m
        FROM ego_step l
        JOIN (VALUES (0.6, 5, 50), (0.3, 2, 20)) AS v(within_m, least_s, least_m) ON l.off_in_lane_m <= v.within_m
    )
    GROUP BY drive_id, ego_id, seg, run_no, within_m, least_s, least_m
    HAVING max(t_ns) - min(t_ns) >= least_s * 1e9 AND sum(speed_mps * dt_ns) >= least_m * 1e9
),
lane_keeping_span AS (
    SELECT drive_id, ego_id, min(t_to_ns) AS t_before_ns, max(t_from_ns) AS t_after_ns, list_distinct(flatten(list(direction_nos))) AS direction_nos FROM lane_keeping GROUP BY ALL
),
-- A map that is shifted along a road still fits on that road. Its position is known in both directions only if the ego drove on two roads
-- that cross. Otherwise, the road where the ego does not fit must have the direction of a road where it did.
fitting_ego AS (
    SELECT l.drive_id, l.ego_id
    FROM ego_step l
    JOIN lane_keeping_span w USING (drive_id, ego_id)
    WHERE l.is_elsewhere
    GROUP BY l.drive_id, l.ego_id, w.t_before_ns, w.t_after_ns, w.direction_nos
    HAVING min(l.t_ns) > w.t_before_ns AND max(l.t_ns) < w.t_after_ns AND (
        list_bool_or(list_transform(w.direction_nos, a -> list_bool_or(list_transform(w.direction_nos, b -> (a - b + 12) % 12 BETWEEN 3 AND 9))))
        OR count(*) FILTER (list_has_any(w.direction_nos, [l.direction_no, (l.direction_no + 1) % 12, (l.direction_no + 11) % 12])) >= 0.9 * count(*)
    )
)
SELECT
    j.drive_id, j.ego_id, n_steps, n_on_lane, n_moving, n_with_direction, lateral_median_m, is_aside, trouble IS NULL OR v.n_fit IS NOT NULL OR w.ego_id IS NOT NULL OR is_against_one_way AND m.ego_id IS NULL AS ok,
    CASE WHEN v.n_fit IS NOT NULL THEN why('others_fit', {'trouble': trouble, 'n_fit': v.n_fit, 'n_witnesses': v.n_witnesses})
        WHEN trouble IS NOT NULL AND w.ego_id IS NOT NULL THEN why('fits_before_and_after', {'trouble': trouble})
        WHEN is_against_one_way AND m.ego_id IS NULL THEN why('against_one_way', {'trouble': trouble})
        ELSE coalesce(trouble, why('on_lane', {'n_on_lane': n_on_lane, 'n_steps': n_steps, 'n_with_direction': n_with_direction, 'n_moving': n_moving}))
    END AS reason
FROM map_check j
LEFT JOIN witness_count v USING (drive_id, ego_id)
LEFT JOIN fitting_ego w USING (drive_id, ego_id)
LEFT JOIN misfit m USING (drive_id, ego_id)
