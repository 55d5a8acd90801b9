-- The table that conditions and anchors see: the author's reference points of the subjects that are to be judged; `ref_id` is 0.. over all of them.
CREATE OR REPLACE TEMP TABLE reference AS
WITH _returned_reference AS (
{reference}
), _raw_reference AS (SELECT r.* FROM _returned_reference r SEMI JOIN _subject s ON r.drive_id = s.drive_id AND r.ego_id = s.ego_id{todo})
SELECT (row_number() OVER (ORDER BY {order}) - 1)::INTEGER AS ref_id, * FROM _raw_reference
