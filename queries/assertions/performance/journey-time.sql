-- title = "Journey not much slower than free flow"
-- breach = "Journey much slower than free flow"
-- clause = "Harper et al. 2021, performance (liveness): gets there in a time that fits the road"
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
-- why = "our default: on a shorter journey a single traffic light decides the result"

-- @reference
-- This rule is a draft: how much of the delay the ego causes, and how much the traffic, is a matter of judgement.
SELECT drive_id, ego_id, t_end_ns AS t_ns FROM clock

-- @condition
WITH travel_step AS (
    SELECT s.drive_id, s.ego_id, s.dt_ns, e.travel_m, (1_000_000_000 * (e.travel_m - lag(e.travel_m) OVER step_order) / lag(e.limit_mps) OVER step_order)::BIGINT AS free_flow_ns
    FROM step s
    JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
    WINDOW step_order AS (PARTITION BY s.drive_id, s.ego_id ORDER BY s.t_ns)
)
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, $most AS required, max(t.travel_m) >= $least_m AS applies,
    -- If the speed limit is missing at any step, the free-flow time is not known.
    CASE WHEN count(t.free_flow_ns) = count(t.dt_ns) THEN sum(t.dt_ns) / nullif(sum(t.free_flow_ns), 0) END AS observed
FROM reference r
JOIN travel_step t ON t.drive_id = r.drive_id AND t.ego_id = r.ego_id
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id
