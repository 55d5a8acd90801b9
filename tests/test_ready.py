"""What others take ready-made: wheel and sdist, the GitHub action, the pre-commit hooks, the image. Each is run, or its steps are."""

from __future__ import annotations

import email
import io
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import venv
import zipfile
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml

from drivelint import __version__
from drivelint import demo as demo_files
from drivelint.guide import FOLDER
from tests.guide.blocks import blocks
from tests.shared_data import ROOT

MOST_IMAGE_BYTES = 600_000_000
BASE_BYTES = 45_000_000
"""What a registry keeps of python:3.12-slim."""
JUNK = re.compile(r"(?:^|/)(?:__pycache__|\.venv|\.\w+_cache|\.git|out|dist|build)/|\.(?:pyc|log|tmp|orig|whl)$|~$")
NO_NETWORK = """
import socket

def refuse(*_args, **_named):
    raise OSError("there is no network here")

socket.socket.connect = socket.create_connection = socket.getaddrinfo = refuse
"""


def run(line: str, folder: Path, **env: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["bash", "-euo", "pipefail", "-c", line], cwd=folder, env={**os.environ, **env}, check=False, capture_output=True,
        text=True, timeout=600,
    )  # fmt: skip


def with_tools(folder: Path) -> str:
    """Put `drivelint` and `python` of this checkout into a folder; return a PATH that begins with it."""
    tools = folder / "tools"
    tools.mkdir()
    for name, words in (("drivelint", "-m drivelint"), ("python", "")):
        (tools / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {words} "$@"\n', encoding="utf-8")
        (tools / name).chmod(0o755)
    return f"{tools}{os.pathsep}{os.environ['PATH']}"


@pytest.fixture
def drives(tmp_path: Path) -> Path:
    """Return a folder with a road, and a drive in which something fails, in `drives`."""
    demo_files.write(tmp_path)
    (tmp_path / "drives").mkdir()
    shutil.move(tmp_path / "near-miss.mcap", tmp_path / "drives")
    return tmp_path


def built(source: Path, out: Path, kind: str) -> Path:
    """Build a wheel or sdist from a tree by its own backend, without an index."""
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", kind, "-d", out], cwd=source, check=True, capture_output=True
    )
    (made,) = out.iterdir()
    return made


class Packages(NamedTuple):
    """What this tree is built into, and the wheel that is built from the sdist."""

    wheel: Path
    sdist: Path
    wheel_of_sdist: Path


@pytest.fixture(scope="module")
def packages(tmp_path_factory: pytest.TempPathFactory) -> Packages:
    pytest.importorskip("hatchling", reason="hatchling is not installed: pip install hatchling")
    home = tmp_path_factory.mktemp("packages")
    wheel, sdist = (built(ROOT, home / kind, kind) for kind in ("wheel", "sdist"))
    with tarfile.open(sdist) as packed:
        packed.extractall(home / "tree", filter="data")
    (tree,) = (home / "tree").iterdir()
    return Packages(wheel, sdist, built(tree, home / "again", "wheel"))


@pytest.mark.ci
@pytest.mark.parametrize("kind", ["wheel", "sdist"])
def test_wheel_and_sdist_install_and_run_the_demo_offline(kind: str, packages: Packages, tmp_path: Path) -> None:
    python = installed(getattr(packages, kind), tmp_path / "venv")
    env = {
        "PATH": f"{python.parent}{os.pathsep}{os.environ['PATH']}",
        "DRIVELINT_CACHE_DIR": str(tmp_path / "cache"),
        "PYTHONPATH": "",
    }
    there = run("python -c 'import drivelint; print(drivelint.__file__)'", tmp_path, **env)
    assert Path(there.stdout.strip()).is_relative_to(tmp_path)
    assert run("drivelint --version", tmp_path, **env).stdout.split()[-1] == __version__
    # the demo as README has it, without the copies, which take most of its time
    line = "drivelint demo && drivelint check demo/*.mcap --map demo/road.xodr --out results --no-robustness"
    done = run(line, tmp_path, **env)
    assert done.returncode == 1, done.stderr
    assert "in 6 of 6 drives; CONTACT in 2 drives" in done.stdout
    assert (tmp_path / "results" / "report.html").is_file()
    assert run("drivelint docs ci && drivelint rules list", tmp_path, **env).returncode == 0


@pytest.mark.ci
def test_the_wheel_of_the_sdist_is_the_wheel_of_the_tree(packages: Packages) -> None:
    assert contents(packages.wheel_of_sdist) == contents(packages.wheel)
    names = contents(packages.wheel)
    assert {"drivelint/py.typed", "drivelint/NOTICE", "drivelint/guide/search.js"} <= names.keys()
    assert {name.partition("/")[0] for name in names} == {"drivelint", f"drivelint-{__version__}.dist-info"}
    assert [name for name in names if JUNK.search(name)] == []


@pytest.mark.ci
def test_the_sdist_has_what_git_has(packages: Packages) -> None:
    """So it has no junk, and its tests find all that they read."""
    words = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    told = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    if told.returncode:
        pytest.skip("this is no git checkout")
    with tarfile.open(packages.sdist) as packed:
        names = {name.partition("/")[2] for name in packed.getnames()}
    assert names - {"PKG-INFO"} == {name for name in told.stdout.splitlines() if (ROOT / name).exists()}
    assert [name for name in names if JUNK.search(name)] == []


@pytest.mark.ci
def test_an_index_can_show_what_the_packages_say_of_themselves(packages: Packages) -> None:
    with zipfile.ZipFile(packages.wheel) as files:
        about = f"drivelint-{__version__}.dist-info"
        metadata = files.read(f"{about}/METADATA")
        assert {f"{about}/licenses/LICENSE", f"{about}/licenses/src/drivelint/NOTICE"} <= set(files.namelist())
    with tarfile.open(packages.sdist) as packed:
        info = packed.extractfile(f"drivelint-{__version__}/PKG-INFO")
        assert info is not None
        assert info.read() == metadata
    told = email.message_from_bytes(metadata)
    assert (told["Name"], told["Version"], told["Requires-Python"]) == ("drivelint", __version__, ">=3.11")
    assert (told["License-Expression"], told["Description-Content-Type"]) == ("Apache-2.0", "text/markdown")
    assert metadata.decode().partition("\n\n")[2] == (ROOT / "README.md").read_text(encoding="utf-8")
    assert told["Project-URL"] is None, "drivelint has no address of its own yet"


def contents(wheel: Path) -> dict[str, int]:
    """Return name -> CRC of the files of a wheel, without the list of them."""
    with zipfile.ZipFile(wheel) as files:
        return {each.filename: each.CRC for each in files.infolist() if not each.filename.endswith("RECORD")}


def pip() -> list[str]:
    """Return the words that call the pip of a python3 on the path: the environment of the tests has none."""
    for folder in dict.fromkeys(f"{os.environ['PATH']}{os.pathsep}{os.defpath}".split(os.pathsep)):
        if python := shutil.which("python3", path=folder):
            words = [python, "-m", "pip"]
            if subprocess.run([*words, "--version"], check=False, capture_output=True).returncode == 0:
                return words
    pytest.skip("no python3 on the path has pip")


def installed(package: Path, home: Path) -> Path:
    """Install a wheel or an sdist into an environment that has our dependencies and no network; return its interpreter."""
    venv.create(home, with_pip=False)
    python = home / "bin" / "python"
    place = Path(sysconfig.get_path("purelib", vars={"base": str(home), "platbase": str(home)}))
    # ours come first: a path file adds folders behind, and does not follow the path files in them, such as that of this checkout
    (place / "dependencies.pth").write_text(
        "\n".join(path for path in sys.path if path.endswith("site-packages")), encoding="utf-8"
    )
    words = ["install", "-q", "--no-index", "--no-deps", "--no-build-isolation", "--ignore-installed", str(package)]
    done = subprocess.run(
        [*pip(), "--python", python, *words],
        cwd=home, env={**os.environ, "PYTHONPATH": ""}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    (place / "sitecustomize.py").write_text(NO_NETWORK, encoding="utf-8")
    return python


@pytest.mark.ci
def test_the_action_fails_where_the_check_does_and_shows_the_outcome(drives: Path) -> None:
    action: dict[str, Any] = yaml.safe_load((ROOT / ".github" / "action" / "action.yml").read_text(encoding="utf-8"))
    given = {
        "logs": "drives",
        "map": "road.xodr",
        "options": "--fail-on critical --no-robustness --no-annotate",
        "out": "results",
    }
    assert given.keys() <= action["inputs"].keys()
    path = with_tools(drives)
    steps = {step.get("id") or step.get("name") or step["uses"]: step for step in action["runs"]["steps"]}
    assert (ROOT / ".github" / "action" / ".." / ".." / "pyproject.toml").is_file(), "what it installs"
    assert steps["Install drivelint"]["run"].endswith('"$ACTION/../.."')
    check = steps["check"]
    env = {
        name: re.sub(r"\$\{\{ inputs\.(\w+) \}\}", lambda said: given[said[1]], value)
        for name, value in check["env"].items()
    }
    files = {name: str(drives / name) for name in ("GITHUB_OUTPUT", "GITHUB_STEP_SUMMARY")}
    done = run(check["run"], drives, PATH=path, PYTHONPATH=str(ROOT / "src"), **env, **files)
    assert done.returncode == 1, done.stderr
    assert (drives / "GITHUB_OUTPUT").read_text(encoding="utf-8") == "exit-code=1\n"
    assert "FAIL" in (drives / "GITHUB_STEP_SUMMARY").read_text(encoding="utf-8")
    assert "${{" not in check["run"], "what is given is no part of the script"


def action_step(folder: Path, **given_inputs: str) -> tuple[subprocess.CompletedProcess[str], list[str], str]:
    """Run the action's check with a `drivelint` that only notes its words; return the run, these words, and the summary."""
    action = yaml.safe_load((ROOT / ".github" / "action" / "action.yml").read_text(encoding="utf-8"))
    (check,) = (step for step in action["runs"]["steps"] if step.get("id") == "check")
    inputs = {name: about.get("default", "") for name, about in action["inputs"].items()} | given_inputs
    env = {
        name: re.sub(r"\$\{\{ inputs\.(\w+) \}\}", lambda said: inputs[said[1]], text)
        for name, text in check["env"].items()
    }
    (folder / "drivelint").write_text("#!/bin/sh\nprintf '%s\\n' \"$@\" > words\nexit 2\n", encoding="utf-8")
    (folder / "drivelint").chmod(0o755)
    files = {name: str(folder / name) for name in ("GITHUB_OUTPUT", "GITHUB_STEP_SUMMARY")}
    done = run(check["run"], folder, PATH=f"{folder}{os.pathsep}{os.environ['PATH']}", **env, **files)
    return (
        done,
        (folder / "words").read_text(encoding="utf-8").splitlines(),
        Path(files["GITHUB_STEP_SUMMARY"]).read_text(),
    )


def test_inputs_of_the_action_are_words_or_lines(tmp_path: Path) -> None:
    out = ["--out", "results"]
    _, words, _ = action_step(tmp_path, logs="a.mcap  b.mcap", options="--fail-on major")
    assert words == ["check", "a.mcap", "b.mcap", *out, "--fail-on", "major"]
    _, words, _ = action_step(
        tmp_path, logs="my drives/a b.mcap\n\nc.mcap\n", map="my road.xodr", options="--waivers\nmy waivers.toml"
    )
    assert words == [
        "check",
        "my drives/a b.mcap",
        "c.mcap",
        "--map",
        "my road.xodr",
        *out,
        "--waivers",
        "my waivers.toml",
    ]
    _, words, _ = action_step(tmp_path, logs="$(touch x); *", options="`touch y` \"'")
    assert words == ["check", "$(touch", "x);", "*", *out, "`touch", "y`", "\"'"]


def test_the_action_does_not_show_an_earlier_result_as_its_own(tmp_path: Path) -> None:
    (tmp_path / "results").mkdir()
    for name in ("summary.json", "report.md"):
        (tmp_path / "results" / name).write_text("an earlier PASS", encoding="utf-8")
    done, _, summary = action_step(tmp_path, logs="a.mcap", options="--wrong")
    assert done.returncode == 2
    assert summary == "## drivelint: exit 2, without a result: see the log of this step\n"


@pytest.mark.ci
def test_the_hooks_that_a_repository_takes_stop_a_commit(drives: Path) -> None:
    clientlib = pytest.importorskip(
        "pre_commit.clientlib", reason="pre-commit is not installed: pip install pre-commit"
    )
    hooks = {hook["id"]: hook for hook in clientlib.load_manifest(ROOT / ".pre-commit-hooks.yaml")}
    path = with_tools(drives)
    (drives / "drivelint.toml").write_text('map = "road.xodr"\n', encoding="utf-8")
    assert (
        run("drivelint rules new mine.r1 --dir rules", drives, PATH=path, PYTHONPATH=str(ROOT / "src")).returncode == 0
    )
    codes = {}
    for name, hook in hooks.items():
        line = " ".join([hook["entry"], *hook["args"]])
        codes[name] = run(line, drives, PATH=path, PYTHONPATH=str(ROOT / "src")).returncode
    assert codes == {"drivelint-rules": 0, "drivelint-check": 1}
    assert re.search(hooks["drivelint-check"]["files"], "drives/a.mcap")
    for place in ("road.xodr", "maps/town.osm", "town.net.xml", "drivelint.toml"):
        assert re.search(hooks["drivelint-check"]["files"], place), "what the check reads starts it"
    assert not re.search(hooks["drivelint-check"]["files"], "notes.md")
    assert re.search(hooks["drivelint-rules"]["files"], "rules/mine/r1.sql")


def test_the_guide_takes_what_is_there() -> None:
    told = {
        block.argument: yaml.safe_load(block.body)
        for block in blocks(FOLDER / "ready-made.md")
        if block.word == "workflow"
    }
    (used,) = (step for step in told["action"]["jobs"]["check"]["steps"] if "with" in step)
    action = yaml.safe_load((ROOT / ".github" / "action" / "action.yml").read_text(encoding="utf-8"))
    assert used["uses"].endswith("/.github/action")
    assert used["with"].keys() <= action["inputs"].keys()
    hooks = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
    assert [hook["id"] for hook in told["hooks"]["repos"][0]["hooks"]] == [hook["id"] for hook in hooks]


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_the_steps_of_the_image_make_one_that_runs_and_is_small(drives: Path) -> None:
    """No builder is needed: the steps are run here, in a folder in the place of the image's."""
    text = (ROOT / ".ci" / "Dockerfile").read_text(encoding="utf-8")
    home = drives / "image"
    steps = [step.replace("\\\n", " ") for step in re.findall(r"^RUN ((?:.*\\\n)*.*)$", text, re.MULTILINE)]
    install, trim = (step for step in steps if "/opt/drivelint" in step)
    here = {"/opt/drivelint": str(home), "/src": str(ROOT), "python -m": "python3 -m"}
    for step in (install, trim):
        for there, place in here.items():
            step = step.replace(there, place)  # noqa: PLW2901
        done = run(step, drives)
        if step.startswith("python3 -m venv") and done.returncode:
            pytest.skip(f"the package index cannot be reached: {done.stderr.strip()[-200:]}")
        assert done.returncode == 0, done.stderr
    path = f"{home / 'bin'}{os.pathsep}{os.environ['PATH']}"
    done = run(
        "drivelint check drives --map road.xodr --out results",
        drives,
        PATH=path,
        PYTHONPATH="",
        DRIVELINT_CACHE_DIR="cache",
    )
    assert done.returncode == 1, done.stderr
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w:gz", compresslevel=6) as layer:
        layer.add(home, "opt/drivelint")
    assert BASE_BYTES + packed.tell() < MOST_IMAGE_BYTES
