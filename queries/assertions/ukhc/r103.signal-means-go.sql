-- title = "A signal is followed by the manoeuvre"
-- breach = "Signalled a manoeuvre that did not follow"
-- clause = "UKHC R103: signals tell others what you are going to do; do not mislead them"
-- hypothesis = "After the indicator came on, did the ego move out or turn to that side in time?"
-- kind = "postcondition"
-- subtype = "temporal"
-- window_s = "window_s"
-- quantifier = "eventually"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- reads = ["ego_state", "indicator_on", "lane_departure"]
-- requires = ["map", "registration", "indicator", "ego_size"]
--
-- [params.window_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: a signal that is older than this has misled others"
--
-- [params.turned_rad]
-- default = 0.5
-- unit = "rad"
-- why = "our default: a change of heading of about 30 degrees is a turn, not a bend's worth of lane keeping"

-- @reference
SELECT drive_id, ego_id, t_on_ns AS t_ns, side
FROM indicator_on
WHERE NOT at_log_start

-- @condition
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id,
    d.t_ns IS NOT NULL OR wrap_rad(e.yaw_rad - e0.yaw_rad) * CASE r.side WHEN 'left' THEN 1 ELSE -1 END >= $turned_rad AS holds
FROM reference_step s
JOIN reference r USING (ref_id)
JOIN ego_state e0 ON e0.drive_id = r.drive_id AND e0.ego_id = r.ego_id AND e0.t_ns = r.t_ns
JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
LEFT JOIN (SELECT DISTINCT drive_id, ego_id, t_ns, side FROM lane_departure) d
    ON d.drive_id = e.drive_id AND d.ego_id = e.ego_id AND d.t_ns = e.t_ns AND d.side = r.side
