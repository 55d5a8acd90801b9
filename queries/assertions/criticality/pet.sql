-- title = "Sufficient post-encroachment time (PET)"
-- breach = "Too little post-encroachment time (PET)"
-- clause = "Allen, Shin, Cooper 1978: the time between one road user leaving the ground of a conflict and the other coming onto it"
-- hypothesis = "Where the ways of the ego and of another road user crossed at 45 degrees or more, and did not become one way, was there at least 1.5 s between the two?"
-- kind = "execution"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "post-encroachment time"
-- near_margin = 0.5
-- reads = ["conflict", "ego_state", "lost_object", "pair", "state_dynamics"]
-- requires = ["ego_size"]
--
-- [params.least_s]
-- default = 1.5
-- unit = "s"
-- why = "below it a conflict counts as serious"
-- source = "Archer 2005 (not seen)"
--
-- [params.crossing_rad]
-- default = 0.7854
-- unit = "rad"
-- why = "our default: 45 degrees; paths that meet at less merge or divide, as in a lane change, where the headway of the follower and the time to collision measure how close it was"
--
-- [reasons.pet_at_most]
-- says = "Not decided: at most {pet_s:.1f} s were between the two, but one of them was not recorded all the time."

-- @reference
SELECT drive_id, ego_id, t_ego_in_ns AS t_ns, object_id, occurrence, NULL AS code FROM conflict
UNION ALL
-- An actor may have crossed the ego's way unseen if its track ends close by, if it is not placed for a while, or if it moves and has no
-- heading or size.
SELECT drive_id, ego_id, t_from_ns, object_id, NULL, code FROM lost_object WHERE code = 'lost_near_ego'
UNION ALL
SELECT drive_id, ego_id, min(t_ns), object_id, NULL, NULL
FROM pair
WHERE x_m IS NULL OR y_m IS NULL OR (yaw_rad IS NULL OR length_m IS NULL OR width_m IS NULL) AND (speed_mps > standing_mps()) IS DISTINCT FROM false
GROUP BY drive_id, ego_id, object_id
UNION ALL
SELECT drive_id, ego_id, min(t_ns), NULL, NULL, NULL FROM ego_state WHERE x_m IS NULL OR y_m IS NULL OR yaw_rad IS NULL GROUP BY drive_id, ego_id

-- @condition
SELECT
    r.drive_id, r.ego_id, r.t_ns, r.ref_id, $least_s AS required, r.code AS reason_code, r.occurrence IS NULL OR abs(c.angle_rad) >= $crossing_rad AND NOT coalesce(abs(wrap_rad(e.yaw_rad - o.yaw_rad)) < $crossing_rad, false) AS applies,
    -- An upper bound of the time can show that there was too little time, but not that there was enough.
    CASE WHEN c.pet_s < $least_s OR NOT c.pet_at_most THEN c.pet_s END AS observed,
    CASE WHEN c.pet_s >= $least_s AND c.pet_at_most THEN why('pet_at_most', {'pet_s': c.pet_s}) END AS reason
FROM reference r
LEFT JOIN conflict c USING (drive_id, ego_id, occurrence)
-- Two actors that leave the ground in one direction have merged: one follows the other.
LEFT JOIN ego_state e ON e.drive_id = c.drive_id AND e.ego_id = c.ego_id AND e.t_ns = c.t_ego_out_ns
LEFT JOIN state_dynamics o ON o.drive_id = c.drive_id AND o.actor_id = c.object_id AND o.t_ns = c.t_object_out_ns
