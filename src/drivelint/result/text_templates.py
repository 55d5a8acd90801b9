"""Loads the Jinja templates for plain text, which are beside the modules that use them.

Their filters include functions of `drivelint.result.text`.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from drivelint.phrases import plural
from drivelint.result.text import ego_and_object_names, ego_name, number, rule_name, seconds, with_count

if TYPE_CHECKING:
    from collections.abc import Callable

    from jinja2 import Template


def text_template(
    module_file: str, name: str, finalize: Callable[[Any], Any] | None = None, **filters: Callable[..., Any]
) -> Template:
    """Return the template `name` beside a module, with additional `filters`; values are not escaped.

    `module_file`: the module's `__file__`. `finalize`: a function applied to each value that is filled in.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # imported here, since most runs use no template

    environment = Environment(  # noqa: S701 - no HTML
        loader=FileSystemLoader(Path(module_file).parent),
        finalize=finalize,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters |= _FILTERS | filters
    return environment.get_template(name)


def cell(value: Any) -> Any:
    """Return a text on one line, escaped for a cell of a Markdown table; other values are returned unchanged."""
    return value.replace("|", "\\|").replace("\n", " ") if isinstance(value, str) else value


_FILTERS: Final[dict[str, Callable[..., Any]]] = {
    function.__name__: function
    for function in (cell, ego_name, number, plural, rule_name, seconds, ego_and_object_names, with_count)
}
