"""The header of a rule file, TOML in the leading comment lines: its fields, and what they must not contradict."""

from __future__ import annotations

import re
from math import inf
from typing import TYPE_CHECKING, Any, Final, Literal

import msgspec

from drivelint.drive import conditions
from drivelint.reasons import signals
from drivelint.reasons.reason_text import ReasonText  # noqa: TC001 - msgspec looks the field types up
from drivelint.sql.words import Quantity, vocabularies

if TYPE_CHECKING:
    from collections.abc import Iterator

Kind = Literal["invariant", "execution", "precondition", "postcondition"]
Seconds = float | str
"""Seconds, or the name of the rule's parameter with the seconds."""

_PARAM_NAME = re.compile(r"[a-z][a-z0-9_]*")
TABLE_LINE = re.compile(r"\s*\[([^\[\]=,]+)\]\s*(?:#.*)?$")
_KEY_LINE = re.compile(r"\s*([\w.\"' \t-]+?)\s*=")


class Param(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A number, switch or word of a rule that a user may change. It is bound as `$name`, never formatted into SQL."""

    default: float | bool | str
    unit: str
    why: str
    source: str = ""


class Conditions(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The conditions under which a rule applies, see `ego_condition`. All must be true; without conditions, the rule always applies."""

    road_type: tuple[str, ...] = ()
    carriageway: tuple[str, ...] = ()
    area: tuple[str, ...] = ()
    nation: tuple[str, ...] = ()
    weather: tuple[str, ...] = ()
    light: tuple[str, ...] = ()
    vehicle_class: tuple[str, ...] = ()
    limit_min_mps: float | None = None
    """The least speed limit in m/s, inclusive."""
    limit_max_mps: float | None = None
    """The greatest speed limit in m/s, inclusive."""

    @property
    def restricted_conditions(self) -> dict[str, tuple[str, ...]]:
        """Return condition -> allowed values, for the conditions that restrict the rule."""
        return {name: getattr(self, name) for name in conditions.RULE_CONDITION_VALUES if getattr(self, name)}

    @property
    def has_speed_limit_condition(self) -> bool:
        """Whether the speed limit restricts the rule."""
        return self.limit_min_mps is not None or self.limit_max_mps is not None


CONTACT_TAG: Final = "contact"
"""Tag of the rules whose findings are contacts, found from touching boxes or from the speeds."""
JUDGES_STANDING_EGO_TAG: Final = "standing"
"""Tag of the rules that also judge an ego that never moves."""
EXCUSABLE_RULE_TAG: Final = "excuses"
"""Tag of the rules that may be kept although their title is false. The hypothesis states the excuse, such as overtaking."""
ROAD_USERS_SIGNAL: Final = "road_users"
"""The signal that every rule about other actors needs: the log records the actors around the ego."""


class Header(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The header of a rule, field by field."""

    title: str
    """A statement that is true when the rule is kept."""
    breach: str | None = None
    """The title of its findings: what happened when the rule is broken. None: "Not kept: " and the rule's title."""
    clause: str
    hypothesis: str
    kind: Kind
    subtype: Literal["temporal", "physical"] | None = None
    window_s: Seconds | None = None
    quantifier: Literal["always", "eventually"] = "always"
    combine: Literal["each", "all", "any"] = "each"
    derivation: Literal["direct", "model"]
    severity: Literal["critical", "major", "minor"]
    legal: Literal["must", "should"]
    status: Literal["draft", "stable", "deprecated"]
    sense: Literal[">=", ">", "<=", "<", "holds"]
    unit: str | None = None
    observes: str | None = None
    """A short noun phrase for the quantity `observed`, for the sentence of a verdict."""
    near_margin: float | None = None
    reads: tuple[str, ...]
    requires: tuple[str, ...] = ()
    pass_requires: tuple[str, ...] = ()
    """Signals without which the rule can fail, but not pass."""
    reference: str | None = None
    without_time: str | None = None
    """Words for a sentence: what the log does not show if the time of a reference point is unknown."""
    without_anchor: str | None = None
    """Words for a sentence: what the log does not show if the time of an anchor is unknown."""
    exempt_after_s: Seconds = 0.0
    merge_gap_s: Seconds = 1.0
    tags: tuple[str, ...] = ()
    """Tags by which reports recognise kinds of rules, such as `contact`, or `danger_space`: its pictures show danger spaces."""
    unaffected_by: tuple[Quantity, ...] = ()
    """Quantities whose uncertainty does not make a step unknown, although the rule reads columns computed from them."""
    law: tuple[str, ...] = ()
    """The nations whose law contains the rule: it is not applicable in another known nation. Empty: it applies in all nations."""
    applies: Conditions = Conditions()
    params: dict[str, Param] = {}
    reasons: dict[str, ReasonText] = {}
    """Reason code -> its text, for codes that only this rule gives by the macro `why`."""


def json_schema() -> dict[str, Any]:
    """Return the JSON schema of a rule's header, for editors and authors of packs."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(Header)}


def contradictions(header: Header) -> list[tuple[str, str]]:
    """Return (key, problem) for fields that contradict each other, and for words and numbers that a field cannot have."""
    return [*_kind_problems(header), *_word_problems(header), *_number_problems(header)]


def line_of_key(text: str, key: str) -> int:
    """Return the line of the header that sets a key, such as `reads` or `params.near_m.unit`; `*` in the key matches any name.

    If no line sets the key, return the line of the table or key that would contain it, else 1.
    """
    parts = key.split(".")
    table: list[str] = []
    best, depth = 1, 0
    for n, line in enumerate(text.splitlines(), 1):
        head, match = TABLE_LINE.match(line), _KEY_LINE.match(line)
        if head:
            table = _split_key(head[1])
        path = table if head else [*table, *_split_key(match[1])] if match else []
        fits = len(path) <= len(parts) and all(want in {"*", part} for want, part in zip(parts, path, strict=False))
        if fits and len(path) > depth:
            best, depth = n, len(path)
    return best


def _split_key(name: str) -> list[str]:
    return [part.strip(" \t'\"") for part in name.split(".")]


def _kind_problems(h: Header) -> Iterator[tuple[str, str]]:
    """Yield (key, problem) for the fields that contradict the rule's kind or sense."""
    later, is_measured = h.kind in {"precondition", "postcondition"}, h.sense != "holds"
    if later != (h.subtype is not None):
        key = "subtype" if h.subtype else "kind"
        yield key, "subtype (temporal or physical) belongs to pre- and postconditions, and they need it"
    if (h.subtype == "temporal") != (h.window_s is not None):
        yield "window_s", "window_s belongs to temporal conditions, and they need it"
    if h.quantifier == "eventually" and not later:
        yield "quantifier", f"quantifier = 'eventually' makes no sense for an {h.kind}: use a pre- or postcondition"
    if h.combine != "each" and h.kind == "invariant":
        yield "combine", "an invariant is judged per object: combine is for conditions at a reference point"
    if is_measured and h.unit is None:
        yield "sense", "unit is missing: a measured condition needs its unit"
    if not is_measured and h.near_margin is not None:
        yield "near_margin", "near_margin needs a measured condition, not sense = 'holds'"
    if h.kind == "invariant" and h.reference is not None:
        yield "reference", "an invariant has no reference point"
    if h.kind != "invariant" and h.exempt_after_s != 0:
        yield "exempt_after_s", "exempt_after_s is for invariants"
    if h.observes is not None and not (is_measured and h.observes.strip()):
        message = "observes names what a measured condition observes, as a short noun phrase; sense = 'holds' observes nothing"
        yield "observes", message
    if h.kind == "invariant" and h.without_time is not None:
        yield "without_time", "an invariant has no reference point"
    if h.subtype != "physical" and h.without_anchor is not None:
        yield "without_anchor", "without_anchor is for physical conditions: no other has an anchor"


def _word_problems(h: Header) -> Iterator[tuple[str, str]]:
    if not h.reads:
        yield "reads", "reads must name the tables that the rule reads"
    for name in h.params:
        if not _PARAM_NAME.fullmatch(name):
            yield f"params.{name}", f"parameter {name!r}: use lower-case letters, digits and _, a letter first"
    for key, words in (("requires", h.requires), ("pass_requires", h.pass_requires)):
        yield from ((key, f"{key}: {wrong}") for word in words if (wrong := signals.unknown_signal_message(word)))
    vocabulary = vocabularies()["rule_tag"]
    yield from (("tags", f"tags: {wrong}") for word in h.tags if (wrong := vocabulary.problem(word)))
    yield from (("law", f"law: {wrong}") for word in h.law if (wrong := conditions.value_problem("nation", word)))
    for name, words in h.applies.restricted_conditions.items():
        problems = (conditions.value_problem(name, word) for word in words)
        yield from ((f"applies.{name}", f"[applies] {wrong}") for wrong in problems if wrong)


def _number_problems(h: Header) -> Iterator[tuple[str, str]]:
    least, largest = h.applies.limit_min_mps, h.applies.limit_max_mps
    for key, value in (("limit_min_mps", least), ("limit_max_mps", largest)):
        if value is not None and not 0 <= value < inf:
            yield f"applies.{key}", f"{key} must be a speed in m/s, not {value}"
    if least is not None and largest is not None and least > largest:
        yield "applies.limit_min_mps", "limit_min_mps is above limit_max_mps: the rule would apply nowhere"
    for key in ("window_s", "exempt_after_s", "merge_gap_s"):
        if wrong := _seconds_problem(h, getattr(h, key)):
            yield key, f"{key} {wrong}"


def _seconds_problem(h: Header, seconds: Seconds | None) -> str | None:
    if isinstance(seconds, str):
        default = h.params[seconds].default if seconds in h.params else None
        if not (isinstance(default, float) and default >= 0):
            return f"= {seconds!r} must be a number or the name of a numeric parameter of this rule"
    elif seconds is not None and not 0 <= seconds < 1e9:
        return f"must be a number of seconds, not {seconds}"
    return None
