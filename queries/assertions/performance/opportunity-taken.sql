-- title = "Opportunities to overtake taken"
-- breach = "Opportunity to overtake not taken"
-- clause = "Harper et al. 2021, performance zones (zone D: overcautious if not taken): use the room to overtake that there is"
-- hypothesis = "While held up behind a slower vehicle, did the ego use every chance to overtake that would have left more than 2.5 s to spare?"
-- kind = "execution"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = "<="
-- unit = "s"
-- observes = "spare time of the opportunity passed up"
-- reads = ["opportunity", "profile"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [params.spare_s]
-- default = 2.5
-- unit = "s"
-- why = "beyond it begins zone D"
-- source = "Harper et al. 2021, performance zones"
--
-- [params.notice_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: an ego that is held up for less has hardly had time to see the opportunity"

-- @reference
-- This rule is a draft: `opportunity` does not say whether lines, signs and junctions allowed the overtake.
SELECT DISTINCT drive_id, ego_id, t_start_ns AS t_ns, object_id, occurrence FROM opportunity

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, p.profile, CASE WHEN o.taken THEN 0.0::DOUBLE ELSE o.spare_s END AS observed, $spare_s AS required,
    -- Opportunities are derived for every profile but `observed`, which is the ego's own overtake.
    p.profile <> 'observed' AND (o.taken OR o.t_end_ns - o.t_start_ns >= $notice_s * 1_000_000_000) AS applies
FROM reference r
CROSS JOIN (FROM profile WHERE selected) p
LEFT JOIN opportunity o ON o.drive_id = r.drive_id AND o.ego_id = r.ego_id AND o.occurrence = r.occurrence AND o.profile = p.profile
