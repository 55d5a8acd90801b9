-- title = "Safe distance to the vehicle ahead"
-- breach = "Too close to the vehicle ahead"
-- clause = "StVO 4(1) (R_G1 of Maierhofer et al. 2020): keep so far behind the vehicle ahead that you can stop even if it brakes suddenly"
-- hypothesis = "At every step behind a vehicle, could the ego have stopped behind it if that vehicle had braked as hard as it can?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = ">="
-- unit = "m"
-- observes = "gap to the vehicle ahead"
-- near_margin = 1.0
-- reads = ["following"]
-- requires = ["way", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.reaction_s]
-- default = 0.3
-- unit = "s"
-- why = "time before the follower brakes"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.brake_mps2]
-- default = 10.0
-- unit = "m/s2"
-- why = "hardest deceleration of the follower"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.brake_lead_mps2]
-- default = 10.5
-- unit = "m/s2"
-- why = "hardest deceleration of the vehicle ahead"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.cut_in_s]
-- default = 3.0
-- unit = "s"
-- why = "time to restore the distance after another vehicle changed lane in front; an ego that changes lanes itself must keep it at once"
-- source = "Maierhofer et al. 2020, R_G1"

-- @condition
SELECT drive_id, ego_id, t_ns, gap_m AS observed,
    stvo_safe_gap_m(ego_speed_mps, speed_mps, $reaction_s, $brake_mps2, $brake_lead_mps2) AS required,
    -- A vehicle that is not seen is at least free_m away. The rule does not apply if that is enough even behind a standing vehicle.
    CASE WHEN follows IS NULL AND free_m >= stvo_safe_gap_m(ego_speed_mps, 0.0, $reaction_s, $brake_mps2, $brake_lead_mps2) THEN false
        ELSE follows AND coalesce(t_ns - let_in_ns >= $cut_in_s * 1e9, true) END AS applies
FROM following
