-- What the rules on junctions, crossings and stopping share.

-- Whether a light forbids to go on (Highway Code Rule 175): red, and red with amber.
CREATE OR REPLACE MACRO forbids(light) AS light IN ('red', 'red_amber');

-- Who stands closer than this behind somebody stands because of them; slower than this moves up in a queue.
CREATE OR REPLACE MACRO stands_near_m() AS 10.0;
CREATE OR REPLACE MACRO moves_up_mps() AS 1.0;

-- Whether the ego stands in a queue: somebody slow close ahead in its lane. `known`: nobody else can be nearer; NULL: not known.
CREATE OR REPLACE MACRO queued(ahead_id, ahead_gap_m, ahead_speed_mps, known, near_m, slow_mps) AS
    ((ahead_id IS NOT NULL AND ahead_gap_m <= near_m AND ahead_speed_mps <= slow_mps) OR CASE WHEN known THEN false END);

-- Whether the way out was full for the ego, which stands where it must keep clear and whose rear has yet to go `clear_m`: somebody slow is
-- near, or leaves it no room to get out, or would be near if it had just got out and it stands for long. What holds it up for long behind
-- somebody further away, or quicker, nobody knows: NULL.
CREATE OR REPLACE MACRO exit_full(ahead_id, ahead_gap_m, ahead_speed_mps, known, clear_m, stood_ns, near_m, slow_mps, long_s) AS
    CASE
        WHEN ahead_id IS NULL THEN CASE WHEN known THEN false END
        WHEN stood_ns < long_s * 1e9 THEN queued(ahead_id, ahead_gap_m, ahead_speed_mps, known, greatest(near_m, coalesce(clear_m, 0)), slow_mps)
        WHEN ahead_speed_mps <= slow_mps AND ahead_gap_m <= near_m + coalesce(clear_m, 0) THEN true
    END;

-- A PET that was seen while somebody else could not be placed (`reason`) is only the most that it can be: it shows too little, not enough.
-- `concerns`: the rule is about such an actor; of one of whom that is not known, enough is known to be kept, and too little not to be broken.
CREATE OR REPLACE MACRO pet_known(pet_s, reason, enough_s, concerns) AS
    CASE WHEN pet_s < enough_s THEN CASE WHEN concerns THEN pet_s END WHEN reason IS NULL THEN pet_s END;

-- How somebody met the ego, in words.
CREATE OR REPLACE MACRO met_words(object_id, pet_s, decel_mps2) AS
    object_id || CASE WHEN pet_s < 0 THEN ' was there at the same time' ELSE format(' came {:.1f} s after the ego', pet_s) END
    || coalesce(format(' and braked with {:.1f} m/s2', decel_mps2), '');

-- Whether the ego made somebody brake: harder than `hard_mps2`, who at its speed would have come within `enough_s` of the ego. NULL: it may
-- have braked for something else.
CREATE OR REPLACE MACRO made_to_brake(decel_mps2, pet_s, other_cause, hard_mps2, enough_s) AS
    CASE WHEN coalesce(decel_mps2 > hard_mps2 AND pet_s < enough_s, false) THEN CASE WHEN other_cause IS NULL THEN true END ELSE false END;

-- That PET with whom it made to brake: it is too short for whoever had to.
CREATE OR REPLACE MACRO pet_forced(pet_s, forced, forced_pet_s, enough_s) AS
    CASE WHEN forced THEN least(pet_s, forced_pet_s) WHEN NOT forced OR pet_s < enough_s THEN pet_s END;

-- How somebody braked before the ego, in words.
CREATE OR REPLACE MACRO braked_words(object_id, pet_s, decel_mps2, other_cause) AS
    format('{} braked with {:.1f} m/s2; at its speed it would have ', object_id, decel_mps2)
    || CASE WHEN pet_s < 0 THEN 'been there at the same time' ELSE format('come within {:.1f} s of the ego', pet_s) END
    || CASE other_cause WHEN 'incomplete' THEN ', but its heading or size is not known' WHEN 'let_go' THEN ', but the ego stood as it began' WHEN 'somebody_else' THEN ', but somebody else was in its way'
        WHEN 'signal' THEN ', but there was a line or a light for it' WHEN 'bend' THEN ', but there was a bend before it' ELSE '' END;

-- Of whom it is not known whether the rule is about it.
CREATE OR REPLACE MACRO unsure_words(object_id) AS 'the class of ' || object_id || ' is not known: record it';
