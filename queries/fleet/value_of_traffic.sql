-- Part of the statements of this folder: how many others the log has at a step on average; NULL with several egos, as their steps may be the same.
CASE WHEN d.n_egos = 1 AND d.n_steps > 0 THEN CASE WHEN d.n_states / d.n_steps - 1 < 1 THEN 'less than 1 other'
    WHEN d.n_states / d.n_steps - 1 < 5 THEN '1 to 5 others' WHEN d.n_states / d.n_steps - 1 < 20 THEN '5 to 20 others'
    ELSE '20 others and more' END END
