-- title = "No needless standstill"
-- breach = "Stood without need"
-- clause = "Harper et al. 2021, performance (liveness): a vehicle that can go on does; nothing is gained by one that stops for no reason"
-- hypothesis = "Where nothing was in its way, nobody was near, and no junction, stop line or crossing was close, did the ego go on within 10 s?"
-- kind = "execution"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = "<="
-- unit = "s"
-- observes = "standstill"
-- tags = ["standing"]
-- reads = ["pair", "standstill"]
-- requires = ["map", "registration", "ego_size"]
--
-- [params.most_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: longer than a hesitation"
--
-- [params.ahead_m]
-- default = 15.0
-- unit = "m"
-- why = "our default: a vehicle ahead within three car lengths is a queue"
--
-- [params.junction_m]
-- default = 20.0
-- unit = "m"
-- why = "our default: near a junction there may be an actor to wait for"
--
-- [params.near_m]
-- default = 15.0
-- unit = "m"
-- why = "our default: the ego may wait for a pedestrian or a moving actor this near"
--
-- [reasons.ends_standing]
-- says = "the log ends before the ego drives on: it may have arrived"

-- @reference
-- This rule is a draft: no log says what a stop is for (passengers, a delivery, a gesture). Only standing is judged, not slow driving.
SELECT drive_id, ego_id, t_start_ns AS t_ns, occurrence FROM standstill

-- @condition
WITH standstill_near_actor AS (
    SELECT DISTINCT s.drive_id, s.ego_id, s.occurrence
    FROM standstill s
    JOIN pair p ON p.drive_id = s.drive_id AND p.ego_id = s.ego_id AND p.t_ns >= s.t_start_ns AND p.t_ns <= s.t_end_ns
    WHERE coalesce(p.clearance_m <= $near_m, true) AND (NOT may_be_vehicle(p.actor_class) OR coalesce(p.speed_mps > standing_mps(), true))
)
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, $most_s AS required, CASE WHEN s.end_seen THEN duration.s END AS observed,
    CASE WHEN NOT s.end_seen THEN why('ends_standing') END AS reason,
    -- A standstill at the beginning of the log is not judged, because the drive begins when the ego is first seen to move. A short
    -- standstill at the end of the log is not judged either.
    s.begin_seen AND (s.end_seen OR duration.s > $most_s) AND n.occurrence IS NULL AND s.stop_line_id IS NULL AND s.crossing_id IS NULL AND s.junction_id IS NULL
        AND s.junction_m > $junction_m AND CASE WHEN s.ahead_id IS NOT NULL THEN s.ahead_gap_m > $ahead_m WHEN s.ahead_known THEN true END AS applies
FROM reference r
JOIN standstill s USING (drive_id, ego_id, occurrence)
CROSS JOIN LATERAL (SELECT (s.t_end_ns - s.t_start_ns) / 1_000_000_000 AS s) duration
LEFT JOIN standstill_near_actor n USING (drive_id, ego_id, occurrence)
