-- Per missing signal: the rules and subjects that it leaves undecided. A verdict names only the first signal that is missing; `needed` has all
-- signals that the rule requires and the subject does not have.
WITH requirement AS (
    SELECT DISTINCT rule_id, rule_version, unnest(requires) AS signal FROM {of}rules
), {subject}, undecided AS (
    SELECT key, ego_id, rule_id, rule_version FROM {of}verdicts WHERE verdict = 'unknown' AND starts_with(reason_code, 'missing_') OR starts_with(reason_code, 'unrecorded_') GROUP BY ALL
), lack AS (
    SELECT DISTINCT d.key, m.ego_id, m.signal FROM (SELECT key, unnest(not_judged) AS m FROM {of}drives) d
), needed AS (
    SELECT u.key, u.ego_id, u.rule_id, r.signal, count(*) OVER (PARTITION BY u.key, u.ego_id, u.rule_id) AS n_lacking
    FROM undecided u
    JOIN requirement r ON r.rule_id = u.rule_id AND r.rule_version = u.rule_version
    JOIN lack l ON l.key = u.key AND l.ego_id = u.ego_id AND l.signal = r.signal
), subject_of_signal AS (
    SELECT n.signal, n.key, s.content, n.ego_id, count(*) AS n_rules, count(*) FILTER (n_lacking = 1) AS n_alone, any_value(s.km) AS km, any_value(d.format) AS format
    FROM needed n JOIN subject s ON s.key = n.key AND s.ego_id = n.ego_id JOIN {of}drives d ON d.key = n.key GROUP BY ALL
), rule_of_signal AS (
    SELECT n.signal, count(DISTINCT n.rule_id) AS rules, count(DISTINCT n.rule_id) FILTER (n_lacking = 1) AS rules_alone
    FROM needed n SEMI JOIN subject s ON s.key = n.key AND s.ego_id = n.ego_id GROUP BY ALL
)
SELECT r.signal, r.rules, r.rules_alone, count(DISTINCT s.content) AS drives, count(DISTINCT s.content) FILTER (n_alone > 0) AS drives_alone,
    coalesce(sum(round(1e9 * s.km)::BIGINT), 0) / 1e9 AS km, coalesce(sum(round(1e9 * s.km)::BIGINT) FILTER (n_alone > 0), 0) / 1e9 AS km_alone,
    sum(n_rules)::BIGINT AS judgements, sum(n_alone)::BIGINT AS judgements_alone,
    list_sort(list(DISTINCT s.format)) AS formats
FROM rule_of_signal r JOIN subject_of_signal s ON s.signal = r.signal
GROUP BY r.signal, r.rules, r.rules_alone
ORDER BY judgements_alone DESC, judgements DESC, r.signal
