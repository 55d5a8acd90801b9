-- title = "Following distance of UN R157 kept"
-- breach = "Closer than the following distance of UN R157"
-- clause = "UN R157 5.2.3.3 (cars and vans; more for heavy vehicles): while moving, up to 60 km/h, keep at least the distance of the table, never less than 2 m; if others take it, restore it at the next opportunity"
-- hypothesis = "At every step at which the ego moved behind a vehicle, was the gap at least the distance of the table?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = ">="
-- unit = "m"
-- observes = "gap to the vehicle ahead"
-- near_margin = 0.5
-- reads = ["following", "pair", "vehicle_ahead"]
-- requires = ["mode_engaged", "way", "ego_size"]
--
-- [params.v_max_mps]
-- default = 16.67
-- unit = "m/s"
-- why = "60 km/h, the end of the table: beyond it the law of the country applies"
-- source = "UN R157 5.2.3.3"
--
-- [params.restore_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time to restore the distance without harsh braking after a cut-in or while and after the vehicle ahead brakes; a vehicle that was ahead already, or whose coming was not seen, has not cut in"
--
-- [params.lead_brakes_mps2]
-- default = 1.0
-- unit = "m/s2"
-- why = "our default: a vehicle ahead that brakes at least this hard takes distance away"
--
-- [params.faster_mps]
-- default = 0.5
-- unit = "m/s"
-- why = "our default: if the ego's speed is higher by more than this than while the vehicle ahead braked, the ego itself closes the gap; a constant speed varies by less"

-- @condition
SELECT f.drive_id, f.ego_id, f.t_ns, f.gap_m AS observed, r157_gap_m(f.ego_speed_mps) AS required,
    f.follows AND f.ego_speed_mps > standstill_mps() AND f.ego_speed_mps <= $v_max_mps
        -- If the two touch within that time, it is not known whether the ego restored the gap as soon as it could.
        AND CASE WHEN coalesce(f.t_ns - f.joined_ns >= $restore_s * 1e9, true) THEN true
            WHEN c.t_ns - f.joined_ns < $restore_s * 1e9 THEN CASE WHEN f.gap_m >= r157_gap_m(f.ego_speed_mps) THEN true END ELSE false END
        AND CASE WHEN f.ego_speed_mps > b.ego_then_mps + $faster_mps THEN true WHEN b.has_braked THEN false WHEN f.gap_m >= r157_gap_m(f.ego_speed_mps) OR NOT b.may_have_braked THEN true END AS applies
FROM following f
LEFT JOIN (
    SELECT drive_id, ego_id, t_ns, object_id, bool_or(accel_mps2 <= -$lead_brakes_mps2) OVER restore_time AS has_braked,
        -- The highest speed of the ego while the vehicle ahead braked, or may have braked.
        max(ego_speed_mps) FILTER (accel_mps2 <= -$lead_brakes_mps2 OR accel_mps2 IS NULL) OVER restore_time AS ego_then_mps, bool_or(accel_mps2 IS NULL) OVER restore_time AS may_have_braked
    FROM vehicle_ahead
    WINDOW restore_time AS (PARTITION BY drive_id, ego_id, object_id ORDER BY t_ns RANGE BETWEEN ($restore_s * 1e9)::BIGINT PRECEDING AND CURRENT ROW)
) b ON b.drive_id = f.drive_id AND b.ego_id = f.ego_id AND b.t_ns = f.t_ns AND b.object_id = f.object_id
ASOF LEFT JOIN (SELECT drive_id, ego_id, object_id, t_ns FROM pair WHERE clearance_m <= 0) c
    ON c.drive_id = f.drive_id AND c.ego_id = f.ego_id AND c.object_id = f.object_id AND c.t_ns >= f.t_ns
