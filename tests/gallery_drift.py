"""The gallery under another matplotlib and other kernels: ``write FOLDER`` here, ``compare FOLDER`` there.

``make drift`` runs both. An alarm is a fault of ours: nothing but the libraries differs.
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl
from gallery import GALLERY
from matplotlib.figure import Figure

from replicate.figures import Record, capture, compare

#: What matplotlib itself draws in another way: the frame of an inset is one artist since 3.10, and labels of a pie have
#: other alignments and another order since 3.11. docs/what-is-compared.md names them.
EXCEPTIONS = {"inset", "pie"}


def drawn(name: str) -> Record:
    figure = Figure()
    GALLERY[name](figure)
    return capture(figure)


def main() -> int:
    """Write records, or compare with those that were written; return the exit status."""
    action, folder = sys.argv[1], Path(sys.argv[2])
    if action == "write":
        folder.mkdir(parents=True, exist_ok=True)
        for name in GALLERY:
            (folder / f"{name}.json").write_text(drawn(name).to_json(), encoding="utf-8")
        return 0
    alarms = 0
    for name in sorted(GALLERY.keys() - EXCEPTIONS):
        changes = compare(Record.from_json((folder / f"{name}.json").read_text(encoding="utf-8")), drawn(name)).changes
        alarms += bool(changes)
        for text in changes:
            sys.stdout.write(f"{name}: {text}\n")
    sys.stdout.write(f"matplotlib {mpl.__version__}: {alarms} of {len(GALLERY)} figures of the gallery differ\n")
    return min(alarms, 1)


if __name__ == "__main__":
    sys.exit(main())
