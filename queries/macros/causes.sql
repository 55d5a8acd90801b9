-- Why a value is what it is, or is not known: a code with arguments, as JSON text. The words are in src/drivelint/reasons/words.toml or, for
-- the codes of one rule, in its header. Arguments are named with their unit: t_ns is a time of the log, gap_m a length, object_id an actor.
CREATE OR REPLACE MACRO why(code) AS to_json({'code': code})::VARCHAR, (code, args) AS to_json({'code': code, 'args': args})::VARCHAR;
