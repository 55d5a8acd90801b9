"""Says by reason code what to record or to provide so that an unknown verdict is decided."""

from __future__ import annotations

from typing import Final

from drivelint.drive.conditions import DRIVE_CONDITION_VALUES
from drivelint.reasons.signals import SIGNAL_OF_CONDITION, TEXTS, how_to_provide

_SHOWN = "what is NULL, or has no row, in the rows that it was judged on"
_A_MAP_THAT_GOES_ON = "a map that goes on, or a longer --sensor-range of check"
_AGAIN = "; run drivelint check with it: what else the rule needs is not looked at before"
REMEDIES: Final[dict[str, str]] = TEXTS["remedies"]


def remedy(code: str, object_id: str | None, log_format: str, advice: str | None = None) -> str:
    """Return what would decide an unknown verdict with this reason code, for a log of this format. `advice`: what its cause asks for."""
    if code.startswith("missing_") and code not in REMEDIES:
        return how_to_provide(code.removeprefix("missing_"), log_format) + _AGAIN
    condition = code.removesuffix("_unknown")
    if condition in DRIVE_CONDITION_VALUES or condition == "limit":
        return (
            how_to_provide({**SIGNAL_OF_CONDITION, "engaged": "mode_engaged"}.get(condition, condition), log_format)
            + _AGAIN
        )
    return REMEDIES.get(code, "{advice}").format(
        object="the object" if object_id is None else f"object {object_id}",
        advice=advice or (_A_MAP_THAT_GOES_ON if code == "only_a_bound" else _SHOWN),
    )


def condition_of(code: str) -> str | None:
    """Return the column of `ego_condition` that a reason code says is not known; None: it is about none."""
    condition = code.removesuffix("_unknown")
    if condition == code:
        return None
    return condition if condition in DRIVE_CONDITION_VALUES else "limit_mps" if condition == "limit" else None
