"""This module reads the trajectories of a CommonRoad file with regular expressions, five times as fast as element by element."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from drivelint.arrays import Floats
_TAG: Final = re.compile(rb"<(/?)([A-Za-z][\w.-]*)>")
_STATE: Final = re.compile(rb"<state>.*?</state>", re.DOTALL)
_COMMENT: Final = re.compile(rb"<!--.*?-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
_TRAJECTORY: Final = re.compile(rb"<trajectory>(.*?)</trajectory>", re.DOTALL)


class Trajectories(NamedTuple):
    """A file without its trajectories, and the numbers of each trajectory by element path."""

    rest: bytes
    columns: list[dict[str, Floats]]


def extract_trajectories(content: bytes) -> Trajectories | None:
    """Take the trajectories out of a file; return None where its states differ in form."""
    first = _STATE.search(content)
    shape = None if first is None else _shape(first[0])
    if shape is None:
        return None
    pattern, places, n_tags = shape
    parts = _TRAJECTORY.split(content)
    columns = []
    for body in parts[1::2]:
        rows = pattern.findall(body)
        if not rows or len(rows) * n_tags != body.count(b"<") or b"&" in body:
            return None
        try:
            values = np.array([tuple(map(float, row)) for row in rows], np.float64)
        except ValueError:
            return None
        columns.append(dict(zip(places, values.T, strict=True)))
    rest = b"<trajectory/>".join(parts[::2])
    # in a comment, a trajectory is none, and with attributes or empty it was not cut out: then it cannot be told which is whose
    if b"<trajectory" in b"".join(_COMMENT.findall(rest)) or rest.count(b"<trajectory") != len(columns):
        return None
    return Trajectories(rest, columns)


def _shape(state: bytes) -> tuple[re.Pattern[bytes], list[str], int] | None:
    """Return the pattern of a state, the places of the numbers in it, and how many tags it has."""
    pattern, at, opened = b"", 0, False
    places: list[str] = []
    stack: list[str] = []
    tags = list(_TAG.finditer(state))
    for tag in tags:
        between = state[at : tag.start()]
        closes, name = bool(tag[1]), tag[2].decode()
        if closes and not stack:
            return None
        if opened and closes:
            pattern += rb"([^<]*)"
            places.append("/".join(stack[1:]))
        elif between.strip():
            return None
        else:
            pattern += rb"\s*"
        pattern += re.escape(tag[0])
        if closes:
            stack.pop()
        else:
            stack.append(name)
        at, opened = tag.end(), not closes
    if (
        len(tags) != state.count(b"<")
        or any("interval" in place for place in places)
        or len(places) < 2
        or len(set(places)) < len(places)
    ):
        return None
    return re.compile(pattern), places, len(tags)
