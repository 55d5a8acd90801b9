"""The templates of the pages, with their style and script. A page's content security policy names both by their hashes."""

from __future__ import annotations

import base64
import hashlib
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import duckdb
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from drivelint import __version__
from drivelint.phrases import escape_invisible
from drivelint.report.html.anchors import anchor
from drivelint.result.compiled_templates import CompiledTemplates
from drivelint.result.schemas import OUTPUT_VERSION
from drivelint.result.text import breach_title, ego_name, measure, number

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

TEMPLATES_FOLDER: Final = Path(__file__).parent / "templates"
_MPS2_PATTERN: Final = re.compile(r"(?:(?<=\d[ \u00a0])|(?<= in )|^)m/s2\b")
PICTURE_STYLE_FILE: Final = "pictures.css"
"""The style of pictures from cameras; only pages with such pictures contain it."""
_STYLE_FILES: Final = ("report.css", "charts.css", "narrow.css", "first.css")


def page_environment(
    scripts: Sequence[str],
    folder: Path | None = None,
    styles: Sequence[str] = (),
    *,
    base_styles: Sequence[str] = _STYLE_FILES,
) -> Environment:
    """Return the template environment of a page: the report's templates, and the templates in `folder`, which take precedence.

    `scripts`: scripts from the report's templates. `base_styles`: the report's styles for the page; the `styles` of `folder` follow them.
    """
    environment = Environment(
        finalize=escape_for_page,
        bytecode_cache=CompiledTemplates("page"),
        loader=FileSystemLoader([*([folder] if folder else []), TEMPLATES_FOLDER]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    style = _concatenated_texts(
        [*(TEMPLATES_FOLDER / name for name in base_styles), *((folder or TEMPLATES_FOLDER) / name for name in styles)]
    )
    script = _concatenated_texts(TEMPLATES_FOLDER / name for name in scripts)
    more = _concatenated_texts([TEMPLATES_FOLDER / PICTURE_STYLE_FILE])
    environment.globals.update(
        style=Markup(style),  # noqa: S704 - ours
        script=Markup(script),  # noqa: S704 - ours
        picture_style=Markup(more),  # noqa: S704 - ours
        policy=_content_security_policy(_csp_hash(style), _csp_hash(script)),
        picture_policy=_content_security_policy(f"{_csp_hash(style)} {_csp_hash(more)}", _csp_hash(script)),
        anchor=anchor,
        number=number,
        version=__version__,
        duckdb_version=duckdb.__version__,
        output_schema=OUTPUT_VERSION,
    )
    environment.filters |= {"ego_name": ego_name, "measure": measure, "breach_title": breach_title}
    return environment


def _content_security_policy(styles: str, script: str) -> str:
    return (
        f"default-src 'none'; style-src {styles}; script-src {script}; img-src data:; "
        "base-uri 'none'; form-action 'none'"
    )


def escape_for_page(value: Any) -> Any:
    """Return a template's value; in a text, invisible characters, such as those that reverse the reading order, are escaped.

    The unit m/s2, alone or after a number, becomes m/s².
    """
    return _MPS2_PATTERN.sub("m/s\u00b2", escape_invisible(value)) if type(value) is str else value  # Markup is safe


def _concatenated_texts(files: Iterable[Path]) -> str:
    return "\n".join(file.read_text(encoding="utf-8").strip() for file in files)


def _csp_hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
