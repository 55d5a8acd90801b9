-- title = "Hazard lights in a minimal risk manoeuvre"
-- breach = "No hazard lights in a minimal risk manoeuvre"
-- clause = "UN R157 5.5.1: the hazard warning lights come on with the start of a minimal risk manoeuvre (5.5.4: and stay on at its end)"
-- hypothesis = "During a minimal risk manoeuvre, were the hazard warning lights on?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- exempt_after_s = "grace_s"
-- tags = ["standing"]
-- reads = ["ego_mode", "ego_state"]
-- requires = ["mode_engaged", "mode_minimal_risk_manoeuvre", "indicator"]
--
-- [params.grace_s]
-- default = 0.5
-- unit = "s"
-- why = "our default: a lamp and its message take that long"
--
-- [reasons.signals_to_side]
-- says = "the ego signals to the {side}: from the 01 series on, such a manoeuvre may change lanes"
-- advice = "see in a video whether it did"

-- @condition
-- The lamps cannot show both: while the manoeuvre changes lanes, as from the 01 series on (not seen) it may, they show the side.
SELECT drive_id, ego_id, t_ns, CASE WHEN e.indicator NOT IN ('left', 'right') THEN e.indicator = 'hazard' END AS holds, mrm.is_on AS applies,
    CASE WHEN e.indicator IN ('left', 'right') THEN why('signals_to_side', {'side': e.indicator}) END AS reason
FROM ego_state e
LEFT JOIN (SELECT * FROM ego_mode WHERE mode = 'minimal_risk_manoeuvre') mrm USING (drive_id, ego_id, t_ns)
