-- title = "Mirror and blind spot checks before reversing"
-- breach = "Reversed without checking mirrors and blind spot"
-- clause = "UKHC R202: before and while reversing look carefully, into the mirrors and the blind spots"
-- hypothesis = "Before the ego began to reverse, did it declare a mirror check and a blind spot check?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["clock", "declared_event", "ego_motion", "step"]
-- requires = ["declared_events"]
--
-- [params.window_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: an older look does not show the present situation"
--
-- [params.reverse_mps]
-- default = 0.1
-- unit = "m/s"
-- why = "our default: noise of a speed that is zero"

-- @reference
SELECT drive_id, ego_id, t_ns, before
FROM (
    SELECT m.drive_id, m.ego_id, m.t_ns, m.v_long_mps < -$reverse_mps AS reverses,
        lag(m.v_long_mps >= -$reverse_mps) OVER (PARTITION BY m.drive_id, m.ego_id, s.seg ORDER BY m.t_ns) AS before
    FROM ego_motion m
    JOIN step s USING (drive_id, ego_id, t_ns)
)
-- If the log, or its part after a hole, begins in reverse, the time at which the reversing began is not known.
WHERE reverses AND before IS DISTINCT FROM false
UNION ALL
-- Nor is that time known if the ego's speed or heading is not known.
SELECT drive_id, ego_id, min(t_ns), NULL FROM ego_motion WHERE v_long_mps IS NULL GROUP BY drive_id, ego_id

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, CASE
    WHEN NOT coalesce(r.before, false) THEN NULL
    WHEN bool_or(d.event = 'mirror_check' AND d.t_ns >= r.t_ns - $window_s * 1e9 AND d.t_ns <= r.t_ns)
        AND bool_or(d.event = 'blind_spot_check' AND d.t_ns >= r.t_ns - $window_s * 1e9 AND d.t_ns <= r.t_ns) THEN true
    WHEN r.t_ns - $window_s * 1e9 >= c.t_start_ns AND bool_or(d.event = 'mirror_check') AND bool_or(d.event = 'blind_spot_check') THEN false
    END AS holds
FROM reference r
JOIN clock c ON c.drive_id = r.drive_id AND c.ego_id = r.ego_id
LEFT JOIN declared_event d ON d.drive_id = r.drive_id AND d.actor_id = r.ego_id
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.before, c.t_start_ns
