"""Forged packs: every file is hashed anew, what nobody signs is changed, or the owner of the key signs what is not so.

`SCRIPT_FINDS` is what the guide's script finds, too. `SCRIPT_MISSES` it cannot find, and each says why.
"""

from __future__ import annotations

import base64
import json
import os
import shutil
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.errors import UsageError
from drivelint.pack import VerifyRequest, verify
from tests.pack.packed import (
    INFO,
    KEY,
    MANIFEST,
    STATEMENT,
    TAG_MANIFEST,
    change_byte,
    change_evidence,
    change_numbers,
    change_table,
    copied,
    edit,
    inner,
    into,
    log_of,
    rehash,
    rewrite_reports,
    rows_of,
    script,
    sql_of,
    to_pass,
)

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.pack.conftest import Packed
    from tests.pack.packed import Tamper
VERDICTS, SUMMARY, EVIDENCE = "data/result/verdicts.parquet", "data/result/summary.json", "data/evidence.json"
OTHER_PACK = ("file changed since the statement about it", "manifest-sha256.txt")
SCRIPT_FINDS: dict[str, Tamper] = {}
SCRIPT_MISSES: dict[str, Tamper] = {}


def change_envelope(pack: Path, change: Callable[[dict[str, Any]], None]) -> None:
    envelope = json.loads((pack / STATEMENT).read_bytes())
    change(envelope)
    (pack / STATEMENT).write_text(json.dumps(envelope, indent=2) + "\n", encoding="utf-8")
    rehash(pack, payload=False)


# One byte in each class of file, all hashes right.

FILES = (
    "data/result/report.html", "data/result/junit.xml", "data/result/run.json", SUMMARY, EVIDENCE, VERDICTS,
    "data/rules/ukhc/no-collision.sql", "data/inputs/map/road.xodr", "data/mapping/mapping.toml",
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.sample(0, ci=99)
@pytest.mark.parametrize("name", [*FILES, "the log", "the SQL", "the rows"])
def test_a_byte_of_each_class_of_file(name: str, packed: Packed, tmp_path: Path) -> None:
    pack = copied(packed, tmp_path)
    path = {"the log": log_of(pack), "the SQL": sql_of(pack), "the rows": rows_of(pack)}.get(name, pack / name)
    change_byte(path)
    assert verify(VerifyRequest(pack, packed.public)).problems == [("file changed", inner(pack, path))]
    assert f"changed, added or removed: {inner(pack, path)}" in script(pack, packed.public, tmp_path).stdout
    rehash(pack)
    problems = verify(VerifyRequest(pack, packed.public)).problems
    # a table that cannot be read any more is named before the statement is compared
    assert OTHER_PACK in problems or problems[0].kind == "result not readable"
    assert "not what was signed: manifest-sha256.txt" in script(pack, packed.public, tmp_path).stdout


# What somebody without the key changes; the hashes are made anew where that helps.


@into(SCRIPT_FINDS)
def verdict_flipped_and_hashed(pack: Path, _p: Packed) -> tuple[str, str]:
    change_table(pack / VERDICTS, "verdict", to_pass)
    rehash(pack)
    return OTHER_PACK


@into(SCRIPT_FINDS)
def verdict_flipped_and_all_follows(pack: Path, _p: Packed) -> tuple[str, str]:
    change_table(pack / VERDICTS, "verdict", to_pass)
    rewrite_reports(pack)
    rehash(pack)
    return "statement says another result", "failedTests"


@into(SCRIPT_FINDS)
def margin_in_the_rows_edited_and_hashed(pack: Path, _p: Packed) -> tuple[str, str]:
    change_numbers(rows_of(pack))
    rehash(pack)
    return OTHER_PACK


@into(SCRIPT_FINDS)
def sql_edited_and_hashed(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(sql_of(pack), "margin, holds", "-0.01 AS margin, holds")
    rehash(pack)
    return OTHER_PACK


@into(SCRIPT_FINDS)
def parameter_edited_and_hashed(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / EVIDENCE, '"ukhc.contact-signature.within_m": "0.4"', '"ukhc.contact-signature.within_m": "0.1"')
    rehash(pack)
    return "statement about another map, rule or parameter", "configuration"


@into(SCRIPT_FINDS)
def log_replaced_and_hashed(pack: Path, p: Packed) -> tuple[str, str]:
    shutil.copyfile(log_of(p.other_pack), log_of(pack))
    rehash(pack)
    return OTHER_PACK


@into(SCRIPT_FINDS)
def map_replaced_and_hashed(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / "data/inputs/map/road.xodr", "<road ", "<road  ")
    rehash(pack)
    return OTHER_PACK


@into(SCRIPT_FINDS)
def older_tool_named_and_hashed(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / SUMMARY, '"version": "', '"version": "0.0.')
    told = json.loads((pack / SUMMARY).read_text("utf-8"))["tool"]
    change_evidence(pack, lambda evidence: evidence.update(tool=told))
    rehash(pack)
    return "statement about another map, rule or parameter", "configuration"


@into(SCRIPT_FINDS)
def manifests_swapped(pack: Path, _p: Packed) -> tuple[str, str]:
    payload, tags = (pack / MANIFEST).read_bytes(), (pack / TAG_MANIFEST).read_bytes()
    (pack / MANIFEST).write_bytes(tags)
    (pack / TAG_MANIFEST).write_bytes(payload)
    return "manifest names a file outside", f"{MANIFEST}: bag-info.txt"


@into(SCRIPT_FINDS)
def manifest_of_another_pack(pack: Path, p: Packed) -> tuple[str, str]:
    shutil.copyfile(p.other_pack / MANIFEST, pack / MANIFEST)
    rehash(pack, payload=False)
    return "file changed", VERDICTS


@into(SCRIPT_FINDS)
def manifest_emptied(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / MANIFEST).write_bytes(b"")
    rehash(pack, payload=False)
    return "file added", VERDICTS


@into(SCRIPT_FINDS)
def manifest_names_a_file_twice(pack: Path, _p: Packed) -> tuple[str, str]:
    line = (pack / MANIFEST).read_text("utf-8").splitlines(keepends=True)[0]
    with (pack / MANIFEST).open("a", encoding="utf-8") as file:
        file.write(line)
    rehash(pack, payload=False)
    return "manifest names a file twice", line[66:-1]


@into(SCRIPT_FINDS)
def manifest_leads_outside(pack: Path, _p: Packed) -> tuple[str, str]:
    with (pack / MANIFEST).open("a", encoding="utf-8") as file:
        file.write(f"{'0' * 64}  data/../../ours.pem\n{'0' * 64}  .\n")
    rehash(pack, payload=False)
    return "manifest names a file outside", "data/../../ours.pem"


@into(SCRIPT_FINDS)
def manifest_names_a_place_from_the_root(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / MANIFEST, "  data/evidence.json", f"  {pack}/data/evidence.json")
    rehash(pack, payload=False)
    return "manifest names a file outside", f"{pack}/data/evidence.json"


@into(SCRIPT_FINDS)
def letters_of_a_name_in_another_case(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / VERDICTS).rename(pack / "data/result/Verdicts.parquet")
    return "file added", "data/result/Verdicts.parquet"


@into(SCRIPT_FINDS)
def two_tables_swapped_and_hashed(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / VERDICTS).rename(pack / "x")
    (pack / "data/result/findings.parquet").rename(pack / VERDICTS)
    (pack / "x").rename(pack / "data/result/findings.parquet")
    rehash(pack)
    return "result not readable", "verdict"


@into(SCRIPT_FINDS)
def info_cut(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / INFO).write_bytes((pack / INFO).read_bytes()[:-10])
    rehash(pack, payload=False)
    return "bag-info.txt not readable", INFO


@into(SCRIPT_FINDS)
def info_removed(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / INFO).unlink()
    rehash(pack, payload=False)
    return "file removed", INFO


@into(SCRIPT_FINDS)
def declaration_removed(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / "bagit.txt").unlink()
    rehash(pack, payload=False)
    return "file removed", "bagit.txt"


@into(SCRIPT_FINDS)
def name_that_is_no_text_added(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / "data/result" / os.fsdecode(b"\xff\x1b[2J.parquet")).write_bytes(b"")
    return "file added", "data/result/\udcff"


@into(SCRIPT_FINDS)
def size_in_the_info_wrong(pack: Path, _p: Packed) -> tuple[str, str]:
    edit(pack / INFO, "Payload-Oxum: ", "Payload-Oxum: 1")
    rehash(pack, payload=False)
    return "Payload-Oxum wrong", INFO


@into(SCRIPT_FINDS)
def note_added_and_hashed(pack: Path, _p: Packed) -> tuple[str, str]:
    """No signature covers the manifest of the tag files."""
    (pack / "README.txt").write_text("all drives passed", encoding="utf-8")
    rehash(pack, payload=False)
    return "file added", "README.txt"


@into(SCRIPT_FINDS)
def list_of_files_to_fetch_added(pack: Path, _p: Packed) -> tuple[str, str]:
    """BagIt would fetch them from elsewhere."""
    (pack / "fetch.txt").write_text("https://example.org/x 3 data/x\n", encoding="utf-8")
    rehash(pack, payload=False)
    return "file added", "fetch.txt"


@into(SCRIPT_FINDS)
def another_kind_of_manifest_added(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / "manifest-md5.txt").write_text(f"{'0' * 32}  {VERDICTS}\n", encoding="utf-8")
    rehash(pack, payload=False)
    return "file added", "manifest-md5.txt"


@into(SCRIPT_FINDS)
def plain_statement_added(pack: Path, _p: Packed) -> tuple[str, str]:
    payload = base64.b64decode(json.loads((pack / STATEMENT).read_bytes())["payload"])
    (pack / "statement.json").write_bytes(payload.replace(b'"FAILED"', b'"PASSED"'))
    rehash(pack, payload=False)
    return "file added", "statement.json"


@into(SCRIPT_FINDS)
def key_replaced_and_hashed(pack: Path, p: Packed) -> tuple[str, str]:
    shutil.copyfile(p.other_public, pack / KEY)
    rehash(pack, payload=False)
    return "another key", KEY


@into(SCRIPT_FINDS)
def key_removed_and_hashed(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / KEY).unlink()
    rehash(pack, payload=False)
    return "file removed", KEY


@into(SCRIPT_FINDS)
def signature_of_another_pack(pack: Path, p: Packed) -> tuple[str, str]:
    other = json.loads((p.other_pack / STATEMENT).read_bytes())["signatures"]
    change_envelope(pack, lambda envelope: envelope.update(signatures=other))
    return "signature wrong", STATEMENT


@into(SCRIPT_FINDS)
def kind_of_payload_changed(pack: Path, _p: Packed) -> tuple[str, str]:
    change_envelope(pack, lambda envelope: envelope.update(payloadType="text/plain"))
    return "signature wrong", STATEMENT


@into(SCRIPT_FINDS)
def link_to_the_same_content(pack: Path, _p: Packed) -> tuple[str, str]:
    """Until somebody changes what it leads to."""
    elsewhere = pack.parent / "elsewhere.parquet"
    (pack / VERDICTS).rename(elsewhere)
    (pack / VERDICTS).symlink_to(elsewhere)
    return "link", VERDICTS


@into(SCRIPT_FINDS)
def link_in_place_of_the_payload(pack: Path, _p: Packed) -> tuple[str, str]:
    (pack / "data").rename(pack.parent / "elsewhere")
    (pack / "data").symlink_to(pack.parent / "elsewhere")
    return "link", "data"


# What the script does not see: it looks at files and at what is signed only.


@into(SCRIPT_MISSES)
def text_before_the_key(pack: Path, _p: Packed) -> tuple[str, str]:
    """The script reads the key in it, and that is the right one."""
    (pack / KEY).write_bytes(b"the key of the ministry\n" + (pack / KEY).read_bytes())
    rehash(pack, payload=False)
    return "text beside the key", KEY


@into(SCRIPT_MISSES)
def name_of_the_key_in_the_envelope_changed(pack: Path, _p: Packed) -> tuple[str, str]:
    """DSSE does not sign it, and the script does not read it."""
    change_envelope(pack, lambda envelope: envelope["signatures"][0].update(keyid="the ministry"))
    return "text beside the signed content", STATEMENT


@into(SCRIPT_MISSES)
def text_added_to_the_envelope(pack: Path, _p: Packed) -> tuple[str, str]:
    """As with the name of the key."""
    change_envelope(pack, lambda envelope: envelope.update(result="PASSED"))
    return "text beside the signed content", STATEMENT


@into(SCRIPT_MISSES)
def second_signature_added(pack: Path, p: Packed) -> tuple[str, str]:
    """The script verifies the first."""
    other = json.loads((p.other_pack / STATEMENT).read_bytes())["signatures"]
    change_envelope(pack, lambda envelope: envelope["signatures"].extend(other))
    return "text beside the signed content", STATEMENT


@into(SCRIPT_MISSES)
def pipe_added(pack: Path, _p: Packed) -> tuple[str, str]:
    """It has no content that could be hashed; reading it would wait for ever."""
    os.mkfifo(pack / "data/pipe")
    return "not a file", "data/pipe"


@pytest.mark.sample(0, ci=99)
@pytest.mark.parametrize("name", [*SCRIPT_FINDS, *SCRIPT_MISSES])
def test_what_was_forged_is_named(name: str, packed: Packed, tmp_path: Path) -> None:
    pack = copied(packed, tmp_path)
    kind, what = (SCRIPT_FINDS | SCRIPT_MISSES)[name](pack, packed)
    found = verify(VerifyRequest(pack, packed.public)).problems
    assert any(each.kind == kind and what in each.subject for each in found), found
    done = script(pack, packed.public, tmp_path)
    assert done.stderr == ""
    assert "\x1b" not in done.stdout
    assert done.returncode == (1 if name in SCRIPT_FINDS else 0), done.stdout


@pytest.mark.ci
def test_the_key_in_the_pack_tells_nothing_as_key(packed: Packed, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="comes with the pack"):
        verify(VerifyRequest(packed.pack, packed.pack / KEY))
