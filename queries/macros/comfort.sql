-- Limits of comfort.

-- A limit of ISO 15622: `slow` up to 5 m/s, `fast` from 20 m/s on, straight in between.
CREATE OR REPLACE MACRO iso15622_limit(v_mps, slow, fast) AS
    CASE WHEN v_mps <= 5 THEN slow WHEN v_mps >= 20 THEN fast WHEN v_mps IS NOT NULL THEN slow + (fast - slow) * (v_mps - 5) / 15 END;
