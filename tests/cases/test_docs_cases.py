"""The site builds with one command, its links hold, and its pages do what they tell their reader to type."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import inspect
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"

#: Pages whose runs cost more than a second or two; ./docs.sh runs every page, and so does the long run of the tests.
COSTLY = {
    "cases-and-runs", "choose-a-tolerance", "commands", "compound-planetary-set", "corner-contact-warning", "cost",
    "cracked-gear", "design-a-fillet", "double-helical-pair", "dynamic-factor", "export", "fem",
    "gear-with-its-width", "helical", "helical-misalignment", "design",
    "load-over-the-face", "measured-root-strain", "measured-transmission-error", "mesh-as-fmu", "mesh-in-adams",
    "mesh-in-openmodelica", "mesh-in-ross", "mesh-in-simulink", "own-equation-of-motion", "proofs",
    "python", "python-formulas",
    "python-mechanics", "python-output", "python-planetary", "python-speeds", "python-wide-pair",
    "rack-and-pinion", "several-meshes",
    "relief-for-torques", "relieve-a-helical-pair", "results", "scuffing-micropitting-loss", "stiffness-table",
    "studies-and-output",
    "sweep-on-a-cluster",
    "shafts-and-bearings", "size-a-pair", "stability", "sweeps", "torque-ripple", "tutorial",
    "rate-a-pair", "tolerances", "use-my-own-compliance", "use-my-own-mesh", "validate-root-stress-formula",
}  # fmt: skip


#: Programs of the tree.
FILES = [path.relative_to(ROOT).as_posix() for top in ("fegear", "docs", "tests", "benchmarks", "cases")
         for path in sorted((ROOT / top).rglob("*.py"))]  # fmt: skip


def _snippets():
    spec = importlib.util.spec_from_file_location("docs_snippets", DOCS / "snippets.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


snippets = _snippets()
PAGES = [page for page in sorted(DOCS.rglob("*.md")) if snippets.runs(page)]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site with one case of the gallery and no page run, and what mkdocs said."""
    pytest.importorskip("mkdocs")
    folder = tmp_path_factory.mktemp("docs") / "site"
    environment = {**os.environ, "FEGEAR_GALLERY": "litvin_lead", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--site-dir", str(folder)],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )
    assert done.returncode == 0, done.stderr
    return folder, done.stderr


@pytest.mark.long
def test_the_search_is_in_sight_and_works_in_a_folder(site, program):
    """A browser starts no worker below file://, which is where the site is opened first."""
    folder, said = site
    assert f"The site starts at {folder / 'index.html'}" in said
    spec = importlib.util.spec_from_file_location("docs_chromium", Path(__file__).with_name("chromium.py"))
    chromium = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(chromium)
    typed = """(async () => {
        const field = document.querySelector('.md-search__input');
        document.querySelector('[data-md-toggle=search]').click();
        field.value = 'robustness';
        field.dispatchEvent(new KeyboardEvent('keyup', { bubbles: true }));
    })()"""
    found = "document.querySelector('.md-search-result__list').innerText"
    with chromium.Browser(program("chromium")) as browser:
        for name in ("index.html", "reference/geometry.html"):
            browser("Page.navigate", url=(folder / name).as_uri())
            browser.until("document.readyState === 'complete'")
            browser.run(typed)
            browser.until(f"{found}.includes('robust')")
            top, bottom = browser.run(
                "(() => { const b = document.querySelector('.md-search__input').getBoundingClientRect();"
                " return [b.top, b.bottom]; })()"
            )
            assert 0 <= top < bottom < 200
        assert browser.complaints == []


@pytest.mark.long
def test_the_site_builds_without_a_warning(site):
    folder, said = site
    # Pages that name other cases, or show what their own run makes, link to what this shortened site leaves out.
    left_out = ("'gallery/", "gallery/", "_files/results/")
    faults = [line for line in said.splitlines() if line.startswith("WARNING")]
    assert [line for line in faults if not any(name in line for name in left_out)] == []
    start = (folder / "index.html").read_text("utf-8")
    assert start.count("<path class=") == 2  # both gears of the pair that turns
    assert "<!-- " not in start.partition("<article")[2].partition("</article>")[0]
    page = (folder / "gallery" / "litvin_lead.html").read_text("utf-8")
    assert "fegear run cases/litvin_lead.toml" in re.sub("<[^>]+>", "", page)
    assert page.count("<img") >= 1
    assert '<h2 id="numbers">' in page
    assert "<math" in (folder / "tutorial.html").read_text("utf-8")


def _hook(name):
    pytest.importorskip("mkdocs")
    spec = importlib.util.spec_from_file_location(f"docs_{name}", DOCS / f"{name}.py")
    hook = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hook)
    return hook


def test_the_menu_refuses_a_lost_page_and_a_long_group(tmp_path):
    menu = _hook("menu")
    (tmp_path / "there.md").write_text("# There")
    (tmp_path / "lost.md").write_text("# Lost")
    nav = [{"Start": "there.md"}, {"Much": [{str(n): "there.md"} for n in range(menu.LARGEST_GROUP + 1)]}]
    assert menu.faults(nav, tmp_path) == [
        "the menu > Much has 9 entries; 8 are taken in at a glance",
        "docs/lost.md stands in no group of mkdocs.yml",
    ]
    assert menu.faults([{"Start": "there.md"}, {"In": ["lost.md"]}], tmp_path) == []


@pytest.mark.parametrize(
    ("spelled", "letters"),
    [
        ("K_Hbeta and K_Falpha", "K_Hβ and K_Fα"),
        ("sigma_HP, alpha_wt, c_gamma_beta", "σ_HP, α_wt, c_γβ"),
        ("F_betay, f_falphaT, Z_epsilon", "F_βy, f_fαT, Z_ε"),
        ('`K_Hbeta` $\\sigma_F$ <a name="K_Hbeta">', None),
        ("[x](rating.md#k_gamma_x) cases/khbeta_spur.toml tables/K_Hbeta.csv", None),
        ("### K_Hbeta\n```text\nI.K_Hbeta = 1.3\n```", None),
        ("beta, a Greek letter; mode_alphabet", None),
        ("by .5 um (-.2 %), +.25 of 3 N m", "by 0.5 µm (-0.2 %), +0.25 of 3 N m"),
        ("`.5 um` file.7z 1.5, 0.2.0, [1](a.md)", None),
    ],
)
def test_symbols_of_the_prose_have_greek_letters_and_nothing_else_has(spelled, letters):
    assert _hook("greek").with_letters(spelled) == (letters or spelled)


_SPELLED_OTHERWISE = re.compile(r"(?:^|[\s(|~+-])\.\d|\bum\b|\d%|\d(?:µm|mm|MPa)\b")


@pytest.mark.parametrize("spelled", [".5 of", "is -.5", "(.5)", "3 um", "5% of", "5mm", "5 um/N"])
def test_other_ways_of_decimals_and_units_are_found(spelled):
    assert _SPELLED_OTHERWISE.search(spelled)
    assert not _SPELLED_OTHERWISE.search("0.5 of 3 µm, 5 % and 5 mm; a sum")


def test_prose_has_one_way_of_decimals_and_of_micrometres():
    """On the site, whatever the files have; a decimal comma is nowhere in them."""
    greek = _hook("greek")
    for page in (*DOCS.rglob("*.md"), ROOT / "README.md", ROOT / "CHANGELOG.md"):
        prose = greek._OTHER.sub(" ", greek.with_letters(page.read_text("utf-8")))
        found = [line for line in prose.splitlines() if _SPELLED_OTHERWISE.search(line)]
        assert found == [], page


def test_every_section_of_the_case_file_s_page_is_on_one_page_of_the_site_and_links_find_it():
    pages = _hook("case_pages")
    text = pages.PAGE.read_text("utf-8")
    texts, homes = pages.split(text)
    assert {*texts} == {pages.PAGE.name, *pages.PAGES}
    parts = [part for part in re.split(r"^(?=## )", text, flags=re.MULTILINE) if part.strip()]
    assert [sum(part in page for page in texts.values()) for part in parts] == [1] * len(parts)
    assert max(len(page.splitlines()) for page in texts.values()) < 0.5 * len(text.splitlines())
    linked = {
        anchor
        for page in DOCS.rglob("*.md")
        for anchor in re.findall(r"case-files\.md#([\w-]+)", page.read_text("utf-8"))
    }
    assert linked <= {*homes}
    assert pages.relinked("[a](../case-files.md#gearname)", "how-to/x.md", homes) == (
        "[a](../case-files-gears.md#gearname)"
    )
    assert pages.relinked("[a](#quantities)", "case-files-gears.md", homes) == "[a](case-files.md#quantities)"


def test_a_dead_link_and_a_fetched_script_are_found(tmp_path):
    links = _hook("links")
    (tmp_path / "there.html").write_text('<a href="#here">a</a> <a href="https://example.org">b</a>')
    (tmp_path / "page.html").write_text(
        '<a href="there.html#x">a</a> <img src="lost.png"> <script src="https://example.org/x.js"></script>'
    )
    assert links.faults(tmp_path) == ["page.html loads https://example.org/x.js", "page.html links to lost.png"]


@pytest.mark.parametrize("tex", [r"\frac{a}{b} x_{j'}", r"\begin{align*} a &= b \\ c &= d \end{align*}"])
def test_an_equation_becomes_mathml(tex):
    pytest.importorskip("latex2mathml")
    assert _equations().mathml(tex, display=True).startswith("<math")


@pytest.mark.parametrize("tex", [r"\nonsense{a}", r"\begin{aligned} a &= b \\ c &= d \end{aligned}"])
def test_an_equation_that_would_be_printed_as_it_stands_is_refused(tex):
    exceptions = pytest.importorskip("mkdocs.exceptions")
    with pytest.raises(exceptions.PluginError, match="MathML"):
        _equations().mathml(tex, display=True)


def _equations():
    spec = importlib.util.spec_from_file_location("docs_equations", DOCS / "equations.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("said", "printed"),
    [
        ("c = 0.0316 +- 2.3e-05 um", "c = 0.0315998 +- 3.1e-05 um"),
        ("5 pairs\n...\nWrote a in ... s.", "5 pairs\nmore\nWrote a in 3.14 s."),
        ("W = 8783.69 N", "W = 8783.68955 N"),
        (
            "Note: it moves gaps by 3.93 um; the error reaches 8e-02.",
            "Note: it moves gaps by 3.95 um; the error reaches 5e-02.",
        ),
        ("Note: te = 7.84 +- 0.02 um (0.26 %).", "Note: te = 7.9 +- 0.03 um (0.38 %)."),
        ("te [um]    1.205077     2.43", "te [um]     1.20348     2.43"),
    ],
)
def test_what_a_page_says_is_what_is_printed(said, printed):
    assert snippets.compare(said, printed) is None  # it raises where they differ


@pytest.mark.parametrize(
    ("said", "printed"),
    [
        ("c = 0.0316", "c = 0.0319"),
        ("c = 0.0316 +- 2e-05", "c = 0.0316 +- 2e-04"),
        ("5 pairs", "6 pairs"),
        ("a\nb", "a"),
        ("a", "a\nb"),
        ("a\n...\nc", "a\nb"),
        ("x = 1.0 um", "x = 1.0 mm"),
        ("te [um]    1.205077     2.43", "te [um] 1.205077     2.43"),
        ("te [um]    1.205077     2.43", "te [um]    1.215077     2.43"),
        ("Note: it moves gaps by 3.93 um.", "Note: it moves gaps by 4.2 um."),
        ("Note: it moves gaps by 3.93 um.", "Note: it closes gaps by 3.93 um."),
        ("Note: te = 7.84 +- 0.02 um (0.2 %).", "Note: te = 7.84 +- 0.2 um (0.2 %)."),
    ],
)
def test_what_a_page_says_is_not_what_is_printed(said, printed):
    with pytest.raises(snippets.DifferentError):
        snippets.compare(said, printed)


def test_numbers_that_are_printed_now_are_written_into_a_page_and_words_are_not(tmp_path):
    page = tmp_path / "page.md"
    text = "A.\n\n```python\nprint('a = 2.50 um\\nmore\\nb = 7.00 +- 0.3 mm')\n```\n\n```text\n{}\n```\n\n2.4\n"
    page.write_text(text.format("a = 2.40 um\n...\nb = 7.01 +- 0.1 mm"))
    assert "expected\n  a = 2.40 um" in snippets.execute(page, tmp_path / "compared")
    assert snippets.execute(page, tmp_path / "run", accept=True) == ""
    assert page.read_text() == text.format("a = 2.50 um\n...\nb = 7.01 +- 0.1 mm")
    with pytest.raises(snippets.DifferentError):
        snippets.accepted("c = 2.40 um", "a = 2.40 um")


def test_a_row_with_a_new_number_is_written_in_the_columns_that_are_printed():
    said = "te [um]    1.205077     2.43"
    assert snippets.accepted(said, "te [um]     1.20348     2.43") == f"{said}\n"  # the same: it stays
    assert snippets.accepted(said, "te [um]     1.25348     2.44") == "te [um]     1.25348     2.43\n"


RUN = """```sh
printf 'a = 2.50 um\\nmore\\nNote: Pair I: 46 %% off; set corner_contact = true.\\nWrote it.\\n'
```
"""


@pytest.mark.parametrize(
    "said",
    ["", "\n```text\na = 2.50 um\n...\n```\n", "\n```text\n...\nNote: Pair I: ...\nWrote it.\n```\n"],
    ids=["no output shown", "elided with other lines", "elided in its line"],
)
def test_a_page_shows_every_note_of_its_runs_whole(said, tmp_path):
    page = tmp_path / "page.md"
    page.write_text(RUN + said)
    assert "Note: Pair I: 46 % off" in snippets.execute(page, tmp_path / "compared")
    assert snippets.execute(page, tmp_path / "put_in", accept=True) == ""
    assert "Note: Pair I: 46 % off; set corner_contact = true.\n" in page.read_text()
    assert snippets.execute(page, tmp_path / "compared") == ""


def test_numbers_of_the_prose_are_those_of_the_run(tmp_path):
    page = tmp_path / "page.md"
    summary = '{"results": {"I.te_mean": {"value": 17.04}}}'
    program = (
        "```python\nimport pathlib\nfolder = pathlib.Path('results/drive')\nfolder.mkdir(parents=True)\n"
        f"(folder / 'summary.json').write_text('{summary}')\nprint('up to 41.1 %')\nratio = 1 / 8\n```\n\n"
    )
    prose = "{}<!-- drive: I.te_mean --> um, {}<!-- = printed(r'up to ([.\\d]+) %') --> %, {}<!-- = 100 * ratio --> %\n"
    page.write_text(program + prose.format("17", "41", "12"))
    assert snippets.execute(page, tmp_path / "right") == ""
    page.write_text(program + prose.format("18", "41", "12"))
    assert "the prose has 18" in snippets.execute(page, tmp_path / "wrong")
    assert snippets.execute(page, tmp_path / "filled", accept=True) == ""
    assert page.read_text() == program + prose.format("17", "41", "12")
    page.write_text(program + "7<!-- drive: I.te_meen -->\n")
    assert "cannot be filled" in snippets.execute(page, tmp_path / "lost")


@pytest.mark.dear
def test_a_refusal_counts_only_where_the_page_shows_it(tmp_path):
    page = tmp_path / "page.md"
    command = "```sh\nfegear run missing.toml\n```\n"
    page.write_text(command)
    assert "ends with 2" in snippets.execute(page, tmp_path / "alone")
    page.write_text(f"{command}\n```text\nfegear: ...\n```\n")
    assert snippets.execute(page, tmp_path / "shown") == ""


@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="looks for processes in /proc")
def test_what_a_failing_page_leaves_running_ends_with_it(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("```sh\nsleep 600 > log 2>&1 &\necho $! > pid\nfalse\n```\n")
    assert "ends with 1" in snippets.execute(page, tmp_path / "run")
    left = Path("/proc") / (tmp_path / "run" / "pid").read_text().strip() / "cmdline"
    for _ in range(1200):
        if not left.exists() or not left.read_bytes():  # gone, or ended and not yet waited for
            break
        time.sleep(0.05)
    else:
        pytest.fail("the background process still runs")


@pytest.mark.dear
@pytest.mark.parametrize(
    "page",
    [pytest.param(page, id=page.stem, marks=[pytest.mark.long] if page.stem in COSTLY else []) for page in PAGES],
)
def test_a_page_does_what_it_says(page, tmp_path):
    assert snippets.execute(page, tmp_path / "run") == ""


#: Names that a page gives as an example, or that stand for one.
EXAMPLES = {"script.py", "fegear.NAME"}


@pytest.mark.parametrize("page", [*sorted(DOCS.rglob("*.md")), *sorted(ROOT.glob("*.md"))], ids=lambda page: page.stem)
def test_files_and_names_of_python_that_a_page_mentions_exist(page):
    text = page.read_text("utf-8")
    made = set(re.findall(r"^# ([\w.-]+\.py)", text, re.MULTILINE)) | EXAMPLES
    files = [*FILES, *("/".join(path.split("/")[1:]) for path in FILES)]
    named = set(re.findall(r"(?<![\w/.<>*-])((?:[\w.-]+/)*[\w-]+\.py)\b", text)) - made
    assert sorted(one for one in named if not any(f"/{path}".endswith(f"/{one}") for path in files)) == []
    dotted = set(re.findall(r"\bfegear(?:\.[A-Za-z_]\w*)+(?!\w*[/-])", text)) - made
    other = (".schema", ".schema.json", ".py", ".files", ".formats", ".importers")  # files, and groups of entry points
    dotted = {one for one in dotted if not one.endswith(other)}
    assert sorted(one for one in dotted if not _there(one)) == []


def _there(name):
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        try:
            found = importlib.import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        try:
            for part in parts[count:]:
                found = getattr(found, part)
        except AttributeError:
            return False
        return True
    return False


def test_the_everyday_tasks_take_at_most_six_lines():
    page = (DOCS / "how-to" / "python.md").read_text("utf-8")
    sections = re.findall(r"^## ([^\n]+)\n(.*?)(?=^## )", page, re.MULTILINE | re.DOTALL)
    tasks = {title: re.findall(r"```python\n(.*?)```", text, re.DOTALL) for title, text in sections[:5]}
    assert len(tasks) == 5
    for title, programs in tasks.items():
        assert [len(program.splitlines()) <= 6 for program in programs] == [True], title


def test_the_python_reference_has_every_name_of_the_top():
    import fegear

    page = (DOCS / "reference" / "top.md").read_text("utf-8")
    named = set(re.findall(r"^::: fegear\.(\w+)$", page, re.MULTILINE))
    assert set(fegear.__all__) - {"FegearError", "InputError", "__version__"} == named


def test_every_name_of_the_python_reference_exists_once():
    names = [
        n
        for page in (DOCS / "reference").glob("*.md")
        for n in re.findall(r"^::: (\S+)$", page.read_text("utf-8"), re.MULTILINE)
    ]
    assert len(names) == len(set(names))
    modules = [name.rpartition(".") for name in names]
    missing = [(m, n) for m, _, n in modules if not hasattr(importlib.import_module(m), n)]
    # a module is an attribute of its package only once somebody has imported it
    assert [f"{m}.{n}" for m, n in missing if importlib.util.find_spec(f"{m}.{n}") is None] == []


def test_the_python_page_names_every_result_and_functions_that_exist():
    """No result whose numbers a Python user could reach through its stage alone."""
    from fegear.results.catalogue import STAGES

    page = (DOCS / "how-to" / "python-mechanics.md").read_text("utf-8")
    rows = re.findall(r"^\| (`.+?) \| (.+) \|$", page, re.MULTILINE)
    listed = {name for row, _ in rows for name in re.findall(r"`([\w-]+)`", row)}
    missing = {name for stage in STAGES for name in stage.results} - {"gear-train"} - listed
    assert missing == set(), "say which functions make them in the table at the end of docs/how-to/python-mechanics.md"
    for _, functions in rows:
        package = ""
        for name in re.findall(r"`([\w.]+)`", functions):
            whole = name if name.startswith("fegear.") else f"fegear.{name}" if "." in name else f"{package}.{name}"
            package, _, last = whole.rpartition(".")
            try:
                importlib.import_module(whole)
            except ModuleNotFoundError:
                assert hasattr(importlib.import_module(package), last), whole


def test_a_page_runs_in_the_folder_that_is_named_and_in_no_other(tmp_path):
    """It ran where one stood, and a page's case was committed to the top of the tree twice."""
    page = tmp_path / "page.md"
    page.write_text("```sh\necho said > here.txt && cat here.txt\n```\n\n```text\nsaid\n```\n")
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter.tex").write_text("dear")
    for name, code in (("made", 0), ("made", 0), ("thesis", 1)):
        command = [sys.executable, str(DOCS / "snippets.py"), str(page), name]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60)
        assert done.returncode == code, done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["made", "page.md", "thesis"]
    assert (tmp_path / "made" / "here.txt").read_text() == "said\n"
    assert (tmp_path / "thesis" / "chapter.tex").exists()


def test_without_a_browser_the_page_of_the_window_says_that_it_has_no_film(monkeypatch):
    pytest.importorskip("mkdocs")
    monkeypatch.syspath_prepend(str(DOCS))
    spec = importlib.util.spec_from_file_location("docs_film", DOCS / "film.py")
    film = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(film)
    monkeypatch.delenv("FEGEAR_GALLERY", raising=False)
    monkeypatch.setattr(film.shutil, "which", lambda _program: None)
    files = SimpleNamespace(get_file_from_path=lambda _path: None)
    assert film.on_files(files, None) is files
    page = SimpleNamespace(file=SimpleNamespace(src_uri="how-to/window.md"))
    text = film.on_page_markdown((DOCS / "how-to" / "window.md").read_text("utf-8"), page, files=files)
    assert "has no film: chromium is not installed." in text
    shown = SimpleNamespace(get_file_from_path=lambda _path: "there")
    assert 'src="window_files/window.webp"' in film.on_page_markdown(
        text.replace("*", "") + film._LINE, page, files=shown
    )


@pytest.mark.dear
def test_a_case_of_the_gallery_that_does_not_run_says_why_and_others_have_run_beside_it(tmp_path, monkeypatch):
    """Two threads, as the site has them: each has the end of its own case."""
    monkeypatch.syspath_prepend(DOCS)
    case_run = importlib.import_module("case_run")
    (tmp_path / "drive.toml").write_text('results = ["geometry"]\n[gear.a]\nteeth = 30\nmodule = "2 mm"\n')
    (tmp_path / "wrong.toml").write_text('results = ["nonsense"]\n')
    names = ("drive", "wrong")
    with ThreadPoolExecutor(2) as pool:
        out = [tmp_path / f"{name}_{number}" for number, name in enumerate(names)]
        said = list(pool.map(case_run.run_case, [tmp_path / f"{name}.toml" for name in names], out))
    assert [bool(words) for words in said] == [False, True], said
    assert "nonsense" in said[1]
    assert (out[0] / "report.html").is_file()


def _called(page):
    """Dotted names that the programs of a page use, as far as they come from an import."""
    home, used = {}, set()
    for block in snippets.blocks(page):
        tree = ast.parse(block.text) if block.kind == "python" and not block.file else ast.Module([], [])
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                home |= {one.asname or one.name: f"{node.module}.{one.name}" for one in node.names}
            elif isinstance(node, ast.Import):
                home |= {one.name: one.name for one in node.names}
        for node in ast.walk(tree):
            if isinstance(node, (ast.Attribute, ast.Name)):
                first, _, rest = ast.unparse(node).partition(".")
                used.add(f"{home.get(first, '')}.{rest}".rstrip("."))
    return used


def _functions(name):
    """A documented function, or the public functions of a documented module, by dotted names."""
    parent, _, last = name.rpartition(".")
    try:
        found = importlib.import_module(name)
    except ModuleNotFoundError:
        return {name} if inspect.isfunction(getattr(importlib.import_module(parent), last)) else set()
    return {
        f"{name}.{key}" for key, one in vars(found).items()
        if inspect.isfunction(one) and one.__module__ == name and not key.startswith("_")
    }  # fmt: skip


@pytest.mark.parametrize("page", sorted((DOCS / "reference").glob("*.md")), ids=lambda page: page.stem)
def test_every_function_of_the_reference_stands_in_a_program_that_is_run(page):
    documented = re.findall(r"^::: (\S+)", page.read_text("utf-8"), re.MULTILINE)
    asked = set().union(*map(_functions, documented))
    assert sorted(asked - set().union(*map(_called, PAGES))) == []


def test_equations_are_numbered_page_by_page_and_can_be_linked_to():
    pytest.importorskip("mkdocs")
    markdown = pytest.importorskip("markdown")
    made = markdown.Markdown(extensions=[_hook("equations").Equations()])
    for _ in range(2):
        html = made.reset().convert("$$\na = b\n$$\n\ntext\n\n$$\nc = d\n$$\n")
        assert re.findall(r'id="equation-(\d+)"', html) == ["1", "2"]
        assert re.findall(r'href="#equation-(\d+)">\((\d+)\)<', html) == [("1", "1"), ("2", "2")]
