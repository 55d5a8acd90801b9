"""Finds and loads rule files: `<pack>/<rule>.sql` is the rule `<pack>.<rule>`. Rules that were read and checked are cached."""

from __future__ import annotations

from functools import cache, lru_cache
from typing import TYPE_CHECKING, Final

import msgspec

from drivelint.catalogue.rule import Rule
from drivelint.errors import RuleError
from drivelint.memo import Memo
from drivelint.resources import folder

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path


class _PackFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    title: str


def load_rules(dirs: Sequence[Path] = ()) -> dict[str, Rule]:
    """Return id -> rule, sorted, for all rules of the shipped packs and of the packs in `dirs`.

    Errors: `RuleError` with file and line, also for two rules with the same id and for a folder without rules.
    """
    rules: dict[str, Rule] = {}
    for file, is_shipped in _all_rule_files(dirs):
        rule = read_rule(file, check_words=not is_shipped)
        if rule.id in rules:
            raise RuleError(
                f"{file}: rule {rule.id} exists already in {rules[rule.id].path}; give this one another name or pack"
            )
        rules[rule.id] = rule
    return dict(sorted(rules.items()))


def load_rule(rule_id: str, dirs: Sequence[Path] = ()) -> Rule | None:
    """Return the rule with this id from the shipped packs or `dirs`, without reading other rules; None for an unknown id.

    Errors: `RuleError` with file and line, also for a folder without rules.
    """
    files = ((file, is_shipped) for file, is_shipped in _all_rule_files(dirs) if rule_id_of(file) == rule_id)
    return next((read_rule(file, check_words=not is_shipped) for file, is_shipped in files), None)


def _all_rule_files(dirs: Sequence[Path]) -> Iterator[tuple[Path, bool]]:
    """Yield each rule file, and whether it is shipped with drivelint."""
    for n, root in enumerate((folder("queries") / "assertions", *dirs)):
        yield from ((file, n == 0) for file in rule_files(root))


def rule_files(root: Path) -> list[Path]:
    """Return the rule files of a folder that contains packs (`<pack>/<rule>.sql`) or is a pack (`<rule>.sql`).

    Errors: `RuleError` for a folder without rules.
    """
    files = sorted(root.glob("*.sql")) + sorted(root.glob("*/*.sql"))
    if not files:
        raise RuleError(f"{root}: no rules here; a folder of rules holds packs, <pack>/<rule>.sql, or is one")
    return files


def rule_id_of(file: Path) -> str:
    """Return the id of the rule in a file: `<pack>.<rule>`."""
    return f"{_pack_folder(file).name}.{file.stem}"


def _pack_folder(file: Path) -> Path:
    """Return the folder of a rule file; for a symbolic link, the folder of its target."""
    return file.resolve().parent if file.is_symlink() else _resolve_folder(file.parent)


@cache
def _resolve_folder(path: Path) -> Path:
    return path.resolve()


def read_rule(file: Path, *, check_words: bool = True) -> Rule:
    """Read and check one rule file, and return the rule. Errors: `RuleError` with file and line.

    `check_words`: also check the words in its SQL, see `rule_words`. Only the tests do this for shipped rules, since it needs a third of
    the time for reading them.
    """
    pack = _pack_folder(file)
    if not file.is_file():
        raise RuleError(f"{file}: a rule must be a file, but this is not one")
    return _cached_rule(file, pack.name, _pack_title(pack), file.read_bytes(), check_words=check_words)


_RULE_MEMO: Final = Memo[Rule]("rules", Rule)
"""Cached rules, by file and content: reading and checking all rules takes longer than judging by one rule."""


@lru_cache(maxsize=1024)  # a process may load the same rules many times, and they seldom change
def _cached_rule(file: Path, pack: str, pack_title: str, content: bytes, *, check_words: bool) -> Rule:
    def parse_rule() -> Rule:
        from drivelint.catalogue.rule_file import checked_rule  # imported here, since it imports the SQL parser

        return checked_rule(file, pack, pack_title, content, check_words=check_words)

    return _RULE_MEMO.find_or_compute(
        "\0".join([str(file), pack, pack_title, str(check_words), content.decode("latin-1")]), parse_rule
    )


@cache
def _pack_title(folder_: Path) -> str:
    """Return the title of a pack from its `pack.toml`; '' without this file. Errors: `RuleError` for an invalid file."""
    file = folder_ / "pack.toml"
    if not file.is_file():
        return ""
    try:
        return msgspec.toml.decode(file.read_bytes(), type=_PackFile).title
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise RuleError(f'{file}: {error}: write title = "...", the subject of the pack') from error
