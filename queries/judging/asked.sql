-- The steps to judge of a rule without a first pass; empty if there are none.
CREATE OR REPLACE TEMP TABLE _asked AS WITH {grid} SELECT * FROM _step_to_judge
