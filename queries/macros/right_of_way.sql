-- What the rules on junctions, crossings and stopping share.

-- Whether a light forbids to go on (Highway Code Rule 175): red, and red with amber.
CREATE OR REPLACE MACRO forbids(light) AS light IN ('red', 'red_amber');

-- Whether the ego stands in a queue: somebody slow close ahead in its lane. `known`: nobody else can be nearer; NULL: not known.
CREATE OR REPLACE MACRO queued(ahead_id, ahead_gap_m, ahead_speed_mps, known, near_m, slow_mps) AS
    ((ahead_id IS NOT NULL AND ahead_gap_m <= near_m AND ahead_speed_mps <= slow_mps) OR CASE WHEN known THEN false END);

-- A PET that was seen while somebody else could not be placed (`reason`) is only the most that it can be: it shows too little, not enough.
CREATE OR REPLACE MACRO pet_known(pet_s, reason, enough_s) AS CASE WHEN reason IS NULL OR pet_s < enough_s THEN pet_s END;

-- How somebody met the ego, in words.
CREATE OR REPLACE MACRO met_words(object_id, pet_s, decel_mps2) AS
    object_id || CASE WHEN pet_s < 0 THEN ' was there at the same time' ELSE format(' came {:.1f} s after the ego', pet_s) END
    || coalesce(format(' and braked with {:.1f} m/s2', decel_mps2), '');
