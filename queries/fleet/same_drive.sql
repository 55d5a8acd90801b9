-- The drives that two audits share: by the content of the log, of the same place first, else by its place, else by an id, else by a file stem
-- that only one drive of each audit has.
CREATE OR REPLACE TEMP TABLE same_drive AS
WITH base_drive AS (
    SELECT *, regexp_replace(file_name, '^(.+)\.[^.]+$', '\1') AS stem,
        row_number() OVER (PARTITION BY log, sha256 ORDER BY status = 'judged' DESC, drive_id, map_sha256 NULLS FIRST, key) AS nth
    FROM {base}drives
), new_drive AS (
    SELECT *, regexp_replace(file_name, '^(.+)\.[^.]+$', '\1') AS stem,
        row_number() OVER (PARTITION BY log, sha256 ORDER BY status = 'judged' DESC, drive_id, map_sha256 NULLS FIRST, key) AS nth
    FROM {new}drives
), unmoved AS (
    SELECT b.key AS base_key, n.key AS new_key FROM base_drive b JOIN new_drive n ON n.sha256 = b.sha256 AND n.log = b.log AND n.nth = b.nth
), base_moved AS (
    SELECT b.* REPLACE (row_number() OVER (PARTITION BY sha256 ORDER BY status = 'judged' DESC, drive_id, log, map_sha256 NULLS FIRST, key) AS nth)
    FROM base_drive b ANTI JOIN unmoved k ON k.base_key = b.key
), new_moved AS (
    SELECT n.* REPLACE (row_number() OVER (PARTITION BY sha256 ORDER BY status = 'judged' DESC, drive_id, log, map_sha256 NULLS FIRST, key) AS nth)
    FROM new_drive n ANTI JOIN unmoved k ON k.new_key = n.key
), by_content AS (
    FROM unmoved
    UNION ALL
    SELECT b.key, n.key FROM base_moved b JOIN new_moved n ON n.sha256 = b.sha256 AND n.nth = b.nth
), base_changed AS (
    SELECT b.* REPLACE (row_number() OVER (PARTITION BY log ORDER BY map_sha256 NULLS FIRST, key) AS nth)
    FROM base_drive b ANTI JOIN by_content k ON k.base_key = b.key
), new_changed AS (
    SELECT n.* REPLACE (row_number() OVER (PARTITION BY log ORDER BY map_sha256 NULLS FIRST, key) AS nth)
    FROM new_drive n ANTI JOIN by_content k ON k.new_key = n.key
), by_place AS (
    SELECT b.key AS base_key, n.key AS new_key FROM base_changed b JOIN new_changed n ON n.log = b.log AND n.nth = b.nth
), base_rest AS (
    SELECT b.* FROM base_changed b ANTI JOIN by_place k ON k.base_key = b.key
), new_rest AS (
    SELECT n.* FROM new_changed n ANTI JOIN by_place k ON k.new_key = n.key
), by_id AS (
    SELECT b.key AS base_key, n.key AS new_key
    FROM (FROM base_rest QUALIFY count(*) OVER (PARTITION BY drive_id) = 1) b
    JOIN (FROM new_rest QUALIFY count(*) OVER (PARTITION BY drive_id) = 1) n ON n.drive_id = b.drive_id
), by_stem AS (
    SELECT b.key AS base_key, n.key AS new_key
    FROM (SELECT r.* FROM base_rest r ANTI JOIN by_id k ON k.base_key = r.key QUALIFY count(*) OVER (PARTITION BY r.stem) = 1) b
    JOIN (SELECT r.* FROM new_rest r ANTI JOIN by_id k ON k.new_key = r.key QUALIFY count(*) OVER (PARTITION BY r.stem) = 1) n ON n.stem = b.stem
), matched AS (
    FROM by_content UNION ALL FROM by_place UNION ALL FROM by_id UNION ALL FROM by_stem
)
-- What differs between the two, NULL where it is not known: the log, the map, and the software that drove.
SELECT m.base_key, m.new_key, n.sha256 IS NOT DISTINCT FROM b.sha256 AS same_log, n.sha256 <> b.sha256 AS data,
    CASE WHEN (b.map_sha256 IS NULL AND b.status <> 'judged') OR (n.map_sha256 IS NULL AND n.status <> 'judged') THEN NULL
        ELSE n.map_sha256 IS DISTINCT FROM b.map_sha256 END AS map, n.tags['release'] <> b.tags['release'] AS software
FROM matched m JOIN {base}drives b ON b.key = m.base_key JOIN {new}drives n ON n.key = m.new_key
