-- title = "Let people finish crossing on green"
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

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, on_id AS object_id, t_on_ns, known, coming_id, coming_known, state
FROM crossing_passage
WHERE coalesce(kind, 'signalled') = 'signalled'

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, state = 'green' AS applies,
    CASE WHEN object_id IS NOT NULL AND t_on_ns <= t_ns OR coming_id IS NOT NULL THEN false WHEN known AND coming_known THEN true END AS holds,
    CASE WHEN state IS NULL THEN 'the light''s state is not known: record it at every step'
        WHEN object_id IS NOT NULL AND t_on_ns <= t_ns THEN object_id || ' was on it'
        WHEN coming_id IS NOT NULL THEN coming_id || ' came over from the other half'
        WHEN NOT known THEN 'somebody nearby who may be on foot cannot be placed, or its class is not known'
        WHEN NOT coming_known THEN 'whether somebody on the other half came over, or was in the way of the ego''s side, is not known' END AS reason
FROM reference
