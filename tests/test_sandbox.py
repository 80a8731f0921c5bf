"""Texts of a paper may come from a stranger: what they can reach, how long they run, how large they become."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
import synthetic

from replicate.errors import TemplateError
from replicate.verdicts.prose import Prose

#: A text, and what is said of it. The offence stands in line 2.
REFUSED = {
    "loop": ("{% for a in range(99999) %}{% for b in range(99999) %}{% endfor %}{% endfor %}", "steps"),
    "loop that writes": ("{% for a in range(99999) %}{{ 'long ' * 1000 }}{% endfor %}", "too large"),
    "recursion": ("{% macro m() %}{{ m() }}{% endmacro %}{{ m() }}", "recursion"),
    "branching": ("{% macro m(n) %}{% if n %}{{ m(n-1) }}{{ m(n-1) }}{% endif %}{% endmacro %}{{ m(40) }}", "steps"),
    "long range": ("{{ range(10**9) | list }}", "ange"),
    "multiplied text": ("{{ 'x' * 10**9 }}", "too large"),
    "multiplied list": ("{{ [1] * 10**9 }}", "too large"),
    "multiplied from the left": ("{{ 10**9 * 'x' }}", "too large"),
    "braces": ("{" * 5000 + "}" * 5000, "nests too deeply"),
    "negations": ("{{ " + "not " * 5000 + "1 }}", "nests too deeply"),
    "power": ("{{ 9**(9**9) }}", "too large"),
    "formatted": ("{{ '%999999999d' % 1 }}", "formatted with %"),
    "padded": ("{{ 'x'.center(10**9) }}", "unsafe"),
    "format method": ("{{ '{:>999999999}'.format(1) }}", "unsafe"),
    "filter center": ("{{ 'x' | center(10**9) }}", "center"),
    "filter indent": ("{{ 'x' | indent(10**9) }}", "indent"),
    "replaced": ("{{ ('x' * 10**5) | replace('x', 'y' * 10**5) }}", "too large"),
    "joined": ("{{ range(10**4) | join('y' * 10**5) }}", "too large"),
    "digits": ("{{ 1.5 | digits(10**9) }}", "number of digits"),
    "doubled": ("{% set a = 'x' * 10**5 %}" + "{% set a = a ~ a %}" * 40 + "{{ a }}", "too large"),
    "doubled in a loop": (
        "{% set n = namespace(a='x' * 10**5) %}{% for i in range(99) %}{% set n.a = n.a ~ n.a %}{% endfor %}",
        "too large",
    ),
    "doubled lists": ("{% set a = [1] %}" + "{% set a = [a, a] %}" * 40 + "{{ a }}", "steps"),
    "doubled dictionaries": ("{% set a = {} %}" + "{% set a = {1: a, 2: a} %}" * 40 + "{{ a == 1 }}", "steps"),
    "doubled namespaces": (
        "{% set a = namespace() %}" + "{% set a = namespace(x=a, y=a) %}" * 40 + "{{ a | string }}",
        "steps",
    ),
    "doubled arguments": ("{% macro m() %}{{ m(varargs, varargs) }}{% endmacro %}{{ m(1) }}", "steps|recursion"),
    "circle": ("{% set n = namespace() %}{% set n.a = n %}{{ n.a | string | length }}", "steps"),
    "searched": (
        "{% set l = range(99999) | list %}{% for a in l %}{% if -1 in l %}{% endif %}{% endfor %}",
        "steps",
    ),
    "searched by a filter": ("{% set l = range(99999) | list %}{{ l | select('in', l) | list | length }}", "steps"),
    "summed": ("{% set l = range(99999) | list %}{% for a in l %}{{ l | sum }}{% endfor %}", "steps"),
    "filtered loops": (
        "{% set l = range(9999) %}{% for a in l %}{% for b in l if not b %}{% endfor %}{% endfor %}",
        "steps",
    ),
    "rounded": ("{{ 1.5 | round(10**9, 'ceil') }}", "number of decimals"),
    "long number": ("{{ ('f' * 10**5) | int(0, 16) }}", "too large"),
    "replaced lazily": (
        "{{ range(9999) | map('string') | map('replace', '1', 'y' * 10**5) | list | length }}",
        "too large|steps",
    ),
    "loop in a macro": (
        "{% macro m() %}{% for a in range(99999) %}{{ 'long ' * 1000 }}{% endfor %}{% endmacro %}{{ m() | length }}",
        "too large",
    ),
    "plain text in a loop": ("{% for a in range(99999) %}" + "long " * 1000 + "{% endfor %}", "too large"),
    "include": ("{% include '/etc/passwd' %}", "'include' is not available"),
    "import": ("{% import '/etc/passwd' as p %}", "'import' is not available"),
    "from import": ("{% from '/etc/passwd' import p %}", "'import' is not available"),
    "extends": ("{% extends '/etc/passwd' %}", "'extends' is not available"),
    "class": ("{{ ''.__class__.__mro__[1].__subclasses__() }}", "unsafe"),
    "globals": ("{{ value.__globals__ }}", "unsafe"),
    "function": ("{{ value.__func__.__globals__ }}", "unsafe"),
    "self": ("{{ self.__init__.__globals__ }}", "unsafe"),
    "attribute filter": ("{{ '' | attr('__class__') }}", "unsafe"),
    "cycler": ("{{ cycler.__init__.__globals__ }}", "unsafe"),
    "lipsum": ("{{ lipsum(n=10**6) }}", "lipsum"),
    "mutation": ("{% set l = [1] %}{{ l.append(2) }}", "unsafe"),
}


def prose(tmp_path: Path) -> Prose:
    return Prose(synthetic.paper(tmp_path), synthetic.results(), [])


@pytest.mark.parametrize("name", REFUSED)
def test_a_text_that_reaches_too_far_is_refused_by_file_and_line_and_at_once(tmp_path: Path, name: str) -> None:
    text, said = REFUSED[name]
    begun = time.process_time()
    with pytest.raises(TemplateError, match=rf"^toy/notes\.md:2: .*({said})"):
        prose(tmp_path).render(f"First.\n{text}\nLast.\n", "toy/notes.md")
    assert time.process_time() - begun < 5


@pytest.mark.parametrize(
    ("text", "filled"),
    [
        ("{% for row in ['A', 'B'] %}{{ row | lower }}{% endfor %}", "ab"),
        ("{% set x = number('table-1', 'A', 'x') %}{{ (x * 2 + 1) | digits(3) }}", "3"),
        ("{% macro half(x) %}{{ value('table-1', 'A', x) }}{% endmacro %}{{ half('x') }}", "1"),
        ("{{ 'a b'.split() | join(', ') | replace('a', 'c') }}", "c, b"),
        ("{{ (2**0.5) | abs | digits(4) }}", "1.414"),
        ("{{ claim('big').evidence }}", "The smallest is 3.1."),
        ("{{ 7 % 4 }}", "3"),
        ("{% set n = namespace(a=0) %}{% for i in [1, 2] %}{% set n.a = n.a + i %}{% endfor %}{{ n.a }}", "3"),
    ],
)
def test_what_texts_need_works(tmp_path: Path, text: str, filled: str) -> None:
    assert prose(tmp_path).render(text, "toy/notes.md") == filled


def test_one_text_does_not_use_up_the_steps_of_the_next(tmp_path: Path) -> None:
    one = prose(tmp_path)
    for _ in range(5):
        assert one.render("{% for a in range(30000) %}{% endfor %}done", "toy/notes.md") == "done"
