"""Reads one rule file and checks its header, its sections, and whether header and sections agree."""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from drivelint.catalogue.check import ENGINE_TABLES, SelectParts, check_query, collect_problems, raise_problems
from drivelint.catalogue.header import Header, line_of_key, parse_header
from drivelint.catalogue.rule import Rule
from drivelint.catalogue.rule_words import refuse_wrong_words
from drivelint.errors import RuleError
from drivelint.phrases import hint, nearest_word
from drivelint.reasons.reason_text import texts_of_shared_codes
from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

PACK_NAME = re.compile(r"[a-z0-9][a-z0-9_-]*")
RULE_NAME = re.compile(r"[a-z0-9][a-z0-9._-]*")
SECTIONS = ("applies", "reference", "condition", "anchor")
_SECTION_MARK = re.compile(r"^--\s*@(\S+)\s*$")
_HIDDEN_CHARACTER = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")
"""Characters that end a line invisibly, control a terminal or reverse the reading order."""
_KEY_COLUMNS = ("drive_id", "ego_id", "t_ns")
_MEASURE_COLUMNS = ("object_id", "ref_id", "profile", "observed", "required", "holds", "applies", "at_least", "error")
_CONDITION_COLUMNS = (*_KEY_COLUMNS, *_MEASURE_COLUMNS, "reason_code", "reason")


class Section(NamedTuple):
    """One section of a rule: its SELECT, the line of its `@` mark, and the line on which the SELECT begins."""

    sql: str
    line: int
    sql_line: int


def checked_rule(file: Path, pack: str, pack_title: str, content: bytes, *, check_words: bool) -> Rule:
    """Check the content of a rule file and return the rule. Errors: `RuleError` with file and line.

    `pack`, `pack_title`: name and title of its pack; `check_words`: also check the words in its SQL.
    """
    for part, what, pattern in ((pack, "folder", PACK_NAME), (file.stem, "file", RULE_NAME)):
        if not pattern.fullmatch(part):
            raise RuleError(
                f"{file}: the {what} name {part!r} makes no rule id: "
                "lower-case letters, digits, '-', '_' (and '.' in the file name) only"
            )
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise RuleError(f"{file}: not UTF-8 at byte {error.start}") from error
    if hidden := _HIDDEN_CHARACTER.search(text):
        line = text.count("\n", 0, hidden.start()) + 1
        raise RuleError(f"{file}:{line}: the character U+{ord(hidden[0]):04X} hides what the rule does: remove it")
    toml, sections = split_sections(text, str(file))
    problems: list[str] = []
    with collect_problems(problems):
        header = parse_header(toml, str(file))
    queries: dict[str, SelectParts] = {}
    for name, section in sections.items():
        with collect_problems(problems):
            queries[name] = check_query(section.sql, str(file), section.sql_line)
    raise_problems(problems)
    if header.reference is not None:
        event = sections["reference"] = _event_table_section(
            header.reference, sections, file, line_of_key(toml, "reference")
        )
        queries["reference"] = check_query(event.sql, str(file), event.sql_line)
    problems += _section_problems(header, sections, queries, file)
    problems += _reads_problems(header, queries, f"{file}:{line_of_key(toml, 'reads')}")
    problems += _param_problems(header, queries, file, toml)
    problems += _reason_problems(header, queries, file, toml)
    if check_words:
        with collect_problems(problems):
            _refuse_wrong_words(header, sections, file, toml)
    raise_problems(problems)
    return Rule(
        **msgspec.structs.asdict(header),
        id=f"{pack}.{file.stem}",
        pack=pack,
        pack_title=pack_title,
        path=file,
        version=hashlib.sha256(content).hexdigest()[:16],
        sections={name: section.sql.rstrip().rstrip(";") for name, section in sections.items()},
        columns={
            name: query.columns
            for name, query in queries.items()
            if query.columns is not None and not (name == "reference" and query.by_name)
        },
        reason_codes=frozenset(reason.code for query in queries.values() for reason in query.reasons),
        quantities=_used_quantities(header, queries),
        occasion_needs=next((queries[name].needs for name in ("reference", "applies") if name in queries), frozenset()),
    )


def _used_quantities(header: Header, queries: dict[str, SelectParts]) -> frozenset[str]:
    """Return the quantities of actors that a rule uses: existence, identity, and the quantities of the columns that it names."""
    declared = store.input_quantities_by_column()
    # an event table named in the header provides all its columns: only columns that other sections name count
    named = {
        name
        for section, query in queries.items()
        if not (header.reference and section == "reference")
        for name in query.column_names
    }
    used = {"existence", "identity"} | ({"position"} if header.reference else set())
    for table in header.reads:
        used.update(*(quantities for column, quantities in declared.get(table, {}).items() if column in named))
    return frozenset(used.difference(header.unaffected_by))


def split_sections(text: str, where: str) -> tuple[str, dict[str, Section]]:
    """Return the header's TOML (its line n is line n of the file), and name -> section.

    Errors: `RuleError` for SQL before the first section, and for an unknown, repeated, empty or missing section.
    """
    lines = text.splitlines()
    marks = [(n, match[1]) for n, line in enumerate(lines) if (match := _SECTION_MARK.match(line))]
    header_end = marks[0][0] if marks else len(lines)
    header = [_uncomment(line, n, where) for n, line in enumerate(lines[:header_end], 1)]
    sections: dict[str, Section] = {}
    ends = [n for n, _ in marks[1:]] + [len(lines)]
    for (start, name), end in zip(marks, ends, strict=False):
        if name not in SECTIONS:
            raise RuleError(f"{where}:{start + 1}: unknown section @{name}; {hint(name, SECTIONS, prefix='@')}")
        if name in sections:
            raise RuleError(f"{where}:{start + 1}: section @{name} stands twice")
        below = lines[start + 1 : end]
        body = "\n".join(below).strip()
        if not body:
            raise RuleError(f"{where}:{start + 1}: section @{name} is empty")
        blank = next(n for n, line in enumerate(below) if line.strip())
        sections[name] = Section(body, start + 1, start + 2 + blank)
    if "condition" not in sections:
        raise RuleError(f"{where}:{len(lines)}: section '-- @condition' is missing")
    return "\n".join(header), sections


def _uncomment(line: str, n: int, where: str) -> str:
    if not line.strip():
        return ""
    if not line.startswith("--"):
        raise RuleError(
            f"{where}:{n}: only '-- ' comment lines (the header) may stand before the first '-- @section' line"
        )
    return line[2:].removeprefix(" ")


def _event_table_section(table: str, sections: dict[str, Section], file: Path, line: int) -> Section:
    """Return the section @reference that the header's `reference = "table"` abbreviates: a SELECT of that whole event table."""
    if "reference" in sections:
        raise RuleError(
            f"{file}:{sections['reference'].line}: the header names an event table already: drop it or @reference"
        )
    columns = store.column_comments().get(table, {})
    if not set(_KEY_COLUMNS) <= columns.keys():
        raise RuleError(
            f"{file}:{line}: reference = {table!r} is no event table: it needs the columns drive_id, ego_id, t_ns"
        )
    return Section(f"SELECT {', '.join(columns)} FROM {table}", line, line)


def _section_problems(
    header: Header, sections: dict[str, Section], queries: dict[str, SelectParts], file: Path
) -> Iterator[str]:
    """Yield the problems of missing or surplus sections, and of each section's columns."""
    wanted = {"reference": header.kind != "invariant", "anchor": header.subtype == "physical"}
    for name, needed in wanted.items():
        if needed != (name in sections):
            line = sections[name].line if name in sections else 1
            what = " ".join(word for word in (header.subtype, header.kind) if word)
            yield (f"{file}:{line}: {what}: {'needs a' if needed else 'has no'} section @{name}")
    if "applies" in sections and header.kind != "invariant":
        yield (
            f"{file}:{sections['applies'].line}: @applies is for invariants; "
            "return a column 'applies' from the condition instead"
        )
    measured = ("holds",) if header.sense == "holds" else ("observed", "required")
    contracts: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
        "condition": ((*_KEY_COLUMNS, *measured), _CONDITION_COLUMNS),
        "applies": (_KEY_COLUMNS, (*_KEY_COLUMNS, "object_id", "episode", "applies", "reason")),
        "anchor": (("ref_id", "t_ns"), ("ref_id", "drive_id", "ego_id", "t_ns")),
    }
    for name, query in queries.items():
        where = f"{file}:{sections[name].line}: @{name}"
        if name != "reference":
            yield from _column_problems(query.columns, *contracts[name], where)
        elif query.columns is not None and ("ref_id" in query.columns or not set(_KEY_COLUMNS) <= set(query.columns)):
            yield (f"{where} must return drive_id, ego_id, t_ns and no ref_id (the engine numbers it)")
    yield from _condition_problems(header, queries["condition"], f"{file}:{sections['condition'].line}: @condition")


def _column_problems(
    columns: tuple[str, ...] | None, required_columns: tuple[str, ...], allowed_columns: tuple[str, ...], where: str
) -> Iterator[str]:
    if columns is None:
        yield (f"{where} must name every column it returns: no star, and AS for every expression")
        return
    if len(set(columns)) != len(columns):
        yield (f"{where} returns a column twice: {', '.join(columns)}")
    if missing := [c for c in required_columns if c not in columns]:
        yield (f"{where} must return {', '.join(required_columns)}; {', '.join(missing)} missing")
    if stray := [c for c in columns if c not in allowed_columns]:
        yield (f"{where} returns the unknown column {stray[0]!r}; {hint(stray[0], allowed_columns)}")


def _condition_problems(header: Header, query: SelectParts, where: str) -> Iterator[str]:
    """Yield contradictions between condition and header: sense, reference, and `combine`."""
    columns = query.columns or ()
    wrong = {"observed", "required", "at_least", "error"} if header.sense == "holds" else {"holds"}
    if found := sorted(wrong & set(columns)):
        yield (f"{where}: column {found[0]!r} does not go with sense = {header.sense!r}")
    if ("ref_id" in columns) != bool(ENGINE_TABLES & query.tables):
        yield (f"{where}: a condition that reads reference or reference_step returns ref_id, and no other does")
    if header.combine != "each" and "object_id" not in columns:
        yield (f"{where}: combine = {header.combine!r} needs the column object_id")


def _reads_problems(header: Header, queries: dict[str, SelectParts], place_of_reads: str) -> Iterator[str]:
    """Yield differences between the header's `place_of_reads` and the tables that the SQL reads. `place_of_reads`: `file:line` of that
    key."""
    given = {"condition": ENGINE_TABLES, "anchor": frozenset({"reference"})} if header.kind != "invariant" else {}
    for name, query in queries.items():
        if early := sorted(query.tables & ENGINE_TABLES - given.get(name, frozenset())):
            yield (f"{query.places[early[0]]}: @{name} has no table {early[0]!r} in a rule of kind {header.kind}")
    said = frozenset(header.reads)
    for query in queries.values():
        if undeclared := sorted(query.tables - ENGINE_TABLES - said):
            yield (f"{query.places[undeclared[0]]}: reads does not match the SQL: add {', '.join(undeclared)} to reads")
    if idle := sorted(said.difference(*(query.tables for query in queries.values()))):
        yield (f"{place_of_reads}: reads does not match the SQL: remove {', '.join(idle)}")


def _param_problems(header: Header, queries: dict[str, SelectParts], file: Path, toml: str) -> Iterator[str]:
    for query in queries.values():
        if strange := sorted(query.parameters - header.params.keys()):
            name = strange[0]
            near = nearest_word(name, header.params)
            yield (
                f"{query.places[f'${name}']}: ${name} is not a parameter of this rule; "
                f"{f'did you mean ${near}? If not, ' if near else ''}add [params.{name}] to the header, with default, unit, why and source"
            )
    used = frozenset[str]().union(*(query.parameters for query in queries.values()))
    used |= {s for s in (header.window_s, header.exempt_after_s, header.merge_gap_s) if isinstance(s, str)}
    if unused := sorted(header.params.keys() - used):
        yield (
            f"{file}:{line_of_key(toml, f'params.{unused[0]}')}: parameter {unused[0]!r} is never used: bind it as ${unused[0]}"
        )


def _refuse_wrong_words(header: Header, sections: dict[str, Section], file: Path, toml: str) -> None:
    def place(part: str, offset: int) -> str:
        if part not in sections:
            return f"{file}:{line_of_key(toml, part)}"
        before = sections[part].sql.encode()[:offset]
        return f"{file}:{sections[part].sql_line + before.count(10)}"

    refuse_wrong_words({name: section.sql for name, section in sections.items()}, header.params, place)


def _reason_problems(header: Header, queries: dict[str, SelectParts], file: Path, toml: str) -> Iterator[str]:
    """Yield the problems of reason codes: codes without a text, texts without their arguments, and unused codes."""
    known = {**texts_of_shared_codes(), **header.reasons}
    given = [reason for query in queries.values() for reason in query.reasons]
    for code, arguments, place in given:
        if code not in known:
            yield (f"{place}: why({code!r}) has no words: add [reasons.{code}] to the header; {hint(code, known)}")
            continue
        if arguments is not None and (absent := sorted(known[code].required_arguments - arguments)):
            yield (f"{place}: the words of {code!r} need the argument {absent[0]!r}: add it to why({code!r}, {{...}})")
    if unused := sorted(header.reasons.keys() - {reason.code for reason in given}):
        line = line_of_key(toml, f"reasons.{unused[0]}")
        yield (f"{file}:{line}: the reason {unused[0]!r} is never used: use it in why({unused[0]!r}), or remove it")
