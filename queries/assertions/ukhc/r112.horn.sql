-- title = "No horn while stationary"
-- breach = "Horn while stationary"
-- clause = "UKHC R112: you must not use your horn while stationary, except when another road user poses a danger"
-- hypothesis = "When the ego's horn began to sound, was the ego moving?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["ego_mode", "ego_state", "pair"]
-- requires = ["mode_horn"]
--
-- [params.near_m]
-- default = 50.0
-- unit = "m"
-- why = "our default: an actor that moves within this distance may have been a danger, which a person must judge"
--
-- [reasons.somebody_moving]
-- says = "an actor nearby was moving: a person must judge whether it was a danger"

-- @reference
SELECT drive_id, ego_id, t_ns
FROM ego_mode
WHERE mode = 'horn'
QUALIFY is_on AND lag(is_on) OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns) IS DISTINCT FROM true

-- @condition
-- The ban on the horn from 23:30 to 7:00 is not judged: these hours are local time, which logs do not have.
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id,
    CASE WHEN e.speed_mps > standing_mps() THEN true WHEN e.speed_mps IS NOT NULL AND n.t_ns IS NULL THEN false END AS holds,
    CASE WHEN n.t_ns IS NOT NULL THEN why('somebody_moving') END AS reason
FROM reference r
JOIN ego_state e USING (drive_id, ego_id, t_ns)
LEFT JOIN (SELECT DISTINCT drive_id, ego_id, t_ns FROM pair WHERE coalesce(speed_mps > standing_mps() AND distance_m <= $near_m, true)) n USING (drive_id, ego_id, t_ns)
