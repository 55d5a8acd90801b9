"""Every option that more than one command, or the command line and Python, take: name, type, default, help and spelling.

The order is that of `--help`. Annotations are evaluated when the classes are made, so this module does not postpone them.
"""

from datetime import date
from typing import Annotated

from drivelint import option_values
from drivelint.options.declaration import Arguments, Option
from drivelint.options.types import (
    NAME_OR_PATH,
    AnyPath,
    Assignments,
    FailOn,
    Format,
    Handedness,
    Pair,
    Paths,
    ReportFile,
    Texts,
    Visibility,
    to_float,
)

Rules = Annotated[
    Texts, Option("Rules to judge by, as in check. Repeatable. Default: those of check.", "SEL", selects_rules=True)
]
RulesDirs = Annotated[
    Paths | None, Option("Folder with rule packs of your own. Repeatable.", "DIR", field="rules_dirs")
]
MinJudged = Annotated[
    float | None,
    Option(
        "Exit code 4 if less than this share of the rules that may apply is decided, such as 0.5.",
        "SHARE",
        minimum=0.0,
        maximum=1.0,
        parse=to_float,
    ),
]
Waivers = Annotated[
    AnyPath | None,
    Option(
        "TOML file of findings that an owner accepts until a date. They are shown, but do not fail the run.", "FILE"
    ),
]
Today = Annotated[
    date | str | None, Option("The date that decides whether a waiver has expired. Default: today.", "DATE")
]
Memory = Annotated[
    str | None,
    Option(
        "Memory of the database before it uses the disk: 512MB, 2GB; none: 80 % of the machine's. Results do not depend "
        "on it. If a step needs more, it takes more, with a note. The program itself takes some 300 MB more. Default: 1200MB.",
        "SIZE|none",
        parse=option_values.parse_memory,
    ),
]
Evidence = Annotated[
    AnyPath | None,
    Option("Also pack the result as evidence into this folder, as drivelint pack does.", "PACK", field="evidence_pack"),
]
Sign = Annotated[
    AnyPath | None,
    Option(
        "Sign the pack with this Ed25519 key: PEM, without a password. Or the public key (id_ed25519.pub) of a key in ssh-agent.",
        "KEY",
    ),
]
Quiet = Annotated[bool, Option("No progress on stderr.", flag="--quiet -q")]


class DriveArguments(Arguments):
    """How a log is read, and the map on which it is judged: the options of every command that reads a log."""

    map: Annotated[
        AnyPath | None,
        Option("The map of the road: OpenDRIVE, Lanelet2, CommonRoad or a SUMO net. Most rules need it.", "MAP"),
    ] = None
    ego: Annotated[str | int | None, Option("The vehicle under test, or every vehicle in turn.", "ID|all")] = None
    mapping: Annotated[
        AnyPath | None,
        Option(
            "The meaning of a table's columns: a TOML file, or the name of a shipped mapping.",
            "FILE|NAME",
            type=NAME_OR_PATH,
        ),
    ] = None
    map_offset: Annotated[
        Pair, Option("Metres added to the map's coordinates.", "DX,DY", parse=option_values.parse_offset)
    ] = None
    map_dir: Annotated[
        AnyPath | None, Option("Folder of maps. Each log gets its map by maps.csv, by name or by place.", "DIR")
    ] = None
    map_origin: Annotated[
        Pair,
        Option(
            "Position of the log's 0,0, for a map in degrees (Lanelet2).", "LAT,LON", parse=option_values.parse_origin
        ),
    ] = None
    handedness: Annotated[Handedness, Option("Side of the road that is driven on.")] = "auto"
    sensor_range: Annotated[
        float | None,
        Option(
            "Range in which the recorder sees every actor. Default: the value in the log, else 50 m.",
            "M",
            minimum=0,
            field="sensor_range_m",
        ),
    ] = None
    visibility: Annotated[
        Visibility,
        Option(
            "Where an unrecorded actor may be. line-of-sight: not in plain view, from 2.5 s after it was lost; none: anywhere."
        ),
    ] = "line-of-sight"
    ego_size: Annotated[
        str | tuple[float, ...] | None,
        Option(
            "The ego's length and width in metres, if the log has none. AHEAD: distance of its centre ahead of the odometry's frame.",
            "L,W[,AHEAD]",
            parse=option_values.parse_ego_size,
        ),
    ] = None
    env: Annotated[
        Assignments,
        Option(
            "A condition of the drives: nation, weather, light, vehicle_class, road_type, carriageway, area, engaged. "
            "Repeatable. Takes precedence over the map and the log.",
            "KEY=VALUE",
        ),
    ] = None
    topic: Annotated[str | None, Option("The MCAP topic to read, if several are possible.", "NAME")] = None


class ReadTraceArguments(DriveArguments, kw_only=False):
    """The arguments of `drivelint.read_trace` in Python."""

    path: AnyPath


class OutputArguments(Arguments):
    """The folder of a result."""

    out: Annotated[
        AnyPath | None, Option("Folder for the result files. An earlier result in it is replaced.", "DIR")
    ] = None
    overwrite: Annotated[bool, Option("Also replace files in it that drivelint did not write.")] = False


class RuleArguments(Arguments):
    """The rules and profiles of a run."""

    rules: Rules = None
    ignore: Annotated[Texts, Option("Leave these rules out. Repeatable.", "SEL", selects_rules=True)] = None
    profile: Annotated[Texts, Option("As in check. Repeatable.", "NAME", field="profiles")] = None
    param: Annotated[Assignments, Option("Set a rule's parameter. Repeatable.", "RULE.PARAM=V", field="params")] = None
    rules_dir: RulesDirs = None


class ExitCodeArguments(Arguments):
    """The verdicts that cause an exit code other than 0."""

    fail_on: Annotated[FailOn, Option("Lowest severity that causes exit code 1.")] = "critical"
    strict: Annotated[bool, Option("Exit code 4 if a rule is unknown.")] = False


class TracesArguments(Arguments, kw_only=False):
    """The logs of a check."""

    traces: Annotated[
        Paths, Option("Recorded drives: files, globs, folders, or a manifest of them, as in audit.", "TRACE")
    ]


class CheckArguments(ExitCodeArguments, RuleArguments, OutputArguments, DriveArguments, TracesArguments):
    """The arguments of `drivelint.check` in Python, and of `drivelint check` except for those on how it prints."""

    rules: Annotated[
        Texts,
        Option(
            "Rules to judge by, see above. Repeatable. Default: stable rules of ukhc, in Germany (--env, --map) of stvo too.",
            "SEL",
            selects_rules=True,
        ),
    ] = None
    profile: Annotated[
        Texts,
        Option(
            "relaxed, nominal, aggressive, observed, or your own. Repeatable. Default: nominal and observed.",
            "NAME",
            field="profiles",
        ),
    ] = None
    require: Annotated[
        Texts, Option("Exit code 4 if one of these rules is unknown. Repeatable.", "SEL", selects_rules=True)
    ] = None
    min_judged: MinJudged = None
    margins: Annotated[bool, Option("Also write margins.parquet, with a row per judged step.")] = False
    keep_db: Annotated[bool, Option("Also keep the database with the tables of every stage.")] = False
    annotate: Annotated[
        bool,
        Option(
            "With --out: write a copy of each log that includes its verdicts, for a viewer.",
            flag="--annotate/--no-annotate",
        ),
    ] = True
    pictures: Annotated[
        bool,
        Option("With --out: show frames of the log's own cameras beside findings.", flag="--pictures/--no-pictures"),
    ] = True
    robustness: Annotated[
        bool | None,
        Option(
            "Count in how many copies of the drive with recording errors a critical or major finding stays. "
            "Default: only for the gravest finding of each rule, and for findings that small errors may remove.",
            flag="--robustness/--no-robustness",
        ),
    ] = None
    confidence: Annotated[
        float | None,
        Option(
            "Only findings that stay in at least this share of their copies can fail the run, such as 0.95. "
            "Default: all findings can.",
            "SHARE",
            minimum=0.0,
            maximum=1.0,
            parse=to_float,
        ),
    ] = None
    baseline: Annotated[
        AnyPath | None, Option("An earlier result. Its findings are known; only new ones can fail the run.", "DIR")
    ] = None
    waivers: Waivers = None
    today: Today = None
    memory: Memory = None
    rule_timeout: Annotated[
        float,
        Option(
            "Seconds that a rule may compute on a batch of drives. A rule that takes longer is an error; the others continue.",
            "S",
            minimum=0.1,
        ),
    ] = 30.0
    evidence: Evidence = None
    sign: Sign = None
    progress: bool = False


class CheckCommandArguments(CheckArguments):
    """The arguments of `drivelint check` on the command line."""

    format_: Annotated[Format, Option("Format of the output on stdout.", flag="--format", place_after="min_judged")] = (
        "text"
    )
    report: Annotated[
        list[ReportFile] | None,
        Option(
            "With --out: also write this report, as drivelint report does. report.html and junit.xml are always written. Repeatable.",
            "html|junit|sarif|xqar|markdown",
            place_after="format_",
        ),
    ] = None
    verbose: Annotated[bool, Option("Print every table, not only the summary.", flag="--verbose -v")] = False
    jobs: Annotated[
        int,
        Option(
            "Number of processes. Each judges a part of the logs; the result is the same.",
            "N",
            flag="--jobs -j",
            minimum=1,
        ),
    ] = 1
    cache: Annotated[
        bool,
        Option(
            "If logs, map, rules and options are those of an earlier run, write and print the same as it did, without judging. "
            "--no-cache always judges, and keeps no receipt.",
            flag="--cache/--no-cache",
            environment_variable="DRIVELINT_CHECK_CACHE",
        ),
    ] = True
    quiet: Quiet = False
