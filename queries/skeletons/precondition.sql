-- title = "Slow enough before it leaves its lane"
-- clause = "none yet: name the rule and its paragraph first, then state in your own words what it demands"
-- hypothesis = "Throughout the seconds before the ego crossed the boundary of its lane, was it no faster than it should be?"
-- kind = "precondition"         # judged before each reference point
-- subtype = "temporal"          # in a window of time; "physical": at places or times from a section @anchor
-- window_s = "window_s"         # a number of seconds, or the parameter with it
-- quantifier = "always"         # or "eventually": once in the window is enough
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
-- [params.window_s]             # every number of the rule is one of these, bound as $name
-- default = 2.0
-- unit = "s"
-- why = "an example: state the source of the number, or that it is your own"
-- source = ""
--
-- [params.most_mps]
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
-- reference_step: the steps of each occasion's window, from the engine. NULL is unknown, and so is a step that a join loses
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, $most_mps AS required,
    CASE WHEN r.begin_seen THEN e.speed_mps END AS observed
FROM reference_step s
JOIN reference r USING (ref_id)
JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
