"""The situations by which a fleet's drives are divided, if the tables of an audit contain them."""

from __future__ import annotations

from typing import Final

from drivelint.drive.conditions import RULE_CONDITION_VALUES
from drivelint.sql.statements import statement

MEASURED_SITUATIONS: Final = {
    "speed_band": ("0 to 15 km/h", "15 to 30 km/h", "30 to 60 km/h", "60 to 90 km/h", "90 km/h and more"),
    "traffic": ("less than 1 other", "1 to 5 others", "5 to 20 others", "20 others and more"),
}
"""Situations that are computed from a drive's exposure and states: name -> values in order."""
_STATEMENT_BY_SITUATION: Final = {"speed_band": "value_of_speed_band", "traffic": "value_of_traffic"}
SITUATIONS: Final = {**RULE_CONDITION_VALUES, **MEASURED_SITUATIONS}
"""All situations: name -> values. Situations that are not measured come from tags, from conditions given to `check`, or from the log."""
UNAVAILABLE_SITUATIONS: Final = {
    "junction kind": "the tables say which rules applied, not at which junction: see the rules of junctions",
    "road type, as the map has it": "only a road type that was set for the whole drive is known",
    "speed at each moment": "the band is that of the mean speed of a drive",
    "density of the traffic": "the number of recorded actors depends on the range of the sensors",
}
"""The situations that an audit's tables do not contain -> why not, or what to use instead."""


def tag_or_situation_sql(by: str | None) -> str:
    """Return the SQL expression for a drive's value of a tag or situation. It reads `d`, the drive, and `ego`, the exposure of an ego."""
    return "NULL::VARCHAR" if by is None else _drive_value_sql(_STATEMENT_BY_SITUATION.get(by, "value_of_tag"))


def situation_sql(situation: str) -> str:
    """Return such an expression for the coverage, where a tag of the same name does not hide the condition that rules were judged under."""
    return _drive_value_sql(_STATEMENT_BY_SITUATION.get(situation, "value_of_condition"))


def _drive_value_sql(statement_name: str) -> str:
    _, _, sql = statement(f"fleet/{statement_name}").partition("\n")
    return sql.strip()


def parameters_of_tag(by: str | None) -> dict[str, str]:
    """Return the parameters that the SQL of `tag_or_situation_sql(by)` needs."""
    return {} if by is None or by in MEASURED_SITUATIONS else {"by": by}
