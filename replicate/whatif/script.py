"""The page's script: its modules in one, each after those that it imports."""

from __future__ import annotations

import re
from functools import cache
from graphlib import TopologicalSorter

from replicate.resources import templates_dir

_IMPORT = re.compile(r'^import \{.*\} from "\./(\w+)\.js";\n', re.MULTILINE)
_EXPORT = re.compile(r"^export ", re.MULTILINE)


@cache
def script() -> str:
    """Return the modules of ``templates/whatif`` as one, without what connects them; no two may share a name."""
    texts = {path.stem: path.read_text(encoding="utf-8") for path in sorted((templates_dir() / "whatif").glob("*.js"))}
    order = TopologicalSorter({name: _IMPORT.findall(text) for name, text in texts.items()}).static_order()
    return "\n".join(_EXPORT.sub("", re.sub(r"\n{2,}", "\n\n", _IMPORT.sub("", texts[name]))) for name in order)
