"""The window in a real browser: changed by keyboard, refused, undone, saved, compared; nothing leaves the machine."""

from __future__ import annotations

import importlib.util
import json
import math
import os
import re
import signal
import subprocess
import sys
import time
import tomllib
import urllib.error
import urllib.request
from pathlib import Path

import pytest

pytest.importorskip("nicegui", reason="nicegui is missing; pip install 'fegear[workbench]'")

_spec = importlib.util.spec_from_file_location("chromium", Path(__file__).with_name("chromium.py"))
assert _spec is not None
assert _spec.loader is not None
chromium = importlib.util.module_from_spec(_spec)
sys.modules["chromium"] = chromium
_spec.loader.exec_module(chromium)

TEXT = """title = "a pair"     # kept
results = ["load-sharing"]
[gear.a]
teeth = 28
module = "3 mm"
face_width = "20 mm"
[pair.I]
driver = "a"
driven = "a"
load = "5 kN"
compliance = { source = "weber-banaschek" }
"""
_LAYOUT = {
    "height": 200,
    "margin": {"l": 40, "r": 12, "t": 12, "b": 40},
    "meta": {"names": 1, "inner": 100, "beside": 1},
}
TWICE = [
    {"key": "twice", "heading": "Twice", "caption": "", "data": [{"y": [1, 2]}], "layout": _LAYOUT},
    {"key": "twice", "same": True},
]
IDLE = "!document.body.classList.contains('computing')"
DRAWN = f"{IDLE} && document.querySelector('[data-picture=sharing] .small-plot path') !== null"
PAINTED = f"{IDLE} && document.querySelector('#plot-load_sharing_I .main-svg') !== null"
#: The map below the load slider comes last, when nothing else is left to compute.
MAPPED = "document.querySelector('#plot-slider_map_I .main-svg') !== null"


def outside_of_tests() -> dict[str, str]:
    """NiceGUI behaves otherwise within pytest."""
    return {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}


class Served:
    """`fegear open` in a process of its own."""

    def __init__(self, folder: Path, *arguments: str):
        self.scratch = folder / "scratch"
        self.scratch.mkdir(exist_ok=True)
        self.process = subprocess.Popen(
            [sys.executable, "-m", "fegear", "open", "--no-browser", *arguments], stdout=subprocess.PIPE, text=True,
            cwd=folder, env=outside_of_tests() | {
                "FEGEAR_STATE": str(folder / "state"), "PYTHONUNBUFFERED": "1", "TMPDIR": str(self.scratch),
            },
            # tests may themselves run under nohup, which is inherited
            preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),  # noqa: PLW1509
        )  # fmt: skip
        self.address = self.process.stdout.readline().split()[-1]

    def end(self, number: int = signal.SIGTERM) -> int:
        tasks = Path(f"/proc/{self.process.pid}/task").glob("*/children")
        children = [int(one) for task in tasks for one in task.read_text().split()]
        self.process.send_signal(number)
        self.process.stdout.close()
        code = self.process.wait(60)
        if number == signal.SIGKILL:  # who it leaves behind has to notice first, and is its heir's to bury
            end = time.monotonic() + 60.0
            while any(map(alive, children)) or any(self.scratch.iterdir()):
                assert time.monotonic() < end
                time.sleep(0.02)
        else:
            assert not [one for one in children if alive(one)]  # the dead may still wait for their heir
            assert list(self.scratch.iterdir()) == []
        return code


def alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def field(key: str) -> str:
    found = f"document.querySelector('[data-key=\"{key}\"]')"
    return f"(one => one?.tagName === 'INPUT' ? one : one?.querySelector('input'))({found})"


def press(browser, key: str, code: int) -> None:
    for kind in ("rawKeyDown", "keyUp"):
        browser("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code)


def button(words: str) -> str:
    return f"[...document.querySelectorAll('button')].find(one => one.textContent.trim() === '{words}')"


def nodes(browser) -> int:
    """How many nodes the page holds for long, those that stand in no document any more included.

    What has just gone is held until the next frames are drawn.
    """
    counts = []
    for _ in range(5):
        browser.run("new Promise(done => setTimeout(done, 150))")
        browser("HeapProfiler.collectGarbage")
        counts.append(browser("Memory.getDOMCounters")["nodes"])
    return min(counts)


def go(browser, address: str) -> None:
    browser("Page.navigate", url=address)
    browser.until("document.documentElement?.dataset.ready !== undefined")


def largest_load(browser) -> str:
    return browser.run("document.querySelector('.values td.number b').textContent")


@pytest.fixture(scope="module")
def browser(program):
    with chromium.Browser(program("chromium")) as opened:
        yield opened


@pytest.fixture
def serve(tmp_path):
    made = []

    def start(*arguments: str) -> Served:
        made.append(Served(tmp_path, *arguments))
        return made[-1]

    yield start
    for one in made:
        if one.process.poll() is None:
            one.end(signal.SIGKILL)


def opened(browser, serve, tmp_path) -> Served:
    """The case in ``drive.toml``, drawn."""
    path = tmp_path / "drive.toml"
    path.write_text(TEXT)
    served = serve(str(path))
    go(browser, served.address)
    browser.until(f"{DRAWN} && {field('pair.I.load')} !== null")
    return served


def stepped(browser) -> None:
    """By keyboard alone: an arrow key steps, the values follow."""
    before = largest_load(browser)
    browser.run(f"{field('pair.I.load')}.focus()")
    press(browser, "ArrowUp", 38)
    browser.until(f"{field('pair.I.load')}.value === '6 kN'")
    browser.until(f"{IDLE} && document.querySelector('.values td.number b').textContent !== '{before}'")
    assert largest_load(browser) != before


def refused(browser) -> None:
    """Refused at its field, in the words of the command line; the results stay; undone."""
    shown = largest_load(browser)
    browser.run(f"{field('gear.a.module')}.select()")
    browser("Input.insertText", text="3 kg")
    press(browser, "Enter", 13)
    browser.until("[...document.querySelectorAll('[role=alert]')].some(one => one.textContent.startsWith("
                  "'gear.a.module = \"3 kg\": is not a length'))")  # fmt: skip
    assert largest_load(browser) == shown
    browser.run("new Promise(done => setTimeout(done, 700))")
    because = "document.getElementById('refused-because')"
    assert browser.run(f"{because} === null")  # it is in sight at its field
    browser.run("document.getElementById('to-fold').click()")
    browser.until(f"{because} !== null && {because}.textContent.includes('is not a length')")
    browser.run("document.getElementById('to-fold').click()")
    browser.until(f"{because} === null")
    browser.click(button("Undo"))
    browser.until(f"{field('gear.a.module')}.value === '3 mm'")


def counts_echoes(browser) -> None:
    """Count what the server says of an exercise: a press before it would be taken back by what was said of the last."""
    said = "fegearGlance.exercise = (content) => { said(content); window.echoes += 1; }"
    browser.run("new Promise(done => setTimeout(done, 800))")  # what it says of earlier presses
    browser.run(f"(said => {{ window.echoes = 0; {said}; }})(fegearGlance.exercise)")


def pressed_and_heard(browser, pressed: str) -> None:
    """Press a button of an exercise, and wait for what the server says of it."""
    before = browser.run("window.echoes")
    browser.run(f"{pressed}.click()")
    browser.until(f"window.echoes > {before}")


def answers_of_wide_pairs_and_of_none(browser) -> None:
    """Of made figures: a mean line load that rises to an end, a stress that is highest in the second row of a map."""
    even = "{ name: 'load / face width', x: [-10, 10], y: [200, 200] }"
    mean = "{ name: 'mean over a base pitch', x: [-9, 0, 9], y: [150, 210, 250] }"
    stress = "{ type: 'heatmap', x: [1, 2], y: [-4, 0, 4], z: [1, 2, 3, 9, 4, 5] }"
    title = "{ text: '<b>driver p: 90 MPa</b>' }"
    history = "{ name: 'driver, tension', x: [1, 2], y: [8, 90] }"
    figures = (
        f"{{ load_over_face_W: {{ data: [{even}, {mean}], layout: {{}} }}, "
        f"root_stress_over_face_W: {{ data: [{stress}], layout: {{ annotations: [{title}] }} }}, "
        f"root_stress_history_W: {{ data: [{history}], layout: {{ xaxis: {{ title: {{ text: 'place [mm]' }} }} }} }} }}"
    )
    roots = "{ 'driver.largest_root_tension': 90, 'driven.largest_root_tension': 80 }"
    made = (
        "fegearExercise({ view: () => ({}), half: () => null, keep: () => 0, changed: () => 0, "
        "shown: () => ({ kind: 'pair', pair: $PAIR, mesh: { wide: true } }), "
        f"number: (name) => (name in {roots} ? {{ value: {roots}[name], unit: 'MPa' }} : null), "
        f"spec: (key) => ({figures})[key] }}).questions()"
    )
    ends, error, place = (browser.run(f"{made.replace('$PAIR', repr('W'))}[{i}].of()") for i in range(3))
    assert ends.startswith("At z = 9 mm: 250 N/mm, against 150 N/mm at z = −9 mm")
    assert "K_Hβ = 250 / 200 = 1.25" in ends
    assert error == ""
    assert place.startswith("The driver gear: 90 MPa")
    assert "at face position z = 0 mm; the driven gear has 80 MPa." in place
    assert browser.run(f"{made.replace('$PAIR', 'null')}.length") == 0


def circles_as_in_a_lecture(browser) -> None:
    """The path of contact ends where tip circles cut the line of action, which is tangent to both base circles."""
    data = "fegearGears.inside('I').data"
    lines = "getComputedStyle(document.querySelector('svg.mesh .circles')).display"
    assert browser.run(lines) == "none"
    browser.click(button("Circles"))
    browser.until(f"{lines} === 'inline'")
    driver, driven = browser.run(f"['driver', 'driven'].map((one) => fegearCircles.of({data}, one))")
    angle, start, end = (browser.run(f"{data}.{one}") for one in ("pressure_angle", "start", "end"))
    for gear, x in ((driver, end), (driven, start)):
        place = complex(1e3 * x * math.cos(angle), 1e3 * x * math.sin(angle))
        assert abs(place - 1j * gear["centre"]) == pytest.approx(gear["tip"], rel=1e-5)
        tangent = gear["tangent"] * complex(math.cos(angle), math.sin(angle)) - 1j * gear["centre"]
        assert abs(tangent) == pytest.approx(gear["base"], rel=1e-9)
        assert gear["pitch"] == pytest.approx(abs(gear["centre"]), rel=1e-12)
    browser.click(button("Circles"))
    browser.until(f"{lines} === 'none'")


def asked_and_answered(browser) -> None:
    """The question of an exercise lies above the figures, hidden or shown, and covers nothing."""
    place = "document.getElementById('{}').getBoundingClientRect().{}"
    shown = "getComputedStyle(document.getElementById('small')).display !== 'none'"
    for press_first, state in (("to-exercise", f"!({shown})"), ("to-answers", shown)):
        browser.run(f"document.getElementById('{press_first}').click()")
        browser.until(state)
        bottom, top = browser.run(place.format("question", "bottom")), browser.run(place.format("glance", "top"))
        assert bottom > browser.run(place.format("question", "top")) + 20
        assert top >= bottom - 0.5
        assert browser.run(place.format("glance", "bottom")) <= browser.run("innerHeight") + 0.5
        assert browser.run("document.querySelector('#question p').textContent").endswith("?")
        computed = browser.run("document.querySelector('#asked output').textContent")
        assert computed.startswith("The peak-to-peak transmission error is ") == (press_first == "to-answers")
    # Point A, where the slider is at first, is a jump for the pair one base pitch ahead: loads add up there, too.
    loads = "fegearField.loaded(data, $PLACE, loadAt).reduce((all, [, , one]) => all + one, 0)"
    inside = f"(({{ data, loadAt }}) => {loads})(fegearGears.inside('I'))"
    for at in ("0", "0.37", "0.999", "1"):
        assert browser.run(inside.replace("$PLACE", at)) == pytest.approx(6000.0, rel=2e-3)
    answers_of_wide_pairs_and_of_none(browser)
    # the next question is asked without its answer; every one has an answer in numbers
    words = "document.querySelector('#question p').textContent"
    answer = "document.querySelector('#asked output').textContent"
    counts_echoes(browser)
    answers = []
    choice = "document.querySelector('.choose-question')"
    count = browser.run(f"{choice}.options.length")
    for number in (1, 2, 3, 4, count - 1, 0):
        before = browser.run(words)
        if number == count - 1:
            browser.run(f"(one => {{ one.value = '{number - 1}'; one.onchange(); }})({choice})")
            browser.until(f"{words} !== {json.dumps(before)}", 5.0)
            browser.run("new Promise(done => setTimeout(done, 800))")
        pressed_and_heard(browser, button("Next question"))
        assert browser.run(f"{choice}.value") == str(number)
        assert browser.run(words) != before
        assert not browser.run(shown)
        assert browser.run(answer) == ""
        pressed_and_heard(browser, "document.getElementById('to-answers')")
        browser.until(f"{answer} !== ''", 10.0)
        answers.append(browser.run(answer))
    ratio = browser.run("(({ data }) => (data.end - data.start) / data.base_pitch)(fegearGears.inside('I'))")
    assert f"= {ratio:.3f}" in answers[3]
    limit = browser.run("fegearGears.inside('I').data.enough.driver")
    assert f"{limit:.4f} (driver)".replace("-", "−") in answers[2]
    assert f"2 (ε − 1)/ε = {100 * 2 * (ratio - 1) / ratio:.0f} %" in answers[0]
    assert answers[4].startswith("p = √(F_n E* / (π b ρ)) = ")
    pressure = browser.run("document.querySelector('[data-number=largest_hertz_pressure] b').textContent")
    found = float(re.search(r"in fegear is ([\d.]+) MPa", answers[4])[1])
    assert found == pytest.approx(float(pressure.split()[0]), rel=1e-3)
    assert answers[5].startswith("The peak-to-peak transmission error is ")
    # the gears as they are shown, as a file that holds by itself
    svg = "fegearSaved.text(document.querySelector('.mesh-stage'))"
    drawing = f"new DOMParser().parseFromString({svg}, 'image/svg+xml')"
    assert browser.run(f"{drawing}.querySelectorAll('path').length") >= 2
    assert "var(" not in browser.run(svg)
    browser.run("new Promise(done => setTimeout(done, 800))")  # what the server says of the last button has come
    browser.run("document.getElementById('to-answers').click()")  # hides them: then the question's buttons are there
    asked = "document.querySelector('#question p').textContent"
    for words, now in (("Why is C no extremum?", f"{asked} === 'Why is C no extremum?'"),
                       (" ", f"{asked}.startsWith('How large')")):  # fmt: skip
        browser.run(f"{button('Own question')}.click()")
        browser.until("document.activeElement.closest('#question p') !== null", 5.0)
        browser("Input.insertText", text=words)
        press(browser, "Enter", 13)
        browser.until("!document.querySelector('#question p').isContentEditable", 5.0)
        browser.until(now, 5.0)
    said = "getComputedStyle(document.getElementById('question'), '::after').content"
    for now in ("includes('hidden until')", "startsWith('none')"):  # not an empty page
        browser.run("document.getElementById('to-report').click()")
        browser.until(f"{said}.{now}", 5.0)
    browser.run("document.getElementById('to-exercise').click()")
    browser.until("document.getElementById('question').hidden")


def in_large_type(browser) -> None:
    """With unsaved changes every button stays within the page; axes keep a scale; enlarged figures grow, too."""
    size = "parseFloat(getComputedStyle(document.querySelector('#enlarged .xtick text')).fontSize)"
    drawn = "document.querySelector('#enlarged[open] .xtick text') !== null"
    sizes = []
    for large in (False, True):
        if large:
            browser.run("document.getElementById('to-large').click()")
            browser.until("document.documentElement.classList.contains('large-type')")
        browser.click("document.querySelector('[data-picture=te] button')")
        browser.until(drawn)
        sizes.append(browser.run(size))
        browser.click(button("Close"))
        browser.until(f"!({drawn})")
    assert sizes[1] == pytest.approx(1.4 * sizes[0])
    assert browser.run("document.querySelector('.headbar .unsaved').textContent") == "changed, not saved"
    for width in (1024, 1280, 1300):
        browser.size(width, 800)
        browser.until("document.documentElement.scrollWidth <= innerWidth")
        assert browser.run("document.querySelector('.views summary').getBoundingClientRect().right") <= width
    # Heights of numbers at the axis of ordinates: two at least, else there is no scale.
    numbers = "[...one.querySelectorAll('text[text-anchor=end]')].length"
    browser.until(f"[...document.querySelectorAll('svg.small-plot')].every(one => {numbers} >= 2)")
    browser.run("document.getElementById('to-large').click()")
    browser.size(1300, 900)
    browser.until("!document.documentElement.classList.contains('large-type')")


@pytest.mark.dear
def test_a_value_stepped_by_keyboard_changes_the_results_and_one_that_is_refused_leaves_them(browser, serve, tmp_path):
    """The shortest walk, of the ordinary run; the next tests walk through all of the window."""
    served = opened(browser, serve, tmp_path)
    stepped(browser)
    refused(browser)
    circles_as_in_a_lecture(browser)
    asked_and_answered(browser)
    served.end()


@pytest.mark.dear
def test_a_case_is_changed_refused_undone_compared_saved_and_outlives_its_server(browser, serve, tmp_path):
    path = tmp_path / "drive.toml"
    served = opened(browser, serve, tmp_path)

    # All results are a click away, and come when they are looked at.
    assert browser.run("document.querySelector('.js-plotly-plot')") is None
    browser.click(button("All results"))
    browser.until(PAINTED)

    # Results that are overtaken before their turn have had a figure that the next ones name by its key alone.
    browser.run(f"for (const figure of {json.dumps(TWICE)}) fegear.hear('found', {{task: 'hand twice', title: 'Twice', "
                "values: '', darker: {}, figures: [figure]})")  # fmt: skip
    browser.until("document.querySelector('#plot-twice .main-svg') !== null")
    browser.run("document.querySelector('[data-task=\"hand twice\"]').remove()")

    stepped(browser)

    # What is typed and not confirmed stays, whatever else of the case changes meanwhile.
    browser.run(f"{field('gear.a.module')}.select()")
    browser("Input.insertText", text="3.25 mm")
    browser.run("emitEvent('load', {pair: 'I', key: 'load', text: '6.1 kN', moving: false})")
    browser.until(f"{field('pair.I.load')}.value === '6.1 kN' && {IDLE}")
    browser.run("emitEvent('relief', {gear: 'a', end: 'tip', start: 28, amount: 5, moving: false})")  # another table
    browser.until(f"{field('gear.a.relief.tip.amount')}?.value === '5.00 um'")
    assert browser.run(f"{field('gear.a.module')}.value") == "3.25 mm"
    browser.run(f"{field('gear.a.module')}.select()")
    browser("Input.insertText", text="3 mm")
    for _ in range(2):
        browser.click(button("Undo"))
    browser.until(f"{field('pair.I.load')}.value === '6 kN' && {field('gear.a.relief.tip.amount')} == null && {IDLE}")

    refused(browser)

    # The other way round: the text changes the form.
    browser.click("[...document.querySelectorAll('.q-tab')].find(one => one.textContent === 'Text')")
    browser.until("document.querySelector('textarea')?.value.includes('load = \"6 kN\"')")
    assert "# kept" in browser.run("document.querySelector('textarea').value")
    browser.click(button("Pin as A"))
    browser.until(f"{button('Unpin A')} !== undefined")
    browser.run("document.querySelector('textarea').select()")
    browser("Input.insertText", text=TEXT.replace("5 kN", "7 kN"))
    # What is pinned is first compared with itself; the text that follows differs.
    browser.until("document.querySelector('#compared').textContent.includes('pair.I.load')")

    # Narrow, dark: nothing sticks out, the figure is redrawn.
    browser.size(800, 900)
    browser.media(prefers_color_scheme="dark")
    browser.until("document.documentElement.scrollWidth <= innerWidth")
    browser.media(prefers_color_scheme="light")
    browser.size(1300, 900)

    # By hand, at a glance: a point of a relief is dragged, the slider moved; one stroke is one step back.
    browser.click(button("At a glance"))
    browser.click(button("Add tip relief"))
    point = "document.querySelector('[data-handle=\"a tip amount\"]')"
    browser.until(f"{point} !== null && {IDLE}")
    browser.run(f"{point}.scrollIntoView({{block: 'center', behavior: 'instant'}})")
    x, y = browser.run(f"(b => [b.x + b.width / 2, b.y + b.height / 2])({point}.getBoundingClientRect())")
    for kind, lower in (("mousePressed", 0), ("mouseMoved", 10), ("mouseMoved", 30), ("mouseReleased", 30)):
        browser("Input.dispatchMouseEvent", type=kind, x=x, y=y + lower, button="left", clickCount=1)
    amount = "document.querySelector('textarea').value.match(/amount = \"([\\d.]+) um\"/)?.[1]"
    browser.until(f"Number({amount}) > 0 && Number({amount}) < 9.5 && {IDLE}")
    browser.click(button("Undo"))
    browser.until(f"Number({amount}) === 10")
    browser.click(button("Undo"))
    browser.until(f"{amount} === undefined && {IDLE}")
    browser.run("document.querySelector('[data-slider]').focus()")
    press(browser, "ArrowRight", 39)
    browser.until("document.querySelector('textarea').value.includes('load = \"7.05 kN\"')")
    browser.click(button("Undo"))
    browser.until("document.querySelector('textarea').value.includes('load = \"7 kN\"')")

    # The map beside the slider follows the load that moves, and shows the one that stands still afterwards.
    browser.run("{ const hear = fegear.hear; fegear.hear = (what, content) => {"
                " if (what === 'harris') window.map = content; return hear(what, content); }; }")  # fmt: skip
    browser.until(f"document.querySelector('[data-slider]').value === '140' && {IDLE}")
    browser.run("document.querySelector('[data-slider]').focus()")
    press(browser, "ArrowRight", 39)
    browser.until("window.map !== undefined")
    browser.click(button("All results"))
    browser.until("document.querySelector('.map .main-svg') !== null")
    browser.run("document.querySelector('.map').scrollIntoView({block: 'center', behavior: 'instant'})")
    mark = "document.querySelector('.map .plot')._fullData.filter(one => one.name === map.pairs.I.now).at(-1)"
    shown = f"Math.round({mark}.x[0])"
    browser.until(f"{shown} === 7050")
    moved = "fegear.hear('load_now', {pair: 'I', load: 1, x: [0, 1], te: [0, 1]});"
    browser.run(moved)
    browser.until(f"{shown} === 1")
    browser.run(f"fegear.hear('harris', map); {moved} fegear.hear('harris', map)")
    browser.run("new Promise(done => setTimeout(done, 400))")
    assert browser.run(shown) == 7050
    browser.click(button("Undo"))
    browser.until(f"{shown} === 7000")

    browser.click(button("At a glance"))

    # At the gears: the tool is drawn, what these compliances cannot tell is said.
    drawn = "document.querySelector('.mesh-stage canvas:not(.inside)').toDataURL()"
    empty = browser.run(drawn)
    browser.click(button("Tool"))
    browser.until(f"{drawn}.length > {len(empty)} + 2000")
    browser.click(button("Deformed"))
    browser.until("document.querySelector('.mesh-told').textContent.includes('not the deformed tooth shape')")

    # What is compared no more is let go of, its pictures included, which nobody has scrolled to.
    kept = []
    for _ in range(4):
        browser.click(button("Unpin A"))
        browser.until(f"{button('Pin as A')} !== undefined && document.querySelector('#compared section') === null")
        kept.append(nodes(browser))
        browser.click(button("Pin as A"))
        browser.run("document.querySelector('[data-slider]').focus()")
        press(browser, "ArrowRight", 39)
        browser.until(f"document.querySelector('#compared').textContent.includes('pair.I.load') && {IDLE}")
        browser.click(button("Undo"))
        browser.until(f"document.querySelector('textarea').value.includes('load = \"7 kN\"') && {IDLE}")
    assert kept[-1] < kept[0] + 30

    # The server is killed; its successor has what was not saved, and writes it where it belongs.
    served.end(signal.SIGKILL)
    assert path.read_text() == TEXT
    served = serve(str(path))
    go(browser, served.address)
    browser.until(f"{field('pair.I.load')}?.value === '7 kN'")
    assert "Unsaved changes of" in browser.run("document.querySelector('.told').textContent")
    browser.click(button("Save"))
    browser.until("document.querySelector('.unsaved').textContent === 'saved'")
    assert tomllib.loads(path.read_text())["pair"]["I"]["load"] == "7 kN"
    assert "# kept" in path.read_text()

    # The report, in the folder that is offered; what stands in it is what stands on the page.
    browser.until(f"{DRAWN} && document.querySelector('.values td.number b') !== null")
    browser.click(button("Export"))
    item = "[...document.querySelectorAll('.q-item')].find(one => one.textContent.includes('Report, tables'))"
    browser.until(f"{item} !== undefined")
    browser.click(item)
    browser.until("document.activeElement.closest('.q-dialog') !== null && document.activeElement.value !== undefined")
    press(browser, "Enter", 13)
    report = tmp_path / "results" / "drive" / "report.html"
    browser.until("[...document.querySelectorAll('.q-notification')].some(one => one.textContent.includes('Wrote '))")
    assert largest_load(browser) in report.read_text()
    assert (report.parent / "tables" / "load_sharing_I.csv").is_file()

    # Nobody else is let in, and nothing has been asked of any other machine.
    bare = served.address.partition("?")[0]
    for request in (
        urllib.request.Request(bare),  # noqa: S310 - an address of this test's own server
        urllib.request.Request(served.address, headers={"Origin": "http://evil.example"}),  # noqa: S310
        urllib.request.Request(served.address, headers={"Host": "evil.example"}),  # noqa: S310
    ):
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(request)  # noqa: S310
    assert [
        one for one in browser.requests if not one.startswith(("http://127.0.0.1:", "data:", "blob:", "about:"))
    ] == []

    # A template, without a file.
    browser.click_until(button("Other case"), "document.querySelector('.start') !== null")
    browser.click("[...document.querySelectorAll('.offer')].find(one => one.textContent.startsWith('pair'))")
    browser.until(f"{field('gear.pinion.teeth')}?.value === '21'")
    assert browser.run("document.querySelector('.unsaved').textContent") == "has no file yet"
    assert [
        one for one in browser.complaints if "favicon" not in one and "WebSocket" not in one and "ERR_" not in one
    ] == []
    assert served.end(signal.SIGHUP) == 128 + signal.SIGTERM  # the terminal is closed: it ends in order


#: What a page shows of every figure, each scrolled to so that it is painted, and of every table.
STATE = """(async () => {
  const soon = () => new Promise((done) => setTimeout(done, 120)), found = {};
  for (const plot of document.querySelectorAll(".plot")) {
    plot.scrollIntoView({ block: "center", behavior: "instant" });
    await soon();
    const axes = Object.entries(plot._fullLayout).filter(([name]) => /^[xy]axis/.test(name));
    found[plot.id] = [plot.data, plot.layout, axes.map(([name, one]) => [name, one.range]), plot.ariaLabel,
      [...plot.querySelectorAll(".plot path")].map((one) => one.getAttribute("d"))];
  }
  found.values = [...document.querySelectorAll(".numbers")].map((one) => one.innerHTML);
  return JSON.stringify(found);
})()"""


PLANE = """results = ["load-sharing"]
[gear.pinion]
teeth = 21
module = "3 mm"
face_width = "30 mm"
profile_shift = 0.3
relief = { tip = { amount = "10 um", length = "4 mm" } }
[gear.wheel]
teeth = 53
module = "3 mm"
face_width = "30 mm"
profile_shift = 0.1
[pair.I]
driver = "pinion"
driven = "wheel"
torque = "260 N*m"
[effects]
neighbour_coupling = true
hertz = "load-dependent"
relief = true
[accuracy]
tolerance = 0.01
"""
AT_ONCE = (".mesh-stage", "[data-picture=te] svg", "[data-picture=sharing] svg", "[data-picture=root] svg",
           "[data-picture=harmonics] svg", "[data-key=relief_of_I_driver] svg", "[data-key=relief_of_I_driven] svg",
           "#strip .cell:last-child", "[data-handle='pinion tip amount']", "[data-slider]")  # fmt: skip
IN_SIGHT = """(names => names.filter((name) => {
  const b = document.querySelector(name)?.getBoundingClientRect();
  return !(b && b.width > 8 && b.height > 8 && b.x >= 0 && b.y >= 0
    && b.right <= innerWidth && b.bottom <= innerHeight);
}))"""
#: Largest principal stress on the fillets of the teeth in contact over the mesh, from the tables of the page [MPa].
INSIDE = """((member) => {
  const { field, data, loadAt } = fegearGears.inside("I");
  let most = 0;
  for (let i = 0; i < 60; i += 1) {
    const loads = fegearField.loaded(data, i / 60, loadAt);
    for (const [pair] of loads) {
      const value = fegearField.superposed(field, member, data, loads, pair, "tension");
      for (const n of field.gears[member].fillet) most = Math.max(most, value[n]);
    }
  }
  return most;
})"""
DRAWN_SO_FAR = """Object.fromEntries([...document.querySelectorAll('#glance [data-count]')].map((one) =>
  [one.dataset.picture ?? one.dataset.key, Number(one.dataset.count)])
  .concat([["inside", document.querySelector("canvas.inside").toDataURL()]]))"""


def serious(browser) -> list[str]:
    """What axe-core finds that is serious or worse, on the page as it is."""
    axe = pytest.importorskip("axe_core_python", reason="axe-core is missing; pip install axe-core-python")
    browser.run(Path(axe.__file__).with_name("axe.min.js").read_text("utf-8") + "; 0")
    found = browser.run("axe.run(document).then(found => found.violations.filter(one => "
                        "['serious', 'critical'].includes(one.impact)).flatMap(one => one.nodes.map(node => "
                        "`${one.id}: ${node.html.slice(0, 120)} ${node.any.map(a => a.message)}`)))")  # fmt: skip
    return list(found)


@pytest.mark.dear
def test_all_that_follows_a_dragged_point_is_in_sight_and_follows_while_it_moves(browser, serve, tmp_path):
    path = tmp_path / "drive.toml"
    path.write_text(PLANE)
    served = serve(str(path))
    browser.size(1300, 800)
    go(browser, served.address)
    browser.until(f"{DRAWN} && document.querySelector('.mesh-scales').textContent.includes('von Mises')")
    browser.until("document.querySelector('[data-number=te_peak_to_peak] .error')?.textContent.startsWith('±')")
    assert browser.run(f"{IN_SIGHT}({list(AT_ONCE)})") == []
    assert browser.run("document.documentElement.scrollHeight <= innerHeight")
    assert browser.run("document.documentElement.lang") == "en-US"

    # Colours are the root stress of the run: superposed in the page from tables, against surface strains there.
    for member in ("driver", "driven"):
        told = browser.run(f"document.querySelector('[data-number=\"{member}.largest_root_tension\"] b').textContent")
        assert browser.run(f"{INSIDE}('{member}')") == pytest.approx(float(told.split()[0]), rel=0.015)

    # What the curves of a small picture are is said above it, the highest first.
    legend = browser.run("document.querySelector('[data-picture=root] .small-legend').textContent")
    assert legend.index("tension") < legend.index("compression")
    assert "driver, tension" in legend
    assert "driven, tension" in legend

    # The gears stand where one pair touches within the relief, beside another.
    browser.run("(one => { one.value = 300; one.oninput(); })(document.querySelector('.mesh-tools input'))")

    # A point is dragged: while it is held all pictures change, its axes stand still, and it stays on its curve.
    browser.click(button("Pin as A"))
    browser.until("document.querySelector('[data-number=te_peak_to_peak] .from-a').textContent === 'as A'")
    browser.run("new Promise(done => setTimeout(done, 300))")  # the strip has another line now, and all above moves up
    point = "document.querySelector('[data-handle=\"pinion tip amount\"]')"
    x, y = browser.run(f"(b => [b.x + b.width / 2, b.y + b.height / 2])({point}.getBoundingClientRect())")

    def mouse(kind: str, lower: float) -> None:
        browser("Input.dispatchMouseEvent", type=kind, x=x, y=y + lower, button="left", buttons=1, clickCount=1)

    ticks = (
        "[...document.querySelectorAll('[data-key=relief_of_I_driver] svg text')].map(one => one.textContent).join()"
    )
    axes, before, word = browser.run(ticks), browser.run(DRAWN_SO_FAR), browser.run(f"{point}.ariaLabel")
    mouse("mousePressed", 0.0)
    mouse("mouseMoved", -6.0)
    mouse("mouseMoved", -12.0)
    changed = " && ".join(f"now.{name} !== before.{name}" for name in ("te", "sharing", "root", "harmonics", "inside"))
    browser.until(f"((now, before) => {changed})({DRAWN_SO_FAR}, {json.dumps(before)})")
    mouse("mouseMoved", -60.0)
    browser.until("document.body.classList.contains('computing') && document.querySelector("
                  "'[data-number=te_peak_to_peak] .from-a').textContent.includes('%')")  # fmt: skip
    assert browser.run(ticks) == axes
    assert browser.run(f"{point}.ariaLabel") != word
    assert browser.run(f"{point}.getBoundingClientRect().y + 11") == pytest.approx(y - 60.0, abs=1.5)
    mouse("mouseReleased", -60.0)
    browser.until(f"{IDLE} && document.querySelector('[data-number=te_peak_to_peak] .error').textContent !== ''")
    tab = "[...document.querySelectorAll('.q-tab')].find(one => one.textContent === '{}')"
    browser.click(tab.format("Text"))
    browser.until("document.querySelector('textarea')?.value.includes('length = \"4 mm\"')")
    text = tomllib.loads(browser.run("document.querySelector('textarea').value"))
    browser.click(tab.format("Form"))
    assert text["gear"]["pinion"]["relief"]["tip"]["length"] == "4 mm"  # the user's own words
    assert float(text["gear"]["pinion"]["relief"]["tip"]["amount"].split()[0]) > 12.0

    # A picture enlarged, others chosen; the choice is the window's, not the case's, and outlives it.
    browser.click("document.querySelector('[data-picture=te] button')")
    browser.until("document.querySelector('#enlarged[open] .main-svg') !== null")
    browser.click(button("Close"))
    in_large_type(browser)
    before = path.read_text()
    browser.run("document.querySelector('.choice').open = true")
    browser.click("[...document.querySelectorAll('.choice label')].find(one => one.textContent === 'Mesh stiffness')")
    browser.until("document.querySelector('[data-picture=stiffness] .small-plot path') !== null")
    assert path.read_text() == before
    go(browser, served.address)
    browser.until("document.querySelector('[data-picture=stiffness] .small-plot path') !== null")

    # Nothing that axe-core calls serious, on light and dark ground, at a glance and among all results.
    for ground in ("dark", "light"):
        browser.media(prefers_color_scheme=ground)
        browser.until(f"{IDLE} && document.body.classList.contains('body--{ground}')")
        browser.run("new Promise(done => setTimeout(done, 800))")  # colours change over a while
        assert serious(browser) == []
    browser.click(button("All results"))
    browser.until("document.querySelector('#report .main-svg') !== null")
    assert serious(browser) == []
    browser.click(button("At a glance"))

    # Narrow: the same parts below each other, nothing sticks out.
    browser.size(420, 900)
    browser.until("document.documentElement.scrollWidth <= innerWidth")
    tops = browser.run("['.mesh-stage', '.reliefs', '#strip', '#small'].map("
                       "one => document.querySelector(one).getBoundingClientRect().y)")  # fmt: skip
    assert tops == sorted(tops)
    browser.size(1300, 900)
    assert [
        one for one in browser.complaints if "favicon" not in one and "WebSocket" not in one and "ERR_" not in one
    ] == []
    served.end()


@pytest.mark.dear
def test_names_of_any_length_leave_the_page_its_width(browser, serve, tmp_path):
    path = tmp_path / "named.toml"
    path.write_text(TEXT.replace("gear.a]", f"gear.{'g' * 300}]").replace('"a"', f'"{"g" * 300}"'))
    browser.size(1300, 900)
    served = serve(str(path))
    go(browser, served.address)
    browser.until(DRAWN)
    assert browser.run("document.documentElement.scrollWidth <= innerWidth")
    served.end()


RACK = """results = ["rack-transmission-error"]
[gear.a]
teeth = 20
module = "2 mm"
profile_shift = 0.3
face_width = "20 mm"
[rack.r]
pinion = "a"
teeth = 3
reference_height = "10 mm"
force = "1 kN"
positions = 8
[accuracy]
tolerance = 0.05
"""


@pytest.mark.dear
def test_figures_beside_each_other_keep_to_their_columns(browser, serve, tmp_path):
    """The first was drawn over all of the width, before the second one came, and lay below it."""
    path = tmp_path / "rack.toml"
    path.write_text(RACK)
    browser.size(1500, 1000)
    served = serve(str(path))
    go(browser, served.address)
    plots = "[...document.querySelectorAll('.figures .js-plotly-plot')]"
    browser.until(f"{IDLE} && {plots}.length === 2 && {plots}.every(one => one.querySelector('.main-svg') !== null)")
    browser.until(f"{plots}.every(one => one.querySelector('.main-svg').clientWidth <= one.clientWidth + 1)", 10.0)
    assert browser.run(f"new Set({plots}.map(one => one.getBoundingClientRect().y)).size") == 1
    served.end()


@pytest.mark.dear
def test_more_than_a_case_may_have_is_not_put_in_and_said_at_once(browser, serve, tmp_path):
    """A browser lays such a text out for half a minute: the page was not heard meanwhile, and lost its connection."""
    served = opened(browser, serve, tmp_path)
    tab = "[...document.querySelectorAll('.q-tab')].find(one => one.textContent.trim() === '{}')"
    browser.click(tab.format("Text"))
    browser.until("document.querySelector('textarea') !== null")
    browser.run("document.querySelector('textarea').focus()")
    browser("Input.insertText", text="#" * 4_000_000)
    browser.until(
        "document.querySelector('.q-notification')?.textContent.includes('Not inserted: the text would exceed')"
    )
    assert browser.run("document.querySelector('textarea').value") == TEXT
    browser.run("document.querySelector('textarea').select()")
    browser("Input.insertText", text=TEXT.replace("5 kN", "7 kN"))  # and what is short enough is
    browser.click(tab.format("Form"))
    browser.until(f"{field('pair.I.load')}?.value === '7 kN'")
    served.end()


@pytest.mark.long
def test_a_page_on_which_values_were_moved_shows_what_a_fresh_page_shows(browser, serve, tmp_path):
    path = tmp_path / "drive.toml"
    path.write_text(TEXT.replace('["load-sharing"]', '["load-sharing", "transmission-error"]'))
    served = serve(str(path))
    go(browser, served.address)
    browser.until(f"{DRAWN} && {field('pair.I.load')} !== null")
    browser.click(button("All results"))
    browser.until(PAINTED)
    browser.until(MAPPED)
    settled = json.loads(browser.run(STATE))
    browser.run("window.cheap = 0; const animate = Plotly.animate;"
                "Plotly.animate = (...given) => { cheap += 1; return animate(...given); }")  # fmt: skip

    def change(script: str, task: str) -> None:
        browser.run(f"new Promise((done) => {{ const hear = fegear.hear; fegear.hear = (what, content) => {{"
                    f"const line = hear(what, content); if (content.task === '{task} of I') {{"
                    f"fegear.hear = hear; line.then(done); }} return line; }}; {script} }})")  # fmt: skip

    for i in range(12):  # near one figure, then near the other
        browser.run(f"document.querySelectorAll('#results .plot')[{i // 6}]"
                    ".scrollIntoView({block: 'center', behavior: 'instant'})")  # fmt: skip
        change(f"emitEvent('load', {{pair: 'I', key: 'load', text: '{5 + 0.03 * i:.2f} kN', moving: true}})",
               "transmission-error")  # fmt: skip
    for i in range(12):
        change("emitEvent('relief', {gear: 'a', end: 'tip', start: 28,"
               f"amount: {(4 + 0.1 * i) * (1 + i // 8)}, moving: true}})", "transmission-error")  # fmt: skip
    assert browser.run("cheap") >= 6
    # The last place again, let go of: nothing is sent anew but that it is at rest.
    change(f"emitEvent('relief', {{gear: 'a', end: 'tip', start: 28, amount: {(4 + 0.1 * 11) * 2}, moving: false}})",
           "transmission-error")  # fmt: skip
    browser.until(IDLE)
    moved = json.loads(browser.run(STATE))
    go(browser, served.address)
    browser.until(PAINTED)  # it was left with all results
    browser.until(MAPPED)
    fresh = json.loads(browser.run(STATE))
    assert moved.keys() == fresh.keys() == settled.keys()
    for name, one in fresh.items():
        assert moved[name] == one, name
    assert [name for name, one in fresh.items() if settled[name] == one] == []
    served.end()


ASSEMBLED = """results = ["planet-load-sharing", "shaft-deflection"]
gear.sun = { teeth = 25, module = "2 mm", face_width = "25 mm" }
gear.planet = { teeth = 29, module = "2 mm", face_width = "25 mm" }
gear.a = { teeth = 25, module = "2 mm", face_width = "25 mm" }
gear.b = { teeth = 29, module = "2 mm", face_width = "25 mm" }
pair.I = { driver = "a", driven = "b", load = "2 kN", compliance = { source = "weber-banaschek" } }
pair.P_sun = { driver = "sun", driven = "planet", compliance = { source = "weber-banaschek" } }
bearing.one = { radial = "300 N/um", fixed = true }
[planetary.P]
sun = "sun"
planet = "planet"
ring_teeth = 83
planets = 4
torque = "320 N*m"
stiffness = { sun_mesh = "400 N/um", ring_mesh = "480 N/um", pin = "250 N/um" }
pin_errors = { tangential = ["20 um", "0 um", "-10 um", "0 um"] }
[shaft.in]
sections = [{ length = "120 mm", outer = "30 mm" }]
gears = [{ gear = "a", at = "40 mm" }]
bearings = [{ bearing = "one", at = "10 mm" }, { bearing = "one", at = "110 mm" }]
coupling = "0 mm"
[shaft.out]
axis = ["0 mm", "54 mm"]
sections = [{ length = "120 mm", outer = "30 mm" }]
gears = [{ gear = "b", at = "40 mm" }]
bearings = [{ bearing = "one", at = "10 mm" }, { bearing = "one", at = "110 mm" }]
coupling = "120 mm"
"""


@pytest.mark.dear
def test_a_set_turns_with_its_loads_and_a_mesh_of_the_gearbox_opens_its_pair(browser, serve, tmp_path):
    path = tmp_path / "both.toml"
    path.write_text(ASSEMBLED)
    served = serve(str(path))
    browser.size(1300, 800)
    go(browser, served.address)
    # The set comes first: colours of the planets by their loads, numbers and pictures of the set.
    canvas = "document.querySelector('[data-set=P] canvas')"
    browser.until(f"{IDLE} && document.querySelector('[data-set=P] .mesh-scale i') !== null")
    browser.until("document.querySelector('[data-number=K_gamma] b') !== null")
    browser.until("document.querySelector('[data-picture=planet-loads] .small-plot path') !== null")
    subject = "document.querySelector('#strip .subject b').textContent"  # several are there: whose numbers these are
    assert browser.run(subject) == "set P"
    at_rest = browser.run(f"{canvas}.toDataURL()")
    browser.run("(one => { one.value = 40; one.oninput(); })(document.querySelector('[data-set=P] input[type=range]'))")
    assert browser.run(f"{canvas}.toDataURL()") != at_rest  # 2 degrees on
    unequal = browser.run("fegearSets.of('P').loads.shares")
    assert sum(unequal) == pytest.approx(4.0, abs=1e-5)
    assert max(unequal) > 1.05
    browser.click("[...document.querySelectorAll('[data-set=P] button')].find(one => one.textContent === 'Nearer')")
    assert browser.run("fegearSets.of('P').focus") == 0
    # An exercise shows the set without its loads, and answers in a sentence.
    with_loads = browser.run(f"{canvas}.toDataURL()")
    browser.run("document.getElementById('to-exercise').click()")
    browser.until("document.body.classList.contains('exercise')")
    assert browser.run(f"getComputedStyle({canvas}).visibility") == "visible"
    browser.until(f"{canvas}.toDataURL() !== {json.dumps(with_loads)}")
    answer = "document.querySelector('#asked output').textContent"
    counts_echoes(browser)
    for words in ("mesh with the sun", "planet ", "(n_s − n_c) / (n_r − n_c) = −z_r/z_s"):
        pressed_and_heard(browser, "document.getElementById('to-answers')")
        browser.until(f"{answer}.includes('{words}')", 10.0)
        pressed_and_heard(browser, button("Next question"))
        assert browser.run(answer) == ""
    browser.run("document.getElementById('to-exercise').click()")
    browser.until("!document.body.classList.contains('exercise')")

    # The gearbox: bent, by a factor that is said and can be changed; a mesh that is pressed opens its pair.
    browser.run(
        "(one => { one.value = 'gearbox'; one.onchange(); })(document.querySelector('.hand:not([hidden]) h2 select'))"
    )
    told = "document.querySelector('.hand:not([hidden]) .mesh-told').textContent"
    browser.until(f"{told}.includes('times as large')")
    box = "document.querySelector('.hand:not([hidden]) canvas')"
    browser.until("fegearGearbox.of().places.length === 1")
    bent = browser.run(f"{box}.toDataURL()")
    browser.run(
        "(one => { one.value = 0; one.oninput(); })(document.querySelector('.hand:not([hidden]) .mesh-factor input'))"
    )
    assert browser.run(f"{box}.toDataURL()") != bent
    assert "0 times" in browser.run(told)
    assert serious(browser) == []
    x, y = browser.run(f"(b => [b.x, b.y])({box}.getBoundingClientRect())")
    px, py = browser.run("fegearGearbox.of().places[0].slice(1)")
    for kind, pressed in (("mouseMoved", "none"), ("mousePressed", "left"), ("mouseReleased", "left")):
        browser("Input.dispatchMouseEvent", type=kind, x=x + px, y=y + py, button=pressed, clickCount=1)
    browser.until("document.querySelector('.hand:not([hidden])').dataset.pair === 'I'")
    browser.until("document.querySelector('[data-picture=te] .small-plot path') !== null")
    assert browser.run("fegearGlance.pair()") == "I"
    assert browser.run(subject) == "pair I"
    go(browser, served.address)  # it is the window's to remember
    browser.until("document.querySelector('.hand:not([hidden])')?.dataset.pair === 'I'")
    browser.size(1300, 900)
    assert [
        one for one in browser.complaints if "favicon" not in one and "WebSocket" not in one and "ERR_" not in one
    ] == []
    served.end()


@pytest.mark.long
def test_the_tip_of_a_crack_is_dragged_and_its_tooth_follows(browser, tmp_path):
    """Length and angle of the case, stress intensity and picture."""
    case = Path(__file__).parents[2] / "cases" / "cracked_tooth.toml"
    asked = 'results = ["mesh-stiffness-revolution", "odd-tooth-stiffness", "stress-intensity"]'
    (tmp_path / "c.toml").write_text(case.read_text().replace(asked, 'results = ["odd-tooth-stiffness"]'))
    served = Served(tmp_path, "c.toml")
    try:
        go(browser, served.address)
        browser.until(f"{IDLE} && document.querySelector('section.crack') !== null")
        browser.run("fegearMiddle.choose('crack pinion')")
        browser.until("document.querySelector('.crack-tip')?.getBoundingClientRect().width > 0")
        words = browser.run("document.querySelector('.crack-words').textContent")
        assert words.startswith("Crack 2.13 mm: K_I = 8.5")
        box = "document.querySelector('.crack-tip').getBoundingClientRect()"
        x, y = browser.run(f"(one => [one.x + one.width / 2, one.y + one.height / 2])({box})")
        mouse = {"button": "left", "buttons": 1}
        browser("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, clickCount=1, **mouse)
        for i in range(1, 6):
            browser("Input.dispatchMouseEvent", type="mouseMoved", x=x + 8 * i, y=y - 3 * i, **mouse)
        browser.until(f"document.querySelector('.crack-words').textContent !== {json.dumps(words)}")
        browser("Input.dispatchMouseEvent", type="mouseReleased", x=x + 40, y=y - 15, button="left", buttons=0)
        browser.until(f"{IDLE} && document.querySelector('.crack-words').textContent.startsWith('Crack 1.5')")
        words = browser.run("document.querySelector('.crack-words').textContent")
        browser.run("document.querySelector('.crack-tip').focus()")
        press(browser, "ArrowRight", 39)
        browser.until(f"{IDLE} && document.querySelector('.crack-words').textContent !== {json.dumps(words)}")
    finally:
        served.end()
