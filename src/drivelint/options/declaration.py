"""Declares an option: the class `Option` stands in the annotation of a dataclass field, or of a command's parameter.

    class DriveArguments:
        map_dir: Annotated[AnyPath | None, Option("Folder of maps.", "DIR")] = None

is `--map-dir DIR` on the command line, the keyword `map_dir` in Python, and the key `map-dir` in `drivelint.toml`.
"""

from __future__ import annotations

from dataclasses import MISSING, dataclass, fields
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
    `OPTION_TYPES` has for the annotation. `selects_rules`: the shell completes ids of rules.
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
    def flags(self) -> str:
        """Return the spelling on the command line."""
        return self.option.flag or f"--{self.name.replace('_', '-')}"

    def engine_value(self, value: Any) -> Any:
        """Return an argument as a value for the engine. Errors: `UsageError`."""
        if get_origin(self.type.command_line_type) is Literal:
            return require_one_of(self.name, value, self.type.command_line_type)
        converted = self.type.convert(value)
        return converted if self.option.parse is None else self.option.parse(converted)

    @classmethod
    def from_annotation(
        cls, name: str, annotation: Any, default: Any, *, is_positional: bool = False
    ) -> DeclaredOption | None:
        """Return the option that an annotation declares; None: it has no `Option`."""
        kind, *more = get_args(annotation) if get_origin(annotation) is Annotated else [annotation]
        for each in more:
            if isinstance(each, Option):
                return cls(name, each.type or OPTION_TYPES[kind], default, is_positional, each)
        return None


@cache
def declared_options(arguments: type) -> tuple[DeclaredOption, ...]:
    """Return the options that a class of arguments declares, the positional ones first."""
    options = [
        DeclaredOption.from_annotation(
            each.name,
            each.type,
            Parameter.empty if each.default is MISSING else each.default,
            is_positional=not each.kw_only,
        )
        for each in fields(arguments)
    ]
    return tuple(sorted(filter(None, options), key=lambda each: not each.is_positional))


def python_signature(arguments: type, returns: Any) -> Signature:
    """Return the signature of a function in Python that takes these arguments, with the names of their types as texts."""
    parameters = [
        Parameter(
            each.name,
            Parameter.KEYWORD_ONLY if each.kw_only else Parameter.POSITIONAL_OR_KEYWORD,
            default=Parameter.empty if each.default is MISSING else each.default,
            annotation=option.type.name if option else OPTION_TYPES[each.type].name,
        )
        for each, option in (
            (each, DeclaredOption.from_annotation(each.name, each.type, None)) for each in fields(arguments)
        )
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
