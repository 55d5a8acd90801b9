-- The logs that only one of two audits has.
SELECT d.log FROM {of}drives d ANTI JOIN same_drive s ON s.{side}_key = d.key ORDER BY d.log, d.key LIMIT $most
