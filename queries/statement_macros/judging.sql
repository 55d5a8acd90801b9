-- Macros of the statements of queries/judging. Rules cannot call them.

-- A text from a rule, limited in length: an unreadably long one, in millions of rows, would take all memory.
CREATE OR REPLACE MACRO bounded_text(given) AS CASE WHEN strlen(given::VARCHAR) > 10_000
    THEN error('it returned a text of more than 10,000 bytes')::VARCHAR ELSE given::VARCHAR END;

-- What makes a kept row a near miss.
CREATE OR REPLACE MACRO is_near_miss(margin, near_margin) AS round(margin, 6) < near_margin;

-- A number, NULL where it is infinite; never a negative zero.
CREATE OR REPLACE MACRO finite(value) AS CASE WHEN isfinite(value) THEN value + 0.0::DOUBLE END;

-- The margin by which the observed value keeps the required one; negative if it misses it. NULL if it is infinite, if `holds` is not known,
-- or for the sense 'holds'.
CREATE OR REPLACE MACRO margin_of(sense, observed, required, holds) AS CASE WHEN sense <> 'holds' AND holds IS NOT NULL
    THEN finite(CASE WHEN sense IN ('>', '>=') THEN observed - required ELSE required - observed END) END;

-- Stands for a time that is not known where a struct needs one to be ordered by.
CREATE OR REPLACE MACRO unknown_time_ns() AS 9_223_372_036_854_775_807;
CREATE OR REPLACE MACRO known_time_ns(t_ns) AS nullif(t_ns, unknown_time_ns());

-- Whether a code says at what time something is not known, and not why.
CREATE OR REPLACE MACRO tells_no_cause(code) AS code IN ('missing_step', 'null_value', 'applies_unknown');

-- Off a straight line by more than the rounding of single precision, some 1 km from its origin.
CREATE OR REPLACE MACRO bend_m() AS 0.0003;
-- Whether a sample of a track that was interpolated is a key frame, which was measured; some logs' clocks jitter.
CREATE OR REPLACE MACRO is_key_frame(t_ns, first_ns, every_ns) AS
    abs((t_ns - first_ns) / every_ns - round((t_ns - first_ns) / every_ns)) < 0.1;

-- Why an object has no place, as a code.
CREATE OR REPLACE MACRO lack(off_level, x_m, y_m, yaw_rad, length_m, width_m) AS CASE WHEN off_level THEN 'off_level'
    WHEN x_m IS NULL OR y_m IS NULL THEN 'no_position' WHEN yaw_rad IS NULL THEN 'no_heading'
    WHEN length_m IS NULL OR width_m IS NULL THEN 'no_size' END;

-- Why the nearest object without a place hides what the rule needs.
CREATE OR REPLACE MACRO hidden_reason(nearest) AS why(CASE nearest.code WHEN 'lost' THEN 'object_lost'
        WHEN 'lost_behind' THEN 'object_lost_behind' WHEN 'appeared' THEN 'object_appeared' ELSE 'object_hidden' END,
    {'object_id': nearest.id, 'lack': nearest.code,
        't_ns': CASE WHEN nearest.code IN ('lost', 'lost_behind') THEN nearest.to_ns
            WHEN nearest.code = 'appeared' THEN nearest.from_ns END,
        'near_m': CASE WHEN nearest.m >= 1 THEN floor(nearest.m) END});

-- Parts of sentences.
CREATE OR REPLACE MACRO seconds(t_ns) AS format('{:.3f} s', t_ns / 1e9);
-- Four digits: what a log measures is known no better, and a margin beside a limit still shows.
CREATE OR REPLACE MACRO amount(value, unit) AS format(CASE WHEN abs(value) < 9999.5 THEN '{:.4g}' ELSE '{:.0f}' END, value) || coalesce(' ' || unit, '');
CREATE OR REPLACE MACRO threshold(sense, value, unit) AS CASE sense WHEN '>' THEN 'more than ' WHEN '>=' THEN 'at least '
    WHEN '<' THEN 'less than ' ELSE 'at most ' END || amount(value, unit);
CREATE OR REPLACE MACRO capital(words) AS upper(words[1]) || words[2:];

-- The rank of a step among those of its episode or reference point: the least decides. `eventually`: one step that holds suffices.
CREATE OR REPLACE MACRO step_rank(holds, eventually, sense) AS CASE WHEN holds = eventually THEN 0
    WHEN (holds IS NULL) = (sense = 'holds') THEN 1 ELSE 2 END;

-- The step that decides: of the least rank, then of the least margin (eventually: the greatest), then the earliest. For the sense 'holds' an
-- unknown step decides before one that decides nothing. The first fields are never NULL and differ from step to step.
CREATE OR REPLACE MACRO deciding_step(eventually, sense, holds, gain, t_ns, who, observed, required, code, reason) AS min({'b': step_rank(holds, eventually, sense),
    'g': CASE WHEN holds IS NULL THEN 0.0::DOUBLE WHEN eventually THEN -gain ELSE gain END, 't': coalesce(t_ns, unknown_time_ns()),
    'who': coalesce(who, ''), 'observed': observed, 'required': required, 'holds': holds, 'code': code, 'reason': reason});

-- The earliest step that could not be judged.
CREATE OR REPLACE MACRO first_unknown_step(holds, t_ns, who, observed, required, code, reason) AS min({'t': coalesce(t_ns, unknown_time_ns()), 'code': coalesce(code, 'null_value'),
    'who': coalesce(who, ''), 'reason': reason, 'observed': observed, 'required': required}) FILTER (holds IS NULL);
