"""Texts of the papers' modules say what they mean to say."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import replicate.papers

# what would be computed in an f-string: a call, an index or a format; "{2T/\\theta}" is LaTeX
_FIELD = re.compile(r"\{[a-z_]{2,}[(\[].*\}|\{\w+(\.\w+)*:[^{}]*[defg%]\}")


def plain_strings(source: str) -> list[str]:
    """Return the strings of a module that are neither f-strings nor docstrings."""
    tree = ast.parse(source)
    inside = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in ast.walk(node)}
    alone = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    return [
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in inside | alone
    ]


def test_no_field_is_left_unfilled_for_want_of_an_f() -> None:
    for path in sorted(Path(replicate.papers.__path__[0]).rglob("*.py")):
        unfilled = [text for text in plain_strings(path.read_text(encoding="utf-8")) if _FIELD.search(text)]
        assert not unfilled, path


def test_such_a_field_is_found() -> None:
    assert _FIELD.search('the pole is at {number(rightmost)}."')
    assert _FIELD.search("it is {value:.3f}")
    assert not _FIELD.search(r"$e^{1+ph}$, $\sqrt{2T/\theta}$, $K_{max}$")
