-- title = "Headlights at night on lit streets too"
-- breach = "No headlights at night on lit streets"
-- clause = "UKHC R115: at night in built-up areas, where street lighting may excuse from headlights, you should use dipped ones"
-- hypothesis = "At every step at night at which the ego moved on a street that may be lit, were its headlights on?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- tags = ["standing"]
-- reads = ["ego_condition", "ego_mode", "ego_state"]
-- requires = ["mode_headlights"]
--
-- [applies]
-- light = ["night"]
--
-- [params.lit_mps]
-- default = 13.42
-- unit = "m/s"
-- why = "30 mph: on roads with a higher limit, and on motorways, headlights are a must (r113.headlights)"
-- source = "UKHC R113"

-- @condition
SELECT e.drive_id, e.ego_id, e.t_ns, e.speed_mps > standing_mps() AND NOT coalesce(c.road_type = 'motorway' OR c.limit_mps > $lit_mps, false) AS applies, m.is_on AS holds,
    CASE WHEN m.is_on IS NULL THEN why('headlights_undeclared') END AS reason
FROM ego_state e
LEFT JOIN ego_mode m ON m.drive_id = e.drive_id AND m.ego_id = e.ego_id AND m.t_ns = e.t_ns AND m.mode = 'headlights'
LEFT JOIN ego_condition c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.t_ns = e.t_ns
