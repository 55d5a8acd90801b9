-- part of `asked.sql` and `judged_of_grid.sql`: the steps of an invariant at which it may be in force, with `doubt` and `why`, the code and
-- the author's reason where that is not known
{base}, _restricted AS (
    SELECT a.* EXCLUDE (applies), a.applies AND {in_force} AS applies,
        CASE WHEN a.applies IS NULL THEN 'applies_unknown' ELSE {doubt} END AS doubt
    FROM _base a
    {condition_joins}
), _step_to_judge AS (SELECT a.* FROM _restricted a{todo}{unsettled} WHERE a.applies IS DISTINCT FROM false)
