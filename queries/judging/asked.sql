-- The grid of a rule without a first pass; empty where nothing is to be judged.
CREATE OR REPLACE TEMP TABLE _asked AS WITH {grid} SELECT * FROM _grid
