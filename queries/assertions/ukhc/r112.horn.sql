-- title = "No horn while stationary"
-- breach = "Horn while stationary"
-- clause = "UKHC R112: you must not use your horn while stationary, except when another road user poses a danger"
-- hypothesis = "When the ego's horn began to sound, and whenever the ego came to stand while it sounded, was the ego moving?"
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
-- An occasion is the begin of a sound, and each step at which the ego comes to stand, or may do so, while it lasts.
SELECT drive_id, ego_id, t_ns, min(t_ns) OVER sound AS t_from_ns
FROM (
    SELECT drive_id, ego_id, t_ns, m.is_on, e.speed_mps <= standing_mps() AS stands,
        sum(CASE WHEN m.is_on THEN 0 ELSE 1 END) OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS n_silent
    FROM ego_mode m
    LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE m.mode = 'horn'
)
WHERE is_on
WINDOW sound AS (PARTITION BY drive_id, ego_id, n_silent ORDER BY t_ns)
QUALIFY t_ns = t_from_ns OR stands IS DISTINCT FROM false AND stands IS DISTINCT FROM lag(stands) OVER sound

-- @condition
-- The ban on the horn from 23:30 to 7:00 is not judged: these hours are local time, which logs do not have.
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id,
    CASE WHEN e.speed_mps > standing_mps() THEN true WHEN e.speed_mps IS NOT NULL AND n.ref_id IS NULL THEN false END AS holds,
    CASE WHEN n.ref_id IS NOT NULL THEN why('somebody_moving') END AS reason
FROM reference r
JOIN ego_state e USING (drive_id, ego_id, t_ns)
-- A sound that began as a warning may still be one when the ego has come to stand.
LEFT JOIN (
    SELECT DISTINCT ref_id
    FROM reference r
    JOIN pair p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.t_ns >= r.t_from_ns AND p.t_ns <= r.t_ns
    WHERE coalesce(p.speed_mps > standing_mps() AND p.distance_m <= $near_m, true)
) n USING (ref_id)
