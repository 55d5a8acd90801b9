-- Part of `position.sql`: the findings that have no longitude yet.
SELECT drive_id, rowid AS key, x_m, y_m FROM finding WHERE lon IS NULL
