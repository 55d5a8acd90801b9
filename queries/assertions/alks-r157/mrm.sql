-- title = "A gentle minimal risk manoeuvre"
-- clause = "UN R157 5.5.1 (5.5.2 in the 01 series): a minimal risk manoeuvre aims at no more than 4 m/s2 of braking, but for very short moments and in a severe failure"
-- hypothesis = "During a minimal risk manoeuvre, did the ego brake no harder than 4 m/s2 for longer than a moment?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = ">="
-- unit = "m/s2"
-- observes = "mildest acceleration of the last moment"
-- near_margin = 0.2
-- reads = ["clock", "ego_mode", "ego_motion"]
-- requires = ["mode_engaged", "mode_minimal_risk_manoeuvre"]
--
-- [params.brake_mps2]
-- default = 4.0
-- unit = "m/s2"
-- why = "deceleration allowed"
-- source = "UN R157 5.5.1"
--
-- [params.brief_s]
-- default = 0.5
-- unit = "s"
-- why = "our default for a very short moment, such as a jolt to wake the driver; a severe failure, which excuses more, is in no trace"
--
-- [params.edge_s]
-- default = 1.0
-- unit = "s"
-- why = "our default: so near to the ends of the log the filter's windows are not whole"

-- @condition
-- harder braking is known to have lasted where it is known of every step of that time within the manoeuvre
WITH own AS (
    SELECT m.drive_id, m.ego_id, m.t_ns, m.accel_mps2, f.is_on, CASE WHEN f.is_on THEN m.accel_mps2 WHEN NOT f.is_on THEN 0.0::DOUBLE END AS within_mps2
    FROM ego_motion m
    LEFT JOIN (SELECT * FROM ego_mode WHERE mode = 'minimal_risk_manoeuvre') f ON f.drive_id = m.drive_id AND f.ego_id = m.ego_id AND f.t_ns = m.t_ns
),
lately AS (
    SELECT *, max(within_mps2) OVER w AS mildest_mps2, count(*) OVER w = count(within_mps2) OVER w AS known
    FROM own
    WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY t_ns RANGE BETWEEN ($brief_s * 1e9)::BIGINT PRECEDING AND CURRENT ROW)
)
SELECT l.drive_id, l.ego_id, l.t_ns, -$brake_mps2 AS required,
    CASE WHEN l.accel_mps2 >= -$brake_mps2 THEN l.accel_mps2
        WHEN l.accel_mps2 IS NOT NULL AND (l.mildest_mps2 >= -$brake_mps2 OR l.known AND l.t_ns - c.t_start_ns >= ($brief_s * 1e9)::BIGINT) THEN l.mildest_mps2 END AS observed,
    l.is_on AND judged_inside(l.accel_mps2, l.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AS applies
FROM lately l
JOIN clock c ON c.drive_id = l.drive_id AND c.ego_id = l.ego_id
