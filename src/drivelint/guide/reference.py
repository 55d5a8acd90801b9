"""The reference that `drivelint docs` prints beside the guides: the data dictionary as text and the catalogue as Markdown."""

from __future__ import annotations

from drivelint import catalogue
from drivelint.errors import UsageError
from drivelint.guide import dictionary
from drivelint.phrases import hint
from drivelint.report import catalogue_page
from drivelint.resources import folder
from drivelint.sql.store import column_comments


def catalogue_markdown() -> str:
    """Return the catalogue of the shipped rules as Markdown."""
    return catalogue_page.page(catalogue.load_rules(()).values(), folder("queries") / "assertions")


def dictionary_text(name: str | None) -> str:
    """Return the data dictionary as text, or one table of it. Errors: `UsageError` with the nearest table."""
    if name is None:
        return dictionary.text()
    if name not in column_comments():
        near = hint(name, column_comments())
        said = "drivelint docs dictionary prints all" if near.startswith("known") else near
        raise UsageError(f"docs dictionary {name}: no table {name!r}: {said}")
    return dictionary.table_text(name)
