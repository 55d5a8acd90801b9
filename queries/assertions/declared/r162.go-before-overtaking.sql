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
-- Of several vehicles passed in one go, one that surely is overtaken is enough.
SELECT drive_id, ego_id, t0_ns AS t_ns, begin_seen, bool_and(may_be_no_overtake(status, sure)) AS is_doubtful, min(vbp_id) AS vbp_id
FROM overtake
GROUP BY drive_id, ego_id, t0_ns, begin_seen

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id,
    -- If it is not sure that the manoeuvre is an overtake, the rule can be kept, but not broken.
    CASE WHEN is_decided OR NOT is_doubtful THEN is_decided END AS holds,
    CASE WHEN NOT is_decided AND is_doubtful THEN overtake_doubt(vbp_id) END AS reason
FROM (
    SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.is_doubtful, r.vbp_id, CASE
        WHEN NOT r.begin_seen THEN NULL
        -- Both decisions at one time count as a decision not to go.
        WHEN count(*) FILTER (d.t_ns <= r.t_ns AND d.t_ns >= r.t_ns - $window_s * 1e9) > 0
            THEN (max({'t': d.t_ns, 'no': d.event = 'overtake_no_go'}) FILTER (d.t_ns <= r.t_ns AND d.t_ns >= r.t_ns - $window_s * 1e9)).no = false
        WHEN r.t_ns - $window_s * 1e9 >= c.t_start_ns AND count(d.t_ns) > 0 THEN false END AS is_decided
    FROM reference r
    JOIN clock c ON c.drive_id = r.drive_id AND c.ego_id = r.ego_id
    LEFT JOIN declared_event d ON d.drive_id = r.drive_id AND d.actor_id = r.ego_id AND d.event IN ('overtake_go', 'overtake_no_go')
    GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.begin_seen, r.is_doubtful, r.vbp_id, c.t_start_ns
)
