"""The reference that `drivelint docs` prints beside the guides: the data dictionary as text and the catalogue as Markdown."""

from __future__ import annotations

from drivelint import catalogue
from drivelint.errors import UsageError
from drivelint.guide import dictionary
from drivelint.phrases import hint
from drivelint.report import catalogue_page
from drivelint.resources import folder
from drivelint.sql.store import schema


def rules() -> str:
    """Return the catalogue of the shipped rules as Markdown."""
    return catalogue_page.page(catalogue.load(()).values(), folder("queries") / "assertions")


def tables(name: str | None) -> str:
    """Return the data dictionary as text, or one table of it. Errors: `UsageError` with the nearest table."""
    if name is None:
        return dictionary.text()
    if name not in schema():
        near = hint(name, schema())
        said = "drivelint docs dictionary prints all" if near.startswith("known") else near
        raise UsageError(f"docs dictionary {name}: no table {name!r}: {said}")
    return dictionary.section_text(name)
