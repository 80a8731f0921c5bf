"""Fill the templates: one way for every page, with the words, numbers and style sheet that they share."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from functools import cache
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from replicate.display import consequences, environment, numbers, scores, words
from replicate.display.addresses import anchor
from replicate.display.distance import off
from replicate.display.keeping import Keep, made_anew
from replicate.display.labels import cell_keys, cited, key_text
from replicate.display.markdown import MarkdownBatch, without_marks
from replicate.display.safe_html import policy
from replicate.figures.style import dark_curves
from replicate.plain_text import visible
from replicate.resources import templates_dir


def html_environment() -> jinja2.Environment:
    """Return the environment of all templates that make HTML: escaped, and with nothing silently empty."""
    return _environment(templates_dir())


@cache
def _environment(folder: Path) -> jinja2.Environment:
    """Return an environment that compiles each template of a folder once; `_BATCH` is that of the page at hand."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(folder),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        finalize=_written,
    )
    environment.filters |= {
        "md": _registering(MarkdownBatch.block),
        "inline": _registering(MarkdownBatch.inline),
        "plain": _registering(MarkdownBatch.plain),
        "key": _registering(_key),
    }
    return environment


def _written(value: Any) -> Any:
    """Write out what would pass for a mark of the page being filled; what is HTML already may be one."""
    return without_marks(value) if isinstance(value, str) and not isinstance(value, Markup) else value


def render(template: str, name: str, keep: Keep = made_anew, **context: Any) -> str:
    """Return a page.

    Parameters
    ----------
    template
        File name in the folder of the templates.
    name
        File name of the page, for error messages.
    keep
        Keeps the texts of the page as they were converted, between runs.
    context
        What the template shows, besides the words, numbers and scores that all pages use.

    Raises
    ------
    TemplateError
        If a text of the page cannot be converted.
    """
    batch = MarkdownBatch(name, keep)
    _BATCH.set(batch)
    page = html_environment().get_template(template)
    text = page.render(
        context,
        words=words,
        anchor=anchor,
        cell_keys=cell_keys,
        key_text=key_text,
        cited=cited,
        scores=scores,
        consequences=consequences,
        numbers=numbers,
        off=off,
        script=_script,
        versions=environment.versions(),
        style=Markup(_STYLE),  # noqa: S704 -- two marks, replaced below
        policy=Markup(_POLICY),  # noqa: S704
    )
    return visible(with_policy(batch.substitute(text).replace(_STYLE, style_sheet(context.get("theme") or {}))))


_BATCH: ContextVar[MarkdownBatch] = ContextVar("batch")


def _registering(method: Callable[..., Markup]) -> Callable[..., Markup]:
    """Return a filter that registers a text with the page at hand; never evaluated where a template is compiled."""

    @jinja2.pass_context
    def register(_context: object, *arguments: Any) -> Markup:
        return method(_BATCH.get(), *arguments)

    return register


def _script(name: str) -> Markup:
    """Return a hand-written script of the pages."""
    return Markup((templates_dir() / name).read_text(encoding="utf-8"))  # noqa: S704 -- the project's own


_STYLE, _POLICY = "\ue006style\ue007", "\ue006policy\ue007"


def style_sheet(theme: Mapping[str, str]) -> str:
    """Return the style sheet of all pages, in the colours of a project where it names some."""
    style = (templates_dir() / "style.css").read_text(encoding="utf-8") + dark_curves() + math_font()
    colours = "".join(f"--{_COLOURS[name]}: {colour}; " for name, colour in theme.items())
    return f"{style}@media not (prefers-color-scheme: dark) {{ :root {{ {colours}}} }}\n" if colours else style


@cache
def math_font() -> str:
    """Return the rule that gives a page the font of its formulas."""
    font = base64.b64encode((templates_dir() / "fonts" / "math.woff").read_bytes()).decode()
    return f'@font-face {{ font-family: "Replicate Math"; src: url(data:font/woff;base64,{font}); }}\n'


_PICTURE = '<img src="data/'  # of the project's own; images in texts do not pass
_COLOURS = {"accent": "link", "paper": "bg", "ink": "ink"}


def with_policy(page: str) -> str:
    """Return a page with the policy that allows the styles and scripts it carries, its pictures, and nothing else."""
    styles, scripts = (re.findall(rf"<{name}[^>]*>(.*?)</{name}>", page, re.DOTALL) for name in ("style", "script"))
    return page.replace(_POLICY, policy(styles, scripts, pictures=_PICTURE in page))


def _key(batch: MarkdownBatch, key: str, labels: Mapping[str, str]) -> Markup:
    """Return the display text of a row or column key: its label, or the key in words."""
    return batch.inline(labels[key]) if key in labels else Markup.escape(numbers.minus_signs(key_text(key)))
