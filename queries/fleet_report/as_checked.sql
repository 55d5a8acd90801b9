-- The rows of a table of an audit as a check has them, each under the drive that stands for its log.
SELECT t.* EXCLUDE (key, result_key) REPLACE (d.drive_id AS drive_id)
FROM {of}{table} t
JOIN {of}drives d USING (key)
ORDER BY {order}
