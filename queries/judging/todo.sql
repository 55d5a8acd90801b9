-- The subjects to which a rule does not apply, whatever happens in the drive: at every step some condition is known, and is not one that the
-- rule allows. `other_nation`: the law of one nation says nothing about a drive in another. `outside_conditions`: the conditions of a rule's header.
-- `ego_never_moves`: an ego that is parked all along is judged by rules about standing only.
CREATE OR REPLACE TEMP TABLE _ruled_out AS
WITH _conditions AS (
    SELECT row_number() OVER () AS no, * FROM (
        SELECT DISTINCT
            s.drive_id, s.ego_id, e.road_type::VARCHAR AS road_type, e.carriageway::VARCHAR AS carriageway, e.area::VARCHAR AS area,
            e.nation::VARCHAR AS nation, e.weather::VARCHAR AS weather, e.light::VARCHAR AS light,
            e.vehicle_class::VARCHAR AS vehicle_class, e.limit_mps
        FROM step s
        LEFT JOIN ego_condition e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
    )
), _condition AS (
    SELECT no, drive_id, ego_id, condition, word
    FROM _conditions UNPIVOT INCLUDE NULLS (word FOR condition IN (road_type, carriageway, area, nation, weather, light, vehicle_class))
), _known AS (
    SELECT r.rule_no, r.code, c.no, c.drive_id, c.ego_id, c.word IS NOT NULL AND a.word IS NULL AS is_outside
    FROM (SELECT DISTINCT rule_no, code, condition FROM _allowed) r
    JOIN _condition c ON c.condition = r.condition
    LEFT JOIN _allowed a ON a.rule_no = r.rule_no AND a.code = r.code AND a.condition = r.condition AND a.word = c.word
    UNION ALL
    SELECT r.rule_no, 'outside_conditions', c.no, c.drive_id, c.ego_id,
        coalesce(c.limit_mps < r.limit_min_mps, false) OR coalesce(c.limit_mps > r.limit_max_mps, false)
    FROM _rule r JOIN _conditions c ON r.limit_min_mps IS NOT NULL OR r.limit_max_mps IS NOT NULL
), _of_conditions AS (
    SELECT rule_no, code, drive_id, ego_id, bool_or(is_outside) AS is_outside FROM _known GROUP BY rule_no, code, drive_id, ego_id, no
)
SELECT rule_no, drive_id, ego_id, code FROM _of_conditions GROUP BY ALL HAVING bool_and(is_outside)
UNION ALL
SELECT r.rule_no, e.drive_id, e.ego_id, 'ego_never_moves'
FROM _rule r
CROSS JOIN (
    SELECT drive_id, ego_id FROM ego_state GROUP BY ALL
    HAVING bool_and(coalesce(speed_mps <= standing_mps(), false)) AND greatest(max(x_m) - min(x_m), max(y_m) - min(y_m)) <= standing_spread_m()
) e
WHERE NOT r.of_standing;

-- The first of a rule's required signals that the log cannot give. A signal without a row in `capability` counts as missing, if it is
-- not one that a log is taken to have.
CREATE OR REPLACE TEMP TABLE _lacking AS
SELECT rule_no, drive_id, ego_id, first.signal AS signal, first.reason AS reason FROM (
    SELECT n.rule_no, s.drive_id, s.ego_id,
        min({'pos': n.pos, 'signal': n.signal,
            'reason': coalesce(c.reason, why('nothing_known', {'signal': n.signal}))}) AS first
    FROM _needs n CROSS JOIN _subject s
    LEFT JOIN capability c ON c.drive_id = s.drive_id AND c.ego_id = s.ego_id AND c.signal = n.signal
    WHERE coalesce(c.available, n.is_assumed) IS DISTINCT FROM true
    GROUP BY ALL);

-- Signals that only few logs have, such as indicators or declared events: a rule does not apply to a log without them, if it is not requested by
-- its id (`is_named`) and the log's mapping does not name the signal. A rule
-- that does not apply anyway is not among them.
CREATE OR REPLACE TEMP TABLE _unrecorded AS
SELECT rule_no, drive_id, ego_id, first.signal AS signal, first.reason AS reason FROM (
    SELECT n.rule_no, s.drive_id, s.ego_id,
        min({'pos': n.pos, 'signal': n.signal, 'reason': coalesce(c.reason, why('nothing_known', {'signal': n.signal}))}) AS first
    FROM _needs n CROSS JOIN _subject s
    LEFT JOIN capability c ON c.drive_id = s.drive_id AND c.ego_id = s.ego_id AND c.signal = n.signal
    LEFT JOIN data_log l ON l.drive_id = s.drive_id
    WHERE n.may_be_unrecorded AND c.available IS DISTINCT FROM true AND NOT (n.signal = 'indicator' AND coalesce(l.names_indicator, false))
    GROUP BY ALL
) u
ANTI JOIN _ruled_out e ON e.rule_no = u.rule_no AND e.drive_id = u.drive_id AND e.ego_id = u.ego_id;

CREATE OR REPLACE TEMP TABLE _gated AS
FROM _lacking g
ANTI JOIN _unrecorded u ON u.rule_no = g.rule_no AND u.drive_id = g.drive_id AND u.ego_id = g.ego_id
ANTI JOIN _ruled_out e ON e.rule_no = g.rule_no AND e.drive_id = g.drive_id AND e.ego_id = g.ego_id;

-- A rule with all its signals is run, and says itself at which steps or occasions its conditions do not hold.
CREATE OR REPLACE TEMP TABLE _excluded AS
FROM _ruled_out WHERE code <> 'outside_conditions'
UNION ALL
FROM _ruled_out e
SEMI JOIN _lacking g ON g.rule_no = e.rule_no AND g.drive_id = e.drive_id AND g.ego_id = e.ego_id
ANTI JOIN (FROM _ruled_out WHERE code = 'other_nation') f ON f.rule_no = e.rule_no AND f.drive_id = e.drive_id AND f.ego_id = e.ego_id
WHERE e.code = 'outside_conditions';

-- The subjects for which a rule is to be run.
CREATE OR REPLACE TEMP TABLE _todo AS
SELECT r.rule_no, s.drive_id, s.ego_id FROM _rule r CROSS JOIN _subject s
ANTI JOIN _gated g ON g.rule_no = r.rule_no AND g.drive_id = s.drive_id AND g.ego_id = s.ego_id
ANTI JOIN _unrecorded u ON u.rule_no = r.rule_no AND u.drive_id = s.drive_id AND u.ego_id = s.ego_id
ANTI JOIN _excluded e ON e.rule_no = r.rule_no AND e.drive_id = s.drive_id AND e.ego_id = s.ego_id;
