-- title = "No stopping on a motorway"
-- breach = "Stopped on a motorway"
-- clause = "UKHC R240 and R271: you must not stop on the carriageway of a motorway, nor on a clearway, but in an emergency or when told to"
-- hypothesis = "At every step on a motorway, had the ego not stood for long with nobody in its way, and no light or sign to wait at?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- tags = ["excuses", "standing"]
-- reads = ["ego_mode", "ego_state", "in_way", "standstill"]
-- requires = ["map", "registration", "ego_size", "road_types"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.stop_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: shorter is a pause in traffic"
--
-- [params.near_m]
-- default = 30.0
-- unit = "m"
-- why = "our default, as in stvo.ri1: an ego that stands closer than this behind another vehicle stands because of it; at the tail of a queue on a motorway many leave a lorry's length and more"
--
-- [params.hazard_m]
-- default = 30.0
-- unit = "m"
-- why = "our default: the ego may have stopped for a pedestrian, an animal or an object in its way at up to this distance"
--
-- [params.queue_mps]
-- default = 2.78
-- unit = "m/s"
-- why = "10 km/h: a vehicle as slow as this is in congestion (as R_I1 of Maierhofer et al. 2020)"
--
-- [reasons.may_be_emergency]
-- says = "the ego stands with its hazard lights on, or at the end of a manoeuvre that it declared"
-- advice = "see in a video whether it was an emergency"
--
-- [reasons.may_wait_at_line]
-- says = "the ego stands at a stop line: it is not known whether it had to wait there"
-- advice = "record the state of the light"
--
-- [reasons.stands_and_unplaced]
-- says = "the ego stands, and an actor that may be in its way cannot be placed"
--
-- [reasons.standstill_begin_unseen]
-- says = "the log does not show when the ego stopped"
--
-- [reasons.has_stood]
-- says = "the ego has stood for {stood_s:.1f} s"

-- @condition
-- Clearways and zig-zags are not in the map tables. Crossings are judged by r191.no-stopping.
WITH standstill_step AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, s.t_start_ns, s.begin_seen, waits_at_line(s.stop_line_id, s.control, s.state) AS waits, e.speed_mps, queue.stands_because_of_somebody IS NULL AS is_in_doubt,
        max(CASE WHEN e.indicator = 'hazard' OR m.t_ns IS NOT NULL THEN e.t_ns END) OVER standstill_so_far IS NOT NULL AS may_be_emergency,
        max(CASE WHEN queue.stands_because_of_somebody THEN e.t_ns END) OVER standstill_so_far AS t_queue_ns, max(CASE WHEN queue.stands_because_of_somebody IS NULL THEN e.t_ns END) OVER standstill_so_far AS t_doubt_ns
    FROM ego_state e
    LEFT JOIN in_way w ON w.drive_id = e.drive_id AND w.ego_id = e.ego_id AND w.t_ns = e.t_ns
    CROSS JOIN LATERAL (SELECT stands_because_of(w.object_id, w.actor_class, w.gap_m, w.along_mps, w.known, $near_m, $hazard_m, $queue_mps) AS stands_because_of_somebody) queue
    LEFT JOIN standstill s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id AND s.t_start_ns <= e.t_ns AND s.t_end_ns >= e.t_ns
    LEFT JOIN (SELECT DISTINCT drive_id, ego_id, t_ns FROM ego_mode WHERE mode IN ('minimal_risk_manoeuvre', 'emergency_manoeuvre') AND is_on) m
        ON m.drive_id = e.drive_id AND m.ego_id = e.ego_id AND m.t_ns = e.t_ns
    WINDOW standstill_so_far AS (PARTITION BY e.drive_id, e.ego_id, s.t_start_ns ORDER BY e.t_ns)
)
SELECT drive_id, ego_id, t_ns,
    CASE WHEN t_start_ns IS NULL THEN CASE WHEN speed_mps IS NOT NULL THEN true END
        -- The ego may go on a while after the vehicles ahead of it.
        WHEN t_ns - t_queue_ns <= ($stop_s * 1e9)::BIGINT OR begin_seen AND t_ns - t_start_ns <= ($stop_s * 1e9)::BIGINT THEN true
        -- At the end of a slip road there may be a light or a sign.
        WHEN waits THEN true
        WHEN waits IS NULL THEN NULL
        WHEN t_ns - t_start_ns > ($stop_s * 1e9)::BIGINT AND (t_doubt_ns IS NULL OR t_ns - t_doubt_ns > ($stop_s * 1e9)::BIGINT) THEN CASE WHEN NOT may_be_emergency THEN false END END AS holds,
    CASE WHEN t_start_ns IS NOT NULL AND may_be_emergency THEN why('may_be_emergency')
        WHEN t_start_ns IS NOT NULL AND waits IS NULL THEN why('may_wait_at_line')
        WHEN t_start_ns IS NOT NULL AND is_in_doubt THEN why('stands_and_unplaced')
        WHEN NOT begin_seen AND t_ns - t_start_ns <= ($stop_s * 1e9)::BIGINT THEN why('standstill_begin_unseen')
        WHEN t_start_ns IS NOT NULL THEN why('has_stood', {'stood_s': (t_ns - t_start_ns) / 1e9}) END AS reason
FROM standstill_step
