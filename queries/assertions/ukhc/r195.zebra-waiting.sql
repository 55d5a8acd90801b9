-- # Draft: whether a person who stands at the kerb wants to cross is a judgement.
-- title = "Give way to people waiting at a zebra crossing"
-- breach = "Did not give way to people waiting at a zebra crossing"
-- clause = "UKHC R195: you should give way to pedestrians waiting to cross at a zebra crossing"
-- hypothesis = "When the ego's front came onto the zebra crossing, had nobody been standing at its end?"
-- kind = "execution"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- reads = ["crossing_passage"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way onto the crossing: begin recording before it"
--
-- [reasons.stood_at_end]
-- says = "{object_id} stood at the end of the crossing"
--
-- [reasons.stood_at_end_of_unknown_kind]
-- says = "{object_id} stood at the end of the crossing; the map does not state the kind of the crossing"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, crossing_id, kind, waiting_id AS object_id, known AND waiting_known AS known
FROM crossing_passage
WHERE coalesce(kind, 'zebra') = 'zebra'

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id,
    CASE WHEN object_id IS NOT NULL THEN CASE WHEN kind = 'zebra' THEN false END WHEN known THEN true END AS holds,
    CASE WHEN object_id IS NOT NULL
        THEN why(CASE WHEN kind IS NULL THEN 'stood_at_end_of_unknown_kind' ELSE 'stood_at_end' END, {'object_id': object_id})
        WHEN NOT known THEN why('person_unplaced') END AS reason
FROM reference
