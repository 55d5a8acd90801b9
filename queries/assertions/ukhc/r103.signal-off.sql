-- title = "Signal off after the manoeuvre"
-- breach = "Signal still on after the manoeuvre"
-- clause = "UKHC R103: cancel your signals after use; a signal left on misleads"
-- hypothesis = "After the last lane change or turn that it was on for, did the indicator go off in time?"
-- kind = "postcondition"
-- subtype = "temporal"
-- window_s = "off_s"
-- quantifier = "eventually"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- reads = ["ego_state", "indicator_on", "junction_passage", "lane_change"]
-- requires = ["map", "registration", "indicator", "ego_size"]
--
-- [params.off_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: time to cancel a signal once the vehicle is where it wanted to be"
--
-- # Draft: it may already announce a next manoeuvre that never came; how long is too long is a judgement.

-- @reference
WITH manoeuvre AS (
    SELECT drive_id, ego_id, side, t_start_ns, t_done_ns FROM lane_change
    UNION ALL
    SELECT drive_id, ego_id, turn, t_in_ns, t_out_ns FROM junction_passage
)
-- If the end of one manoeuvre is not known, the end of the last one is not known.
SELECT i.drive_id, i.ego_id, i.side, i.occurrence, CASE WHEN count(*) = count(m.t_done_ns) THEN max(m.t_done_ns) END AS t_ns
FROM indicator_on i
JOIN manoeuvre m ON m.drive_id = i.drive_id AND m.ego_id = i.ego_id AND m.side = i.side AND m.t_start_ns >= i.t_on_ns AND m.t_start_ns <= i.t_off_ns
GROUP BY i.drive_id, i.ego_id, i.side, i.occurrence

-- @condition
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, e.indicator <> r.side AS holds
FROM reference_step s
JOIN reference r USING (ref_id)
JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
