"""The what-if page in a real browser: as exact as Python, usable by keyboard, and quiet about nonsense."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from replicate.loops import PID, Loop, Plant
from replicate.whatif import Row, whatif_page

sync_api = pytest.importorskip("playwright.sync_api")

ROWS = [Row("first", "e^{-s}/(s+1)", "k=0.6,ki=0.5"), Row("second", "e^{-0.5s}/(s^2+0.6s+1)", "k=0.3,ki=0.4,b=0.5")]
LOOPS = 300


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("whatif") / "whatif.html"
    path.write_text(whatif_page(ROWS), encoding="utf-8")
    return path.as_uri()


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.wrong = []
    page.on("pageerror", lambda error: page.wrong.append(str(error)))
    page.on("console", lambda message: page.wrong.append(message.text) if message.type == "error" else None)
    page.on("request", lambda request: None if request.url.startswith("file:") else page.wrong.append(request.url))
    page.goto(address)
    until(page, "window.whatif && document.querySelector('#metrics-body tr')")
    yield page
    page.close()
    assert page.wrong == []  # nothing raised, nothing was fetched


def until(page: Any, condition: str) -> None:
    """Wait until something holds; the page's policy forbids what Playwright does to wait by itself."""
    for _ in range(100):
        if page.evaluate(f"Boolean({condition})"):
            return
        page.wait_for_timeout(50)
    pytest.fail(f"{condition} did not come true")


def random_loop(rng: np.random.Generator) -> tuple[dict[str, Any], Loop]:
    """Draw a loop: first and second order, integrating, unstable, high order, poorly damped, inverse response."""
    dead_time, lag = 10.0 ** rng.uniform(-1.0, 0.7), 10.0 ** rng.uniform(-0.5, 0.5)
    dens: list[Any] = [[lag, 1.0], np.convolve([lag, 1.0], [0.3 * lag, 1.0]), [lag, 1.0, 0.0], [lag, -1.0]]
    dens += [np.poly([-1.0] * int(rng.integers(3, 9))), [1.0, rng.uniform(0.2, 1.2), 1.0], np.poly([-1.0, -2.0, -0.7])]
    kind = int(rng.integers(0, len(dens)))
    num = [-0.5, 1.0] if kind == 6 else [1.0]
    den = [float(a) for a in dens[kind]]
    dead_time = min(dead_time, 0.4 * lag) if kind == 3 else 0.0 if kind in {1, 4} and rng.random() < 0.1 else dead_time
    time = dead_time + lag
    k = rng.uniform(1.1, 2.5) if kind == 3 else 10.0 ** rng.uniform(-1.0, 0.5)
    ki = 0.02 * k / time if kind == 3 else k / time * 10.0 ** rng.uniform(-0.7, 0.4)
    kd = k * time * rng.uniform(0.05, 0.3) if rng.random() < 0.4 else 0.0
    b = float(rng.choice([0.0, 0.5, 1.0]))
    lag_d = kd / k / 10.0
    loop = Loop(Plant(num, den, dead_time=dead_time), PID(k, ki, kd, b=b, derivative_filter=lag_d))
    plant = {"num": num, "den": den, "deadTime": dead_time}
    return {"plant": plant, "controller": {"k": k, "ki": ki, "kd": kd, "b": b, "filter": lag_d}}, loop


COMPUTE = """([plant, controller, times]) => {
  const prepared = Kernel.prepare(plant);
  if (!Kernel.isStable(prepared, controller)) return { stable: false };
  const maps = Kernel.mapsOf(prepared, controller.kd ? controller.filter : 0), until = times[times.length - 1] * 1.001;
  const step = Kernel.respond(maps, controller, { setpoint: 1, until });
  const load = Kernel.respond(maps, controller, { setpoint: 0, load: 1, until });
  const run = whatif.measure(prepared, controller);
  const { overshoot, settling, iae, ms, gain, phase, delay } = run;
  return { stable: true, step: times.map((t) => step.y(t)), load: times.map((t) => load.y(t)), overshoot, settling, iae,
    ms, gain, phase, delay };
}"""


def test_the_kernel_is_as_exact_as_python(page: Any) -> None:
    rng = np.random.default_rng(2026)
    stable = 0
    for _ in range(LOOPS):
        given, loop = random_loop(rng)
        times = np.linspace(0.0, 12.0 * (given["plant"]["deadTime"] + 1.0), 60)
        found = page.evaluate(COMPUTE, [given["plant"], given["controller"], times.tolist()])
        assert found["stable"] == loop.is_stable(), given
        if not found["stable"]:
            continue
        stable += 1
        until = 1.01 * float(times[-1])
        assert np.max(np.abs(np.array(found["step"]) - loop.step(until=until)(times))) < 1e-9, given
        assert np.max(np.abs(np.array(found["load"]) - loop.load_step(until=until)(times))) < 1e-9, given
        margins = loop.margins()
        expected = {"ms": float(loop.sensitivity_peak()), "gain": margins.gain, "phase": margins.phase}
        expected["delay"] = margins.delay
        if loop.rightmost_pole().real < -0.05:  # slower loops are cut off by the page, which says so
            step = loop.step()
            expected |= {"overshoot": step.overshoot(), "settling": step.settling_time(), "iae": step.iae()}
        for name, value in expected.items():
            assert found[name] == pytest.approx(value, rel=1e-7, abs=1e-9), (name, given)
    assert stable > LOOPS / 3


def test_the_page_agrees_with_its_own_reference(page: Any) -> None:
    (apart,) = re.findall(r"agrees with the report to ([\d.e+-]+)\.", page.inner_text("#agreement"))
    assert float(apart) < 1e-9


def test_dragging_and_keys_move_the_gains(page: Any) -> None:
    def gains() -> dict[str, float]:
        found: dict[str, float] = page.evaluate("whatif.state.controller")
        return found

    before = gains()
    page.focus("#plane")
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Shift+ArrowUp")
    after = gains()
    assert after["k"] > before["k"]
    assert after["ki"] > before["ki"]
    box = page.locator("#plane").bounding_box()
    page.mouse.move(box["x"] + box["width"] * 0.5, box["y"] + box["height"] * 0.6)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] * 0.4, box["y"] + box["height"] * 0.7)
    page.mouse.up()
    assert gains()["k"] < after["k"]
    until(page, "document.getElementById('spoken').textContent.includes('overshoot')")


def test_an_address_reopens_the_loop(page: Any, address: str) -> None:
    page.goto(f"{address}#plant=2%20e%5E%7B-0.3s%7D%2F(s(s%2B1))&controller=k%3D0.4%2Cki%3D0.05%2Cb%3D0.5")
    until(page, "whatif.state.plantText.startsWith('2 e')")
    assert page.evaluate("whatif.state.controller") == {"k": 0.4, "ki": 0.05, "kd": 0, "b": 0.5, "filter": 0}
    page.fill("#k", "0.5")
    until(page, "decodeURIComponent(location.hash).includes('k=0.5,')")


def test_the_python_lines_reproduce_the_loop(page: Any) -> None:
    lines = page.evaluate("whatif.python()")
    names: dict[str, Any] = {}
    exec(lines, names)  # noqa: S102  -- the lines that a reader would run
    shown = page.evaluate("whatif.state.last.overshoot")
    assert names["y"].overshoot() == pytest.approx(shown, abs=1e-9)


@pytest.mark.parametrize(
    ("field", "text", "reason"),
    [
        ("plant", "1/(s+1)(s+2)", "column 8: is this above or below the division?"),
        ("plant", "hello", "column 1: 'hello' is not known here"),
        ("plant", "", "the text is empty"),
        ("plant", "s^2/(s+1)", "improper"),
        ("plant", "e^{s}/(s+1)", "predicts"),
        ("plant", "1e308*1e308/(s+1)", "beyond any limit"),
        ("controller", "PI, please", "is not known; allowed are k, ki, kd"),
        ("controller", "k=abc", "'abc' is not known here"),
        ("controller", "k=1e308", "beyond any limit"),
        ("controller", "ki=1", "the gain is missing"),
    ],
)
def test_nonsense_gets_a_sentence_and_changes_nothing(page: Any, field: str, text: str, reason: str) -> None:
    before = page.evaluate("[whatif.state.plantText, whatif.state.controller]")
    page.fill(f"#{field}", text)
    page.press(f"#{field}", "Enter")
    until(page, f"document.getElementById('{field}-error').textContent")
    assert reason in page.inner_text(f"#{field}-error")
    assert page.evaluate("[whatif.state.plantText, whatif.state.controller]") == before


def test_a_plant_without_stable_region_and_one_without_dead_time(page: Any) -> None:
    page.fill("#plant", "e^{-9s}/(s-1)")
    page.press("#plant", "Enter")
    until(page, "document.getElementById('plane-note').textContent")
    assert "No PI part stabilises this plant" in page.inner_text("#plane-note")
    assert "Unstable" in page.inner_text("#verdict")
    page.fill("#plant", "1/((s+1)(0.2s+1)^2)")
    page.press("#plant", "Enter")
    until(page, "!document.getElementById('verdict').textContent")
    assert page.evaluate("whatif.state.last.stable")


def test_pins_saturation_and_mismatch(page: Any) -> None:
    page.click("#pin")
    page.fill("#k", "0.9")
    page.check("#saturation")
    page.check("#mismatch")
    until(page, "document.querySelectorAll('#output .cloud').length === 8")
    assert page.locator("#output .curve.saturated").count() == 1
    assert page.locator("#metrics-head th").count() == 3
    assert page.locator("#output .curve.a").count() == 1


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 360])
def test_accessible(page: Any, axe: str, scheme: str, width: int) -> None:
    page.emulate_media(color_scheme=scheme)
    page.set_viewport_size({"width": width, "height": 800})
    # The policy of the page allows its own script only: axe comes in through the debugger.
    page.evaluate(axe)
    found = page.evaluate("axe.run(document, { resultTypes: ['violations'] })")
    assert [(v["id"], [node["target"] for node in v["nodes"]]) for v in found["violations"]] == []
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


def test_without_script_the_first_row_is_shown(browser: Any, address: str) -> None:
    page = browser.new_context(java_script_enabled=False).new_page()
    page.goto(address)
    assert page.locator("noscript svg, svg#still").count() >= 1
    assert "Without script this page shows the loop" in page.content()
    page.close()


def test_the_page_is_one_file_with_little_script() -> None:
    folder = Path(__file__).parents[2] / "templates" / "whatif"
    assert sum(len(path.read_bytes()) for path in folder.glob("*.js")) <= 80_000
    html = whatif_page(ROWS)
    assert not re.search(r'(src|href)="(?!#|data:)', html)
    assert "http://" not in html.replace("http://www.w3.org/", "")
    (data,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', html)
    assert [row["label"] for row in json.loads(data)["rows"]] == ["first", "second"]
