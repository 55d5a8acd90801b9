-- The clocks of the egos that are judged in this part of the run.
SELECT c.* FROM ego_clock c ANTI JOIN deferred_ego USING (drive_id, ego_id)
