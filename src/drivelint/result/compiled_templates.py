"""Caches compiled templates: compiling the templates of a report takes longer than judging a short drive."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from jinja2 import BytecodeCache

from drivelint.memo import Memo

if TYPE_CHECKING:
    from jinja2.bccache import Bucket

# compiled templates contain values from these files, so a change of the files must invalidate the cache
_TEMPLATE_MEMO: Final = Memo[bytes](
    "templates", bytes, ("*.py", "report/html/*.py", "result/*.py", "incident/*.py", "fleet_report/*.py")
)


class CompiledTemplates(BytecodeCache):
    """The compiled templates of one kind of Jinja environment; another kind may compile the same template differently."""

    def __init__(self, kind: str) -> None:
        """Store the name of the kind."""
        self._kind = kind

    def load_bytecode(self, bucket: Bucket) -> None:
        """Fill a bucket with the stored code."""
        if (bytecode := _TEMPLATE_MEMO.get(self._memo_key(bucket))) is not None:
            bucket.bytecode_from_string(bytecode)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Store the compiled code."""
        _TEMPLATE_MEMO.put(self._memo_key(bucket), bucket.bytecode_to_string())

    def _memo_key(self, bucket: Bucket) -> str:
        return f"{self._kind} {bucket.key} {bucket.checksum}"
