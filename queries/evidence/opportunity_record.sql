INSERT INTO opportunity_record BY NAME
SELECT o.*, p.style FROM opportunity o JOIN profile p USING (profile)
