-- title = "Give way to people on a zebra crossing"
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

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, crossing_id, kind, on_id AS object_id, t_on_ns, known, coming_id, coming_known
FROM crossing_passage
WHERE coalesce(kind, 'zebra') = 'zebra'

-- @condition
-- A person who steps onto the crossing when the ego is already on it has not been refused.
SELECT drive_id, ego_id, t_ns, ref_id,
    CASE WHEN object_id IS NOT NULL AND t_on_ns <= t_ns THEN CASE WHEN kind = 'zebra' THEN false END
        -- The map tables have no islands: if somebody comes from the other half, it is not known whether the ego had to give way.
        WHEN known AND coming_known AND coming_id IS NULL THEN true END AS holds,
    CASE WHEN object_id IS NOT NULL AND t_on_ns <= t_ns
        THEN object_id || ' was on it' || CASE WHEN kind IS NULL THEN '; the map does not say what kind of crossing it is' ELSE '' END
        WHEN NOT known THEN 'somebody nearby who may be on foot cannot be placed, or its class is not known'
        WHEN coming_id IS NOT NULL THEN coming_id || ' came over from the other half: whether an island parts the crossing is not known'
        WHEN NOT coming_known THEN 'whether somebody on the other half came over, or was in the way of the ego''s side, is not known' END AS reason
FROM reference
