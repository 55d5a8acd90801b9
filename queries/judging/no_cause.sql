-- The table of `cause.sql` without rows.
CREATE OR REPLACE TEMP TABLE _cause AS
SELECT {'drive_id': drive_id, 'ego_id': ego_id, 't_ns': start_ns, 'object_id': '', 'of_hidden': true, 'of_lanes': true} AS key,
    NULL::VARCHAR AS lack, NULL::VARCHAR AS because
FROM _subject WHERE false
