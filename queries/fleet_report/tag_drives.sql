-- The drives with one of these values.
CREATE OR REPLACE TEMP TABLE shown_key AS
SELECT d.key FROM drives d JOIN shown_value s ON s.tag_value IS NOT DISTINCT FROM {value}
