"""Reading the reference drive: against omega-prime, a library made for the format."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import pyarrow.compute as pc

from drivelint.drive.trace import IngestOptions
from drivelint.formats import read_trace
from tests.bench.clock import Span, median, repeat
from tests.bench.rivals.comparison import agree, ask
from tests.bench.table import Bar, Row

if TYPE_CHECKING:
    from tests.bench.place import Place

PYTHON = "DRIVELINT_BENCH_OMEGA_PYTHON"


def compare(place: Place) -> list[Row]:
    """Compare the reading of all states of the reference drive into a table."""
    trace = place.reference
    runs = min(2, place.sizes.runs)
    theirs = ask("omega_script.py", "omega_prime", PYTHON, trace, runs)
    states = read_trace(trace, IngestOptions()).tables["actor_state"]
    agree("states", states.num_rows, theirs["rows"])
    for axis in "xy":
        agree(f"sum of {axis}", pc.sum(states[f"{axis}_m"]).as_py(), theirs[axis])
    omega = median([Span(*t) for t in theirs["taken"]])
    ours = repeat(partial(read_trace, trace, IngestOptions()), place.sizes.runs)
    return [
        Row("omega-prime", "its reading", omega.wall, cpu=omega.cpu, note=f"median of {runs}"),
        Row("omega-prime", "ours", ours.wall, cpu=ours.cpu, note="with the checks of ingest"),
        Row("omega-prime", "ours is faster", omega.wall / ours.wall, "x", bar=Bar(15.0, at_least=True)),
    ]
