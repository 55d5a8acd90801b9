-- The author's reference points of the subjects that are to be judged.
CREATE OR REPLACE TEMP TABLE _raw_reference AS
WITH _returned_reference AS (
{reference}
) SELECT r.* FROM _returned_reference r SEMI JOIN _subject s ON r.drive_id = s.drive_id
    AND r.ego_id = s.ego_id{todo}
