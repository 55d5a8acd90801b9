"""One drive, its road and a pack of rules in which every word is a stranger's."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, NamedTuple

import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq
from mcap.reader import make_reader
from mcap.writer import Writer

from tests.hostile.words import EGO, EVIL, FILE, LONG, ONCOMING, TOO_LONG
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

OVERTAKE = ROOT / "fixtures" / "overtake"
SCENE = ROOT / "fixtures" / "scenes" / "collision.mcap"


class Files(NamedTuple):
    log: Path
    road: Path
    mapping: Path
    rules: Path

    @property
    def options(self) -> list[str]:
        return ["--map", str(self.road), "--mapping", str(self.mapping), "--rules-dir", str(self.rules)]


def write(folder: Path) -> Files:
    """Write the overtake that ends in a contact, with these names."""
    rows = pyarrow.csv.read_csv(OVERTAKE / "collision.csv").to_pydict()
    names = {"ego": EGO, "oncoming": ONCOMING, "parked": LONG}
    rows["actor"] = [names[name] for name in rows["actor"]]
    files = Files(folder / f"{FILE}.parquet", folder / f"{FILE}.xodr", folder / "mapping.toml", folder / "rules")
    pq.write_table(pa.table(rows), files.log)
    files.road.write_bytes((OVERTAKE / "road.xodr").read_bytes())
    mapping = (OVERTAKE / "mapping.toml").read_text(encoding="utf-8")
    mapping = mapping.replace('ids = ["ego"]', f"ids = [{json.dumps(EGO)}]")
    files.mapping.write_text(mapping.replace("The overtake fixture", json.dumps(EVIL)[1:-1]), encoding="utf-8")
    pack = files.rules / "evil"
    pack.mkdir(parents=True)
    (pack / "near.sql").write_text(RULE, encoding="utf-8")
    (pack / "unknown.sql").write_text(RULE.replace("clearance_m AS observed", "NULL AS observed"), encoding="utf-8")
    (pack / "pack.toml").write_text(f"title = {_TOML}\n", encoding="utf-8")
    return files


_TOML = json.dumps(f"Title {EVIL}").replace("\x7f", "\\u007f")
RULE = f"""-- title = {_TOML}
-- clause = {_TOML}
-- hypothesis = {_TOML}
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = ">"
-- unit = {_TOML}
-- observes = {_TOML}
-- near_margin = 0.5
-- reads = ["pair"]
-- requires = ["ego_size"]
--
-- [params.near_m]
-- default = 3.0
-- unit = {_TOML}
-- why = {_TOML}
-- source = {_TOML}
--
-- [params.word]
-- default = {_TOML}
-- unit = {_TOML}
-- why = {_TOML}

-- @applies
SELECT drive_id, ego_id, t_ns, object_id, clearance_m < 1 AS applies FROM pair

-- @condition
-- $word
SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, $near_m AS required, $word AS reason FROM pair
"""


def write_mcap(path: Path) -> None:
    """Copy a scene with a channel, a schema, metadata and an attachment beside it that a stranger named."""
    with SCENE.open("rb") as source, path.open("wb") as target:
        reader, writer = make_reader(source), Writer(target)
        writer.start(profile=EVIL, library=EVIL)
        schema_ids: dict[int, int] = {}
        channel_ids: dict[int, int] = {}
        for schema, channel, message in reader.iter_messages():
            if schema is not None and schema.id not in schema_ids:
                schema_ids[schema.id] = writer.register_schema(schema.name, schema.encoding, schema.data)
            if channel.id not in channel_ids:
                schema_id = 0 if schema is None else schema_ids[schema.id]
                channel_ids[channel.id] = writer.register_channel(
                    channel.topic, channel.message_encoding, schema_id, channel.metadata
                )
                writer.register_channel(f"/{TOO_LONG}", "json", 0, {TOO_LONG: TOO_LONG})
                hostile = writer.register_channel(
                    f"/{EVIL}", EVIL, writer.register_schema(EVIL, EVIL, b""), {EVIL: EVIL}
                )
                writer.add_message(hostile, message.log_time, EVIL.encode(), message.publish_time)
            writer.add_message(channel_ids[channel.id], message.log_time, message.data, message.publish_time)
        for record in reader.iter_metadata():
            writer.add_metadata(record.name, record.metadata)
        writer.add_metadata(EVIL, {EVIL: EVIL})
        writer.add_attachment(0, 0, EVIL, EVIL, b"x")
        writer.finish()  # type: ignore[no-untyped-call]
