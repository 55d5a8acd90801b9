-- title = "Back before the line becomes solid"
-- breach = "Not back before the line became solid"
-- clause = "UKHC R128: where the middle line nearer to you is broken you may cross it to overtake if you can finish before a solid line on your side begins"
-- hypothesis = "When the ego had crossed a line that it may cross, was it back before the line became solid on its side?"
-- kind = "postcondition"
-- subtype = "physical"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["line_step", "overtake"]
-- requires = ["map", "registration", "handedness", "markings", "ego_size"]
-- without_anchor = "the log does not show the ego back in its lane: record it until it is"
--
-- [reasons.no_lane_beyond_line]
-- says = "the map has no lane beyond the line, which may be the edge of the road"
-- advice = "use a map with the lanes of both directions"
--
-- [reasons.solid_overtake_unsure]
-- says = "the line was solid, but it is not sure whether the ego overtook"
-- advice = "record all vehicles from before the ego leaves its lane until it is back in it"
--
-- [reasons.solid_crossing_unseen]
-- says = "the log does not show the ego crossing the line; the line was solid while the ego was over it"

-- @reference
SELECT o.drive_id, o.ego_id, o.t0_ns AS t_ns, max(o.vbp_id) AS object_id, bool_or(o.sure) AS sure, o.begin_seen, o.t3_ns, o.t_end_ns, o.opposing, CASE o.side WHEN 1 THEN 'left' ELSE 'right' END AS side
FROM overtake o
LEFT JOIN line_step l ON l.drive_id = o.drive_id AND l.ego_id = o.ego_id AND l.t_ns = o.t0_ns AND l.side = CASE o.side WHEN 1 THEN 'left' ELSE 'right' END
-- A line that is solid at t0 is judged by r129.no-cross-solid, unless the beginning of the overtake was not seen.
WHERE o.opposing IS DISTINCT FROM false AND (l.forbidden IS DISTINCT FROM true OR NOT o.begin_seen)
GROUP BY o.drive_id, o.ego_id, o.t0_ns, o.begin_seen, o.t3_ns, o.t_end_ns, o.opposing, o.side

-- @anchor
-- The anchor is the step at which the line becomes solid under the ego, else the step at which the ego is back.
SELECT r.ref_id, coalesce(min(l.t_ns) FILTER (l.forbidden AND l.passing_id IS NULL AND l.passing_known), r.t3_ns) AS t_ns
FROM reference r
LEFT JOIN line_step l ON l.drive_id = r.drive_id AND l.ego_id = r.ego_id AND l.side = r.side AND l.t_ns >= r.t_ns AND l.t_ns <= r.t_end_ns
GROUP BY r.ref_id, r.t3_ns

-- @condition
WITH step_over_line AS (
    SELECT drive_id, ego_id, t_ns, side, forbidden AND CASE WHEN passing_id IS NOT NULL THEN false WHEN passing_known THEN true END AS is_solid FROM line_step
)
SELECT r.drive_id, r.ego_id, coalesce(min(l.t_ns) FILTER (l.is_solid), r.t3_ns) AS t_ns, r.ref_id,
    CASE
        -- If the map has no lane beyond the line, the line may be the edge of the road.
        WHEN r.opposing IS NULL THEN NULL
        -- A line that is solid when it is first seen may already have been solid when the ego crossed it, if the ego crossed it at all.
        WHEN bool_or(l.is_solid) THEN CASE WHEN r.sure AND (r.begin_seen OR min(l.t_ns) FILTER (NOT l.is_solid) < min(l.t_ns) FILTER (l.is_solid)) THEN false END
        WHEN count(l.t_ns) > 0 AND count(l.t_ns) = count(l.is_solid) THEN true
    END AS holds,
    CASE WHEN r.opposing IS NULL THEN why('no_lane_beyond_line')
        WHEN bool_or(l.is_solid) AND NOT r.sure THEN why('solid_overtake_unsure')
        WHEN bool_or(l.is_solid) AND NOT r.begin_seen THEN why('solid_crossing_unseen') END AS reason
FROM reference r
LEFT JOIN step_over_line l ON l.drive_id = r.drive_id AND l.ego_id = r.ego_id AND l.side = r.side AND l.t_ns >= r.t_ns AND l.t_ns <= r.t_end_ns
GROUP BY r.drive_id, r.ego_id, r.ref_id, r.sure, r.begin_seen, r.t3_ns, r.opposing
