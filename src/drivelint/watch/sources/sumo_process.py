"""Runs SUMO as a child process, and steps it through TraCI.

A step consists of SUMO's own floating car data: requests for single vehicles would be slower, and their values rounded differently.
SUMO is not loaded as a library, because libsumo contains its own Arrow, which clashes with pyarrow's.
Source: SUMO's documentation of "TraCI/Protocol" and "Simulation/Output/FCDOutput".
"""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from contextlib import ExitStack, contextmanager, suppress
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.errors import TraceError, UsageError
from drivelint.phrases import one_line
from drivelint.watch.sources.sumo_steps import HOST, StepReader

if TYPE_CHECKING:
    from collections.abc import Iterator

GRACE_BEFORE_KILL_S: Final = 5.0
"""How long SUMO may take to end by itself and to write its other outputs."""
CONNECT_TIMEOUT_S: Final = 30.0
_STEP_TIMEOUT_S: Final = 10.0
_CONNECT_RETRY_PERIOD_S: Final = 0.02
_MOST_START_ATTEMPTS: Final = 3
_PORT_IN_USE_WORD: Final = "bind"
"""A word in SUMO's message if another program took the port in the meantime."""
_NO_SUMO_MESSAGE: Final = "SUMO is not installed: pip install 'drivelint[sumo]'"
_SUMO_OPTIONS: Final = (
    ("fcd-output.attributes", "id,x,y,z,angle,type,speed,pos,lane,edge,slope,signals,acceleration,vehicle"),
    ("fcd-output.geo", "false"), ("fcd-output.utm", "false"), ("fcd-output.skip-empty", "false"),
    ("device.fcd.period", "0"), ("device.fcd.begin", "-1"), ("human-readable-time", "false"), ("no-step-log", "true"),
)  # fmt: skip


class SumoStep(NamedTuple):
    """One step of the simulation: its time as SUMO writes it, its `timestep` element, and the state of each traffic light."""

    time: str
    xml: bytes
    lights: dict[str, str]


class VehicleType(NamedTuple):
    """The class and size of a vType in SUMO."""

    vehicle_class: str
    length_m: float
    width_m: float


def find_sumo_program_and_home() -> tuple[str, str | None]:
    """Return the path of SUMO's program and, if it is known, SUMO_HOME. Errors: `UsageError` if SUMO is not installed.

    The program inside the package is used: the script of the same name starts it as a child, which would outlive the script.
    """
    homes = [os.environ.get("SUMO_HOME")]
    with suppress(ImportError):
        import sumo

        homes.append(sumo.SUMO_HOME)
    for home in homes:
        if home and (program := shutil.which("sumo", path=str(Path(home) / "bin"))):
            return program, home
    if program := shutil.which("sumo"):
        return program, None
    raise UsageError(f"{_NO_SUMO_MESSAGE}, or set SUMO_HOME")


class SumoProcess:
    """A simulation that waits between its steps, which are `step_s` apart. It ends at `until_s` of its clock, or when SUMO would end.

    Errors: `UsageError` without SUMO or traci, `TraceError` with SUMO's own message if it cannot continue.
    """

    def __init__(self, config: Path, *, precision: int, until_s: float | None) -> None:
        try:
            from traci import constants, exceptions
        except ImportError as error:
            raise UsageError(_NO_SUMO_MESSAGE) from error
        self._config = config
        self._refusal = exceptions.TraCIException
        self._light_state = constants.TL_RED_YELLOW_GREEN_STATE
        self._broken = (exceptions.FatalTraCIError, exceptions.TraCIException, OSError)
        self._messages = tempfile.TemporaryFile()  # noqa: SIM115 - closed in end()
        self._steps = StepReader()
        self._process: subprocess.Popen[bytes] | None = None
        self._con: Any = None
        self._is_asked = False
        """Whether SUMO has not yet answered the last request."""
        with ExitStack() as undo:
            undo.callback(self.end)
            self._start_and_connect(precision)
            with self._guarded_connection() as con:
                self.step_s = float(con.simulation.getDeltaT())
                end_s = float(con.simulation.getEndTime())  # less than 0: until all vehicles have arrived
                for light in con.trafficlight.getIDList():
                    con.trafficlight.subscribe(light, (self._light_state,))
            undo.pop_all()
        self._ends_empty = end_s < 0
        self._end_s = min(limit_s for limit_s in (end_s if end_s >= 0 else inf, until_s) if limit_s is not None)

    @property
    def output_head(self) -> bytes:
        """The output of SUMO before the first step."""
        return self._steps.output_head

    def step(self) -> SumoStep:
        """Simulate one step."""
        with self._guarded_connection() as con:
            con.simulationStep()
            lights = con.trafficlight.getAllSubscriptionResults()
        if (content := self._steps.take_step(_STEP_TIMEOUT_S)) is None:
            raise TraceError(
                f"{self._config}: SUMO wrote no floating car data of a step: leave that to SUMO's defaults"
            )
        return SumoStep(*content, {light: states[self._light_state] for light, states in sorted(lights.items())})

    def is_over(self) -> bool:
        """Return whether the simulation is at its end."""
        with self._guarded_connection() as con:
            if self._ends_empty and con.simulation.getMinExpectedNumber() == 0:
                return True
            return float(con.simulation.getTime()) >= self._end_s - self.step_s / 2

    def vehicle_type(self, name: str) -> VehicleType | None:
        """Return the class and size of a vType; None: SUMO does not know the type."""
        # a type that was changed for a single vehicle is called BASE@ID, after its original type BASE
        parts = name.split("@")
        with self._guarded_connection() as con:
            types = con.vehicletype
            for n in range(len(parts), 0, -1):
                base = "@".join(parts[:n])
                with suppress(self._refusal):
                    return VehicleType(types.getVehicleClass(base), types.getLength(base), types.getWidth(base))
        return None

    def end(self) -> None:
        """End SUMO: give it `GRACE_BEFORE_KILL_S` if it waits for a request, else kill it at once. May be called twice."""
        con, self._con = self._con, None
        if self._process is not None:
            if con is not None and not self._is_asked:
                with suppress(*self._broken):
                    con.close(wait=False)
                with suppress(subprocess.TimeoutExpired):
                    self._process.wait(GRACE_BEFORE_KILL_S)
            self._kill(self._process)
        self._steps.close()
        self._messages.close()

    @staticmethod
    def _kill(process: subprocess.Popen[bytes]) -> None:
        if process.poll() is None:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)
        process.wait()

    def _start_and_connect(self, precision: int) -> None:
        """Start SUMO and connect to it; try another port if another program took the first."""
        program, home = find_sumo_program_and_home()
        environment = {**os.environ, **({"SUMO_HOME": home} if home else {})}
        for start in range(_MOST_START_ATTEMPTS):
            with socket.create_server((HOST, 0)) as free:
                port = free.getsockname()[1]
            options = [*_SUMO_OPTIONS, ("fcd-output", f"{HOST}:{self._steps.port}"), ("precision", str(precision))]
            command = [program, "-c", str(self._config), "--remote-port", str(port)]
            command += [part for name, value in options for part in (f"--{name}", value)]
            # in a session of its own: only drivelint receives Ctrl-C, and then ends SUMO
            self._process = subprocess.Popen(  # noqa: S603 - the user chose to run SUMO
                command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self._messages,
                start_new_session=True, env=environment,
            )  # fmt: skip
            if self._connect(port, self._process):
                return
            if _PORT_IN_USE_WORD not in self._output_text() or start == _MOST_START_ATTEMPTS - 1:
                raise self._failure()

    def _connect(self, port: int, process: subprocess.Popen[bytes]) -> bool:
        """Connect as soon as SUMO listens, and return whether it did. traci's own function would write to stdout meanwhile."""
        from traci.connection import Connection

        until = time.monotonic() + CONNECT_TIMEOUT_S
        while time.monotonic() < until and process.poll() is None:
            try:
                self._con = Connection(HOST, port, process, None, True)
            except OSError:
                time.sleep(_CONNECT_RETRY_PERIOD_S)
            else:
                return True
        self._kill(process)
        return False

    @contextmanager
    def _guarded_connection(self) -> Iterator[Any]:
        """Provide the connection within the block. Errors: `TraceError` if the connection fails."""
        self._is_asked = True
        try:
            yield self._con
        except self._broken as error:
            raise self._failure() from error
        self._is_asked = False

    def _failure(self) -> TraceError:
        """Return an error with SUMO's own message on why it ended."""
        code: int | None = None
        if self._process is not None:
            with suppress(subprocess.TimeoutExpired):
                code = self._process.wait(GRACE_BEFORE_KILL_S)
        lines = [line for line in self._output_text().splitlines() if not line.startswith(("Warning:", "Quitting"))]
        first = next((n for n, line in enumerate(lines) if line.startswith("Error:")), 0)
        message = one_line("\n".join(line.removeprefix("Error:").strip() for line in lines[first:]))
        return TraceError(f"{self._config}: SUMO: {message or f'it ended with exit code {code}'}")

    def _output_text(self) -> str:
        self._messages.seek(0)
        return self._messages.read().decode("utf-8", "replace")
