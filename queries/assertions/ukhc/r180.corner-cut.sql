-- title = "Do not cut the corner"
-- breach = "Cut the corner"
-- clause = "UKHC R180: do not cut the corner when turning right"
-- hypothesis = "When the ego had turned across the oncoming traffic, was it wholly on its own side of the road that it entered?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "m"
-- observes = "reach over the middle of the road entered"
-- reads = ["ego_corridor", "ego_state", "junction_passage"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way out of the junction: record it until it has left"
--
-- [params.tolerance_m]
-- default = 0.3
-- unit = "m"
-- why = "our default: a wheel on the line is not yet the other side of the road"

-- @reference
SELECT drive_id, ego_id, t_out_ns AS t_ns, occurrence, turn, across
FROM junction_passage
WHERE across IS DISTINCT FROM false AND turn IS DISTINCT FROM 'u_turn'

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, $tolerance_m AS required,
    CASE c.side WHEN 1 THEN c.left_out_m WHEN -1 THEN c.right_out_m END AS observed,
    CASE WHEN r.across IS NULL THEN NULL WHEN c.over_width_m IS NULL THEN false ELSE c.over_against END AS applies,
    CASE WHEN r.across IS NULL THEN across_doubt(r.turn) END AS reason
FROM reference r
JOIN ego_state e USING (drive_id, ego_id, t_ns)
JOIN ego_corridor c USING (drive_id, ego_id, chain_id, t_ns)
