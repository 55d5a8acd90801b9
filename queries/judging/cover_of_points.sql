-- part of `outcome_of_references.sql`: of each reference all points are judged
_cover AS (
    SELECT ref_id, count(*) AS n_points, NULL::VARCHAR AS problem, min(t_ns) AS t_min, max(t_ns) AS t_max
    FROM reference_step GROUP BY ref_id)
