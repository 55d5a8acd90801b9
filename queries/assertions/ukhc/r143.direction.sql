-- title = "With the direction of the lane"
-- clause = "UKHC R143, R160 and R263: you must travel in the direction of a one-way road; on a motorway you must not reverse or drive against the traffic; on other roads you should keep to your side"
-- hypothesis = "At every step outside an overtake, did the ego drive forwards and with the direction of its lane?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- merge_gap_s = 5.0
-- reads = ["data_log", "ego_motion", "ego_state", "excursion", "lanelet", "line_step", "overtake_step", "step"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [params.reverse_mps]
-- default = 0.1
-- unit = "m/s"
-- why = "our default: slower is standing with noise"
--
-- [params.manoeuvring_mps]
-- default = 4.47
-- unit = "m/s"
-- why = "our default: at 10 mph and less vehicles turn round, park and reverse, which R200 to R203 allow with care; on a motorway nothing excuses it"
--
-- [params.passing_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time in the opposing lane to get past something that the log does not show, such as road works"

-- @applies
-- not in junctions, where lanes of all directions overlap, and not off every lane, as in a car park
WITH passing_by AS (
    SELECT drive_id, ego_id, t_ns FROM overtake_step
    UNION
    SELECT drive_id, ego_id, t_ns FROM line_step WHERE passing_id IS NOT NULL
    UNION
    SELECT s.drive_id, s.ego_id, s.t_ns
    FROM excursion x
    JOIN step s ON s.drive_id = x.drive_id AND s.ego_id = x.ego_id AND s.t_ns >= x.t0_ns AND s.t_ns <= x.t_end_ns
        AND s.t_ns < x.t0_ns + ($passing_s * 1e9)::BIGINT
)
SELECT e.drive_id, e.ego_id, e.t_ns,
    (p.t_ns IS NULL OR e.with_direction) AND NOT (e.x_m IS NOT NULL AND e.lanelet_id IS NULL) AND NOT e.in_junction
        AND (abs(m.v_long_mps) > $manoeuvring_mps OR coalesce(e.road_type, '') = 'motorway') AS applies
FROM ego_state e
LEFT JOIN ego_motion m USING (drive_id, ego_id, t_ns)
LEFT JOIN passing_by p USING (drive_id, ego_id, t_ns)

-- @condition
SELECT e.drive_id, e.ego_id, e.t_ns, (n.bidirectional OR e.with_direction) AND m.v_long_mps >= -$reverse_mps AS holds,
    format('{:.1f} m/s along its own heading, {} lane {}', m.v_long_mps, CASE WHEN n.bidirectional OR e.with_direction THEN 'with' ELSE 'against' END, e.lanelet_id) AS reason
FROM ego_state e
JOIN data_log g USING (drive_id)
LEFT JOIN ego_motion m USING (drive_id, ego_id, t_ns)
LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = e.lanelet_id
