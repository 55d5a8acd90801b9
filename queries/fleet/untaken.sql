-- The candidates of findings that are in no pair yet.
CREATE OR REPLACE TEMP TABLE candidate AS
SELECT c.* FROM candidate c
ANTI JOIN pair p ON p.drive = c.drive AND p.new_no = c.new_no
ANTI JOIN pair q ON q.drive = c.drive AND q.base_no = c.base_no
