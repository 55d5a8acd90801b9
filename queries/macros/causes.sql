-- The reason for a value, or for a value that is not known: a code with arguments, as JSON text. The words of each code are in
-- src/drivelint/reasons/words.toml or, for the codes of one rule, in the rule's header. The names of the arguments contain units: t_ns is a
-- time of the log, gap_m a length, object_id an actor.
CREATE OR REPLACE MACRO why(code) AS to_json({'code': code})::VARCHAR, (code, args) AS to_json({'code': code, 'args': args})::VARCHAR;
