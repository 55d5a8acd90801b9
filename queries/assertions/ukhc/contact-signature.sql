-- title = "No impact-like change of speed"
-- breach = "Speed changed as in an impact"
-- clause = "UKHC R144: do not drive dangerously or without care for others; a contact that the boxes miss shows in the speeds"
-- hypothesis = "While another actor was within reach, did the ego and that actor lose or gain speed no faster than tyres can?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = "<"
-- unit = "m/s2"
-- observes = "change of speed of the ego or the other"
-- merge_gap_s = 1.0
-- tags = ["contact", "standing"]
-- reads = ["before_track", "between_steps", "ego_state", "hidden", "lost_object", "pair", "step", "clock"]
-- requires = ["ego_size", "speeds"]
--
-- [params.within_m]
-- default = 0.5
-- unit = "m"
-- why = "our default: recorded boxes are a little smaller than the vehicles, and the two move on between two steps; both together are about this much"
--
-- [params.tyre_mps2]
-- default = 12.0
-- unit = "m/s2"
-- why = "dry tyres give about 10; our default leaves room for noise of one backward difference"
--
-- [params.jolt_s]
-- default = 0.1
-- unit = "s"
-- why = "our default: an impact lasts this long; over a longer step, its loss of speed looks like braking"
--
-- [params.walk_mps]
-- default = 3.0
-- unit = "m/s"
-- why = "our default: a pedestrian walks at 2 m/s at most, but recorded speeds of pedestrians jump; a gain of speed counts only above this speed, which even a person in a hurry does not reach"
--
-- [reasons.close_between_samples]
-- says = "object {object_id} came close between two samples"
--
-- [reasons.close_after_hole]
-- says = "object {object_id} is close to the ego at the end of a hole in the log"
--
-- [reasons.close_before_track]
-- says = "object {object_id} is first seen here, going away from the ego: back at these speeds, it was close to the ego less than half a second before"
--
-- [reasons.stood_still]
-- says = "the ego stood still: if there was a contact, the other actor hit the ego"
--
-- [reasons.ego_braking_unknown]
-- says = "the ego's braking is not known here, because its speed just before is missing"
-- advice = "begin recording earlier"
--
-- [reasons.object_braking_unknown]
-- says = "the braking of object {object_id} is not known here, because its speed just before is missing"
-- advice = "begin recording earlier"
--
-- [reasons.step_too_long]
-- says = "a step of {step_s:.2f} s is too long to distinguish an impact from braking"

-- @applies
SELECT drive_id, ego_id, t_ns, object_id, CASE WHEN clearance_m IS NOT NULL THEN true END AS applies, NULL AS reason
FROM pair
WHERE clearance_m IS NULL OR clearance_m <= $within_m
UNION ALL
-- An actor whose track ends close by, or on a way that may lead to the ego, may have touched the ego unseen: each such actor adds one step, whose result is not known.
SELECT l.drive_id, l.ego_id, s.t_ns, l.object_id, NULL,
    why('recorded_too_short', {'object_id': l.object_id, 'to_ns': last.t_ns, 'far_m': CASE WHEN p.clearance_is_bound THEN p.distance_m ELSE coalesce(p.clearance_m, p.distance_m) END, 'ego_to_ns': c.t_end_ns})
FROM lost_object l
JOIN clock c USING (drive_id, ego_id)
ASOF JOIN step s ON s.drive_id = l.drive_id AND s.ego_id = l.ego_id AND l.t_from_ns <= s.t_ns
CROSS JOIN LATERAL (SELECT l.t_from_ns - 1 AS t_ns) last
LEFT JOIN pair p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.object_id = l.object_id AND p.t_ns = last.t_ns
LEFT JOIN (SELECT drive_id, ego_id, object_id, max(t_ns) AS t_ns FROM hidden WHERE least_m <= 0 GROUP BY ALL) h ON h.drive_id = l.drive_id AND h.ego_id = l.ego_id AND h.object_id = l.object_id
WHERE l.code IN ('lost_near_ego', 'lost_on_road') OR h.t_ns >= l.t_from_ns
UNION ALL
-- An actor that came near between two steps may have touched the ego, too.
SELECT drive_id, ego_id, t_next_ns, object_id, NULL, why('close_between_samples', {'object_id': object_id}) FROM between_steps
UNION ALL
-- An actor that is close by when a hole of the log ends may have touched the ego during the hole.
SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, NULL, why('close_after_hole', {'object_id': p.object_id})
FROM step s
JOIN clock c USING (drive_id, ego_id)
JOIN pair p USING (drive_id, ego_id, t_ns)
WHERE s.dt_ns > c.max_gap_ns AND p.clearance_m < lost_near_m()
UNION ALL
-- An actor that is first seen while it goes away from the ego may have touched the ego just before.
SELECT drive_id, ego_id, t_ns, object_id, NULL, why('close_before_track', {'object_id': object_id}) FROM before_track WHERE least_m <= $within_m

-- @condition
-- greatest() ignores NULL: the acceleration of one of the two can show a contact, but not that there was none. Nor can a step show that
-- there was none if it is so long that it may hide a jolt.
SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, $tyre_mps2 AS required,
    CASE WHEN jolt_mps2 >= $tyre_mps2 OR p.accel_mps2 + e.accel_mps2 IS NOT NULL AND NOT coalesce(may_hide_jolt, false) THEN jolt_mps2 END AS observed,
    CASE WHEN other_mps2 >= $tyre_mps2 AND e.fastest_3s_mps < standing_mps() THEN why('stood_still')
        WHEN (jolt_mps2 >= $tyre_mps2) IS DISTINCT FROM true AND (e.accel_mps2 IS NULL AND e.speed_mps IS NOT NULL OR p.accel_mps2 IS NULL AND p.speed_mps IS NOT NULL)
            THEN CASE WHEN e.accel_mps2 IS NULL THEN why('ego_braking_unknown') ELSE why('object_braking_unknown', {'object_id': p.object_id}) END
        WHEN may_hide_jolt AND jolt_mps2 < $tyre_mps2 THEN why('step_too_long', {'step_s': st.dt_ns / 1e9}) END AS reason
FROM pair p
JOIN ego_state e USING (drive_id, ego_id, t_ns)
JOIN step st USING (drive_id, ego_id, t_ns)
-- An impact from behind, or with a pedestrian, adds speed to the object.
CROSS JOIN LATERAL (SELECT greatest(-p.accel_mps2, CASE WHEN NOT may_walk(p.actor_class) OR p.speed_mps > $walk_mps THEN p.accel_mps2 END) AS other_mps2) object_motion
CROSS JOIN LATERAL (SELECT greatest(other_mps2, abs(e.accel_mps2)) AS jolt_mps2) jolt
CROSS JOIN LATERAL (SELECT st.dt_ns > $jolt_s * 1.5e9 AND jolt_mps2 * st.dt_ns / 1e9 >= $tyre_mps2 * $jolt_s AS may_hide_jolt) step_length
