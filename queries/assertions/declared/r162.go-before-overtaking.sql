-- title = "Decision to go before overtaking"
-- breach = "Overtook without the decision to go"
-- clause = "UKHC R162, R267: overtake only when you have made sure that it is safe"
-- hypothesis = "When the ego left its lane to overtake, was its last declared decision a decision to go?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["clock", "declared_event", "overtake"]
-- requires = ["declared_events", "map", "registration", "ego_size", "handedness"]
--
-- [params.window_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: an older decision was about another situation"

-- @reference
SELECT DISTINCT drive_id, ego_id, t0_ns AS t_ns, begin_seen
FROM overtake

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, CASE
    WHEN NOT r.begin_seen THEN NULL
    -- Both decisions at one time count as a decision not to go.
    WHEN count(*) FILTER (d.t_ns <= r.t_ns AND d.t_ns >= r.t_ns - $window_s * 1e9) > 0
        THEN (max({'t': d.t_ns, 'no': d.event = 'overtake_no_go'}) FILTER (d.t_ns <= r.t_ns AND d.t_ns >= r.t_ns - $window_s * 1e9)).no = false
    WHEN r.t_ns - $window_s * 1e9 >= c.t_start_ns AND count(d.t_ns) > 0 THEN false END AS holds
FROM reference r
JOIN clock c ON c.drive_id = r.drive_id AND c.ego_id = r.ego_id
LEFT JOIN declared_event d ON d.drive_id = r.drive_id AND d.actor_id = r.ego_id AND d.event IN ('overtake_go', 'overtake_no_go')
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.begin_seen, c.t_start_ns
