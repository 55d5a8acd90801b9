"""Reads one rule file and checks its header, its sections, and whether header and sections agree."""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from drivelint.catalogue import allowed_sql
from drivelint.catalogue.check import (
    ENGINE_TABLES,
    SelectParts,
    check_query,
    collect_problems,
    parameter_places,
    raise_problems,
)
from drivelint.catalogue.header import Header, line_of_key
from drivelint.catalogue.header_reader import KEYS_OF_KIND, ReadHeader, read_header
from drivelint.catalogue.rule import Rule
from drivelint.catalogue.rule_words import refuse_wrong_words
from drivelint.errors import RuleError
from drivelint.phrases import hint, nearest_word
from drivelint.reasons.reason_text import texts_of_shared_codes
from drivelint.sql import declarations

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
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
    for part, kind, pattern in ((pack, "folder", PACK_NAME), (file.stem, "file", RULE_NAME)):
        if not pattern.fullmatch(part):
            raise RuleError(
                f"{file}: the {kind} name {part!r} makes no rule id: "
                "lower-case letters, digits, '-', '_' (and '.' in the file name) only"
            )
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise RuleError(f"{file}: not UTF-8 at byte {error.start}") from error
    if hidden := _HIDDEN_CHARACTER.search(text):
        line = text.count("\n", 0, hidden.start()) + 1
        raise RuleError(f"{file}:{line}: the character U+{ord(hidden[0]):04X} hides what the rule does: remove it")
    problems: list[str] = []
    toml, sections = split_sections(text, str(file), problems)
    reading = read_header(toml, str(file))
    header = reading.header
    problems += reading.problems
    if header is not None and header.reference is not None:
        with collect_problems(problems):
            sections["reference"] = _event_table_section(
                header.reference, sections, file, line_of_key(toml, "reference")
            )
    queries: dict[str, SelectParts] = {}
    for name, section in sections.items():
        with collect_problems(problems):
            queries[name] = check_query(section.sql, str(file), section.sql_line)
    problems += _disagreements(reading, sections, queries, file, toml)
    if header is not None and check_words and queries.keys() == sections.keys():
        with collect_problems(problems):
            _refuse_wrong_words(header, sections, file, toml)
    if header is None or problems:
        raise_problems(in_order_of_lines(problems, file))
        raise AssertionError  # a header that cannot be read is a problem
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


def readable_sections(file: Path) -> tuple[dict[str, Section], dict[str, object]]:
    """Return the sections of a rule file that may be invalid, and the defaults of its parameters; both empty for an unreadable file."""
    text = file.read_text(encoding="utf-8", errors="replace")
    sections: dict[str, Section] = {}
    header = None
    with collect_problems([]):
        toml, sections = split_sections(text, str(file), [])
        header = read_header(toml, str(file)).header
        if header is not None and header.reference is not None:
            sections["reference"] = _event_table_section(
                header.reference, sections, file, line_of_key(toml, "reference")
            )
    return sections, {name: param.default for name, param in header.params.items()} if header else {}


def in_order_of_lines(problems: Sequence[str], file: Path) -> list[str]:
    """Return the problems `file:line: message` in the order of their lines."""

    def line(problem: str) -> int:
        match = re.match(r":(\d+):", problem.removeprefix(str(file)))
        return int(match[1]) if match else 0

    return sorted(problems, key=line)


def _disagreements(
    reading: ReadHeader, sections: dict[str, Section], queries: dict[str, SelectParts], file: Path, toml: str
) -> Iterator[str]:
    """Yield the problems between header and SQL, without those that a refused section or a doubtful key may only cause."""
    header, doubtful, is_complete = reading.header, reading.doubtful_keys, queries.keys() == sections.keys()
    if header is None:
        return
    if KEYS_OF_KIND.isdisjoint(doubtful):
        yield from _section_problems(header, sections, queries, file)
    if not {"reads", "kind"} & doubtful:
        yield from _reads_problems(header, queries, f"{file}:{line_of_key(toml, 'reads')}", is_complete=is_complete)
    if "params" not in doubtful:
        yield from _param_problems(header, sections, file, toml)
    if "reasons" not in doubtful and is_complete:
        yield from _reason_problems(header, queries, file, toml)


def _used_quantities(header: Header, queries: dict[str, SelectParts]) -> frozenset[str]:
    """Return the quantities of actors that a rule uses: existence, identity, and the quantities of the columns that it names."""
    declared = declarations.input_quantities_by_column()
    # an event table named in the header provides all its columns: only columns that other sections name count
    columns = {
        name
        for section, query in queries.items()
        if not (header.reference and section == "reference")
        for name in query.column_names
    }
    used = {"existence", "identity"} | ({"position"} if header.reference else set())
    for table in header.reads:
        used.update(*(quantities for column, quantities in declared.get(table, {}).items() if column in columns))
    return frozenset(used.difference(header.unaffected_by))


def split_sections(text: str, where: str, problems: list[str]) -> tuple[str, dict[str, Section]]:
    """Return the header's TOML (its line n is line n of the file), and name -> section; add to the problems of the file.

    Problems: an unknown, repeated, empty or missing section. A section with a misspelled name is taken for the one that is meant.
    Errors: `RuleError` for SQL before the first section.
    """
    lines = text.splitlines()
    marks = [(n, match[1]) for n, line in enumerate(lines) if (match := _SECTION_MARK.match(line))]
    header_end = marks[0][0] if marks else len(lines)
    header = [_uncomment(line, n, where) for n, line in enumerate(lines[:header_end], 1)]
    sections: dict[str, Section] = {}
    ends = [n for n, _ in marks[1:]] + [len(lines)]
    section_names = {name for _, name in marks}
    for (start, name_of_mark), end in zip(marks, ends, strict=False):
        name = name_of_mark
        if name not in SECTIONS:
            problems.append(f"{where}:{start + 1}: unknown section @{name}; {hint(name, SECTIONS, prefix='@')}")
            name = nearest_word(name, set(SECTIONS) - section_names) or name
        if name in sections:
            problems.append(f"{where}:{start + 1}: section @{name} stands twice")
            continue
        below = lines[start + 1 : end]
        body = "\n".join(below).strip()
        if not body:
            problems.append(f"{where}:{start + 1}: section @{name} is empty")
            section_names.add(name)
        elif name in SECTIONS:
            blank = next(n for n, line in enumerate(below) if line.strip())
            sections[name] = Section(body, start + 1, start + 2 + blank)
    if "condition" not in sections and "condition" not in section_names:
        problems.append(f"{where}:{len(lines)}: section '-- @condition' is missing")
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
    columns = declarations.column_comments().get(table, {})
    if not set(_KEY_COLUMNS) <= columns.keys():
        raise RuleError(
            f"{file}:{line}: reference = {table!r} is no event table: it needs the columns drive_id, ego_id, t_ns"
        )
    return Section(f"SELECT {', '.join(columns)} FROM {table}", line, line)


def _section_problems(
    header: Header, sections: dict[str, Section], queries: dict[str, SelectParts], file: Path
) -> Iterator[str]:
    """Yield the problems of missing or surplus sections, and of each section's columns."""
    is_needed_by_section = {"reference": header.kind != "invariant", "anchor": header.subtype == "physical"}
    for name, is_needed in is_needed_by_section.items():
        if is_needed != (name in sections):
            line = sections[name].line if name in sections else 1
            kind = " ".join(word for word in (header.subtype, header.kind) if word)
            yield (f"{file}:{line}: {kind}: {'needs a' if is_needed else 'has no'} section @{name}")
    if "applies" in sections and header.kind != "invariant":
        yield (
            f"{file}:{sections['applies'].line}: @applies is for invariants; "
            "return a column 'applies' from the condition instead"
        )
    value_columns = ("holds",) if header.sense == "holds" else ("observed", "required")
    contracts: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
        "condition": ((*_KEY_COLUMNS, *value_columns), _CONDITION_COLUMNS),
        "applies": (_KEY_COLUMNS, (*_KEY_COLUMNS, "object_id", "episode", "applies", "reason")),
        "anchor": (("ref_id", "t_ns"), ("ref_id", "drive_id", "ego_id", "t_ns")),
    }
    for name, query in queries.items():
        where = f"{file}:{sections[name].line}: @{name}"
        if name != "reference":
            yield from _column_problems(query, *contracts[name], where)
        elif query.columns is not None and ("ref_id" in query.columns or not set(_KEY_COLUMNS) <= set(query.columns)):
            yield (f"{where} must return drive_id, ego_id, t_ns and no ref_id (the engine numbers it)")
    if "condition" in queries:
        where = f"{file}:{sections['condition'].line}: @condition"
        yield from _condition_problems(header, queries["condition"], where)


def _column_problems(
    query: SelectParts, required_columns: tuple[str, ...], allowed_columns: tuple[str, ...], where: str
) -> Iterator[str]:
    columns, section = query.columns, where.rpartition(" ")[2]
    if columns is None:
        yield (f"{where} must name every column it returns: no star, and AS for every expression")
        return
    if len(set(columns)) != len(columns):
        yield (f"{where} returns a column twice: {', '.join(columns)}")
    stray = [c for c in columns if c not in allowed_columns]
    meant_columns = {nearest_word(c, allowed_columns) for c in stray}
    if missing_columns := [c for c in required_columns if c not in columns and c not in meant_columns]:
        yield (f"{where} must return {', '.join(required_columns)}; {', '.join(missing_columns)} missing")
    for c in stray:
        yield (f"{query.places[f'AS {c}']}: {section} returns the unknown column {c!r}; {hint(c, allowed_columns)}")


def _condition_problems(header: Header, query: SelectParts, where: str) -> Iterator[str]:
    """Yield contradictions between condition and header: sense, reference, and `combine`."""
    columns = query.columns or ()
    wrong = {"observed", "required", "at_least", "error"} if header.sense == "holds" else {"holds"}
    if wrong_columns := sorted(wrong & set(columns)):
        yield (f"{where}: column {wrong_columns[0]!r} does not go with sense = {header.sense!r}")
    if ("ref_id" in columns) != bool(ENGINE_TABLES & query.tables):
        yield (f"{where}: a condition that reads reference or reference_step returns ref_id, and no other does")
    if header.combine != "each" and "object_id" not in columns:
        yield (f"{where}: combine = {header.combine!r} needs the column object_id")


def _reads_problems(
    header: Header, queries: dict[str, SelectParts], place_of_reads: str, *, is_complete: bool
) -> Iterator[str]:
    """Yield differences between the header's `reads` and the tables that the SQL reads.

    `place_of_reads`: `file:line` of that key. `is_complete`: the tables of all sections are known.
    """
    tables_of_engine = (
        {"condition": ENGINE_TABLES, "anchor": frozenset({"reference"})} if header.kind != "invariant" else {}
    )
    for name, query in queries.items():
        if early := sorted(query.tables & ENGINE_TABLES - tables_of_engine.get(name, frozenset())):
            yield (f"{query.places[early[0]]}: @{name} has no table {early[0]!r} in a rule of kind {header.kind}")
    declared = frozenset(header.reads)
    unknown = sorted(declared - allowed_sql.tables())
    for name in unknown:
        yield (f"{place_of_reads}: reads: {allowed_sql.unknown_table_message(name)}")
    reported = {nearest_word(name, allowed_sql.tables()) for name in unknown}
    for query in queries.values():
        if undeclared := sorted(query.tables - ENGINE_TABLES - declared - reported):
            yield (f"{query.places[undeclared[0]]}: reads does not match the SQL: add {', '.join(undeclared)} to reads")
            reported.update(undeclared)
    idle = sorted(declared.difference(unknown, *(query.tables for query in queries.values())))
    if is_complete and idle:
        yield (f"{place_of_reads}: reads does not match the SQL: remove {', '.join(idle)}")


def _param_problems(header: Header, sections: dict[str, Section], file: Path, toml: str) -> Iterator[str]:
    by_section = [parameter_places(section.sql, str(file), section.sql_line) for section in sections.values()]
    places = {
        name: place for places_of_section in reversed(by_section) for name, place in (places_of_section or {}).items()
    }
    meant_names = set()
    for name in sorted(places.keys() - header.params.keys()):
        near = nearest_word(name, header.params)
        meant_names.add(near)
        yield (
            f"{places[name]}: ${name} is not a parameter of this rule; "
            f"{f'did you mean ${near}? If not, ' if near else ''}add [params.{name}] to the header, with default, unit, why and source"
        )
    times = (header.window_s, header.exempt_after_s, header.merge_gap_s)
    used = places.keys() | {s for s in times if isinstance(s, str)} | meant_names
    for name in sorted(header.params.keys() - used) if None not in by_section else ():
        line = line_of_key(toml, f"params.{name}")
        yield (f"{file}:{line}: parameter {name!r} is never used: bind it as ${name}")


def _refuse_wrong_words(header: Header, sections: dict[str, Section], file: Path, toml: str) -> None:
    def place(part: str, offset: int) -> str:
        if part not in sections:
            return f"{file}:{line_of_key(toml, part)}"
        before = sections[part].sql.encode()[:offset]
        return f"{file}:{sections[part].sql_line + before.count(10)}"

    refuse_wrong_words({name: section.sql for name, section in sections.items()}, header.params, place)


def _reason_problems(header: Header, queries: dict[str, SelectParts], file: Path, toml: str) -> Iterator[str]:
    """Yield the problems of reason codes: codes without a text, texts without their arguments, and unused codes."""
    texts = {**texts_of_shared_codes(), **header.reasons}
    reasons = [reason for query in queries.values() for reason in query.reasons]
    for code, arguments, place in reasons:
        if code not in texts:
            yield (f"{place}: why({code!r}) has no words: add [reasons.{code}] to the header; {hint(code, texts)}")
            continue
        if arguments is not None and (absent := sorted(texts[code].required_arguments - arguments)):
            yield (f"{place}: the words of {code!r} need the argument {absent[0]!r}: add it to why({code!r}, {{...}})")
    for code in sorted(header.reasons.keys() - {reason.code for reason in reasons}):
        line = line_of_key(toml, f"reasons.{code}")
        yield (f"{file}:{line}: the reason {code!r} is never used: use it in why({code!r}), or remove it")
