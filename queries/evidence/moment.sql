-- The moments of the egos from $first_no to before $end_no. Their scenes are made in one go.
CREATE OR REPLACE TEMP TABLE _moment AS SELECT * EXCLUDE (ego_no) FROM _every_moment WHERE ego_no >= $first_no AND ego_no < $end_no
