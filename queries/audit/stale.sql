-- Keys of results to take out: of listed logs that have changed since, and those to be tried again.
SELECT key FROM receipts SEMI JOIN _listed USING (log) ANTI JOIN _listed USING (source_id)
UNION
SELECT key FROM receipts WHERE $retry AND status <> 'judged'
ORDER BY key
