-- title = "Emergency corridor kept open"
-- breach = "Emergency corridor blocked"
-- clause = "StVO 11(2) (R_I4 of Maierhofer et al. 2020): in slow traffic on two or more lanes leave a way free between the leftmost lane and the others"
-- hypothesis = "At every step in slow traffic, did the ego keep to the outer border of its lane?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "minor"
-- legal = "must"
-- status = "draft"
-- law = ["de"]
-- sense = "<="
-- unit = "m"
-- observes = "distance to the border to keep to"
-- merge_gap_s = 10.0
-- reads = ["data_log", "ego_lane", "ego_state", "lanelet", "lead"]
-- requires = ["map", "registration", "ego_size", "handedness"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.slow_mps]
-- default = 2.78
-- unit = "m/s"
-- why = "10 km/h: congestion"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.border_m]
-- default = 0.75
-- unit = "m"
-- why = "our default: an ego this close to the border keeps to it; this number is a judgement, so the rule is a draft"

-- @condition
SELECT e.drive_id, e.ego_id, e.t_ns, $border_m AS required,
    -- The outer border is the left one in the leftmost lane, and the right one in every other lane. Left-hand traffic, where this is
    -- mirrored, is not supported.
    o.half_width_m - e.lat_half_m - CASE WHEN n.left_id IS NULL OR n.left_against THEN o.d_m ELSE -o.d_m END AS observed,
    e.speed_mps <= $slow_mps AND l.speed_mps <= $slow_mps AND l.object_id IS NOT NULL
        AND CASE WHEN n.lanelet_id IS NOT NULL THEN n.left_id IS NOT NULL AND NOT n.left_against OR n.right_id IS NOT NULL AND NOT n.right_against END AS applies
FROM ego_state e
JOIN data_log g ON g.drive_id = e.drive_id
LEFT JOIN ego_lane o ON o.drive_id = e.drive_id AND o.ego_id = e.ego_id AND o.t_ns = e.t_ns
LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
LEFT JOIN lead l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.t_ns = e.t_ns
