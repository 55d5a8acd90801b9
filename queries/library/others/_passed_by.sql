-- Vehicles ahead that are in the ego's lane by the map, although the ego's own path, as driven after this step, passes beside them. A lane
-- of a map may be wide, cut a corner, or run where no vehicle drives. The ego does not follow a vehicle that its box does not meet on its
-- path. Two kinds are listed. The first kind stands. The second kind moves, but not towards the path; it is not in front of the ego's box,
-- and one lane has no room for both, so that the two are in different lanes.
--
-- If sensors measured the positions, a vehicle that the path overlaps by less than `measured_meeting_m` is listed as well, as not certain.
--
-- A standing vehicle in the ego's way, round which the ego swerves at the last moment, is not listed at any step. That is: both its lane
-- and its curvature led the ego into that vehicle less than `late_s` before it, and the ego left this course faster than in a lane change.
-- Beyond the end of the recorded path, the ego is assumed to keep its curvature. It then passes only vehicles that it would also pass with
-- another curvature.
-- lifetime: part
CREATE TABLE _passed_by (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- a vehicle ahead that is in the running lane by the map, but that the ego's path passes at a distance of 0.2 m or more. It stands, or the lane is too narrow for both. Vehicles are excluded round which the ego swerves in the last 2 s, or for which it leaves its lane
    is_sure BOOLEAN NOT NULL          -- false: the positions were measured by sensors, and the path overlaps the vehicle by less than their accuracy, or passes it by less than 0.2 m
);

INSERT INTO _passed_by BY NAME
WITH candidate AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, st.seg, p.object_id, p.x_m, p.y_m, p.yaw_rad, p.speed_mps, p.length_m, p.width_m, e.length_m AS ego_length_m, e.width_m AS ego_width_m,
        e.yaw_rad AS ego_yaw_rad, e.speed_mps AS ego_speed_mps, abs(p.d_m - e.d_m) - p.lat_half_m - e.lat_half_m AS across_m,
        (p.x_m - e.x_m) * cos(e.yaw_rad) + (p.y_m - e.y_m) * sin(e.yaw_rad) AS dx, (p.y_m - e.y_m) * cos(e.yaw_rad) - (p.x_m - e.x_m) * sin(e.yaw_rad) AS dy,
        CASE WHEN g.sensor_range_m IS NOT NULL THEN measured_meeting_m() ELSE 0.0 END AS may_meet_m,
        coalesce(p.speed_mps <= standing_mps(), false) OR p.lat_half_m + e.lat_half_m > p.half_width_m AND abs(e.d_m) + e.lat_half_m < p.half_width_m AS has_no_room
    FROM pair p
    JOIN data_log g USING (drive_id)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN step st USING (drive_id, ego_id, t_ns)
    WHERE p.s_m > e.s_m AND p.distance_m < lost_near_m() + 2 * drift_s() * e.speed_mps AND may_be_vehicle(p.actor_class) AND in_lane(p.d_m, p.lat_half_m, p.half_width_m)
        AND CASE WHEN p.speed_mps <= standing_mps() THEN true
            ELSE abs(p.d_m - e.d_m) >= p.lat_half_m + e.lat_half_m - may_meet_m AND (has_no_room OR may_meet_m > 0) END
),
-- occasion: candidate
segment_cell AS (
    SELECT w.*, cell_key(floor((x0_m + x1_m) / 8) + i.i, floor((y0_m + y1_m) / 8) + j.j) AS cell
    FROM _own_way w
    SEMI JOIN candidate c ON c.drive_id = w.drive_id AND c.ego_id = w.ego_id
    CROSS JOIN (VALUES (-2), (-1), (0), (1), (2)) AS i(i) CROSS JOIN (VALUES (-2), (-1), (0), (1), (2)) AS j(j)
),
-- The first point of the ego's path that is level with the vehicle.
way_place AS (
    SELECT
        drive_id, ego_id, t_ns, object_id,
        min({'t_ns': t_from_ns, 'on_m': s0_m + len_m - driven_m, 'd_m': d_m, 'heading_rad': atan2(ty0 + u * (ty1 - ty0), tx0 + u * (tx1 - tx0)), 'bend_per_m': bend_per_m}) AS there
    FROM (
        SELECT *, a0 / (a0 + a1) AS u, offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1) AS d_m
        FROM (
            SELECT
                c.drive_id, c.ego_id, c.t_ns, c.object_id, c.x_m, c.y_m, s.* EXCLUDE (drive_id, ego_id, seg, cell),
                along0(c.x_m, c.y_m, s.x0_m, s.y0_m, s.tx0, s.ty0) AS a0, along1(c.x_m, c.y_m, s.x1_m, s.y1_m, s.tx1, s.ty1) AS a1
            FROM candidate c
            JOIN segment_cell s ON s.drive_id = c.drive_id AND s.ego_id = c.ego_id AND s.seg = c.seg AND s.cell = corridor_cell_of(c.x_m, c.y_m)
            WHERE (s.t_from_ns > c.t_ns OR s.t_from_ns IS NULL) AND along0(c.x_m, c.y_m, s.x0_m, s.y0_m, s.tx0, s.ty0) >= 0 AND along1(c.x_m, c.y_m, s.x1_m, s.y1_m, s.tx1, s.ty1) > 0
        )
    )
    GROUP BY drive_id, ego_id, t_ns, object_id
),
-- The curvature of the path at the ego's position. (A window instead of an ASOF join: for few rows, DuckDB would compare all rows with
-- all.)
bend_at_step AS (
    SELECT drive_id, ego_id, t_ns, bend_per_m
    FROM (
        SELECT * REPLACE (last_value(bend_per_m IGNORE NULLS) OVER (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns, is_step ROWS UNBOUNDED PRECEDING) AS bend_per_m)
        FROM (
            SELECT drive_id, ego_id, seg, t_from_ns AS t_ns, bend_per_m, false AS is_step FROM _own_way WHERE t_from_ns IS NOT NULL
            UNION ALL
            SELECT drive_id, ego_id, seg, t_ns, NULL, true FROM step
        )
    )
    WHERE is_step AND bend_per_m IS NOT NULL
),
-- The greatest lateral acceleration of the ego in the next two seconds.
across_soon AS (
    SELECT drive_id, ego_id, t_ns, max(abs(lat_accel_mps2)) OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns RANGE BETWEEN CURRENT ROW AND 2_000_000_000 FOLLOWING) AS most_mps2
    FROM ego_motion
),
beside_way AS (
    SELECT
        c.drive_id, c.ego_id, c.t_ns, c.object_id, w.there.t_ns AS t_there_ns, a.apart_m >= a.least_m AND c.has_no_room AS is_sure,
        c.across_m < 0 AND (c.dx - (c.length_m + c.ego_length_m) / 2) / nullif(c.ego_speed_mps, 0) BETWEEN steering_s() AND late_s()
            AND (m.most_mps2 >= swerves_from_mps2() OR 2 * abs(w.there.d_m - arc_offset_m(c.dx, c.dy, s.bend_per_m)) >= changes_lane_mps2() * (c.dx / nullif(c.ego_speed_mps, 0)) ** 2)
            AND abs(arc_offset_m(c.dx, c.dy, s.bend_per_m)) < c.ego_width_m / 2 + box_half_across_m(c.length_m, c.width_m, c.yaw_rad - c.ego_yaw_rad - s.bend_per_m * c.dx) AS is_course_held
    FROM candidate c
    JOIN way_place w USING (drive_id, ego_id, t_ns, object_id)
    JOIN bend_at_step s ON s.drive_id = c.drive_id AND s.ego_id = c.ego_id AND s.t_ns = c.t_ns
    LEFT JOIN across_soon m ON m.drive_id = c.drive_id AND m.ego_id = c.ego_id AND m.t_ns = c.t_ns
    CROSS JOIN LATERAL (
        SELECT abs(w.there.d_m) - box_half_across_m(c.length_m, c.width_m, c.yaw_rad - w.there.heading_rad) - swept_in_bend_half_m(c.ego_length_m, c.ego_width_m, w.there.bend_per_m) AS apart_m,
            -- A vehicle that moves towards the path may soon be in it.
            passes_beside_m() + bends_otherwise_m(w.there.on_m, c.ego_speed_mps) + CASE WHEN c.speed_mps > standing_mps() THEN drift_s() * greatest(0.0, -sign(w.there.d_m) * c.speed_mps * sin(c.yaw_rad - w.there.heading_rad)) ELSE 0.0 END AS least_m
    ) a
    WHERE a.apart_m >= a.least_m AND c.has_no_room OR c.may_meet_m > 0 AND a.apart_m BETWEEN -c.may_meet_m AND passes_beside_m()
)
SELECT b.drive_id, b.ego_id, b.t_ns, b.object_id, b.is_sure
FROM beside_way b
ANTI JOIN (FROM beside_way WHERE is_course_held AND is_sure) h ON h.drive_id = b.drive_id AND h.ego_id = b.ego_id AND h.object_id = b.object_id
-- The ego also does not pass by a vehicle that it overtakes on the side of the oncoming traffic: until it pulls out, it is behind that
-- vehicle.
ANTI JOIN (FROM excursion WHERE overtaking AND begin_seen AND over_against AND max_out_m >= surely_out_m()) x
    ON x.drive_id = b.drive_id AND x.ego_id = b.ego_id AND x.t0_ns <= coalesce(b.t_there_ns, 9223372036854775807) AND x.t_end_ns >= b.t_ns
