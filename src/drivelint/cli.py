"""The command line: parse, call, print, exit. stdout is data, stderr is progress and diagnostics.

Everything heavy is imported inside the commands, so that `--help` stays fast.
"""

from __future__ import annotations

import io
import os
import sys
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import nullcontext, redirect_stdout
from datetime import date, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn, TypeVar

import typer

from drivelint import __version__, cli_explain, options
from drivelint.errors import DriveLintError, ExitCode, UsageError

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextlib import AbstractContextManager

    from rich.console import RenderableType

    from drivelint.ingest.trace import EgoSize
    from drivelint.report.progress import Progress
    from drivelint.report.result import Result

T = TypeVar("T")

app = typer.Typer(
    name="drivelint",
    help="Checks recorded drives against the rules of the road.",
    epilog="To begin: `drivelint demo` writes drives to try it on and prints the command that checks them; "
    "`drivelint inspect TRACE` shows what a log of yours can decide.",
    add_completion=False,
    rich_markup_mode=None,  # two columns of text: frames and types leave a help of 80 columns no room for words
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
rules_app = typer.Typer(help="List, show, write and test the rules.", rich_markup_mode=None)
app.add_typer(rules_app, name="rules")


def _version(value: bool) -> None:
    if value:
        typer.echo(f"drivelint {__version__}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _root(
    ctx: typer.Context,
    *,
    version: Annotated[  # noqa: ARG001 - its callback acts
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Checks recorded drives against the rules of the road."""
    if ctx.invoked_subcommand is None:
        with redirect_stdout(sys.stderr):
            typer.echo(ctx.get_help())
        raise typer.Exit(int(ExitCode.USAGE))


@app.command()
def check(
    *,
    traces: Annotated[list[str], typer.Argument(metavar="TRACE", help="Recorded drives: files, globs or folders.")],
    map_: options.MapFile = None,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder for the result files.")] = None,
    rules: Annotated[
        list[str] | None,
        typer.Option(
            "--rules", metavar="SEL", help="Rules to judge by, see above. Repeatable. Default: stable rules of ukhc."
        ),
    ] = None,
    ignore: Annotated[
        list[str] | None, typer.Option("--ignore", metavar="SEL", help="Leave these rules out. Repeatable.")
    ] = None,
    profile: Annotated[
        list[str] | None,
        typer.Option("--profile", metavar="NAME", help="relaxed, nominal (default), aggressive, observed. Repeatable."),
    ] = None,
    param: Annotated[
        list[str] | None, typer.Option("--param", metavar="RULE.PARAM=V", help="Set a rule's parameter. Repeatable.")
    ] = None,
    ego: options.EgoId = None,
    mapping: options.MappingName = None,
    map_offset: options.MapOffset = None,
    map_dir: options.MapDir = None,
    map_origin: options.MapOrigin = None,
    handedness: options.DrivenSide = options.Handedness.auto,
    sensor_range: options.SensorRange = None,
    ego_size: options.EgoBox = None,
    env: options.Conditions = None,
    topic: options.Topic = None,
    rules_dir: options.RulesDirs = None,
    fail_on: Annotated[
        options.FailOn, typer.Option("--fail-on", help="Least severity that makes exit code 1.")
    ] = options.FailOn.critical,
    strict: Annotated[bool, typer.Option("--strict", help="Unknown is not good enough: exit code 4.")] = False,
    format_: options.Printed = options.Format.text,
    margins: Annotated[bool, typer.Option("--margins", help="Also write margins.parquet: every judged step.")] = False,
    keep_db: Annotated[
        bool, typer.Option("--keep-db", help="Also keep the database with every stage's tables.")
    ] = False,
    annotate: Annotated[
        bool,
        typer.Option(
            "--annotate/--no-annotate", help="With --out: copy each log with its verdicts in it, for a viewer."
        ),
    ] = True,
    baseline: options.Baseline = None,
    waivers: options.Waivers = None,
    today: options.Today = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on stderr.")] = False,
) -> None:
    """Judge recorded drives against the rules.

    With --out: tables of verdicts and findings, report.html, and the logs with their verdicts in them.

    SEL is a rule's id, a glob, a pack, all, or what a rule says of itself: kind:invariant, severity:critical,
    status:draft, legal:must, clause:R162, requires:indicator. A comma means both (ukhc,legal:must), --rules twice either.

    Exit codes: 0 nothing failed at or above --fail-on; 1 something did (with --baseline or --waivers: something that is new
    and that nobody answers for); 2 usage or rule error; 3 judged on lossy input; 4 some drives not judged (with --strict: some
    rule unknown); 75 the machine failed, try again; 130 interrupted.
    """
    from drivelint import run
    from drivelint.report.files import prepare
    from drivelint.report.gate import Keeper
    from drivelint.report.outputs import write
    from drivelint.report.result import exit_code
    from drivelint.settings import FILE

    keeper = Keeper.of(baseline, waivers, Path(FILE), _today(today), out)
    settings = run.Settings(
        traces=tuple(traces),
        map=map_,
        out=out,
        rules=tuple(rules or ()),
        ignore=tuple(ignore or ()),
        profiles=tuple(profile or ()),
        params=tuple(param or ()),
        ego=ego,
        mapping=mapping,
        map_offset=_offset(map_offset),
        map_dir=map_dir,
        map_origin=_origin(map_origin),
        handedness=handedness.value,
        sensor_range_m=sensor_range,
        ego_size=_ego_size(ego_size),
        env=tuple(env or ()),
        rules_dirs=tuple(rules_dir or ()),
        fail_on=fail_on.value,
        strict=strict,
        margins=margins,
        keep_db=keep_db,
        annotate=annotate,
        topic=topic,
    )
    if out is not None:
        prepare(out)
    with _progress(quiet) as progress:
        result = _interruptible(lambda: run.check(settings, progress))
        if keeper is not None:
            result = keeper.gate(result)
        if out is not None:
            write(result, out)
    _print(result, format_, out)
    raise typer.Exit(int(exit_code(result)))


@app.command()
def demo(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder for the logs and their road.")] = Path(
        "demo"
    ),
) -> None:
    """Write drives to try drivelint on.

    Three overtakes at two speeds, as ASAM OSI in MCAP, and their road. Prints the command that checks them.
    """
    from drivelint.demo import files

    written = files.write(out)
    typer.echo(f"{out}: {len(written) - 1} drives and their road are there. Check them with:", err=True)
    typer.echo(files.next_command(out, sys.argv[0]))


@app.command()
def inspect(
    *,
    trace: Annotated[str, typer.Argument(metavar="TRACE", help="One recorded drive.")],
    map_: options.MapFile = None,
    ego: options.EgoId = None,
    mapping: options.MappingName = None,
    map_offset: options.MapOffset = None,
    map_dir: options.MapDir = None,
    map_origin: options.MapOrigin = None,
    handedness: options.DrivenSide = options.Handedness.auto,
    sensor_range: options.SensorRange = None,
    ego_size: options.EgoBox = None,
    env: options.Conditions = None,
    topic: options.Topic = None,
    rules: Annotated[
        list[str] | None,
        typer.Option("--rules", metavar="SEL", help="Rules to ask about, as in check. Repeatable. Default: ukhc."),
    ] = None,
    rules_dir: options.RulesDirs = None,
    format_: options.Printed = options.Format.text,
) -> None:
    """Show what is in a log and what it can decide.

    Also how it lies on the map, what is wrong with it, and what to provide so that more rules can be decided.
    """
    from drivelint import inspect as inspection

    order = inspection.Order(
        trace=trace,
        map=map_,
        mapping=mapping,
        ego=ego,
        topic=topic,
        map_offset=_offset(map_offset),
        map_dir=map_dir,
        map_origin=_origin(map_origin),
        handedness=handedness.value,
        sensor_range_m=sensor_range,
        ego_size=_ego_size(ego_size),
        env=tuple(env or ()),
        rules=tuple(rules or ()),
        rules_dirs=tuple(rules_dir or ()),
    )
    found = _interruptible(lambda: inspection.inspect(order))
    if format_ is options.Format.json:
        typer.echo(inspection.to_json(found))
    else:
        from drivelint.inspect.text import render

        _say(render(found, trace))
    raise typer.Exit(int(inspection.exit_code(found)))


@app.command()
def convert(
    *,
    trace: Annotated[str, typer.Argument(metavar="TRACE", help="One recorded drive.")],
    to: Annotated[
        options.Target, typer.Option("--to", help="mcap: one file of ASAM OSI; parquet: a folder of tables.")
    ],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder for the converted log.")],
    map_: options.MapFile = None,
    ego: options.EgoId = None,
    mapping: options.MappingName = None,
    map_offset: options.MapOffset = None,
    sensor_range: options.SensorRange = None,
    ego_size: options.EgoBox = None,
    topic: options.Topic = None,
) -> None:
    """Write a log anew, as OSI in MCAP or as Parquet.

    In metres, seconds and box centres, with its map, so that it needs no mapping any more and gives the same verdicts.
    """
    from drivelint import convert as converter
    from drivelint.convert.text import said

    order = converter.Order(
        trace=trace,
        to=to.value,
        out=out,
        map=map_,
        map_offset=_offset(map_offset),
        mapping=mapping,
        ego=ego,
        topic=topic,
        sensor_range_m=sensor_range,
        ego_size=_ego_size(ego_size),
    )
    written = _interruptible(lambda: converter.convert(order))
    for note in written.notes:
        typer.echo(f"drivelint: {note}", err=True)
    typer.echo(said(written))


@app.command()
def report(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="What check --out wrote.")],
    to: Annotated[
        options.Report,
        typer.Option(
            "--to",
            help="html: one page that opens offline; junit, sarif (2.1.0), xqar (ASAM): for servers and viewers; "
            "markdown: for a comment on a pull request.",
        ),
    ] = options.Report.html,
) -> None:
    """Write a report from a result folder, into it.

    Files: report.html, junit.xml, report.sarif, report.xqar, report.md. Prints the name of the one that was written.
    """
    from drivelint.report.files import publish
    from drivelint.report.load import load
    from drivelint.report.targets import TARGETS

    name, render = TARGETS[to.value]
    publish(folder, {name: render(load(folder))}, {})
    typer.echo(str(folder / name))


cli_explain.register(app, lambda job: _interruptible(job), lambda what: _say(what))


@app.command("diff")
def diff_(
    base: Annotated[Path, typer.Argument(metavar="BASE", help="What check --out wrote, earlier.")],
    new: Annotated[Path, typer.Argument(metavar="NEW", help="What check --out wrote, later.")],
    format_: Annotated[
        options.Compared, typer.Option("--format", help="What is printed on stdout.")
    ] = options.Compared.text,
    fail_on: Annotated[
        options.FailOn | None,
        typer.Option("--fail-on", help="Least severity of a new finding that makes exit code 1. Default: NEW's."),
    ] = None,
) -> None:
    """Compare two results: new, fixed, changed and unchanged findings.

    What NEW did not judge is not fixed: it is listed apart, with the reason. Findings that NEW's run waived do not gate.

    Exit codes: 0 no new finding of a stable rule at or above --fail-on; 1 there is one; 2 usage error.
    """
    from drivelint.report.gate import compared, words
    from drivelint.report.load import load

    earlier, later = load(base), load(new)
    least = later.fail_on if fail_on is None else fail_on.value
    found, failing = compared(earlier, later, (base.resolve().name, new.resolve().name), least)
    if format_ is options.Compared.json:
        typer.echo(words.to_json(found, failing, least))
    elif format_ is options.Compared.markdown:
        from drivelint.report import markdown

        typer.echo(markdown.difference(found, failing, least, later.gate))
    else:
        typer.echo(words.text(found, failing, least, later.gate))
    raise typer.Exit(int(ExitCode.FAILED if failing else ExitCode.OK))


@rules_app.command("list")
def rules_list(
    selectors: Annotated[
        list[str] | None, typer.Argument(metavar="[SEL]...", help="Which ones, as --rules of check. Default: all.")
    ] = None,
    format_: options.Printed = options.Format.text,
    rules_dir: options.RulesDirs = None,
) -> None:
    """List the rules.

    Such as: drivelint rules list ukhc,status:stable clause:R162

    With --format json also the clause that each is from and what it requires of a log.
    """
    from drivelint.catalogue import load, select
    from drivelint.report import rules_text

    known = load(tuple(rules_dir or ()))
    rules = select(known, selectors, ()) if selectors else list(known.values())
    if format_ is options.Format.json:
        typer.echo(rules_text.listing_json(rules))
    else:
        _say(lambda width: rules_text.listing(rules, width))


@rules_app.command("show")
def rules_show(
    rule_id: Annotated[str, typer.Argument(metavar="ID", help="The rule's id.")], rules_dir: options.RulesDirs = None
) -> None:
    """Show one rule: question, clause, parameters, SQL."""
    from drivelint.catalogue import load, select
    from drivelint.report import rules_text

    rules = load(tuple(rules_dir or ()))
    for rule in [rules[rule_id]] if rule_id in rules else select(rules, [rule_id], []):
        _say(rules_text.page(rule))
        _say(rules_text.source(rule), soft_wrap=True)


@rules_app.command("new")
def rules_new(
    rule_id: Annotated[str, typer.Argument(metavar="PACK.NAME", help="The id of the rule to write.")],
    folder: Annotated[Path, typer.Option("--dir", metavar="DIR", help="Folder of packs to write it into.")] = Path(),
    kind: Annotated[
        options.RuleKind, typer.Option("--kind", help="What it is judged at.")
    ] = options.RuleKind.invariant,
) -> None:
    """Write a rule to start from.

    DIR/PACK/NAME.sql and NAME.cases.yml: a small rule with its cases, which runs as it is. Nothing is overwritten.
    """
    from drivelint.casefile import workshop

    for file in workshop.new(rule_id, folder, kind.value):
        typer.echo(file)
    typer.echo(f"Edit both, then: drivelint rules test {folder} --rules {rule_id}", err=True)


@rules_app.command("page")
def rules_page(
    folder: Annotated[
        Path | None, typer.Argument(metavar="[DIR]", help="Folder with rule packs; default: the shipped ones.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Write it there; default: print it.")
    ] = None,
) -> None:
    """Write the catalogue as one Markdown page.

    A table per pack: what each rule asserts and needs, its numbers and where they are from; and by clause what is covered.
    """
    from drivelint.catalogue import load
    from drivelint.report.catalogue_page import page
    from drivelint.resources import folder as shipped

    rules = load((folder,) if folder else ()).values()
    packs = folder or shipped("queries") / "assertions"
    text = page([rule for rule in rules if rule.path.is_relative_to(packs)], packs)
    if out is None:
        typer.echo(text, nl=False)
    else:
        out.write_text(text, encoding="utf-8")


@rules_app.command("test")
def rules_test(
    folder: Annotated[
        Path | None, typer.Argument(metavar="[DIR]", help="Folder with rule packs; default: the shipped ones.")
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option("--rules", metavar="SEL", help="Rule id or glob. Repeatable. Default: all.")
    ] = None,
    mutate: Annotated[
        bool, typer.Option("--mutate", help="Break each rule in many ways, and ask whether some case notices.")
    ] = False,
) -> None:
    """Run the test cases beside the rules.

    Each is a small scene with the verdict that is due. With --mutate: whether the cases would notice a wrong sense,
    threshold or window, or a missing condition.

    Exit codes: 0 all is well; 1 some verdict is another, or a mutant of a stable rule is noticed by no case; 2 a rule
    or its cases cannot be used.
    """
    from drivelint.casefile import workshop

    test = workshop.mutation_test if mutate else workshop.case_test
    raise typer.Exit(int(_interruptible(lambda: test(folder, tuple(only or ()), typer.echo))))


def main() -> NoReturn:
    """Run the command line; every mistake of a user ends in one line on stderr and its exit code."""
    from typer.exceptions import TyperException

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a log's words may not fit the terminal's encoding
    try:
        code = app(standalone_mode=False, default_map=_settings())
    except DriveLintError as error:
        _fail(str(error), error.exit_code)
    except TyperException as error:
        also = " and drivelint.toml in this folder" if Path("drivelint.toml").is_file() else ""
        words = error.format_message().replace("Value error, ", "")  # the library's, not ours
        _fail(f"{words} (see drivelint {_asked(error)}--help{also})", ExitCode.USAGE)
    except (KeyboardInterrupt, typer.Abort):
        code = ExitCode.INTERRUPTED
    if code == ExitCode.INTERRUPTED:
        print("drivelint: error: interrupted", file=sys.stderr, flush=True)
        os._exit(code)  # the database may still be computing in its thread: there is nothing to wait for
    sys.exit(code or 0)


def _asked(error: Exception) -> str:
    """Return the words of the command that a mistake was made in, each with a space behind it; '' for none."""
    about, words = getattr(error, "ctx", None), ""
    while about is not None and about.parent is not None:
        about, words = about.parent, f"{about.info_name} {words}"
    return words


def _settings() -> dict[str, Any]:
    """Return what `drivelint.toml` in the current folder says about the options of `check`, or of others that read a log.

    Those take what is about the log and its map, not where `check` writes to and how it prints.
    """
    from drivelint.settings import FILE, defaults

    name = "".join(sys.argv[1:2])
    if name not in {"check", "inspect", "convert"} or not Path(FILE).is_file():
        return {}
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    params = commands["check"].params
    known = {p.opts[0].lstrip("-"): (p.name, p.multiple) for p in params if p.param_type_name == "option"}
    for name_ in ("help", "today"):  # a day that stands in a file would keep waivers from expiring
        known.pop(name_, None)
    taken = {p.name for p in commands[name].params}
    if name != "check":
        taken -= {"out", "format_"}
    return {name: {param: value for param, value in defaults(known).items() if param in taken}}


def _fail(message: str, code: ExitCode) -> NoReturn:
    print(f"drivelint: error: {' '.join(message.split())}", file=sys.stderr)
    sys.exit(int(code))


def _today(text: str | None) -> date:
    """Read the day that waivers are held against; the system's if none is given. Errors: `UsageError`."""
    if text is None:
        return datetime.now().astimezone().date()
    try:
        return date.fromisoformat(text)
    except ValueError as error:
        raise UsageError(f"--today {text!r}: write a day such as 2027-03-31") from error


def _offset(text: str | None) -> tuple[float, float] | None:
    """Read DX,DY. Errors: `UsageError`."""
    if text is None:
        return None
    try:
        dx, dy = (float(part) for part in text.split(","))
    except ValueError as error:
        raise UsageError(f"--map-offset {text!r}: write two numbers in metres, DX,DY, such as 2.6,3.1") from error
    return dx, dy


def _ego_size(text: str | None) -> EgoSize | None:
    """Read L,W[,AHEAD]. Errors: `UsageError`."""
    if text is None:
        return None
    from drivelint.ingest.trace import EgoSize

    try:
        length, width, *rest = (float(part) for part in text.split(","))
        (ahead,) = rest or [0.0]
    except ValueError:
        length = width = ahead = float("nan")
    if not (0.0 < length < 100.0 and 0.0 < width < 10.0 and abs(ahead) < 100.0):
        raise UsageError(f"--ego-size {text!r}: write length and width in metres, such as 4.9,1.9 or 4.9,1.9,1.4")
    return EgoSize(length, width, ahead)


def _origin(text: str | None) -> tuple[float, float] | None:
    """Read LAT,LON. Errors: `UsageError`."""
    if text is None:
        return None
    try:
        lat, lon = (float(part) for part in text.split(","))
    except ValueError:
        lat = lon = 999.0
    if not (abs(lat) <= 90 and abs(lon) <= 180):
        raise UsageError(f"--map-origin {text!r}: write latitude and longitude in degrees, LAT,LON, such as 51.5,-2.58")
    return lat, lon


def _interruptible(job: Callable[[], T]) -> T:
    """Run `job` beside the main thread: the database does not look at Ctrl-C while it computes, this thread does.

    It looks several times a second, because some libraries make the system restart a wait that a signal interrupted.
    """
    running = ThreadPoolExecutor(max_workers=1).submit(job)
    while not running.done():
        wait([running], timeout=0.2)
    return running.result()


def _progress(quiet: bool) -> AbstractContextManager[Progress]:
    """Return a bar on a terminal's stderr; elsewhere only the pipeline's notes, as lines."""
    from drivelint.report.progress import Notes, Silent

    if quiet:
        return nullcontext(Silent())
    if not sys.stderr.isatty():
        return nullcontext(Notes())
    from drivelint.report.console import Bar

    return Bar()


def _say(what: RenderableType | Callable[[int], RenderableType], *, soft_wrap: bool = False) -> None:
    """Print for a person on stdout: plain and wide where that is no terminal. `what` may depend on the width."""
    from rich.console import Console

    terminal = sys.stdout.isatty()
    console = Console(width=None if terminal or "COLUMNS" in os.environ else 120, highlight=False)
    with nullcontext() if terminal else console.capture() as captured:
        console.print(what(console.width) if callable(what) else what, soft_wrap=soft_wrap)
    if captured is not None:
        typer.echo("\n".join(line.rstrip() for line in captured.get().splitlines()))


def _print(result: Result, format_: options.Format, out: Path | None) -> None:
    """Print the outcome of a check on stdout."""
    from drivelint.report import summary, terminal

    if format_ is options.Format.json:
        typer.echo(summary.render(result), nl=False)
    else:
        _say(lambda width: terminal.render(result, None if out is None else str(out), width))
