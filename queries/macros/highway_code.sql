-- Models that several rules share. Speeds in m/s unless the name says otherwise.

CREATE OR REPLACE MACRO mph(v_mps) AS v_mps / 0.44704;

-- Thinking and stopping distance of Highway Code Rule 126 as Harper et al. 2021 fit it (speed in mph, metres out).
CREATE OR REPLACE MACRO thinking_distance_m(v_mps) AS 0.300 * mph(v_mps);
CREATE OR REPLACE MACRO stopping_distance_m(v_mps) AS 0.300 * mph(v_mps) + 0.058 - 0.011 * mph(v_mps) + 0.015 * mph(v_mps) ** 2;

-- Length of a danger space: the stopping distance, and 0 for a vehicle that stands (the constant of the fit would leave 6 cm).
CREATE OR REPLACE MACRO danger_space_m(v_mps) AS CASE WHEN v_mps < 0.05 THEN 0.0 ELSE stopping_distance_m(v_mps) END;

-- Safe distance ahead (Appendix A of Harper et al. 2021). w: lane width; beta, theta: pull-out and cut-in angle; headroom, clearance: gaps
-- to the vehicle being passed (VBP) when pulling out and cutting in start. AV: the ego; OV: the oncoming vehicle. Undefined (NULL) if the
-- ego is not faster than the VBP.
CREATE OR REPLACE MACRO pull_out_time_s(w, beta, v_av) AS w / (v_av * sin(beta));
CREATE OR REPLACE MACRO passing_time_s(w, beta, headroom, clearance, l_av, l_vbp, v_av, v_vbp) AS
    CASE WHEN v_av > v_vbp THEN
        (headroom + l_vbp + clearance + l_av + (v_vbp - v_av * cos(beta)) * pull_out_time_s(w, beta, v_av)) / (v_av - v_vbp)
    END;
CREATE OR REPLACE MACRO overtaking_time_s(w, beta, theta, headroom, clearance, l_av, l_vbp, v_av, v_vbp) AS
    pull_out_time_s(w, beta, v_av) + passing_time_s(w, beta, headroom, clearance, l_av, l_vbp, v_av, v_vbp) + pull_out_time_s(w, theta, v_av);
CREATE OR REPLACE MACRO safe_distance_ahead_m(w, beta, theta, headroom, clearance, l_av, l_vbp, v_av, v_vbp, v_ov) AS
    w / tan(beta) + w / tan(theta) + stopping_distance_m(v_ov)
    + v_av * passing_time_s(w, beta, headroom, clearance, l_av, l_vbp, v_av, v_vbp)
    + v_ov * overtaking_time_s(w, beta, theta, headroom, clearance, l_av, l_vbp, v_av, v_vbp);

-- The distance that a vehicle drives in t_s if it has the speed v and accelerates to v_most by at most 3.5 m/s2 (a brisk start). The second
-- macro: the greatest possible mean speed over total_s, if the vehicle drove gone_m in the first gone_s and then has the speed v.
CREATE OR REPLACE MACRO speeding_up_m(t_s, v_mps, v_most_mps) AS
    v_mps * t_s + 3.5 * least(t_s, greatest(v_most_mps - v_mps, 0) / 3.5) * (t_s - least(t_s, greatest(v_most_mps - v_mps, 0) / 3.5) / 2);
CREATE OR REPLACE MACRO most_mean_mps(total_s, gone_s, gone_m, v_mps, v_most_mps) AS
    (gone_m + speeding_up_m(greatest(total_s - gone_s, 0), v_mps, v_most_mps)) / greatest(total_s, gone_s);

-- Performance zone of an overtake by the time in which the spare distance closes.
CREATE OR REPLACE MACRO overtake_zone(spare_m, spare_s) AS
    CASE WHEN spare_m <= 0 THEN 'A' WHEN spare_s < 0.5 THEN 'B' WHEN spare_s <= 2.5 THEN 'C' WHEN spare_s > 2.5 THEN 'D' END;

-- Whether an actor may be passed over a line that must not be crossed (UKHC R129): standing vehicles and objects, and cyclists, horses and
-- works vehicles at 10 mph or less. A lorry, van or vehicle of unknown kind that is as slow as that may be a works vehicle: NULL.
CREATE OR REPLACE MACRO may_be_passed_over_solid_line(actor_class, length_m, speed_mps) AS
    (is_vehicle(actor_class) OR is_class(actor_class, 'object')) AND speed_mps <= standing_mps()
    OR (is_bicycle(actor_class, length_m) OR is_class(actor_class, 'animal')) AND speed_mps <= 4.4704
    OR CASE WHEN actor_class IN ('truck', 'van', 'vehicle') AND speed_mps <= 4.4704 THEN NULL ELSE false END;

-- Room to leave beside a passed actor: the width of a door, 1.5 m for a cyclist and 2 m for a horse (UKHC R163).
CREATE OR REPLACE MACRO passing_room_m(actor_class) AS CASE actor_class WHEN 'animal' THEN 2.0 WHEN 'bicycle' THEN 1.5 ELSE 1.0 END;

-- Factor by which the stopping distance and the two seconds increase with the weather: 2 in the wet (Rule 227), up to 10 on ice (Rule 230).
-- Unknown weather counts as dry: a vehicle that is too close in the dry is too close in any weather.
CREATE OR REPLACE MACRO stopping_factor(weather) AS CASE weather WHEN 'wet' THEN 2.0::DOUBLE WHEN 'ice' THEN 10.0::DOUBLE ELSE 1.0::DOUBLE END;

-- An actor of unknown class may be the vehicle ahead. That matters within this distance, 20 s at the ego's speed: on ice, the two seconds
-- become 20.
CREATE OR REPLACE MACRO unsure_reach_m(v_mps) AS greatest(lost_near_m(), 20.0 * coalesce(v_mps, 70.0));

-- The side on which to overtake: the opposite of the side to which traffic keeps.
CREATE OR REPLACE MACRO overtaking_side(handedness) AS CASE handedness WHEN 'lht' THEN 'right' WHEN 'rht' THEN 'left' END;

-- Speed limits of Rule 124 for a class of vehicle outside built-up areas, in mph. road: single, dual or motorway. The 70 mph for buses on
-- motorways apply up to a length of 12 m.
CREATE OR REPLACE MACRO class_limit_mph(vehicle_class, length_m, nation, road) AS
    CASE
        WHEN vehicle_class IN ('car', 'motorcycle') THEN CASE road WHEN 'single' THEN 60 ELSE 70 END
        WHEN vehicle_class = 'goods_7t5' OR vehicle_class = 'bus' AND length_m <= 12 THEN CASE road WHEN 'single' THEN 50 WHEN 'dual' THEN 60 ELSE 70 END
        WHEN vehicle_class = 'goods_over_7t5' AND nation = 'gb-sct' THEN CASE road WHEN 'single' THEN 40 WHEN 'dual' THEN 50 ELSE 60 END
        ELSE CASE road WHEN 'single' THEN 50 ELSE 60 END
    END;

-- The highest and the lowest limit of Rule 124, in m/s, that may apply if some arguments are not known. signed: the map states a limit,
-- which replaces the limit for built-up areas (20 mph in Wales, else 30). A town map without limits may be of any country: the built-up
-- limit counts as the highest only if the nation is given. The lowest is that of a map that states a limit.
CREATE OR REPLACE MACRO most_limit_mps(vehicle_class, length_m, nation, road_type, carriageway, area, signed) AS
    0.44704 * CASE
        WHEN NOT signed AND area = 'built_up' AND nation IS NOT NULL THEN CASE nation WHEN 'gb-wls' THEN 20 ELSE 30 END
        ELSE class_limit_mph(
            coalesce(vehicle_class, 'car'), coalesce(length_m, 0.0), coalesce(nation, 'gb'),
            CASE WHEN coalesce(road_type, 'motorway') = 'motorway' AND coalesce(carriageway, 'dual') = 'dual' THEN 'motorway' ELSE coalesce(carriageway, 'dual') END
        )
    END;
CREATE OR REPLACE MACRO least_limit_mps(vehicle_class, length_m, nation, road_type, carriageway) AS
    0.44704 * class_limit_mph(
        coalesce(vehicle_class, 'goods_over_7t5'), coalesce(length_m, 'inf'::DOUBLE), CASE WHEN coalesce(nation, 'gb') = 'gb' THEN 'gb-sct' ELSE nation END,
        CASE WHEN road_type = 'motorway' THEN 'motorway' ELSE coalesce(carriageway, 'single') END
    );
