-- Numbers that are the same for the same rows, whatever their order: their count and the sums of their hashes.
SELECT count(*), sum(md5_number_lower(r::VARCHAR)), sum(md5_number_upper(r::VARCHAR))
FROM (SELECT t AS r FROM (SELECT {columns} FROM {table}) t)
