-- Part of the statements of this folder: `subject` has one row per ego of a judged drive, with its exposure and its value of the tag. An ego
-- without steps has no exposure. `content` is the same for all results of a log; see `drivelint.fleet.counted` for what counts once.
subject AS (
    SELECT d.key, coalesce(d.sha256, d.key) AS content, v.ego_id, ego.km, ego.hours, ego.engaged_km, ego.engaged_hours, {value} AS tag_value
    FROM {of}drives d
    JOIN (SELECT DISTINCT key, ego_id FROM {of}verdicts) v ON v.key = d.key
    LEFT JOIN (SELECT key, unnest(exposure, recursive := true) FROM {of}drives) ego ON ego.key = v.key AND ego.ego_id = v.ego_id
    {without}
    WHERE d.status = 'judged'
    QUALIFY row_number() OVER (PARTITION BY tag_value, content, v.ego_id ORDER BY {first}) = 1
)
