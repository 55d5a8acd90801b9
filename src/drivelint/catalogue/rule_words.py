"""Refuses a rule that compares a column with a word that the column never has: such a rule would never apply or never fail."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.errors import RuleError
from drivelint.sql import syntax, word_check
from drivelint.sql.word_types import LiteralPlace, PossibleWords, wrong_words

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from drivelint.catalogue.header import Param
    from drivelint.sql.word_scope import Relation


def refuse_wrong_words(
    sections: Mapping[str, str], params: Mapping[str, Param], place_of: Callable[[str, int], str]
) -> None:
    """Check the words in the SQL of a rule's sections, and in the defaults of its parameters.

    `place_of`: function from a section and a byte offset in its SQL, or from `params.NAME.default` and 0, to `file:line`.
    Errors: `RuleError` with a line for each wrong word, with the nearest valid word.
    """
    try:
        queries = _checked_queries(sections)
    except _DeepSectionError as error:
        raise RuleError(f"{place_of(error.section, 0)}: too deeply nested to be checked: split it into CTEs") from error
    problems = [
        f"{place_of(name, wrong.offset or 0)}: {wrong.message}"
        for name, query in queries.items()
        for wrong in sorted(query.wrong, key=lambda word: word.offset or 0)
    ]
    for name, param in params.items():
        if problem := parameter_problem(sections, name, param.default):
            problems.append(f"{place_of(f'params.{name}.default', 0)}: parameter {name!r}: {problem}")
    if problems:
        raise RuleError("\n".join(dict.fromkeys(problems)))


def parameter_problem(sections: Mapping[str, str], name: str, value: object) -> str | None:
    """Return why a column that the rule compares with this parameter can never have this value; None if the value is possible."""
    if not isinstance(value, str):
        return None
    literal = PossibleWords(literals={value: LiteralPlace(None)}, direct=True)
    for query in _checked_queries(sections).values():
        for compared in query.parameters.get(name, ()):
            for wrong in wrong_words(literal, compared):
                return wrong.message
    return None


class _DeepSectionError(RecursionError):
    """Raised for a section that is too deeply nested to be checked."""

    def __init__(self, section: str) -> None:
        super().__init__(section)
        self.section = section


def _checked_queries(sections: Mapping[str, str]) -> dict[str, word_check.CheckedQuery]:
    """Return section -> its checked query. For the other sections, the engine's tables have the columns of @reference.

    Errors: `_DeepSectionError`.
    """
    queries: dict[str, word_check.CheckedQuery] = {}
    tables: dict[str, Relation] = {}
    for name in sorted(sections, key=lambda section: section != "reference"):
        try:
            queries[name] = word_check.check_query(syntax.parse_select(sections[name], name), tables)
        except RecursionError as error:
            raise _DeepSectionError(name) from error
        if name == "reference":
            columns = queries[name].relation._replace(complete=False)
            tables = {"reference": columns, "reference_step": columns}
    return queries
