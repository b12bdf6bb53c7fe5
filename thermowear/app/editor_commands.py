"""Commands for editors and shells: the JSON schema of case files, completion of commands."""

from __future__ import annotations

import json
import sys

from ..errors import CaseError
from .arguments import parser
from .case_commands import check_absent


def schema(chosen) -> int:
    """Write the JSON schema of case files."""
    from .schema import case_schema

    text = json.dumps(case_schema(), ensure_ascii=False, indent=1)
    if chosen.output is None:
        print(text)
        return 0
    check_absent(chosen.output, chosen.overwrite)
    try:
        chosen.output.write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise CaseError(f"{chosen.output}: cannot be written: {error.strerror}") from None
    print(f"wrote {chosen.output}")
    return 0


def completion(chosen) -> int:
    """Print the completion of commands and options for a shell."""
    try:
        import shtab
    except ImportError:
        raise CaseError("completion: needs the Python package shtab") from None
    sys.stdout.write(shtab.complete(parser(), chosen.shell, preamble=_preamble()))
    return 0


def _preamble() -> dict[str, str]:
    """Functions that complete names of starters and of verification cases in bash."""
    from ..case.starters import starters
    from ..verification import CASES

    line_ends = "\\n"
    lists = {"starters": [*starters()], "checks": [*CASES]}
    functions = (  # shtab splits words at ends of lines only
        f"_thermowear_{name}() {{ compgen -W $'{line_ends.join(words)}' -- \"$1\"; }}\n"
        for name, words in lists.items()
    )
    return {"bash": "".join(functions)}
