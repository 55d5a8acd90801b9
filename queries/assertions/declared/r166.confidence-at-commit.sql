-- title = "No overtaking in doubt"
-- breach = "Overtook in doubt"
-- clause = "UKHC R166: do not overtake if you are in doubt"
-- hypothesis = "When the ego left its lane to overtake, was its declared confidence high enough?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = ""
-- observes = "declared confidence"
-- near_margin = 0.02
-- reads = ["declared_event", "overtake"]
-- requires = ["declared_events", "map", "registration", "ego_size", "handedness"]
--
-- [params.window_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: an older confidence was about another situation"
--
-- [params.least]
-- default = 0.9
-- unit = ""
-- why = "our default: the maker must define what counts as doubt"

-- @reference
-- Of several vehicles passed in one go, one that surely is overtaken is enough.
SELECT drive_id, ego_id, t0_ns AS t_ns, begin_seen, bool_and(may_be_no_overtake(status, sure)) AS is_doubtful, min(vbp_id) AS vbp_id
FROM overtake
GROUP BY drive_id, ego_id, t0_ns, begin_seen

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, $least AS required,
    -- If it is not sure that the manoeuvre is an overtake, the rule can be kept, but not broken.
    CASE WHEN confidence >= $least OR NOT is_doubtful THEN confidence END AS observed,
    CASE WHEN confidence < $least AND is_doubtful THEN overtake_doubt(vbp_id) END AS reason
FROM (
    SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.is_doubtful, r.vbp_id,
        -- The last confidence counts; of two at one time, the lower one. If its value is not a number, the confidence is not known.
        CASE WHEN r.begin_seen THEN -(max({'t': d.t_ns, 'open': TRY_CAST(d.value AS DOUBLE) IS NULL, 'less': -TRY_CAST(d.value AS DOUBLE)})).less END AS confidence
    FROM reference r
    LEFT JOIN declared_event d ON d.drive_id = r.drive_id AND d.actor_id = r.ego_id AND d.event = 'confidence'
        AND d.t_ns <= r.t_ns AND d.t_ns >= r.t_ns - ($window_s * 1e9)::BIGINT
    GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.begin_seen, r.is_doubtful, r.vbp_id
)
