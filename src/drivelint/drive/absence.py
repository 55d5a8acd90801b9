"""Finds the times at which a log continues without its ego, adds ego states without values there, and reports their duration.

The recorder's own ego is the vehicle that carries the recorder. It must have states from the log's first frame to its last. The host of
OSI, the odometry of ROS, the ego flag of a table, or a mapping names it. An ego that the user chooses with --ego, or each of `--ego all`,
must have states from the start of its track to its end.

If the ego has no position at a frame, it gets a state without values: rules are judged there, and are unknown. Times without frames get
no states: no rule is judged there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.ego import ALL_EGOS, asks_for_all_egos
from drivelint.drive.lost_time import LATEST_CREDIBLE_NS
from drivelint.drive.order import MAX_GAP_PERIODS, UNKNOWN_CODE, sorted_states
from drivelint.drive.trace import EGO_ABSENT_CHECK, QualityFinding, States
from drivelint.phrases import ego_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.arrays import Indices, Times
    from drivelint.drive.trace import Recording

EGO_CHOSEN_CHECK: Final = "ego_chosen"
"""The id of the check (information only) for an ego that the user chose. A converted log keeps the finding, to distinguish this ego from
the recorder's own."""
ALL_EGOS_CHOSEN_CHECK: Final = "egos_chosen"
"""The id of the check (information only) for `--ego all`; the finding's actor is the recorder's own ego, if the log has one."""
LEAST_ABSENCE_NS: Final = 250_000_000
"""Shorter holes are clock jitter, as odometry at 100 Hz has; this is 2.5 periods of 10 Hz, the usual sampling rate in this field."""
LONGEST_FRAME_STEP_NS: Final = 1_000_000_000
"""Frames further apart than this are not successive frames of one recording."""
LEAST_TIME_BETWEEN_ADDED_STATES_NS: Final = 2_000_000
"""The least time between states that are added between frames."""
ASSUMED_EGO_PERIOD_NS: Final = 100_000_000
"""The sampling period that is assumed for an ego with fewer than two states."""


class Absence(NamedTuple):
    """The stretches in which one ego has no position, within a log or its track (`of_track`) from `first_ns` to `last_ns`.

    `since_ns`, `until_ns` (n): the last time before and the first time after each stretch, both outside it, ascending.
    """

    ego_id: str
    since_ns: Times
    until_ns: Times
    period_ns: int
    first_ns: int
    last_ns: int
    of_track: bool

    @property
    def stretches_within_log_or_track_ns(self) -> tuple[Times, Times]:
        """Return the starts and ends of the stretches (n), limited to the log or the track."""
        return np.maximum(self.since_ns, self.first_ns), np.minimum(self.until_ns, self.last_ns)

    def stretch_indices(self, t_ns: Times) -> Indices:
        """Return for each time (n) the index of the stretch that contains it; -1: no stretch does."""
        of = np.searchsorted(self.since_ns, t_ns, side="left") - 1
        return np.where((of >= 0) & (t_ns < self.until_ns[of]), of, -1)


def effective_ego_option(recording: Recording, ego_option: str | None) -> str | None:
    """Return the `--ego` of this run, or `all` if the log was converted with `--ego all`; None: use the ego that the log names."""
    if ego_option is None and any(finding.check_id == ALL_EGOS_CHOSEN_CHECK for finding in recording.findings):
        return ALL_EGOS
    return ego_option


def egos_with_recorder(recording: Recording) -> list[str]:
    """Return the egos that carry the recorder: those that the log or its mapping names, without those that a user had chosen."""
    picked = {finding.actor_id for finding in recording.findings if finding.check_id == EGO_CHOSEN_CHECK}
    among_all = [finding.actor_id for finding in recording.findings if finding.check_id == ALL_EGOS_CHOSEN_CHECK]
    if among_all:
        return [name for name in among_all if name is not None]
    return [name for name in dict.fromkeys(recording.ego_ids) if name not in picked]


def absences(recording: Recording, ego_option: str | None) -> list[Absence]:
    """Return the absences of the recorder's own egos, or of the ego that the user chooses (states not yet cleaned)."""
    states, egos = recording.states, egos_with_recorder(recording)
    names = egos if ego_option is None or asks_for_all_egos(ego_option, states.ids) else [ego_option]
    absences_of_egos = []
    for name in names:
        t_ns = _times_with_position(states, name)
        of_track = name not in egos and len(t_ns) > 0
        span = (int(t_ns[0]), int(t_ns[-1])) if of_track else _log_span_ns(recording)
        absence = _absence_of_actor(name, t_ns, span, recording.ends_apart_ns, of_track=of_track)
        if len(absence.since_ns):
            absences_of_egos.append(absence)
    return absences_of_egos


def _log_span_ns(recording: Recording) -> tuple[int, int]:
    """Return the first and the last time of a log: of its states, and of the frames before and after them.

    Isolated frames do not count: the first message of a log may contain only the road, with any time.
    """
    t_ns = recording.states.t_ns
    first, last = int(t_ns.min()), int(t_ns.max())
    frames = np.zeros(0, np.int64) if recording.frames_ns is None else recording.frames_ns
    frames = np.unique(frames[(np.abs(frames) < LATEST_CREDIBLE_NS) & ((frames < first) | (frames > last))])
    if not len(frames):
        return first, last
    edges = np.unique(np.r_[frames, first, last])
    steps = np.r_[np.iinfo(np.int64).max, np.diff(edges), np.iinfo(np.int64).max]
    near = edges[(steps[:-1] <= LONGEST_FRAME_STEP_NS) | (steps[1:] <= LONGEST_FRAME_STEP_NS)]
    return min([first, *near[:1].tolist()]), max([last, *near[-1:].tolist()])


def _times_with_position(states: States, actor_id: str) -> Times:
    """Return the times, ascending, at which an actor has a position."""
    if actor_id not in states.ids or not {"x_m", "y_m"} <= states.numbers.keys():
        return np.zeros(0, np.int64)
    has_place = states.actor == states.ids.index(actor_id)
    has_place &= np.isfinite(states.numbers["x_m"]) & np.isfinite(states.numbers["y_m"])
    return np.unique(states.t_ns[has_place])


def _absence_of_actor(
    actor_id: str, t_ns: Times, span_ns: tuple[int, int], ends_apart_ns: int, *, of_track: bool
) -> Absence:
    """Return the absence of an actor with positions at these times within a span; holes that are clock jitter do not count."""
    first, last = span_ns
    steps = np.diff(t_ns)
    period = max(int(np.median(steps)), 1) if len(steps) else ASSUMED_EGO_PERIOD_NS
    # 1 ns outside the span, so that a stretch at either end includes the end itself
    edges = np.r_[first - 1, t_ns, last + 1]
    least = np.full(len(edges) - 1, max(MAX_GAP_PERIODS * period, LEAST_ABSENCE_NS))
    least[[0, -1]] = max(least[0], ends_apart_ns) + 1
    wide = np.diff(edges) > (least if len(t_ns) else 0)
    return Absence(actor_id, edges[:-1][wide], edges[1:][wide], period, first, last, of_track)


def frame_times_without_states(recording: Recording, ego_absences: Sequence[Absence]) -> Times:
    """Return the times of frames without any actor during the absence of an ego (states not yet cleaned)."""
    if recording.frames_ns is None or not ego_absences:
        return np.zeros(0, np.int64)
    within = np.any([absence.stretch_indices(recording.frames_ns) >= 0 for absence in ego_absences], axis=0)
    return np.setdiff1d(recording.frames_ns[within], recording.states.t_ns)


def with_unknown_ego_states(states: States, ego_absences: Sequence[Absence], frames_ns: Times | None) -> States:
    """Add states without values for each ego, at the frames during its absence. The states are sorted, and so is the result."""
    ids = list(dict.fromkeys([*states.ids, *(absence.ego_id for absence in ego_absences)]))
    more = [_unknown_ego_states(states, ids, absence, frames_ns) for absence in ego_absences]
    if not any(map(len, more)):
        return states
    states.ids = ids
    return sorted_states(States.concatenate([states, *more]))


def _unknown_ego_states(states: States, ids: list[str], absence: Absence, frames_ns: Times | None) -> States:
    number = ids.index(absence.ego_id)
    t_ns = _times_to_fill(absence, states, states.t_ns[states.actor == number], frames_ns)
    n = len(t_ns)
    return States(
        ids,
        np.full(n, number, np.int32),
        t_ns,
        {name: np.full(n, np.nan) for name in states.numbers},
        {name: np.full(n, UNKNOWN_CODE) for name in states.codes},
        np.zeros(n, np.bool_),
    )


def _times_to_fill(absence: Absence, states: States, ego_times_ns: Times, frames_ns: Times | None) -> Times:
    """Return the times of frames within an absence, at most one per period, without those near a state of the ego (`ego_times_ns`).

    If frames are rarer than the ego's states, times between the frames are added, because rules would otherwise have a hole there.
    """
    period, half = absence.period_ns, absence.period_ns // 2
    times = np.concatenate([states.t_ns, np.zeros(0, np.int64) if frames_ns is None else frames_ns])
    times = np.unique(times[absence.stretch_indices(times) >= 0])
    if not len(times):
        return times
    of = absence.stretch_indices(times)
    slot = (times - absence.since_ns[of] + half) // period
    _, first = np.unique(np.stack([of, slot]), axis=1, return_index=True)
    times, of = times[first], of[first]
    apart = np.diff(times)
    wide = np.flatnonzero((apart > MAX_GAP_PERIODS * period) & (apart <= LONGEST_FRAME_STEP_NS) & (np.diff(of) == 0))
    if len(wide) > len(times) / 2:
        step = max(period, LEAST_TIME_BETWEEN_ADDED_STATES_NS)
        between = [np.arange(times[k] + step, times[k + 1] - step // 2, step) for k in wide]
        times = np.sort(np.concatenate([times, *between]))
    beside = np.searchsorted(ego_times_ns, times - half)
    is_near_state = np.append(ego_times_ns, np.iinfo(np.int64).max)[beside] <= times + half
    return times[~is_near_state]


def absence_findings(ego_absences: Sequence[Absence], states: States) -> list[QualityFinding]:
    """Return a finding of severity error for each absence (states in order, including those without values)."""
    start = int(states.t_ns.min())
    findings = []
    for absence in ego_absences:
        begins, ends = absence.stretches_within_log_or_track_ns
        lost_ns, of_ns = int((ends - begins).sum()), absence.last_ns - absence.first_ns
        until = "the end" if ends[0] == absence.last_ns else f"{(ends[0] - start) / 1e9:.3f} s"
        when = f"from {(begins[0] - start) / 1e9:.3f} s to {until}"
        if len(begins) > 1:
            when = f"in {len(begins)} stretches, the first {when}"
        whole = f"{of_ns / 1e9:.1f} s{' of its track' if absence.of_track else ''}"
        percent = "" if not of_ns else f" ({100 * lost_ns / of_ns:.0f} %)" if 200 * lost_ns >= of_ns else " (under 1 %)"
        message = (
            f"the {ego_name(absence.ego_id)} is absent for {lost_ns / 1e9:.1f} of {whole}{percent}, {when}: "
            "what it did in that time is unknown"
        )
        ego_times = (
            states.t_ns[states.actor == states.ids.index(absence.ego_id)]
            if absence.ego_id in states.ids
            else begins[:0]
        )
        n = int((absence.stretch_indices(ego_times) >= 0).sum())
        findings.append(QualityFinding(EGO_ABSENT_CHECK, "error", message, max(n, 1), int(begins[0]), absence.ego_id))
    return findings


def without_ego_choices(findings: Sequence[QualityFinding]) -> list[QualityFinding]:
    """Return the findings without those about the user's choice of the ego when the log was converted."""
    return [finding for finding in findings if finding.check_id not in {EGO_CHOSEN_CHECK, ALL_EGOS_CHOSEN_CHECK}]


def ego_choice_findings(recording: Recording, ego_option: str | None) -> list[QualityFinding]:
    """Return a finding, with the length of the track, if the user chooses another ego than the recorder's (states not yet cleaned)."""
    egos, states = egos_with_recorder(recording), recording.states
    if ego_option is None or ego_option in egos:
        return []
    if asks_for_all_egos(ego_option, states.ids):
        message = "every motor vehicle is an ego in turn (--ego all): each is judged for the time of its track"
        names: list[str | None] = [*egos] if egos else [None]
        return [QualityFinding(ALL_EGOS_CHOSEN_CHECK, "info", message, actor_id=name) for name in names]
    t_ns, (first, last) = _times_with_position(states, ego_option), _log_span_ns(recording)
    there = f"{(t_ns[-1] - t_ns[0]) / 1e9 if len(t_ns) else 0.0:.1f} of {(last - first) / 1e9:.1f} s of the log"
    message = f"the {ego_name(ego_option)} is chosen with --ego: it is judged for the time of its track, {there}"
    return [QualityFinding(EGO_CHOSEN_CHECK, "info", message, actor_id=ego_option)]
