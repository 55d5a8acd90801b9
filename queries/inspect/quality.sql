SELECT 'log' AS about, severity, check_id, message, n, actor_id, t_first_ns FROM quality
UNION ALL
SELECT 'map', severity, check_id, coalesce(lanelet_id || ': ', '') || message, n, NULL, NULL FROM map_quality
ORDER BY about, check_id, actor_id NULLS FIRST, t_first_ns NULLS FIRST, message
