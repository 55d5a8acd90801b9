-- The law of one nation says nothing about a drive in another; where the nation is not known, it is judged.
CREATE OR REPLACE TEMP TABLE _foreign AS
SELECT r.rule_no, n.drive_id, n.ego_id
FROM (SELECT DISTINCT rule_no FROM _law) r
CROSS JOIN (SELECT DISTINCT drive_id, ego_id, nation FROM ego_condition) n
LEFT JOIN _law l ON l.rule_no = r.rule_no AND l.nation = n.nation
GROUP BY ALL
HAVING bool_and(n.nation IS NOT NULL AND l.nation IS NULL);

-- The first of a rule's required signals that the log cannot give. A signal without a row in `capability` counts as missing, if it is
-- not one that a log is taken to have.
CREATE OR REPLACE TEMP TABLE _gated AS
SELECT rule_no, drive_id, ego_id, first.signal AS signal, first.reason AS reason FROM (
    SELECT n.rule_no, s.drive_id, s.ego_id,
        min({'pos': n.pos, 'signal': n.signal,
            'reason': coalesce(c.reason, why('nothing_known', {'signal': n.signal}))}) AS first
    FROM _needs n CROSS JOIN _subject s
    LEFT JOIN capability c ON c.drive_id = s.drive_id AND c.ego_id = s.ego_id AND c.signal = n.signal
    WHERE coalesce(c.available, n.is_assumed) IS DISTINCT FROM true
    GROUP BY ALL) g
ANTI JOIN _foreign f ON f.rule_no = g.rule_no AND f.drive_id = g.drive_id AND f.ego_id = g.ego_id;

-- The subjects for which a rule is to be run.
CREATE OR REPLACE TEMP TABLE _todo AS
SELECT r.rule_no, s.drive_id, s.ego_id FROM _rule r CROSS JOIN _subject s
ANTI JOIN _gated g ON g.rule_no = r.rule_no AND g.drive_id = s.drive_id AND g.ego_id = s.ego_id
ANTI JOIN _foreign f ON f.rule_no = r.rule_no AND f.drive_id = s.drive_id AND f.ego_id = s.ego_id;
