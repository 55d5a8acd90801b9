-- Macros that the rules on junctions, crossings and stopping share.

-- Whether a light forbids going on (Highway Code Rule 175): red, and red with amber.
CREATE OR REPLACE MACRO forbids(state) AS state IN ('red', 'red_amber');

-- A vehicle that stands closer than stands_near_m behind an actor stands because of it. A vehicle slower than moves_up_mps moves up in a
-- queue.
CREATE OR REPLACE MACRO stands_near_m() AS 10.0;
CREATE OR REPLACE MACRO moves_up_mps() AS 1.0;

-- Whether the ego stands in a queue: a slow vehicle is close ahead in its lane. `known`: no other vehicle can be nearer. Result NULL: not
-- known.
CREATE OR REPLACE MACRO queued(ahead_id, ahead_gap_m, ahead_speed_mps, known, near_m, slow_mps) AS
    ((ahead_id IS NOT NULL AND ahead_gap_m <= near_m AND ahead_speed_mps <= slow_mps) OR CASE WHEN known THEN false END);

-- Whether the ego stands because its exit is full. The ego stands where it must keep clear, and its rear still has to drive `clear_m` to
-- leave. A short stand (less than `long_s`): true if a slow vehicle is within `near_m` or within `clear_m`. A longer stand: true if a slow
-- vehicle is within `near_m` of the place where the ego would just have left; else NULL, because the cause of so long a stand is not known.
CREATE OR REPLACE MACRO exit_full(ahead_id, ahead_gap_m, ahead_speed_mps, known, clear_m, stood_ns, near_m, slow_mps, long_s) AS
    CASE
        WHEN ahead_id IS NULL THEN CASE WHEN known THEN false END
        WHEN stood_ns < long_s * 1e9 THEN queued(ahead_id, ahead_gap_m, ahead_speed_mps, known, greatest(near_m, coalesce(clear_m, 0)), slow_mps)
        WHEN ahead_speed_mps <= slow_mps AND ahead_gap_m <= near_m + coalesce(clear_m, 0) THEN true
    END;

-- A post-encroachment time (PET) that was measured while another actor had no position (`reason`) is an upper bound: it can show that the
-- PET is too short, but not that it is long enough. `concerns`: the rule is about an actor of this class. If that is not known, a PET that
-- is long enough keeps the rule, and a short one does not break it.
CREATE OR REPLACE MACRO pet_known(pet_s, reason, enough_s, concerns) AS
    CASE WHEN pet_s < enough_s THEN CASE WHEN concerns THEN pet_s END WHEN reason IS NULL THEN pet_s END;

-- How an actor met the ego, as a reason. NULL: no actor did.
CREATE OR REPLACE MACRO met_reason(object_id, pet_s, decel_mps2) AS CASE WHEN object_id IS NOT NULL AND pet_s IS NOT NULL THEN
    why(CASE WHEN pet_s < 0 THEN 'met_at_same_time' ELSE 'met_later' END, {'object_id': object_id, 'pet_s': pet_s, 'decel_mps2': decel_mps2}) END;

-- Why it is not known whether an actor that came late enough braked for the ego: it braked harder than `hard_mps2`, and was not made to
-- brake (made_to_brake). NULL: it did not brake so hard, or came too soon.
CREATE OR REPLACE MACRO braking_doubt(object_id, pet_s, decel_mps2, hard_mps2, enough_s) AS CASE WHEN decel_mps2 > hard_mps2 AND pet_s >= enough_s THEN
    why('braked_and_came_later', {'object_id': object_id, 'decel_mps2': decel_mps2, 'pet_s': pet_s}) END;

-- Whether the ego made an actor brake: the actor braked harder than `hard_mps2`, and at its speed it would have come within `enough_s` of
-- the ego. NULL: it may have braked for something else.
CREATE OR REPLACE MACRO made_to_brake(decel_mps2, pet_s, other_cause, hard_mps2, enough_s) AS
    CASE WHEN coalesce(decel_mps2 > hard_mps2 AND pet_s < enough_s, false) THEN CASE WHEN other_cause IS NULL THEN true END ELSE false END;

-- The PET that counts: the lower of the PET with the actor that the ego met and the PET with the actor that the ego made brake. If it is
-- not known whether the ego made an actor brake, the PET is known only if it is too short.
CREATE OR REPLACE MACRO pet_forced(pet_s, forced, forced_pet_s, enough_s) AS
    CASE WHEN forced THEN least(pet_s, forced_pet_s) WHEN NOT forced OR pet_s < enough_s THEN pet_s END;

-- How an actor braked before the ego, as a reason. NULL: no actor did.
CREATE OR REPLACE MACRO braked_reason(object_id, pet_s, decel_mps2, other_cause) AS CASE WHEN object_id IS NOT NULL AND decel_mps2 IS NOT NULL AND pet_s IS NOT NULL THEN
    why(CASE WHEN pet_s < 0 THEN 'braked_before_meeting' ELSE 'braked_before_ego' END, {'object_id': object_id, 'decel_mps2': decel_mps2, 'pet_s': pet_s, 'other_cause': other_cause}) END;

-- The reason if it is not known whether the rule is about an actor.
CREATE OR REPLACE MACRO class_doubt(object_id) AS CASE WHEN object_id IS NOT NULL THEN why('class_unknown', {'object_id': object_id}) END;

-- Whether the ego stands at a stop line because it must: before a stop or give-way sign, or a light that was not green when the ego stopped.
-- NULL: the light, or what governs the line, is not known.
CREATE OR REPLACE MACRO waits_at_line(stop_line_id, control, state) AS
    CASE WHEN stop_line_id IS NULL OR state = 'green' THEN false WHEN control IN ('stop', 'give_way') OR forbids(state) OR state = 'amber' THEN true END;
