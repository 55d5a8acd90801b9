-- title = "Joining without forcing the traffic on the main carriageway"
-- breach = "Forced the traffic on the main carriageway when joining"
-- clause = "UKHC R259: give priority to traffic already on the motorway, match your speed to a safe gap"
-- hypothesis = "When the ego moved from a slip road onto the main carriageway, was the vehicle behind there far enough away, and did it not have to brake hard?"
-- kind = "execution"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- reads = ["lane_change"]
-- requires = ["map", "registration", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.pet_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: the two seconds of R126, from the ego's rear to the follower's front where the paths meet"
--
-- [params.decel_mps2]
-- default = 2.0
-- unit = "m/s2"
-- why = "our default: more than letting off the accelerator or braking in comfort"
--
-- # Draft: in dense traffic merging into less than two seconds is common, and whether it was forced is a judgement.
--
-- [reasons.gap_behind]
-- says = "the vehicle behind was {gap_m:.1f} m away at {speed_mps:.1f} m/s, and then braked at {decel_mps2:.1f} m/s2"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, follower_id AS object_id, occurrence
FROM lane_change

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, c.merge AS applies,
    CASE
        WHEN c.follower_id IS NULL THEN CASE WHEN c.known AND c.begin_seen THEN true END
        -- A nearer vehicle that was not placed could only make the gap smaller.
        ELSE c.follower_gap_m >= $pet_s * c.follower_speed_mps AND c.follower_decel_mps2 <= $decel_mps2 AND CASE WHEN c.known AND c.begin_seen THEN true END
    END AS holds,
    CASE WHEN c.follower_gap_m IS NOT NULL AND c.follower_speed_mps IS NOT NULL AND c.follower_decel_mps2 IS NOT NULL
        THEN why('gap_behind', {'gap_m': c.follower_gap_m, 'speed_mps': c.follower_speed_mps, 'decel_mps2': c.follower_decel_mps2}) END AS reason
FROM reference r
JOIN lane_change c USING (drive_id, ego_id, occurrence)
