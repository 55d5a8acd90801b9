-- The candidates that are the best of both of their findings. If these are taken, and what they leave is asked again until nothing is left, the
-- pairs are those that one gets by taking the best candidate of all again and again.
INSERT INTO pair
SELECT drive, new_no, base_no FROM candidate
QUALIFY row_number() OVER (PARTITION BY drive, new_no ORDER BY other_id, apart_s, gap_s, new_no, base_no) = 1
    AND row_number() OVER (PARTITION BY drive, base_no ORDER BY other_id, apart_s, gap_s, new_no, base_no) = 1
