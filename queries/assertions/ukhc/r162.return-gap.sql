-- title = "Room to return ahead of the vehicle being passed"
-- breach = "No room to return ahead of the vehicle being passed"
-- clause = "UKHC R162 and R163: overtake only if there is a suitable gap in front of the vehicle that you mean to overtake"
-- hypothesis = "When the ego pulled out, was there room for it ahead of the vehicle being passed, with thinking distance before and behind?"
-- kind = "execution"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "m"
-- observes = "space ahead of the vehicle being passed"
-- near_margin = 2.0
-- reads = ["ego_state", "hidden", "oncoming", "overtake", "pair", "unplaced"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [reasons.actor_may_be_there]
-- says = "actor {object_id}, which may be there, {lack}"
-- advice = "record it without a break"
--
-- [reasons.class_there_unknown]
-- says = "the class of an actor there is not known"
-- advice = "record it"
--
-- [reasons.may_pass_next]
-- says = "{gap_m:.2f} m ahead of the vehicle being passed are not enough, but the log ends before the ego is back: it may pass the next vehicle, too"
-- advice = "record until the ego is back"

-- @reference
SELECT drive_id, ego_id, t0_ns AS t_ns, vbp_id AS object_id, occurrence
FROM overtake
WHERE opposing IS DISTINCT FROM false
-- If two vehicles are passed in one go, the ego returns ahead of the last one.
QUALIFY occurrence = max(occurrence) OVER (PARTITION BY drive_id, ego_id, t0_ns)

-- @condition
-- Without a vehicle ahead of the vehicle being passed, the gap reaches at least as far as the corridor and the sensors.
WITH gap_ahead_of_passed AS (
    SELECT r.ref_id, v.front_s_m, min(a.rear_s_m) - v.front_s_m AS gap_m, min(a.rear_s_m) FILTER (is_vehicle(a.actor_class)) - v.front_s_m AS vehicle_gap_m
    FROM reference r
    JOIN pair v ON v.drive_id = r.drive_id AND v.ego_id = r.ego_id AND v.t_ns = r.t_ns AND v.object_id = r.object_id
    LEFT JOIN (
        FROM pair
        WHERE (may_be_vehicle(actor_class) OR actor_class = 'object' AND abs(d_m) <= half_width_m) AND abs(d_m) - lat_half_m < half_width_m - over_boundary_m()
            AND (abs(heading_diff_rad) < pi() / 2 OR speed_mps <= standing_mps())
    ) a ON a.drive_id = r.drive_id AND a.ego_id = r.ego_id AND a.t_ns = r.t_ns AND a.s_m > v.s_m
    GROUP BY r.ref_id, v.front_s_m
),
-- A vehicle without a place may be in the gap, unless it is behind the ego or further ahead.
possible_vehicle AS (
    SELECT r.ref_id, min({'lane_m': d.lane_m, 'object_id': d.object_id, 'lack': coalesce(u.code, 'no_place')}) AS o
    FROM reference r
    JOIN hidden d ON d.drive_id = r.drive_id AND d.ego_id = r.ego_id AND d.t_ns = r.t_ns AND d.vehicle AND d.ahead IS DISTINCT FROM false
    LEFT JOIN unplaced u ON u.drive_id = d.drive_id AND u.ego_id = d.ego_id AND u.t_ns = d.t_ns AND u.object_id = d.object_id
    GROUP BY r.ref_id
)
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, required_gap.size_m AS required,
    coalesce(h.gap_m IS NULL OR free_gap.unseen_m < h.gap_m, false) AND NOT too_small.is_known AS at_least,
    CASE
        WHEN NOT o.begin_seen THEN NULL
        WHEN too_small.is_known AND may_be_no_overtake(o.status, o.sure) THEN NULL
        -- An ego that is not back yet may pass the vehicle ahead of the gap, too, and return ahead of that one.
        WHEN too_small.is_known AND o.status = 'truncated' THEN NULL
        -- Only a known vehicle makes the gap too small: an object nearer than that, of a class that is not known, may be no vehicle.
        WHEN too_small.is_known THEN h.vehicle_gap_m
        -- least() ignores NULL (no vehicle without a place), as is right here.
        WHEN h.gap_m IS NULL THEN CASE WHEN free_gap.seen_m IS NOT NULL THEN greatest(0.0, least(free_gap.seen_m, free_gap.unseen_m)) END
        WHEN h.gap_m >= required_gap.size_m THEN greatest(0.0, least(h.gap_m, free_gap.unseen_m))
    END AS observed,
    CASE WHEN NOT o.begin_seen THEN why('overtake_begin_unseen') WHEN too_small.is_known AND may_be_no_overtake(o.status, o.sure) THEN overtake_doubt(o.vbp_id)
        WHEN too_small.is_known THEN CASE WHEN o.status = 'truncated' THEN why('may_pass_next', {'gap_m': h.vehicle_gap_m}) END
        WHEN free_gap.unseen_m < required_gap.size_m THEN why('actor_may_be_there', {'object_id': d.o.object_id, 'lack': d.o.lack})
        WHEN h.gap_m < required_gap.size_m THEN why('class_there_unknown')
        WHEN coalesce(free_gap.unseen_m < h.gap_m, h.gap_m IS NULL) AND coalesce(h.gap_m, free_gap.seen_m) >= required_gap.size_m THEN why('lower_bound')
    END AS reason
FROM reference r
JOIN overtake o USING (drive_id, ego_id, occurrence)
CROSS JOIN LATERAL (SELECT o.l_av_m + thinking_distance_m(o.v_vbp_mps) + thinking_distance_m(o.v_av_mps) AS size_m) required_gap
LEFT JOIN gap_ahead_of_passed h USING (ref_id)
CROSS JOIN LATERAL (SELECT coalesce(h.vehicle_gap_m < required_gap.size_m, false) AS is_known) too_small
LEFT JOIN possible_vehicle d USING (ref_id)
LEFT JOIN ego_state e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns = r.t_ns
LEFT JOIN oncoming n ON n.drive_id = r.drive_id AND n.ego_id = r.ego_id AND n.t_ns = r.t_ns
CROSS JOIN LATERAL (SELECT n.free_m - (h.front_s_m - e.front_s_m) AS seen_m, d.o.lane_m - (h.front_s_m - e.front_s_m) AS unseen_m) free_gap
