"""Records the actors of a scene as rows of `actor` and `actor_state`, with the recorder's faults that the scene defines."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS
from drivelint.errors import UsageError
from drivelint.phrases import hint
from drivelint.scene.actor import BRAKE_LIGHT_DECELERATION_MPS2, CLASSES_WITH_LIGHTS, DT_S, light_states

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.arrays import Floats, Mask
    from drivelint.scene.actor import Actor, MotionSamples

_OTHER_SIDE: Final = {"left": "right", "right": "left"}
_STANDING_MPS: Final = 0.05
_STRONG_BRAKING_MPS2: Final = 6.0


def actor_row(actor: Actor) -> dict[str, Any]:
    """Return the row of `actor`. Errors: `UsageError` for an unknown kind."""
    kind, faults = actor.text.kind, actor.text.faults
    if kind is not None and kind not in ACTOR_CLASSES:
        raise UsageError(f"actor {actor.name}: kind {kind!r}: {hint(kind, ACTOR_CLASSES)}")
    length, width, height = actor.size
    if faults.swapped:
        length, width = width, length
    if "size" in faults.unknown:
        length = width = height = None
    if "width" in faults.unknown:
        width = None
    return {
        "actor_id": actor.name,
        "actor_class": None if "class" in faults.unknown else kind,
        "length_m": length,
        "width_m": width,
        "height_m": height,
        "is_ego": actor.name == "ego",
    }


def state_columns(
    actor: Actor, seconds: float, rate: float, *, left: bool, with_height: bool, seed: int
) -> dict[str, Any]:
    """Return the columns of an actor's samples, mirrored if `left`, that is, for left-hand traffic."""
    motion = actor.motion(seconds)
    indices = np.arange(0, len(motion.t), round(1 / rate / DT_S))
    t = motion.t[indices]
    present = _mask_of_samples(actor, t)
    indices, t = indices[present], t[present]
    x, y, yaw, vx, vy = _states_with_faults(actor, motion, indices, seed)
    hand = -1.0 if left else 1.0
    n, unknown = len(t), actor.text.faults.unknown
    indicator, brake = _indicator_and_brake_light(actor, motion, indices)
    if left:
        indicator = [_OTHER_SIDE.get(word, word) if word else None for word in indicator]
    middle = motion.z[indices] + (actor.size[2] or 1.5) / 2
    return {
        "actor_id": [actor.name] * n,
        "t_ns": np.round(t * 1e9).astype(np.int64),
        "x_m": x,
        "y_m": hand * y,
        "z_m": middle if with_height or actor.text.height is not None else [None] * n,
        "yaw_rad": [None] * n if "heading" in unknown else np.arctan2(hand * np.sin(yaw), np.cos(yaw)),
        "vx_mps": [None] * n if "speed" in unknown else vx,
        "vy_mps": [None] * n if "speed" in unknown else hand * vy,
        "indicator": indicator,
        "brake_light": brake,
    }


def light_rows(lights: Mapping[str, Sequence[tuple[float, str]]], seconds: float) -> Iterable[dict[str, Any]]:
    """Yield the states of the traffic lights, recorded ten times a second."""
    from drivelint.drive.trace import SIGNAL_STATES

    t = np.arange(int(seconds * 10) + 1) / 10
    for name, changes in lights.items():
        for when, state in zip(t, light_states(changes, t, SIGNAL_STATES, f"light {name}"), strict=True):
            yield {"signal_id": name, "t_ns": round(float(when) * 1e9), "state": state}


def _mask_of_samples(actor: Actor, t: Floats) -> Mask:
    """Return for each of n times whether the log has a sample of the actor."""
    first, last = actor.text.there or (-1.0, math.inf)
    present: Mask = (t >= first - 1e-6) & (t <= last + 1e-6)
    for begin, end in actor.text.faults.lost_spans:
        present &= ~_mask_of_span(t, begin, end)
    return present


def _states_with_faults(
    actor: Actor, motion: MotionSamples, indices: Any, seed: int
) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    faults = actor.text.faults
    t, x, y, yaw = (column[indices].copy() for column in (motion.t, motion.x, motion.y, motion.yaw))
    vx, vy = motion.vx[indices].copy(), motion.vy[indices].copy()
    for begin, end in faults.frozen:
        still = np.flatnonzero(_mask_of_span(t, begin, end))
        if len(still):
            x[still], y[still] = x[still[0]], y[still[0]]
    for begin, end, ahead, aside in faults.shift:
        in_span = _mask_of_span(t, begin, end)
        x[in_span] += ahead * np.cos(yaw[in_span]) - aside * np.sin(yaw[in_span])
        y[in_span] += ahead * np.sin(yaw[in_span]) + aside * np.cos(yaw[in_span])
    if faults.jitter:
        draw = np.random.default_rng(seed)
        x, y, vx, vy = (column + draw.normal(0.0, faults.jitter, len(column)) for column in (x, y, vx, vy))
    for begin, end in faults.turned:
        yaw[_mask_of_span(t, begin, end)] += math.pi
    return x, y, yaw, vx, vy


def _mask_of_span(t: Floats, begin: float, end: float) -> Mask:
    return (t >= begin - 1e-6) & (t <= end + 1e-6)


def _indicator_and_brake_light(
    actor: Actor, motion: MotionSamples, indices: Any
) -> tuple[list[str | None], list[str | None]]:
    t, text = motion.t[indices], actor.text
    owner = f"actor {actor.name}"
    if text.kind not in CLASSES_WITH_LIGHTS:
        return [None] * len(t), [None] * len(t)
    indicator = light_states(text.indicator, t, INDICATORS, f"{owner}: indicator")
    if text.brake is not None:
        return indicator, light_states(text.brake, t, BRAKE_LIGHTS, f"{owner}: brake")
    push, speed = motion.push[indices], np.hypot(motion.vx, motion.vy)[indices]
    strong = push < -_STRONG_BRAKING_MPS2
    braking = (push < -BRAKE_LIGHT_DECELERATION_MPS2) | (speed < _STANDING_MPS)
    shine = np.where(strong, "strong", np.where(braking, "on", "off"))
    return indicator, [str(word) for word in shine]
