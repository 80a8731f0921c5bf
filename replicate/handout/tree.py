"""Pandoc's document tree, as the nested lists and dictionaries of its JSON form.

Every element is ``{"t": type, "c": contents}``. Attributes are ``[id, classes, [[key, value], ...]]``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

Element = dict[str, Any]
Blocks = list[Element]


_WORDS = {"Str", "Space", "SoftBreak", "LineBreak"}  # nine of ten elements
_TEXTS = {"Para", "Plain", "Header", "LineBlock"}  # blocks that hold no blocks, footnotes aside


def elements(node: object, *, words: bool = False) -> Iterator[Element]:
    """Yield every element below a node, in the order of the text.

    Parameters
    ----------
    words
        Whether words and the spaces between them are wanted, too.
    """
    unwanted = () if words else _WORDS
    waiting = [node]  # a stack, not a recursion: trees of a class set are walked a thousand times
    while waiting:
        found = waiting.pop()
        if isinstance(found, list):
            waiting += [
                child
                for child in reversed(found)
                if isinstance(child, list) or (isinstance(child, dict) and child.get("t") not in unwanted)
            ]
        elif isinstance(found, dict):
            if "t" in found:
                yield found
            content = found.get("c")
            if isinstance(content, list | dict):
                waiting.append(content)


def transform(node: Any, change: Callable[[Element], list[Element] | None], *, texts: bool = True) -> Any:
    """Return a copy in which elements are replaced, children before their parents.

    Parameters
    ----------
    change
        Gets an element whose children are changed already; returns what takes its place, or ``None`` to keep
        it. Words and the spaces between them stay what they are.
    texts
        Whether what is inside paragraphs and headings may change, or only blocks.
    """
    if isinstance(node, list):
        out: list[Any] = []
        for child in node:
            if isinstance(child, dict) and "t" in child:
                if child["t"] in _WORDS:
                    out.append(child)
                    continue
                leaf = "c" not in child or (not texts and child["t"] in _TEXTS)
                kept = child if leaf else {**child, "c": transform(child["c"], change, texts=texts)}
                replaced = change(kept)
                out += [kept] if replaced is None else replaced
            else:
                out.append(transform(child, change, texts=texts) if isinstance(child, list) else child)
        return out
    return node


def classes(element: Element) -> list[str]:
    """Return the classes of a Div, Span, CodeBlock or Header; of any other element none."""
    places = {"Div": 0, "Span": 0, "CodeBlock": 0, "Header": 1}
    place = places.get(element["t"])
    return [] if place is None else list(element["c"][place][1])


def text_of(node: object) -> str:
    """Return the words of a node as plain text; formulas as their LaTeX source."""
    out = []
    for element in elements(node, words=True):
        match element["t"]:
            case "Str":
                out.append(element["c"])
            case "Code" | "Math":
                out.append(element["c"][1])
            case "Space" | "SoftBreak" | "LineBreak":
                out.append(" ")
    return "".join(out)


def string(text: str) -> Element:
    """Return a word; it may hold spaces that must not break."""
    return {"t": "Str", "c": text}


def math(tex: str) -> Element:
    """Return an inline formula."""
    return {"t": "Math", "c": [{"t": "InlineMath"}, tex]}


def raw_inline(target: str, text: str) -> Element:
    """Return text for one output format."""
    return {"t": "RawInline", "c": [target, text]}


def raw_block(target: str, text: str) -> Element:
    """Return a block for one output format."""
    return {"t": "RawBlock", "c": [target, text]}


def span(content: Sequence[Element], *names: str) -> Element:
    """Return inline content with classes."""
    return {"t": "Span", "c": [["", list(names), []], list(content)]}


def div(content: Sequence[Element], *names: str, **attributes: str) -> Element:
    """Return blocks with classes and attributes."""
    return {"t": "Div", "c": [["", list(names), [list(pair) for pair in attributes.items()]], list(content)]}


def attribute(element: Element, key: str) -> str:
    """Return an attribute of a Div or Span, empty if it has none of that name."""
    return str(dict(element["c"][0][2]).get(key, ""))


def plain(content: Sequence[Element]) -> Element:
    """Return a block of inline content that is not a paragraph."""
    return {"t": "Plain", "c": list(content)}


def inlines(text: str) -> list[Element]:
    r"""Return short Markdown-like text as inline content: words, and LaTeX math between ``$``.

    Examples
    --------
    >>> [element["t"] for element in inlines("by $K_p/T_i$, exact")]
    ['Str', 'Space', 'Math', 'Str', 'Space', 'Str']
    """
    out: list[Element] = []
    for place, part in enumerate(text.split("$")):
        if place % 2:
            out.append(math(part))
            continue
        words = part.split(" ")
        for number, word in enumerate(words):
            if number:
                out.append({"t": "Space"})
            if word:
                out.append(string(word))
    return out
