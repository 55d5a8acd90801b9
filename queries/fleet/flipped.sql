-- The first of the verdicts that change, or that need a new check (`becomes` NULL), those of a log together.
SELECT r.log, w.ego_id, w.profile, w.object_id, w.occurrence, w.was, w.becomes
FROM what_if w JOIN {of}receipts r ON r.key = w.key
WHERE w.becomes IS DISTINCT FROM w.was
ORDER BY ALL NULLS FIRST
LIMIT $most
