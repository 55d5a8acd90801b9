-- title = "Not pulling out while being overtaken"
-- breach = "Pulled out while being overtaken"
-- clause = "UKHC R162: before overtaking make sure that nobody behind is beginning to overtake you"
-- hypothesis = "When the ego first left its lane to overtake, was the nearest vehicle behind in the passing lane still seconds away?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "time until the vehicle behind in the passing lane is there"
-- near_margin = 1.0
-- reads = ["overtake", "overtake_place"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [params.ttc_s]
-- default = 4.0
-- unit = "s"
-- why = "our default: time to see the ego pull out and to slow down in comfort"
--
-- [reasons.overtaken_unknown]
-- says = "it is not known which vehicle the ego meant to overtake, if any"
-- advice = "record all vehicles ahead of it, with their classes"

-- @reference
SELECT o.drive_id, o.ego_id, o.t0_ns AS t_ns, p.rear_id AS object_id, o.occurrence
FROM overtake o
LEFT JOIN overtake_place p USING (drive_id, ego_id, occurrence)
-- If two vehicles are passed in one go, the ego pulls out only once.
QUALIFY o.occurrence = min(o.occurrence) OVER (PARTITION BY o.drive_id, o.ego_id, o.t0_ns)

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, $ttc_s AS required,
    -- Another vehicle that was not placed could only make the time shorter, unless it is too far away to arrive in time.
    CASE WHEN o.begin_seen AND (p.rear_known OR p.rear_ttc_s < $ttc_s OR p.rear_unseen_m > 0 AND p.rear_unseen_m >= $ttc_s * greatest(0.0, unknown_speed_mps() - o.v_av_mps))
        -- If no vehicle was placed ahead and none was passed, this may be no overtake: a lane change, or a noisy position of a corner.
        AND (o.vbp_placed OR o.passed OR p.rear_ttc_s >= $ttc_s) AND NOT is_doubtful THEN or_never(p.rear_ttc_s, $ttc_s) END AS observed,
    CASE WHEN NOT o.begin_seen THEN why('overtake_begin_unseen') WHEN is_doubtful THEN overtake_doubt(o.vbp_id)
        WHEN NOT o.vbp_placed AND NOT o.passed THEN why('overtaken_unknown') END AS reason
FROM reference r
JOIN overtake o USING (drive_id, ego_id, occurrence)
LEFT JOIN overtake_place p USING (drive_id, ego_id, occurrence)
CROSS JOIN LATERAL (SELECT coalesce(p.rear_ttc_s < $ttc_s, false) AND may_be_no_overtake(o.status, o.sure) AS is_doubtful) doubt
