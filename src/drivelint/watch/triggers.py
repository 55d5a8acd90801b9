"""Runs commands of the user at alarms."""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from drivelint import catalogue
from drivelint.errors import UsageError
from drivelint.phrases import plural

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.catalogue import Rule

LEAST_PAUSE_BETWEEN_STARTS_S: Final = 1.0
"""The least number of seconds between two starts of one command; alarms in between are not passed on."""
MOST_SIMULTANEOUS_RUNS: Final = 4
"""The most simultaneous runs of one command."""


@dataclass
class Trigger:
    """A command and the rules whose alarms start it. It runs without a shell and gets the alarms on stdin, one line of JSON each."""

    rules: frozenset[str]
    command: Sequence[str]
    n_run: int = 0
    n_left_out: int = 0
    """Alarms for which the command was not started."""
    _n_told: int = 0
    _last_s: float = -LEAST_PAUSE_BETWEEN_STARTS_S
    _running: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def run_for_alarms_and_return_note(self, alarms: Sequence[Mapping[str, Any]]) -> str | None:
        """Start the command once for the alarms of its rules, unless it is started too often.

        Return a note: an error, or the number of alarms that were left out before; None: there is nothing to report.
        """
        own_alarms = [alarm for alarm in alarms if alarm["rule_id"] in self.rules]
        if not own_alarms:
            return None
        now = time.monotonic()
        self._running = [running for running in self._running if running.poll() is None]
        if now - self._last_s < LEAST_PAUSE_BETWEEN_STARTS_S or len(self._running) >= MOST_SIMULTANEOUS_RUNS:
            self.n_left_out += len(own_alarms)
            return None
        self._last_s = now
        try:
            process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=sys.stderr.fileno())  # noqa: S603 - given by the user
        except OSError as error:
            return f"--on: {self.command[0]}: cannot be started: {error.strerror or error}"
        assert process.stdin is not None  # noqa: S101 - it is a pipe
        with suppress(BrokenPipeError, OSError):  # the command need not read stdin
            process.stdin.writelines(json.dumps(alarm).encode() + b"\n" for alarm in own_alarms)
            process.stdin.close()
        self._running.append(process)
        self.n_run += 1
        return self.note_on_left_out_alarms()

    def note_on_left_out_alarms(self) -> str | None:
        """Return in words how many alarms were left out since the last note; None if there are none."""
        n, self._n_told = self.n_left_out - self._n_told, self.n_left_out
        if not n:
            return None
        limits = f"at most once in {LEAST_PAUSE_BETWEEN_STARTS_S:g} s, and {MOST_SIMULTANEOUS_RUNS} run at a time"
        return f"--on: {self.command[0]} was not started for {plural(n, 'alarm')}: it starts {limits}"

    def wait_for_running_commands(self) -> None:
        """Wait up to `LEAST_PAUSE_BETWEEN_STARTS_S` for each command that still runs; after that, leave it running."""
        for process in self._running:
            with suppress(subprocess.TimeoutExpired):
                process.wait(LEAST_PAUSE_BETWEEN_STARTS_S)


def parse(texts: Sequence[str], rules_by_id: Mapping[str, Rule], selected_rules: Mapping[str, Rule]) -> list[Trigger]:
    """Return the triggers of texts `SEL=COMMAND`. Errors: `UsageError` for a wrong text, or if SEL names no selected rule."""
    triggers = []
    for text in texts:
        names, sign, words = text.partition("=")
        if not sign or not names.strip():
            raise UsageError(f"--on {text!r}: write SEL=COMMAND, such as severity:critical='notify-send alarm'")
        try:
            command = shlex.split(words)
        except ValueError as error:
            raise UsageError(f"--on {text!r}: {error}") from error
        if not command:
            raise UsageError(f"--on {text!r}: no command behind the sign =")
        rules = (
            frozenset(rule.id for rule in catalogue.select_rules(rules_by_id, [names.strip()], ()))
            & selected_rules.keys()
        )
        if not rules:
            raise UsageError(f"--on {text!r}: none of the selected rules is meant: add it with --rules")
        triggers.append(Trigger(rules, command))
    return triggers
