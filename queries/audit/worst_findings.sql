-- The worst findings of an audit, as many as `most` (NULL: all), as its summary counts them: logs with the same content once, and one finding per event.
-- All rows of these findings, each with the key of its own result, in the order of reports: severity, contacts first, sure before possible, the
-- least margin; then a total order.
WITH event AS ({event}), counted AS ({counted_id}), placed AS (
    SELECT f.*, row_number() OVER (
        ORDER BY
            CASE f.severity WHEN 'critical' THEN 0 WHEN 'major' THEN 1 ELSE 2 END,
            coalesce(list_contains(r.tags, 'contact'), false) DESC,
            CASE WHEN f.n_copies IS NULL THEN 1 WHEN f.n_stays >= {least_share} * f.n_copies THEN 0 ELSE 2 END,
            coalesce(f.margin, 0),
            f.t_worst_ns NULLS FIRST, f.drive_id, f.result_key, f.ego_id, f.rule_id, f.profile NULLS FIRST, f.object_id NULLS FIRST,
            f.occurrence, f.ref_id NULLS FIRST, f.finding_id
    ) AS place
    FROM counted_findings f
    LEFT JOIN rules r USING (rule_id)
), worst AS (
    SELECT key, finding_id
    FROM placed
    SEMI JOIN event USING (key, finding_id)
    ORDER BY place
    LIMIT $most
), wanted AS (
    SELECT c.key, c.finding_id FROM counted c JOIN worst w ON w.key = c.key AND w.finding_id = c.counted_id
)
SELECT * EXCLUDE (result_key, place) REPLACE (result_key AS key)
FROM placed p
WHERE $most IS NULL OR $most >= (SELECT count(*) FROM event) OR EXISTS (FROM wanted w WHERE w.key = p.key AND w.finding_id = p.finding_id)
ORDER BY place
