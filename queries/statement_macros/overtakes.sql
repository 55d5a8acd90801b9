-- The same verdicts as in the four rules on danger spaces (r126.ds-*): touching counts as inside. A vehicle that cannot be placed could
-- only make a verdict worse.
CREATE OR REPLACE MACRO danger_space_verdict(depth_m, ov_id, ov_known) AS CASE WHEN ov_id IS NULL AND ov_known THEN 'nobody'
    WHEN depth_m >= 0 THEN 'fail' WHEN depth_m < 0 AND ov_known THEN 'pass' ELSE 'unknown' END;
