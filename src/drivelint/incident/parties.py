"""The parties of an incident: their speeds, braking and lanes, and the other actors around them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import shapely

from drivelint.catalogue.header import CONTACT_TAG
from drivelint.incident.case import PARTY_LETTERS
from drivelint.incident.delta_v import delta_v_text
from drivelint.incident.judge import EgoRows
from drivelint.incident.motion import SECONDS_BEFORE_MOMENT, is_slowing_known
from drivelint.incident.sizes import size_source_text
from drivelint.incident.words import amount_text, are_speeds_nearly_equal, collision_title, speed_text
from drivelint.report.html.plan_view import box_corners_m
from drivelint.result.text import breach_title, seconds

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.incident.case import Case
    from drivelint.incident.motion import MotionOfParties, SlowingPeriod
    from drivelint.result.text import Row

_LARGEST_STANDING_SPEED_MPS: Final = 0.5
_MOST_LISTED_OTHER_ACTORS: Final = 3
"""At most this many actors that are not parties are described."""
_LANE_TEXTS: Final = {True: "centre in a lane of its direction", False: "centre in the oncoming lane"}


def party_values(
    case: Case,
    motion: MotionOfParties,
    party_no: int,
    step_no: int | None,
    last_before_contact_s: float | None,
    *,
    slowings: Sequence[SlowingPeriod],
) -> dict[str, Any]:
    """Return the values of one party: kind, size, lane, speeds, delta-v, braking and brake lights.

    `party_no`: 0 for A, 1 for B; `step_no`: the step that the sheet describes;
    `last_before_contact_s`: the time of the last step before a contact.
    """
    actor_id = case.finding.parties[party_no]
    tables = case.drive.trace.tables
    about: Row = next((row for row in tables["actor"].to_pylist() if row["actor_id"] == actor_id), {})
    v = motion.speed[party_no]
    window = v[
        (motion.t >= -SECONDS_BEFORE_MOMENT - 1e-9)
        & (motion.t <= (0.0 if last_before_contact_s is None else last_before_contact_s) + 1e-9)
    ]
    fastest = window[~np.isnan(window)].max(initial=-math.inf)
    gaps = " (not known throughout)" if np.isnan(window).any() else ""
    size = [about.get(name) for name in ("length_m", "width_m", "height_m")]
    return {
        "letter": PARTY_LETTERS[party_no],
        "id": actor_id,
        "ego": party_no == 0,
        "kind": (about.get("actor_class") or "kind not recorded").replace("_", " "),
        "size_source": size_source_text(case.drive.trace, actor_id),
        "size": " x ".join("?" if side is None else f"{side:.2f}" for side in size) + " m",
        "lane": _lane_text(case, party_no, step_no),
        "speed": "not known" if step_no is None else speed_text(float(v[step_no])),
        "delta_v": delta_v_text(
            motion, party_no, None if last_before_contact_s is None else step_no, case.drive.trace, actor_id
        ),
        "fastest": "not known" if math.isinf(fastest) else f"{speed_text(float(fastest))}{gaps}",
        "slowed": _slowing_texts(slowings, last_before_contact_s),
        "slowing_known": is_slowing_known(
            motion, party_no, 0.0 if last_before_contact_s is None else last_before_contact_s
        ),
        "lights": _brake_lights_text(case, actor_id),
    }


def party_kinds(case: Case) -> list[str | None]:
    """Return the class of each party in words; None if it is not recorded."""
    classes = {row["actor_id"]: row["actor_class"] for row in case.drive.trace.tables["actor"].to_pylist()}
    return [(classes.get(actor_id) or "").replace("_", " ") or None for actor_id in case.finding.parties]


def _slowing_texts(slowings: Sequence[SlowingPeriod], last_before_contact_s: float | None) -> list[str]:
    """Return the last two periods of slowing in words, and the number of earlier periods."""
    texts = [f"{len(slowings) - 2} earlier"] if len(slowings) > 2 else []
    for period in slowings[-2:]:
        until = "the last step before contact" if period.end_s == last_before_contact_s else f"{period.end_s:+.2f} s"
        if period.sudden:
            how = f"lost within {period.end_s - period.start_s:.2f} s, faster than tyres brake: as in an impact"
        else:
            how = f"hardest half second {period.hardest_mps2:.1f}, mean {period.mean_mps2:.1f} m/s\u00b2"
        texts.append(
            f"from {period.start_s:+.2f} s to {until}: {period.from_mps:.1f} to {period.to_mps:.1f} m/s, {how}".replace(
                "-", "\u2212"
            )
        )
    return texts


def _brake_lights_text(case: Case, actor_id: str) -> str:
    """Return in words when the brake lights were on in the 15 s before the moment."""
    moment = case.finding.moment_ns
    states = [
        (t_ns, light)
        for row_actor_id, t_ns, light in zip(
            *(case.drive.trace.tables["actor_state"][name].to_pylist() for name in ("actor_id", "t_ns", "brake_light")),
            strict=True,
        )
        if row_actor_id == actor_id and moment - SECONDS_BEFORE_MOMENT * 10**9 <= t_ns <= moment
    ]
    known_states = [(t_ns, light) for t_ns, light in states if light is not None]
    if not known_states:
        return "not recorded"
    on = [t_ns for t_ns, light in known_states if light != "off"]
    partly = "" if len(known_states) == len(states) else " (not known at every step)"
    if not on:
        return f"off throughout{partly}"
    return f"on from {(on[0] - moment) / 1e9:+.2f} s, at {len(on)} of {len(states)} steps{partly}".replace(
        "-", "\u2212"
    )


def _lane_text(case: Case, party_no: int, step_no: int | None) -> str:
    """Return in words whether a party is in a lane of its direction or in the oncoming lane at step `step_no` of the first party.

    `step_no`: None, if that moment was not examined. The words also say when the party left its lane.
    """
    party_rows = (case.ego_rows, case.other_party)[party_no]
    if step_no is None or not isinstance(party_rows, EgoRows) or not party_rows.steps.num_rows:
        return "not examined"
    t_ns = case.ego_rows.steps["t_ns"][step_no].as_py()
    i = int(np.searchsorted(party_rows.steps["t_ns"].to_numpy(), t_ns, side="right")) - 1
    if i < 0:
        return "not known"
    step = party_rows.steps.slice(i, 1).to_pylist()[0]
    text: str = _LANE_TEXTS.get(step["with_traffic"], "lane not known")
    if step["out_since_ns"] is not None:
        text += f"; left its lane at {seconds(step['out_since_ns'], case.finding.drive_start_ns)}"
        text += " and is not completely back" if step["with_traffic"] else ""
    return text


def overtaking_text(case: Case, step_no: int | None) -> str:
    """Return in words which vehicles A was overtaking at step `step_no`, and whether A was in the oncoming lane; '' for no vehicle."""
    if step_no is None:
        return ""
    t_ns, row = case.ego_rows.steps["t_ns"][step_no].as_py(), case.finding.row
    passed = sorted(
        {
            overtake["vbp_id"]
            for overtake in case.result.overtakes.to_pylist()
            if (overtake["drive_id"], overtake["ego_id"]) == (row["drive_id"], row["ego_id"])
            and overtake["t0_ns"] <= t_ns <= overtake["t_end_ns"]
        }
    )
    against = case.ego_rows.steps["with_traffic"][step_no].as_py() is False
    classes = {actor["actor_id"]: actor["actor_class"] for actor in case.drive.trace.tables["actor"].to_pylist()}
    vehicles = [f"{(classes.get(actor_id) or 'vehicle').replace('_', ' ')} {actor_id}" for actor_id in passed]
    return f"A was overtaking {' and '.join(vehicles)}{', in the oncoming lane' if against else ''}" if passed else ""


def sheet_title(case: Case, motion: MotionOfParties, step_no: int | None, *, is_only_possible: bool) -> str:
    """Return the title of the sheet: a collision of A and B, the broken rule, or the rule that was nearly broken."""
    finding, row = case.finding, case.finding.row
    when = seconds(finding.moment_ns, finding.drive_start_ns)
    if finding.is_near_miss and CONTACT_TAG in finding.rule["tags"] and row["unit"] == "m" and len(finding.parties) > 1:
        apart = amount_text(row["observed"], row["unit"])
        return f"Near miss at {when}: A and B were {apart} apart; \u201c{finding.rule['title']}\u201d was kept"
    if finding.is_near_miss:
        return f"Near miss at {when}: \u201c{finding.rule['title']}\u201d was kept by {amount_text(row['margin'], row['unit'])}"
    if not finding.is_contact or len(finding.parties) < 2:
        return f"{breach_title(finding.rule)}{', possibly' if is_only_possible else ''}, at {when}"
    oncoming = step_no is not None and case.ego_rows.steps["with_traffic"][step_no].as_py() is False
    return collision_title(
        motion,
        step_no,
        party_kinds=party_kinds(case),
        time_text=when,
        closing_mps=row["closing_mps"],
        is_in_oncoming_lane=oncoming,
        is_only_possible=is_only_possible,
    )


def other_actor_texts(plan: Mapping[str, Any], scene: Row) -> list[str]:
    """Return in words the other actors in the plan view: kind, size, speed, and distance from A."""
    actors = {actor["actor_id"]: actor for actor in scene["actors"]}
    ego = shapely.polygons(box_corners_m(plan["ego"]))
    texts = []
    for actor_id in [text["actor"] for text in plan["texts"] if text["kind"] == "other"]:
        about = actors[actor_id]
        size = " x ".join("?" if about[side] is None else f"{about[side]:.2f}" for side in ("length_m", "width_m"))
        mps = about["speed_mps"]
        moves = (
            "speed not known"
            if mps is None
            else "standing"
            if mps < _LARGEST_STANDING_SPEED_MPS
            else f"at {mps:.1f} m/s"
        )
        apart = float(shapely.distance(ego, shapely.polygons(box_corners_m(about))))
        kind = (about["actor_class"] or "kind not recorded").replace("_", " ")
        texts.append(f"{actor_id}: {kind}, {size} m, {moves}, {apart:.1f} m from A")
    more = [f"{len(texts) - _MOST_LISTED_OTHER_ACTORS} more"] if len(texts) > _MOST_LISTED_OTHER_ACTORS else []
    return texts[:_MOST_LISTED_OTHER_ACTORS] + more


def relative_speed_text(relative_mps: float, closing_mps: float | None) -> str:
    """Return the relative speed of both parties in words, and the closing speed of the box centres if it differs."""
    if math.isnan(relative_mps):
        return "relative speed not known"
    text = f"relative speed {speed_text(relative_mps)}"
    if closing_mps is None or are_speeds_nearly_equal(relative_mps, closing_mps):
        return text
    return f"{text}; the box centres {'move apart' if closing_mps < 0 else 'approach'} at {abs(closing_mps):.1f} m/s"
