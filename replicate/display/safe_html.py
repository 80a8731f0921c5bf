"""Texts of strangers on our pages: what may stay of the HTML that they become, and what the browser may do.

A paper's prose may come from a pull request. So only the elements and attributes that the pages need pass, links lead
to web pages and mail addresses only, images do not pass at all, and a policy in the page forbids everything that the
page does not carry itself.
"""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Sequence

import nh3


def _names(text: str) -> set[str]:
    return set(text.split())


_MATH = _names(
    """math mrow mi mn mo ms mtext mspace mfrac msqrt mroot msub msup msubsup munder mover munderover mmultiscripts
    mprescripts none mtable mtr mtd mstyle menclose mpadded mphantom merror semantics annotation"""
)
_TEXT = _names(
    """p em strong a code pre ul ol li blockquote table caption colgroup col thead tbody tfoot tr th td h1 h2 h3 h4 h5
    h6 sub sup br hr del section dl dt dd span aside"""
)
_MATH_ATTRIBUTES = _names(
    """display mathvariant stretchy form encoding columnalign accent accentunder fence separator columnspacing
    rowspacing displaystyle scriptlevel lspace rspace minsize maxsize width height depth linethickness notation
    columnlines rowlines"""
)

_ATTRIBUTES: dict[str, set[str]] = {
    **dict.fromkeys(_MATH, _MATH_ATTRIBUTES),
    "a": {"href", "id", "class", "role"},
    "li": {"id"},
    "section": {"class", "role"},
    "ol": {"start", "type"},
    "span": {"class"},
    "code": {"class"},
    "pre": {"class"},
    "tr": {"class"},
    "th": {"scope"},
}

_SCHEMES = ("http", "https", "mailto", "doi")
_STRAY = re.compile(rf"\s*[/\\]{{2}}|(?!({'|'.join(_SCHEMES)}):)[^/?#]*:", re.IGNORECASE)


def strays(address: str) -> bool:
    """Say whether a link neither names one of the schemes nor stays in the report."""
    return bool(_STRAY.match(address))


def _kept(tag: str, attribute: str, value: str) -> str | None:
    """Return an attribute's value, none for a link that strays."""
    del tag
    return None if attribute == "href" and strays(value) else value


_CLEANER = nh3.Cleaner(
    tags=_MATH | _TEXT,
    attributes=_ATTRIBUTES,
    attribute_filter=_kept,
    url_schemes=set(_SCHEMES),
    link_rel=None,
)


def sanitised(text: str) -> str:
    """Return HTML with everything removed that a text on a page does not need.

    Examples
    --------
    >>> sanitised('<p onclick="x()">A <a href="javascript:x()">link</a><img src="http://x/y.png"></p>')
    '<p>A <a>link</a></p>'
    """
    return _CLEANER.clean(text)


def policy(styles: Sequence[str], scripts: Sequence[str], *, pictures: bool = False) -> str:
    """Return the Content-Security-Policy of a page that carries its styles and scripts itself.

    Parameters
    ----------
    styles, scripts
        The exact texts of its style and script elements; nothing else runs.
    pictures
        Whether it shows pictures that lie beside it.

    Examples
    --------
    >>> policy([], [])[:42]
    "default-src 'none'; script-src 'none'; sty"
    """
    return "; ".join(
        (
            "default-src 'none'",
            f"script-src {_hashes(scripts)}",
            f"style-src-elem {_hashes(styles)}",
            "style-src-attr 'unsafe-inline'",  # drawings place their parts with style attributes
            "img-src data: 'self'" if pictures else "img-src data:",
            "font-src data:",
            "base-uri 'none'",
            "form-action 'none'",
        )
    )


def _hashes(texts: Sequence[str]) -> str:
    digests = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in texts]
    return " ".join(f"'sha256-{digest}'" for digest in digests) or "'none'"
