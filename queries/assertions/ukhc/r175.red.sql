-- title = "Stop at a red light"
-- breach = "Passed a red light"
-- clause = "UKHC R175 and R176: you must stop behind the stop line unless the light is green, or amber and too late to stop"
-- hypothesis = "Was the light neither red nor red with amber when the ego's front went over the stop line?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["data_log", "ego_condition", "ego_state", "environment", "step", "stop_line_crossing"]
-- requires = ["map", "registration", "ego_size", "traffic_lights", "signals"]
--
-- [params.line_m]
-- default = 0.4
-- unit = "m"
-- why = "our default: maps, boxes and positions together are not more exact about a vehicle that stands at the line"
--
-- [reasons.stands_at_line]
-- says = "the light was {state}, and the ego stood at most {line_m:g} m further on: positions are not exact enough to show whether it was before the line"
--
-- [params.seen_line_m]
-- default = 1.0
-- unit = "m"
-- why = "our default: the same where the sensors of a recorder saw the ego"
--
-- [params.turn_m]
-- default = 30.0
-- unit = "m"
-- why = "our default: a vehicle that turns at a junction has turned this far past its stop line"
--
-- [reasons.right_on_red]
-- says = "the light was {state}, and the ego turned right: in {nation} that is allowed after a stop, or without a stop on a separate turning lane; a person must judge"
--
-- [reasons.right_on_red_somewhere]
-- says = "the light was {state}, and the ego turned right: in some nations that is allowed, and the nation is not known"
-- advice = "set it, such as --env nation=de"
--
-- [reasons.line_crossing_unseen]
-- says = "the log does not show when the ego crossed the stop line"
--
-- [reasons.red_then_off]
-- says = "the light was red and then off: it is not known whether the light or its recording failed"
--
-- [reasons.light_turned]
-- says = "the light turned {state} while the ego was crossing the stop line"

-- @reference
SELECT c.drive_id, c.ego_id, c.t_ns, c.occurrence, c.signal_id, c.begin_seen, c.state, c.state_before,
    c.t_state_ns > c.t_ns - s.dt_ns AS changed,
    EXISTS (
        FROM step n JOIN ego_state e USING (drive_id, ego_id, t_ns)
        WHERE n.drive_id = c.drive_id AND n.ego_id = c.ego_id AND n.t_ns >= c.t_ns AND n.travel_m <= s.travel_m + m.line_m
            AND e.speed_mps <= standstill_mps()
    ) AS stands, m.line_m,
    -- Some nations that drive on the right turn right on red.
    coalesce(g.nation IN ('us', 'ca', 'mx', 'cn', 'kr'), v.handedness = 'rht') AND EXISTS (
        FROM step n JOIN ego_state e USING (drive_id, ego_id, t_ns)
        WHERE n.drive_id = c.drive_id AND n.ego_id = c.ego_id AND n.t_ns >= c.t_ns AND n.travel_m <= s.travel_m + $turn_m
            -- At the end of the log a turn may have only begun.
            AND wrap_rad(e.yaw_rad - a.yaw_rad) < CASE WHEN l.travel_m < s.travel_m + $turn_m THEN -pi() / 36 ELSE -pi() / 6 END
    ) AS may_turn_on_red, g.nation
FROM stop_line_crossing c
JOIN step s ON s.drive_id = c.drive_id AND s.ego_id = c.ego_id AND s.t_ns = c.t_ns
LEFT JOIN (SELECT drive_id, ego_id, max(travel_m) AS travel_m FROM step GROUP BY drive_id, ego_id) l ON l.drive_id = c.drive_id AND l.ego_id = c.ego_id
LEFT JOIN data_log d ON d.drive_id = c.drive_id
LEFT JOIN environment v ON v.environment_id = d.environment_id
CROSS JOIN LATERAL (SELECT CASE WHEN d.sensor_range_m IS NULL THEN $line_m ELSE $seen_line_m END AS line_m) m
LEFT JOIN ego_state a ON a.drive_id = c.drive_id AND a.ego_id = c.ego_id AND a.t_ns = c.t_ns
LEFT JOIN ego_condition g ON g.drive_id = c.drive_id AND g.ego_id = c.ego_id AND g.t_ns = c.t_ns
WHERE c.control = 'traffic_light'

-- @condition
-- The ego crosses the line between two steps: if the light changed between them, too, both states must agree. No light goes off after red:
-- either the light or its recording failed.
SELECT drive_id, ego_id, t_ns, ref_id,
    CASE WHEN begin_seen AND NOT coalesce(state = 'off' AND forbids(state_before), false) AND (NOT coalesce(changed, false) OR forbids(state_before) = forbids(state))
        AND NOT ((stands OR may_turn_on_red) AND coalesce(forbids(state), false)) THEN NOT forbids(state) END AS holds,
    CASE WHEN NOT begin_seen THEN why('line_crossing_unseen')
        WHEN state IS NULL THEN why('light_state_unknown')
        WHEN state = 'off' AND forbids(state_before) THEN why('red_then_off')
        WHEN changed THEN why('light_turned', {'state': state})
        WHEN may_turn_on_red AND forbids(state) THEN CASE WHEN nation IS NULL THEN why('right_on_red_somewhere', {'state': state}) ELSE why('right_on_red', {'state': state, 'nation': nation}) END
        WHEN stands AND forbids(state) THEN why('stands_at_line', {'state': state, 'line_m': line_m})
        ELSE why('light_was', {'state': state}) END AS reason
FROM reference
