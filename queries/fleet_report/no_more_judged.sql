-- The drives that the base judged and the newer audit could not judge, and why.
SELECT n.log, n.key AS new_key, b.log AS base_log, n.status_reason AS reason
FROM same_drive s
JOIN {base}drives b ON b.key = s.base_key AND b.status = 'judged'
JOIN {new}drives n ON n.key = s.new_key AND n.status <> 'judged'
ORDER BY n.log, n.key, b.log, b.key
