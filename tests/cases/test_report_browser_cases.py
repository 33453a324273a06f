"""The report in a real browser: it asks nobody for anything, draws, hides what is clicked, hands out the tables."""

from __future__ import annotations

import base64
import csv
import importlib.util
import io
import math
import sys
import zipfile
from pathlib import Path

import pytest
from solved_once import CACHE

from fegear.base.errors import MissingLibraryError
from fegear.case.reading import read_scene
from fegear.engine.executor import Executor
from fegear.engine.plan import make_plan
from fegear.engine.run import Silence, run_plan
from fegear.output.run_files import write_results
from fegear.output.sweep import write_sweep
from fegear.results.catalogue import STAGES
from fegear.studies.sweep import read_axis, sweep_case

_spec = importlib.util.spec_from_file_location("chromium", Path(__file__).with_name("chromium.py"))
assert _spec is not None
assert _spec.loader is not None
chromium = importlib.util.module_from_spec(_spec)
sys.modules["chromium"] = chromium
_spec.loader.exec_module(chromium)

CASES = Path(__file__).parents[2] / "cases"


def made(folder: Path, name: str, *overrides: str) -> Path:
    scene = read_scene(CASES / f"{name}.toml", overrides)
    write_results(run_plan(scene, make_plan(scene, STAGES), cache=CACHE), folder, Silence(), plots=False)
    return folder


@pytest.fixture(scope="module")
def gear(tmp_path_factory):
    """Tables of one gear: curves with error bands, two panels, a text column."""
    return made(tmp_path_factory.mktemp("gear"), "lin_table1", "stiffness.positions=20", "accuracy.tolerance=0.05")


@pytest.fixture(scope="module")
def relief(tmp_path_factory):
    """A designed relief: families of curves behind a menu."""
    return made(tmp_path_factory.mktemp("relief"), "mark_minimum_excitation")


@pytest.fixture(scope="module")
def browser(program):
    with chromium.Browser(program("chromium")) as opened:
        yield opened


@pytest.fixture
def page(browser, gear):
    """The gear's report in a wide, light window; opened again only where a test has left it."""
    address = (gear / "report.html").absolute().as_uri()
    browser.size(1300, 900)
    browser.media(prefers_color_scheme="light")
    if browser.run("location.href.split('#')[0]") != address:
        browser.requests.clear()
        browser.complaints.clear()
        browser.open(gear / "report.html")
    return browser


def plot(key: str) -> str:
    return f"document.getElementById('plot-{key}')"


def test_it_asks_for_nothing_and_complains_of_nothing(page, gear):
    address = (gear / "report.html").absolute().as_uri()
    assert [url for url in page.requests if url != address and not url.startswith("data:")] == []
    assert page.complaints == []
    assert page.run("document.documentElement.dataset.ready") == "yes"


def test_no_button_sends_the_data_away(page):
    names = page.run("[...document.querySelectorAll('.modebar-btn')].map(b => b.getAttribute('data-title'))")
    assert set(names) <= {
        "Download plot",
        "Zoom",
        "Pan",
        "Reset axes",
        "Download plot as a SVG",
        "Download plot as SVG",
    }


def test_plots_are_drawn_from_the_tables(page, gear):
    assert page.run("document.querySelectorAll('.plot .main-svg').length") >= 4
    assert page.run("[...document.querySelectorAll('.plot')].every(p => p.querySelector('path.js-line'))") is False
    drawn = page.run(f"{plot('compliance_a')}._fullData.map(t => [t.name, [...t.x], [...t.y]])")
    head, *rows = [line.split(",") for line in (gear / "tables" / "stiffness_a.csv").read_text().splitlines()]
    at = head.index("roll_angle [deg]")
    curve = {name: (x, y) for name, x, y in drawn if len(x) == len(rows)}
    x, y = curve["c<sub>0</sub>, loaded tooth"]
    assert x == pytest.approx([float(row[at]) for row in rows], rel=1e-11)
    assert y == pytest.approx([float(row[head.index("c_self [um.mm/N]")]) for row in rows], rel=1e-11)
    lines = f"{plot('compliance_a')}.querySelectorAll('path.js-line').length"
    assert page.run(lines) >= 3


@pytest.mark.dear
def test_a_click_on_the_legend_hides_the_curve_and_another_brings_it_back(page):
    entry = f"{plot('root_stress_a')}.querySelectorAll('.legendtoggle')[0]"
    shown = f"{plot('root_stress_a')}.data.filter(t => t.name?.startsWith('tension')).map(t => t.visible ?? true)"
    assert set(page.run(shown)) == {True}
    page.click(entry)
    page.until(f"{shown}.every(v => v === 'legendonly')")
    other = "t.name?.startsWith('compression') && (t.visible ?? true) === true"
    assert page.run(f"{plot('root_stress_a')}.data.some(t => {other})")
    page.run("new Promise(done => setTimeout(done, 400))")  # a second click at once would be a double click
    page.click(entry)
    page.until(f"{shown}.every(v => v === true)")


def test_downloads_are_the_very_files(page, gear):
    page.click("document.querySelector('button[data-file=\"tables/stiffness_a.csv\"]')")
    assert page.downloaded("stiffness_a.csv") == (gear / "tables" / "stiffness_a.csv").read_bytes()
    page.click("document.getElementById('all-files')")
    with zipfile.ZipFile(io.BytesIO(page.downloaded("lin_table1.zip"))) as packed:
        names = {name for name in packed.namelist() if name.startswith("tables/")}
        assert names == {f"tables/{path.name}" for path in (gear / "tables").iterdir()}
        assert all(packed.read(name) == (gear / name).read_bytes() for name in names)
        assert "lin_table1.toml" in packed.namelist()


def test_tables_open_and_sort(page, gear):
    block = "document.querySelector('.data[data-file=\"tables/stiffness_a.csv\"]')"
    assert page.run(f"{block}.querySelectorAll('tbody tr').length") == 6
    page.click(f"{block}.querySelector('.more')")
    page.until(f"{block}.querySelectorAll('tbody tr').length === 20")
    head = (gear / "tables" / "stiffness_a.csv").read_text().splitlines()[0].split(",")
    at = head.index("c_prev [um.mm/N]")
    page.click(f"{block}.querySelectorAll('th .sort')[{at}]")
    page.until(f"{block}.querySelectorAll('th')[{at}].getAttribute('aria-sort') === 'ascending'")
    page.run("new Promise(done => setTimeout(done, 50))")
    shown = page.run(f"[...{block}.querySelectorAll('tbody tr')].map(r => Number(r.cells[{at}].textContent))")
    assert shown == sorted(shown)
    assert len(set(shown)) > 10


def test_the_plan_opens(page):
    fold = "[...document.querySelectorAll('#plan details')].at(-1)"
    hidden = f"{fold}.querySelector('table').checkVisibility()"
    assert page.run(hidden) is False
    page.click(f"{fold}.querySelector('summary')")
    page.until(hidden)
    assert '"transmission-error" is not in results' in page.run(f"{fold}.textContent")


def test_dark_pages_are_dark_and_their_plots_legible(page):
    ground = "getComputedStyle(document.body).backgroundColor"
    text = f"getComputedStyle({plot('fillet_a')}.querySelector('.xtick text')).fill"
    light = page.run(ground), page.run(text)
    page.media(prefers_color_scheme="dark")
    page.until(f"{ground} !== '{light[0]}'")
    page.until(f"{text} !== '{light[1]}'")

    def brightness(told: str) -> int:
        return sum(int(part) for part in told[4:-1].split(",")[:3])

    assert brightness(light[0]) > 600 > 300 > brightness(light[1])
    assert brightness(page.run(ground)) < 200 < 600 < brightness(page.run(text))


@pytest.mark.dear("700")
@pytest.mark.parametrize("width", [1300, 700, 360])
def test_no_width_makes_the_page_scroll_sideways(page, width):
    page.size(width, 800)
    overflow = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
    page.until(f"{overflow} === 0")
    page.until("[...document.querySelectorAll('.plot')].every(p => p.scrollWidth <= p.clientWidth + 1)")
    assert page.run(overflow) == 0


@pytest.mark.dear("span W")
@pytest.mark.parametrize("words", ["span W", "over balls or pins M"])
def test_the_answer_is_seen_first_and_span_and_dimension_over_balls_one_click_away(page, words):
    page.run("scrollTo(0, 0)")
    assert page.run("document.querySelector('main section h2').textContent") == "Answer"
    assert page.run("document.querySelector('ul.answer').getBoundingClientRect().bottom") < 560
    assert page.run("document.querySelectorAll('ul.notes > li').length") <= 3
    link = "[...document.querySelectorAll('nav a')].find(a => a.textContent.startsWith('Gear data'))"
    assert page.run(f"{link}.getBoundingClientRect().bottom") < 900
    page.run("document.documentElement.style.scrollBehavior = 'auto'")
    page.click(link)
    row = f"[...document.querySelectorAll('.sheet tr')].find(r => r.textContent.trim().startsWith('{words}'))"
    left, right, bottom = page.run(
        f"(() => {{ const b = {row}.getBoundingClientRect(); return [b.left, b.right, b.bottom]; }})()"
    )
    assert 0 < left < right < 1300
    assert bottom < 900
    assert float(page.run(f"{row}.cells[1].textContent")) > 10.0
    assert page.complaints == []


def test_values_and_gear_data_fit_a_telephone(page):
    page.size(420, 900)
    parts = "[...document.querySelectorAll('.sheet, .wide:has(> .values)')].filter(p => p.checkVisibility())"
    page.until(f"{parts}.every(p => p.scrollWidth <= p.clientWidth + 1)")
    assert page.run(f"{parts}.length") >= 2


@pytest.mark.dear
def test_the_menu_of_a_harris_map_changes_its_curves(page, relief):
    page.open(relief / "report.html")
    assert page.complaints == []
    key = "harris_map_I"
    shown = f"{plot(key)}._fullData.filter(t => t.visible === true)"
    heights = f"{shown}.map(t => Math.max(...t.y) - Math.min(...t.y))"
    menu = page.run(f"{plot(key)}.layout.updatemenus[0].buttons.map(b => b.label)")
    assert menu[0] == "designed"
    assert min(page.run(heights)) < 1e-6  # at the design load the designed relief leaves nothing
    plain = menu.index("no relief")
    page.click(f"{plot(key)}.querySelector('.updatemenu-header')")
    page.until(f"{plot(key)}.querySelectorAll('.updatemenu-dropdown-button').length > 1")
    page.run("new Promise(done => setTimeout(done, 300))")
    page.click(f"{plot(key)}.querySelectorAll('.updatemenu-dropdown-button')[{plain}]")
    page.until(f"Math.min(...{heights}) > 0.1")
    page.media(prefers_color_scheme="dark")
    page.until(f"{plot(key)}.layout.font.family && {plot(key)}.layout.updatemenus[0].active === {plain}")
    page.run("new Promise(done => setTimeout(done, 300))")
    assert min(page.run(heights)) > 0.1  # what was chosen stays so when the page turns dark


@pytest.mark.dear
def test_paper_shows_what_is_folded_and_is_white(page):
    page.media(prefers_color_scheme="dark")
    folded = "document.querySelectorAll('details:not([open])').length"
    before = page.run(folded)
    assert before >= 3
    assert base64.b64decode(page("Page.printToPDF")["data"]).startswith(b"%PDF")
    page.run("dispatchEvent(new Event('beforeprint'))")
    assert page.run(folded) == 0
    page.run("dispatchEvent(new Event('afterprint'))")
    assert page.run(folded) == before
    page("Emulation.setEmulatedMedia", media="print")
    page.until("getComputedStyle(document.body).backgroundColor === 'rgb(255, 255, 255)'")
    page("Emulation.setEmulatedMedia", media="")


def test_without_plotly_the_page_says_what_to_install_and_keeps_everything_else(browser, gear, tmp_path, monkeypatch):
    def missing() -> str:
        raise MissingLibraryError("plotly.js is missing; run: pip install plotly")

    monkeypatch.setattr("fegear.output.report.page.compressed_plotly", missing)
    made(tmp_path, "lin_table1", "stiffness.positions=5", "accuracy.tolerance=0.5")
    browser.complaints.clear()
    browser.open(tmp_path / "report.html")
    assert browser.complaints == []
    assert "run: pip install plotly" in browser.run(f"{plot('compliance_a')}.textContent")
    block = "document.querySelector('.data[data-file=\"tables/stiffness_a.csv\"]')"
    assert browser.run(f"{block}.querySelector('tbody tr').cells.length") == 1 + 5  # it stands on its side


# ---- sweeps ------------------------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """A sweep whose largest profile shifts are pointed teeth."""
    folder = tmp_path_factory.mktemp("sweep")
    axes = [read_axis("gear.a.profile_shift=0:2:5"), read_axis("gear.a.teeth=20:26:3")]
    results = sweep_case(CASES / "lin_table1.toml", axes, ['results=["geometry"]'], executor=Executor(workers=1))
    assert 0 < len(results.failures) < 15
    write_sweep(results, folder, plots=False)
    return results, folder


@pytest.mark.dear
def test_a_sweep_is_shown_as_map_curves_and_lines_through_all_its_values(browser, swept):
    results, folder = swept
    browser.size(1300, 900)
    browser.complaints.clear()
    browser.open(folder / "report.html")
    assert browser.complaints == []
    rows = list(csv.DictReader((folder / "tables" / "sweep.csv").open(encoding="utf-8")))
    ratio = [float(row["I.contact_ratio"] or math.nan) for row in rows]
    expected = [[None if math.isnan(v) else v for v in ratio[k::3]] for k in range(3)]

    def digits(rows: list) -> list:  # as many as the table has
        return [[None if v is None else float(f"{v:.12g}") for v in row] for row in rows]

    tiles = f"{plot('sweep_map')}._fullData.find(t => t.visible === true).z.map(row => [...row])"
    assert digits(browser.run(tiles)) == expected
    shown = f"{plot('sweep_curves')}._fullData.filter(t => t.visible === true)"
    assert digits(browser.run(f"{shown}.map(t => [...t.y])")) == expected
    browser.click(f"{plot('sweep_curves')}.querySelector('.updatemenu-header')")
    browser.until(f"{plot('sweep_curves')}.querySelectorAll('.updatemenu-dropdown-button').length > 1")
    browser.run("new Promise(done => setTimeout(done, 300))")
    browser.click(f"{plot('sweep_curves')}.querySelectorAll('.updatemenu-dropdown-button')[1]")
    browser.until(f"{plot('sweep_curves')}.querySelector('.ytitle').textContent.includes('centre_distance [mm]')")
    lines = f"{plot('sweep_coordinates')}._fullData.filter(t => t.visible === true).flatMap(t => [...t.x])"
    assert browser.run(f"{lines}.filter(x => x === null).length") == len(results.points) - len(results.failures)
    assert browser.run("document.querySelector('#failures').textContent").count("pointed") >= 1
    browser.size(360, 800)
    browser.until("document.documentElement.scrollWidth === document.documentElement.clientWidth")
