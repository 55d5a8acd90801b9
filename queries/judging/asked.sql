-- The steps to judge of an invariant that has no first pass (see group.sql); empty if there are none.
CREATE OR REPLACE TEMP TABLE _asked AS WITH {grid} SELECT * FROM _step_to_judge
