-- The new receipts whose key a chunk has already: the hash of the rows there and here.
SELECT key, o.rows_sha256, n.rows_sha256
FROM _old o JOIN _new n USING (key)
