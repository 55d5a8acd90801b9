-- Responsibility-Sensitive Safety (Shalev-Shwartz, Shammah, Shashua 2017, arXiv:1708.06374): least safe distances. Speeds in m/s.

-- Distance that a vehicle drives if it accelerates at `a` during the response time rho and then brakes at `b` to a stop. If v is negative,
-- the vehicle moves away.
CREATE OR REPLACE MACRO rss_way_m(v, rho, a, b) AS v * rho + a * rho ** 2 / 2 + CASE WHEN v + a * rho > 0 THEN (v + a * rho) ** 2 / (2 * b) ELSE 0 END;

-- Definition 1: the front vehicle brakes with b_max, and the rear vehicle responds after the time rho.
CREATE OR REPLACE MACRO rss_longitudinal_m(v_rear, v_front, rho, a_acc, b_min, b_max) AS
    CASE WHEN v_rear + v_front IS NOT NULL THEN greatest(0.0, rss_way_m(v_rear, rho, a_acc, b_min) - v_front ** 2 / (2 * b_max)) END;

-- Definition 6: two vehicles drift towards each other (speeds across the road, positive towards the other). mu is the lateral fluctuation.
CREATE OR REPLACE MACRO rss_lateral_m(v1, rho1, v2, rho2, a_lat, b_lat, mu) AS
    CASE WHEN v1 + v2 IS NOT NULL THEN mu + greatest(0.0, rss_way_m(v1, rho1, a_lat, b_lat) + rss_way_m(v2, rho2, a_lat, b_lat)) END;

-- The lateral distance for the ego and another actor, which does not drift while it stands. If their boxes are this far apart laterally, no
-- longitudinal distance is dangerous (definitions 3 and 7).
CREATE OR REPLACE MACRO rss_across_m(ego_lat_mps, rho, lat_mps, speed_mps, rho_other, a_lat, b_lat, mu) AS
    CASE WHEN speed_mps <= standing_mps() THEN rss_lateral_m(ego_lat_mps, rho, 0, 0, a_lat, b_lat, mu)
        WHEN speed_mps IS NOT NULL THEN rss_lateral_m(ego_lat_mps, rho, lat_mps, rho_other, a_lat, b_lat, mu) END;
