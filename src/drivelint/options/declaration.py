"""Declares an option: the class `Option` stands in the annotation of a dataclass field, or of a command's parameter.

    class DriveArguments:
        map_dir: Annotated[AnyPath | None, Option("Folder of maps.", "DIR")] = None

is `--map-dir DIR` on the command line, the keyword `map_dir` in Python, and the key `map-dir` in `drivelint.toml`.
"""

from __future__ import annotations

from dataclasses import MISSING, Field, dataclass, fields
from functools import cache
from inspect import Parameter, Signature
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, TypeVar, get_args, get_origin

from drivelint.options.types import OPTION_TYPES, OptionType, require_one_of

if TYPE_CHECKING:
    from collections.abc import Callable

_OptionsOfEngine = TypeVar("_OptionsOfEngine")


@dataclass(frozen=True, repr=False, eq=False)
class Option:
    """What an option's annotation says besides its type: the help, and how the option differs from its name in Python.

    `metavar`: the name of the value in the help. `flag`: the spelling on the command line. `minimum`, `maximum`: bounds of a number.
    `field`: the name of the engine's field. `parse`: reads the value, after the conversion by its type. `type`: if not that which
    `OPTION_TYPES` has for the annotation. `selects_rules`: the shell completes ids of rules. `environment_variable`: sets the option, too.
    `place_after`: the option of this name comes before this one in the help; empty: the options of the base classes do.
    """

    help: str
    metavar: str | None = None
    flag: str | None = None
    minimum: float | None = None
    maximum: float | None = None
    field: str | None = None
    parse: Callable[[Any], Any] | None = None
    type: OptionType | None = None
    selects_rules: bool = False
    environment_variable: str | None = None
    place_after: str = ""


class DeclaredOption(NamedTuple):
    """An option of a class of arguments: its name in Python, its type, and its declaration."""

    name: str
    type: OptionType
    default: Any
    is_positional: bool
    option: Option

    @property
    def field(self) -> str:
        """Return the name of the engine's field; the command line has a parameter of this name."""
        return self.option.field or self.name

    @property
    def flags(self) -> list[str]:
        """Return the spellings on the command line."""
        return (self.option.flag or f"--{self.name.replace('_', '-')}").split()

    def engine_value(self, value: Any) -> Any:
        """Return an argument as a value for the engine. Errors: `UsageError`."""
        if get_origin(self.type.command_line_type) is Literal:
            return require_one_of(self.name, value, self.type.command_line_type)
        converted = self.type.convert(value)
        return converted if self.option.parse is None else self.option.parse(converted)

    @classmethod
    def from_field(cls, field: Field[Any]) -> DeclaredOption | None:
        """Return the option that a field declares; None: it has no `Option`."""
        if get_origin(field.type) is not Annotated:
            return None
        kind, option = get_args(field.type)
        return cls(field.name, option.type or OPTION_TYPES[kind], _default(field), not field.kw_only, option)


def _default(field: Field[Any]) -> Any:
    return Parameter.empty if field.default is MISSING else field.default


@cache
def declared_options(arguments: type) -> tuple[DeclaredOption, ...]:
    """Return the options that a class of arguments declares, the positional ones first."""
    options: list[DeclaredOption] = []
    for each in fields(arguments):
        if (declared := DeclaredOption.from_field(each)) is not None:
            names = [option.name for option in options]
            place = declared.option.place_after
            options.insert(names.index(place) + 1 if place else len(options), declared)
    return tuple(sorted(options, key=lambda each: not each.is_positional))


def python_signature(arguments: type, returns: Any) -> Signature:
    """Return the signature of a function in Python that takes these arguments, with the names of their types as texts."""
    names = {each.name: each.type.name for each in declared_options(arguments)}
    parameters = [
        Parameter(
            each.name,
            Parameter.KEYWORD_ONLY if each.kw_only else Parameter.POSITIONAL_OR_KEYWORD,
            default=_default(each),
            annotation=names.get(each.name) or OPTION_TYPES[each.type].name,
        )
        for each in fields(arguments)
    ]
    return Signature(sorted(parameters, key=lambda each: each.kind), return_annotation=returns)


def engine_values(arguments: Any, group: type | None = None) -> dict[str, Any]:
    """Return field of the engine -> value, for all options of the arguments, or for those that the class `group` declares.

    Errors: `UsageError` for an invalid value.
    """
    return {
        each.field: each.engine_value(getattr(arguments, each.name))
        for each in declared_options(group or type(arguments))
    }


def options_of_engine(
    kind: Callable[..., _OptionsOfEngine], values: dict[str, Any], **replacements: Any
) -> _OptionsOfEngine:
    """Return an instance of the dataclass `kind` with those of the values that it has fields for, and with the replacements."""
    names = {each.name for each in fields(kind)}  # type: ignore[arg-type]
    return kind(**{name: value for name, value in values.items() if name in names} | replacements)
