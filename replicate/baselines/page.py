"""The page of a run: what changed in words, both pictures, and the command that accepts what is ticked.

It stands alone: no other file, no network, and without a script everything can be read.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import jinja2
from markupsafe import Markup

from replicate.baselines.outcomes import Outcome
from replicate.baselines.outputs import counted, worst_first
from replicate.display.safe_html import policy
from replicate.resources import templates_dir

#: Pictures of more figures than this would make the page too heavy; the words are there.
MOST_PICTURES = 200


def page(outcomes: Sequence[Outcome], command: Callable[[Outcome], str]) -> str:
    """Return the page.

    Parameters
    ----------
    command
        Returns the command that accepts one figure.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(templates_dir()),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    style = (templates_dir() / "style.css").read_text(encoding="utf-8")
    script = (templates_dir() / "figures.js").read_text(encoding="utf-8")
    return environment.get_template("figures.html").render(
        outcomes=worst_first(outcomes),
        same=[outcome.name for outcome in outcomes if outcome.status == "same"],
        summary=counted(outcomes),
        command=command,
        most_pictures=MOST_PICTURES,
        style=Markup(style),  # noqa: S704  -- our own file
        script=Markup(script),  # noqa: S704
        policy=policy([style], [script]),
    )
