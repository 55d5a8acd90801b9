-- Part of the statements of this folder, behind ORDER BY: findings `f` and their rules `r` in the order of every report, that is by severity, then
-- contacts, sure ones and the least margin.
list_position(['critical', 'major', 'minor'], f.severity), list_contains(r.tags, 'contact') DESC,
    coalesce(f.n_stays < {least_share} * f.n_copies, false), coalesce(f.margin, 0), f.t_worst_ns, f.finding_id
