-- title = "Not too fast while it moves"
-- clause = "none yet: name the rule and its paragraph first, then state in your own words what it demands"
-- hypothesis = "While the ego moved, was it no faster than it should be?"
-- kind = "invariant"            # judged at every step
-- derivation = "direct"         # or "model", where the rule judges by a model (of braking, for example), not by a recorded value alone
-- severity = "minor"            # critical | major | minor
-- legal = "should"              # must | should
-- status = "draft"              # only stable rules affect the exit code
-- sense = "<="                  # observed <= required must hold; or "holds", and a column of that name
-- unit = "m/s"
-- near_margin = 1.0             # kept by less than this: a near miss
-- observes = "speed"
-- reads = ["ego_state"]         # the tables of the SQL below
-- requires = []                 # the signals that the log must have: see drivelint inspect
--
-- [params.most_mps]             # every number of the rule is one of these, bound as $name
-- default = 20.0
-- unit = "m/s"
-- why = "an example: state the source of the number, or that it is your own"
-- source = ""

-- @applies
-- where it must be judged; true, false, or NULL where that is not known. Without this section: at every step
SELECT drive_id, ego_id, t_ns, speed_mps > standing_mps() AS applies
FROM ego_state

-- @condition
-- NULL is unknown and makes the verdict unknown; a step that a join loses is unknown too, never a pass
SELECT drive_id, ego_id, t_ns, speed_mps AS observed, $most_mps AS required
FROM ego_state
