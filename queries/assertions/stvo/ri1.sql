-- title = "Not stopping on a motorway"
-- breach = "Stopped on a motorway"
-- clause = "StVO 18(8) (R_I1 of Maierhofer et al. 2020): stopping on motorways is forbidden; standing in a queue, for somebody in the way or with a breakdown (15) is not stopping"
-- hypothesis = "When the ego came to a standstill on a motorway, was there a slow or standing vehicle close ahead, somebody in the way, or a light or sign to wait at?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = "holds"
-- reads = ["ego_mode", "ego_state", "in_way", "standstill"]
-- requires = ["map", "registration", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.queue_mps]
-- default = 2.78
-- unit = "m/s"
-- why = "10 km/h: a vehicle as slow as this is in congestion"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.queue_m]
-- default = 30.0
-- unit = "m"
-- why = "our default: a vehicle that stops further behind than this does not stop for the queue"
--
-- [params.lights_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: a broken-down ego puts its hazard lights on within this time; StVO 15 demands it at once"
--
-- [reasons.may_wait_at_line]
-- says = "the ego stood at a stop line: it is not known whether it had to wait there"
-- advice = "record the state of the light"
--
-- [reasons.may_have_broken_down]
-- says = "the ego had its hazard lights on, or declared an emergency or minimal risk manoeuvre: a person must judge whether it broke down"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, ahead_id AS object_id, ahead_gap_m, ahead_speed_mps, ahead_known, t_end_ns, stop_line_id, control, state
FROM standstill

-- @condition
-- To stop means to halt by choice. An ego that stands for an actor in its way does not stop in this sense, nor does one at a red light or a
-- sign at the end of a ramp, nor an ego that broke down.
-- Hazard lights show that it may have broken down.
WITH possible_breakdown AS (
    SELECT r.ref_id
    FROM reference r
    JOIN ego_state e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns <= least(r.t_end_ns, r.t_ns + ($lights_s * 1e9)::BIGINT)
        AND e.t_ns >= r.t_ns - ($lights_s * 1e9)::BIGINT
    LEFT JOIN ego_mode m ON m.drive_id = e.drive_id AND m.ego_id = e.ego_id AND m.t_ns = e.t_ns
        AND m.mode IN ('minimal_risk_manoeuvre', 'emergency_manoeuvre') AND m.is_on
    WHERE e.indicator = 'hazard' OR m.t_ns IS NOT NULL
    GROUP BY r.ref_id
)
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.object_id,
    queued(r.object_id, r.ahead_gap_m, r.ahead_speed_mps, r.ahead_known, $queue_m, $queue_mps)
        OR stands_because_of(w.object_id, w.actor_class, w.gap_m, w.along_mps, w.known, $queue_m, $queue_m, $queue_mps)
        OR waits_at_line(r.stop_line_id, r.control, r.state)
        OR CASE WHEN b.ref_id IS NULL THEN false END AS holds,
    CASE WHEN b.ref_id IS NOT NULL THEN why('may_have_broken_down') WHEN waits_at_line(r.stop_line_id, r.control, r.state) IS NULL THEN why('may_wait_at_line') END AS reason
FROM reference r
LEFT JOIN in_way w ON w.drive_id = r.drive_id AND w.ego_id = r.ego_id AND w.t_ns = r.t_ns
LEFT JOIN possible_breakdown b ON b.ref_id = r.ref_id
