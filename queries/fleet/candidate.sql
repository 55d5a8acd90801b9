-- Pairs of findings that may be the same, by the rules of `drivelint.gate.match.may_match`.
CREATE OR REPLACE TEMP TABLE candidate AS
SELECT n.new_key AS drive, n.no AS new_no, b.no AS base_no, n.finding_id <> b.finding_id AS other_id, abs(b.worst_s - n.worst_s) AS apart_s,
    greatest(0.0, greatest(b.from_s, n.from_s) - least(b.to_s, n.to_s)) AS gap_s
FROM new_finding n
JOIN base_finding b ON b.new_key = n.new_key AND b.ego_id = n.ego_id AND b.rule_id = n.rule_id
    AND b.profile IS NOT DISTINCT FROM n.profile AND b.object_id IS NOT DISTINCT FROM n.object_id
WHERE CASE WHEN n.same_log THEN gap_s <= {near_s}
    ELSE abs(b.worst_s - n.worst_s) <= {near_s} AND coalesce(sqrt((b.x_m - n.x_m) ** 2 + (b.y_m - n.y_m) ** 2) <= {near_m}, true)
        OR greatest(b.to_s, n.to_s) - least(b.from_s, n.from_s) > 0 AND greatest(b.to_s, n.to_s) - least(b.from_s, n.from_s)
            <= 2 * (least(b.to_s, n.to_s) - greatest(b.from_s, n.from_s)) END
