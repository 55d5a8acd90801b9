-- title = "Within its lane"
-- breach = "Out of its lane"
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
-- tags = ["excuses"]
-- reads = ["beside", "ego_state", "line_step", "step"]
-- requires = ["map", "registration", "markings", "ego_size"]
--
-- [params.astride_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: an ego astride a line for longer than this is not correcting its course; time in which it stands or goes round an actor does not count"
--
-- [params.change_s]
-- default = 10.0
-- unit = "s"
-- why = "UN R79 5.6.4.6.5 allows 5 s for a lane change by the system, 10 s for that of a bus or lorry; here every ego has 10 s"
--
-- [params.slow_mps]
-- default = 8.94
-- unit = "m/s"
-- why = "our default, 20 mph: traffic slower than this is slow; a motorcycle may filter past it (UKHC R88, R160)"
--
-- [reasons.may_filter]
-- says = "the ego is as narrow as a motorcycle, and may have filtered past slow traffic"
-- advice = "a person must judge this"
--
-- [reasons.astride_begin_unseen]
-- says = "the ego is already astride the line when the log begins or when the ego enters the map"
-- advice = "record it from before that"
--
-- [reasons.change_end_unseen]
-- says = "the log ends before it shows whether this is a lane change"
-- advice = "record the ego for longer"
--
-- [reasons.may_go_round_unplaced]
-- says = "the ego may be going round an actor whose position is not known"
-- advice = "record every actor nearby without a break"

-- @condition
WITH astride_step AS (
    SELECT drive_id, ego_id, l.t_ns, l.marking, l.beyond, l.astride_begin_seen, l.changes, l.overtaking OR l.passing_id IS NOT NULL AS is_excused,
        CASE WHEN l.t_ns = l.t_astride_ns OR is_excused OR e.speed_mps <= standing_mps() THEN 0 ELSE s.dt_ns END AS counted_ns,
        sum(counted_ns) OVER astride_stretch / 1e9 AS most_s, coalesce(sum(counted_ns) FILTER (l.passing_known AND is_excused IS NOT NULL) OVER astride_stretch, 0) / 1e9 AS least_s,
        bool_or(e.width_m <= narrowest_car_m() AND b.t_ns IS NOT NULL) OVER astride_stretch AS may_filter
    -- A step over both lines of the lane is left out: the lane is too narrow for the ego.
    FROM (FROM line_step QUALIFY count(*) OVER (PARTITION BY drive_id, ego_id, t_ns) = 1) l
    JOIN step s USING (drive_id, ego_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN (
        SELECT DISTINCT drive_id, ego_id, t_ns FROM beside WHERE may_be_vehicle(actor_class) AND along IS DISTINCT FROM false AND coalesce(speed_mps < $slow_mps, true)
    ) b USING (drive_id, ego_id, t_ns)
    WHERE l.t_astride_ns IS NOT NULL
    WINDOW astride_stretch AS (PARTITION BY drive_id, ego_id, l.t_astride_ns ORDER BY l.t_ns ROWS UNBOUNDED PRECEDING)
),
-- The time that counts lies between least_s, in which the ego was certainly not going round an actor, and most_s, which includes the time
-- in which it may have been.
judged_step AS (
    SELECT *, CASE WHEN NOT changes THEN $astride_s ELSE $change_s END AS required,
        CASE
            WHEN most_s <= $astride_s THEN most_s
            WHEN marking IS NULL OR may_filter OR changes IS NULL AND least_s <= $change_s THEN NULL
            WHEN most_s <= required THEN most_s
            WHEN least_s > required THEN least_s
        END AS observed
    FROM astride_step
    -- A solid line divides lanes, too, if both lanes have the same direction. Otherwise it is the edge or the middle of the road.
    WHERE is_excused IS DISTINCT FROM true
        AND coalesce(marking IN ('broken', 'broken_broken', 'broken_solid', 'solid_broken', 'botts_dots') OR marking IN ('solid', 'solid_solid') AND beyond IS NOT DISTINCT FROM 'same', true)
)
SELECT e.drive_id, e.ego_id, e.t_ns, coalesce(j.required, $astride_s) AS required, coalesce(NOT j.astride_begin_seen, false) AS at_least,
    CASE WHEN e.front_s_m IS NULL THEN NULL WHEN j.t_ns IS NULL THEN 0.0::DOUBLE ELSE j.observed END AS observed,
    CASE
        WHEN e.front_s_m IS NULL THEN ego_lacks(e.x_m, e.yaw_rad, e.lanelet_id, e.front_s_m)
        WHEN j.t_ns IS NOT NULL AND NOT j.astride_begin_seen AND j.observed <= j.required THEN why('astride_begin_unseen')
        WHEN j.observed IS NULL AND j.may_filter THEN why('may_filter')
        WHEN j.t_ns IS NOT NULL AND j.changes IS NULL THEN why('change_end_unseen')
        WHEN j.observed IS NULL AND j.least_s <= j.required THEN why('may_go_round_unplaced')
    END AS reason
FROM ego_state e
LEFT JOIN judged_step j USING (drive_id, ego_id, t_ns)
