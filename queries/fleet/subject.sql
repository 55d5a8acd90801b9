-- Part of the statements of this folder: `subject` has one row per ego of a judged drive, with its exposure and its value of the tag.
-- A log that is there twice, as under two names or in two audits that were merged, was driven once.
subject AS (
    SELECT d.key, ego.ego_id, ego.km, ego.hours, ego.engaged_km, ego.engaged_hours, {value} AS tag_value
    FROM (
        SELECT *, unnest(CASE WHEN len(exposure) > 0 THEN exposure
            ELSE [{'ego_id': '', 'km': NULL, 'hours': NULL, 'engaged_km': NULL, 'engaged_hours': NULL, 'n_steps': 0}] END) AS ego
        FROM {of}drives WHERE status = 'judged'
    ) d {without}
    QUALIFY row_number() OVER (PARTITION BY tag_value, coalesce(d.sha256, d.key), ego.ego_id ORDER BY d.key) = 1
)
