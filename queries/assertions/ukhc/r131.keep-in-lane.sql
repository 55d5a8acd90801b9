-- title = "Within its lane"
-- clause = "UKHC R131: keep between the broken lines that divide the road into lanes"
-- hypothesis = "At every step outside a lane change or overtake, had the ego been astride a lane line for no longer than a few seconds?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "s"
-- observes = "time astride a lane line"
-- merge_gap_s = 2.0
-- reads = ["ego_state", "line_step", "step"]
-- requires = ["map", "registration", "markings", "ego_size"]
--
-- [params.astride_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: longer is no correction any more; time standing does not count"

-- @condition
WITH astride AS (
    SELECT drive_id, ego_id, l.t_ns, l.marking, l.begin_seen, l.manoeuvre, l.passing_id,
        sum(CASE WHEN l.t_ns = l.t_since_ns OR e.speed_mps <= standing_mps() THEN 0 ELSE s.dt_ns END)
            OVER (PARTITION BY drive_id, ego_id, l.side, l.t_since_ns ORDER BY l.t_ns ROWS UNBOUNDED PRECEDING) / 1e9 AS moving_s
    FROM line_step l
    JOIN step s USING (drive_id, ego_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    -- over both lines at once: a lane that is too narrow for it
    QUALIFY count(*) OVER (PARTITION BY drive_id, ego_id, l.t_ns) = 1
)
SELECT e.drive_id, e.ego_id, e.t_ns, $astride_s AS required, coalesce(NOT a.begin_seen, false) AS at_least,
    CASE WHEN e.front_s_m IS NULL THEN NULL WHEN a.t_ns IS NULL THEN 0.0::DOUBLE WHEN a.marking IS NOT NULL OR a.moving_s <= $astride_s THEN a.moving_s END AS observed,
    CASE WHEN e.front_s_m IS NULL THEN 'the ego is not placed on the road' END AS reason
FROM ego_state e
LEFT JOIN (
    FROM astride
    WHERE NOT manoeuvre AND passing_id IS NULL
        AND coalesce(marking IN ('broken', 'broken_broken', 'broken_solid', 'solid_broken', 'botts_dots'), true)
) a USING (drive_id, ego_id, t_ns)
