-- part of `outcome_of_references.sql`: a rule without a window has nothing that could be seen in part only, so no reference has a `problem`
_cover AS (
    SELECT ref_id, count(*) AS n_points, NULL::VARCHAR AS problem, min(t_ns) AS t_min, max(t_ns) AS t_max
    FROM reference_step GROUP BY ref_id)
