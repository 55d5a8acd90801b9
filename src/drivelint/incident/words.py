"""Texts of the sheet, for readers who know neither the rules nor drivelint."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from drivelint.catalogue.header import CONTACT_TAG
from drivelint.incident.motion import slowing_known
from drivelint.result.certainty import certainty
from drivelint.result.text import number, tolerance

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.incident.motion import Motion, Slowing
    from drivelint.result.text import Row

SENSE: Final = {">": "more than ", ">=": "at least ", "<": "less than ", "<=": "at most "}
_KMH, _MPH = 3.6, 1 / 0.44704
_HEAD_ON_RAD, _ALONG_RAD = 5 * math.pi / 6, math.pi / 6


def speed(mps: float) -> str:
    """Return a speed as text in m/s, km/h and mph; `not known` for NaN."""
    if math.isnan(mps):
        return "not known"
    return f"{mps:.1f} m/s ({mps * _KMH:.0f} km/h, {mps * _MPH:.0f} mph)"


def closing(mps: float | None) -> str | None:
    """Return a closing speed in words; None if it is not known."""
    if mps is None:
        return None
    return f"none: they move apart at {speed(-mps)}" if mps < 0 else speed(mps)


def told_unit(unit: str | None) -> str:
    """Return a unit with m/s2 as m/s²; '' for None."""
    return (unit or "").replace("m/s2", "m/s\u00b2")


def amount(value: float | None, unit: str | None) -> str:
    """Return a measured value with its unit, with m/s2 as m/s²."""
    return number(value, told_unit(unit) or None)


def nearly_same(relative_mps: float, closing_mps: float | None) -> bool:
    """Return whether closing speed and relative speed are nearly equal, or the relative speed is not known."""
    if math.isnan(relative_mps):
        return True
    return closing_mps is not None and math.isclose(closing_mps, relative_mps, rel_tol=0.05, abs_tol=0.2)


def minus(text: str) -> str:
    """Return a text in which negative numbers have a minus sign (U+2212) instead of a hyphen."""
    return text.replace(" -", " \u2212") if not text.startswith("-") else "\u2212" + minus(text[1:])


def measured_text(row: Row, rule: Row) -> str:
    """Return the observed and the required value in words; '' if the rule measures nothing."""
    if row["observed"] is None and row["required"] is None:
        return ""
    if CONTACT_TAG in rule["tags"] and row["unit"] == "m" and (row["observed"] or 0.0) < 0:
        return f"boxes overlap by {amount(-row['observed'], 'm')} and must not"
    must = (
        "none"
        if row["required"] == 0 and rule["sense"][0] == "<"
        else f"{SENSE.get(rule['sense'], '')}{required(row, rule)}"
    )
    return minus(f"{amount(row['observed'], row['unit'])}, must be {must}")


def required(row: Row, rule: Row) -> str:
    """Return the required value as text, and the tolerance that it includes, if any."""
    said, given = amount(row["required"], row["unit"]), tolerance(row, rule)
    return said if given is None else f"{said}, including {amount(given, row['unit'])} tolerance"


def profile(name: str | None) -> str:
    """Return the profile of an overtake in words, with a leading space; '' for a rule without profiles."""
    if name is None:
        return ""
    return " (overtake as driven)" if name == "observed" else f" (planned as {name})"


def how_sure(row: Row) -> str:
    """Return whether a finding is sure, and in how many of its judged copies it stays; '' if no copies were judged."""
    word = certainty(row)
    return "" if word is None else f"{word}, {row['n_stays']} of {row['n_copies']}"


def contact(row: Row, rule: Row) -> str:
    """Return the overlap of the boxes in the recording and its copies in words; '' if the finding is not about overlapping boxes."""
    if CONTACT_TAG not in rule["tags"] or row["unit"] != "m" or row["observed"] is None or row["observed"] >= 0:
        return ""
    said = f"the boxes overlap by {amount(-row['observed'], 'm')} in the recording"
    if row["n_copies"] is not None and row["n_stays"] < row["n_copies"]:
        said += f"; in {row['n_copies'] - row['n_stays']} of {row['n_copies']} copies with assumed errors they do not"
    return said


def story(
    motion: Motion,
    at: int | None,
    slowed: Sequence[list[Slowing]],
    *,
    kinds: Sequence[str | None],
    did: str,
    closing_mps: float | None,
    offset_s: float,
) -> str:
    """Return in one sentence the events up to the step `at`; '' if there is only one party or `at` is None.

    `slowed`: the result of `slowings` for each party; `kinds`: the class of each party, None: not recorded; `did`: the first party's
    manoeuvre; `closing_mps`: the finding's closing speed; `offset_s`: the moment in seconds from the drive's start.
    """
    if at is None or len(slowed) < 2:
        return ""
    parts = [did, _left_lane(motion, at, offset_s)]
    until_s = float(motion.t[at])
    steady = [not found and slowing_known(motion, party, until_s) for party, found in enumerate(slowed)]
    if all(steady):
        parts.append("neither slowed by 1 m/s\u00b2 or more before")
    else:
        for party, (letter, found, still) in enumerate(zip("AB", slowed, steady, strict=True)):
            if found:
                from_s, to_s = (each + offset_s for each in (found[-1].start_s, found[-1].end_s))
                how = "lost speed faster than tyres brake" if found[-1].sudden else "slowed last"
                since_s = until_s - found[-1].end_s
                then = (
                    f", and not in the {since_s:.1f} s after"
                    if since_s >= 1 and slowing_known(motion, party, until_s)
                    else ""
                )
                parts.append(f"{letter} {how} from {from_s:.2f} s to {to_s:.2f} s{then}")
            elif still:
                parts.append(f"{letter} did not slow by 1 m/s\u00b2 or more")
    parts += [
        _party_with_speed(letter, kind, float(each[at]))
        for letter, kind, each in zip("AB", kinds, motion.speed, strict=True)
    ]
    turn = float(motion.turn[at])
    how = "" if math.isnan(turn) else _angle(turn)
    relative = float(motion.relative[at])
    if not nearly_same(relative, closing_mps):
        how = f"{how}, relative speed {speed(relative)}" if how else f"relative speed {speed(relative)}"
    elif closing_mps is not None:
        nearer = f"moving apart at {-closing_mps:.1f} m/s" if closing_mps < 0 else f"closing at {speed(closing_mps)}"
        how = f"{how}, {nearer}" if how else nearer
    parts.append(how)
    text = "; ".join(part for part in parts if part)
    return f"{text[:1].upper()}{text[1:]}."


def collision_title(
    motion: Motion, at: int | None, *, when: str, closing_mps: float | None, oncoming: bool, possible: bool
) -> str:
    """Return a title for a contact of A and B: their directions, the time, A's lane, and the closing speed.

    The title does not state who is at fault. `at`: the last step before the contact; `oncoming`: A was in the oncoming lane at `at`.
    """
    turn = math.nan if at is None else float(motion.turn[at])
    how = "" if math.isnan(turn) else f" {_angle(turn)}"
    parts = [f"A and B {'may have ' if possible else ''}collided{how} at {when}"]
    parts += ["A in the oncoming lane"] if oncoming else []
    if closing_mps is not None and closing_mps > 0:
        parts.append(f"closing at {closing_mps:.1f} m/s")
    return ", ".join(parts)


def _party_with_speed(letter: str, kind: str | None, mps: float) -> str:
    """Return a party's letter with its class and speed, if known; '' if neither is known."""
    article = "an" if kind and kind[0] in "aeiou" else "a"
    named = [letter, f"{article} {kind}"] if kind else [letter]
    known = [] if math.isnan(mps) else [f"at {mps:.1f} m/s"]
    parts = [*named, *known]
    return ", ".join(parts) if kind else " ".join(parts) if known else ""


def _angle(turn_rad: float) -> str:
    """Return the angle between two headings in words."""
    if turn_rad >= _HEAD_ON_RAD:
        return "head-on"
    return "in the same direction" if turn_rad <= _ALONG_RAD else f"at {math.degrees(turn_rad):.0f}\u00b0 to each other"


def _left_lane(motion: Motion, at: int, offset_s: float) -> str:
    """Return in words when A left its lane, and the gap to B then; '' if A is in its lane at step `at`, or this was not examined."""
    since = float(motion.out_since[at])
    if math.isnan(since):
        return ""
    i = motion.at(since)
    gap = math.nan if i is None else float(motion.gap[i])
    free = "" if math.isnan(gap) else f" with {gap:.2f} m between the boxes"
    return f"A left its lane at {since + offset_s:.2f} s{free}"
