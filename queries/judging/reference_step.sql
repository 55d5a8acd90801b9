-- The table of steps that the condition of one rule sees.
CREATE OR REPLACE TEMP VIEW reference_step AS SELECT * EXCLUDE (rule_no) FROM _reference_step WHERE rule_no = {rule_no}
