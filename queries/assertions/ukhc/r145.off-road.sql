-- title = "Not on the footway"
-- breach = "On the footway"
-- clause = "UKHC R145: you must not drive on or over a pavement, footpath or bridleway, except to reach property or in an emergency"
-- hypothesis = "At every step, was the ego's outline off every footway, or may it have been on its way to property, or in an emergency?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "<="
-- unit = "m"
-- observes = "reach onto the footway"
-- merge_gap_s = 2.0
-- tags = ["excuses", "standing"]
-- reads = ["ego_footway", "ego_mode", "ego_state"]
-- requires = ["map", "registration", "lane_types", "ego_size"]
--
-- [params.tolerance_m]
-- default = 0.05
-- unit = "m"
-- why = "our default: the noise of registration, as for lane boundaries"
--
-- [params.access_mps]
-- default = 4.47
-- unit = "m/s"
-- why = "our default: at 10 mph and less a vehicle crosses the footway to reach property; faster it has left the road"
--
-- [reasons.partly_off_map]
-- says = "part of the ego is on ground that the map does not have"
--
-- [reasons.may_be_access]
-- says = "slowly over the footway, from or to ground that the map does not have; it may be private property with access over the footway"
--
-- [reasons.may_be_emergency]
-- says = "on the footway while an emergency manoeuvre was declared"
-- advice = "see in a video whether that was an emergency"

-- @condition
-- Ground that the map does not have may be property: an ego that comes from there slowly, or goes there, may cross the footway to get
-- access.
WITH footway_step AS (
    SELECT f.drive_id, f.ego_id, f.t_ns, f.depth_m, coalesce(f.depth_m > $tolerance_m, false) AS is_on_footway,
        f.depth_m IS NULL AND e.x_m IS NOT NULL AS is_beyond_map, coalesce(e.speed_mps <= $access_mps, true) AS is_slow
    FROM ego_footway f
    LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
),
-- The steps of a stretch on the footway have the number of the last step before the stretch. The first step after it has the next number.
numbered_step AS (
    SELECT *, count(CASE WHEN NOT is_on_footway THEN 1 END) OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS stretch_no FROM footway_step
),
footway_stretch AS (
    SELECT n.drive_id, n.ego_id, n.stretch_no, bool_and(n.is_slow) AND count(b.stretch_no) > 0 AS may_be_access
    FROM numbered_step n
    LEFT JOIN (
        SELECT drive_id, ego_id, stretch_no FROM numbered_step WHERE is_beyond_map
        UNION ALL
        SELECT drive_id, ego_id, stretch_no - 1 FROM numbered_step WHERE is_beyond_map
    ) b ON b.drive_id = n.drive_id AND b.ego_id = n.ego_id AND b.stretch_no = n.stretch_no
    WHERE n.is_on_footway
    GROUP BY n.drive_id, n.ego_id, n.stretch_no
)
SELECT n.drive_id, n.ego_id, n.t_ns, n.depth_m AS observed, CASE WHEN NOT coalesce(s.may_be_access OR n.is_on_footway AND x.t_ns IS NOT NULL, false) THEN $tolerance_m END AS required,
    CASE WHEN n.depth_m IS NULL THEN why('partly_off_map')
        WHEN n.is_on_footway AND x.t_ns IS NOT NULL THEN why('may_be_emergency')
        WHEN s.may_be_access THEN why('may_be_access') END AS reason
FROM numbered_step n
LEFT JOIN footway_stretch s ON s.drive_id = n.drive_id AND s.ego_id = n.ego_id AND s.stretch_no = CASE WHEN n.is_on_footway THEN n.stretch_no END
LEFT JOIN (
    SELECT DISTINCT drive_id, ego_id, t_ns FROM ego_mode WHERE mode IN ('minimal_risk_manoeuvre', 'emergency_manoeuvre') AND is_on
) x ON x.drive_id = n.drive_id AND x.ego_id = n.ego_id AND x.t_ns = n.t_ns
