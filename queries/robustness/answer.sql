UPDATE finding SET n_copies = a.n_copies, n_stays = a.n_stays
FROM _answer a WHERE finding.drive_id = a.drive_id AND finding.finding_id = a.finding_id
