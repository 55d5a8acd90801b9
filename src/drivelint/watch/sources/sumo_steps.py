"""Reads the steps of a simulation that SUMO writes into a socket.

Into a socket, SUMO writes every step at once; into a file or a pipe, it writes several steps in a block.
"""

from __future__ import annotations

import re
import socket
import threading
from collections import deque
from contextlib import suppress
from typing import Final

HOST: Final = "127.0.0.1"
_ACCEPT_TIMEOUT_S: Final = 0.2
_BLOCK_BYTES: Final = 1 << 16
_STEP_ELEMENT: Final = re.compile(rb'[ \t]*<timestep time="([^"]*)" *(?:/>|>.*?</timestep>)[ \t]*\r?\n?', re.DOTALL)
_FCD_BEGIN: Final = re.compile(rb"<fcd-export[^>]*>[ \t]*\r?\n?")


class StepReader:
    """Listens at `port`, and keeps the received steps until they are taken.

    A thread reads, because SUMO reports the end of a step only after it has written the step, and cannot write into a full socket.
    """

    def __init__(self) -> None:
        self._server = socket.create_server((HOST, 0))
        self._server.settimeout(_ACCEPT_TIMEOUT_S)
        self.port: int = self._server.getsockname()[1]
        self.output_head = b""
        """The output of SUMO before the first step."""
        self._found: deque[tuple[str, bytes]] = deque()
        self._news = threading.Condition()
        self._ended = False
        self._thread = threading.Thread(target=self._listen, name="drivelint-sumo", daemon=True)
        self._thread.start()

    def take_step(self, timeout_s: float) -> tuple[str, bytes] | None:
        """Return the next step: its time as SUMO writes it, and its element; None: no step came within `timeout_s`."""
        with self._news:
            self._news.wait_for(lambda: self._found or self._ended, timeout_s)
            return self._found.popleft() if self._found else None

    def close(self) -> None:
        """Stop listening, after SUMO has ended and its output was read. SUMO's end must have been requested before."""
        self._ended = True
        self._thread.join()

    def _listen(self) -> None:
        with self._server:
            while not self._ended:
                with suppress(TimeoutError):
                    connection, _ = self._server.accept()
                    break
            else:
                return
        with connection, suppress(OSError):
            connection.settimeout(None)
            self._read_steps(connection)
        with self._news:
            self._ended = True
            self._news.notify_all()

    def _read_steps(self, connection: socket.socket) -> None:
        waiting = bytearray()
        while block := connection.recv(_BLOCK_BYTES):
            waiting += block
            if not self.output_head:
                begin = _FCD_BEGIN.search(waiting)
                if begin is None:
                    continue
                self.output_head = bytes(waiting[: begin.end()])
                del waiting[: begin.end()]
            at = 0
            while step := _STEP_ELEMENT.match(waiting, at):
                with self._news:
                    self._found.append((step[1].decode(), bytes(step[0])))
                    self._news.notify_all()
                at = step.end()
            del waiting[:at]
