-- title = "Distance restored after a cut-in"
-- breach = "Distance not restored after a cut-in"
-- clause = "UN R157 5.2.3.3: where a vehicle that cuts in leaves less than the distance of the table, restore it at the next opportunity"
-- hypothesis = "After a vehicle cut in, was the following distance restored in time, or had that vehicle gone?"
-- kind = "postcondition"
-- subtype = "temporal"
-- window_s = "window_s"
-- quantifier = "eventually"
-- derivation = "model"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = ">="
-- unit = "m"
-- observes = "gap to the vehicle that cut in"
-- reads = ["cut_in", "ego_state", "lead", "pair", "vehicle_ahead"]
-- requires = ["mode_engaged", "map", "registration", "ego_size"]
--
-- [params.window_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time to restore the distance without harsh braking"
--
-- [params.v_max_mps]
-- default = 16.67
-- unit = "m/s"
-- why = "60 km/h, the end of the table: beyond it the law of the country applies"
-- source = "UN R157 5.2.3.3"

-- @reference
SELECT drive_id, ego_id, t_ns, object_id, gap_m
FROM cut_in

-- @condition
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, s.object_id, e.speed_mps <= $v_max_mps AS applies, r157_gap_m(e.speed_mps) AS required,
    CASE
        WHEN r.object_id IS NULL THEN NULL
        WHEN s.t_ns = r.t_ns THEN r.gap_m
        -- After the two boxes have touched, it is not known whether the distance was restored or the vehicle has gone.
        WHEN bool_or(coalesce(p.clearance_m <= 0, false)) OVER (PARTITION BY s.ref_id ORDER BY s.t_ns) THEN NULL
        WHEN l.t_ns IS NULL THEN NULL
        WHEN l.object_id = s.object_id THEN l.gap_m
        WHEN v.object_id IS NOT NULL THEN v.gap_m
        -- The vehicle hesitates at the line: a part of it is still in the lane, and no other vehicle is nearer.
        WHEN in_lane(p.d_m, p.lat_half_m, p.half_width_m) AND p.front_s_m > e.front_s_m AND (l.object_id IS NULL OR p.rear_s_m - e.front_s_m < l.gap_m)
            THEN p.rear_s_m - e.front_s_m
        -- Another vehicle is ahead, or none: the vehicle that cut in has gone again.
        ELSE 'inf'::DOUBLE
    END AS observed
FROM reference_step s
JOIN reference r USING (ref_id)
JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
LEFT JOIN lead l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.t_ns = s.t_ns
LEFT JOIN vehicle_ahead v ON v.drive_id = s.drive_id AND v.ego_id = s.ego_id AND v.t_ns = s.t_ns AND v.object_id = s.object_id
LEFT JOIN pair p ON p.drive_id = s.drive_id AND p.ego_id = s.ego_id AND p.t_ns = s.t_ns AND p.object_id = s.object_id
