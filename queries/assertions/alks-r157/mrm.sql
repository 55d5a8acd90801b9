-- title = "Gentle braking in a minimal risk manoeuvre"
-- breach = "Hard braking in a minimal risk manoeuvre"
-- clause = "UN R157 5.5.1 (5.5.2 in the 01 series): a minimal risk manoeuvre aims at no more than 4 m/s2 of braking, but for very short moments and in a severe failure"
-- hypothesis = "During a minimal risk manoeuvre, did the ego brake harder than 4 m/s2 for no longer than a moment?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = ">="
-- unit = "m/s2"
-- observes = "highest acceleration (negative when braking) over brief_s"
-- near_margin = 0.2
-- tags = ["standing"]
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
-- why = "our default: this near to the ends of the log, the filter's windows are not complete"

-- @condition
-- Braking that is too hard is known to have lasted for brief_s only if the acceleration is known at every step of that time, from a step at
-- its beginning or before it. Steps outside the manoeuvre count as no braking.
WITH ego_step AS (
    SELECT m.drive_id, m.ego_id, m.t_ns, m.accel_mps2, m.accel_error_mps2, c.t_start_ns, c.t_end_ns, c.period_ns, mrm.is_on,
        CASE WHEN mrm.is_on THEN m.accel_mps2 WHEN NOT mrm.is_on THEN 0.0::DOUBLE END AS manoeuvre_mps2
    FROM ego_motion m
    JOIN clock c ON c.drive_id = m.drive_id AND c.ego_id = m.ego_id
    LEFT JOIN (SELECT * FROM ego_mode WHERE mode = 'minimal_risk_manoeuvre') mrm ON mrm.drive_id = m.drive_id AND mrm.ego_id = m.ego_id AND mrm.t_ns = m.t_ns
),
recent_braking AS (
    SELECT *, max(manoeuvre_mps2) OVER brief_time AS mildest_mps2, count(*) OVER brief_time = count(manoeuvre_mps2) OVER brief_time AS is_known
    FROM ego_step
    WINDOW brief_time AS (PARTITION BY drive_id, ego_id ORDER BY t_ns RANGE BETWEEN ($brief_s * 1e9)::BIGINT + period_ns - 1 PRECEDING AND CURRENT ROW)
)
SELECT b.drive_id, b.ego_id, b.t_ns, -$brake_mps2 AS required, b.accel_error_mps2 AS error,
    CASE WHEN b.accel_mps2 >= -$brake_mps2 THEN b.accel_mps2
        WHEN b.accel_mps2 IS NOT NULL AND (b.mildest_mps2 >= -$brake_mps2 OR b.is_known AND b.t_ns - b.t_start_ns >= ($brief_s * 1e9)::BIGINT) THEN b.mildest_mps2 END AS observed,
    b.is_on AND is_judged(b.accel_mps2, b.t_ns, b.t_start_ns, b.t_end_ns, $edge_s) AS applies
FROM recent_braking b
