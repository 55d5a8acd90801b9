-- title = "Overtake with time to spare"
-- breach = "Overtook with little time to spare"
-- clause = "UKHC R162 (performance zones of Harper et al. 2021): overtake only with enough road, and use the road that there is"
-- hypothesis = "In the overtake as it was driven, would the spare distance ahead have lasted for at least half a second?"
-- kind = "execution"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "spare time"
-- reads = ["overtake", "overtake_sda"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [params.margin_s]
-- default = 0.5
-- unit = "s"
-- why = "zone A (unsafe) and B (less than this to spare) fail, C and D are kept"
-- source = "Harper et al. 2021, performance zones"
--
-- [reasons.spare_time_unknown]
-- says = "the spare time of the overtake as it was driven is not known[: {observed_doubt}]"
--
-- [reasons.no_profile_in_time]
-- says = "no profile would have had that much spare time; the spare time of the overtake as it was driven is not known[: {observed_doubt}]"

-- @reference
SELECT drive_id, ego_id, t0_ns AS t_ns, ov_id AS object_id, occurrence
FROM overtake
WHERE opposing IS DISTINCT FROM false

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, $margin_s AS required, bool_or(s.at_least) AS at_least,
    -- An overtake that was not completed has no pull-out and cut-in angles of its own, so the profile `observed` has no zone: the rule
    -- fails if no other profile would have left enough time.
    coalesce(
        max(s.spare_s) FILTER (s.profile = 'observed' AND s.zone IS NOT NULL),
        CASE WHEN bool_and(coalesce(s.zone IN ('A', 'B'), false)) FILTER (s.profile <> 'observed') THEN max(s.spare_s) END
    ) AS observed,
    -- The measure is the reason where there is one: what other profiles would have had is shown with the overtakes.
    CASE WHEN bool_or(s.profile = 'observed' AND s.zone IS NOT NULL) IS NOT true THEN why(
        CASE WHEN bool_and(coalesce(s.zone IN ('A', 'B'), false)) FILTER (s.profile <> 'observed')
            THEN 'no_profile_in_time' ELSE 'spare_time_unknown' END,
        {'observed_doubt': min(s.reason) FILTER (s.profile = 'observed' AND s.zone IS NULL)}
    ) END AS reason
FROM reference r
JOIN overtake_sda s USING (drive_id, ego_id, occurrence)
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id
