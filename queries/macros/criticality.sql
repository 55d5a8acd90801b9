-- Measures of how near a rear-end collision is (definitions: Westhofen et al. 2023). Gaps in m, speeds in m/s; infinite: never.

-- Speed along the lane, in either direction; 0 for an actor that moves at a right angle to the lane.
CREATE OR REPLACE MACRO along_lane_mps(speed_mps, heading_diff_rad) AS speed_mps * coalesce(abs(cos(heading_diff_rad)), 1.0);

-- Speed along the corridor: positive for a vehicle that heads in its direction, negative for one against it.
CREATE OR REPLACE MACRO along_mps(speed_mps, oncoming) AS CASE WHEN oncoming THEN -speed_mps WHEN NOT oncoming THEN speed_mps END;

-- Time to collision at present speeds.
CREATE OR REPLACE MACRO ttc_s(gap_m, closing_mps) AS
    CASE WHEN closing_mps > 0 THEN gap_m / closing_mps WHEN closing_mps <= 0 AND gap_m IS NOT NULL THEN 'inf'::DOUBLE END;

-- A longer time counts as infinite: it results from a speed difference that is too small for any log to resolve.
CREATE OR REPLACE MACRO never_after_s() AS 600.0;
-- A time, or infinite if it is too long, unless the rule requires more.
CREATE OR REPLACE MACRO or_never(time_s, required_s) AS
    CASE WHEN time_s > greatest(never_after_s(), required_s) THEN 'inf'::DOUBLE ELSE time_s END;

-- A value, if its worst and its best case (by the errors of its inputs) are on the same side of the required value; else NULL.
-- `sure_at_least`: the value must be at least the required one. `sure_at_most`: the value must be at most the required one.
CREATE OR REPLACE MACRO sure_at_least(value, worst, best, required) AS CASE WHEN worst >= required OR best < required THEN value END;
CREATE OR REPLACE MACRO sure_at_most(value, worst, best, required) AS CASE WHEN worst <= required OR best > required THEN value END;

-- By how much a value may be above the recorded one, if it is in doubt (`doubt_ns`, NULL: it is not): infinite without a bound.
CREATE OR REPLACE MACRO above_mps(doubt_ns, most, recorded) AS
    CASE WHEN doubt_ns IS NULL OR most <= recorded THEN 0.0::DOUBLE ELSE coalesce(most - recorded, 'inf'::DOUBLE) END;
-- Whether a rule applies, if it was found with speeds that may be wrong by `doubt_mps`: a wrong speed must not excuse.
CREATE OR REPLACE MACRO unless_in_doubt(applies, doubt_mps) AS CASE WHEN applies OR doubt_mps <= 0 THEN applies END;

-- Whether the two may still touch: false if it is known that they pass each other, unknown if they may graze each other.
CREATE OR REPLACE MACRO may_touch(passes_by, grazes) AS CASE WHEN passes_by THEN false WHEN grazes THEN NULL ELSE true END;
-- The limit of criticality.ttc by default, for what plots the time that the rule judges.
CREATE OR REPLACE MACRO serious_ttc_s() AS 1.5;
-- Whether a limit must be kept: who may graze another keeps it either way while the measure does.
CREATE OR REPLACE MACRO must_keep(passes_by, grazes, keeps) AS may_touch(passes_by, coalesce(grazes, false) AND NOT coalesce(keeps, false));

-- Time headway: the time until the ego's front reaches the present position of the other's rear.
CREATE OR REPLACE MACRO thw_s(gap_m, v_mps) AS
    CASE WHEN v_mps > 0 THEN gap_m / v_mps WHEN v_mps <= 0 AND gap_m IS NOT NULL THEN 'inf'::DOUBLE END;

-- Deceleration rate to avoid the crash: the deceleration that removes the closing speed within the gap.
CREATE OR REPLACE MACRO drac_mps2(gap_m, closing_mps) AS
    CASE
        WHEN gap_m > 0 AND closing_mps > 0 THEN closing_mps ** 2 / (2 * gap_m)
        WHEN gap_m <= 0 AND closing_mps > 0 THEN 'inf'::DOUBLE
        WHEN closing_mps <= 0 AND gap_m IS NOT NULL THEN 0.0::DOUBLE
    END;

-- Time to brake: how long the ego can wait until only full braking avoids the collision; negative: it is too late.
CREATE OR REPLACE MACRO ttb_s(gap_m, closing_mps, brake_mps2) AS
    CASE WHEN closing_mps > 0 THEN gap_m / closing_mps - closing_mps / (2 * brake_mps2) ELSE ttc_s(gap_m, closing_mps) END;

-- Time until a gap is closed, if it closes at the speed dv, which grows by da per second: the smallest positive root of gap = dv t + da t^2
-- / 2.
CREATE OR REPLACE MACRO gap_closed_s(gap_m, dv, da) AS
    CASE
        WHEN dv ** 2 + 2 * da * gap_m >= 0 AND dv + sqrt(greatest(dv ** 2 + 2 * da * gap_m, 0)) > 0
            THEN 2 * gap_m / (dv + sqrt(greatest(dv ** 2 + 2 * da * gap_m, 0)))
        WHEN dv + da + gap_m IS NOT NULL THEN 'inf'::DOUBLE
    END;

-- Time after which a vehicle that brakes stands; infinite: it does not brake.
CREATE OR REPLACE MACRO stopped_after_s(v_mps, a_mps2) AS
    CASE WHEN v_mps * a_mps2 < 0 OR v_mps = 0 AND a_mps2 < 0 THEN -v_mps / a_mps2 WHEN v_mps + a_mps2 IS NOT NULL THEN 'inf'::DOUBLE END;

-- Modified time to collision (Ozbay et al. 2008), at present accelerations; v_lead_mps is negative if the other comes towards the ego. Who
-- brakes, stops and does not reverse. So there are three cases: they meet while both move; the other stands first, and the ego drives up to
-- it; the ego stands first, and the other comes, if it is oncoming.
CREATE OR REPLACE MACRO mttc_s(gap_m, v_mps, a_mps2, v_lead_mps, a_lead_mps2) AS
    CASE
        WHEN gap_closed_s(gap_m, v_mps - v_lead_mps, a_mps2 - a_lead_mps2) <= least(stopped_after_s(v_mps, a_mps2), stopped_after_s(v_lead_mps, a_lead_mps2))
            THEN gap_closed_s(gap_m, v_mps - v_lead_mps, a_mps2 - a_lead_mps2)
        WHEN stopped_after_s(v_lead_mps, a_lead_mps2) <= stopped_after_s(v_mps, a_mps2)
            THEN gap_closed_s(gap_m - v_lead_mps ** 2 / (2 * a_lead_mps2), v_mps, a_mps2)
        WHEN v_lead_mps >= 0 AND gap_m + v_mps + a_mps2 + a_lead_mps2 IS NOT NULL THEN 'inf'::DOUBLE
        ELSE gap_closed_s(gap_m + v_mps ** 2 / (2 * a_mps2), -v_lead_mps, -a_lead_mps2)
    END;

-- An acceleration is a mean over half a second, or over this time at least: four steps at 10 samples a second, whose times jitter.
CREATE OR REPLACE MACRO least_mean_ns() AS 398_000_000;

-- Time for which the present lateral speed predicts an actor's position.
CREATE OR REPLACE MACRO drift_s() AS 3.0;

-- Whether the lead is ahead of the ego's own box: the two boxes overlap across the corridor. NULL if one of them has no position. A lead
-- alongside the ego is not ahead.
CREATE OR REPLACE MACRO lead_is_ahead(gap_m, d_m, lat_half_m, lead_d_m, lead_lat_half_m) AS
    gap_m >= 0 AND abs(d_m - lead_d_m) < lat_half_m + lead_lat_half_m;

-- Whether a motorcycle or bicycle may ride on the line beside the lead, between two lanes, and not behind the lead: its box may reach over
-- the line, and its centre is not surely within the lead's width.
CREATE OR REPLACE MACRO may_ride_on_line(actor_class, d_m, lat_half_m, lead_d_m, lead_lat_half_m, half_width_m) AS
    coalesce(
        actor_class IN ('motorcycle', 'bicycle') AND abs(d_m - lead_d_m) > lead_lat_half_m - measured_meeting_m()
        AND sign(d_m - lead_d_m) * d_m + lat_half_m > half_width_m - surely_out_m(),
        false
    );

-- Whether the lead will still be ahead when the ego arrives, at the present lateral speeds (positive to the left, from the heading relative
-- to the corridor). It will not if one of the two pulls out or comes in beside the other.
CREATE OR REPLACE MACRO on_course(gap_m, ttc_s, d_m, lat_half_m, lat_mps, lead_d_m, lead_lat_half_m, lead_lat_mps) AS
    gap_m >= 0 AND abs(d_m - lead_d_m + (lat_mps - lead_lat_mps) * CASE WHEN ttc_s > never_after_s() THEN 0.0 WHEN ttc_s < drift_s() THEN ttc_s WHEN ttc_s >= drift_s() THEN drift_s() END)
        < lat_half_m + lead_lat_half_m;

-- The time in which a point at p, moving at v, is within r of the origin. If it never is, from_s is later than to_s.
CREATE OR REPLACE MACRO time_within(p, v, r) AS
    CASE
        WHEN abs(v) > 1e-6 THEN {'from_s': (-r * sign(v) - p) / v, 'to_s': (r * sign(v) - p) / v}
        WHEN abs(p) <= r THEN {'from_s': '-inf'::DOUBLE, 'to_s': 'inf'::DOUBLE}
        WHEN abs(p) > r THEN {'from_s': 'inf'::DOUBLE, 'to_s': '-inf'::DOUBLE}
    END;
-- Boxes that pass each other at a smaller distance than this may touch: headings are not known more accurately.
CREATE OR REPLACE MACRO least_apart_m() AS 0.1;

-- Whether at least one of the two moves. The recorded speeds of standing vehicles jitter, even of two in contact.
CREATE OR REPLACE MACRO either_moves(ego_mps, lead_mps) AS ego_mps > standing_mps() OR lead_mps > standing_mps();

-- Whether a vehicle ahead comes towards the ego. A vehicle that stands facing the ego does not.
CREATE OR REPLACE MACRO comes(speed_mps, oncoming) AS oncoming AND speed_mps > standing_mps();

-- Whether the ego follows its lead: part of the ego is in the lane, and the lead is neither alongside nor moving towards the ego. A lead
-- that is parked facing the ego counts: it is in the way, too.
CREATE OR REPLACE MACRO follows(in_lane, gap_m, speed_mps, oncoming) AS in_lane AND gap_m >= 0 AND NOT comes(speed_mps, oncoming);

-- Whether the lead comes towards the ego in its lane.
CREATE OR REPLACE MACRO meets(in_lane, gap_m, speed_mps, oncoming) AS in_lane AND gap_m >= 0 AND comes(speed_mps, oncoming);

-- Speed, away from the ego, of a vehicle that the ego follows. A followed vehicle that faces the ego is a parked one: its speed is 0.
CREATE OR REPLACE MACRO ahead_mps(speed_mps, oncoming) AS CASE WHEN oncoming THEN 0.0::DOUBLE WHEN NOT oncoming THEN speed_mps END;
