-- title = "Indicator on for 3 to 5 s before a lane change"
-- breach = "Indicator not on for 3 to 5 s before a lane change"
-- clause = "UN R79 5.6.4.6.4: an automatic lane change begins 3 to 5 s after its indicator came on (later supplements: 7 s where the driver confirms it)"
-- hypothesis = "When the ego began to cross into the next lane, had its indicator on that side been on for 3 to 5 s?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["ego_state", "indicator_on", "lane_change"]
-- requires = ["mode_engaged", "map", "registration", "ego_size", "indicator"]
--
-- [params.least_s]
-- default = 3.0
-- unit = "s"
-- why = "earliest start"
-- source = "UN R79 5.6.4.6.4"
--
-- [params.most_s]
-- default = 5.0
-- unit = "s"
-- why = "latest start"
-- source = "UN R79 5.6.4.6.4"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, side, begin_seen
FROM lane_change

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id,
    -- If the indicator is on when the log begins, it may have been on for long enough, or for too long.
    CASE WHEN r.begin_seen AND e.indicator IS NOT NULL AND NOT coalesce(i.at_log_start AND r.t_ns - i.t_on_ns <= $most_s * 1e9, false)
        THEN coalesce(r.t_ns - i.t_on_ns >= $least_s * 1e9 AND r.t_ns - i.t_on_ns <= $most_s * 1e9, false) END AS holds
FROM reference r
JOIN ego_state e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns = r.t_ns
LEFT JOIN indicator_on i ON i.drive_id = r.drive_id AND i.ego_id = r.ego_id AND i.side = r.side AND i.t_on_ns <= r.t_ns AND i.t_off_ns >= r.t_ns
