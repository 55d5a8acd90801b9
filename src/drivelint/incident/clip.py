"""Cuts a clip out of the log around a finding, long enough that the clip alone gives the same finding, and converts it."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

import pyarrow.compute as pc

from drivelint.convert import Clip, convert
from drivelint.drive.trace import DriveInput
from drivelint.engine.batch import drive_with_map
from drivelint.engine.map_library import MapLibrary
from drivelint.errors import DriveLintError, UsageError
from drivelint.formats import expand_traces, read_trace
from drivelint.formats.files import identify
from drivelint.incident.command import rule_ids_named_by_user, rule_selection_options
from drivelint.incident.finding import named_finding
from drivelint.incident.judge import Judge, matching_finding
from drivelint.result import request as run_request
from drivelint.result.load import load_result

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.convert import ConvertedTrace, ConvertRequest
    from drivelint.incident.finding import NamedFinding
    from drivelint.result.request import RunRequest

TRIED_PADDINGS_S: Final = ((15, 7), (30, 15), (60, 60))
"""Seconds before the first and after the last failing step, tried in this order; then the whole log."""
_NS_PER_S: Final = 1_000_000_000
_OPTIONS_IN_CONVERTED_LOG: Final = ("map", "map_dir", "map_offset", "mapping", "topic", "ego_size")
"""Options whose effects a converted log already contains."""


def write_clip(request: ConvertRequest, finding_name: str, result_folder: Path, memory: int | None) -> ConvertedTrace:
    """Convert the part of a log around a finding of a result, with the options of the result's run unless the request sets them.

    Errors: `UsageError` if the finding does not exist, the log is another log, or even the whole log does not give the finding again;
    the errors of `convert`.
    """
    result = load_result(result_folder)
    finding = named_finding(result, finding_name)
    run_options = run_request.load(result_folder).of_drive(finding.row["drive_id"])
    request = _request_with_run_options(request, run_options, finding)
    rule = result.rules.filter(pc.equal(result.rules["rule_id"], finding.row["rule_id"]))
    judge = Judge.of_run(run_options, rule, memory)
    for before_s, after_s, clip in _clips_to_try(finding):
        with TemporaryDirectory(prefix="drivelint-") as place:
            tried = convert(replace(request, out=Path(place) / "clip", clip=clip))
            same = _gives_finding(tried.path, run_options, finding, judge)
        if same:
            written_clip = convert(replace(request, clip=clip))
            notes = (*written_clip.notes, _clip_sentence(finding, clip, before_s, after_s))
            options = rule_selection_options(
                run_options, result.rules["rule_id"].to_pylist(), rule_ids_named_by_user(result.rules)
            )
            return replace(written_clip, notes=notes, check_options=tuple(options))
    raise UsageError(
        f"finding {finding.row['finding_id']}: judging the whole log again does not give this finding: the tool, the rule or an option "
        "has changed: check the drive again"
    )


def _request_with_run_options(
    request: ConvertRequest, run_options: RunRequest, finding: NamedFinding
) -> ConvertRequest:
    """Return the request with the finding's ego, and with the run's options that the request does not set. Errors: `UsageError`."""
    paths = expand_traces([request.trace])
    if len(paths) == 1 and identify(paths[0]).sha256 != finding.drive["sha256"]:
        raise UsageError(f"{paths[0]} differs from {finding.drive['file_name']}, the log of the finding: give that log")
    unset = {field.name: field.default for field in fields(DriveInput)}
    set_options = {name for name, default in unset.items() if getattr(request, name) != default}
    # if the request sets map or map_dir, the run's other option of the two does not apply
    set_options |= {"map", "map_dir"} if set_options & {"map", "map_dir"} else set()
    options = {name: getattr(run_options, name) for name in unset if name not in set_options}
    return replace(request, **{**options, "ego": finding.row["ego_id"] or None})


def _clips_to_try(finding: NamedFinding) -> Iterator[tuple[float | None, float | None, Clip]]:
    """Yield the clips to try, each longer than the one before, with the seconds before and after the finding; None: the whole log."""
    name = f"{Path(finding.drive['file_name']).stem}-clip-{finding.row['finding_id'][:8]}"
    start, end = finding.row["t_start_ns"], finding.row["t_end_ns"]
    first = finding.drive_start_ns
    last = first + round((finding.drive["duration_s"] or 0.0) * _NS_PER_S)
    for before_s, after_s in TRIED_PADDINGS_S:
        clip = Clip(name, max(start - before_s * _NS_PER_S, first), min(end + after_s * _NS_PER_S, last))
        if (clip.from_ns, clip.to_ns) == (first, last):
            break
        yield before_s, after_s, clip
    yield None, None, Clip(name, first, last)


def _gives_finding(path: Path, run_options: RunRequest, finding: NamedFinding, judge: Judge) -> bool:
    """Return whether a clip gives the finding: same rule, profile, object, worst step and margin."""
    defaults: dict[str, Any] = {
        field.name: field.default for field in fields(DriveInput) if field.name in _OPTIONS_IN_CONVERTED_LOG
    }
    options = replace(run_options, **{**defaults, "ego": finding.row["ego_id"] or None})
    try:
        drive = drive_with_map(read_trace(path, options.ingest_options()), MapLibrary(options))
        ego_rows = judge.judge(drive, finding.row["ego_id"], finding.row["object_id"])
    except DriveLintError:
        return False  # a longer clip may succeed
    return matching_finding(ego_rows.findings, finding.row) is not None


def _clip_sentence(finding: NamedFinding, clip: Clip, before_s: float | None, after_s: float | None) -> str:
    """Return the span of the clip in one sentence."""
    from_s, to_s = ((t_ns - finding.drive_start_ns) / _NS_PER_S for t_ns in (clip.from_ns, clip.to_ns))
    row = finding.row
    if before_s is None:
        span = "the whole log, because no shorter part that was tried gives the finding"
        whole = (row["t_start_ns"] - clip.from_ns, clip.to_ns - row["t_end_ns"])
        if whole[0] <= TRIED_PADDINGS_S[0][0] * _NS_PER_S and whole[1] <= TRIED_PADDINGS_S[0][1] * _NS_PER_S:
            span = "the whole log, which is not longer than this"
    else:
        span = f"{before_s:g} s before to {after_s:g} s after the finding"
        if (before_s, after_s) != TRIED_PADDINGS_S[0]:
            span += f", because {TRIED_PADDINGS_S[0][0]} s and {TRIED_PADDINGS_S[0][1]} s do not give it"
    return (
        f"the clip is {from_s:.2f} s to {to_s:.2f} s of the drive ({span}); judged by itself, it gives the same finding of "
        f"{row['rule_id']}; its other findings, and all ids, may differ: drivelint docs convert says why"
    )
