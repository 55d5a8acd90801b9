"""A source that steps a simulation in SUMO, which waits while a window is judged.

The recording is SUMO's floating car data, and beside it the files that its reader needs: the sizes of vehicles, and the states of lights.
"""

from __future__ import annotations

import re
import time
from html import unescape
from itertools import count
from typing import TYPE_CHECKING, BinaryIO, Final
from xml.sax.saxutils import quoteattr

from drivelint.errors import TraceError
from drivelint.formats import safe_xml
from drivelint.phrases import name_list
from drivelint.watch.source import Frame, WindowFileSource
from drivelint.watch.sources.recordings import convert_write_errors
from drivelint.watch.sources.sumo_process import SumoProcess, SumoStep

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from lxml import etree

    from drivelint.watch.sources.sumo_process import VehicleType

LEAST_RECORDED_DECIMALS: Final = 4
"""The number of decimals that are recorded, unless the configuration requires more."""
DEFAULT_WINDOW_SPAN_S: Final = 0.5
MOST_SIMULATED_SPAN_PER_READ_S: Final = 0.5
"""The most seconds that one `read` simulates, so that a contact halts the simulation soon."""
_FCD_BEGIN: Final = b'<?xml version="1.0" encoding="UTF-8"?>\n<fcd-export>\n'
_FCD_END: Final = b"</fcd-export>\n"
_LIGHTS_BEGIN: Final = b"<tlsStates>\n"
_LIGHTS_END: Final = b"</tlsStates>\n"
_TYPE_ATTRIBUTE: Final = re.compile(rb'\stype="([^"]*)"')
_ACTOR_OMITTING_OPTIONS: Final = (
    "person-fcd-output", "fcd-output.filter-edges.input-file", "fcd-output.filter-shapes", "device.fcd.probability",
    "device.fcd.explicit", "device.fcd.radius", "person-device.fcd.probability", "person-device.fcd.explicit",
)  # fmt: skip
"""Options of a configuration with which SUMO does not write every actor."""


def open(name: str, folder: Path, *, span_s: float = DEFAULT_WINDOW_SPAN_S, until_s: float | None = None) -> SumoSource:  # noqa: A001
    """Start the simulation of a `*.sumocfg`, and return it as a source; it is recorded in a new folder within `folder`.

    Errors: `UsageError` without SUMO or traci, `TraceError` with SUMO's own message if it cannot start.
    """
    from pathlib import Path

    return SumoSource(Path(name), folder, span_s=span_s, until_s=until_s)


class SumoSource(WindowFileSource):
    """Advances a simulation by `span_s` per window, until SUMO's clock reaches `until_s` or the simulation ends."""

    window_name = "window.fcd.xml"
    is_advanced_by_reads = True

    def __init__(self, config: Path, folder: Path, *, span_s: float, until_s: float | None) -> None:
        options = _configuration(config)
        omitting = [
            name for name in _ACTOR_OMITTING_OPTIONS if any(candidate.tag == name for candidate in options.iter())
        ]
        self._notes = (
            [f"{config.name}: {name_list(omitting)}: actors that SUMO does not write after that are not judged"]
            if omitting
            else []
        )
        base = config.stem.replace(".", "-")  # the reader finds the file of lights by the name before the first dot
        own_folder = next(
            candidate for n in count(1) if not (candidate := folder / (base if n == 1 else f"{base}-{n}")).exists()
        )
        self.recording = own_folder / f"{base}.fcd.xml"
        self._types: dict[bytes, VehicleType | None] = {}
        self._files: dict[Path, tuple[BinaryIO, bytes]] = {}
        self._sumo = SumoProcess(
            config, precision=max(LEAST_RECORDED_DECIMALS, _precision_decimals(options)), until_s=until_s
        )
        self._is_over = False
        self._n_steps = max(1, round(span_s / self._sumo.step_s))
        # a window ends with a span: the first span includes the log's first step, each other starts after the last step of the previous one
        self._n_left = self._n_steps + 1
        self._n_part = max(1, round(MOST_SIMULATED_SPAN_PER_READ_S / self._sumo.step_s))

    def read(self, timeout_s: float) -> Sequence[Frame] | None:
        """Simulate the next part of the span, at most `MOST_SIMULATED_SPAN_PER_READ_S` and about `timeout_s` of real time.

        Return a frame per step.
        """
        if self._is_over:
            return None
        until = time.monotonic() + timeout_s
        frames: list[Frame] = []
        while self._n_left and len(frames) < self._n_part and not (frames and time.monotonic() > until):
            if self._sumo.is_over():
                self._is_over = True
                break
            step = self._sumo.step()
            with convert_write_errors(self.recording):
                self._record_step(step)
            frames.append(
                Frame(round(float(step.time) * 1e9), step, len(step.xml) + sum(map(len, step.lights.values())))
            )
            self._n_left -= 1
        self.is_window_due = not self._n_left
        self._n_left = self._n_left or self._n_steps
        return frames or None

    def notes(self) -> Sequence[str]:
        """Return, on the first call, a note on actors that the configuration leaves out of the recording."""
        new_notes, self._notes = self._notes, []
        return new_notes

    def write_window(self, frames: Sequence[Frame], path: Path, *, may_omit_earlier_data: bool = False) -> None:  # noqa: ARG002 - as in all sources
        """Write these steps as floating car data, and the types and lights beside it."""
        steps = [frame.data for frame in frames if isinstance(frame.data, SumoStep)]
        path.write_bytes(b"".join([_FCD_BEGIN, *(step.xml for step in steps), _FCD_END]))
        lights = _companion_file(path, "tls")
        if any(step.lights for step in steps):
            lights.write_bytes(b"".join([_LIGHTS_BEGIN, *map(_light_states_xml, steps), _LIGHTS_END]))
        else:
            lights.unlink(missing_ok=True)
        _companion_file(path, "vtypes").write_bytes(self._vtypes_xml(self._types))

    def end_sender_if_possible(self) -> None:
        """End the simulation."""
        self._is_over = True
        self._sumo.end()

    def close(self) -> None:
        """End the simulation and the recording."""
        self.end_sender_if_possible()
        for file, end in self._files.values():
            if not file.closed:
                with convert_write_errors(self.recording), file:
                    file.write(end)

    def _record_step(self, step: SumoStep) -> None:
        """Write a step to the recording at once, so that it is kept even if this process is killed."""
        self._append_to_file(self.recording, self._sumo.output_head, step.xml, _FCD_END)
        if step.lights:
            self._append_to_file(
                _companion_file(self.recording, "tls"), _LIGHTS_BEGIN, _light_states_xml(step), _LIGHTS_END
            )
        new = set(_TYPE_ATTRIBUTE.findall(step.xml)) - self._types.keys()
        if new:
            # requested while the vehicle exists: the type of a single vehicle ends with it
            self._types |= {name: self._sumo.vehicle_type(unescape(name.decode())) for name in sorted(new)}
            _companion_file(self.recording, "vtypes").write_bytes(self._vtypes_xml(self._types))

    def _append_to_file(self, path: Path, begin: bytes, content: bytes, end: bytes) -> None:
        if path not in self._files:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._files[path] = path.open("xb"), end
            self._files[path][0].write(begin)
        file, _ = self._files[path]
        file.write(content)
        file.flush()

    @staticmethod
    def _vtypes_xml(types: dict[bytes, VehicleType | None]) -> bytes:
        lines = [
            f'<vType id="{name.decode()}" vClass="{kind.vehicle_class}" length="{kind.length_m!r}" width="{kind.width_m!r}"/>\n'
            for name, kind in sorted(types.items())
            if kind is not None
        ]
        return "".join(["<routes>\n", *lines, "</routes>\n"]).encode()


def _companion_file(log: Path, kind: str) -> Path:
    return log.with_name(f"{log.name.partition('.')[0]}.{kind}.xml")


def _light_states_xml(step: SumoStep) -> bytes:
    """Return the states of all traffic lights at a step, in the format of SUMO's own output of states."""
    return "".join(
        f'<tlsState time="{step.time}" id={quoteattr(light)} state="{state}"/>\n'
        for light, state in step.lights.items()
    ).encode()


def _configuration(config: Path) -> etree._Element:
    try:
        content = config.read_bytes()
    except OSError as error:
        raise TraceError(f"{config}: cannot be read: {error.strerror or error}") from error
    return safe_xml.parse(content, f"{config}", TraceError)


def _precision_decimals(options: etree._Element) -> int:
    texts: Iterable[str | None] = (option.get("value", option.get("v")) for option in options.iter("precision"))
    return max((int(text) for text in texts if text is not None and text.strip().isdecimal()), default=0)
