"""The site of `drivelint docs --html`: the guides, the rule catalogue, the data dictionary and the command line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint import __version__, guide
from drivelint.errors import UsageError
from drivelint.guide import command_page, dictionary, html
from drivelint.report.catalogue_page import table
from drivelint.result.files import publish

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from drivelint.guide.command_page import Command

PICTURES: Final = ("log.svg",)
"""The pictures of the guides."""
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
"""Page -> its title and what it has."""


def write(folder: Path, commands: Iterable[Command]) -> Path:
    """Write the site into `folder`; return its first page. Errors: `UsageError` where `folder` is a file, `OutputError`."""
    if folder.exists() and not folder.is_dir():
        raise UsageError(f"--html {folder}: is a file: give a folder for the pages")
    publish(folder, contents(commands), {})
    return folder / "index.html"


def contents(commands: Iterable[Command]) -> dict[str, bytes]:
    """Return every file of the site, name -> bytes: the same for the same version."""
    pages = {name: guide.text(name) for name in (*guide.TOPICS, "catalogue", "reasons", "macros")}
    pages["dictionary"] = dictionary.page()
    pages["commands"] = command_page.page(commands)
    pages["index"] = _index()
    navigation = [
        ("Guides", [(topic.name, topic.title) for topic in guide.topics()]),
        ("Reference", [(name, title) for name, (title, _) in REFERENCE_PAGES.items()]),
    ]
    footer = f"drivelint {__version__}"
    files = {
        f"{name}.html": html.page(text, name=name, pages=navigation, footer=footer).encode()
        for name, text in pages.items()
    }
    files |= {name: (guide.FOLDER / name).read_bytes() for name in (html.STYLESHEET, *PICTURES)}
    return files


def _index() -> str:
    guides = [(f"[{topic.title}]({topic.name}.md)", topic.sentence) for topic in guide.topics()]
    others = [(f"[{title}]({name}.md)", has) for name, (title, has) in REFERENCE_PAGES.items()]
    return (
        "# drivelint\n\ndrivelint checks recorded drives against the rules of the road. Give it a log and a map; it says *pass*, *fail* or "
        "*unknown* for every rule, with the evidence.\n\n"
        f"## Guides\n\n{table(('guide', 'what it is for'), guides)}\n"
        f"## Reference\n\n{table(('page', 'what it has'), others)}"
    )
