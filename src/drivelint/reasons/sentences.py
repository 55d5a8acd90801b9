"""SQL that makes the sentence of each verdict: what was observed and required, or what was missing."""

from __future__ import annotations

from typing import Final

# a person counts from the drive's first time stamp, as every other output does: the log's clock may be that of 1970
_AT = "format('{:.3f} s', (t_decides_ns - start_ns) / 1e9)"
_OBJECT = "coalesce('object ' || object_id, 'an object')"
_FROM_TO = "(t_start_ns - start_ns) / 1e9, (t_end_ns - start_ns) / 1e9"
_OBSERVED = "format('{:.6g}', observed) || coalesce(' ' || unit, '')"
_REQUIRED = """CASE sense WHEN '>' THEN 'more than ' WHEN '>=' THEN 'at least ' WHEN '<' THEN 'less than '
            ELSE 'at most ' END
        || format('{:.6g}', required) || coalesce(' ' || unit, '')"""
# those of the step that is not decided, not of the worst one that is
_BOUND, _ASKED = _OBSERVED.replace("observed", "bound"), _REQUIRED.replace("required", "asked")
_MARGIN = "format('{:.6g}', abs(margin)) || coalesce(' ' || unit, '')"

_CAPITAL = "coalesce(upper({0}[1]), '')"
_WHAT = "CASE WHEN observes IS NULL THEN '' ELSE upper(observes[1]) || observes[2:] || ' ' END"

_CONDITIONS: Final = {
    "engaged": ("whether the automated driver drives", "the log''s mode flag engaged, or --env engaged=yes"),
    "road_type": (
        "the kind of road",
        "a map that says it, or what it was, such as --env road_type=motorway, rural or town",
    ),
    "carriageway": ("whether this is a single or a dual carriageway", "--env carriageway=single"),
    "area": ("whether this is a built-up area", "a map with road types, or --env area=built_up"),
    "nation": ("in which country this is", "--env nation=gb"),
    "weather": ("the weather", "--env weather=dry"),
    "light": ("whether it is day or night", "--env light=day or light=night"),
    "vehicle_class": ("which class of vehicle the ego is", "--env vehicle_class=car"),
    "limit": ("the speed limit", "a map with speed limits"),
}
"""Condition -> what is not known, and what to give; as SQL text."""
_NOT_KNOWN = "\n        ".join(
    f"WHEN '{name}_unknown' THEN '{what[0].upper()}{what[1:]} is not known' || coalesce(' at ' || {_AT}, '') || ': give {remedy}.'"
    for name, (what, remedy) in _CONDITIONS.items()
)

_TOLD = f"""CASE
    WHEN reason IS NOT NULL AND (verdict <> 'unknown' OR code <> 'applies_unknown') THEN words
    WHEN verdict = 'unknown' THEN CASE code
        WHEN 'missing_step' THEN 'The rule''s data has no row at ' || {_AT} || '.'
        WHEN 'null_value' THEN 'A value that the rule needs is not known at ' || {_AT} || '.'
        WHEN 'only_a_bound' THEN 'Only a bound is known at ' || {_AT}
            || coalesce(' (' || {_BOUND} || ', required ' || {_ASKED} || ')', '') || '.'
        WHEN 'applies_unknown' THEN 'Whether the rule applies is not known' || coalesce(' at ' || {_AT}, '')
            || CASE WHEN reason IS NOT NULL THEN ': ' || words ELSE '' END || '.'
        {_NOT_KNOWN}
        WHEN 'not_engaged' THEN 'The automated driver does not drive' || coalesce(' at ' || {_AT}, '') || '.'
        WHEN 'reference_time_unknown' THEN {_CAPITAL.format("without_time")}
            || coalesce(without_time[2:], 'The time of the assertion reference point is not known') || '.'
        WHEN 'anchor_unknown' THEN {_CAPITAL.format("without_anchor")}
            || coalesce(without_anchor[2:], 'It is not known when or where the condition had to hold') || '.'
        WHEN 'beyond_sensor_range' THEN 'Nobody was seen at ' || {_AT}
            || ', but the sensors do not reach everywhere.'
        WHEN 'window_truncated' THEN format(
            'The rule looks at {{:.3f}} s to {{:.3f}} s, and the log has the ego from {{:.3f}} s to {{:.3f}} s only'
            || ': record the ego, and who is near it, over all of that.',
            {_FROM_TO}, (ego_from_ns - start_ns) / 1e9, (ego_to_ns - start_ns) / 1e9)
        WHEN 'log_hole' THEN format('The log has a hole between {{:.3f}} s and {{:.3f}} s.', {_FROM_TO})
        WHEN 'lost_near_ego' THEN 'The track of ' || {_OBJECT} || ' ends close to the ego at ' || {_AT}
            || ': record it for as long as the ego.'
        WHEN 'lost_in_range' THEN 'The track of ' || {_OBJECT} || ' ends within sensor range at ' || {_AT} || '.'
        WHEN 'lost_on_road' THEN 'The track of ' || {_OBJECT} || ' ends on the road at ' || {_AT} || '.'
        ELSE coalesce({_AT}, 'At an unknown time') || ': ' || replace(code, '_', ' ') || '.' END
    WHEN verdict = 'not_applicable' THEN CASE code
        WHEN 'no_anchor' THEN 'The time or place at which it must hold never came.'
        WHEN 'nobody_there' THEN 'Nobody was there.'
        WHEN 'not_engaged' THEN 'The automated driver never drives in this drive.'
        WHEN 'other_nation' THEN 'The law of another nation.'
        WHEN 'outside_conditions' THEN 'Outside the conditions of the rule.'
        ELSE 'What the rule is about never happened in this drive.' END
    WHEN code = 'nobody_there' THEN 'Nobody was there at ' || {_AT} || '.'
    WHEN sense = 'holds' THEN CASE verdict
        WHEN 'pass' THEN 'Kept: the condition held.'
        ELSE 'The condition did not hold at ' || {_AT} || '.' END
    WHEN observed IS NULL OR required IS NULL THEN CASE verdict
        WHEN 'pass' THEN 'Kept: ' || {_WHAT} || coalesce({_OBSERVED}, 'unlimited') || ' at ' || {_AT} || '.'
        ELSE 'Violated: ' || {_WHAT} || coalesce({_OBSERVED}, 'unlimited') || ' at ' || {_AT} || '.' END
    ELSE {_WHAT} || {_OBSERVED} || ' at ' || {_AT} || ' where ' || {_REQUIRED} || ' is required: '
        || CASE WHEN verdict = 'pass' THEN 'kept by ' || {_MARGIN}
            WHEN margin = 0 THEN 'exactly at the limit, which does not do'
            ELSE 'missed by ' || {_MARGIN} END || '.' END"""

SENTENCE_SQL: Final = f"""{_TOLD} AS told,
        coalesce(replace(label, '_', ' ') || ': ', '')
            || CASE WHEN reason IS NULL AND cause IS NOT NULL
                THEN format('{{}}; {{}}.', rtrim(told, '.'), words) ELSE told END AS sentence"""
"""What a verdict or finding says, as the column `sentence`. Columns that it reads: verdict, code, reason (the author's, or NULL), cause
(that, or what the engine found out), its words, and the times, numbers and names that the codes of the engine tell."""

HAS_MEASURE_SQL: Final = """coalesce(reason IS NULL AND CASE verdict
        WHEN 'unknown' THEN code = 'only_a_bound' AND bound IS NOT NULL AND asked IS NOT NULL
        WHEN 'not_applicable' THEN false
        ELSE code <> 'nobody_there' AND sense <> 'holds' AND observed IS NOT NULL AND required IS NOT NULL END, false)"""
"""Whether the sentence tells what was observed and what is required."""
