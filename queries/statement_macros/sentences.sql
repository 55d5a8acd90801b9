-- The rows of `_named` or `_failed` with the column `sentence`, and whether that states the observed value and the value that is
-- required (`reason_measures`). Columns that are read: verdict, code, reason (the author's, or NULL), cause (that, or what the engine found
-- out), and the times, numbers and names in the sentences of the engine's codes. `_worded` has the words of the causes.
CREATE OR REPLACE MACRO with_sentences(verdict_table) AS TABLE
WITH _parts AS (
    -- times in sentences count from the drive's first time stamp, as in every other output: the log's own times may count from 1970
    SELECT n.*, w.words, w.cause_code, w.cause_args,
        seconds(t_decides_ns - start_ns) AS at_time,
        coalesce(' at ' || at_time, '') AS if_at_time,
        coalesce('object ' || object_id, 'an object') AS who,
        CASE WHEN observes IS NULL THEN '' ELSE capital(observes) || ' ' END AS what,
        amount(observed, unit) AS measured
    FROM query_table(verdict_table) n
    LEFT JOIN _worded w USING (rule_no, cause, start_ns)
), _parts_with_told AS (
    SELECT *, CASE
        WHEN reason IS NOT NULL AND (verdict <> 'unknown' OR code <> 'applies_unknown') THEN words
        WHEN verdict = 'unknown' THEN CASE code
            WHEN 'missing_step' THEN 'The rule''s data has no row at ' || at_time || '.'
            WHEN 'null_value' THEN 'A value that the rule needs is not known at ' || at_time || '.'
            -- the bound at the undecided step (`bound`), not the value at the worst decided step (`observed`)
            WHEN 'only_a_bound' THEN 'Only a bound is known at ' || at_time
                || coalesce(' (' || amount(bound, unit) || ', required ' || threshold(sense, asked, unit) || ')', '') || '.'
            WHEN 'within_error' THEN 'Missed by less than the measuring error at ' || at_time
                || coalesce(' (' || amount(bound, unit) || ', required ' || threshold(sense, asked, unit) || ')', '') || '.'
            WHEN 'one_sample' THEN 'Missed in one measurement only, at ' || at_time
                || coalesce(' (' || amount(bound, unit) || ', required ' || threshold(sense, asked, unit) || ')', '') || '.'
            WHEN 'applies_unknown' THEN 'Whether the rule applies is not known' || if_at_time
                || CASE WHEN reason IS NOT NULL THEN ': ' || words ELSE '' END || '.'
            WHEN 'engaged_unknown' THEN 'Whether the automated driver drives is not known' || if_at_time
                || ': give the log''s mode flag engaged, or --env engaged=yes.'
            WHEN 'road_type_unknown' THEN 'The kind of road is not known' || if_at_time
                || ': give a map that says it, or what it was, such as --env road_type=motorway, rural or town.'
            WHEN 'carriageway_unknown' THEN 'Whether this is a single or a dual carriageway is not known' || if_at_time
                || ': give --env carriageway=single.'
            WHEN 'area_unknown' THEN 'Whether this is a built-up area is not known' || if_at_time
                || ': give a map with road types, or --env area=built_up.'
            WHEN 'nation_unknown' THEN 'The country is not known' || if_at_time || ': give --env nation=gb.'
            WHEN 'weather_unknown' THEN 'The weather is not known' || if_at_time || ': give --env weather=dry.'
            WHEN 'light_unknown' THEN 'Whether it is day or night is not known' || if_at_time || ': give --env light=day or light=night.'
            WHEN 'vehicle_class_unknown' THEN 'The ego''s class of vehicle is not known' || if_at_time
                || ': give --env vehicle_class=car.'
            WHEN 'limit_unknown' THEN 'The speed limit is not known' || if_at_time || ': give a map with speed limits.'
            WHEN 'not_engaged' THEN 'The automated driver does not drive' || if_at_time || '.'
            WHEN 'reference_time_unknown'
                THEN coalesce(capital(without_time), 'The time of the assertion reference point is not known') || '.'
            WHEN 'anchor_unknown'
                THEN coalesce(capital(without_anchor), 'It is not known when or where the condition had to hold') || '.'
            WHEN 'beyond_sensor_range' THEN 'Nobody was seen at ' || at_time || ', but the sensors do not reach everywhere.'
            WHEN 'window_truncated' THEN format(
                'The rule looks at {:.3f} s to {:.3f} s, and the log has the ego from {:.3f} s to {:.3f} s only'
                || ': record the ego, and who is near it, over all of that.',
                (t_start_ns - start_ns) / 1e9, (t_end_ns - start_ns) / 1e9, (ego_from_ns - start_ns) / 1e9, (ego_to_ns - start_ns) / 1e9)
            WHEN 'log_hole' THEN format(
                'The log has a hole between {:.3f} s and {:.3f} s.', (t_start_ns - start_ns) / 1e9, (t_end_ns - start_ns) / 1e9)
            WHEN 'lost_near_ego' THEN 'The track of ' || who || ' ends close to the ego at ' || at_time
                || ': record it for as long as the ego.'
            WHEN 'lost_in_range' THEN 'The track of ' || who || ' ends within sensor range at ' || at_time || '.'
            WHEN 'lost_on_road' THEN 'The track of ' || who || ' ends on the road at ' || at_time || '.'
            ELSE coalesce(at_time, 'At an unknown time') || ': ' || replace(code, '_', ' ') || '.' END
        WHEN verdict = 'not_applicable' THEN CASE code
            WHEN 'ego_never_moves' THEN 'The ego never moves in this drive.'
            WHEN 'no_anchor' THEN 'The time or place at which it must hold never came.'
            WHEN 'nobody_there' THEN 'Nobody was there.'
            WHEN 'not_engaged' THEN 'The automated driver never drives in this drive.'
            WHEN 'other_nation' THEN 'The law of another nation.'
            WHEN 'outside_conditions' THEN 'Outside the conditions of the rule.'
            ELSE 'What the rule is about never happened in this drive.' END
        WHEN code = 'nobody_there' THEN 'Nobody was there at ' || at_time || '.'
        WHEN sense = 'holds' THEN CASE verdict
            WHEN 'pass' THEN 'Kept: the condition held.'
            ELSE 'The condition did not hold at ' || at_time || '.' END
        WHEN observed IS NULL OR required IS NULL THEN CASE verdict WHEN 'pass' THEN 'Kept: ' ELSE 'Violated: ' END
            || what || coalesce(measured, 'unlimited') || ' at ' || at_time || '.'
        ELSE what || measured || ' at ' || at_time || ' where ' || threshold(sense, required, unit) || ' is required: '
            || CASE WHEN verdict = 'pass' THEN 'kept by ' || amount(abs(margin), unit)
                WHEN margin = 0 THEN 'exactly at the limit, which does not do'
                ELSE 'missed by ' || amount(abs(margin), unit) END || '.' END AS told
    FROM _parts
)
SELECT *, coalesce(replace(label, '_', ' ') || ': ', '')
        || CASE WHEN reason IS NULL AND cause IS NOT NULL THEN format('{}; {}.', rtrim(told, '.'), words) ELSE told END AS sentence,
    coalesce(reason IS NULL AND CASE verdict
        WHEN 'unknown' THEN code IN ('only_a_bound', 'within_error', 'one_sample') AND bound IS NOT NULL AND asked IS NOT NULL
        WHEN 'not_applicable' THEN false
        ELSE code <> 'nobody_there' AND sense <> 'holds' AND observed IS NOT NULL AND required IS NOT NULL END, false) AS reason_measures
FROM _parts_with_told;
