"""The site of `drivelint docs --html`: the guides, the rule catalogue, the data dictionary and the command line."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint import __version__, guide
from drivelint.errors import UsageError
from drivelint.guide import dictionary, html, search
from drivelint.result.publishing import publish
from drivelint.result.text_templates import text_template

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

SITE_PICTURE_FILES: Final = ("log.svg",)
"""Picture files of the guides."""
REFERENCE_PAGES: Final = {
    "catalogue": (
        "The rule catalogue",
        "Every rule with its numbers and sources, and every clause with what covers it.",
    ),
    "dictionary": ("The data dictionary", "Every table with its columns, and how the derived tables are derived."),
    "reasons": (
        "Reason codes",
        "Every cause of an unknown verdict and every reason, with its sentence and the advice.",
    ),
    "macros": ("Macros", "What the SQL of a rule can call."),
    "commands": ("The command line", "Every command with its arguments and options."),
}
"""Page -> its title and a sentence about its content."""


class Command(NamedTuple):
    """One command: its usage, its description, and (name, meaning) of its arguments and options."""

    usage: str
    about: str
    arguments: tuple[tuple[str, str], ...]
    options: tuple[tuple[str, str], ...]

    @property
    def name(self) -> str:
        """The words before the arguments, such as `drivelint rules list`."""
        return self.usage.partition(" [")[0].partition(" {")[0]


def write(folder: Path, commands: Iterable[Command]) -> Path:
    """Write the site into `folder` and return its first page. Errors: `UsageError` if `folder` is a file; `OutputError`."""
    if folder.exists() and not folder.is_dir():
        raise UsageError(f"--html {folder}: is a file: give a folder for the pages")
    publish(folder, site_files(commands), {})
    return folder / "index.html"


def site_files(commands: Iterable[Command]) -> dict[str, bytes]:
    """Return file name -> bytes for every file of the site; one version of drivelint always gives the same bytes."""
    pages = {name: guide.text(name) for name in (*guide.TOPICS, "catalogue", "reasons", "macros")}
    pages["dictionary"] = dictionary.page()
    pages["commands"] = text_template(__file__, "commands.md.j2", shown=_help_as_markdown).render(commands=commands)
    index = text_template(__file__, "index.md.j2")
    pages["index"] = index.render(topics=guide.topics(), reference=REFERENCE_PAGES)
    navigation = [
        ("Guides", [(topic.name, topic.title) for topic in guide.topics()]),
        ("Reference", [(name, title) for name, (title, _) in REFERENCE_PAGES.items()]),
    ]
    footer = f"drivelint {__version__}"
    parsed = {name: html.parse(text) for name, text in pages.items()}
    files = {
        f"{name}.html": html.page(tokens, name=name, pages=navigation, footer=footer).encode()
        for name, tokens in parsed.items()
    }
    files |= {
        name: (guide.FOLDER / name).read_bytes() for name in (html.STYLESHEET, search.SCRIPT_FILE, *SITE_PICTURE_FILES)
    }
    files[search.INDEX_FILE] = search.index_script(parsed)
    return files


def _help_as_markdown(text: str) -> str:
    """Return help text as Markdown, with its options as code."""
    return re.sub(r"(?<![\w-])(--[a-z][\w-]*)", r"`\1`", dictionary.escape_markdown(text))
