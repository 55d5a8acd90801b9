"""Resolves names in a SELECT to their possible words: columns of its sources, its aliases, and outer queries."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from drivelint.sql.word_types import WordType, possible_words_of_field, union

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


class Relation(NamedTuple):
    """The columns of a table or query in order, with names in lower case. `complete`: it has no other columns."""

    columns: Sequence[tuple[str, WordType]]
    complete: bool = True


UNKNOWN = Relation([], complete=False)


class Source:
    """A relation in a FROM, its name or alias, and its `hidden` columns, which a `*` omits."""

    def __init__(self, name: str, relation: Relation, hidden: frozenset[str] = frozenset()) -> None:
        self.name, self.relation, self.hidden = name, relation, hidden

    @cached_property
    def possible_words_by_column(self) -> dict[str, WordType]:
        """Column -> its possible values; if two columns have the same name, the first one counts."""
        return dict(reversed(self.relation.columns))

    def with_hidden_columns(self, names: frozenset[str]) -> Source:
        """Return the source with more hidden columns."""
        return Source(self.name, self.relation, self.hidden | names)


class Scope:
    """The names in scope: `bound` parameters of a macro or lambda, sources of a FROM, aliases of a SELECT, and the outer scope."""

    def __init__(
        self,
        outer: Scope | None = None,
        ctes: Mapping[str, Relation] | None = None,
        sources: Sequence[Source] = (),
        bound: Mapping[str, WordType] | None = None,
    ) -> None:
        self.outer, self.ctes, self.sources, self.bound = outer, ctes or {}, sources, bound or {}
        self.aliases: dict[str, WordType] = {}

    def lookup(self, names: Sequence[str]) -> WordType:
        """Return the possible values of a column. `names`: its parts in lower case: [source], column, [fields]."""
        first, *rest = names
        if first in self.bound:
            return possible_words_of_field(self.bound[first], rest)
        for source in self.sources:
            if rest and source.name == first and rest[0] in source.possible_words_by_column:
                return possible_words_of_field(source.possible_words_by_column[rest[0]], rest[1:])
        for source in self.sources:
            if first in source.possible_words_by_column:
                return possible_words_of_field(source.possible_words_by_column[first], rest)
        if first in self.aliases:
            return possible_words_of_field(self.aliases[first], rest)
        if self.outer is None or not all(source.relation.complete for source in self.sources):
            return None
        return self.outer.lookup(names)


def with_column_names(relation: Relation, names: Sequence[str]) -> Relation:
    """Return the relation with its first columns renamed to `names`."""
    columns = list(relation.columns)
    columns[: len(names)] = [(name.lower(), kind) for name, (_, kind) in zip(names, columns, strict=False)]
    return Relation(columns, relation.complete)


def union_of_relations(left: Relation, right: Relation, *, by_name: bool) -> Relation:
    """Return the columns of a UNION of two relations."""
    complete = left.complete and right.complete
    if by_name:
        first, second = dict(left.columns), dict(right.columns)
        names = dict.fromkeys([*first, *second])
        possible_words_by_column = {
            name: [columns[name] for columns in (first, second) if name in columns] for name in names
        }
        return Relation([(name, union(possible_words_by_column[name])) for name in names], complete)
    if not complete:
        return Relation([(name, None) for name, _ in left.columns], complete=False)
    pairs = zip(left.columns, right.columns, strict=False)
    return Relation([(name, union([kind, other_kind])) for (name, kind), (_, other_kind) in pairs])
