"""Formats an inspection as text for the terminal, with one label and text per line."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING, Any, Final

import msgspec
from rich.console import Group
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from drivelint.formats.registry import format_title_and_ego
from drivelint.formats.tables.mapping import GROUP_PLACEHOLDER
from drivelint.phrases import name_list, plural
from drivelint.result.counts import group_rows
from drivelint.result.one_line import nested_texts_on_one_line
from drivelint.result.text import ego_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rich.console import RenderableType

    from drivelint.inspect import model

MAX_LISTED_TEXTS: Final = 12
"""Largest number of lines shown of a list; the JSON has all of them."""
_MAX_LISTED_NAMES: Final = 6
"""Largest number of egos or selectors that a line names; it then states how many more there are."""
_DRAFT_MARK: Final = " (draft)"
_STYLE_BY_SEVERITY: Final = {"error": "bold red", "warning": "yellow", "info": "dim"}
_HIDDEN_NOTE_PREFIX: Final = "read through"
"""Reader notes that begin with these words repeat the content section, so they are not shown."""
_HANDEDNESS_SOURCE_WORDS: Final = {
    "option": "as --handedness says",
    "attribute": "as the map says",
    "junctions": "as the map's junctions are linked",
    "lanes": "as its lanes lie beside each other",
    "traces": "as the log's traffic drives",
    "default": "only by the standard's default: set it with --handedness",
}
"""Source of the handedness (side of the road that is driven on) -> its words."""
Line = tuple[str, Text]


def render(inspection: model.Inspection, trace: str) -> Group:
    """Return the whole inspection as a renderable. `trace`: the log as the user named it."""
    draft = inspection.content.draft_mapping
    inspection = msgspec.convert(nested_texts_on_one_line(msgspec.to_builtins(inspection)), type(inspection))
    lines = [*_content_lines(inspection.content)]
    if inspection.file.drive_id:
        lines.append(("drive", Text(inspection.file.drive_id)))
    if inspection.problem is not None:
        lines.append(("problem", Text(f"cannot be read as a drive: {inspection.problem}", "bold red")))
    if inspection.drive is not None:
        lines += _drive_lines(inspection.drive)
    parts: list[RenderableType] = [_title_text(inspection), _table_of_lines(lines)]
    if inspection.drive is not None:
        parts.append(_decidable_rules(inspection.drive, inspection.file.name))
    if draft is not None:
        save = f"Save it as my.toml, then: drivelint inspect {shlex.quote(trace)} --mapping my.toml"
        parts += [
            Text(f"A mapping states the meaning of each column. This is a draft; check it line by line:\n\n{draft}"),
            Text(save, style="bold"),
        ]
    return Group(*(Padding(part, (0, 0, 1, 0)) for part in parts))


def _title_text(inspection: model.Inspection) -> Text:
    file = inspection.file
    about = [_size_text(file.bytes)]
    if file.format is not None:
        words = format_title_and_ego(file.format)
        about.insert(0, words[0] if words else f"a table, read through the mapping {file.format}")
    return Text(file.name, style="bold").append(f"  {', '.join(about)}", style="default")


def _size_text(n_bytes: int) -> str:
    for unit, factor in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if n_bytes >= factor:
            return f"{n_bytes / factor:.1f} {unit}"
    return plural(n_bytes, "byte")


def _table_of_lines(lines: Sequence[Line]) -> Table:
    """Return a table of labels and texts; a label that repeats the previous one is not shown."""
    grid = _empty_label_table("bold", no_wrap=True)
    previous = None
    for label, text in lines:
        grid.add_row("" if label == previous else label, text)
        previous = label
    return grid


def _empty_label_table(label_style: str, **label_options: Any) -> Table:
    """Return an empty table with a column of labels in this style, and a column of texts."""
    grid = Table.grid(padding=(0, 2, 0, 0))
    grid.add_column(style=label_style, **label_options)
    grid.add_column(overflow="fold", ratio=1)
    return grid


def _first_lines(label: str, texts: Sequence[Text]) -> Iterator[Line]:
    """Yield the first `MAX_LISTED_TEXTS` texts, and a line with the number of further texts."""
    for text in texts[:MAX_LISTED_TEXTS]:
        yield label, text
    if len(texts) > MAX_LISTED_TEXTS:
        yield label, Text(f"and {len(texts) - MAX_LISTED_TEXTS} more", style="dim")


def _content_lines(content: model.Content) -> Iterator[Line]:
    for channel in content.channels:
        yield "channels", _channel_text(channel)
    if len(content.sheets) > 1:
        yield "tables", Text(", ".join(f"{s.name} ({plural(s.rows or 0, 'row')})" for s in content.sheets if s.rows))
    for sheet in content.sheets if len(content.sheets) == 1 else ():
        yield "table", _sheet_text(sheet)
    for note in content.notes:
        if not note.startswith(_HIDDEN_NOTE_PREFIX):
            yield "note", Text(note)


def _channel_text(channel: model.Channel) -> Text:
    text = Text(channel.topic)
    rate = "" if channel.rate_hz is None else f", {channel.rate_hz:.3g} Hz"
    kind = f"{channel.schema or 'no schema'} in {channel.encoding or 'no encoding'}"
    text.append(f": {plural(channel.messages, 'message')} of {kind}{rate}, {_size_text(channel.bytes)}")
    text.append(
        f", read as {channel.read_as}" if channel.read_as else ", not read", "green" if channel.read_as else "dim"
    )
    return text


def _sheet_text(sheet: model.Sheet) -> Text:
    rows = "" if sheet.rows is None else f"{plural(sheet.rows, 'row')}, "
    columns = [c for c in sheet.columns if c.read_as]
    if not columns:
        names = [c.name for c in sheet.columns]
        return Text(f"{sheet.name}: {rows}{plural(len(names), 'column')}: {name_list(names, MAX_LISTED_TEXTS)}")
    per_actor = any(GROUP_PLACEHOLDER in c.name for c in sheet.columns)
    whole = f"{rows}{len(columns)} of {plural(len(sheet.columns), 'column')}{' per actor' if per_actor else ''}"
    text = Text(f"{whole} read: {', '.join(_column_text(column, per_actor=per_actor) for column in columns)}")
    if unread := [c.name for c in sheet.columns if not c.read_as]:
        names = [name.replace(GROUP_PLACEHOLDER, "").lstrip("# ") for name in unread]
        text.append(f"; not read: {name_list(names, MAX_LISTED_TEXTS)}", style="dim")
    return text


def _column_text(column: model.Column, *, per_actor: bool) -> str:
    """Return the quantity that a column is read as. The column's name is added if it differs, except in a wide table."""
    meaning = " and ".join(column.read_as)
    unit = f" in {column.unit}" if column.unit else ""
    return f"{meaning}{unit}" if per_actor or meaning == column.name else f"{column.name}{unit} as {meaning}"


def _drive_lines(drive: model.Drive) -> Iterator[Line]:
    clock = drive.clock
    period = "" if clock.period_s is None else f", one every {clock.period_s:.4g} s ({1 / clock.period_s:.3g} Hz)"
    time = Text(f"{clock.duration_s:.2f} s, {plural(clock.steps, 'step')}{period}, ")
    holes = f"{plural(clock.holes, 'hole')}, the longest {clock.longest_hole_s or 0.0:.2f} s, "
    holes += f"the first at {clock.first_hole_at_s or 0.0:.2f} s"
    time.append(holes if clock.holes else "no holes", style="yellow" if clock.holes else "green")
    yield "time", time.append("" if clock.utc_start is None else f", from {clock.utc_start}")
    total = sum(c.n for c in drive.classes)
    yield "actors", Text(f"{plural(total, 'actor')}, {plural(drive.states, 'state')}")
    for count in drive.classes:
        sized = "sizes known" if count.sized == count.n else f"size known of {count.sized}"
        line = Text(
            f"{plural(count.n, count.actor_class or 'actor of unknown class')}: {count.moving or 'none'} moving, "
        )
        yield "actors", line.append(sized, style="" if count.sized == count.n else "yellow")
    yield from _ego_lines(drive)
    yield from _map_lines(drive)
    yield from _quality_lines([q for q in drive.quality if q.check_id != "no_ego"])


def _ego_lines(drive: model.Drive) -> Iterator[Line]:
    if not drive.egos:
        why = drive.ego_source.removeprefix("no ego: ")
        yield "ego", Text(f"none: {why}. The longest way first:", style="yellow")
        yield from _first_lines("ego", [Text(f"--ego {a.actor_id}  {_actor_text(a)}") for a in drive.candidates])
        return
    egos = [Text(f"{ego.actor.actor_id}: {_actor_text(ego.actor)}") for ego in drive.egos]
    if len(egos) == 1:
        yield "ego", egos[0].append(f"; {drive.ego_source}")
        return
    yield "egos", Text(f"{len(egos)}: {drive.ego_source}")
    yield from _first_lines("egos", egos)


def _actor_text(actor: model.Actor) -> str:
    box = "size unknown"
    if actor.length_m is not None and actor.width_m is not None:
        box = f"{actor.length_m:.2f} x {actor.width_m:.2f} m"
    way = f"{actor.way_m / 1000:.2f} km" if actor.way_m >= 1000 else f"{actor.way_m:.0f} m"
    speed = "" if actor.top_speed_mps is None else f", up to {actor.top_speed_mps:.1f} m/s"
    span = f"from {actor.first_at_s:.1f} to {actor.last_at_s:.1f} s"
    return f"{actor.actor_class or 'class unknown'}, {box}, {way}{speed}, {span}"


def _map_lines(drive: model.Drive) -> Iterator[Line]:
    road = drive.road
    if road is None:
        why = drive.road_problem or "none: rules about the road cannot be decided; name a map with --map"
        yield "map", Text(why, style="bold red" if drive.road_problem else "yellow")
        return
    yield "map", _map_text(road)
    about = drive.egos or ([drive.supposed] if drive.supposed else [])
    fits = [(ego, ego.registration) for ego in about if ego.registration is not None]
    if len(fits) == 1:
        yield "fit", _map_fit_text(fits[0][1])
        return
    bad = [(ego, fit) for ego, fit in fits if not fit.ok or fit.aside]
    good = len(fits) - len(bad)
    share = "none" if not good else f"{good} of {len(fits)}" if bad else "all"
    yield "fit", Text(f"{share} of the egos lie well on the map", style="yellow" if bad else "green")
    yield from _first_lines(
        "fit", [Text(f"{ego_name(ego.actor.actor_id)}: ").append_text(_map_fit_text(fit)) for ego, fit in bad]
    )


def _map_text(road: model.Road) -> Text:
    text = Text("the log's own" if road.source == "log" else road.name)
    text.append(f": {plural(road.lanelets, 'lanelet')}, {road.drivable} of them for driving, {road.drivable_km:.2f} km")
    if any(road.offset_m):
        text.append(f", moved by ({road.offset_m[0]:+g}, {road.offset_m[1]:+g}) m")
    side = f"{'left' if road.handedness == 'lht' else 'right'}-hand traffic"
    source = _HANDEDNESS_SOURCE_WORDS.get(road.handedness_source, road.handedness_source)
    return text.append(f"; {side}, {source}", style="yellow" if road.handedness_source == "default" else "")


def _map_fit_text(fit: model.MapRegistration) -> Text:
    if not fit.ok:
        return Text(fit.reason, style="bold yellow")
    off = "" if fit.lateral_median_m is None else f", {fit.lateral_median_m:.2f} m from its middle (median)"
    if fit.aside:
        return Text(f"{fit.reason}{off}: the map may be shifted: correct it with --map-offset", style="bold yellow")
    return Text(f"{fit.reason}{off}", style="green")


def _quality_lines(findings: Sequence[model.Quality]) -> Iterator[Line]:
    if not any(q.severity != "info" for q in findings):
        yield "data", Text("no problem found", style="green")
    yield from _first_lines("data", [_finding_text(finding) for finding in findings])


def _finding_text(finding: model.Quality) -> Text:
    about, info = "map: " if finding.about == "map" else "", finding.severity == "info"
    at = "" if finding.first_at_s is None or info else f" (first at {finding.first_at_s:.2f} s)"
    text = Text(f"{finding.severity}: ", style=_STYLE_BY_SEVERITY[finding.severity])
    return text.append(f"{about}{finding.message}{at}", style="dim" if info else "default")


def _decidable_rules(drive: model.Drive, log: str) -> Group:
    """Return the rules that can and cannot be decided for each ego; egos with the same missing signals share a paragraph."""
    egos_told = drive.egos or ([drive.supposed] if drive.supposed else [])
    alike = group_rows(egos_told, lambda ego: tuple(item.signal for item in ego.missing_signals))
    parts: list[RenderableType] = []
    for egos in sorted(alike.values(), key=lambda group: -len(group[0].can)):
        parts += _decidable_rules_of_egos(drive, egos, log)
    return Group(*parts)


def _decidable_rules_of_egos(drive: model.Drive, egos: list[model.Ego], log: str) -> list[RenderableType]:
    ego, n = egos[0], len(drive.rules)
    selection = name_list(drive.selection, _MAX_LISTED_NAMES)
    egos_text = ""
    if not drive.egos:
        egos_text = f" with --ego {ego.actor.actor_id}"
    elif len(drive.egos) > 1:
        egos_text = f" for {'ego' if len(egos) == 1 else 'egos'} {name_list([e.actor.actor_id for e in egos], _MAX_LISTED_NAMES)}"
    style = "bold green" if len(ego.can) == n else "bold yellow" if ego.can else "bold red"
    parts: list[RenderableType] = [
        Text(f"{log} can decide {_decidable_count_text(ego, drive, selection)}{egos_text}.", style=style)
    ]
    if ego.can:
        rule_names = (f"{_short_rule_id(rule, drive)}{_DRAFT_MARK if rule in drive.drafts else ''}" for rule in ego.can)
        parts.append(Text(f"It can: {', '.join(rule_names)}.", style="dim"))
    if ego.missing_signals:
        parts += [Text("\nTo decide more, provide:", style="bold"), _missing_signals_table(ego)]
        parts += [
            Text("\nRules and the signals that they need:", style="bold"),
            _undecided_rules_table(ego, drive.drafts),
        ]
    return parts


def _decidable_count_text(ego: model.Ego, drive: model.Drive, selection: str) -> str:
    """Return in words how many rules can be decided; drafts are counted separately from the rules that `check` runs by default."""
    n, n_drafts = len(drive.rules), len(drive.drafts)
    if not n_drafts:
        return f"{len(ego.can)} of {n} rules ({selection})"
    can = len(set(ego.can) & set(drive.drafts))
    run = f"{len(ego.can) - can} of the {n - n_drafts} rules that check runs ({selection})"
    return f"{run}, and {can} of {n_drafts} drafts (--rules {selection})"


def _short_rule_id(rule_id: str, drive: model.Drive) -> str:
    """Return a rule's id; without its pack if all requested rules are of one pack."""
    packs = {rule.partition(".")[0] for rule in drive.rules}
    return rule_id.partition(".")[2] if len(packs) == 1 else rule_id


def _missing_signals_table(ego: model.Ego) -> Table:
    grid = _empty_label_table("yellow", overflow="fold")
    for item in ego.missing_signals:
        waiting = f"{plural(len(item.rules), 'rule')} wait{'s' if len(item.rules) == 1 else ''} for it"
        alone = ""
        if len(item.alone) < len(item.rules):
            alone = f", {len(item.alone)} of them for nothing else" if item.alone else ", and for something else too"
        text = Text(item.provide)
        text.append(f"\nNow: {item.reason}. {waiting}{alone}.", style="dim")
        grid.add_row(item.signal, text)
    return grid


def _undecided_rules_table(ego: model.Ego, drafts: Sequence[str]) -> Table:
    """Return a table of the undecidable rules, with one row per set of missing signals."""
    grid = _empty_label_table("yellow", overflow="fold")
    waiting = group_rows(ego.cannot, lambda rule: tuple(rule.missing_signals))
    for signals, rules in sorted(waiting.items(), key=lambda item: (-len(item[1]), item[0])):
        ids = (
            f"{rule.rule_id}{_DRAFT_MARK if rule.rule_id in drafts else ''}{' (can be broken, not kept)' if rule.breach_only else ''}"
            for rule in rules
        )
        grid.add_row(" + ".join(signals), Text(", ".join(ids)))
    return grid
