-- title = "Changing lanes forces nobody to brake"
-- breach = "Changed lane and forced somebody to brake"
-- clause = "UKHC R133: change lanes only if it does not force another road user to change course or speed"
-- hypothesis = "In the seconds after a lane change began, did the vehicle behind in the new lane not have to brake hard?"
-- kind = "postcondition"
-- subtype = "temporal"
-- window_s = "window_s"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "draft"
-- sense = "<="
-- unit = "m/s2"
-- observes = "deceleration of the vehicle behind in the new lane"
-- near_margin = 0.5
-- reads = ["lane_change"]
-- requires = ["map", "registration", "ego_size"]
--
-- [params.window_s]
-- default = 4.0
-- unit = "s"
-- why = "our default: time for a driver's reaction and the braking that it leads to; lane_change looks at the follower for the same time"
--
-- [params.decel_mps2]
-- default = 2.0
-- unit = "m/s2"
-- why = "our default: more than letting off the accelerator or braking in comfort"
--
-- # Draft: why the follower braked is a judgement. The rule applies only where the follower was too near to stop before it reached the
-- # place of the ego.
--
-- [reasons.lane_change_begin_unseen]
-- says = "the log does not show the beginning of the lane change"
-- advice = "record the ego from before it"
--
-- [reasons.follower_unknown]
-- says = "the follower in the new lane is not known, because an actor nearby cannot be placed"
-- advice = "record every actor there, from before the lane change"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, follower_id AS object_id, occurrence
FROM lane_change
WHERE follower_id IS NOT NULL OR NOT known OR NOT begin_seen

-- @condition
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, s.object_id, $decel_mps2 AS required,
    CASE WHEN c.begin_seen AND (c.known OR c.follower_decel_mps2 > $decel_mps2) THEN c.follower_decel_mps2 END AS observed,
    CASE WHEN NOT c.begin_seen THEN why('lane_change_begin_unseen')
        WHEN c.follower_id IS NULL THEN why('follower_unknown') END AS reason,
    c.follower_gap_m <= stopping_distance_m(c.follower_speed_mps) OR NOT c.known AND NULL AS applies
FROM reference_step s
JOIN reference r USING (ref_id)
JOIN lane_change c ON c.drive_id = r.drive_id AND c.ego_id = r.ego_id AND c.occurrence = r.occurrence
