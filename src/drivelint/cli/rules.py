"""`drivelint rules`: list, show, write and test the rules."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from drivelint.cli import completion, options
from drivelint.cli.console import print_rich, progress, run_interruptible
from drivelint.cli.options import Texts, argument, option
from drivelint.phrases import inert, inert_json

app = typer.Typer(help="List, show, write and test the rules.", rich_markup_mode=None)


@app.command("list")
def list_(
    selectors: Annotated[Texts, argument("[SEL]...", "Which ones, as --rules of check. Default: all.")] = None,
    format_: options.FormatOption = "text",
    rules_dir: options.RulesDirs = None,
) -> None:
    """List the rules.

    Such as: drivelint rules list ukhc,status:stable clause:R162

    With --format json also the clause that each is from and what it requires of a log.
    """
    from drivelint.catalogue import load_rules, select_rules
    from drivelint.report import rules_text

    known = load_rules(tuple(rules_dir or ()))
    rules = select_rules(known, selectors, ()) if selectors else list(known.values())
    if format_ == "json":
        typer.echo(inert_json(rules_text.listing_json(rules)))
    else:
        print_rich(lambda width: rules_text.listing(rules, width))


@app.command("show")
def show(
    rule_id: Annotated[
        str,
        argument(
            "ID", "The rule's id, or how it begins, with or without its pack.", autocompletion=completion.rule_ids
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
        print_rich(rules_text.source(rule), soft_wrap=True)


@app.command("new")
def new(
    rule_id: Annotated[str, argument("PACK.NAME", "The id of the rule to write.")],
    folder: Annotated[Path, option("--dir", "DIR", "Folder of packs to write it into.")] = Path(),
    kind: Annotated[
        options.RuleKind, option("--kind", None, "Judged at every step, or else at, before or after a reference point.")
    ] = "invariant",
) -> None:
    """Write a rule to start from.

    DIR/PACK/NAME.sql and NAME.cases.yml: a small rule with its cases, which runs as it is. Nothing is overwritten.
    """
    from drivelint.casefile import commands

    for file in commands.new_rule(rule_id, folder, kind):
        typer.echo(file)
    typer.echo(f"Edit both, then: drivelint rules test {folder} --rules {rule_id}", err=True)


@app.command("page")
def page_(
    folder: Annotated[Path | None, argument("[DIR]", "Folder with rule packs; default: the shipped ones.")] = None,
    out: Annotated[Path | None, option("--out", "FILE", "Write it there; default: print it.")] = None,
) -> None:
    """Write the catalogue as one Markdown page.

    A table per pack: what each rule asserts and needs, its numbers and where they are from; by clause what is covered; and the
    words that logs and maps have for what rules ask.
    """
    from drivelint.catalogue import load_rules
    from drivelint.report.catalogue_page import page
    from drivelint.resources import folder as shipped

    rules = load_rules((folder,) if folder else ()).values()
    packs = folder or shipped("queries") / "assertions"
    text = inert(page([rule for rule in rules if rule.path.is_relative_to(packs)], packs))
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
        bool, option("--mutate", None, "Break each rule in many ways, and ask whether some case notices.")
    ] = False,
    watch: Annotated[
        bool, option("--watch", None, "Then test each rule again when its file or its cases are saved, until Ctrl-C.")
    ] = False,
) -> None:
    """Run the test cases beside the rules.

    Each is a small scene with the verdict that is due. With --mutate: whether the cases would notice a wrong sense,
    threshold or window, or a missing condition.

    Exit codes: 0 all is well; 1 some verdict is another, or a mutant of a stable rule is noticed by no case; 2 a rule
    or its cases cannot be used.
    """
    from threading import Event

    from drivelint.casefile import commands

    test = commands.mutation_test if mutate else commands.case_test
    out = None if sys.stdout.isatty() else sys.stdout  # None: above the bar, where both are on the terminal
    with progress(quiet=not mutate) as shown:
        shown.stage("judging mutants")

        def say(text: str) -> None:
            typer.echo(inert(text), file=out)
            shown.advance()

        over, names = Event(), tuple(only or ())
        if watch:
            code = run_interruptible(lambda: commands.watch(test, folder, names, say, over), over.set)
        else:
            code = run_interruptible(lambda: test(folder, names, say))
        raise typer.Exit(int(code))


@app.command("scene")
def scene(
    file: Annotated[Path, argument("FILE", "Scenes as YAML.")],
    only: Annotated[Texts, argument("[NAME]...", "Scenes by how their names begin. Default: all.")] = None,
    out: Annotated[
        Path | None, option("--out", "DIR", "Write each scene's log and map there, into a folder of its name.")
    ] = None,
    to: Annotated[options.ConvertTarget, option("--to", None, "The format of these logs.")] = "parquet",
    rules_dir: options.RulesDirs = None,
) -> None:
    """Judge drawn scenes, and hold the verdicts against those that they expect.

    A scene is some ten lines of YAML: a road, who drives on it and how, and the verdicts that are due. `drivelint docs scenes` explains
    it.

    Exit codes: 0 all is well; 1 some verdict is another; 2 a scene cannot be understood.
    """
    from drivelint.scene.judge import scene_test

    code = scene_test(
        file, tuple(only or ()), tuple(rules_dir or ()), lambda text: typer.echo(inert(text)), out=out, to=to
    )
    raise typer.Exit(int(code))
