-- title = "Give way to pedestrians when turning"
-- breach = "Did not give way to pedestrians when turning"
-- clause = "UKHC H2 and R170: at a junction give way to people on foot who cross the road that you turn into or out of"
-- hypothesis = "When the ego turned into a road, or out of one, before a pedestrian, was there time for both?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "critical"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "time until the walker came"
-- near_margin = 1.0
-- reads = ["junction_passage", "passage_conflict"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way into the junction: begin recording before it"
--
-- [params.pet_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: a person who gets there sooner was crossing, or about to cross, when the ego went"
--
-- [params.decel_mps2]
-- default = 1.5
-- unit = "m/s2"
-- why = "our default: a walker who stops within a second brakes this hard"

-- @reference
SELECT p.drive_id, p.ego_id, p.t_in_ns AS t_ns, p.occurrence, p.turn, at_fork(p.turn, p.turn_rad, p.straightest_rad) AS fork, c.object_id,
    -- A pedestrian may have stopped for another reason than the ego, such as having arrived, which no log shows: so `on_foot` is always given
    -- as another possible cause of the braking.
    made_to_brake(c.braked_mps2, c.braked_pet_s, 'on_foot', $decel_mps2, $pet_s) AS forced,
    CASE WHEN forced IS NULL THEN braked_reason(c.braked_id, c.braked_pet_s, c.braked_mps2, c.braked_cause) ELSE coalesce(c.reason, class_doubt(c.object_id)) END AS reason,
    pet_forced(pet_known(c.pet_s, c.reason, $pet_s, is_class(c.actor_class, 'pedestrian')), forced, c.braked_pet_s, $pet_s) AS pet_s
FROM junction_passage p
LEFT JOIN passage_conflict c ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id AND c.occurrence = p.occurrence AND c.relation = 'pedestrian'
WHERE p.turn IS DISTINCT FROM 'straight' OR at_fork(p.turn, p.turn_rad, p.straightest_rad)

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, CASE WHEN turn IS NOT NULL AND NOT (fork AND pet_s < $pet_s) THEN pet_s END AS observed, $pet_s AS required,
    CASE WHEN turn IS NULL THEN why('turn_unseen')
        WHEN fork AND pet_s < $pet_s THEN fork_doubt()
        WHEN pet_s IS NULL THEN reason END AS reason
FROM reference
