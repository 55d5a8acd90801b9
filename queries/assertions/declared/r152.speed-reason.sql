-- title = "A reason for every chosen speed"
-- breach = "A chosen speed without a reason"
-- clause = "UKHC R125, R152: suit the speed to the road, the weather, and who may be there"
-- hypothesis = "Did every declared choice of speed name its reason?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["declared_event"]
-- requires = ["declared_events"]

-- @reference
SELECT drive_id, actor_id AS ego_id, t_ns, value
FROM declared_event
WHERE event = 'chosen_speed'

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id,
    CASE WHEN value IS NOT NULL THEN TRY_CAST(split_part(value, ';', 1) AS DOUBLE) IS NOT NULL AND trim(split_part(value, ';', 2)) <> '' END AS holds
FROM reference
