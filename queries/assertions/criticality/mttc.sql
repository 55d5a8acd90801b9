-- title = "Modified time to collision"
-- clause = "Ozbay, Yang, Bartin, Mudigonda 2008: the time until ego and leading vehicle would collide at their present accelerations"
-- hypothesis = "At every step behind a vehicle in its lane, or in the way of one that comes towards it, was the ego at least 1.5 s from hitting it if both went on as they were?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "modified time to collision"
-- near_margin = 0.5
-- merge_gap_s = 1.0
-- reads = ["clock", "ego_motion", "ego_state", "pair", "step", "vehicle_ahead"]
-- requires = ["map", "registration", "ego_size", "speeds"]
--
-- [params.least_s]
-- default = 1.5
-- unit = "s"
-- why = "our default: the same as for the time to collision"
--
-- [params.edge_s]
-- default = 0.5
-- unit = "s"
-- why = "our default: so near to the ends of the log the windows of the accelerations are not whole"

-- @applies
-- A vehicle beside the ego's way that does not close in yet: only its heading of that step puts it into the way, and one heading is no proof.
-- a step without a row in `vehicle_ahead` is one at which nobody knows who leads
SELECT s.drive_id, s.ego_id, s.t_ns, l.object_id,
    CASE WHEN l.object_id IS NOT NULL THEN on_course(
        -- at the present speeds across they are moved on to when the gap is gone at the present accelerations
        l.gap_m, coalesce(mttc_s(l.gap_m, l.ego_speed_mps, m.accel_mps2, k.away_mps, k.other_mps2), k.ttc_s),
        e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, p.speed_mps * sin(p.heading_diff_rad)
    ) AND may_touch(l.passes_by, l.grazes) AND CASE WHEN l.across_m < 0 OR k.ttc_s < 'inf' THEN true END AND either_moves(l.ego_speed_mps, l.speed_mps)
    -- one that is not seen is further away than the way that is free, and the two close in no faster than tyres allow
    WHEN l.known OR gone_s(l.free_m, l.free_mps, 10.0) >= $least_s THEN true END AS applies,
    CASE WHEN l.grazes THEN graze_words(l.object_id)
        WHEN l.across_m >= 0 AND k.ttc_s = 'inf' THEN format('{} is beside the ego''s way and does not close in, but its heading at this step points into the way: record headings more exactly', l.object_id) END AS reason
FROM step s
LEFT JOIN vehicle_ahead l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.t_ns = l.t_ns AND p.object_id = l.object_id
LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
LEFT JOIN ego_motion m ON m.drive_id = s.drive_id AND m.ego_id = s.ego_id AND m.t_ns = s.t_ns
CROSS JOIN LATERAL (SELECT along_mps(l.speed_mps, l.oncoming) AS away_mps, along_mps(l.accel_mps2, l.oncoming) AS other_mps2, ttc_s(l.gap_m, l.ego_speed_mps - along_mps(l.speed_mps, l.oncoming)) AS ttc_s) k

-- @condition
-- at the ends of the log the windows of the accelerations are not whole, which says nothing about the drive. They smooth: the ego's begins to
-- count before it begins, the other's after, and still counts when it is over; where that makes the difference, it is not known
SELECT l.drive_id, l.ego_id, l.t_ns, l.object_id, $least_s AS required, l.object_id IS NULL OR judged_inside(m.accel_mps2 + l.other_mps2, l.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AS applies,
    v.observed,
    CASE WHEN v.observed IS NULL AND l.gap_m + m.accel_mps2 + l.other_mps2 IS NOT NULL
        THEN 'the accelerations are means over half a second, which leave open on which side of the limit it is: no recording decides that' END AS reason
FROM (
    SELECT *, along_mps(speed_mps, oncoming) AS away_mps, along_mps(accel_mps2, oncoming) AS other_mps2,
        min(along_mps(accel_mps2, oncoming)) OVER w AS least_mps2, max(along_mps(accel_mps2, oncoming)) OVER w AS most_mps2
    FROM vehicle_ahead
    WINDOW w AS (PARTITION BY drive_id, ego_id, object_id ORDER BY t_ns RANGE BETWEEN CURRENT ROW AND ($edge_s * 1e9)::BIGINT FOLLOWING)
) l
JOIN clock c ON c.drive_id = l.drive_id AND c.ego_id = l.ego_id
JOIN (
    SELECT *, max(accel_mps2) OVER w AS most_mps2, min(accel_mps2) OVER w AS least_mps2
    FROM ego_motion
    WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY t_ns RANGE BETWEEN ($edge_s * 1e9)::BIGINT PRECEDING AND CURRENT ROW)
) m ON m.drive_id = l.drive_id AND m.ego_id = l.ego_id AND m.t_ns = l.t_ns
CROSS JOIN LATERAL (
    SELECT CASE WHEN l.object_id IS NULL THEN 'inf'::DOUBLE
        ELSE sure(
            or_never(mttc_s(l.gap_m, l.ego_speed_mps, m.accel_mps2, l.away_mps, l.other_mps2), $least_s),
            mttc_s(l.gap_m, l.ego_speed_mps, m.most_mps2, l.away_mps, l.least_mps2),
            mttc_s(l.gap_m, l.ego_speed_mps, m.least_mps2, l.away_mps, l.most_mps2), $least_s
        ) END AS observed
) v
