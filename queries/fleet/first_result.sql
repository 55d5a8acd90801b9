-- Part of the statements of this folder, behind ORDER BY: the results `d` of one log, the first one first. Keys are hashes of versions too, so
-- they decide last: two audits of the same logs have the same first results.
d.log, d.map_sha256 NULLS FIRST, d.conditions::VARCHAR NULLS FIRST, d.key
