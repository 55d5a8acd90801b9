"""Turns reasons, which are codes with arguments, into sentences.

The SQL macro `why(code, arguments)` returns a reason as JSON text. The text of a code is in `words.toml`, or in the header of the rule if
only this rule uses the code. A user's rule may return plain text instead, which is printed as it is.
"""

from __future__ import annotations

import json
import re
from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import msgspec

from drivelint.facts import toml_beside

if TYPE_CHECKING:
    from collections.abc import Mapping

_OPTIONAL = re.compile(r"\[([^\[\]]*)\]")
_ARGUMENT = re.compile(r"\{(\w+)(?::(\.?\d?[fg]))?\}")
_JSON_START = '{"code":'
PLAIN_TEXT_CODE: Final = "text"
"""The code of a reason that is plain text; the text is its argument."""


class ReasonText(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The text and the advice of a reason code; `{name}` is an argument, and `[...]` is left out if an argument in it is NULL."""

    says: str
    advice: str = ""

    def __post_init__(self) -> None:
        """Raise `ValueError` for text in braces that is no argument: formatting it may be unsafe."""
        for text in (self.says, self.advice):
            if rest := re.search(r"[{}].*", _ARGUMENT.sub("", text)):
                raise ValueError(f"{rest[0]!r}: write an argument as {{name}} or {{name:.1f}}")

    @property
    def required_arguments(self) -> frozenset[str]:
        """The names of the arguments that must not be NULL."""
        return frozenset(name for name, _ in _ARGUMENT.findall(_OPTIONAL.sub("", self.says + self.advice)))


class Reason(NamedTuple):
    """A reason: its code and its arguments by name."""

    code: str
    arguments: dict[str, Any]


def texts_of_shared_codes() -> dict[str, ReasonText]:
    """Return reason code -> text, for the codes of `words.toml`, which do not belong to a single rule."""
    return _read_words_file()[0]


@cache
def _read_words_file() -> tuple[dict[str, ReasonText], dict[str, dict[str, str]]]:
    raw = dict(toml_beside(__file__, "words.toml"))
    values = raw.pop("values")
    return msgspec.convert(raw, dict[str, ReasonText]), values


def parse_reason(reason: str) -> Reason:
    """Return the code and the arguments of a reason; `reason`: JSON from the SQL macro `why`, or plain text."""
    try:
        raw = json.loads(reason) if reason.startswith(_JSON_START) else {}
        return Reason(str(raw["code"]), dict(raw.get("args") or {}))
    except (ValueError, TypeError, KeyError):
        return Reason(PLAIN_TEXT_CODE, {PLAIN_TEXT_CODE: reason})


def sentence(reason: str, start_ns: int = 0, rule_texts: Mapping[str, ReasonText] | None = None) -> str:
    """Return a reason as a sentence, with its advice at the end.

    `start_ns`: the start of the log, from which times count; `rule_texts`: the texts of the rule's codes.
    """
    code, arguments = parse_reason(reason)
    return reason if code == PLAIN_TEXT_CODE else _sentence(code, arguments, start_ns, rule_texts)


def _sentence(
    code: str, arguments: Mapping[str, Any], start_ns: int, rule_texts: Mapping[str, ReasonText] | None
) -> str:
    words = text_of(code, rule_texts)
    text = _sentence_from_template(words.says, arguments, start_ns, rule_texts)
    return f"{text}: {_sentence_from_template(words.advice, arguments, start_ns, rule_texts)}" if words.advice else text


def sentence_if_it_has_advice(
    code: str, arguments: Mapping[str, Any], start_ns: int = 0, rule_texts: Mapping[str, ReasonText] | None = None
) -> str | None:
    """Return a reason as a sentence if it, or a reason in its arguments, has advice; else None."""
    nested = (
        sentence_if_it_has_advice(*nested_reason, start_ns, rule_texts) for nested_reason in _nested_reasons(arguments)
    )
    return _sentence(code, arguments, start_ns, rule_texts) if text_of(code, rule_texts).advice or any(nested) else None


def code_and_nested_codes(code: str, arguments: Mapping[str, Any]) -> set[str]:
    """Return a code and the codes of the reasons among its arguments."""
    return {code}.union(*(code_and_nested_codes(*reason) for reason in _nested_reasons(arguments)))


def _nested_reasons(arguments: Mapping[str, Any]) -> list[Reason]:
    """Return those arguments of a reason that are reasons themselves."""
    reasons = [parse_reason(value) for value in arguments.values() if isinstance(value, str)]
    return [reason for reason in reasons if reason.code != PLAIN_TEXT_CODE]


def text_of(code: str, rule_texts: Mapping[str, ReasonText] | None = None) -> ReasonText:
    """Return the text of a code: from the rule, else from `words.toml`, else the code itself with spaces."""
    return (rule_texts or {}).get(code) or texts_of_shared_codes().get(code) or ReasonText(code.replace("_", " "))


def _sentence_from_template(
    template: str, arguments: Mapping[str, Any], start_ns: int, rule_texts: Mapping[str, ReasonText] | None
) -> str:
    argument_words = {name: _argument_words(name, value, start_ns, rule_texts) for name, value in arguments.items()}
    for part in _OPTIONAL.findall(template):
        absent = any(argument_words.get(name) is None for name, _ in _ARGUMENT.findall(part))
        template = template.replace(f"[{part}]", "" if absent else part, 1)
    return _ARGUMENT.sub(lambda match: _formatted_value(argument_words.get(match[1]), match[2] or ""), template)


def _formatted_value(value: Any, spec: str) -> str:
    if value is None:
        return "?"  # a required argument is NULL
    return format(value, spec) if isinstance(value, int | float) else str(value)


def _argument_words(name: str, value: Any, start_ns: int, rule_texts: Mapping[str, ReasonText] | None) -> Any:
    """Return an argument as it is inserted into a text.

    A time is converted to seconds from the start, a value in the table `[values.<name>]` to its words, a reason to its sentence.
    """
    if name.endswith("_ns") and isinstance(value, int):
        return f"{(value - start_ns) / 1e9:.3f} s"
    if isinstance(value, str):
        return _read_words_file()[1].get(name, {}).get(value) or sentence(value, start_ns, rule_texts)
    return value
