-- Those of some egos, whose scenes are made at once.
CREATE OR REPLACE TEMP TABLE _moment AS SELECT * EXCLUDE (ego_no) FROM _every_moment WHERE ego_no >= $first_no AND ego_no < $end_no
