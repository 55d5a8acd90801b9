-- Results of logs that are not among the sources: of earlier runs.
SELECT key FROM receipts ANTI JOIN _listed USING (log) ORDER BY key
