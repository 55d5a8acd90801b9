"""`drivelint rules`: list, show, write and test the rules."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from drivelint.cli import completion, options
from drivelint.cli.console import print_rich, progress, run_interruptible
from drivelint.cli.options import Texts, argument, option
from drivelint.phrases import terminal_safe, terminal_safe_json

app = typer.Typer(help="List, show, write and test the rules.", rich_markup_mode=None)


@app.command("list")
def list_(
    selectors: Annotated[Texts, argument("[SEL]...", "Rules to list, as --rules of check. Default: all.")] = None,
    format_: options.FormatOption = "text",
    rules_dir: options.RulesDirs = None,
) -> None:
    """List the rules.

    Example: drivelint rules list ukhc,status:stable clause:R162

    With --format json, also prints the clause of each rule and the signals that it requires.
    """
    from drivelint.catalogue import load_rules, select_rules
    from drivelint.report import rules_text

    rules_by_id = load_rules(tuple(rules_dir or ()))
    rules = select_rules(rules_by_id, selectors, ()) if selectors else list(rules_by_id.values())
    if format_ == "json":
        typer.echo(terminal_safe_json(rules_text.rules_as_json(rules)))
    else:
        print_rich(lambda width: rules_text.rules_table(rules, width))


@app.command("show")
def show(
    rule_id: Annotated[
        str,
        argument(
            "ID",
            "The id of the rule, with or without its pack. It may be shortened to its beginning.",
            autocompletion=completion.rule_ids,
        ),
    ],
    rules_dir: options.RulesDirs = None,
) -> None:
    """Show one rule: question, clause, parameters, SQL."""
    from drivelint.catalogue import load_rules, select_rules
    from drivelint.report import rules_text

    rules = load_rules(tuple(rules_dir or ()))
    begun = [rule for rule in rules.values() if rule.id.startswith((rule_id, f"{rule.pack}.{rule_id}"))]
    for rule in [rules[rule_id]] if rule_id in rules else begun or select_rules(rules, [rule_id], []):
        print_rich(rules_text.rule_details(rule))
        print_rich(rules_text.path_and_sql(rule), soft_wrap=True)


@app.command("new")
def new(
    rule_id: Annotated[str, argument("PACK.NAME", "The id of the rule to write.")],
    folder: Annotated[Path, option("--dir", "DIR", "Folder of packs to write it into.")] = Path(),
    kind: Annotated[
        options.RuleKind,
        option("--kind", None, "When the rule is judged: at every step, or at, before or after a reference point."),
    ] = "invariant",
) -> None:
    """Write a small new rule, to be edited.

    Writes DIR/PACK/NAME.sql and NAME.cases.yml: a rule that already runs, and its test cases. Nothing is overwritten.
    """
    from drivelint.casefile import commands

    for file in commands.write_new_rule(rule_id, folder, kind):
        typer.echo(file)
    typer.echo(f"Edit both, then: drivelint rules test {folder} --rules {rule_id}", err=True)


@app.command("page")
def page_(
    folder: Annotated[Path | None, argument("[DIR]", "Folder with rule packs; default: the shipped ones.")] = None,
    out: Annotated[Path | None, option("--out", "FILE", "Write the page to this file. Default: print it.")] = None,
) -> None:
    """Write the catalogue as one Markdown page.

    The page has a table per pack: what each rule asserts and requires, its numbers and their sources; which clauses are covered;
    and where logs and maps contain the signals that rules require.
    """
    from drivelint.catalogue import load_rules
    from drivelint.report.catalogue_page import render_markdown
    from drivelint.resources import folder as shipped

    rules = load_rules((folder,) if folder else ()).values()
    packs = folder or shipped("queries") / "assertions"
    text = terminal_safe(render_markdown([rule for rule in rules if rule.path.is_relative_to(packs)], packs))
    if out is None:
        typer.echo(text, nl=False)
    else:
        out.write_text(text, encoding="utf-8")


@app.command("test")
def run_tests(
    folder: Annotated[
        Path | None, argument("[DIR]", "Folder with rule packs, or the file of one rule; default: the shipped ones.")
    ] = None,
    only: Annotated[Texts, option("--rules", "SEL", "Rule id or glob. Repeatable. Default: all.")] = None,
    mutate: Annotated[
        bool, option("--mutate", None, "Change each rule in many ways, and check that some case notices each change.")
    ] = False,
    tables: Annotated[
        Texts, option("--table", "TABLE", "Test this table of the library, or glob, instead of rules. Repeatable.")
    ] = None,
    watch: Annotated[
        bool, option("--watch", None, "Then test a rule again whenever its file or its cases are saved, until Ctrl-C.")
    ] = False,
) -> None:
    """Run the test cases beside the rules, or beside tables of the library.

    Each case is a small scene with the expected verdict. With --mutate: checks whether the cases detect a wrong sense,
    threshold or window, or a missing condition.

    Exit codes: 0 all passed; 1 some verdict is not the expected one, or no case detects a mutant of a stable rule; 2 a rule
    or its cases cannot be used.
    """
    from threading import Event

    from drivelint.casefile import commands

    test = commands.mutation_test if mutate else commands.case_test
    out = None if sys.stdout.isatty() else sys.stdout  # None: printed above the progress bar on the terminal
    with progress(quiet=not mutate) as bar:
        bar.stage("judging mutants")

        def say(text: str) -> None:
            typer.echo(terminal_safe(text), file=out)
            bar.advance()

        over, names = Event(), tuple(only or ())
        if tables:
            test_tables = commands.table_mutation_test if mutate else commands.table_case_test
            raise typer.Exit(int(run_interruptible(lambda: test_tables(tuple(tables), say))))
        if watch:
            code = run_interruptible(lambda: commands.repeat_tests_on_changes(test, folder, names, say, over), over.set)
        else:
            code = run_interruptible(lambda: test(folder, names, say))
        raise typer.Exit(int(code))


@app.command("scene")
def scene(
    file: Annotated[Path, argument("FILE", "Scenes as YAML.")],
    only: Annotated[Texts, argument("[NAME]...", "Names of scenes, or their beginnings. Default: all.")] = None,
    out: Annotated[
        Path | None, option("--out", "DIR", "Write the log and the map of each scene into a folder of its name there.")
    ] = None,
    to: Annotated[options.ConvertTarget, option("--to", None, "Format of the logs of --out.")] = "parquet",
    rules_dir: options.RulesDirs = None,
) -> None:
    """Judge drawn scenes, and compare the verdicts with the expected ones.

    A scene is some ten lines of YAML: a road, the actors on it and their movement, and the expected verdicts. `drivelint docs scenes`
    explains it.

    Exit codes: 0 all passed; 1 some verdict is not the expected one; 2 a scene cannot be understood.
    """
    from drivelint.scene.judge import scene_test

    code = scene_test(
        file, tuple(only or ()), tuple(rules_dir or ()), lambda text: typer.echo(terminal_safe(text)), out=out, to=to
    )
    raise typer.Exit(int(code))
