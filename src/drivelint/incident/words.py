"""Texts of the sheet, for readers who know neither the rules nor drivelint."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from drivelint.catalogue.header import CONTACT_TAG
from drivelint.incident.motion import is_slowing_known
from drivelint.result.certainty import certainty
from drivelint.result.text import number, tolerance

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.incident.motion import MotionOfParties, SlowingPeriod
    from drivelint.result.text import Row

SENSE_WORDS: Final = {">": "more than ", ">=": "at least ", "<": "less than ", "<=": "at most "}
_KMH, _MPH = 3.6, 1 / 0.44704
_SIDE_BY_SIDE: Final = "side by side"
_TITLE_LINE_CHARACTERS: Final = 86
"""A longer title would take a second line of page 1."""
_HEAD_ON_RAD, _ALONG_RAD = 5 * math.pi / 6, math.pi / 6


def speed_text(mps: float) -> str:
    """Return a speed as text in m/s, km/h and mph; `not known` for NaN."""
    if math.isnan(mps):
        return "not known"
    return f"{mps:.1f} m/s ({mps * _KMH:.0f} km/h, {mps * _MPH:.0f} mph)"


def metres_text(value: float) -> str:
    """Return a length as text; `not known` for NaN."""
    return "not known" if math.isnan(value) else f"{value:.2f} m"


def closing_speed_text(mps: float | None) -> str | None:
    """Return a closing speed in words; None if it is not known."""
    if mps is None:
        return None
    return f"none: they move apart at {speed_text(-mps)}" if mps < 0 else speed_text(mps)


def unit_text(unit: str | None) -> str:
    """Return a unit with m/s2 as m/s²; '' for None."""
    return (unit or "").replace("m/s2", "m/s\u00b2")


def amount_text(value: float | None, unit: str | None) -> str:
    """Return a measured value with its unit, with m/s2 as m/s²."""
    return number(value, unit_text(unit) or None)


def are_speeds_nearly_equal(relative_mps: float, closing_mps: float | None) -> bool:
    """Return whether closing speed and relative speed are nearly equal, or the relative speed is not known."""
    if math.isnan(relative_mps):
        return True
    return closing_mps is not None and math.isclose(closing_mps, relative_mps, rel_tol=0.05, abs_tol=0.2)


def text_with_minus_signs(text: str) -> str:
    """Return a text in which negative numbers have a minus sign (U+2212) instead of a hyphen."""
    return text.replace(" -", " \u2212") if not text.startswith("-") else "\u2212" + text_with_minus_signs(text[1:])


def measured_and_required_text(row: Row, rule: Row) -> str:
    """Return the observed and the required value in words; '' if the rule measures nothing."""
    if row["observed"] is None and row["required"] is None:
        return ""
    if CONTACT_TAG in rule["tags"] and row["unit"] == "m" and (row["observed"] or 0.0) < 0:
        return f"boxes overlap by {amount_text(-row['observed'], 'm')} and must not"
    must = (
        "none"
        if row["required"] == 0 and rule["sense"][0] == "<"
        else f"{SENSE_WORDS.get(rule['sense'], '')}{required_value_text(row, rule)}"
    )
    return text_with_minus_signs(f"{amount_text(row['observed'], row['unit'])}, must be {must}")


def required_value_text(row: Row, rule: Row) -> str:
    """Return the required value as text, and the tolerance that it includes, if any."""
    text, row_tolerance = amount_text(row["required"], row["unit"]), tolerance(row, rule)
    return text if row_tolerance is None else f"{text}, including {amount_text(row_tolerance, row['unit'])} tolerance"


def profile_text(name: str | None) -> str:
    """Return the profile of an overtake in words, with a leading space; '' for a rule without profiles."""
    if name is None:
        return ""
    return " (overtake as driven)" if name == "observed" else f" (planned as {name})"


def certainty_text(row: Row) -> str:
    """Return whether a finding is sure, and in how many of its judged copies it stays; '' if no copies were judged."""
    word = certainty(row)
    return "" if word is None else f"{word}, {row['n_stays']} of {row['n_copies']}"


def box_overlap_text(row: Row, rule: Row) -> str:
    """Return the overlap of the boxes in the recording and its copies in words; '' if the finding is not about overlapping boxes."""
    if CONTACT_TAG not in rule["tags"] or row["unit"] != "m" or row["observed"] is None or row["observed"] >= 0:
        return ""
    text = f"the boxes overlap by {amount_text(-row['observed'], 'm')} in the recording"
    if row["n_copies"] is not None and row["n_stays"] < row["n_copies"]:
        text += f"; in {row['n_copies'] - row['n_stays']} of {row['n_copies']} copies with assumed errors they do not"
    return text


def story_sentence(
    motion: MotionOfParties,
    step_no: int | None,
    slowings: Sequence[list[SlowingPeriod]],
    *,
    party_kinds: Sequence[str | None],
    manoeuvre_text: str,
    closing_mps: float | None,
    moment_from_start_s: float,
) -> str:
    """Return in one sentence the events up to the step `step_no`; '' if there is only one party or `step_no` is None.

    `slowings`: the result of `slowing_periods` for each party; `party_kinds`: the class of each party, None: not recorded;
    `manoeuvre_text`: the first party's manoeuvre; `closing_mps`: the finding's closing speed;
    `moment_from_start_s`: the moment in seconds from the drive's start.
    """
    if step_no is None or len(slowings) < 2:
        return ""
    parts = [manoeuvre_text, _lane_departure_text(motion, step_no, moment_from_start_s)]
    until_s = float(motion.t[step_no])
    steady = [not periods and is_slowing_known(motion, party, until_s) for party, periods in enumerate(slowings)]
    if all(steady):
        parts.append("neither slowed by 1 m/s\u00b2 or more before")
    else:
        for party, (letter, periods, still) in enumerate(zip("AB", slowings, steady, strict=True)):
            if periods:
                from_s, to_s = (time_s + moment_from_start_s for time_s in (periods[-1].start_s, periods[-1].end_s))
                how = "lost speed faster than tyres brake" if periods[-1].sudden else "slowed last"
                since_s = until_s - periods[-1].end_s
                then = (
                    f", and not in the {since_s:.1f} s after"
                    if since_s >= 1 and is_slowing_known(motion, party, until_s)
                    else ""
                )
                parts.append(f"{letter} {how} from {from_s:.2f} s to {to_s:.2f} s{then}")
            elif still:
                parts.append(f"{letter} did not slow by 1 m/s\u00b2 or more")
    parts += [
        _party_and_speed_text(letter, kind, float(speeds[step_no]))
        for letter, kind, speeds in zip("AB", party_kinds, motion.speed, strict=True)
    ]
    how = _directions_text(motion, step_no)
    relative = float(motion.relative[step_no])
    if not are_speeds_nearly_equal(relative, closing_mps):
        how = f"{how}, relative speed {speed_text(relative)}" if how else f"relative speed {speed_text(relative)}"
    elif closing_mps is not None:
        nearer = (
            f"moving apart at {-closing_mps:.1f} m/s" if closing_mps < 0 else f"closing at {speed_text(closing_mps)}"
        )
        how = f"{how}, {nearer}" if how else nearer
    parts.append(how)
    text = "; ".join(part for part in parts if part)
    return f"{text[:1].upper()}{text[1:]}."


def collision_title(
    motion: MotionOfParties,
    step_no: int | None,
    *,
    party_kinds: Sequence[str | None],
    time_text: str,
    closing_mps: float | None,
    is_in_oncoming_lane: bool,
    is_only_possible: bool,
) -> str:
    """Return a title for a contact of A and B: their kinds if these differ, directions, the time, A's lane, and the closing speed.

    The title does not state who is at fault. `step_no`: the last step before the contact; `party_kinds`: the class of each party, None:
    not recorded; `is_in_oncoming_lane`: A was there at `step_no`.
    """
    directions = "" if step_no is None else _directions_text(motion, step_no)
    if directions.startswith(_SIDE_BY_SIDE):
        directions = _SIDE_BY_SIDE  # the sentence below the title has the rest
    how = f" {directions}" if directions else ""
    is_named = all(party_kinds) and len(set(party_kinds)) > 1
    subject = " and ".join(
        f"{kind} {letter}" if is_named else letter for letter, kind in zip("AB", party_kinds, strict=True)
    )
    parts = [
        f"{subject[:1].upper()}{subject[1:]} {'may have ' if is_only_possible else ''}collided{how} at {time_text}"
    ]
    relative = math.nan if step_no is None else float(motion.relative[step_no])
    if closing_mps is not None and closing_mps > 0 and are_speeds_nearly_equal(relative, closing_mps):
        parts.append(f"closing at {closing_mps:.1f} m/s")
    elif not math.isnan(relative):
        parts.append(f"relative speed {relative:.1f} m/s")
    with_lane = ", ".join([parts[0], "A in the oncoming lane", *parts[1:]])
    is_lane_told = is_in_oncoming_lane and len(with_lane) <= _TITLE_LINE_CHARACTERS
    return with_lane if is_lane_told else ", ".join(parts)


def _party_and_speed_text(letter: str, kind: str | None, mps: float) -> str:
    """Return a party's letter with its class and speed, if known; '' if neither is known."""
    article = "an" if kind and kind[0] in "aeiou" else "a"
    name_parts = [letter, f"{article} {kind}"] if kind else [letter]
    speed_parts = [] if math.isnan(mps) else [f"at {mps:.1f} m/s"]
    parts = [*name_parts, *speed_parts]
    return ", ".join(parts) if kind else " ".join(parts) if speed_parts else ""


def _directions_text(motion: MotionOfParties, step_no: int) -> str:
    """Return the directions of both parties in words; '' if not known. Who passes beside the other does not come head-on."""
    turn_rad = float(motion.turn[step_no])
    if math.isnan(turn_rad):
        return ""
    if _ALONG_RAD < turn_rad < _HEAD_ON_RAD:
        return f"at {math.degrees(turn_rad):.0f}\u00b0 to each other"
    if turn_rad >= _HEAD_ON_RAD and not motion.is_aside[step_no]:
        return "head-on"
    text = "in the same direction" if turn_rad <= _ALONG_RAD else "in opposite directions"
    return f"{_SIDE_BY_SIDE} {text}" if motion.is_alongside[step_no] else text


def _lane_departure_text(motion: MotionOfParties, step_no: int, moment_from_start_s: float) -> str:
    """Return in words when A left its lane, and the gap to B then; '' if A is in its lane at step `step_no`, or this was not examined."""
    since = float(motion.out_since[step_no])
    if math.isnan(since):
        return ""
    i = motion.nearest_step(since)
    gap = math.nan if i is None else float(motion.gap[i])
    free = "" if math.isnan(gap) else f" with {gap:.2f} m between the boxes"
    return f"A left its lane at {since + moment_from_start_s:.2f} s{free}"
