"""The guides that `drivelint docs` prints and `drivelint docs --html` writes as a site: one Markdown file per topic in this folder."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

from drivelint.errors import UsageError
from drivelint.phrases import hint

TOPICS: Final = (
    "traces", "damaged-logs", "argoverse", "123d", "scenarionet", "mapping", "maps", "convert", "reading-an-unknown", "explain",
    "differences", "incident", "evidence-pack", "viewer", "pictures", "columns", "python", "ci", "ready-made", "second-run", "watching",
    "fleets", "fleet-machines", "fleet-results", "fleet-costs", "writing-a-rule", "scenes", "rule-durations", "rule-reference",
    "adding-a-format", "architecture",
)  # fmt: skip
"""The topics in reading order; each is the name of a Markdown file without its suffix."""
FOLDER: Final = Path(__file__).parent
REFERENCE_TOPICS: Final = ("dictionary", "catalogue", "reasons", "macros")
"""The topics of `drivelint docs` besides the guides: the tables, the rules, the reason codes and the macros."""
OUTPUT_TABLES_MARK: Final = "<!-- tables: output -->"
"""A line in a guide that is replaced by the columns of every output file."""
_MARK = re.compile(r"^<!-- .* -->\n", re.MULTILINE)


class Topic(NamedTuple):
    """A guide: its name, its title and its first sentence."""

    name: str
    title: str
    sentence: str


@cache
def topics() -> tuple[Topic, ...]:
    """Return every guide, in reading order."""
    heads = ((name, *_markdown_source(name).splitlines()[:3]) for name in TOPICS)
    return tuple(Topic(name, title.removeprefix("# "), sentence) for name, title, _, sentence in heads)


def text(name: str, table: str | None = None) -> str:
    """Return a guide or a reference topic as Markdown. `table`: one table of the topic `dictionary`.

    In a guide, the columns of the output files are filled in. Errors: `UsageError` with the nearest topic or table.
    """
    if name not in TOPICS + REFERENCE_TOPICS:
        raise UsageError(f"no guide {name!r}: {hint(name, TOPICS + REFERENCE_TOPICS)}")
    if table is not None and name != "dictionary":
        raise UsageError(f"docs {name} {table}: only the dictionary has tables: drivelint docs dictionary {table}")
    if name in REFERENCE_TOPICS:
        from drivelint.guide import dictionary

        return dictionary.REFERENCE_TEXTS[name]() if table is None else dictionary.table_text(table)
    source = _markdown_source(name)
    if OUTPUT_TABLES_MARK in source:
        from drivelint.guide.dictionary import output_tables_text

        source = source.replace(OUTPUT_TABLES_MARK, output_tables_text())
    return _MARK.sub("", source)


def topic_listing() -> str:
    """Return one line per guide: its name and its first sentence."""
    width = max(map(len, TOPICS))
    return "\n".join(f"{topic.name:<{width}}  {topic.sentence}" for topic in topics())


def _markdown_source(name: str) -> str:
    return (FOLDER / f"{name}.md").read_text(encoding="utf-8")
