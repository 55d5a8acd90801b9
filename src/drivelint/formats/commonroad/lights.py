"""The traffic lights of a CommonRoad scenario: their cycles, unrolled over the time of the log."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from drivelint.drive.trace import QualityFinding
from drivelint.formats import safe_xml

if TYPE_CHECKING:
    from lxml import etree

    from drivelint.arrays import Floats, Times
_STATE_BY_COLOUR = {"red": "red", "redYellow": "red_amber", "yellow": "amber", "green": "green", "inactive": "off"}
_MIN_PHASE_STEPS = 0.5  # phases are whole numbers of steps: a shorter phase than this is a mistake


class _UnreadableCycleError(ValueError):
    """Raised for a light whose cycle cannot be read; the caller adds the light's id."""


def signal_states(
    root: etree._Element, step_s: float, first_step: float, last_step: float
) -> tuple[pa.Table | None, list[QualityFinding]]:
    """Return a table of `signal_id`, `t_ns`, `state` (None without lights), and findings on lights that cannot be read.

    `first_step` and `last_step`: the log's first and last time step, of `step_s` seconds each. Each light has a row at the
    first step and at every change.
    """
    ids: list[str] = []
    times: list[Times] = []
    states: list[str | None] = []
    findings = []
    for light in root.findall("trafficLight"):
        name = light.get("id", "")
        try:
            steps, light_states = _unroll_cycle(light, first_step, last_step)
        except _UnreadableCycleError as error:
            message = f"the states of traffic light {name} are not known: {error}"
            findings.append(QualityFinding("signal_cycle", "warning", message))
            continue
        if None in light_states:
            words = sorted({w for w in _cycle_colours(light) if w not in _STATE_BY_COLOUR})
            message = f"traffic light {name} has colours that are not known: {', '.join(words)}"
            findings.append(QualityFinding("signal_cycle", "warning", message, len(words)))
        ids += [name] * len(steps)
        times.append(np.round(steps * step_s * 1e9).astype(np.int64))
        states += light_states
    if not ids:
        return None, findings
    return pa.table({"signal_id": ids, "t_ns": np.concatenate(times), "state": pa.array(states, pa.string())}), findings


def _unroll_cycle(light: etree._Element, first_step: float, last_step: float) -> tuple[Floats, list[str | None]]:
    """Return the time steps at which a light's state is known or changes, and its states.

    The cycle starts at step `timeOffset` and repeats without end, before that step, too. A light that is not active is off.
    """
    if _child_text(light, "active").lower() in {"false", "0"}:
        return np.array([first_step]), ["off"]
    colours = _cycle_colours(light)
    if not colours:
        raise _UnreadableCycleError("it has no cycle")
    durations = np.array(
        [safe_xml.number_or_nan(e.findtext("duration")) for e in light.iterfind("cycle/cycleElement")], np.float64
    )
    if not (durations >= _MIN_PHASE_STEPS).all():
        raise _UnreadableCycleError("a phase of its cycle has no duration")
    offset = safe_xml.number_or_nan(_child_text(light, "timeOffset") or "0")
    if not math.isfinite(offset):
        raise _UnreadableCycleError("its time offset is not a number")
    ends = np.cumsum(durations)
    cycles = np.arange(np.floor((first_step - offset) / ends[-1]), np.floor((last_step - offset) / ends[-1]) + 1)
    begins = (offset + cycles[:, None] * ends[-1] + np.r_[0.0, ends[:-1]]).ravel()
    states = [_STATE_BY_COLOUR.get(word) for word in colours] * len(cycles)
    at = int(np.searchsorted(begins, first_step, side="right")) - 1
    keep = [i for i in range(at, len(begins)) if begins[i] <= last_step and (i == at or states[i] != states[i - 1])]
    return np.maximum(begins[keep], first_step), [states[i] for i in keep]


def _cycle_colours(light: etree._Element) -> list[str]:
    return [(e.findtext("color") or "").strip() for e in light.iterfind("cycle/cycleElement")]


def _child_text(light: etree._Element, name: str) -> str:
    """Return the text of a child element of a light or of its cycle: writers differ in where they put it."""
    return (light.findtext(name) or light.findtext(f"cycle/{name}") or "").strip()
