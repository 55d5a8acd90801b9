"""Parses the header of a rule file: TOML in its leading comment lines; unknown keys are refused."""

from __future__ import annotations

import re
import tomllib
from math import inf
from typing import Any, Final, Literal

import msgspec

from drivelint.drive import conditions
from drivelint.errors import RuleError
from drivelint.phrases import hint
from drivelint.reasons import signals
from drivelint.reasons.reason_text import ReasonText

Kind = Literal["invariant", "execution", "precondition", "postcondition"]
Seconds = float | str
"""Seconds, or the name of the rule's parameter that holds them."""

_NAME = re.compile(r"[a-z][a-z0-9_]*")
_TABLE = re.compile(r"\s*\[([^\[\]=,]+)\]\s*(?:#.*)?$")
_KEY = re.compile(r"\s*([\w.\"' \t-]+?)\s*=")


class Param(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A number, switch or word of a rule that a user may change: bound as `$name`, never formatted into SQL."""

    default: float | bool | str
    unit: str
    why: str
    source: str = ""


class Conditions(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The conditions in which a rule applies, see `ego_condition`; all must hold; none given: it always applies."""

    road_type: tuple[str, ...] = ()
    carriageway: tuple[str, ...] = ()
    area: tuple[str, ...] = ()
    nation: tuple[str, ...] = ()
    weather: tuple[str, ...] = ()
    light: tuple[str, ...] = ()
    vehicle_class: tuple[str, ...] = ()
    limit_min_mps: float | None = None
    """The least speed limit in m/s, itself included."""
    limit_max_mps: float | None = None
    """The greatest speed limit in m/s, itself included."""

    @property
    def restricting(self) -> dict[str, tuple[str, ...]]:
        """Return condition -> allowed values, for the conditions that restrict the rule."""
        return {name: getattr(self, name) for name in conditions.CONDITION_VALUES if getattr(self, name)}

    @property
    def has_limit(self) -> bool:
        """Whether the speed limit restricts the rule."""
        return self.limit_min_mps is not None or self.limit_max_mps is not None


class Header(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What a rule says about itself, field by field as in the design."""

    title: str
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
    """What `observed` is, as a short noun phrase, for the sentence of a verdict."""
    near_margin: float | None = None
    reads: tuple[str, ...]
    requires: tuple[str, ...] = ()
    pass_requires: tuple[str, ...] = ()
    """Signals without which the rule can be found broken, but not kept."""
    reference: str | None = None
    without_time: str | None = None
    """What the log does not show where the time of a reference point is not known, as a clause."""
    without_anchor: str | None = None
    """The same for an anchor without a time."""
    exempt_after_s: Seconds = 0.0
    merge_gap_s: Seconds = 1.0
    tags: tuple[str, ...] = ()
    """What reports know a rule by: `contact`, its findings are contacts; `danger_space`, its pictures show danger spaces."""
    law: tuple[str, ...] = ()
    """The nations whose law the rule is: it is not applicable where the nation is known to be another; empty: no nation's own."""
    applies: Conditions = Conditions()
    params: dict[str, Param] = {}
    reasons: dict[str, ReasonText] = {}
    """The codes that only this rule gives as reasons (the macro `why`), with their words."""


_OF: Final = {"params": Param, "applies": Conditions, "reasons": ReasonText}


def json_schema() -> dict[str, Any]:
    """Return the JSON schema of a rule's header, for editors and for authors of packs."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(Header)}


def parse_header(text: str, where: str) -> Header:
    """Parse the TOML `text`, whose line n is line n of the file `where`.

    Errors: `RuleError` naming file and line for bad TOML, an unknown key (with the nearest known one), a wrong type, or
    fields
    that contradict each other.
    """
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        line = re.search(r"at line (\d+)", str(error))
        raise RuleError(f"{where}:{line[1] if line else 1}: the header is not TOML: {error}") from error
    try:
        header = msgspec.convert(raw, Header)
    except msgspec.ValidationError as error:
        raise _explained(error, text, where) from error
    problem = _contradiction(header)
    if problem:
        key, message = problem
        raise RuleError(f"{where}:{line_of(text, key)}: {message}")
    return header


def _explained(error: msgspec.ValidationError, text: str, where: str) -> RuleError:
    """Turn msgspec's message into one line with file, line and the nearest known key."""
    message = str(error)
    place = re.search(r"at `\$\.?([^`]*)`", message)
    path = place[1] if place else ""
    unknown = re.search(r"unknown field `([^`]+)`", message)
    keys = re.sub(r"\[[^\]]*\]", ".*", path)
    if not unknown:
        return RuleError(f"{where}:{line_of(text, keys)}: header: {message}")
    key = unknown[1]
    known = _OF.get(re.split(r"\W", path)[0], Header)
    nearest = hint(key, known.__struct_fields__)
    line = line_of(text, f"{keys}.{key}" if keys else key)
    return RuleError(f"{where}:{line}: unknown key {key!r} in the header; {nearest}")


def line_of(text: str, key: str) -> int:
    """Return the line of the header that sets a key, such as `reads` or `params.near_m.unit`; `*` in it is any name.

    Where no line sets it: that of the table or key that it would be in, else 1.
    """
    wanted = key.split(".")
    table: list[str] = []
    best, depth = 1, 0
    for n, line in enumerate(text.splitlines(), 1):
        head, said = _TABLE.match(line), _KEY.match(line)
        if head:
            table = _parts(head[1])
        path = table if head else [*table, *_parts(said[1])] if said else []
        fits = len(path) <= len(wanted) and all(want in {"*", part} for want, part in zip(wanted, path, strict=False))
        if fits and len(path) > depth:
            best, depth = n, len(path)
    return best


def _parts(name: str) -> list[str]:
    return [part.strip(" \t'\"") for part in name.split(".")]


def _contradiction(h: Header) -> tuple[str, str] | None:
    """Return (key, message) of the first rule of the header that is broken, or None."""
    later = h.kind in {"precondition", "postcondition"}
    seconds = {"window_s": h.window_s, "exempt_after_s": h.exempt_after_s, "merge_gap_s": h.merge_gap_s}
    checks: list[tuple[bool, str, str]] = [
        (
            later != (h.subtype is not None),
            "subtype" if h.subtype else "kind",
            "subtype (temporal or physical) belongs to pre- and postconditions, and they need it",
        ),
        (
            (h.subtype == "temporal") != (h.window_s is not None),
            "window_s",
            "window_s belongs to temporal conditions, and they need it",
        ),
        (
            h.quantifier == "eventually" and not later,
            "quantifier",
            f"quantifier = 'eventually' makes no sense for an {h.kind}: use a pre- or postcondition",
        ),
        (
            h.combine != "each" and h.kind == "invariant",
            "combine",
            "an invariant is judged per object: combine is for conditions at a reference point",
        ),
        (h.sense != "holds" and h.unit is None, "sense", "unit is missing: a measured condition says in which unit"),
        (
            h.sense == "holds" and h.near_margin is not None,
            "near_margin",
            "near_margin needs a measured condition, not sense = 'holds'",
        ),
        (h.kind == "invariant" and h.reference is not None, "reference", "an invariant has no reference point"),
        (h.kind != "invariant" and h.exempt_after_s != 0, "exempt_after_s", "exempt_after_s is for invariants"),
        (
            h.observes is not None and (h.sense == "holds" or not h.observes.strip()),
            "observes",
            "observes names what a measured condition observes, as a short noun phrase; sense = 'holds' observes nothing",
        ),
        (h.kind == "invariant" and h.without_time is not None, "without_time", "an invariant has no reference point"),
        (
            h.subtype != "physical" and h.without_anchor is not None,
            "without_anchor",
            "without_anchor is for physical conditions: no other has an anchor",
        ),
        (not h.reads, "reads", "reads must name the tables that the rule reads"),
    ]
    checks += [
        (
            not _NAME.fullmatch(name),
            f"params.{name}",
            f"parameter {name!r}: use lower-case letters, digits and _, a letter first",
        )
        for name in h.params
    ]
    for key in ("requires", "pass_requires"):
        checks += [(True, key, f"{key}: {wrong}") for word in getattr(h, key) if (wrong := signals.problem(word))]
    checks += [(True, "law", f"law: {wrong}") for word in h.law if (wrong := conditions.value_problem("nation", word))]
    for name, words in h.applies.restricting.items():
        checks += [
            (True, f"applies.{name}", f"[applies] {wrong}")
            for word in words
            if (wrong := conditions.value_problem(name, word))
        ]
    least, most = h.applies.limit_min_mps, h.applies.limit_max_mps
    checks += [
        (value is not None and not 0 <= value < inf, f"applies.{key}", f"{key} must be a speed in m/s, not {value}")
        for key, value in (("limit_min_mps", least), ("limit_max_mps", most))
    ]
    checks.append(
        (
            least is not None and most is not None and least > most,
            "applies.limit_min_mps",
            "limit_min_mps is above limit_max_mps: the rule would apply nowhere",
        )
    )
    for key, value in seconds.items():
        if isinstance(value, str):
            default = h.params[value].default if value in h.params else None
            good = isinstance(default, float) and default >= 0
            checks.append(
                (not good, key, f"{key} = {value!r} must be a number or the name of a numeric parameter of this rule")
            )
        elif value is not None:
            checks.append((not 0 <= value < 1e9, key, f"{key} must be a number of seconds, not {value}"))
    return next(((key, message) for broken, key, message in checks if broken), None)
