-- The rows of a table of some batches whose drives have a receipt that names the batch.
SELECT r.* EXCLUDE (filename)
FROM _rows r
SEMI JOIN _packed p ON p.key = r.key AND p.batch = parse_filename(r.filename, true)
ORDER BY {order}
