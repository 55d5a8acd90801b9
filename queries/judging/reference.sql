-- The table that conditions and anchors see: `ref_id` is 0.. over all subjects.
CREATE OR REPLACE TEMP TABLE reference AS
SELECT (row_number() OVER (ORDER BY {order}) - 1)::INTEGER AS ref_id, * FROM _raw_reference
