"""Write at the end of each lock when the newest file that it names was published.

Whoever remakes the lock later with ``make lock ARGS="--exclude-newer DATE"`` gets the same packages.
"""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

NOTE = "# newest file published: "


def date(uv: str, lock: Path) -> None:
    """Ask the index through uv, whose ``pylock.toml`` carries the times."""
    command = [uv, "pip", "compile", str(lock), "--format", "pylock.toml", "--universal", "--quiet"]
    done = subprocess.run([*command, "--python-version", "3.11"], capture_output=True, text=True, check=True)  # noqa: S603
    packages = tomllib.loads(done.stdout)["packages"]
    files = [
        file for package in packages for file in (*package.get("wheels", ()), *filter(None, [package.get("sdist")]))
    ]
    newest = max(file["upload-time"] for file in files if "upload-time" in file)
    lines = [line for line in lock.read_text(encoding="utf-8").splitlines() if not line.startswith(NOTE)]
    text = "\n".join([*lines, f"{NOTE}{newest:%Y-%m-%dT%H:%M:%SZ}"]) + "\n"
    lock.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    for name in sys.argv[2:]:
        date(sys.argv[1], Path(name))
