"""Makes the command line from the declared options, and has those that only commands share."""

from __future__ import annotations

from functools import cached_property
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

import typer

from drivelint.cli import completion
from drivelint.options.arguments import CheckCommandArguments
from drivelint.options.declaration import Arguments, DeclaredOption, declared_options
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
    option = declared.option
    if declared.is_positional:
        return argument(option.metavar or "", option.help)
    return typer.Option(
        *declared.flags,
        metavar=option.metavar,
        help=option.help,
        min=option.minimum,
        max=option.maximum,
        envvar=option.environment_variable,
        autocompletion=completion.rule_ids if option.selects_rules else None,
    )


_OPTIONS_OF_CHECK: Final = {option.name: option for option in declared_options(CheckCommandArguments)}


def _option_of_check(name: str) -> Any:
    return declared_info(_OPTIONS_OF_CHECK[name])


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


class DeclaredCommand:
    """A command in which each parameter that is a class of arguments is replaced by the options that the class declares.

    Typer gets a parameter per option, with the name of the engine's field. They are made when Typer asks for them, only for the command
    that runs.
    """

    def __init__(self, command: Callable[..., None]) -> None:
        self._command = command
        self.__name__, self.__module__, self.__doc__ = command.__name__, command.__module__, command.__doc__

    @cached_property
    def _parameters_of_command(self) -> dict[str, Parameter]:
        return dict(signature(self._command, eval_str=True).parameters)

    @property
    def _groups(self) -> dict[str, type[Arguments]]:
        kinds = {name: parameter.annotation for name, parameter in self._parameters_of_command.items()}
        return {name: kind for name, kind in kinds.items() if isinstance(kind, type) and issubclass(kind, Arguments)}

    @property
    def __signature__(self) -> Signature:
        """Return the signature that Typer reads."""
        parameters: list[Parameter] = []
        for name, parameter in self._parameters_of_command.items():
            if name not in self._groups:
                parameters.append(parameter.replace(kind=Parameter.KEYWORD_ONLY))
                continue
            parameters += [
                Parameter(
                    declared.field,
                    Parameter.KEYWORD_ONLY,
                    default=declared.default,
                    annotation=Annotated[declared.type.command_line_type, declared_info(declared)],
                )
                for declared in declared_options(self._groups[name])
            ]
        return Signature(parameters)

    @property
    def __annotations__(self) -> dict[str, Any]:  # type: ignore[override]
        """Return the types that Typer reads."""
        return {name: parameter.annotation for name, parameter in self.__signature__.parameters.items()}

    def __call__(self, **values: Any) -> None:
        """Run the command with the values of its options."""
        for name, group in self._groups.items():
            values[name] = group(**{declared.name: values.pop(declared.field) for declared in declared_options(group)})
        self._command(**values)
