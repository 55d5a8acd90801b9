-- title = "Signal before moving out"
-- breach = "No signal before moving out"
-- clause = "UKHC R103: give clear signals in plenty of time before changing course or direction"
-- hypothesis = "Was the indicator of that side on throughout the seconds before the ego crossed the boundary of its lane?"
-- kind = "precondition"
-- subtype = "temporal"
-- window_s = "window_s"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- reads = ["ego_state", "lane_departure"]
-- requires = ["map", "registration", "indicator", "ego_size"]
--
-- [params.window_s]
-- default = 5.0
-- unit = "s"
-- why = "five seconds as in the example of Harper et al. 2021; three is the least that an automatic lane change needs"
-- source = "Harper et al. 2021, temporal precondition; UN R79"
--
-- [reasons.crossing_unseen]
-- says = "the log does not show where the ego crossed the boundary"

-- @reference
SELECT drive_id, ego_id, t_ns, side, begin_seen
FROM lane_departure
WHERE NOT back

-- @condition
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id,
    CASE WHEN r.begin_seen THEN e.indicator = r.side END AS holds,
    CASE WHEN NOT r.begin_seen THEN why('crossing_unseen') END AS reason
FROM reference_step s
JOIN reference r USING (ref_id)
JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
