"""Makes the command line from the declared options, and has those that only commands share."""

from __future__ import annotations

from dataclasses import is_dataclass
from functools import wraps
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from drivelint.cli import completion
from drivelint.options.arguments import CheckCommandArguments
from drivelint.options.declaration import DeclaredOption, declared_options
from drivelint.options.types import Format

if TYPE_CHECKING:
    from collections.abc import Callable


ConvertTarget = Literal["mcap", "parquet"]
SqlFormat = Literal["text", "csv", "json"]
DiffFormat = Literal["text", "json", "markdown"]
RuleKind = Literal["invariant", "execution", "precondition", "postcondition"]
Texts = list[str] | None
"""The value of an option that may be repeated."""


def argument(metavar: str, help_text: str, **settings: Any) -> Any:
    """Return an argument of a command with its help."""
    return typer.Argument(metavar=metavar, help=help_text, **settings)


def option(flag: str, metavar: str | None, help_text: str, **settings: Any) -> Any:
    """Return an option of a command with its help."""
    return typer.Option(flag, metavar=metavar, help=help_text, **settings)


def declared_info(declared: DeclaredOption) -> Any:
    """Return the argument or option of Typer for a declared option."""
    said = declared.option
    if declared.is_positional:
        return argument(said.metavar or "", said.help)
    return typer.Option(
        *declared.flags,
        metavar=said.metavar,
        help=said.help,
        min=said.minimum,
        max=said.maximum,
        envvar=said.environment_variable,
        autocompletion=completion.rule_ids if said.selects_rules else None,
    )


def _option_of_check(name: str) -> Any:
    return next(declared_info(each) for each in declared_options(CheckCommandArguments) if each.name == name)


MinJudged = Annotated[float | None, _option_of_check("min_judged")]
Waivers = Annotated[Path | None, _option_of_check("waivers")]
Today = Annotated[str | None, _option_of_check("today")]
MemorySize = Annotated[str | None, _option_of_check("memory")]
Overwrite = Annotated[bool, _option_of_check("overwrite")]
Evidence = Annotated[Path | None, _option_of_check("evidence")]
Sign = Annotated[Path | None, _option_of_check("sign")]
RulesDirs = Annotated[list[Path] | None, _option_of_check("rules_dir")]
Quiet = Annotated[bool, _option_of_check("quiet")]
FormatOption = Annotated[Format, _option_of_check("format_")]


def with_declared_options(command: Callable[..., None]) -> Callable[..., None]:
    """Replace each parameter of a command that is a class of arguments by the options that the class declares.

    Typer gets a parameter per option, with the name of the engine's field.
    """
    groups: dict[str, Any] = {}
    parameters: list[Parameter] = []
    for each in signature(command, eval_str=True).parameters.values():
        if is_dataclass(each.annotation):
            groups[each.name] = each.annotation
            parameters += [
                Parameter(
                    declared.field,
                    Parameter.KEYWORD_ONLY,
                    default=declared.default,
                    annotation=Annotated[declared.type.command_line_type, declared_info(declared)],
                )
                for declared in declared_options(groups[each.name])
            ]
        else:
            parameters.append(each.replace(kind=Parameter.KEYWORD_ONLY))

    @wraps(command)
    def command_with_options(**values: Any) -> None:
        for name, group in groups.items():
            values[name] = group(**{each.name: values.pop(each.field) for each in declared_options(group)})
        command(**values)

    command_with_options.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
    command_with_options.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return command_with_options
