-- title = "Turn across a safe gap"
-- clause = "UKHC R180: before turning right wait for a safe gap between you and any oncoming vehicle"
-- hypothesis = "When the ego turned across the oncoming traffic before somebody, did it leave enough time?"
-- kind = "execution"
-- derivation = "model"
-- severity = "critical"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "time until the oncoming vehicle came"
-- near_margin = 1.0
-- reads = ["junction_passage", "passage_conflict"]
-- requires = ["map", "registration", "ego_size"]
--
-- [params.pet_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: the two seconds that are also asked for when following"

-- @reference
SELECT p.drive_id, p.ego_id, p.t_in_ns AS t_ns, p.occurrence, p.across, c.object_id, c.reason,
    pet_known(c.pet_s, c.reason, $pet_s) AS pet_s
FROM junction_passage p
LEFT JOIN passage_conflict c ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id AND c.occurrence = p.occurrence AND c.relation = 'oncoming'
WHERE p.across IS DISTINCT FROM false

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, CASE WHEN across THEN pet_s END AS observed, $pet_s AS required,
    CASE WHEN across IS NULL THEN 'which way the ego turned, or the side of the road, is not known'
        WHEN pet_s IS NULL THEN reason END AS reason
FROM reference
