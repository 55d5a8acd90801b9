-- title = "Lateral acceleration within UN R79"
-- breach = "Lateral acceleration beyond UN R79"
-- clause = "UN R79 5.6.2.1.3 (lane keeping): no more lateral acceleration than the system may be specified for: 3 m/s2 for cars and vans, 2.5 m/s2 for buses and lorries"
-- hypothesis = "At every step, was the ego's lateral acceleration at most 3 m/s2, or at most 2.5 m/s2 if it is a lorry or bus?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "m/s2"
-- observes = "lateral acceleration"
-- near_margin = 0.3
-- reads = ["actor", "clock", "ego_condition", "ego_motion"]
-- requires = ["speeds"]
--
-- [params.most_mps2]
-- default = 3.0
-- unit = "m/s2"
-- why = "the most that a lane keeping system of a car or van (M1, N1) may ask for"
-- source = "UN R79 5.6.2.1.3, 03 series (not seen)"
--
-- [params.heavy_mps2]
-- default = 2.5
-- unit = "m/s2"
-- why = "the most of a bus or lorry (M2, M3, N2, N3)"
-- source = "UN R79 5.6.2.1.3, 03 series (not seen)"
--
-- [params.edge_s]
-- default = 0.5
-- unit = "s"
-- why = "our default: this near to the ends of the log, the filter's window is not complete"
--
-- [reasons.heavy_vehicle_unknown]
-- says = "it is not known whether the ego is a bus or lorry"
-- advice = "set --env vehicle_class=..."

-- @condition
-- The heading is filtered before it is differentiated, see ego_motion. If the kind of the ego is not known, a value within both limits is a
-- pass, and a value above both limits is a fail.
SELECT m.drive_id, m.ego_id, m.t_ns, peak_sure_at_most(magnitude.lat_mps2, m.lat_peak_mps2, bound.limit_mps2) AS observed, bound.limit_mps2 AS required, m.lat_error_mps2 AS error,
    is_judged(m.lat_accel_mps2, m.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AS applies,
    CASE WHEN kind.is_heavy IS NULL AND bound.limit_mps2 IS NULL THEN why('heavy_vehicle_unknown')
        WHEN magnitude.lat_mps2 <= bound.limit_mps2 AND magnitude.lat_mps2 + m.lat_peak_mps2 > bound.limit_mps2 THEN why('peak_flattened') END AS reason
FROM ego_motion m
JOIN clock c ON c.drive_id = m.drive_id AND c.ego_id = m.ego_id
LEFT JOIN ego_condition ec ON ec.drive_id = m.drive_id AND ec.ego_id = m.ego_id AND ec.t_ns = m.t_ns
LEFT JOIN actor a ON a.drive_id = m.drive_id AND a.actor_id = m.ego_id
CROSS JOIN LATERAL (
    SELECT CASE WHEN ec.vehicle_class IN ('bus', 'goods_7t5', 'goods_over_7t5') THEN true WHEN ec.vehicle_class IS NOT NULL THEN false
        WHEN a.actor_class = 'truck' THEN true WHEN a.actor_class IN ('van', 'bicycle') THEN false END AS is_heavy
) kind
CROSS JOIN LATERAL (SELECT abs(m.lat_accel_mps2) AS lat_mps2) magnitude
CROSS JOIN LATERAL (
    SELECT CASE WHEN kind.is_heavy OR magnitude.lat_mps2 + m.lat_peak_mps2 <= $heavy_mps2 AND kind.is_heavy IS NULL THEN $heavy_mps2
        WHEN NOT kind.is_heavy OR magnitude.lat_mps2 > $most_mps2 THEN $most_mps2 END AS limit_mps2
) bound
