"""Declares an option: the class `Option` stands in the annotation of a field of a class of arguments.

    class DriveArguments(Arguments):
        map_dir: Annotated[AnyPath | None, Option("Folder of maps.", "DIR")] = None

is `--map-dir DIR` on the command line, the keyword `map_dir` in Python, and the key `map-dir` in `drivelint.toml`.
"""

from __future__ import annotations

from dataclasses import fields
from inspect import Parameter, Signature, get_annotations
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, TypeVar, dataclass_transform, get_args, get_origin

from drivelint.options.types import OPTION_TYPES, OptionType, require_one_of

if TYPE_CHECKING:
    from collections.abc import Callable

_OptionsOfEngine = TypeVar("_OptionsOfEngine")


class Option(NamedTuple):
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
    """A field of a class of arguments. `default`: `Parameter.empty` if it must be given. `option`: without help if only Python has it."""

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


@dataclass_transform(kw_only_default=True, frozen_default=True)
class Arguments:
    """The base of classes of arguments. To type checkers they are dataclasses, which take longer to define than some commands run."""

    fields_by_name: ClassVar[dict[str, DeclaredOption]] = {}

    def __init_subclass__(cls, *, kw_only: bool = True) -> None:
        """Find the fields of the class; those of its last base come first, and a field that is declared again keeps its place."""
        cls.fields_by_name = {}
        for base in reversed(cls.__bases__):
            cls.fields_by_name |= getattr(base, "fields_by_name", {})
        for name, annotation in get_annotations(cls).items():
            kind, option = get_args(annotation) if hasattr(annotation, "__metadata__") else (annotation, Option(""))
            default = vars(cls).get(name, Parameter.empty)
            cls.fields_by_name[name] = DeclaredOption(
                name, option.type or OPTION_TYPES[kind], default, not kw_only, option
            )

    def __init__(self, *positional: Any, **keywords: Any) -> None:
        names = [declared.name for declared in self.fields_by_name.values() if declared.is_positional]
        defaults = {declared.name: declared.default for declared in self.fields_by_name.values()}
        vars(self).update(defaults | dict(zip(names, positional, strict=False)) | keywords)


def declared_options(arguments: type[Arguments]) -> tuple[DeclaredOption, ...]:
    """Return the options that a class of arguments declares, the positional ones first."""
    options: list[DeclaredOption] = []
    for declared in arguments.fields_by_name.values():
        if declared.option.help:
            names, place = [option.name for option in options], declared.option.place_after
            options.insert(names.index(place) + 1 if place else len(options), declared)
    return tuple(sorted(options, key=lambda declared: not declared.is_positional))


def python_signature(arguments: type[Arguments], returns: Any) -> Signature:
    """Return the signature of a function in Python that takes these arguments, with the names of their types as texts."""
    parameters = [
        Parameter(
            declared.name,
            Parameter.POSITIONAL_OR_KEYWORD if declared.is_positional else Parameter.KEYWORD_ONLY,
            default=declared.default,
            annotation=declared.type.name,
        )
        for declared in arguments.fields_by_name.values()
    ]
    return Signature(sorted(parameters, key=lambda declared: declared.kind), return_annotation=returns)


def engine_values(arguments: Arguments, group: type[Arguments] | None = None) -> dict[str, Any]:
    """Return field of the engine -> value, for all options of the arguments, or for those that the class `group` declares.

    Errors: `UsageError` for an invalid value.
    """
    return {
        declared.field: declared.engine_value(getattr(arguments, declared.name))
        for declared in declared_options(group or type(arguments))
    }


def options_of_engine(
    kind: Callable[..., _OptionsOfEngine], values: dict[str, Any], **replacements: Any
) -> _OptionsOfEngine:
    """Return an instance of the dataclass `kind` with those of the values that it has fields for, and with the replacements."""
    names = {field.name for field in fields(kind)}  # type: ignore[arg-type]
    return kind(**{name: value for name, value in values.items() if name in names} | replacements)
