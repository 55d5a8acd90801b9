-- Models of the German rules and of UN R157. Speeds in m/s, decelerations positive.

-- Gap that lets a follower stop behind its leader when both brake as hard as they can, the follower after its reaction time (Maierhofer et
-- al. 2020, R_G1; StVO 4(1)); 0 if the leader's braking distance is longer.
CREATE OR REPLACE MACRO stvo_safe_gap_m(v_mps, v_lead_mps, reaction_s, brake_mps2, brake_lead_mps2) AS
    CASE WHEN v_mps * reaction_s + v_mps ** 2 / (2 * brake_mps2) < v_lead_mps ** 2 / (2 * brake_lead_mps2) THEN 0.0::DOUBLE
    ELSE v_mps * reaction_s + v_mps ** 2 / (2 * brake_mps2) - v_lead_mps ** 2 / (2 * brake_lead_mps2) END;

-- Least following distance of UN R157 5.2.3.3: a time gap of 1.0 s at 7.2 km/h, 1.1 s at 10, then 0.1 s more per 10 km/h up to 1.6 s at 60,
-- linear between these points; never less than 2 m. Beyond 60 km/h the law of the country applies, not this table.
CREATE OR REPLACE MACRO r157_gap_m(v_mps) AS CASE
    WHEN v_mps <= 2.0 THEN 2.0::DOUBLE
    WHEN v_mps * 3.6 <= 10 THEN v_mps * (1.0 + 0.1 * (v_mps * 3.6 - 7.2) / 2.8)
    ELSE v_mps * (1.1 + 0.01 * (v_mps * 3.6 - 10)) END;
