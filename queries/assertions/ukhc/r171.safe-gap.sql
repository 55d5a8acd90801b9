-- # Draft: a deceleration on the major road may have another cause than the ego.
-- title = "Safe gap when going from a stop sign"
-- breach = "Went from a stop sign into too small a gap"
-- clause = "UKHC R171: after stopping, wait for a safe gap in the traffic before moving off"
-- hypothesis = "When the ego went from a stop sign before somebody on the other road, did it leave enough time and make nobody brake?"
-- kind = "execution"
-- derivation = "model"
-- severity = "critical"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- reads = ["junction_passage", "passage_conflict"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way into the junction: begin recording before it"
--
-- [params.pet_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: the two seconds that are also demanded when following"
--
-- [params.decel_mps2]
-- default = 2.0
-- unit = "m/s2"
-- why = "our default: a vehicle that brakes harder than this was forced to brake"

-- @reference
SELECT p.drive_id, p.ego_id, p.t_in_ns AS t_ns, p.occurrence, p.control, c.relation, c.reason,
    c.decel_mps2, c.braked_id, c.braked_pet_s, c.braked_mps2, c.braked_cause, made_to_brake(c.braked_mps2, c.braked_pet_s, c.braked_cause, $decel_mps2, $pet_s) AS forced,
    CASE WHEN forced THEN c.braked_id ELSE c.object_id END AS object_id,
    pet_known(c.pet_s, c.reason, $pet_s, is_vehicle(c.actor_class)) AS pet_s
FROM junction_passage p
LEFT JOIN passage_conflict c ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id AND c.occurrence = p.occurrence
    AND c.relation IN ('from_left', 'from_right')
WHERE coalesce(p.control, 'stop') = 'stop'

-- @condition
-- An actor that came late enough and braked hard may have braked for something else, if the ego did not make it brake.
SELECT drive_id, ego_id, t_ns, ref_id, CASE WHEN control IS NOT NULL THEN pet_s >= $pet_s AND CASE WHEN decel_mps2 <= $decel_mps2 THEN true END AND NOT forced END AS holds,
    CASE WHEN control IS NULL THEN why('way_in_control_unknown')
        WHEN forced IS DISTINCT FROM false THEN braked_reason(braked_id, braked_pet_s, braked_mps2, braked_cause)
        ELSE coalesce(braking_doubt(object_id, pet_s, decel_mps2, $decel_mps2, $pet_s), met_reason(object_id, pet_s, decel_mps2), reason) END AS reason
FROM reference
