-- title = "Mirror check, then blind spot check, before pulling out"
-- breach = "Pulled out without checking mirror, then blind spot"
-- clause = "UKHC R163, R133: before pulling out use the mirrors, then check the blind spot on that side"
-- hypothesis = "Before the ego left its lane, did it declare a mirror check and then a blind spot check?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["clock", "declared_event", "lane_departure"]
-- requires = ["declared_events", "map", "registration", "ego_size"]
--
-- [params.window_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: an older look does not show the present situation"

-- @reference
SELECT drive_id, ego_id, t_ns, side, begin_seen
FROM lane_departure
WHERE NOT back

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, CASE
    WHEN NOT r.begin_seen THEN NULL
    -- A mirror check must come before a blind spot check: the first mirror check is compared with the last blind spot check.
    WHEN min(d.t_ns) FILTER (d.event = 'mirror_check' AND d.t_ns >= r.t_ns - $window_s * 1e9 AND coalesce(d.value, r.side) = r.side)
        <= max(d.t_ns) FILTER (d.event = 'blind_spot_check' AND d.t_ns <= r.t_ns AND coalesce(d.value, r.side) = r.side) THEN true
    WHEN r.t_ns - $window_s * 1e9 >= c.t_start_ns AND bool_or(d.event = 'mirror_check') AND bool_or(d.event = 'blind_spot_check') THEN false
    END AS holds
FROM reference r
JOIN clock c ON c.drive_id = r.drive_id AND c.ego_id = r.ego_id
LEFT JOIN declared_event d ON d.drive_id = r.drive_id AND d.actor_id = r.ego_id
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.begin_seen, c.t_start_ns
