"""The page of a run over figures in a real browser: readable by everyone, and its ticks give the exact commands."""

from __future__ import annotations

import base64
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib.image
import numpy as np
import pytest

from browser.sight import SEAM
from replicate.baselines.outcomes import Outcome
from replicate.baselines.page import page as page_of

pytest.importorskip("playwright.sync_api")

OUTCOMES = [
    Outcome("plots/fall-1", "changed", "f.py", ["curve 'ZN' moved", "QuadMesh 1 moved"], ["named", "net"], 0.1, "ab"),
    Outcome("plots/it's new-1", "new", "plots/plot_new.py", ["has no accepted state"], ["named"]),
    Outcome("plots/bad", "failed", "plots/plot_bad.py:3", ["ZeroDivisionError: division by zero"], ["named"]),
    Outcome("plots/same-1", "same", "plots/plot_same.py"),
]  # fmt: skip


def command(outcome: Outcome) -> str:
    name = f"{outcome.name}={outcome.digest}" if outcome.digest else outcome.name
    return shlex.join(["replicate", "figures", "accept", "plots", "--only", name, "--reason", "..."])


def picture(folder: Path, grey: float) -> str:
    matplotlib.image.imsave(folder / "p.png", np.full((60, 90, 3), grey))
    return base64.b64encode((folder / "p.png").read_bytes()).decode()


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("figures")
    first = OUTCOMES[0].to_dict() | {"accepted": picture(folder, 0.9), "new": picture(folder, 0.4)}
    (folder / "index.html").write_text(page_of([Outcome(**first), *OUTCOMES[1:]], command), encoding="utf-8")
    return (folder / "index.html").as_uri()


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.wrong = []
    page.on("pageerror", lambda error: page.wrong.append(str(error)))
    page.on("console", lambda message: page.wrong.append(message.text) if message.type == "error" else None)
    page.on(
        "request",
        lambda request: None if request.url.startswith(("file:", "data:")) else page.wrong.append(request.url),
    )
    page.goto(address)
    yield page
    page.close()
    assert page.wrong == []


def test_ticks_show_the_exact_commands(page: Any) -> None:
    assert page.locator("input.accept").count() == 2  # what failed cannot be accepted
    moved, new = (page.locator("section", has=page.get_by_role("heading", name=one.name)) for one in OUTCOMES[:2])
    assert page.locator("#commands").is_hidden()
    moved.locator("input.accept").focus()
    page.keyboard.press("Space")
    assert page.inner_text("#commands code").splitlines() == [command(OUTCOMES[0])]
    new.locator("input.accept").check()
    assert sorted(page.inner_text("#commands code").splitlines()) == sorted(map(command, OUTCOMES[:2]))
    moved.locator("input.accept").uncheck()
    new.locator("input.accept").uncheck()
    assert page.locator("#commands").is_hidden()


def test_the_pictures_are_swept_by_keyboard(page: Any) -> None:
    slider = page.locator(".pair input[type=range]")
    slider.focus()
    before = page.evaluate("document.querySelector('.pair').style.getPropertyValue('--cut')")
    page.keyboard.press("ArrowRight")
    assert page.evaluate("document.querySelector('.pair').style.getPropertyValue('--cut')") != before


@pytest.mark.parametrize("width", [1280, 800, 360])
def test_the_thumb_is_on_the_seam(page: Any, width: int) -> None:
    page.set_viewport_size({"width": width, "height": 800})
    assert max(map(abs, page.evaluate(SEAM))) < 2.0


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 360])
def test_accessible(page: Any, axe: str, scheme: str, width: int) -> None:
    page.emulate_media(color_scheme=scheme)
    page.set_viewport_size({"width": width, "height": 800})
    page.locator("input.accept").first.check()
    # The policy of the page allows its own script only: axe comes in through the debugger.
    page.evaluate(axe)
    found = page.evaluate("axe.run(document, { resultTypes: ['violations'] })")
    assert [(one["id"], [node["target"] for node in one["nodes"]]) for one in found["violations"]] == []
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


def test_without_script_everything_can_be_read(browser: Any, address: str) -> None:
    page = browser.new_context(java_script_enabled=False).new_page()
    page.goto(address)
    text = page.inner_text("body")
    for outcome in OUTCOMES[:3]:
        assert all(change in text for change in outcome.changes)
        assert not outcome.differs or command(outcome) in text
    assert page.locator("input.accept").first.is_hidden()
    page.close()
