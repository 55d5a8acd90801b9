"""`drivelint docs`: prints the guides and the reference, or writes them as a site."""

from __future__ import annotations

import json
from pathlib import Path  # noqa: TC003 - Typer looks the annotations up
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from drivelint.cli.options import argument, option
from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.guide.site import Command

SETTINGS_SCHEMA_TOPIC: Final = "settings-schema"
"""The topic that prints the JSON schema of `drivelint.toml`."""

HEADER_SCHEMA_TOPIC: Final = "header-schema"
"""The topic that prints the JSON schema of a rule's header."""


def docs(
    ctx: typer.Context,
    topic: Annotated[
        str | None,
        argument(
            "[TOPIC]", "The guide to print, or dictionary, catalogue, reasons or macros. Default: list the guides."
        ),
    ] = None,
    table: Annotated[str | None, argument("[TABLE]", "With dictionary: the table to print; default: all.")] = None,
    *,
    html: Annotated[
        Path | None, option("--html", "DIR", "Write all guides, the rules, the tables and the commands as a site.")
    ] = None,
) -> None:
    """Print a guide, or write all of them as a site.

    Without TOPIC: lists the guides. With TOPIC: prints that guide as Markdown.

    docs dictionary [TABLE] prints the tables that rules read, with the meaning of each column. docs catalogue prints the
    shipped rules as Markdown; docs reasons prints every reason code with its words; docs macros prints the macros that rules
    can call; docs settings-schema prints the JSON schema of drivelint.toml, for editors; docs
    header-schema prints that of a rule's header.

    With --html: writes one offline site with the guides, the rule catalogue, the data dictionary and the command line, and
    prints the name of its first page.
    """
    from drivelint import guide

    if html is not None:
        if topic is not None:
            raise UsageError(f"docs {topic} --html: --html writes all guides: leave out {topic} or --html")
        from drivelint.guide import site

        typer.echo(str(site.write(html, _commands(ctx.find_root().command, "drivelint"))))
    elif topic is None:
        typer.echo(guide.topic_listing())
        typer.echo(
            "drivelint docs TOPIC prints one; drivelint docs dictionary [TABLE] the tables, catalogue the rules, reasons the reason codes, "
            "macros the macros; "
            "drivelint docs --html DIR writes all as a site",
            err=True,
        )
    elif topic == SETTINGS_SCHEMA_TOPIC:
        from drivelint.options.settings_file import settings_schema

        typer.echo(settings_schema(), nl=False)
    elif topic == HEADER_SCHEMA_TOPIC:
        from drivelint.catalogue import json_schema

        typer.echo(json.dumps(json_schema(), indent=2))
    else:
        typer.echo(guide.text(topic, table), nl=False)


def _commands(command: Any, name: str) -> Iterator[Command]:
    """Yield the command, or all commands below a group, with the texts of their help, depth first."""
    from drivelint.guide.site import Command

    if hasattr(command, "commands"):
        for word, subcommand in command.commands.items():
            yield from _commands(subcommand, f"{name} {word}")
        return
    about = typer.Context(command, info_name=name)
    texts_by_kind: dict[str, list[tuple[str, str]]] = {"argument": [], "option": []}
    for param in command.get_params(about):
        if (record := param.get_help_record(about)) is not None:
            words, meaning = record
            # remove the Python type
            texts_by_kind[param.param_type_name].append((words.partition(" <")[0], meaning))
    usage = " ".join([name, *command.collect_usage_pieces(about)])
    yield Command(usage, command.help or "", tuple(texts_by_kind["argument"]), tuple(texts_by_kind["option"]))
