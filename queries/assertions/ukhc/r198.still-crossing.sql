-- title = "Let people finish crossing on green"
-- breach = "Did not let people finish crossing on green"
-- clause = "UKHC R198: give way to anyone still crossing after the light for vehicles has turned green"
-- hypothesis = "When the ego went onto the signalled crossing on green, was nobody on foot on its half, or about to come onto it?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["crossing_passage"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way onto the crossing: begin recording before it"
--
-- [reasons.came_over]
-- says = "{object_id} came over from the other half"
--
-- [reasons.crossing_kind_unknown]
-- says = "the map states neither the kind of the crossing nor a light for it"
-- advice = "use a map with the kinds of its crossings, and their lights"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, on_id AS object_id, t_on_ns, known, coming_id, coming_known, kind, state
FROM crossing_passage
WHERE coalesce(kind, 'signalled') = 'signalled'

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, state = 'green' AS applies,
    CASE WHEN object_id IS NOT NULL AND t_on_ns < t_ns OR coming_id IS NOT NULL THEN false WHEN object_id IS NOT NULL AND t_on_ns = t_ns THEN NULL WHEN known AND coming_known THEN true END AS holds,
    CASE WHEN state IS NULL THEN why(CASE WHEN kind IS NULL THEN 'crossing_kind_unknown' ELSE 'light_state_unknown' END)
        WHEN object_id IS NOT NULL AND t_on_ns < t_ns THEN why('was_on_crossing', {'object_id': object_id})
        WHEN coming_id IS NOT NULL THEN why('came_over', {'object_id': coming_id})
        WHEN object_id IS NOT NULL AND t_on_ns = t_ns THEN why('came_at_same_step', {'object_id': object_id})
        WHEN NOT known THEN why('person_unplaced')
        WHEN NOT coming_known THEN why('other_half_unknown') END AS reason
FROM reference
