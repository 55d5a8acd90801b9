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
-- reads = ["clock", "ego_state", "indicator_on", "lane_change"]
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
--
-- [reasons.signal_time_between_steps]
-- says = "the indicator had been on for {on_s:.1f} s as far as the steps show, and for at most {step_s:.2f} s more or less"
-- advice = "record more steps a second"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, side, begin_seen
FROM lane_change

-- @condition
-- The indicator came on in the step before t_on_ns, and the ego over the line in the step before t_ns: the time may be one step longer or
-- shorter.
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id,
    CASE WHEN NOT r.begin_seen OR e.indicator IS NULL THEN NULL
        WHEN i.t_on_ns IS NULL OR signalled.least_s >= $most_s THEN false
        -- If the indicator is on when the log begins, it may have been on for long enough, or for too long.
        WHEN i.at_log_start THEN NULL
        WHEN signalled.most_s <= $least_s THEN false
        WHEN signalled.least_s >= $least_s AND signalled.most_s <= $most_s THEN true END AS holds,
    CASE WHEN r.begin_seen AND NOT i.at_log_start AND holds IS NULL AND e.indicator IS NOT NULL
        THEN why('signal_time_between_steps', {'on_s': (r.t_ns - i.t_on_ns) / 1e9, 'step_s': k.period_ns / 1e9}) END AS reason
FROM reference r
JOIN clock k USING (drive_id, ego_id)
JOIN ego_state e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns = r.t_ns
LEFT JOIN indicator_on i ON i.drive_id = r.drive_id AND i.ego_id = r.ego_id AND i.side = r.side AND i.t_on_ns <= r.t_ns AND i.t_off_ns >= r.t_ns
CROSS JOIN LATERAL (
    SELECT greatest(r.t_ns - i.t_on_ns - k.period_ns, 0) / 1e9 AS least_s, (r.t_ns - i.t_on_ns + k.period_ns) / 1e9 AS most_s
) signalled
