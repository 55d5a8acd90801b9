-- title = "Give way to people on a zebra crossing"
-- breach = "Did not give way to people on a zebra crossing"
-- clause = "UKHC R195: you must give way when a pedestrian has moved onto a zebra crossing; one with an island is two"
-- hypothesis = "When the ego's front came onto the zebra crossing, was nobody on foot on that half of it?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["crossing_passage"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way onto the crossing: begin recording before it"
--
-- [reasons.was_on_crossing_of_unknown_kind]
-- says = "{object_id} was on it; the map does not state the kind of the crossing"
--
-- [reasons.came_over_maybe_island]
-- says = "{object_id} came over from the other half: it is not known whether an island divides the crossing"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, crossing_id, kind, on_id AS object_id, t_on_ns, known, coming_id, coming_known
FROM crossing_passage
WHERE coalesce(kind, 'zebra') = 'zebra'

-- @condition
-- The ego need not give way to a person who steps onto the crossing when the ego is already on it.
SELECT drive_id, ego_id, t_ns, ref_id,
    CASE WHEN object_id IS NOT NULL AND t_on_ns < t_ns THEN CASE WHEN kind = 'zebra' THEN false END
        WHEN object_id IS NOT NULL AND t_on_ns = t_ns THEN NULL
        -- The map tables have no islands: if a person comes from the other half, it is not known whether the ego had to give way.
        WHEN known AND coming_known AND coming_id IS NULL THEN true END AS holds,
    CASE WHEN object_id IS NOT NULL AND t_on_ns = t_ns THEN why('came_at_same_step', {'object_id': object_id})
        WHEN object_id IS NOT NULL AND t_on_ns < t_ns
        THEN why(CASE WHEN kind IS NULL THEN 'was_on_crossing_of_unknown_kind' ELSE 'was_on_crossing' END, {'object_id': object_id})
        WHEN NOT known THEN why('person_unplaced')
        WHEN coming_id IS NOT NULL THEN why('came_over_maybe_island', {'object_id': coming_id})
        WHEN NOT coming_known THEN why('other_half_unknown') END AS reason
FROM reference
