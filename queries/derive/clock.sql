-- The egos that are judged now; those of another part of the run rest meanwhile.
SELECT c.* FROM ego_clock c ANTI JOIN deferred_ego USING (drive_id, ego_id)
