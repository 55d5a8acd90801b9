-- The listed drives that have no receipt. A file that is listed twice is judged once.
SELECT DISTINCT ON (source_id) *
FROM _listed ANTI JOIN receipts USING (source_id)
ORDER BY log, source_id
