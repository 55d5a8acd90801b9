-- title = "Safe distance to the vehicle behind when changing lane"
-- breach = "Changed lane too close to the vehicle behind"
-- clause = "StVO 7(5), 5(4) (R_G6 of Maierhofer et al. 2020): change lane only if nobody behind is put in danger"
-- hypothesis = "When the ego began to change lane, was the vehicle behind in the new lane at its safe distance from the ego?"
-- kind = "execution"
-- derivation = "model"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = ">="
-- unit = "m"
-- observes = "gap of the vehicle behind in the new lane"
-- near_margin = 1.0
-- reads = ["lane_change"]
-- requires = ["map", "registration", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.reaction_s]
-- default = 0.3
-- unit = "s"
-- why = "time before the follower brakes"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.brake_mps2]
-- default = 10.0
-- unit = "m/s2"
-- why = "hardest deceleration of the follower"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.brake_lead_mps2]
-- default = 10.5
-- unit = "m/s2"
-- why = "hardest deceleration of the vehicle ahead"
-- source = "Maierhofer et al. 2020, Table II"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, follower_id AS object_id, follower_gap_m, follower_gap_before_m, follower_speed_mps, ego_speed_mps, begin_seen, known,
    -- clear: every vehicle is placed, or every unseen one is so far away that it keeps its safe distance even at unknown_speed_mps.
    known OR unseen_m >= stvo_safe_gap_m(unknown_speed_mps(), ego_speed_mps, $reaction_s, $brake_mps2, $brake_lead_mps2) AS clear
FROM lane_change

-- @condition
-- The ego comes over the line between t_start and the step before it: if the gap was too small then, it may have been at the line, too.
SELECT drive_id, ego_id, t_ns, ref_id, object_id, safe_m AS required,
    -- A vehicle that could not be placed may be nearer: then only a violation is certain. If the ego came over the line in a hole of the log, it
    -- is not known who was behind it then.
    CASE WHEN begin_seen AND (clear AND coalesce(follower_gap_before_m >= safe_m, true) OR follower_gap_m < safe_m) THEN follower_gap_m END AS observed,
    CASE WHEN object_id IS NOT NULL THEN true WHEN clear AND begin_seen THEN false END AS applies
FROM (SELECT *, stvo_safe_gap_m(follower_speed_mps, ego_speed_mps, $reaction_s, $brake_mps2, $brake_lead_mps2) AS safe_m FROM reference)
