-- title = "Headlights at night"
-- breach = "No headlights at night"
-- clause = "UKHC R113: you must use headlights at night, except on a road with lit street lighting, which is generally one of 30 mph"
-- hypothesis = "At every step at night at which the ego moved, were its headlights on, or may the street have been lit?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- tags = ["excuses", "standing"]
-- reads = ["ego_condition", "ego_mode", "ego_state"]
-- requires = ["mode_headlights"]
--
-- [applies]
-- light = ["night"]
--
-- [params.lit_mps]
-- default = 13.42
-- unit = "m/s"
-- why = "30 mph: lamps excuse from headlights only on roads with no higher limit"
-- source = "UKHC R113"
--
-- [reasons.street_lamps_unknown]
-- says = "the headlights were off, and it is not known whether the street was lit"
--
-- [reasons.lamps_need_limit]
-- says = "the headlights were off: lit street lamps excuse that only under a low speed limit, and the limit is not known"

-- @condition
-- No table says whether street lamps are lit. Where they may be, or where the limit is not known, driving without headlights is not certain
-- to break the rule (see r115.dipped-headlights).
SELECT e.drive_id, e.ego_id, e.t_ns, e.speed_mps > standing_mps() AS applies,
    CASE WHEN m.is_on THEN true WHEN NOT m.is_on AND (coalesce(c.road_type, '') = 'motorway' OR c.limit_mps > $lit_mps) THEN false END AS holds,
    CASE WHEN m.is_on IS NULL THEN why('headlights_undeclared')
        WHEN m.is_on OR c.road_type = 'motorway' THEN NULL
        WHEN NOT m.is_on AND c.limit_mps <= $lit_mps THEN why('street_lamps_unknown')
        WHEN NOT m.is_on AND c.limit_mps IS NULL THEN why('lamps_need_limit') END AS reason
FROM ego_state e
LEFT JOIN ego_mode m ON m.drive_id = e.drive_id AND m.ego_id = e.ego_id AND m.t_ns = e.t_ns AND m.mode = 'headlights'
LEFT JOIN ego_condition c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.t_ns = e.t_ns
