"""Pickles: every protocol and numpy, nothing but plain values, and one line for whatever is damaged or hostile."""

from __future__ import annotations

import collections
import pickle
import random
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from drivelint.formats.scenarionet.pickle_shortcuts import Points
from drivelint.formats.scenarionet.pickled_numpy import PickleError
from drivelint.formats.scenarionet.unpickle import load
from tests.formats.scenarionet.scenario_file import lane, scenario, straight, track

POINT = (1.5, 2.5, 3.5)
PAIRS = [[1.0, 2.0], [3.0, 4.0]]
VALUES: dict[str, Any] = {
    "float32": np.arange(6, dtype=np.float32).reshape(2, 3),
    "fortran": np.asfortranarray(np.arange(6.0).reshape(2, 3)),
    "big endian": np.arange(3, dtype=">i2"),
    "bools": np.array([True, False]),
    "one bool": np.array([True]),
    "another": np.array([True]),  # numpy gives both the same bytes, to which the file refers
    "empty": np.zeros((0, 3)),
    "no bytes": b"",
    "texts": np.array(["ab", "c"]),
    "0-d": np.array(5.0),
    "long": np.zeros((300, 2)),
    "scalars": [np.float64(3.25), np.int64(7), np.bool_(True)],
    "plain": (1, "x", None, True, False, -5, 70_000, 2**40, -(2**70), 1.5, b"xyz", "é😀", "y" * 300),
    "points": [POINT, (4.0, 5.0, 6.0)],
    "one point": [POINT],
    "the same point": POINT,
    "many points": [(float(i), 2.0, 3.0) for i in range(2500)],
    "pairs": PAIRS,
    "the same pair": PAIRS[1],
    "sets": [{1, 2}, frozenset(["a"])],
    "dicts": [collections.defaultdict(int, {"q": 1}), collections.OrderedDict(a=1), {1: {None: 2.5}}],
    "nested": [[[1.0]], [[]], ()],
}


def same(original: Any, copy: Any) -> bool:
    """Whether a value was read as what it is; a list of points may be an array, and a set is a list."""
    if isinstance(original, np.ndarray):
        return isinstance(copy, np.ndarray) and original.dtype == copy.dtype and np.array_equal(original, copy)
    if isinstance(original, dict):
        return (
            type(copy) is dict
            and original.keys() == copy.keys()
            and all(same(original[key], copy[key]) for key in original)
        )
    if isinstance(original, (set, frozenset)):
        return type(copy) is list and set(copy) == original
    if isinstance(original, list) and isinstance(copy, Points):
        return original == copy.as_list() and np.array_equal(np.array(original), copy.array)
    if isinstance(original, (list, tuple)):
        return type(original) is type(copy) and len(original) == len(copy) and all(map(same, original, copy))
    return bool(original == copy) and (isinstance(original, np.generic) or type(original) is type(copy))


@pytest.mark.parametrize("protocol", [2, 3, 4, 5])
def test_every_protocol(protocol: int) -> None:
    read = load(pickle.dumps(VALUES, protocol))
    assert [name for name in VALUES if not same(VALUES[name], read[name])] == []


@pytest.mark.parametrize("protocol", [2, 3, 4, 5])
def test_what_is_the_same_twice(protocol: int) -> None:
    shared = np.arange(3.0)
    read = load(
        pickle.dumps({"a": shared, "b": [shared], "c": VALUES["many points"], "d": VALUES["many points"]}, protocol)
    )
    assert read["a"] is read["b"][0]
    assert read["c"] is read["d"]


def test_both_names_of_numpy() -> None:
    content = pickle.dumps(np.arange(3.0), 4)
    core = b"numpy._core.multiarray" if b"numpy._core" in content else b"numpy.core.multiarray"
    for name in (b"numpy.core.multiarray", b"numpy._core.multiarray"):
        # the length of the name stands before it, that of the frame at the begin
        other = content.replace(bytes([len(core)]) + core, bytes([len(name)]) + name)
        assert load(other).tolist() == [0.0, 1.0, 2.0]


class _Evil:
    def __reduce__(self) -> Any:
        return (print, ("run",))


@pytest.mark.parametrize("protocol", [2, 3, 4, 5])
@pytest.mark.parametrize(
    ("value", "name"),
    [
        (_Evil(), "print"),
        (Path("x"), "Path"),
        (np.random.default_rng(1), "_generator_ctor|__generator_ctor|_pickle"),
        (complex(1, 2), "complex"),
    ],
)
def test_any_other_name_is_refused(value: Any, name: str, protocol: int, capsys: pytest.CaptureFixture[str]) -> None:
    content = pickle.dumps({"a": value}, protocol)
    with pytest.raises(
        PickleError, match=rf"requests '[\w.]*({name})[\w]*', which is refused: only numpy arrays and plain values"
    ):
        load(content)
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("protocol", [2, 3, 4, 5])
def test_arrays_of_objects_are_refused(protocol: int) -> None:
    for array in (
        np.array([{"a": 1}, None], object),
        np.zeros(2, [("a", "f8"), ("b", "i4")]),
        np.zeros(2, "M8[s]"),
        np.zeros(2, complex),
    ):
        with pytest.raises(PickleError, match="array of Python objects, which is refused: write numbers"):
            load(pickle.dumps({"a": array}, protocol))


def test_an_array_has_as_many_bytes_as_its_shape_says() -> None:
    content = pickle.dumps({"a": np.arange(100.0)}, 4)
    assert content.count(b"K\x64\x85") == 1
    for shape in (b"K\x65\x85", b"K\x63\x85"):
        with pytest.raises(PickleError, match="the size of an array does not match its shape"):
            load(content.replace(b"K\x64\x85", shape))


HOSTILE = {
    "a key that holds tuples": b"\x80\x04}N" + b"\x85" * 300_000 + b"K\x01s.",
    "a member of a set is no key": b"\x80\x04\x8f(N" + b"\x85" * 300_000 + b"\x90.",
    "a number for what the file refers to": b"\x80\x02]r\xff\xff\xff\x7f.",
    "a length beyond the file": b"\x80\x04\x8e\xff\xff\xff\xff\xff\xff\xff\x7f.",
    "a name of another module": b"\x80\x02cos\nsystem\n(X\x02\x00\x00\x00idtR.",
    "a name on the stack": b"\x80\x04\x8c\x02os\x94\x8c\x06system\x93.",
    "an object's operation": b"\x80\x02(ios\nsystem\n.",
    "a registered extension": b"\x80\x02\x82\x01.",
    "a text that is copied again and again": b"\x80\x02c_codecs\nencode\nq\x00X\x10\x27\x00\x00"
    + b"a" * 10_000 + b"q\x01X\x06\x00\x00\x00latin1q\x02]"
    + b"h\x00h\x01h\x02\x86Ra" * 100_000 + b".",
    "nothing": b"\x80\x04.",
    "two values": b"\x80\x04NN.",
    "no end": b"\x80\x04N",
    "a mark below": b"\x80\x04(.",
    "the stack is empty": b"\x80\x040.",
    "content for something that is not an array": b"\x80\x04}Nb.",
}  # fmt: skip


@pytest.mark.sample(4, ci=99)
@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_pickles_take_neither_time_nor_memory(name: str) -> None:
    """In a process of its own, which may take 512 MiB beyond what Python and numpy take: two of these crash or fill `pickle` itself."""
    code = (
        "import resource, sys\n"
        "from drivelint.formats.scenarionet.pickled_numpy import PickleError\n"
        "from drivelint.formats.scenarionet.unpickle import load\n"
        "taken = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "resource.setrlimit(resource.RLIMIT_AS, (taken + 2**29, taken + 2**29)); resource.setrlimit(resource.RLIMIT_CPU, (20, 20))\n"
        "try:\n    load(sys.stdin.buffer.read())\nexcept PickleError as error:\n    print(error)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], input=HOSTILE[name], capture_output=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr.decode()
    lines = done.stdout.decode().splitlines()
    harmless = name in {"a member of a set is no key", "a number for what the file refers to"}
    assert len(lines) == (0 if harmless else 1)


@pytest.mark.ci
def test_damage_is_one_line() -> None:
    content = pickle.dumps(scenario({"ego": track(straight(20, 5.0))}, features={"1": lane([[0, 0], [50, 0]])}), 4)
    chance = random.Random(7)  # noqa: S311 - damage, no secret
    told = []
    for _ in range(2000):
        damaged = bytearray(content[: chance.randrange(1, len(content) + 1)])
        for _ in range(chance.randrange(3)):
            damaged[chance.randrange(len(damaged))] = chance.randrange(256)
        with suppress(PickleError):
            load(bytes(damaged))
            continue
        with pytest.raises(PickleError) as error:
            load(bytes(damaged))
        told.append(str(error.value))
    assert len(told) > 1500
    assert [text for text in told if "\n" in text or len(text) > 1000] == []
