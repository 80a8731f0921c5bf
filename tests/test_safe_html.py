"""What a stranger's text can do to a page: nothing."""

from __future__ import annotations

import base64
import hashlib
import re

from replicate.display.markdown import MarkdownBatch
from replicate.display.rendering import render
from replicate.display.safe_html import sanitised


def test_what_pages_need_passes() -> None:
    batch = MarkdownBatch("page")
    text = "[paper](https://doi.org/10.1/2), [cell](khan.html#table-2), *x* and $\\frac{a}{b}$, see^[A note.]"
    page = batch.substitute(f"<div>{batch.block(text)}</div>")
    for part in (
        '<a href="https://doi.org/10.1/2">',
        '<a href="khan.html#table-2">',
        "<em>x</em>",
        "<mfrac>",
        "A note.",
    ):
        assert part in page


def test_schemes() -> None:
    for scheme in ("http", "https", "mailto", "doi"):
        assert f'href="{scheme}:x"' in sanitised(f'<a href="{scheme}:x">x</a>')
    for scheme in ("javascript", "data", "file", "vbscript", "JaVaScRiPt"):
        assert "href" not in sanitised(f'<a href="{scheme}:x">x</a>')


def test_the_policy_of_a_page_names_its_own_style_and_nothing_else() -> None:
    page = render("methods.html", "methods.html", about=type("About", (), {"methods": "Text."}), verdicts="")
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', page)
    (style,) = re.findall(r"<style>(.*?)</style>", page, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    assert f"style-src-elem &#39;sha256-{digest}&#39;" in policy or f"style-src-elem 'sha256-{digest}'" in policy
    assert "default-src 'none'" in policy
    assert "script-src 'none'" in policy
