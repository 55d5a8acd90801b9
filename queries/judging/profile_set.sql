-- Per subject the profiles asked for and those that the condition returns, or ''.
INSERT INTO _profile_set BY NAME
WITH {condition}, _profile_of_subject AS (
    SELECT s.drive_id, s.ego_id, p.profile FROM _subject s CROSS JOIN (SELECT profile FROM profile WHERE selected) p
    UNION SELECT drive_id, ego_id, profile FROM _state WHERE profile IS NOT NULL)
SELECT $_no AS rule_no, drive_id, ego_id, profile FROM _profile_of_subject UNION ALL
SELECT $_no, s.drive_id, s.ego_id, '' FROM _subject s ANTI JOIN _profile_of_subject k ON s.drive_id = k.drive_id AND s.ego_id = k.ego_id
