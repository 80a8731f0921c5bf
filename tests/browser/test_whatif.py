"""The what-if page in a real browser: as exact as Python, usable by keyboard, and quiet about nonsense."""

from __future__ import annotations

import contextlib
import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest

from browser.random_loops import random_loop
from replicate.loops import PI, PID, Loop, Plant
from replicate.loops.errors import LoopError
from replicate.loops.notation import parse_controller, parse_plant
from replicate.loops.tune import amigo, simc, ziegler_nichols
from replicate.resources import templates_dir
from replicate.whatif import Row, whatif_page
from replicate.whatif.script import script

sync_api = pytest.importorskip("playwright.sync_api")

ROWS = [Row("first", "e^{-s}/(s+1)", "k=0.6,ki=0.5"), Row("second", "e^{-0.5s}/(s^2+0.6s+1)", "k=0.3,ki=0.4,b=0.5")]
LOOPS = 300


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("whatif") / "whatif.html"
    path.write_text(whatif_page(ROWS), encoding="utf-8")
    return path.as_uri()


@contextlib.contextmanager
def tab(browser: Any) -> Iterator[Any]:
    """Open a tab, which takes longer than a page in it."""
    page = browser.new_page()
    page.wrong = []
    page.on("pageerror", lambda error: page.wrong.append(str(error)))
    page.on("console", lambda message: page.wrong.append(message.text) if message.type == "error" else None)
    page.on("request", lambda request: None if request.url.startswith("file:") else page.wrong.append(request.url))
    yield page
    page.close()


def opened(page: Any, address: str) -> None:
    """Open the page, in a tab that may have shown it before."""
    page.goto("about:blank")
    page.wrong.clear()
    page.set_viewport_size({"width": 1280, "height": 900})
    page.emulate_media(color_scheme="light")
    page.mouse.move(0, 0)
    page.goto(address)
    until(page, "window.whatif && document.querySelector('#metrics-body tr')")


@pytest.fixture(scope="module")
def reopened(browser: Any) -> Iterator[Any]:
    with tab(browser) as page:
        yield page


@pytest.fixture
def page(reopened: Any, address: str) -> Iterator[Any]:
    """Return the page as it opens, for tests that change it."""
    opened(reopened, address)
    yield reopened
    assert reopened.wrong == []  # nothing raised, nothing was fetched


@pytest.fixture(scope="module")
def left_open(browser: Any, address: str) -> Iterator[Any]:
    with tab(browser) as page:
        opened(page, address)
        yield page


@pytest.fixture
def same_page(left_open: Any) -> Iterator[Any]:
    """Return a page that stays open, for tests that ask its functions or leave it as it was."""
    yield left_open
    assert left_open.wrong == []


NEXT_FRAME = "() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 0)))"


def until(page: Any, condition: str) -> None:
    """Wait until something holds and is drawn; the page's policy forbids what Playwright does to wait by itself."""
    for _ in range(600):
        if page.evaluate(f"Boolean({condition})"):
            page.evaluate(NEXT_FRAME)  # what has changed is drawn once a frame
            return
        page.wait_for_timeout(50)
    pytest.fail(f"{condition} did not come true")


COMPUTE = """([given, controller, times]) => {
  const plant = whatif.prepare(given);
  if (whatif.unstablePoles(plant, controller) !== 0) return { stable: false };
  const respond = whatif.responder(plant, controller), until = times.at(-1);
  const step = respond({ until }), load = respond({ setpoint: 0, load: 1, until });
  const { overshoot, settling, rise, iae, loadIae, variation, ms, gain, phase, delay } =
    whatif.measure(plant, controller);
  return { stable: true, step: times.map((t) => step.at(step.output, t)),
    load: times.map((t) => load.at(load.output, t)),
    overshoot, settling, rise, iae, loadIae, variation, ms, gain, phase, delay };
}"""


def test_the_kernel_is_as_exact_as_python(same_page: Any) -> None:
    rng = np.random.default_rng(2026)
    stable = 0
    for number in range(LOOPS):
        given, loop = random_loop(rng, number)
        times = np.linspace(0.0, 12.0 * (given["plant"]["deadTime"] + 1.0), 60)
        found = same_page.evaluate(COMPUTE, [given["plant"], given["controller"], times.tolist()])
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
        if number % 5 == 0:  # the longest part, and the same code for each
            expected |= metrics_of(loop)
        for name, value in expected.items():
            assert found[name] == pytest.approx(value, rel=1e-7, abs=1e-9), (name, given)
    assert stable > LOOPS / 3


@pytest.mark.parametrize(
    ("plant", "controller"),
    [
        ("0.666e^{-4.46s}", "k=1.476,ki=0.0396"),  # a peak for each turn of the dead time, the largest not far out
        ("1.77e^{-4s}", "k=0.0323,ki=0.00823,kd=0.01875,derivative_filter=0.06"),  # the largest infinitely far out
        ("1/(s+1)^15", "k=0,ki=0.0005"),  # crosses one far below all that is fast or slow in it
        ("9/(s^3+s^2+9s+9)", "k=-0.3,ki=0.2"),  # poles on the imaginary axis
    ],
)
def test_margins_of_loops_that_chance_seldom_brings(same_page: Any, plant: str, controller: str) -> None:
    found = same_page.evaluate(
        "([plant, given]) => whatif.measure(whatif.prepare(whatif.parsePlant(plant)), whatif.parseController(given))",
        [plant, controller],
    )
    loop = Loop(parse_plant(plant), parse_controller(controller))
    margins = loop.margins()
    expected = [float(loop.sensitivity_peak()), margins.gain, margins.phase, margins.delay]
    assert [found[name] for name in ("ms", "gain", "phase", "delay")] == pytest.approx(expected, rel=1e-7)


def metrics_of(loop: Loop) -> dict[str, float]:
    """Return what Python reads from the responses; nothing where there is no such number."""
    step, load, control = loop.step(), loop.load_step(), loop.respond().control
    readings: dict[str, Callable[[], float]] = {
        "overshoot": step.overshoot,
        "settling": step.settling_time,
        "rise": step.rise_time,
        "iae": step.iae,
        "loadIae": load.iae,
        "variation": control.total_variation,
    }
    found = {}
    for name, reading in readings.items():
        with contextlib.suppress(LoopError):
            found[name] = reading()
    return found


def test_the_page_agrees_with_its_own_reference(same_page: Any) -> None:
    (apart,) = re.findall(r"agrees with the report to ([\d.e+-]+)\.", same_page.inner_text("#agreement"))
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


DRAG = """async ([plant, controller]) => {
  location.hash = new URLSearchParams({ plant, controller });
  await new Promise((done) => setTimeout(done, 50));
  await new Promise((done) => requestAnimationFrame(() => setTimeout(done, 0)));
  const least = { frame: Infinity, loop: Infinity }, asked = window.requestAnimationFrame;
  const take = (what, work) => {
    const from = performance.now();
    work();
    least[what] = Math.min(least[what], performance.now() - from);
  };
  for (let i = 0; i < 16; i++) {
    let frame;
    window.requestAnimationFrame = (draw) => { frame = draw; return 1; };
    take("frame", () => {
      const key = i % 8 < 4 ? "ArrowRight" : "ArrowLeft";
      document.getElementById("plane").dispatchEvent(new KeyboardEvent("keydown", { key }));
      frame();
      document.body.getBoundingClientRect();  // lays out what has changed
    });
    window.requestAnimationFrame = asked;
    take("loop", () => {
      let x = 1;
      for (let j = 0; j < 16e6; j++) x = x * 0.9999999 + 1e-7;
      window.kept = x;
    });
  }
  return [whatif.state.last.stable, least.frame / least.loop];
}"""


@pytest.mark.parametrize(
    ("plant", "controller"),
    [
        ("e^{-s}/(s+1)", "k=0.6,ki=0.5"),
        ("e^{-s}/(s+1)", "k=0.6,ki=0.5,kd=0.2,derivative_filter=0.02"),
        ("1/(s+1)^4", "k=0.3,ki=0.1"),
        ("1/(s+1)^15", "k=0.3,ki=0.1"),
        ("1/((s+1)(0.001s+1))", "k=0.3,ki=0.1"),
        ("9/(s^3+s^2+9s+9)", "k=-0.3,ki=0.2"),  # poles on the imaginary axis
        ("1/(s(s+1)^3)", "k=0.2,ki=0.01"),
        ("e^{-15s}/(s+1)^3", "k=0.3,ki=0.1"),  # hardly damped
        ("e^{-0.01s}/(s+1)", "k=0.3,ki=0.1"),
        ("e^{-100s}/(s+1)", "k=0.3,ki=0.01"),
        ("e^{-s}", "k=0.3,ki=0.3"),
    ],
)
def test_dragging_takes_less_than_a_frame(page: Any, plant: str, controller: str) -> None:
    """A frame has 16 ms, in which a laptop adds 16 million products, each of which waits for the one before.

    Machines differ, and this one has other work: what counts is the ratio of the shortest of both, give or take a half.
    """
    stable, ratio = page.evaluate(DRAG, [plant, controller])
    assert stable
    assert ratio < 1.5


def test_an_address_reopens_the_loop(page: Any, address: str) -> None:
    page.goto(f"{address}#plant=2%20e%5E%7B-0.3s%7D%2F(s(s%2B1))&controller=k%3D0.4%2Cki%3D0.05%2Cb%3D0.5")
    until(page, "whatif.state.plantText.startsWith('2 e')")
    assert page.evaluate("whatif.state.controller") == {
        "k": 0.4, "ki": 0.05, "kd": 0, "b": 0.5, "c": 0, "filter": 0, "prefilter": 0,
    }  # fmt: skip
    page.fill("#k", "0.5")
    until(page, "decodeURIComponent(location.hash).includes('k=0.5,')")


def test_an_address_holds_all_that_was_set(page: Any, address: str) -> None:
    page.click("#pin")
    page.fill("#k", "0.7")
    page.check("[name=plane][value=kd]")
    page.fill("#limit", "2")
    page.check("#saturation")
    page.uncheck("#anti-windup")
    page.fill("#mismatch-size", "30")
    page.check("#mismatch")
    until(page, "location.hash.includes('mismatch=30') && location.hash.includes('plane=kd')")
    there = page.evaluate("location.href")
    page.goto(address + "#")
    page.goto(there)
    until(page, "document.querySelectorAll('#output .cloud').length === 8")
    assert page.evaluate("[whatif.state.controller.k, whatif.state.plane, whatif.state.pins.length]") == [0.7, "kd", 1]
    assert not page.is_checked("#anti-windup")
    page.goto(f"{address}#plant=1%2F(s%2B1)&controller=k%3D1%2Cki%3D1")  # an address without options has none
    until(page, "whatif.state.plantText === '1/(s+1)' && !document.querySelector('#output .cloud')")
    assert page.evaluate("[whatif.state.plane, whatif.state.pins.length]") == ["ki", 0]


def numbers(text: str) -> list[float]:
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?", text)]


def test_the_python_lines_print_what_the_table_shows(same_page: Any, capsys: pytest.CaptureFixture[str]) -> None:
    exec(same_page.evaluate("whatif.python(whatif.state)"), {})  # noqa: S102  -- the lines that a reader would run
    printed = numbers(capsys.readouterr().out)
    assert printed == numbers(" ".join(same_page.locator("#metrics-body td").all_inner_texts()))
    assert len(printed) == same_page.locator("#metrics-body tr").count()


def test_an_ideal_derivative_is_that_of_the_core(page: Any, address: str) -> None:
    page.evaluate("whatif.state.last = null")  # so that what is read is of the new loop
    page.goto(f"{address}#plant=1%2F(s%2B1)%5E4&controller=k%3D1%2Cki%3D0.98%2Ckd%3D3")
    until(page, "whatif.state.plantText === '1/(s+1)^4' && whatif.state.last?.stable")
    loop = Loop(Plant([1.0], np.poly([-1.0] * 4)), PID(1.0, 0.98, 3.0))
    found = page.evaluate(
        "(({ overshoot, loadIae, variation, ms }) => [overshoot, loadIae, variation, ms])(whatif.state.last)"
    )
    expected = [loop.step().overshoot(), loop.load_step().iae(), loop.respond().control.total_variation()]
    assert found == pytest.approx([*expected, float(loop.sensitivity_peak())], rel=1e-8)


def test_the_slider_multiplies_all_gains(page: Any) -> None:
    page.focus("#sharpen")
    for _ in range(20):
        page.keyboard.press("ArrowRight")
    until(page, "Math.abs(whatif.state.controller.k - 0.66) < 1e-9")
    assert page.evaluate("whatif.state.controller.ki") == pytest.approx(0.55)
    assert page.inner_text("#factor") == "1.100"
    loop = Loop(Plant.foptd(1.0, 1.0, 1.0), PID(0.66, 0.55))
    assert f"{float(loop.sensitivity_peak()):.4g}" in page.inner_text("#metrics-body")


def test_how_far_a_printed_rule_may_be_sharpened(page: Any, address: str) -> None:
    kp, ki = 0.404 + 0.256 - 0.1275, 0.0808 + 0.719 - 0.324  # Khan's rule (7b) at ph = 1
    page.goto(f"{address}#plant=e%5E%7B-s%7D%2F(s%2B1)&controller=k%3D{kp}%2Cki%3D{ki}")
    until(page, f"whatif.state.controller.k === {kp} && whatif.state.last.ms < 1.7")

    def peak(factor: float) -> float:
        page.locator("#sharpen").fill(str(factor))
        until(page, f"document.getElementById('factor').textContent === '{factor:.3f}'")
        found = float(page.evaluate("whatif.state.last.ms"))
        loop = Loop(Plant.foptd(1.0, 1.0, 1.0), PID(factor * kp, factor * ki))
        assert found == pytest.approx(float(loop.sensitivity_peak()), rel=1e-9)
        return found

    assert peak(1.425) < 2.0 < peak(1.43)


def rules(page: Any, plant: str) -> dict[str, list[float]]:
    found = page.evaluate("(text) => whatif.rules(whatif.prepare(whatif.parsePlant(text)))", plant)
    return {rule["name"]: [rule["k"], rule["ki"]] for rule in found}


@pytest.mark.parametrize("text", ["e^{-2s}/(3s+1)", "-0.5e^{-0.2s}/(3s+1)", "0.5e^{-2s}/s"])
def test_the_rules_of_the_page_are_those_of_the_core(same_page: Any, text: str) -> None:
    plant, found = parse_plant(text), rules(same_page, text)
    for name, rule in (("SIMC", simc), ("AMIGO", amigo), ("ZN", ziegler_nichols)):
        expected = rule(plant)
        assert found[name] == pytest.approx([expected.k, expected.ki], rel=1e-12), name


def test_rules_of_the_papers_are_marked_where_they_apply(same_page: Any) -> None:
    # Khan and Lehman for e^{-hs}/(s + p), K = 2/p, by (7b) and, restored, (7a); Bayhan and others with K, tau and L
    p, h = 0.5, 3.0
    kp = 0.404 / h + 0.256 * p - 0.1275 * (p / h) ** 0.5
    ki = 0.0808 / h**2 + 0.719 * p / h - 0.324 * p**0.5 / h**1.5
    assert rules(same_page, "2e^{-3s}/(s+0.5)")["Khan (7)"] == pytest.approx([kp / 2, ki / 2], rel=1e-12)
    p, h = 0.5, 0.2
    kp = -0.0404 * p**2 * h + 0.0723 * p + 0.3852 / h
    ki = -0.0525 * p**2 + 0.4104 * p / h - 0.00024 / h**2
    assert rules(same_page, "e^{-0.2s}/(s+0.5)")["Khan (7)"] == pytest.approx([kp, ki], rel=1e-12)
    assert "Khan (7)" not in rules(same_page, "e^{-0.01s}/(s+0.5)")
    assert list(rules(same_page, "1/((s+1)(0.2s+1)(0.05s+1))")) == ["SIMC"]
    assert rules(same_page, "e^{-s}/(s-1)") == {}


def test_the_marked_pole_assignment_puts_a_double_pole(same_page: Any) -> None:
    K, tau, L = 2.0, 3.0, 1.5
    k, ki = rules(same_page, "2e^{-1.5s}/(3s+1)")["pole assignment"]
    a = (L + 4 * tau - (L**2 + 8 * tau**2) ** 0.5) / (2 * L)  # -a/tau is the triple pole with the exact dead time
    above, below = [L**2, -6 * L, 12.0], [L**2, 6 * L, 12.0]  # Padé, second order
    loop = np.polyadd(np.polymul([tau, 1.0, 0.0], below), K * np.polymul([k, ki], above))
    assert np.polyval(loop, -a / tau) == pytest.approx(0.0, abs=1e-9)
    assert np.polyval(np.polyder(loop), -a / tau) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("text", ["1/(s+1)^4", "2e^{-0.5s}/((4s+1)(s+1))", "e^{-s}(1-0.3s)/(s(s+1)^2)", "1/(s+1)^7"])
def test_several_lags_are_reduced_as_in_the_core(same_page: Any, text: str) -> None:
    expected = simc(parse_plant(text))
    assert rules(same_page, text)["SIMC"] == pytest.approx([expected.k, expected.ki], rel=1e-9)


def test_curves_and_picture_can_be_taken_away(page: Any) -> None:
    page.click("#pin")
    until(page, "whatif.state.pins.length")
    with page.expect_download() as got:
        page.click("#csv")
    lines = Path(got.value.path()).read_text(encoding="utf-8").splitlines()
    assert lines[0] == "t,y_setpoint,u_setpoint,y_load,u_load,a_y_setpoint,a_u_setpoint,a_y_load,a_u_load"
    values = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    loop = Loop(Plant.foptd(1.0, 1.0, 1.0), PID(0.6, 0.5))
    assert np.max(np.abs(values[:, 1] - loop.step(until=1.01 * values[-1, 0])(values[:, 0]))) < 1e-9
    with page.expect_download() as got:
        page.click("#svg")
    picture = Path(got.value.path()).read_text(encoding="utf-8")
    parse = (
        "(text) => new DOMParser().parseFromString(text, 'image/svg+xml').querySelectorAll(':root > svg .curve').length"
    )
    assert page.evaluate(parse, picture) == 10  # of the loop and the pinned one, in five of the six diagrams


def test_it_prints_on_one_page(page: Any) -> None:
    for gain in ("0.5", "0.7", "0.8"):
        page.fill("#k", gain)
        until(page, f"whatif.state.controller.k === {gain}")
        page.click("#pin")
        until(page, f"whatif.state.pins.at(-1)?.controller.k === {gain}")
    assert len(re.findall(rb"/Type */Page\b(?!s)", page.pdf(prefer_css_page_size=True))) == 1


def test_a_change_is_drawn_once_a_frame(page: Any) -> None:
    frames = page.evaluate("""async () => {
      let frames = 0;
      const asked = window.requestAnimationFrame;
      window.requestAnimationFrame = (f) => asked(() => { frames++; f(); });
      const key = new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true });
      for (let i = 0; i < 50; i++) document.getElementById("plane").dispatchEvent(key);
      await new Promise((done) => asked(() => setTimeout(done, 0)));
      return frames;
    }""")
    assert frames == 1


@pytest.mark.parametrize(
    ("field", "text", "reason"),
    [
        ("plant", "1/(s+1)(s+2)", "column 8: is this above or below the division?"),
        ("plant", "hello", "column 1: 'hello' is not known here"),
        ("plant", "", "the text is empty"),
        ("plant", "s^2/(s+1)", "improper"),
        ("plant", "e^{s}/(s+1)", "predicts"),
        ("plant", "1e308*1e308/(s+1)", "beyond any limit"),
        ("plant", "1e309/(s+1)", "1e309 is not a floating-point number"),
        ("plant", "1e-400/(s+1)", "1e-400 is not a floating-point number"),
        ("plant", "0x10/(s+1)", "'x' is not known here"),
        ("controller", "k=0b1", "'b' is not known here"),
        ("plant", "1/(s+1,5)", "a decimal point is written '.', not ','"),
        ("plant", "NaN/(s+1)", "'NaN' is not known here"),
        ("plant", "(s+1)/(s+2)", "answers at once"),
        ("plant", "1/(s+1)^16", "at most order 15"),
        ("plant", "(" * 500 + "s" + ")" * 500, "too many parentheses"),
        ("plant", "e^{-s}/(s+1)+e^{-2s}/(s+1)", "a sum of different dead times is not drawn here"),
        ("plant", "0/(s+1)", "the plant is zero"),
        ("plant", "1/0", "division by zero"),
        ("controller", "k=1,ti=0", "ti must not be zero"),
        ("controller", "k=NaN", "'NaN' is not known here"),
        ("controller", "k=1,k=2", "k is given twice"),
        ("controller", "k=1,ki=1,ti=2", "ki and ti cannot both be given"),
        ("controller", "k=1,derivative_filter=-1", "must not be negative"),
        ("controller", "k=1,measurement_filter=1", "is not drawn here"),
        ("controller", "k" * 5000, "is not known"),
        ("controller", "PI, please", "is not known; allowed are k, ki, kd"),
        ("controller", "k=abc", "'abc' is not known here"),
        ("controller", "k=1e308", "beyond any limit"),
        ("controller", "ki=1", "the gain is missing"),
        ("k", "1e308", "beyond any limit"),
        ("k", "1e9", "so high a gain is not drawn here"),
        ("plant", "1e300/(s+1)", "numbers so far apart"),
        ("plant", "1e-300/(s+1)", "numbers so far apart"),
        ("plant", "e^{-1e-308s}/(s+1)", "numbers so far apart"),
        ("plant", "e^{-1e308s}/(s+1)", "numbers so far apart"),
        ("plant", "1/(1e-300s+1)", "numbers so far apart"),
        ("ki", "", "'' is not a number"),
        ("kd", "0,5", "'0,5' is not a number; write a point"),
        ("filter", "-1", "must not be negative"),
        ("k", "NaN", "'NaN' is not a number"),
        ("k", "0x10", "'0x10' is not a number"),
        ("ki", "0b1", "'0b1' is not a number"),
        ("k", "1e309", "beyond any limit"),
        ("k", "\u0661", "'\u0661' is not a number"),
        ("k", "-1e308", "beyond any limit"),
        ("b", "Infinity", "'Infinity' is not a number"),
    ],
)
def test_nonsense_gets_a_sentence_and_changes_nothing(same_page: Any, field: str, text: str, reason: str) -> None:
    before = same_page.evaluate("[whatif.state.plantText, whatif.state.controller]")
    sense = same_page.input_value(f"#{field}")
    same_page.fill(f"#{field}", text)
    same_page.press(f"#{field}", "Enter")
    error = same_page.get_attribute(f"#{field}", "aria-describedby")
    until(same_page, f"document.getElementById('{error}').textContent")
    assert reason in same_page.inner_text(f"#{error}")
    assert same_page.get_attribute(f"#{field}", "aria-invalid") == "true"
    assert same_page.evaluate("[whatif.state.plantText, whatif.state.controller]") == before
    same_page.fill(f"#{field}", sense)
    same_page.press(f"#{field}", "Enter")
    until(same_page, f"!document.getElementById('{error}').textContent")


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


@pytest.mark.parametrize("width", [1280, 800, 360])
def test_no_value_is_hidden_beside_a_controller_of_many_settings(page: Any, address: str, width: int) -> None:
    page.set_viewport_size({"width": width, "height": 800})
    page.goto("about:blank")
    controller = "k%3D4.71756%2Cki%3D5.45382%2Ckd%3D0.200019%2Cderivative_filter%3D0.005"
    page.goto(f"{address}#plant=e%5E%7B-0.1s%7D%2F(s-1)&controller={controller}")
    until(page, "window.whatif && document.querySelector('#metrics-head small')?.textContent.includes('filter')")
    assert page.locator("[aria-label=Metrics]").evaluate("(region) => region.scrollWidth <= region.clientWidth")
    assert page.locator("#metrics-body td").count() == 10


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
    sources = sum(len(path.read_bytes()) for path in (templates_dir() / "whatif").glob("*.js"))
    assert len(script().encode()) < sources <= 80_000
    html = whatif_page(ROWS)
    assert not re.search(r'(src|href)="(?!#|data:)', html)
    assert "http://" not in html.replace("http://www.w3.org/", "")
    (data,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', html)
    assert [row["label"] for row in json.loads(data)["rows"]] == ["first", "second"]


def test_no_two_modules_of_the_script_share_a_name() -> None:
    names = re.findall(r"^(?:export )?(?:const|let|class|function\*?) ([\w$]+)", script(), re.MULTILINE)
    assert len(names) == len(set(names)) > 50


LIMITED = """([given, controller, limit, antiWindup, end]) =>
  whatif.limited(whatif.prepare(given), controller, limit, antiWindup, end).output"""


@pytest.mark.parametrize("anti_windup", ["none", "back-calculation"])
@pytest.mark.parametrize(
    ("plant", "controller"),
    [
        ("e^{-s}/(s+1)", "k=0.9,ki=0.7"),
        ("e^{-0.5s}/(s(s+1))", "k=1.5,ki=0.15,kd=0.7,derivative_filter=0.1"),
        ("1/((s+1)(0.1s+1)^2)", "k=6,ki=4,setpoint_filter=0.2"),
        ("1/(s+1)^4", "k=1.5,ki=0.5,kd=1.5,derivative_filter=0.2"),
    ],
)
def test_the_limited_response_is_right_to_a_line_width(
    same_page: Any, plant: str, controller: str, anti_windup: Literal["none", "back-calculation"]
) -> None:
    """The page says that it is approximate; a line is about a hundredth of the picture's height wide."""
    limit, loop = 1.2, Loop(parse_plant(plant), parse_controller(controller))
    given = same_page.evaluate(
        "([plant, controller]) => [whatif.parsePlant(plant), whatif.parseController(controller)]", [plant, controller]
    )
    points = np.array(same_page.evaluate(LIMITED, [*given, limit, anti_windup != "none", 30.0]))
    exact = loop.saturated(limits=(-limit, limit), anti_windup=anti_windup, until=30.1).output(points[:, 0])
    assert np.max(np.abs(exact - loop.step(until=30.1)(points[:, 0]))) > 0.01  # the limit is felt
    assert np.max(np.abs(points[:, 1] - exact)) < 1e-3


REGION = """([text, controller, plane]) => {
  const plant = whatif.prepare(whatif.parsePlant(text)), given = whatif.parseController(controller);
  const box = whatif.extent(plant, given, plane), map = whatif.gainMap(plant, given, plane, box);
  return { border: whatif.border(plant, given, plane).filter(([k, ki]) =>
      k > box.left && k < box.right && ki > box.bottom && ki < box.top),
    levels: [1.4, 2].map((ms) => whatif.contour(map, Math.log(ms)).map((segment) => segment[0])),
    box, stable: map.stable };
}"""


@pytest.mark.parametrize("text", ["e^{-s}/(s+1)", "e^{-0.4s}/(s-1)", "9/(s^3+s^2+9s+9)", "-2e^{-s}/(s+1)", "e^{-s}/s"])
def test_region_and_contours_are_those_of_the_core(same_page: Any, text: str) -> None:
    sign = -1.0 if text.startswith("-") else 1.0
    plant = parse_plant(text)
    found = same_page.evaluate(
        REGION, [text, f"k={sign * 1.3 if '-1)' in text else sign * 0.2},ki={sign * 0.05}", "ki"]
    )
    box, columns, rows = found["box"], 72, 54
    assert box["top" if sign > 0 else "bottom"] * sign > 0
    for index in range(0, len(found["stable"]), 97):  # the cells' corners
        row, column = divmod(index, columns + 1)
        k = box["left"] + (box["right"] - box["left"]) * column / columns
        ki = box["bottom"] + (box["top"] - box["bottom"]) * row / rows
        if abs(ki) > 1e-6:
            assert found["stable"][index] == Loop(plant, PI(k, ki)).is_stable(), (k, ki)
    assert found["border"]
    for k, ki in found["border"][:: max(1, len(found["border"]) // 12)]:  # a pole on the imaginary axis
        loop = Loop(plant, PI(k, ki))
        assert min(abs(pole.real) for pole in loop.poles(6)) < 1e-6 * (1.0 + abs(k))
    for level, points in zip((1.4, 2.0), found["levels"], strict=True):
        for k, ki in points[:: max(1, len(points) // 8)]:
            assert float(Loop(plant, PI(k, ki)).sensitivity_peak()) == pytest.approx(level, rel=1e-3)


def test_a_minus_sign_may_be_typographic(page: Any) -> None:
    page.fill("#plant", "e^{\u22121.5s}/(s+1)\u00b2")
    page.press("#plant", "Enter")
    page.fill("#k", "\u22120.1")
    until(page, "whatif.state.controller.k === -0.1 && whatif.state.plant.deadTime === 1.5")
    assert page.evaluate("whatif.state.plant.den") == [1, 2, 1]


@pytest.mark.parametrize(
    "fragment",
    [
        "%E0%A4%A", "plant=%&controller=%", "plant=", "controller=k", "controller=k%3D1e308", "plant=1/0", "pins=;;k;",
        "pins=k%3D1%2Cki%3D1;nonsense", "mismatch=many", "mismatch=-5", "limit=-1", "limit=0", "plane=kx", "a" * 20000,
        "plant=e%5E%7B-s%7D%2F(s%2B1)&controller=k%3DNaN&plane=kd&windup=maybe", "=&=&==",
    ],
)  # fmt: skip
def test_a_damaged_address_leaves_a_page_that_works(page: Any, address: str, fragment: str) -> None:
    page.goto(f"{address}#{fragment}")
    page.evaluate(NEXT_FRAME)
    until(page, "whatif.state.last && whatif.state.plant")
    page.fill("#k", "0.55")
    until(page, "whatif.state.last.stable && whatif.state.controller.k === 0.55")
    assert page.locator("#metrics-body tr").count() == 10


def test_the_address_keeps_set_point_filter_and_three_pins(page: Any, address: str) -> None:
    page.fill("#controller", "k=0.6,ki=0.5,kd=0.2,derivative_filter=0.05,setpoint_filter=0.7,c=1,b=0.3")
    page.press("#controller", "Enter")
    for gain in ("0.5", "0.45", "0.4", "0.35"):
        page.fill("#k", gain)
        until(page, f"whatif.state.last && whatif.state.controller.k === {gain}")
        page.click("#pin")
        until(page, f"whatif.state.pins.at(-1)?.controller.k === {gain}")
    until(page, "/pins=.*;.*;k=0[.]35,/.test(decodeURIComponent(location.hash))")
    before, there = page.evaluate("[whatif.state.controller, whatif.state.pins]"), page.evaluate("location.href")
    page.goto(address + "#")
    page.goto(there)
    until(page, "whatif.state.pins.length === 3 && whatif.state.controller.k === 0.35")
    after = page.evaluate("[whatif.state.controller, whatif.state.pins]")
    assert after[0] == before[0]
    assert [pin["controller"] for pin in after[1]] == [pin["controller"] for pin in before[1]]
    assert [pin["controller"]["k"] for pin in after[1]] == [0.45, 0.4, 0.35]
    assert after[0]["prefilter"] == 0.7


def test_fine_steps_are_a_tenth_of_a_step(page: Any) -> None:
    page.focus("#plane")
    gains = [page.evaluate("whatif.state.controller.k")]
    for key in ("ArrowRight", "Alt+ArrowRight", "Shift+ArrowRight"):
        page.keyboard.press(key)
        gains.append(page.evaluate("whatif.state.controller.k"))
    normal, fine, large = np.diff(gains)
    assert [fine / normal, large / normal] == pytest.approx([0.1, 10.0])


def test_nothing_is_spoken_during_a_change(page: Any) -> None:
    before, *during = page.evaluate("""async () => {
      const spoken = document.getElementById("spoken"), k = document.getElementById("k");
      const pause = (ms) => new Promise((done) => setTimeout(done, ms));
      await pause(800);
      const heard = [spoken.textContent];
      for (const gain of [0.61, 0.62, 0.63]) {
        k.value = gain;
        k.dispatchEvent(new Event("input", { bubbles: true }));
        await pause(100);
        heard.push(spoken.textContent);
      }
      return heard;
    }""")
    assert during == [before] * 3
    until(page, "document.getElementById('spoken').textContent.startsWith('k=0.63')")


def test_touch_moves_the_point(browser: Any, address: str) -> None:
    page = browser.new_context(has_touch=True, viewport={"width": 360, "height": 800}).new_page()
    page.goto(address)
    until(page, "window.whatif && whatif.state.view")
    before = page.evaluate("whatif.state.controller")
    box = page.locator("#plane").bounding_box()
    page.touchscreen.tap(box["x"] + box["width"] * 0.6, box["y"] + box["height"] * 0.7)
    until(page, f"whatif.state.controller.k !== {before['k']}")
    page.close()
