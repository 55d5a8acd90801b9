"""The help of `check` and `watch`, with the options grouped under headings."""

from __future__ import annotations

from typing import Any, Final

from typer.core import TyperCommand

from drivelint.options.arguments import DriveArguments, RuleArguments
from drivelint.options.declaration import declared_options

_OPTIONS_BY_HEADING: Final = {
    "Watching": ("halt_on", "warn", "advise", "on", "serve", "replay", "window", "every", "idle"),
    "Input": tuple(option.field for option in declared_options(DriveArguments)),
    "Rules": tuple(option.field for option in declared_options(RuleArguments)),
    "Gate": ("fail_on", "strict", "require", "min_judged", "confidence", "baseline", "waivers", "today"),
    "Output": (
        "out",
        "overwrite",
        "format_",
        "report",
        "margins",
        "keep_db",
        "annotate",
        "pictures",
        "evidence_pack",
        "sign",
        "verbose",
        "jobs",
        "cache",
        "quiet",
    ),
}
"""Heading -> parameters. The help keeps the command's order within a heading; options without a heading come last."""


class GroupedCommand(TyperCommand):
    """A command whose options are shown in groups."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments and one section of options per group."""
        groups: dict[str, list[tuple[str, str]]] = {
            name: [] for name in ("Arguments", *_OPTIONS_BY_HEADING, "Other options")
        }
        heading = {param: name for name, params in _OPTIONS_BY_HEADING.items() for param in params}
        for param in self.get_params(ctx):
            if (record := param.get_help_record(ctx)) is not None:
                is_option = param.param_type_name == "option"
                groups[heading.get(param.name or "", "Other options") if is_option else "Arguments"].append(record)
        for name, records in groups.items():
            if records:
                with formatter.section(name):
                    formatter.write_dl(records)
