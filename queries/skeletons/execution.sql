-- title = "Not too fast when it leaves its lane"
-- clause = "none yet: name the rule and its paragraph first, then state in your own words what it demands"
-- hypothesis = "When the ego crossed the boundary of its lane, was it no faster than it should be?"
-- kind = "execution"            # judged at the moment of each reference point
-- derivation = "direct"         # or "model", where the rule judges by a model (of braking, for example), not by a recorded value alone
-- severity = "minor"            # critical | major | minor
-- legal = "should"              # must | should
-- status = "draft"              # only stable rules affect the exit code
-- sense = "<="                  # observed <= required must hold; or "holds", and a column of that name
-- unit = "m/s"
-- near_margin = 1.0             # kept by less than this: a near miss
-- observes = "speed"
-- reads = ["ego_state", "lane_departure"]   # the tables of the SQL below
-- requires = ["map", "registration"]        # the signals that the log must have: see drivelint inspect
--
-- [params.most_mps]             # every number of the rule is one of these, bound as $name
-- default = 20.0
-- unit = "m/s"
-- why = "an example: state the source of the number, or that it is your own"
-- source = ""

-- @reference
-- one row per occasion; none: the rule does not apply to this drive
SELECT drive_id, ego_id, t_ns, begin_seen
FROM lane_departure
WHERE NOT back

-- @condition
-- NULL is unknown and makes the verdict unknown; an occasion that a join loses is unknown too, never a pass
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, $most_mps AS required,
    CASE WHEN r.begin_seen THEN e.speed_mps END AS observed
FROM reference r
JOIN ego_state e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns = r.t_ns
