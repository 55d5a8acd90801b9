-- title = "Mirrors before signalling"
-- breach = "Signalled without checking the mirrors"
-- clause = "UKHC R161: use the mirrors in good time before you signal or change direction"
-- hypothesis = "Before its indicator came on, did the ego declare a mirror check?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["clock", "declared_event", "indicator_on"]
-- requires = ["declared_events", "indicator"]
--
-- [params.window_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: an older look does not show the present situation"

-- @reference
SELECT drive_id, ego_id, t_on_ns AS t_ns, side
FROM indicator_on
WHERE NOT at_log_start

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, CASE
    WHEN bool_or(d.t_ns >= r.t_ns - $window_s * 1e9 AND d.t_ns <= r.t_ns AND coalesce(d.value, r.side) = r.side) THEN true
    WHEN r.t_ns - $window_s * 1e9 >= c.t_start_ns AND count(d.t_ns) > 0 THEN false END AS holds
FROM reference r
JOIN clock c ON c.drive_id = r.drive_id AND c.ego_id = r.ego_id
LEFT JOIN declared_event d ON d.drive_id = r.drive_id AND d.actor_id = r.ego_id AND d.event = 'mirror_check'
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, c.t_start_ns
