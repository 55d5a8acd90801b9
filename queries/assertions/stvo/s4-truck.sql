-- title = "Lorries and buses: fifty metres behind the vehicle ahead"
-- breach = "Lorry or bus less than fifty metres behind the vehicle ahead"
-- clause = "StVO 4(3): lorries over 3.5 t and buses keep at least 50 m behind the vehicle ahead on motorways when faster than 50 km/h"
-- hypothesis = "At every step faster than 50 km/h, did the lorry or bus keep 50 m behind the vehicle ahead?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = ">="
-- unit = "m"
-- observes = "gap to the vehicle ahead"
-- near_margin = 2.0
-- reads = ["ego_condition", "following"]
-- requires = ["way", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
-- vehicle_class = ["bus", "goods_7t5", "goods_over_7t5"]
--
-- [params.gap_m]
-- default = 50.0
-- unit = "m"
-- why = "least distance"
-- source = "StVO 4(3)"
--
-- [params.from_mps]
-- default = 13.89
-- unit = "m/s"
-- why = "50 km/h"
-- source = "StVO 4(3)"
--
-- [params.cut_in_s]
-- default = 3.0
-- unit = "s"
-- why = "time to restore the distance after another vehicle changed lane in front; an ego that changes lanes itself must keep it at once"
-- source = "case law: a gap that is too small only for a moment is no offence; time as in R_G1 of Maierhofer et al. 2020"
--
-- [reasons.weight_unknown]
-- says = "the ego was {gap_m:.1f} m behind the vehicle ahead: it is not known whether the ego weighs more than 3.5 t"

-- @condition
-- A goods vehicle of up to 7.5 t may be a van of up to 3.5 t, for which the rule requires nothing.
SELECT drive_id, ego_id, t_ns, f.gap_m AS observed, CASE WHEN c.vehicle_class <> 'goods_7t5' OR f.gap_m >= $gap_m THEN $gap_m END AS required,
    CASE WHEN c.vehicle_class = 'goods_7t5' AND f.gap_m < $gap_m THEN why('weight_unknown', {'gap_m': f.gap_m}) END AS reason,
    follows AND ego_speed_mps > $from_mps AND coalesce(t_ns - let_in_ns >= $cut_in_s * 1e9, true) AS applies
FROM following f
JOIN ego_condition c USING (drive_id, ego_id, t_ns)
