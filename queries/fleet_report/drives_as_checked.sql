-- The drives of an audit as a check has them, and their logs; logs of one content once.
SELECT * EXCLUDE (key, tags) FROM {of}drives ORDER BY drive_id, file_name, log
