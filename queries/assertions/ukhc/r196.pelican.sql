-- title = "Stop at a signalled crossing"
-- clause = "UKHC R196 and R197: at a signalled crossing you must stop on red, and give way to people on it while amber flashes, to those from beyond an island too"
-- hypothesis = "When the ego went onto the crossing, did the light allow it, and was nobody on its half, or about to come onto it, while amber flashed?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["actor", "clock", "crossing_occupancy", "crossing_passage", "stop_line_crossing"]
-- requires = ["map", "registration", "ego_size"]
--
-- [params.past_line_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: a stop line crossed longer ago is not the one before this crossing"
--
-- [params.straight_s]
-- default = 3.0
-- unit = "s"
-- why = "our default: who takes longer from one half to the other waits on an island, and a crossing that is not straight is two (R197)"

-- @reference
-- where the crossing has a stop line, it is there that the light had to be kept
SELECT c.drive_id, c.ego_id, c.t_in_ns AS t_ns, c.occurrence, c.crossing_id, c.along_road, c.on_id AS object_id, c.t_on_ns, c.known,
    CASE WHEN count(l.t_ns) > 0 THEN max({'t': l.t_ns, 'state': l.state}).state ELSE c.state END AS state
FROM crossing_passage c
LEFT JOIN stop_line_crossing l ON l.drive_id = c.drive_id AND l.ego_id = c.ego_id AND l.signal_id = c.signal_id
    AND l.t_ns <= c.t_in_ns AND l.t_ns >= c.t_in_ns - ($past_line_s * 1e9)::BIGINT
WHERE coalesce(c.kind, 'signalled') = 'signalled'
GROUP BY c.drive_id, c.ego_id, c.t_in_ns, c.occurrence, c.crossing_id, c.along_road, c.on_id, c.t_on_ns, c.known, c.state

-- @condition
-- who is on the other half and goes straight on to this one was on the way when the ego came; who came from here, or leaves there, was not
WITH other AS (
    SELECT r.ref_id, o.object_id, a.actor_class, o.t_to_ns, k.t_end_ns - k.max_gap_ns AS t_seen_ns,
        min(q.t_from_ns) FILTER (q.t_from_ns > r.t_ns) AS t_next_ns, bool_or(q.t_from_ns <= r.t_ns) AS came
    FROM reference r
    JOIN clock k USING (drive_id, ego_id)
    JOIN crossing_occupancy o ON o.drive_id = r.drive_id AND o.crossing_id = r.crossing_id AND o.along_road <> r.along_road
        AND o.t_from_ns <= r.t_ns AND o.t_to_ns >= r.t_ns AND o.object_id <> r.ego_id
    JOIN actor a ON a.drive_id = o.drive_id AND a.actor_id = o.object_id
    LEFT JOIN crossing_occupancy q ON q.drive_id = o.drive_id AND q.crossing_id = o.crossing_id AND q.object_id = o.object_id AND q.along_road = r.along_road
    GROUP BY r.ref_id, o.object_id, a.actor_class, o.t_to_ns, k.t_end_ns, k.max_gap_ns
),
coming AS (
    SELECT ref_id, min(object_id) FILTER (comes) AS comes_id, count(*) FILTER (comes IS NULL) AS n_unknown
    FROM (
        SELECT ref_id, object_id, CASE
            WHEN t_next_ns - t_to_ns <= ($straight_s * 1e9)::BIGINT THEN CASE WHEN actor_class IS NOT NULL THEN true END
            WHEN came OR t_to_ns < t_seen_ns THEN false
        END AS comes
        FROM other
    )
    GROUP BY ref_id
)
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id,
    NOT forbids(r.state) AND (r.state <> 'flashing'
        OR CASE WHEN r.object_id IS NOT NULL AND r.t_on_ns <= r.t_ns OR c.comes_id IS NOT NULL THEN false WHEN r.known AND coalesce(c.n_unknown, 0) = 0 THEN true END) AS holds,
    'the light was ' || coalesce(replace(r.state, '_', ' and '), 'not known') || coalesce(', and ' || coalesce(r.object_id, c.comes_id) || ' on the crossing', '') AS reason
FROM reference r
LEFT JOIN coming c USING (ref_id)
