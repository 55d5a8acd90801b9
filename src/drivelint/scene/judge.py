"""Judges the scenes of a file in one run, and compares the verdicts with the expected ones."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple

from drivelint import catalogue
from drivelint.convert import ConvertRequest, convert
from drivelint.errors import DriveLintError, ExitCode, SceneFileError, TraceError, UsageError
from drivelint.phrases import hint, nearest_word, plural
from drivelint.reasons.reason_text import code_and_nested_codes
from drivelint.report.progress import Silent
from drivelint.result.publishing import publish
from drivelint.run import CheckOptions, check
from drivelint.scene import document
from drivelint.scene.scene import scenes_of

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterator, Mapping, Sequence

    from drivelint.catalogue import Rule
    from drivelint.result.model import Result
    from drivelint.scene.document import SceneEntry
    from drivelint.scene.scene import Scene

NOT_JUDGED: Final = "refused"
"""The verdict on a scene whose log could not be judged."""
_VERDICTS_BY_EXPECTATION: Final = {
    "fail": {"fail"},
    "pass": {"pass"},
    "unknown": {"unknown"},
    "not_applicable": {"not_applicable"},
    "refused": {NOT_JUDGED},
    "not fail": {"pass", "unknown", "not_applicable", NOT_JUDGED},
    "not pass": {"fail", "unknown", "not_applicable", NOT_JUDGED},
}
"""Expected words -> the verdicts that match them."""
_EXPECTATION: Final = re.compile(
    r"(?P<verdict>[a-z_]+(?: [a-z]+)?)(?: \((?P<code>\w+)\))?(?:: (?P<why>.+))?", re.DOTALL
)
_VERDICTS_WORST_FIRST: Final = ("error", "fail", "unknown", "pass", "not_applicable")
_GRAVE_SEVERITIES: Final = {"critical", "major"}

Row = dict[str, Any]
Key = tuple[str, str]
"""The name of a scene, and a rule's id."""


class Expectation(NamedTuple):
    """The expected verdict of a rule, its reason code (None: any), and the author's explanation."""

    verdict: str
    code: str | None
    why: str


class VerdictsOfScenes(NamedTuple):
    """The rows of verdicts of some scenes, by scene and rule; and why a log could not be judged, by scene."""

    rows: Mapping[Key, Sequence[Row]]
    refusals: Mapping[str, str]

    def verdict(self, key: Key) -> str:
        """Return the verdict of a rule on a scene: the worst verdict of its rows."""
        verdicts = {row["verdict"] for row in self.rows.get(key, ())}
        return next((verdict for verdict in _VERDICTS_WORST_FIRST if verdict in verdicts), NOT_JUDGED)

    def reason_codes_of_verdict(self, key: Key) -> set[str]:
        """Return the reason codes of the rows with the worst verdict."""
        worst = self.verdict(key)
        return {code for row in self.rows.get(key, ()) if row["verdict"] == worst for code in reason_codes(row)}

    def reasons_text(self, key: Key) -> str:
        """Return the reasons, as sentences, of the rows with the worst verdict, or why the log could not be judged."""
        worst = self.verdict(key)
        if worst == NOT_JUDGED:
            return self.refusals.get(key[0], "the rule was not run")
        return "; ".join(sorted({row["reason"] for row in self.rows.get(key, ()) if row["verdict"] == worst}))


def reason_codes(row: Row) -> set[str]:
    """Return the codes of the reason and of the cause in a row of verdicts."""
    codes = {row["reason_code"]} if row["reason_code"] else set()
    if row["cause_code"]:
        codes |= set(code_and_nested_codes(row["cause_code"], json.loads(row["cause_args"] or "{}")))
    return codes


def expectation(text: str) -> Expectation:
    """Read an expectation, such as `fail: it touches the car`. Errors: `UsageError`."""
    match = _EXPECTATION.fullmatch(text.strip())
    verdict = match["verdict"] if match else text.partition(":")[0]
    if match is None or verdict not in _VERDICTS_BY_EXPECTATION:
        raise UsageError(f"{verdict!r} is no verdict: {hint(verdict, _VERDICTS_BY_EXPECTATION)}")
    return Expectation(verdict, match["code"], match["why"] or "")


def judge_scenes(
    scenes: Sequence[Scene], rules: Sequence[str], folder: Path, rules_dirs: Sequence[Path] = ()
) -> VerdictsOfScenes:
    """Write the scenes into an empty folder and judge them as drives of one run. Errors: as `check`."""
    for scene in scenes:
        at = folder / scene.name
        at.mkdir(parents=True)
        for name, content in scene.files().items():
            (at / name).write_bytes(content)
    options = CheckOptions(
        (str(folder),),
        rules=tuple(rules),
        rules_dirs=tuple(rules_dirs),
        profiles=("nominal", "observed"),
        robustness=False,
    )
    results: list[Result] = []
    try:
        results.append(check(options, Silent(), on_nothing_judged=results.append))
    except TraceError:
        if not results:
            raise
    rows_by_key: dict[Key, list[Row]] = defaultdict(list)
    names = {scene.name for scene in scenes}
    for row in results[0].verdicts.to_pylist():
        drive = row["drive_id"]
        rows_by_key[drive if drive in names else drive.rpartition("-")[0], row["rule_id"]].append(row)
    refusals = {
        drive["file_name"]: drive["status_reason"].removeprefix(f"{folder / drive['file_name']}: ")
        for drive in results[0].drives.to_pylist()
        if drive["status"] == "not_judged"
    }
    return VerdictsOfScenes(rows_by_key, refusals)


def differences(scene: Scene, verdicts: VerdictsOfScenes, gating: Container[str]) -> Iterator[str]:
    """Yield each difference between verdicts and expectations. `gating`: rules whose critical and major fails must be expected."""
    expectations = {rule: expectation(text) for rule, text in scene.text.expect.items()}
    for rule, expected_verdict in expectations.items():
        key = scene.name, rule
        got = verdicts.verdict(key)
        if got not in _VERDICTS_BY_EXPECTATION[expected_verdict.verdict]:
            why = f" ({expected_verdict.why})" if expected_verdict.why else ""
            yield f"{rule}: expected {expected_verdict.verdict}{why}, got {got}: {verdicts.reasons_text(key)}"
        elif expected_verdict.code and expected_verdict.code not in verdicts.reason_codes_of_verdict(key):
            codes = ", ".join(sorted(verdicts.reason_codes_of_verdict(key)))
            yield f"{rule}: expected {got} for {expected_verdict.code}, got {codes}: {verdicts.reasons_text(key)}"
    for (name, rule), rows in sorted(verdicts.rows.items()):
        if name != scene.name or rule in expectations or rule not in gating:
            continue
        if any(row["verdict"] in {"fail", "error"} and row["severity"] in _GRAVE_SEVERITIES for row in rows):
            yield f"{rule}: not expected to fail: {verdicts.reasons_text((name, rule))}"


def scene_test(
    path: Path,
    only: Sequence[str],
    rules_dirs: Sequence[Path],
    say: Callable[[str], None],
    *,
    out: Path | None = None,
    to: Literal["mcap", "parquet"] = "parquet",
) -> ExitCode:
    """Judge the scenes of a file whose names begin with one of `only` (empty: all), and call `say` with the result of each.

    `out`: the log and the map of each scene are written there, in a folder with its name. Return FAILED if a verdict is not as expected.
    Errors: `UsageError` for mistakes in the file, `OutputError`.
    """
    file = document.read(path)
    texts = [text for text in file.scenes if not only or text.name.startswith(tuple(only))]
    if not texts:
        near = [word for name in only if (word := nearest_word(name, (text.name for text in file.scenes)))]
        suggestion = f"; did you mean {near[0]!r}?" if near else ""
        raise UsageError(f"{path}: none of its {len(file.scenes)} scenes has such a name{suggestion}")
    rules = catalogue.load_rules(tuple(rules_dirs))
    scenes = scenes_of(texts, file.roads)
    _refuse_wrong_expectations(path, texts, rules)
    for scene in scenes:
        try:
            files = scene.files()
        except DriveLintError as error:
            raise UsageError(f"{path}:{scene.text.line}: scene {scene.text.name!r}: {error}") from error
        if out is not None:
            _write_log(out / scene.name, files, to)
    with TemporaryDirectory() as folder:
        verdicts = judge_scenes(
            scenes, rule_selectors_for_scenes(texts, all_fails=file.all_fails), Path(folder), rules_dirs
        )
    gating = gating_rules(rules) if file.all_fails else frozenset()
    code = ExitCode.OK
    for scene in scenes:
        wrong = list(differences(scene, verdicts, gating))
        headline = f"{'FAIL' if wrong else 'ok  '} {scene.name}: {plural(len(scene.text.expect), 'verdict')}"
        say("\n".join([headline, *(f"     {path}:{scene.text.line}: {line}" for line in wrong)]))
        code = max(code, ExitCode.FAILED if wrong else ExitCode.OK)
    return code


def rule_selectors_for_scenes(texts: Sequence[SceneEntry], *, all_fails: bool) -> list[str]:
    """Return the rules by which scenes are judged: the rules that they name, and with `all_fails` all stable rules."""
    return [*(["status:stable"] if all_fails else []), *sorted({rule for text in texts for rule in text.expect})]


def gating_rules(rules: Mapping[str, Rule]) -> frozenset[str]:
    """Return the rules whose critical and major fails must be expected: all stable rules."""
    return frozenset(rule.id for rule in rules.values() if rule.status == "stable")


def _unknown_rule_message(rule_id: str, rules: Mapping[str, Rule]) -> str:
    """Return the message for an unknown rule, with the most similar known rule, or with how to add its pack."""
    pack, dot, name = rule_id.partition(".")
    packs = {rule.pack for rule in rules.values()}
    if dot and pack not in packs:
        near = nearest_word(pack, packs)
        suggestion = f"; did you mean {near!r}?" if near else ""
        return f"no rule {rule_id!r}, as there is no pack {pack!r}{suggestion}: give its folder with --rules-dir"
    holding = min((known_id for known_id in rules if (name or pack) in known_id), key=len, default=None)
    near = holding or nearest_word(rule_id, rules, cutoff=0.75)
    return f"no rule {rule_id!r}; {f'did you mean {near!r}?' if near else 'drivelint rules list shows them all'}"


def _refuse_wrong_expectations(path: Path, texts: Sequence[SceneEntry], rules: Mapping[str, Rule]) -> None:
    """Raise `UsageError` with a line for each unknown rule and verdict that scenes expect."""
    problems = []
    for text in texts:
        place = f"{path}:{text.line}: scene {text.name!r}: "
        for rule, text_of_verdict in text.expect.items():
            if rule not in rules:
                problems.append(f"{place}expect: {_unknown_rule_message(rule, rules)}")
            try:
                expectation(text_of_verdict)
            except UsageError as error:
                problems.append(f"{place}{error}")
    if problems:
        raise SceneFileError("\n".join(problems))


def _write_log(folder: Path, files: dict[str, bytes], to: Literal["mcap", "parquet"]) -> None:
    if to == "parquet":
        publish(folder, files, {})
        return
    with TemporaryDirectory() as temporary:
        log = Path(temporary) / folder.name
        publish(log, files, {})
        convert(ConvertRequest(str(log), to, folder))
