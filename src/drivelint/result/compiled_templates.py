"""Keeps compiled templates: to compile those of a report takes longer than to judge a short drive."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from jinja2 import BytecodeCache

from drivelint.memo import Memo

if TYPE_CHECKING:
    from jinja2.bccache import Bucket

# what is filled in while a template is compiled is of this code
_COMPILED: Final = Memo[bytes](
    "templates", bytes, ("*.py", "report/html/*.py", "result/*.py", "incident/*.py", "fleet_report/*.py")
)


class CompiledTemplates(BytecodeCache):
    """The compiled templates of one kind of environment: one template may be compiled otherwise in another."""

    def __init__(self, kind: str) -> None:
        """Take the kind's name."""
        self._kind = kind

    def load_bytecode(self, bucket: Bucket) -> None:
        """Fill a bucket with the stored code."""
        if (known := _COMPILED.get(self._name(bucket))) is not None:
            bucket.bytecode_from_string(known)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Store the compiled code."""
        _COMPILED.put(self._name(bucket), bucket.bytecode_to_string())

    def _name(self, bucket: Bucket) -> str:
        return f"{self._kind} {bucket.key} {bucket.checksum}"
