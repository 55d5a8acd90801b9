-- Limits of comfort.

-- A limit of ISO 15622: `slow` up to 5 m/s, `fast` from 20 m/s on, linear in between.
CREATE OR REPLACE MACRO iso15622_limit(v_mps, slow, fast) AS
    CASE WHEN v_mps <= 5 THEN slow WHEN v_mps >= 20 THEN fast WHEN v_mps IS NOT NULL THEN slow + (fast - slow) * (v_mps - 5) / 15 END;

-- Whether a filtered value is to be judged: if it is known, or if it is unknown although the log extends over edge_s before and after it.
-- At the ends of the log, the filter has no complete window; such an unknown value says nothing about the drive.
CREATE OR REPLACE MACRO is_judged(value, t_ns, t_start_ns, t_end_ns, edge_s) AS
    value IS NOT NULL OR (t_ns - t_start_ns >= edge_s * 1_000_000_000 AND t_end_ns - t_ns >= edge_s * 1_000_000_000);

-- A filtered value, if it decides: it is above the limit, or it is within the limit even if the filter flattened its peak. Else NULL.
CREATE OR REPLACE MACRO peak_sure_at_most(value, rise, most) AS
    CASE WHEN value > most OR value + rise <= most THEN value END;
