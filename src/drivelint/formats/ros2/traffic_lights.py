"""Converts Autoware's traffic light messages to states of signals.

A group has the id of a regulatory element of the Lanelet2 map. Each message lists all groups that are known at its time. A group has an
element for each lit lamp, which is a full lamp (circle) or an arrow.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import pyarrow as pa

from drivelint.drive.trace import EARLIEST_UTC_NS, SIGNAL_STATES, QualityFinding
from drivelint.formats.ros2.objects import stamps

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from drivelint.arrays import Codes, Times
    from drivelint.formats.ros2.cdr import Table

LONGEST_LIGHT_STATE_VALIDITY_NS: Final = 5_000_000_000
"""Without a new message, a state is valid for at most this time, as in Autoware for lights that roadside units report."""
LIGHT_ELEMENT_NUMBERS: Final = {
    "RED": 1, "AMBER": 2, "GREEN": 3,
    "CIRCLE": 1, "LEFT_ARROW": 2, "RIGHT_ARROW": 3, "UP_ARROW": 4, "UP_LEFT_ARROW": 5, "UP_RIGHT_ARROW": 6, "DOWN_ARROW": 7,
    "DOWN_LEFT_ARROW": 8, "DOWN_RIGHT_ARROW": 9,
    "SOLID_OFF": 1, "SOLID_ON": 2, "FLASHING": 3,
}  # fmt: skip
"""The constants of an element. Those in the log's definition take precedence, as older versions have other numbers."""
_COLOURS: Final = ("RED", "AMBER", "GREEN")
_LIT_RED_BIT, _DARK_RED_BIT, _ARROW_RED_BIT = 1, 8, 64
"""The bits for red: a full lamp is lit, a full lamp is dark, an arrow is lit. The next two bits are those of amber and green."""
_COLOUR_MASK: Final = 0b111
"""The bits for red, amber and green of one kind, after a shift to the lowest bits."""
_FLASHING_BIT, _DOUBT_BIT = 512, 1024
_STATE_BY_LIT_COLOURS: Final = {1: "red", 3: "red_amber", 2: "amber", 4: "green"}
_GROUP_AND_ID_FIELDS: Final = (("traffic_light_groups", "traffic_light_group_id"), ("signals", "traffic_signal_id"))


class GroupStates(NamedTuple):
    """The groups in a batch of messages. Per message: `stamp_ns` and `log_ns`; per group: index of its message, id and state."""

    stamp_ns: Times
    log_ns: Times
    message: NDArray[np.intp]
    group: NDArray[np.int64]
    state: Codes


def group_states(table: Table, log_ns: Times, constants: Mapping[str, Mapping[str, int]]) -> GroupStates:
    """Return the states of the groups in messages, as indices in `SIGNAL_STATES`; -1: unknown.

    `constants`: message type -> constant -> value, from the log's definition.
    """
    path, name = next((pair for pair in _GROUP_AND_ID_FIELDS if pair[0] in table.children), _GROUP_AND_ID_FIELDS[0])
    groups = table.items(path)
    state = _states_of_groups(groups, _light_element_numbers(constants))
    return GroupStates(stamps(table, "stamp")[0], log_ns, groups.parent, groups.column(name).astype(np.int64), state)


def _light_element_numbers(constants: Mapping[str, Mapping[str, int]]) -> Mapping[str, int]:
    names = {*_COLOURS, "CIRCLE", "SOLID_OFF", "SOLID_ON", "FLASHING"}
    return next((numbers for numbers in constants.values() if numbers.keys() >= names), LIGHT_ELEMENT_NUMBERS)


def _states_of_groups(groups: Table, number: Mapping[str, int]) -> Codes:
    elements = groups.items("elements")
    color, shape, status = (elements.column(name) for name in ("color", "shape", "status"))
    full = shape == number["CIRCLE"]
    arrow = np.isin(shape, [value for name, value in number.items() if name.endswith("_ARROW")])
    lit, dark, flashing = (status == number[name] for name in ("SOLID_ON", "SOLID_OFF", "FLASHING"))
    bits = np.zeros(elements.n, np.int64)
    for k, name in enumerate(_COLOURS):
        of_color = color == number[name]
        for is_so, bit in ((full & lit, _LIT_RED_BIT), (full & dark, _DARK_RED_BIT), (arrow & lit, _ARROW_RED_BIT)):
            bits[of_color & is_so] |= bit << k
    bits[full & flashing & np.isin(color, [number[name] for name in _COLOURS])] |= _FLASHING_BIT
    # any other element: another colour, shape or status, an unknown value, or a flashing arrow
    bits[(bits == 0) & ~(dark & (full | arrow))] = _DOUBT_BIT
    of_group = np.zeros(groups.n, np.int64)
    np.bitwise_or.at(of_group, elements.parent, bits)
    return _STATE_OF_BITS[of_group]


def _state_of_bits(bits: int) -> int:
    """Return the state of a light that applies to every turn, as an index in `SIGNAL_STATES`; -1 if turns differ or it is unknown.

    The map does not state to which turns an arrow applies. So the state is unknown if an arrow has another colour than the full lamp:
    red with a green arrow is red for some turns and green for others. It is also unknown if only arrows are lit.
    """
    full, dark, arrows = (
        bits & _COLOUR_MASK,
        bits // _DARK_RED_BIT & _COLOUR_MASK,
        bits // _ARROW_RED_BIT & _COLOUR_MASK,
    )
    word = None
    if bits & _DOUBT_BIT:
        word = None
    elif bits & _FLASHING_BIT:
        word = "flashing" if not (full or arrows) else None
    elif full:
        word = _STATE_BY_LIT_COLOURS.get(full) if arrows in {0, full} else None
    elif dark == _COLOUR_MASK and not arrows:  # with fewer dark lamps listed, another may be lit
        word = "off"
    return -1 if word is None else SIGNAL_STATES.index(word)


_STATE_OF_BITS: Final = np.array([_state_of_bits(bits) for bits in range(2 * _DOUBT_BIT)], np.int8)


def signal_states(
    batches: Sequence[GroupStates], span_ns: tuple[int, int], topic: str, *, own_times: bool
) -> tuple[pa.Table | None, list[QualityFinding]]:
    """Return a table of `signal_id`, `t_ns` and `state` of all groups, and findings on unusable messages.

    `span_ns`: first and last time of the drive. A row with a NULL state ends a group's last state, if the next message does not list
    the group, or there is no next message.
    """
    t_ns = np.concatenate([batch.stamp_ns if own_times else batch.log_ns for batch in batches])
    first = np.cumsum([0, *(len(batch.log_ns) for batch in batches)])
    message = np.concatenate([batch.message + at for batch, at in zip(batches, first, strict=False)])
    group, state = (np.concatenate([getattr(batch, name) for batch in batches]) for name in ("group", "state"))
    since, until = span_ns
    usable = (t_ns != 0) | (until < EARLIEST_UTC_NS)
    if not usable.any() or t_ns[usable].min() > until or t_ns[usable].max() + LONGEST_LIGHT_STATE_VALIDITY_NS < since:
        why = (
            f"{topic}: the messages have other times than the states of the drive: the states of the lights are unknown"
        )
        return None, [QualityFinding("signal_clock", "warning", why, len(t_ns))]
    keep = usable[message]
    message, group, state = message[keep], group[keep], state[keep]
    times, place = np.unique(t_ns[usable], return_inverse=True)
    step = np.zeros(len(t_ns), np.intp)
    step[usable] = place.reshape(-1)
    step = step[message]
    order = np.lexsort((step, group))
    step, group, state = step[order], group[order], state[order]
    end = _end_times(times, step, group)
    ended = np.flatnonzero(end <= until)
    ids = np.concatenate([group, group[ended]])
    words = pa.array([*SIGNAL_STATES, None], pa.string())
    rows = {
        "signal_id": pa.array(ids, pa.int64()).cast(pa.string()),
        "t_ns": np.concatenate([times[step], end[ended]]),
        "state": words.take(pa.array(np.concatenate([state % len(words), np.full(len(ended), len(words) - 1)]))),
    }
    findings = []
    if not usable.all():
        why = (
            f"{topic}: {int((~usable).sum())} messages without a time stamp are left out: the states of the "
            "lights at their time are unknown"
        )
        findings.append(QualityFinding("signal_clock", "warning", why, int((~usable).sum())))
    return (pa.table(rows) if len(ids) else None), findings


def _end_times(times: Times, step: NDArray[np.intp], group: NDArray[np.int64]) -> Times:
    """Return the time at which each state ends: at the next message, but at most `LONGEST_LIGHT_STATE_VALIDITY_NS` after its own.

    If the next message is in time and has the group, the end is the far future. Rows are sorted by group and step.
    `times`: the sorted times of the messages; `step`: each row's index in `times`.
    """
    following = np.append(times[1:], np.iinfo(np.int64).max)[step]
    again = np.append((group[1:] == group[:-1]) & (step[1:] <= step[:-1] + 1), False)
    stale = times[step] + LONGEST_LIGHT_STATE_VALIDITY_NS
    end = np.where(again, np.iinfo(np.int64).max, following)
    return np.where(following > stale, np.minimum(end, stale), end)
