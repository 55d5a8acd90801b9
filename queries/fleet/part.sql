-- Findings without a partner that are a part of a longer one of the other audit (`drivelint.gate.match.is_part_of`): of several the first.
-- Of NEW, any longer one of BASE counts; of BASE, those of NEW that have a partner, as the others are told already.
CREATE OR REPLACE TEMP TABLE part AS
WITH new_part AS (
    SELECT n.new_key AS drive, n.no AS new_no, min(b.no) AS base_no
    FROM (SELECT f.* FROM new_finding f ANTI JOIN pair p ON p.drive = f.new_key AND p.new_no = f.no) n
    JOIN base_finding b ON b.new_key = n.new_key AND b.ego_id = n.ego_id AND b.rule_id = n.rule_id
        AND b.profile IS NOT DISTINCT FROM n.profile AND b.object_id IS NOT DISTINCT FROM n.object_id
    WHERE n.to_s - n.from_s < b.to_s - b.from_s AND n.from_s >= b.from_s - CASE WHEN n.same_log THEN {near_s} ELSE 0.0 END
        AND n.to_s <= b.to_s + CASE WHEN n.same_log THEN {near_s} ELSE 0.0 END
    GROUP BY ALL
), base_left AS (
    SELECT f.* FROM base_finding f ANTI JOIN pair p ON p.drive = f.new_key AND p.base_no = f.no
    ANTI JOIN new_part t ON t.drive = f.new_key AND t.base_no = f.no
), base_part AS (
    SELECT b.new_key AS drive, min(n.no) AS new_no, b.no AS base_no
    FROM base_left b
    JOIN (SELECT f.* FROM new_finding f SEMI JOIN pair p ON p.drive = f.new_key AND p.new_no = f.no) n
        ON b.new_key = n.new_key AND b.ego_id = n.ego_id AND b.rule_id = n.rule_id
        AND b.profile IS NOT DISTINCT FROM n.profile AND b.object_id IS NOT DISTINCT FROM n.object_id
    WHERE b.to_s - b.from_s < n.to_s - n.from_s AND b.from_s >= n.from_s - CASE WHEN n.same_log THEN {near_s} ELSE 0.0 END
        AND b.to_s <= n.to_s + CASE WHEN n.same_log THEN {near_s} ELSE 0.0 END
    GROUP BY ALL
)
FROM new_part UNION ALL FROM base_part
