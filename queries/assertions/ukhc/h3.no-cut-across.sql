-- title = "Do not cut across cyclists and horses"
-- breach = "Cut across a cyclist or a horse"
-- clause = "UKHC H3 and R182: do not cut across cyclists or horses going ahead when you turn"
-- hypothesis = "When the ego turned before a cyclist or horse ahead of it, beside it or coming towards it, did it leave enough time and make nobody brake?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "critical"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["junction_passage", "passage_conflict", "road_user"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way into the junction: begin recording before it"
--
-- [params.pet_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: the two seconds that are also demanded when following"
--
-- [params.decel_mps2]
-- default = 1.5
-- unit = "m/s2"
-- why = "our default: a cyclist who brakes harder than this was forced to brake"

-- @reference
WITH encounter AS (
    SELECT p.drive_id, p.ego_id, p.t_in_ns, p.occurrence, p.turn, at_fork(p.turn, p.turn_rad, p.straightest_rad) AS is_at_fork, r.relation, c.object_id, c.actor_class, c.decel_mps2, c.reason, b.actor_class AS braked_class,
        made_to_brake(c.braked_mps2, c.braked_pet_s, c.braked_cause, $decel_mps2, $pet_s) AS is_forced,
        braked_reason(c.braked_id, c.braked_pet_s, c.braked_mps2, c.braked_cause) AS braked_reason,
        pet_known(c.pet_s, c.reason, $pet_s, true) AS pet_s
    FROM junction_passage p
    CROSS JOIN (VALUES ('ahead_going'), ('oncoming')) AS r(relation)
    LEFT JOIN passage_conflict c ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id AND c.occurrence = p.occurrence AND c.relation = r.relation
    LEFT JOIN road_user b ON b.drive_id = p.drive_id AND b.actor_id = c.braked_id
    WHERE p.turn IS DISTINCT FROM 'straight' OR at_fork(p.turn, p.turn_rad, p.straightest_rad)
),
judged_encounter AS (
    SELECT
        *,
        -- The conflict with the least PET may be with another vehicle and hide a later cyclist. Then the rule can be shown to be kept, but
        -- not to be broken.
        CASE WHEN turn IS NULL THEN NULL
            WHEN is_forced AND braked_class IN ('bicycle', 'animal') THEN CASE WHEN NOT is_at_fork THEN false END
            -- An actor that came late enough and braked hard may have braked for something else, if the ego did not make it brake.
            WHEN actor_class IN ('bicycle', 'animal') OR pet_s >= $pet_s
            THEN pet_s >= $pet_s AND CASE WHEN decel_mps2 <= $decel_mps2 THEN true END AND CASE WHEN NOT is_forced THEN true END OR CASE WHEN NOT is_at_fork THEN false END END AS kept,
        CASE WHEN turn IS NULL THEN why('turn_unseen')
            WHEN is_at_fork AND object_id IS NOT NULL AND kept IS NULL THEN fork_doubt()
            WHEN is_forced IS DISTINCT FROM false THEN braked_reason
            ELSE coalesce(braking_doubt(object_id, pet_s, decel_mps2, $decel_mps2, $pet_s), met_reason(object_id, pet_s, decel_mps2), reason) END AS reason_given
    FROM encounter
)
-- Of the two relations, along the ego's way and towards it, the worse one counts.
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, worst.object_id AS object_id, worst.kept AS kept, worst.reason AS reason
FROM (
    SELECT drive_id, ego_id, t_in_ns, occurrence, min({
            'rank': CASE WHEN NOT kept THEN 0 WHEN kept IS NULL THEN 1 ELSE 2 END, 'nobody': object_id IS NULL, 'relation': relation,
            'object_id': object_id, 'kept': kept, 'reason': reason_given
        }) AS worst
    FROM judged_encounter
    GROUP BY drive_id, ego_id, t_in_ns, occurrence
)

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, kept AS holds, reason
FROM reference
