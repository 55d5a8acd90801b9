-- title = "Headlights at night"
-- clause = "UKHC R113 and R115: you must use headlights at night, and should where street lighting would excuse it"
-- hypothesis = "At every step at night at which the ego moved, were its headlights on?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["ego_mode", "ego_state"]
-- requires = ["mode_headlights"]
--
-- [applies]
-- light = ["night"]

-- @condition
SELECT e.drive_id, e.ego_id, e.t_ns, e.speed_mps > standing_mps() AS applies, m.is_on AS holds,
    CASE WHEN m.is_on IS NULL THEN 'the log has not yet said whether the headlights are on' END AS reason
FROM ego_state e
LEFT JOIN ego_mode m ON m.drive_id = e.drive_id AND m.ego_id = e.ego_id AND m.t_ns = e.t_ns AND m.mode = 'headlights'
