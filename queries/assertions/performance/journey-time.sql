-- title = "Journey time against free flow"
-- clause = "The paper, performance (liveness): gets there in a time that fits the road"
-- hypothesis = "Did the drive take at most twice the time that it would have taken at the speed limit?"
-- kind = "execution"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = "<="
-- unit = "times"
-- observes = "journey time over that at the speed limit"
-- reads = ["clock", "ego_state", "step"]
-- requires = ["map", "registration", "speed_limits"]
--
-- [params.most]
-- default = 2.0
-- unit = "times"
-- why = "our default: lights and queues in town about double the time"
--
-- [params.least_m]
-- default = 1000.0
-- unit = "m"
-- why = "our default: over less than this one light decides"

-- @reference
-- a draft: how much of the delay is the ego's doing, and how much the traffic's, is a matter of judgement
SELECT drive_id, ego_id, t_end_ns AS t_ns FROM clock

-- @condition
WITH way AS (
    SELECT s.drive_id, s.ego_id, s.dt_ns, e.travel_m, (1_000_000_000 * (e.travel_m - lag(e.travel_m) OVER w) / lag(e.limit_mps) OVER w)::BIGINT AS free_ns
    FROM step s
    JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
    WINDOW w AS (PARTITION BY s.drive_id, s.ego_id ORDER BY s.t_ns)
)
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, $most AS required, max(w.travel_m) >= $least_m AS applies,
    -- a limit that is missing anywhere leaves the free time open
    CASE WHEN count(w.free_ns) = count(w.dt_ns) THEN sum(w.dt_ns) / nullif(sum(w.free_ns), 0) END AS observed
FROM reference r
JOIN way w ON w.drive_id = r.drive_id AND w.ego_id = r.ego_id
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id
