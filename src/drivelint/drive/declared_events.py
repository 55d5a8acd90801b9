"""Lists the events that an ego may declare, with their values and meanings, and turns recorded headlights into such events."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.facts import toml_beside

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.drive.trace import States

HEADLIGHTS: Final = "headlights"
"""The name of the event, and of the entry of `States.codes` whose values index `HEADLIGHT_STATES`."""
HEADLIGHT_STATES: Final = ("off", "on")
_TABLES_OF_EVENTS_FILE: Final = toml_beside(__file__, "declared_events.toml")
ON_OFF_EVENTS: Final[dict[str, str]] = _TABLES_OF_EVENTS_FILE["on_off"]
"""Event that stays on until it is declared off -> its meaning."""
EVENTS: Final[dict[str, dict[str, str]]] = {
    **{mode: {"value": "on, off", "says": says} for mode, says in ON_OFF_EVENTS.items()},
    **_TABLES_OF_EVENTS_FILE["other"],
}
"""Event -> its possible values (`value`) and meaning (`says`). Other events are kept, but no rule reads them."""


def with_headlight_events(events: pa.Table | None, states: States) -> pa.Table | None:
    """Return the log's events with one more row for each change of an actor's headlights; NULL means unknown from then on.

    `states` are in order of actor and time. Actors that declare headlight events themselves get no rows.
    """
    import numpy as np
    import pyarrow as pa
    import pyarrow.compute as pc

    from drivelint.arrays import words_of_codes

    codes = states.codes.get(HEADLIGHTS)
    if codes is None or not (codes >= 0).any():
        return events
    is_change = np.r_[True, (states.actor[1:] != states.actor[:-1]) | (codes[1:] != codes[:-1])]
    has_lights = np.bincount(states.actor[codes >= 0], minlength=len(states.ids)) > 0
    if events is not None:
        declared = set(events.filter(pc.equal(events["event"], HEADLIGHTS))["actor_id"].to_pylist())
        has_lights &= [name not in declared for name in states.ids]
    rows = np.flatnonzero(is_change & has_lights[states.actor])
    lamps = pa.table(
        {
            "t_ns": states.t_ns[rows],
            "actor_id": words_of_codes(states.actor[rows], states.ids),
            "event": pa.repeat(pa.scalar(HEADLIGHTS), len(rows)),
            "value": words_of_codes(codes[rows], HEADLIGHT_STATES),
        }
    )
    return lamps if events is None else pa.concat_tables([events.select(lamps.column_names), lamps])
