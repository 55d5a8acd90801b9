"""The content of an incident sheet, as plain values for the template."""

from __future__ import annotations

import hashlib
import math
import re
from textwrap import shorten
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.catalogue.header import CONTACT_TAG
from drivelint.convert import CLIP_CHECK_ID
from drivelint.engine.robustness.copies import MeasurementErrors
from drivelint.incident.case import PARTY_LETTERS
from drivelint.incident.charts import charts_over_time, gap_and_finding_courses
from drivelint.incident.command import reproducing_commands, rule_ids_named_by_user
from drivelint.incident.conduct import conduct_texts_and_counts, conduct_with_party_name, text_with_party_names
from drivelint.incident.delta_v import IMPACT_WINDOW_S
from drivelint.incident.fitting import (
    SHARED_HEADING_CHARACTERS,
    FittedTexts,
    characters_lost_to_hash_lines,
    first_fitted_texts,
    fit_conduct_lists_and_return_further_pages,
    is_first_page_full,
    remove_and_return_shared_reasons,
)
from drivelint.incident.judge import matching_finding
from drivelint.incident.motion import (
    MOST_ROWS_OF_SECONDS_TABLE,
    SECONDS_BEFORE_MOMENT,
    MotionOfParties,
    rows_of_seconds_table,
    slowing_periods,
)
from drivelint.incident.parties import overtaking_text, party_kinds, party_values, relative_speed_text, sheet_title
from drivelint.incident.place import (
    coordinates_source_text,
    doubtful_at_sea_text,
    driving_side_text,
    geo_source,
    place_at_moment,
    road_id_of_lanelet,
    simulator_text,
    weather_and_light_text,
)
from drivelint.incident.record import data_elements_by_presence
from drivelint.incident.scene import plan_view_at_moment
from drivelint.incident.sizes import size_source_text
from drivelint.incident.words import (
    amount_text,
    box_overlap_text,
    certainty_text,
    closing_speed_text,
    measured_and_required_text,
    metres_text,
    profile_text,
    story_sentence,
    text_with_minus_signs,
)
from drivelint.report.html.pictures import cameras_by_moment
from drivelint.result.certainty import LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING, POSSIBLE, SURE, certainty
from drivelint.result.text import seconds, utc_at

if TYPE_CHECKING:
    from drivelint.incident.case import Case
    from drivelint.incident.finding import NamedFinding
    from drivelint.result.model import Result
    from drivelint.result.text import Row

CONDUCT_SPAN_S: Final = (15, 7)
"""The conduct of each party is reported from this long before the moment to this long after it."""
_UNKNOWN_NUMBER_TEXT: Final = "-"
_CLIP_NAME_PATTERN: Final = re.compile(r"^(.+)-clip-[0-9a-f]{8}$")
"""The name of a clip from `convert --clip`, see `clip.py`."""
_CLIP_NOTE: Final = "; values that depend on the time before or after it may differ from those of the log"
_MOST_SENTENCE_CHARACTERS: Final = 330
_CHARACTERS_RESERVED_PER_NOTE: Final = 370
"""The number of characters that warnings about the log, or the source of a clip, may have in the columns of page 2."""
_MOST_WARNING_CHARACTERS: Final = 300
_CHARACTERS_RESERVED_FOR_MISSING_RECORDS: Final = 1050
"""The characters that the lists of missing records take in the columns of page 2, if page 1 has no space for them."""
_MOST_LISTED_CONTACTS: Final = 2


def template_values(case: Case) -> dict[str, Any]:
    """Return all values of the template."""
    finding, row = case.finding, case.finding.row
    motion = MotionOfParties.of_steps(case.ego_rows.steps, finding.moment_ns)
    before = motion.last_step_apart_before(0.0) if finding.is_contact else None
    at = motion.nearest_step(0.0) if before is None else before
    before_s = None if before is None else float(motion.t[before])
    slowed = [slowing_periods(motion, no, before_s or 0.0) for no in range(len(finding.parties))]
    offset_s = (finding.moment_ns - finding.drive_start_ns) / 1e9
    rows = rows_of_seconds_table(motion, before_s)
    span, where = _conduct_span_ns(finding), place_at_moment(case)
    values = {
        "row": row,
        "rule": finding.rule,
        "drive": finding.drive,
        "what": text_with_party_names(_finding_sentence(finding), PARTY_LETTERS[0]),
        "story": story_sentence(
            motion,
            at,
            slowed,
            party_kinds=party_kinds(case),
            manoeuvre_text=overtaking_text(case, at),
            closing_mps=row["closing_mps"],
            moment_from_start_s=offset_s,
        ),
        "clip_of": _log_name_of_clip(finding.drive["file_name"]),
        "cut_from": _clip_source_texts(case),
        "recorded": f"{_signed_number_text(max(float(motion.t[0]), -SECONDS_BEFORE_MOMENT))} s to {_signed_number_text(before_s or 0.0)} s",
        "profile": profile_text(row["profile"]),
        "when": seconds(finding.moment_ns, finding.drive_start_ns),
        "worst": seconds(row["t_worst_ns"], finding.drive_start_ns),
        "stretch": None
        if row["t_start_ns"] == row["t_end_ns"]
        else [seconds(row[key], finding.drive_start_ns) for key in ("t_start_ns", "t_end_ns")],
        "utc": utc_at(finding.moment_ns, finding.drive),
        "place": where,
        "placed": seconds(where.t_ns, finding.drive_start_ns),
        "road_id": road_id_of_lanelet(case, where.lanelet_id),
        "coordinates": coordinates_source_text(case),
        "geo_source": (source := geo_source(case)),
        "at_sea": doubtful_at_sea_text(where, source),
        "surroundings": weather_and_light_text(finding.drive),
        "simulator": simulator_text(finding.drive),
        "hand": driving_side_text(finding.drive),
        "contact": finding.is_contact,
        "near": finding.is_near_miss,
        "near_margin": amount_text(finding.rule["near_margin"], row["unit"]),
        "delta_v_s": IMPACT_WINDOW_S,
        "peak": "deepest" if row["unit"] == "m" else "hardest",
        "before": None if before_s is None else f"{-before_s:.2f} s before",
        "parties": [
            party_values(case, motion, no, at, before_s, slowings=slowed[no]) for no in range(len(finding.parties))
        ],
        "closing": closing_speed_text(row["closing_mps"]),
        "against": None if at is None else relative_speed_text(float(motion.relative[at]), row["closing_mps"]),
        "gap": None if at is None else metres_text(float(motion.gap[at])),
        "least": _least_gap_text(motion, finding),
        "contacts": FittedTexts(
            (hits := _other_contact_texts(case))[:_MOST_LISTED_CONTACTS], max(len(hits) - _MOST_LISTED_CONTACTS, 0)
        ),
        "overlap": box_overlap_text(row, finding.rule),
        **plan_view_at_moment(case),
        "cameras": cameras_by_moment(case.result.pictures).get((row["drive_id"], row["t_worst_ns"]), []),
        "pictured_at": seconds(row["t_worst_ns"], finding.drive_start_ns),
        "strips": charts_over_time(motion, _party_names(finding), *gap_and_finding_courses(case), finding.moment_ns),
        "seconds": [{**second, "drive_s": offset_s + float(motion.t[second["i"]])} for second in rows],
        "step_s": motion.step_s,
        "span": {
            "of": span,
            "before": number_or_dash((finding.moment_ns - span[0]) / 1e9, 1),
            "after": number_or_dash((span[1] - finding.moment_ns) / 1e9, 1),
        },
        "recording": _recording_time_texts(finding),
        "errors": MeasurementErrors().standard_deviations_text,
        "least_share": f"{LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING:.0%}",
        "sure": _certainty_values(case),
        "rests": _contact_by_speed_change_sentence(case, motion),
        "records": data_elements_by_presence(case.drive.trace.tables, finding.drive, row["ego_id"]),
        "quality": _fitted_log_warnings(case),
        "again": matching_finding(case.ego_rows.verdicts if finding.is_near_miss else case.ego_rows.findings, row),
        "source": case.source,
        "commands": reproducing_commands(
            case.run_options,
            finding,
            case.result.rules["rule_id"].to_pylist(),
            rule_ids_named_by_user(case.result.rules),
        ),
        "log": f"{finding.drive['file_name']} ({finding.drive['format']}), SHA-256",
        "rules_sha256": _rules_sha256(case.result),
        "n_rules": case.result.rules.num_rows,
    }
    values["title"] = sheet_title(case, motion, at, is_only_possible=values["sure"]["title"] == POSSIBLE)
    values["crowded"] = is_first_page_full(values)
    used_characters = (
        characters_lost_to_hash_lines([f"{values['log']} {'0' * 64}", *values["commands"], *values["cut_from"]])
        + _CHARACTERS_RESERVED_FOR_MISSING_RECORDS * values["crowded"]
    )
    return {**values, **_conduct_values(case, span, MOST_ROWS_OF_SECONDS_TABLE - len(rows), used_characters)}


def number_or_dash(value: float | None, digits: int = 2) -> str:
    """Return a number for the table; a dash if it is not known."""
    if value is None or math.isnan(value):
        return _UNKNOWN_NUMBER_TEXT
    text = f"{value:.{digits}f}"
    return text.removeprefix("-") if float(text) == 0 else text.replace("-", "\u2212")


def _finding_sentence(finding: NamedFinding) -> str:
    """Return the finding in one sentence."""
    row, rule = finding.row, finding.rule
    if overlap := box_overlap_text(row, rule):
        return f"{overlap[:1].upper()}{overlap[1:]}."
    observed = measured_and_required_text(row, rule)
    if observed and row["margin"] is not None:
        by = "kept by" if finding.is_near_miss else "missed by"
        observed = f"{rule['observes'] or 'measured'}: {observed}; {by} {amount_text(abs(row['margin']), row['unit'])}"
    if row["unit"] == "m/s2" and finding.is_contact:
        observed += " (of the speed alone, not of its direction; from one step to the next)"
    reason = "" if row["reason_measures"] and observed else row["reason"]
    text = "; ".join(part for part in (reason, observed) if part)
    return shorten(f"{text[:1].upper()}{text[1:]}", _MOST_SENTENCE_CHARACTERS, placeholder=" ...")


def _party_names(finding: NamedFinding) -> list[str]:
    return [f"{letter} ({actor_id})" for letter, actor_id in zip(PARTY_LETTERS, finding.parties, strict=False)]


def _log_name_of_clip(file_name: str) -> str | None:
    """Return the name of the log that a clip was cut from, taken from the clip's name; None if the file is no clip."""
    match = _CLIP_NAME_PATTERN.match(file_name.partition(".")[0])
    return match[1] if match else None


def _signed_number_text(s: float) -> str:
    return text_with_minus_signs(f"{s:+.2f}") if s else "0"


def _least_gap_text(motion: MotionOfParties, finding: NamedFinding) -> str | None:
    """Return the least gap between the two parties in the whole drive, in words; None if no gap is known."""
    known_steps = [i for i, gap in enumerate(motion.gap) if not math.isnan(gap)]
    if not known_steps:
        return None
    i = min(known_steps, key=lambda i: (motion.gap[i], i))
    at = (float(motion.t[i]) * 1e9 + finding.moment_ns - finding.drive_start_ns) / 1e9
    deep = f"boxes overlap by {-motion.gap[i]:.2f} m" if motion.gap[i] < 0 else f"{motion.gap[i]:.2f} m"
    return f"{deep} at {at:.2f} s"


def _other_contacts_of_ego(case: Case) -> list[Row]:
    """Return the contacts of A in this drive, except the sheet's finding, in time order."""
    own_row = case.finding.row
    tagged = {rule["rule_id"] for rule in case.result.rules.to_pylist() if CONTACT_TAG in rule["tags"]}
    contacts = [
        row
        for row in case.result.findings.to_pylist()
        if row["drive_id"] == own_row["drive_id"]
        and row["rule_id"] in tagged
        and row["finding_id"] != own_row["finding_id"]
        and row["object_id"] is not None
        and own_row["ego_id"] in {row["ego_id"], row["object_id"]}
    ]
    return sorted(contacts, key=lambda row: (row["t_start_ns"], row["rule_id"], row["ego_id"]))


def _is_between_parties(case: Case, row: Row) -> bool:
    """Return whether a contact is between the two parties."""
    return {row["ego_id"], row["object_id"]} == set(case.finding.parties)


def _other_contact_texts(case: Case) -> list[str]:
    """Return in words the contacts of the two parties that other rules found, and the contacts of A with other actors."""
    titles = {rule["rule_id"]: rule["title"] for rule in case.result.rules.to_pylist()}
    texts = []
    for row in _other_contacts_of_ego(case):
        sure = f"; {certainty_text(row)}" if row["n_copies"] is not None else ""
        at = seconds(row["t_start_ns"], case.finding.drive_start_ns)
        is_of_parties = _is_between_parties(case, row)
        if not is_of_parties or row["rule_id"] != case.finding.row["rule_id"]:
            other_id = row["object_id"] if row["ego_id"] == case.finding.row["ego_id"] else row["ego_id"]
            other_words, by = "" if is_of_parties else f" with {other_id}", titles[row["rule_id"]]
            texts.append(f"at {at}{other_words}, by the rule \u201c{by}\u201d (finding {row['finding_id'][:8]}{sure})")
    return texts


def _warning_texts(case: Case) -> list[str]:
    return [check["message"] for check in case.finding.drive["quality"] if check["severity"] != "info"]


def _fitted_log_warnings(case: Case) -> FittedTexts:
    """Return the first warnings about the log and the number of further warnings; a long warning is cut and refers to the full text."""
    rest = " ... (in full in report.html)"
    shortened = [shorten(warning, _MOST_WARNING_CHARACTERS, placeholder=rest) for warning in _warning_texts(case)]
    return first_fitted_texts(shortened, _MOST_WARNING_CHARACTERS)


def _clip_source_texts(case: Case) -> list[str]:
    return [
        f"{check['message']}{_CLIP_NOTE}"
        for check in case.finding.drive["quality"]
        if check["check_id"] == CLIP_CHECK_ID
    ]


def _recording_time_texts(finding: NamedFinding) -> dict[str, str]:
    """Return the recording's length, and its start and end in seconds from the moment."""
    end_ns = finding.drive_start_ns + round((finding.drive["duration_s"] or 0.0) * 1e9)
    from_s, to_s = ((t_ns - finding.moment_ns) / 1e9 for t_ns in (finding.drive_start_ns, end_ns))
    return {
        "length": seconds(end_ns, finding.drive_start_ns),
        "from": _signed_number_text(from_s),
        "to": _signed_number_text(to_s),
    }


def _conduct_span_ns(finding: NamedFinding) -> tuple[int, int]:
    """Return start and end of the time in which the conduct of each party is reported, within the recording."""
    end_ns = finding.drive_start_ns + round((finding.drive["duration_s"] or 0.0) * 1e9)
    first, last = (finding.moment_ns + sign * s * 10**9 for sign, s in zip((-1, 1), CONDUCT_SPAN_S, strict=True))
    return max(first, finding.drive_start_ns), min(last, end_ns)


def _conduct_values(
    case: Case, span_ns: tuple[int, int], unused_rows_of_seconds: int, used_characters: int
) -> dict[str, Any]:
    """Return the conduct of each party from its verdicts as ego, and the reasons why rules are undecided for both parties."""
    finding = case.finding
    rules = {rule["rule_id"]: rule for rule in case.result.rules.to_pylist()}
    # the first party was judged again without copies: take their numbers from the result
    copies = {
        row["finding_id"]: {name: row[name] for name in ("n_copies", "n_stays")}
        for row in case.result.findings.to_pylist()
    }
    parties: list[dict[str, Any]] = []
    for letter, actor, rows in zip(PARTY_LETTERS, finding.parties, (case.ego_rows, case.other_party), strict=False):
        party: dict[str, Any] = {
            "letter": letter,
            "id": actor,
            "ego": letter == PARTY_LETTERS[0],
            "in_report": actor in {ego["ego_id"] for ego in finding.drive["exposure"]},
            "not_judged": rows if isinstance(rows, str) else "",
        }
        if rows is not None and not isinstance(rows, str):
            findings = [{**row, **copies.get(row["finding_id"], {})} for row in rows.findings]
            party |= conduct_texts_and_counts(
                rows.verdicts, findings, rules, span_ns, finding.drive_start_ns, is_about_contact=finding.is_contact
            )
        parties.append(party)
    of_both = remove_and_return_shared_reasons(parties)
    other_parties = [(party["id"], party["letter"]) for party in parties][::-1] if len(parties) > 1 else [None]
    parties = [
        conduct_with_party_name(party, party["letter"], other_party)
        for party, other_party in zip(parties, other_parties, strict=True)
    ]
    of_both = conduct_with_party_name(of_both, "either")
    beside = sum(len(line) for party in parties for line in party.get("beside", ()))
    of_both |= {"in_report": any(party["in_report"] for party in parties), "id": parties[-1]["id"]}
    lines = used_characters + beside + SHARED_HEADING_CHARACTERS * bool(of_both["reasons"])
    lines += _CHARACTERS_RESERVED_PER_NOTE * (bool(_warning_texts(case)) + bool(_clip_source_texts(case)))
    further = fit_conduct_lists_and_return_further_pages([*parties, of_both], unused_rows_of_seconds, lines)
    has_kept = any(party[name].texts for party in parties for name in ("kept", "excused") if name in party)
    return {"conduct": parties, "of_both": of_both, "further": further, "has_kept": has_kept}


def _certainty_values(case: Case) -> dict[str, Any]:
    """Return how sure the finding is (`word`, `n`: copies, `stays`: copies in which it stays).

    `title`: for a contact, the certainty of the surest finding of the same contact, else `word`; `by`: that finding's rule, in words.
    """
    row, rules = case.finding.row, {rule["rule_id"]: rule for rule in case.result.rules.to_pylist()}
    values = {"word": certainty(row), "n": row["n_copies"], "stays": row["n_stays"], "title": certainty(row), "by": ""}
    if case.finding.is_contact and values["word"] == POSSIBLE:
        for contact in _other_contacts_of_ego(case):
            same = (
                _is_between_parties(case, contact)
                and contact["t_start_ns"] <= row["t_end_ns"]
                and contact["t_end_ns"] >= row["t_start_ns"]
            )
            if same and certainty(contact) == SURE:
                values["title"] = SURE
                values["by"] = f"\u201c{rules[contact['rule_id']]['title']}\u201d ({certainty_text(contact)})"
                break
    return values


def _contact_by_speed_change_sentence(case: Case, motion: MotionOfParties) -> str:
    """Return in words how a contact is known if no boxes overlap: from a sudden change of speed; '' for other findings."""
    row = case.finding.row
    if not case.finding.is_contact or row["unit"] == "m":
        return ""
    since_s, until_s = ((row[key] - case.finding.moment_ns) / 1e9 for key in ("t_start_ns", "t_end_ns"))
    beside_s = 1.5 * motion.step_s  # include one step before and one step after
    near = (motion.t >= since_s - beside_s) & (motion.t <= until_s + beside_s)
    gaps, times = motion.gap[near], motion.t[near]
    known_gaps = gaps[~np.isnan(gaps)]
    if known_gaps.size and known_gaps.min() <= 0:
        return ""
    gap_text = "no gap is known"
    if known_gaps.size:
        at_s = times[np.nanargmin(gaps)] + (case.finding.moment_ns - case.finding.drive_start_ns) / 1e9
        gap_text = f"least gap {known_gaps.min():.2f} m, at {at_s:.2f} s"
    are_apart = 0 < known_gaps.size == gaps.size
    boxes = "the boxes do not touch at that time" if are_apart else "whether the boxes touch is not known"
    assumed = any(size_source_text(case.drive.trace, actor_id) for actor_id in case.finding.parties)
    sizes = "; sizes are assumed, not recorded" if assumed else ""
    return f"It is based on a sudden change of speed: {boxes} ({gap_text}{sizes})."


def _rules_sha256(result: Result) -> str:
    """Return the SHA-256 of the lines `ID VERSION` of all rules, in the order of the ids."""
    rows = sorted((rule["rule_id"], rule["rule_version"]) for rule in result.rules.to_pylist())
    return hashlib.sha256("".join(f"{rule} {version}\n" for rule, version in rows).encode()).hexdigest()
