"""What strangers write into names: each part would do something in some output if that output took it for its own."""

from __future__ import annotations

from typing import Final

PARTS: Final = (
    "\x1b]8;;https://evil.example\x07link\x1b]8;;\x07\x1b[31m\x9b31m\x7f",
    "\r\n::error::forged\n##[error]forged ##vso[task.complete]forged\nexit 0: nothing failed\n",
    "</title></style></script><script>alert(1)</script><img src=x onerror=alert(2)><a href='javascript:alert(3)'>",
    "\"'; DROP TABLE verdict; --\n.shell touch pwned\n",
    "[x](javascript:alert(4)) ![i](https://evil.example/p.png) | a | `code` ```\n# head\n- **b** ~~s~~ $m$ @team #12",
    "\u202eevil\u2066\u200b\ufeff\u2028",
    "[red]rich[/red] [link=https://evil.example]l[/link] {0} {{ 7*7 }} %s $(touch pwned) &amp; \\",
    "\x00\x08\x0b end",
)
EVIL: Final = "".join(PARTS)
EGO: Final = f"=1+1{EVIL}"
ONCOMING: Final = f"@o{EVIL}"
LONG: Final = f"-{'L' * 999}"
"""As long as an actor's id may be."""
TOO_LONG: Final = "L" * 100_000
FILE: Final = (
    "=1+1\x1b[31m\n::error::x ##[error] <img src=x onerror=alert(1)> '\""
    "`touch pwned`$(touch pwned); | [x](javascript:1) \u202eevil"
)
"""A file name holds no NUL and no slash, and at most 255 bytes."""
MARK: Final = "evil"
"""A word that is in each of them but the long one, so that a test knows that it looked at one."""
