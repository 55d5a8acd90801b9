"""Drives made in memory, read as if a recorder had written them: ordered, completed and checked as every log is."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.drive.finish import finish_trace
from drivelint.drive.trace import BRAKE_LIGHTS, INDICATORS, STATE_COLUMNS, Identity, IngestOptions, Recording, States
from drivelint.engine.batch import Drive

if TYPE_CHECKING:
    from numpy.typing import NDArray


def ingested(drive: Drive) -> Drive:
    """Return the drive as ingest hands it over when it finds these states in a log."""
    tables, drive_id = drive.trace.tables, drive.trace.drive_id
    states, log = tables["actor_state"], tables["data_log"].to_pylist()[0]
    encoded = pc.dictionary_encode(states["actor_id"].combine_chunks())

    def codes(name: str, words: tuple[str, ...]) -> NDArray[np.int8]:
        found = pc.index_in(states[name].combine_chunks(), value_set=pa.array(words))
        return np.asarray(pc.fill_null(found, -1).to_numpy(zero_copy_only=False), np.int8)

    recording = Recording(
        log["format"],
        States(
            encoded.dictionary.to_pylist(),
            encoded.indices.to_numpy().astype(np.int32),
            states["t_ns"].to_numpy(),
            {name: states[name].to_numpy().astype(np.float64) for name in STATE_COLUMNS},
            {"indicator": codes("indicator", INDICATORS), "brake_light": codes("brake_light", BRAKE_LIGHTS)},
            np.zeros(len(states), np.bool_),
        ),
        actors=tables["actor"],
        signals=tables["signal_state"],
        events=tables["declared_event"],
        ego_ids=tables["actor"].filter(tables["actor"]["is_ego"])["actor_id"].to_pylist(),
        sensor_range_m=log["sensor_range_m"],
    )
    trace = finish_trace(
        drive.trace.path, Identity(drive_id, log["file_name"], log["sha256"]), recording, IngestOptions()
    )
    return replace(drive, trace=replace(trace, tables={**trace.tables, "drive_condition": tables["drive_condition"]}))
