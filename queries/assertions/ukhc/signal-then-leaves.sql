-- title = "Exit taken after signalling to leave"
-- breach = "Exit not taken after signalling to leave"
-- clause = "UKHC R103: do not mislead others by your signals (physical postcondition of Harper et al. 2021)"
-- hypothesis = "When the ego signalled towards an exit beside it, and not only for a change to the lane beside the exit, was it in the exit lane where the exit parts from the road?"
-- kind = "postcondition"
-- subtype = "physical"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["exit_passed", "indicator_on", "lane_crossing"]
-- requires = ["map", "registration", "indicator"]
--
-- [params.off_s]
-- default = 5.0
-- unit = "s"
-- why = "our default, as in r103.signal-off: a signal that goes off this soon after a lane change was for that change"

-- @reference
-- A signal for a change to the lane beside the exit is no signal to leave.
WITH lane_change_signal AS (
    SELECT i.drive_id, i.ego_id, i.occurrence, max(l.t_ns) AS t_ns
    FROM indicator_on i
    JOIN lane_crossing l ON l.drive_id = i.drive_id AND l.ego_id = i.ego_id AND l.side = CASE i.side WHEN 'left' THEN 1 WHEN 'right' THEN -1 END
        AND l.t_ns >= i.t_on_ns
    WHERE l.t_ns <= i.t_off_ns AND i.t_off_ns <= l.t_ns + ($off_s * 1e9)::BIGINT
    GROUP BY ALL
)
SELECT x.drive_id, x.ego_id, greatest(max(i.t_on_ns), x.t_near_ns) AS t_ns, x.side, x.occurrence
FROM exit_passed x
JOIN indicator_on i ON i.drive_id = x.drive_id AND i.ego_id = x.ego_id AND i.side = x.side
    AND i.t_on_ns <= coalesce(x.t_gore_ns, i.t_on_ns) AND i.t_off_ns >= x.t_near_ns
LEFT JOIN lane_change_signal c ON c.drive_id = i.drive_id AND c.ego_id = i.ego_id AND c.occurrence = i.occurrence
WHERE coalesce(c.t_ns > x.t_near_ns, true)
GROUP BY x.drive_id, x.ego_id, x.t_near_ns, x.side, x.occurrence

-- @anchor
SELECT r.ref_id, x.t_gore_ns AS t_ns
FROM reference r
JOIN exit_passed x USING (drive_id, ego_id, occurrence)

-- @condition
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, x.taken AS holds
FROM reference_step s
JOIN reference r USING (ref_id)
JOIN exit_passed x ON x.drive_id = s.drive_id AND x.ego_id = s.ego_id AND x.occurrence = r.occurrence
