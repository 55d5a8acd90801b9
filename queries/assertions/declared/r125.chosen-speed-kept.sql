-- title = "Not faster than the chosen speed"
-- breach = "Faster than the chosen speed"
-- clause = "UKHC R125, R146, R152: the limit is no target; choose a speed that suits the conditions"
-- hypothesis = "At every step, was the ego no faster than the speed that it had declared as its choice?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "m/s"
-- observes = "speed"
-- merge_gap_s = 5.0
-- reads = ["declared_event", "ego_state"]
-- requires = ["declared_events"]
--
-- [params.settle_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: time to slow down to a lower choice"
--
-- [params.tolerance_mps]
-- default = 1.0
-- unit = "m/s"
-- why = "our default: speed control is that exact"

-- @condition
-- A choice whose value is no number may be of a higher speed: then only a speed that another choice allows is known to be kept.
SELECT e.drive_id, e.ego_id, e.t_ns, e.speed_mps AS observed,
    CASE WHEN count(d.t_ns) = count(d.speed_mps) OR e.speed_mps <= max(d.speed_mps) + $tolerance_mps THEN max(d.speed_mps) + $tolerance_mps END AS required
FROM ego_state e
LEFT JOIN (
    -- A choice holds until the next one, and for a while longer if the next one is lower.
    SELECT drive_id, actor_id, t_ns, TRY_CAST(split_part(value, ';', 1) AS DOUBLE) AS speed_mps,
        lead(t_ns) OVER (PARTITION BY drive_id, actor_id ORDER BY t_ns, value) + ($settle_s * 1e9)::BIGINT AS t_end_ns
    FROM declared_event
    WHERE event = 'chosen_speed'
) d ON d.drive_id = e.drive_id AND d.actor_id = e.ego_id AND e.t_ns >= d.t_ns AND e.t_ns < coalesce(d.t_end_ns, 'inf'::DOUBLE)
GROUP BY e.drive_id, e.ego_id, e.t_ns, e.speed_mps
