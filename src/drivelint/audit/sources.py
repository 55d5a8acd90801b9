"""Lists the drives of an audit: the rows of a manifest, or the logs of files, globs, folders and buckets."""

from __future__ import annotations

import math
import re
from dataclasses import fields, replace
from difflib import get_close_matches
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

from drivelint.audit.bucket import download, find_object, is_url, list_objects
from drivelint.audit.model import AuditDrive
from drivelint.drive import conditions
from drivelint.drive.conditions import RULE_CONDITION_VALUES
from drivelint.drive.trace import DriveInput
from drivelint.errors import TraceError, UsageError
from drivelint.formats import expand_traces
from drivelint.formats.files import TRACE_SUFFIXES, is_log_name, is_utf8
from drivelint.phrases import hint, name_list

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

OPTION_COLUMNS: Final = ("log", "map", "ego", "environment", "handedness", "mapping", "topic")
"""Columns of a manifest that are options, not tags: the log, its map, its ego, conditions (`weather=wet;light=night`), and other
options."""
_HANDEDNESS_VALUES: Final = ("auto", "lht", "rht")
_MANIFEST_ONLY_COLUMNS: Final = frozenset({"map", "environment", "handedness", "mapping"})
"""Columns that a manifest may have, but no table of states."""
_LEAST_NUMERIC_COLUMNS_OF_STATES: Final = 3
"""A row of a table of states has at least this many numbers: a time and two coordinates."""
_SAMPLE_LINES: Final = 100
_LEAST_SIMILARITY_FOR_HINT: Final = 0.8
"""From this similarity on, the name of a tag counts as a misspelt column: `maps` does, `lap` does not."""
_MANIFEST_BATCH_ROWS: Final = 10_000


def drives(sources: Sequence[str], options: DriveInput) -> Iterator[AuditDrive]:
    """Yield the drives of the sources. `options` apply to each drive, unless the manifest overrides them.

    A Parquet or CSV file with a column `log` is a manifest. It may be of any length, and its paths are relative to its folder. All other
    sources are the same as for `check`.
    Errors: `UsageError` for an invalid manifest, `TraceError` for a missing source.
    """
    conditions.parse_env_settings(options.env)
    logs: list[str] = []
    for source in sources:
        if is_url(source):
            yield from _drives_in_bucket(source, options)
        elif _is_manifest(Path(source), with_mapping=options.mapping is not None):
            yield from _drives_of_manifest(Path(source), source, options)
        else:
            logs.append(source)
    if logs:
        for path in expand_traces(logs, map_path=options.map):
            if not is_utf8(str(path)):
                raise UsageError(f"{path}: its name is not UTF-8, which results need: rename it")
            yield AuditDrive(str(path), options)


def expand_manifests(
    traces: Sequence[str], options: DriveInput, note: Callable[[str], object] = lambda _: None
) -> tuple[tuple[str, ...], dict[Path, DriveInput]]:
    """Return the logs that `check` has to judge, and the options of logs that a manifest names. Each manifest in `traces` is replaced by
    its logs.

    `note` receives warnings about columns that may be misspelt. Here, a manifest is one Parquet or CSV file whose column `log` contains an
    existing log: a table of states may have any columns. Errors: `UsageError` as in `drives`, and for a log in two rows with different
    options, because a check has one result per log.
    """
    plain = DriveInput(**{field.name: getattr(options, field.name) for field in fields(DriveInput)})
    logs: list[str] = []
    options_by_path: dict[Path, DriveInput] = {}
    for trace in traces:
        if not _is_manifest_of_existing_logs(Path(trace)):
            logs.append(trace)
            continue
        for text in tag_warnings(
            [name for name in next(_manifest_rows(Path(trace)), {}) if name not in OPTION_COLUMNS]
        ):
            note(text)
        for drive in _drives_of_manifest(Path(trace), trace, plain):
            if options_by_path.setdefault(Path(drive.log), drive.options) != drive.options:
                raise UsageError(
                    f"{trace}: names {drive.log} twice, with different options: drivelint audit judges it with both"
                )
            logs.append(drive.log)
    return tuple(logs), options_by_path


def tag_warnings(tag_names: Sequence[str]) -> Iterator[str]:
    """Yield warnings about tags whose name is a condition, or is similar to an option column."""
    if of_conditions := name_list([f"column {name}" for name in tag_names if name in RULE_CONDITION_VALUES]):
        yield f"the manifest's {of_conditions} is only a tag: conditions of a drive stand in the column environment, such as weather=wet"
    for name in tag_names:
        text = name.casefold()
        # swapping two letters of a short name lowers the similarity below that of `lap` and `map`
        turned = [column for column in OPTION_COLUMNS if column != text and sorted(column) == sorted(text)]
        for candidate in (*turned, *get_close_matches(text, OPTION_COLUMNS, n=1, cutoff=_LEAST_SIMILARITY_FOR_HINT))[
            :1
        ]:
            yield f"the manifest's column {name} is only a tag: did you mean {candidate}?"


def _is_manifest_of_existing_logs(path: Path) -> bool:
    if not path.is_file() or path.suffix.lower() not in {".parquet", ".csv"}:
        return False
    try:
        first = next(_manifest_rows(path), {})
    except UsageError:
        return False  # the reader of logs reports why it is no log either
    name = first.get("log", "")
    return bool(name) and (is_url(name) or _exists(path.parent / name))


def _drives_in_bucket(url: str, options: DriveInput) -> Iterator[AuditDrive]:
    """Yield the drives below a URL prefix, or of a manifest in the object store."""
    manifest = find_object(url) if url.lower().endswith((".parquet", ".csv")) else None
    if manifest is not None:
        with TemporaryDirectory(prefix="drivelint-manifest-") as home:
            copy = download(manifest, Path(home))
            if _is_manifest(copy, with_mapping=options.mapping is not None):
                yield from _drives_of_manifest(copy, url, options)
                return
    remote_objects = [manifest] if manifest is not None else list_objects(url)
    n = 0
    for remote in remote_objects:
        if is_log_name(remote.url):
            n += 1
            yield AuditDrive(remote.url, options, {}, remote.size, remote.e_tag)
    if not n:
        raise TraceError(
            f"{url}: no log below this prefix (looked for {', '.join(sorted(TRACE_SUFFIXES))}): check the URL"
        )


def _is_manifest(path: Path, *, with_mapping: bool) -> bool:
    """Return whether a file is a manifest.

    Errors: `UsageError` for a file that is neither a manifest with a column `log` nor a table of states; `TraceError` for an unreadable
    file. With a mapping, every table without a column `log` counts as a log, even if cells are empty.
    """
    if not path.is_file() or path.suffix.lower() not in {".parquet", ".csv"}:
        return False
    try:
        if path.suffix.lower() == ".parquet":
            names = pq.read_schema(path).names
        else:
            with path.open(encoding="utf-8-sig", errors="replace") as file:
                names, cells = (re.split(r"[,\r\n]", file.readline(65536).replace('"', "")) for _ in range(2))
    except (OSError, ValueError) as error:
        raise TraceError(f"{path}: cannot be read: {error}: copy it again, or check its permissions") from error
    if "log" in names:
        return True
    first = _first_row(path) if path.suffix.lower() == ".parquet" else dict(zip(names, cells, strict=False))
    for name, value in first.items():  # a table of states has numbers and actors, but no paths of logs
        text = str(value)
        is_name = "/" in text or text.lower().endswith(tuple(TRACE_SUFFIXES))
        if is_name and name not in OPTION_COLUMNS and (is_url(text) or _exists(path.parent / text)):
            raise UsageError(
                f"{path}: a manifest needs a column log: its column {name!r} names logs: rename that column to log"
            )
    if not with_mapping and (not _MANIFEST_ONLY_COLUMNS.isdisjoint(names) or not _may_have_actor_states(path)):
        apart = "; separate them by commas" if re.search(r"[;\t]", "".join(names)) else ""
        raise UsageError(
            f"{path}: a manifest needs a column log: its columns are {name_list([name for name in names if name], 6)}{apart}"
        )
    return False


def _may_have_actor_states(path: Path) -> bool:
    """Return whether a table can contain states: the Parquet types, or one of the first rows of a CSV, must allow a time and a position.

    A CSV without rows counts as yes.
    """
    if path.suffix.lower() == ".parquet":
        types = [field.type for field in pq.read_schema(path)]
        numbers = sum(pa.types.is_primitive(kind) and not pa.types.is_boolean(kind) for kind in types)
        return numbers >= _LEAST_NUMERIC_COLUMNS_OF_STATES or any(map(pa.types.is_nested, types))
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        some = [re.split(r"[,;\t]", line) for line in islice(file, 1, _SAMPLE_LINES)]
    rows = [row for row in some if any(cell.strip() for cell in row)]
    return not rows or any(sum(map(_is_number, row)) >= _LEAST_NUMERIC_COLUMNS_OF_STATES for row in rows)


def _is_number(cell: str) -> bool:
    try:
        return math.isfinite(float(cell))
    except ValueError:
        return False


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # not a valid file name
        return False


def _first_row(path: Path) -> dict[str, Any]:
    """Return the first row of a Parquet file; empty if there is no row, or if the file is damaged, which the reader of logs reports."""
    try:
        with pq.ParquetFile(path) as file:
            batch = next(file.iter_batches(1), None)
            return batch.to_pylist()[0] if batch is not None and batch.num_rows else {}
    except (OSError, ValueError):
        return {}


def _drives_of_manifest(path: Path, manifest_name: str, options: DriveInput) -> Iterator[AuditDrive]:
    for number, row in enumerate(_manifest_rows(path), start=1):
        log = row.pop("log")
        if not log:
            raise UsageError(f"{manifest_name}, row {number}: no log: fill the column log")
        try:
            _require_valid_options(row, options)
        except UsageError as error:
            raise UsageError(f"{manifest_name}, row {number} ({log}): {error}: nothing was judged yet") from error
        own_options: dict[str, Any] = {}
        if place := row.pop("map", None):
            own_options |= {"map": Path(_resolve_path(manifest_name, place)), "map_dir": None}
        if ego := row.pop("ego", None):
            own_options["ego"] = ego
        if env := row.pop("environment", None):
            own_options["env"] = (*options.env, *_split_conditions(env))
        if (mapping := row.pop("mapping", None)) and (Path(path).parent / mapping).is_file():
            mapping = _resolve_path(manifest_name, mapping)
        cells = {"mapping": mapping, "handedness": row.pop("handedness", None), "topic": row.pop("topic", None)}
        own_options |= {name: value for name, value in cells.items() if value}
        tags = {name: value for name, value in sorted(row.items()) if value}
        yield AuditDrive(_resolve_path(manifest_name, log), replace(options, **own_options), tags)


def _require_valid_options(row: Mapping[str, str], options: DriveInput) -> None:
    """Raise `UsageError` for option values of a row that are invalid, before any drive is judged."""
    try:
        conditions.parse_env_settings((*options.env, *_split_conditions(row.get("environment", ""))))
    except UsageError as error:
        raise UsageError(str(error).replace("--env", "environment", 1)) from error
    side = row.get("handedness", "")
    if side and side not in _HANDEDNESS_VALUES:
        raise UsageError(f"handedness {side!r}: {hint(side, _HANDEDNESS_VALUES)}")


def _split_conditions(environment: str) -> tuple[str, ...]:
    return tuple(part.strip() for part in environment.split(";") if part.strip())


def _manifest_rows(path: Path) -> Iterator[dict[str, str]]:
    """Yield the rows of a manifest with all cells as text; a missing cell is ''."""
    try:
        if path.suffix.lower() == ".parquet":
            with path.open("rb") as source, pq.ParquetFile(source) as file:
                for batch in file.iter_batches(_MANIFEST_BATCH_ROWS):
                    yield from _rows_as_text(batch.to_pylist())
        else:
            with path.open("rb") as source, pa_csv.open_csv(source) as reader:
                for batch in reader:
                    yield from _rows_as_text(batch.to_pylist())
    except (OSError, ValueError) as error:
        raise UsageError(f"{path}: not a manifest that can be read: {error}") from error


def _rows_as_text(rows: list[dict[str, Any]]) -> Iterator[dict[str, str]]:
    for row in rows:
        yield {name: "" if value is None else str(value) for name, value in row.items()}


def _resolve_path(manifest: str, place: str) -> str:
    """Return a path in a manifest, resolved against the manifest's folder; a URL or an absolute path stays unchanged."""
    if is_url(place):
        return place
    if is_url(manifest):
        return f"{manifest.rpartition('/')[0]}/{place}"
    return str(Path(manifest).parent / place)
