"""The log of one drive in MCAP or SQLite: one file, or a folder of the files into which `ros2 bag record` splits a log."""

from __future__ import annotations

from collections import Counter
from contextlib import suppress
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Any, Final

from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError
from drivelint.formats.mcap.bag_folder import METADATA_FILE, METADATA_ROOT_KEY, is_bag
from drivelint.formats.mcap.storage import file_index, recorded_file, recorded_span
from drivelint.formats.ros2.messages import DETECTIONS_ROLE, MESSAGE_TYPES, ODOMETRY_ROLE, ROAD_USERS_ROLE, TRANSFORMS
from drivelint.formats.ros2.types import message_kind
from drivelint.phrases import name_list
from drivelint.receipts.events import report_searched_path

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from drivelint.formats.mcap.reader import Container
    from drivelint.formats.mcap.summary import Summary

COMPRESSED_SUFFIX: Final = ".zstd"
"""The end of the names of a bag's files that `ros2 bag record --compression-mode file` has compressed."""
_MOST_TIME_BETWEEN_PARTS_NS: Final = 1_000_000_000
"""A recorder goes on with the next file at once."""
_MOST_LISTED_TOPICS: Final = 8
"""An error lists at most this many topics, and counts the others."""
SUFFIX_BY_STORAGE: Final = {"mcap": ".mcap", "sqlite3": ".db3"}
"""Storage of a bag that is read -> the suffix of its files."""
OSI_SCHEMAS: Final = frozenset({"osi3.GroundTruth", "osi3.SensorView"})
ROS_ROLE_BY_SCHEMA: Final = {name: message.role for name, message in MESSAGE_TYPES.items()}
FOXGLOVE_ROLE_BY_SCHEMA: Final = {
    "foxglove.SceneUpdate": ROAD_USERS_ROLE,
    "foxglove.FrameTransform": "frames",
    "foxglove.FrameTransforms": "frames",
}
"""Schema -> the role of its messages. Schemas of ROS have the names that `message_kind` returns."""


def bag_files(path: Path) -> list[Path]:
    """Return the files of a drive in the order of recording.

    Errors: `TraceError` if a bag's `metadata.yaml` cannot be read, its storage is another, or a file is missing, empty or not listed.
    """
    if not path.is_dir():
        return [path]
    try:
        information = _bag_metadata(path)
        storage, names = information.get("storage_identifier"), information["relative_file_paths"]
    except (KeyError, TypeError, AttributeError) as error:
        raise _metadata_error(path, error) from error
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        raise TraceError(f"{path}: its {METADATA_FILE} lists no files: reindex the bag")
    if storage is not None and storage not in SUFFIX_BY_STORAGE:
        raise _unread_storage_error(path, str(storage))
    if str(information.get("compression_mode")).lower() == "message":
        raise TraceError(
            f"{path}: a bag whose messages are each compressed: convert it with {conversion_command(path)}, and give that"
        )
    files = []
    for name in names:
        file = _bag_file(path, name.removesuffix(COMPRESSED_SUFFIX)) or _bag_file(path, name)
        if file is None:
            raise TraceError(f"{path}: {name}, a part of this bag, is missing: copy the whole folder")
        if file.suffix == COMPRESSED_SUFFIX:
            raise TraceError(
                f"{path}: a bag whose files are compressed: unpack them in its folder with zstd -d {quote(str(file))}"
            )
        if not file.stat().st_size:
            raise TraceError(
                f"{path}: {name}, a part of this bag, is empty (0 bytes): copy it again, or reindex the bag"
            )
        files.append(file)
    suffix = SUFFIX_BY_STORAGE.get(storage, ".mcap")
    if unlisted := sorted(file.name for file in path.glob(f"*{suffix}") if file not in files):
        raise TraceError(
            f"{path}: its {METADATA_FILE} does not list {unlisted[0]}: reindex the bag, or remove the file from its folder"
        )
    return files


def lone_part_findings(path: Path) -> list[QualityFinding]:
    """Return a finding for a file that is a part of a bag, by its name and times, such as `drive_1.mcap`, but has no `metadata.yaml`.

    A recorder writes `metadata.yaml` when it ends, so it is missing after a crash.
    """
    name, _, number = path.stem.rpartition("_")
    if path.is_dir() or not number.isdecimal() or (path.parent / METADATA_FILE).exists():
        return []
    before, after = (path.with_name(f"{name}_{int(number) + step}{path.suffix}") for step in (-1, 1))
    if not (_continues(before, path) or _continues(path, after)):
        return []
    message = (
        f"one of several parts of a bag without {METADATA_FILE}: it is a drive of its own, cut where the part begins and ends: "
        f"to judge the bag as one drive, first run ros2 bag reindex {quote(str(path.parent))}"
    )
    return [QualityFinding("bag_part", "warning", message)]


def _continues(first: Path, second: Path) -> bool:
    """Return whether the second file begins when the first ends; False if a file is missing, or has no index."""
    if not (first.is_file() and second.is_file()):
        return False
    with suppress(TraceError, OSError, ValueError):
        earlier, later = recorded_span(first), recorded_span(second)
        if earlier is not None and later is not None:
            return abs(later[0] - earlier[1]) <= _MOST_TIME_BETWEEN_PARTS_NS
    return False


def _bag_file(folder: Path, name: str) -> Path | None:
    """Return the file of a bag, or None if it is missing."""
    # older recorders list only a file's name, or prefix it with the folder's name
    return next(
        (place for place in (folder / name, folder / name.rsplit("/", 1)[-1]) if report_searched_path(place).is_file()),
        None,
    )


def _unread_storage_error(path: Path, storage: str) -> TraceError:
    """Return the error for a bag, given as its folder, in a storage that is not read, with the command that converts it."""
    return TraceError(
        f"{path}: a bag in {storage}: convert it to MCAP with {conversion_command(path)}, "
        "or with ros2 bag convert and storage_id: mcap, and give the converted bag"
    )


def conversion_command(path: Path) -> str:
    """Return the command that converts a bag, given as its folder or as one of its files, to MCAP without compression."""
    whole = path if path.is_dir() or not is_bag(path.parent) else path.parent
    name = (whole.name if whole.is_dir() else whole.stem) or "bag"
    converted = whole.with_name(f"{name}-mcap") if whole.name else Path(f"{name}-mcap")
    command = f"rosbags-convert --src {quote(str(whole))} --dst {quote(str(converted))} --dst-storage mcap"
    return f"{command} (of PyPI's package rosbags)"


def _bag_metadata(path: Path) -> Any:
    """Return the content of a bag's `metadata.yaml`. Errors: `TraceError` if it cannot be read."""
    import yaml  # imported here, because only bags need it

    try:
        return yaml.safe_load((path / METADATA_FILE).read_bytes())[METADATA_ROOT_KEY]
    except (OSError, yaml.YAMLError, KeyError, TypeError, ValueError, RecursionError) as error:
        raise _metadata_error(path, error) from error


def _metadata_error(path: Path, error: Exception) -> TraceError:
    return TraceError(f"{path}: its {METADATA_FILE} cannot be read ({type(error).__name__}: {error}): reindex the bag")


def missing_message_findings(
    path: Path, parts: Sequence[Container], is_read: Callable[[str, str], bool]
) -> list[QualityFinding]:
    """Return a finding for each topic of which the bag's `metadata.yaml` counts more messages than its files contain.

    `parts`: the bag's files, read to their ends. `is_read`: whether messages of a topic and kind, as `message_kind` returns it, are read.
    If bytes were lost, they explain missing messages, so there is no finding.
    """
    if not path.is_dir() or any(part.losses.has_lost_bytes for part in parts):
        return []
    counts: Counter[str] = Counter()
    for part in parts:
        for number, n in part.counts.by_channel.items():
            counts[part.channels[number].topic] += n
    findings = []
    for topic, kind, n_listed in _topics_with_counts(_bag_metadata(path)):
        if n_listed > counts[topic] and is_read(topic, message_kind(kind)):
            n = n_listed - counts[topic]
            message = f"{METADATA_FILE} counts {n_listed} messages of topic {topic!r}, the bag has {counts[topic]}: {n} are lost"
            findings.append(QualityFinding("index_mismatch", "error", message, n))
    return findings


def _topics_with_counts(metadata: Any) -> Iterator[tuple[str, str, int]]:
    """Yield name, type and number of messages of each topic in a bag's description; skip entries that are not as rosbag2 writes them."""
    topics = metadata.get("topics_with_message_count")
    for entry in topics if isinstance(topics, list) else ():
        match entry:
            case {"topic_metadata": {"name": str(name), "type": str(kind)}, "message_count": int(n)}:
                yield name, kind, n


def message_family(path: Path) -> str:
    """Return the kind of messages in a drive's log: `osi`, `ros2`, `foxglove`, or `none` of them.

    The indexes of the files are searched first. Only if they name no usable schema are the whole files read.
    If a log has several kinds, OSI wins, because it is ground truth.
    """
    parts = bag_files(path)
    for schemas in (_schema_names_in_index, _schema_names_in_data):
        kinds = {message_kind(name) for file in parts for name in schemas(file)}
        if kinds & OSI_SCHEMAS:
            return "osi"
        for name, roles in (("ros2", ROS_ROLE_BY_SCHEMA), ("foxglove", FOXGLOVE_ROLE_BY_SCHEMA)):
            if {roles.get(schema) for schema in kinds} & {ROAD_USERS_ROLE, DETECTIONS_ROLE, ODOMETRY_ROLE}:
                return name
        if TRANSFORMS in kinds:
            return "ros2"  # they may place the ego
    return "none"


def topics_text(path: Path) -> str:
    """Return a clause that lists the topics of a drive's log, and names the guide for messages of other types."""
    has = (
        name_list([f"{kind} on {topic}" for topic, kind in sorted(kinds_by_topic(path).items())], _MOST_LISTED_TOPICS)
        or "no topic"
    )
    return f"the log has {has}; drivelint docs mapping shows how messages of other types become a table"


def kinds_by_topic(path: Path) -> dict[str, str]:
    """Return topic -> kind of its messages, as `message_kind` returns it, for a drive's log.

    Errors: `TraceError` for a damaged file.
    """
    kind_by_topic = {}
    for file in bag_files(path):
        part: Summary | Container = file_index(file)
        if not part.channels:
            part = whole = recorded_file(file)
            for _ in whole.messages():
                pass
        for channel in part.channels.values():
            schema = part.schemas.get(channel.schema_id)
            kind_by_topic[channel.topic] = message_kind(schema.name) if schema else "no schema"
    return kind_by_topic


def _schema_names_in_index(file: Path) -> set[str]:
    """Return the names of the schemas in the file's index; an empty set if the index is missing or damaged."""
    return {schema.name for schema in file_index(file).schemas.values()}


def _schema_names_in_data(file: Path) -> set[str]:
    """Return the names of the schemas in the file's data section. Errors: `TraceError` for a damaged file."""
    container = recorded_file(file)
    for _ in container.messages():
        pass
    return {schema.name for schema in container.schemas.values()}
