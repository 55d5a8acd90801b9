-- title = "Close to the edge when turning to the near side"
-- breach = "Far from the edge when turning to the near side"
-- clause = "UKHC R183: when turning left keep as close to the left as is safe and practicable"
-- hypothesis = "When the ego had turned to the near side, was there little room between it and the near edge of the lane that it entered?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "m"
-- observes = "room to the near edge of the lane entered"
-- reads = ["data_log", "ego_corridor", "ego_state", "junction_passage", "lane_beside", "pair"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way out of the junction: record it until it has left"
--
-- [params.near_m]
-- default = 1.5
-- unit = "m"
-- why = "our default: a car in the middle of a lane of 3.5 m leaves 0.9 m; no other vehicle can drive in less than this"
--
-- [params.passing_m]
-- default = 30.0
-- unit = "m"
-- why = "our default: an actor at the near edge, up to this far ahead or beside the ego, may have to be passed with room"
--
-- [reasons.near_side_taken]
-- says = "an actor is, or may be, on the near side, or the near side has another lane of the ego's direction; either keeps the ego away from the edge"
-- advice = "no better recording can decide this"

-- @reference
SELECT drive_id, ego_id, t_out_ns AS t_ns, occurrence, turn, across
FROM junction_passage
WHERE across IS DISTINCT FROM true AND turn IS DISTINCT FROM 'straight'

-- @condition
WITH placed_ego AS (
    SELECT r.ref_id, r.turn, r.across, e.*, c.half_width_m, c.side, CASE c.side WHEN 1 THEN -c.right_out_m WHEN -1 THEN -c.left_out_m END AS room_m
    FROM reference r
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN ego_corridor c USING (drive_id, ego_id, chain_id, t_ns)
),
-- The near side is taken if an actor stands or rides there, or may do so, or if it has another lane of the ego's direction, into which
-- others turn.
taken_near_side AS (
    SELECT DISTINCT ego.ref_id
    FROM placed_ego ego
    JOIN pair p USING (drive_id, ego_id, t_ns)
    WHERE p.x_m IS NULL OR p.front_s_m IS NOT NULL AND -ego.side * (p.d_m - ego.d_m) > 0 AND abs(p.d_m) - p.lat_half_m < p.half_width_m + 0.5
        AND p.front_s_m >= ego.rear_s_m AND p.rear_s_m <= ego.front_s_m + $passing_m
    UNION
    SELECT ego.ref_id
    FROM placed_ego ego
    JOIN data_log g USING (drive_id)
    JOIN lane_beside b ON b.environment_id = g.environment_id AND b.lanelet_id = ego.lanelet_id AND b.drivable AND NOT b.against
        AND b.side = CASE ego.side WHEN 1 THEN 'right' ELSE 'left' END
)
SELECT ego.drive_id, ego.ego_id, ego.t_ns, ego.ref_id, $near_m AS required,
    CASE WHEN ego.room_m <= $near_m OR n.ref_id IS NULL THEN ego.room_m END AS observed,
    CASE WHEN ego.across IS NOT NULL THEN true END AS applies,
    CASE WHEN ego.across IS NULL THEN across_doubt(ego.turn)
        WHEN ego.room_m > $near_m AND n.ref_id IS NOT NULL THEN why('near_side_taken') END AS reason
FROM placed_ego ego
LEFT JOIN taken_near_side n USING (ref_id)
