"""Hook of mkdocs: the pictures of the tutorial in the window, taken from the window itself as the page goes on.

Each picture of the page is the state after a step of `STEPS`; every value that the page names below it,
"`I.te_peak_to_peak` is 6.56 um", is held against what stands in the window then. Pictures are kept in
``results/film`` and taken anew when the page, the window or the program changes. Where there is no browser the page is
built without them. ``FEGEAR_GALLERY``, if set, has them taken only if it names ``tutorial-in-the-window``.
"""

from __future__ import annotations

import io
import logging
import re
import time
from base64 import b64decode
from pathlib import Path

from film import MADE, Camera, named, opened, why_not
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File
from shortened import chosen

from fegear.base.cache_keys import content_key
from fegear.base.code_version import code_version

DOCS = Path(__file__).resolve().parent
PAGE = DOCS / "tutorial-in-the-window.md"
FOLDER = MADE / "tutorial"
log = logging.getLogger("mkdocs.plugins.window_tutorial")
_SIZE = (1300, 900)
#: Seconds until the window has to show what the page says.
_PATIENCE = 60.0
_PICTURE = re.compile(r"^!\[[^\]]*\]\(tutorial-in-the-window_files/([\w-]+)\.png\)\n*", re.MULTILINE)
_VALUE = re.compile(r"`(\w+(?:\.\w+)+)` is (-?[\d.]+)")
_IDLE = "!document.body.classList.contains('computing')"
_VALUES = (
    "Object.fromEntries([...document.querySelectorAll('.values tr')].map(row => ["
    "row.querySelector('code')?.textContent, row.querySelector('td.number b')?.textContent]))"
)


class Session(Camera):
    """The window as somebody works with it."""

    def still(self) -> None:
        """Wait until all is computed and painted."""
        time.sleep(0.8)
        if not self.wait(_IDLE, 120.0):
            raise PluginError("the window of the tutorial does not come to rest")
        time.sleep(1.0)

    def tab(self, words: str) -> None:
        """Show form or text."""
        self.browser.click(f"[...document.querySelectorAll('.q-tab')].find(one => one.textContent === '{words}')")
        time.sleep(0.5)

    @property
    def text(self) -> str:
        """The case, in the text's tab."""
        self.tab("Text")
        self.wait("document.querySelector('textarea') !== null")
        return self.browser.run("document.querySelector('textarea').value")

    def write(self, text: str) -> None:
        """Put another text in its place."""
        self.tab("Text")
        self.browser.run("document.querySelector('textarea').select()")
        self.browser("Input.insertText", text=text)
        time.sleep(1.0)
        self.still()
        self.tab("Form")

    def see(self, element: str, above: float = 70) -> None:
        """Scroll the page so that an element stands below the bar."""
        self.scroll(f"document.querySelector({element!r})", above)
        time.sleep(1.2)

    def press(self, words: str) -> None:
        """Press a button."""
        self.browser.click(named(words))


def opening(at: Session) -> None:
    """The case of the drawing, as it is opened."""
    at.wait("document.querySelector('svg.mesh path') !== null", 60.0)


def loaded(at: Session) -> None:
    """The loaded pair with its three effects."""
    text = at.text.replace(
        'results = ["geometry"]', 'results = ["load-sharing", "transmission-error", "root-stress-history"]'
    )
    effects = 'neighbour_coupling = true\nhertz = "load-dependent"\ncorner_contact = true\n'
    at.write(f"{text}\n[effects]\n{effects}")
    at.browser.run("scrollTo(0, 0)")


def error(at: Session) -> None:
    """What the plain gears do."""
    at.press("All results")
    at.see('[data-task="transmission-error of I"]')


def dragged(at: Session) -> None:
    """A relief by hand on the pinion, its amount dragged."""
    at.press("At a glance")
    at.press("Add tip relief")
    point = "document.querySelector('[data-handle=\"pinion tip amount\"]')"
    at.wait(f"{point} !== null")
    at.still()
    x, y = at.middle(point)
    for kind, by in (("mousePressed", 0), ("mouseMoved", -15), ("mouseMoved", -45), ("mouseReleased", -45)):
        at.browser("Input.dispatchMouseEvent", type=kind, x=x, y=y + by, button="left", clickCount=1)
        time.sleep(0.3)
    at.still()


def ground(at: Session) -> None:
    """The nearest that can be ground."""
    at.press("Best grindable tip relief")
    at.wait("document.querySelector('#designed section') !== null", 120.0)
    at.press("All results")
    at.wait("document.querySelector('#designed .main-svg') !== null", 120.0)
    at.still()
    at.wait("document.querySelector('#compared .main-svg') !== null", 120.0)
    at.see("#designed")


def rounded(at: Session) -> None:
    """Amounts that a grinder reads, and all loads."""
    text = at.text
    for gear, amount, start in (("pinion", "11 um", "33.7 mm"), ("wheel", "20 um", "80.4 mm")):
        tip = f'relief = {{ tip = {{ amount = "{amount}", start_radius = "{start}" }} }}'
        text = re.sub(rf"(\[gear\.{gear}\][^\[]*?)relief = [^\n]*", rf"\1{tip}", text)
    at.write(text)
    at.see(".map")


def compared(at: Session) -> None:
    """A and B."""
    at.still()
    at.wait("document.querySelector('#compared .main-svg') !== null", 120.0)
    at.see('#compared figure[data-key*="transmission_error_I"]')


STEPS = (opening, loaded, error, dragged, ground, rounded, compared)


def parts(text: str) -> list[tuple[str, str]]:
    """Every picture's step with what the page says from it to the next one."""
    found = list(_PICTURE.finditer(text))
    ends = [one.start() for one in found[1:]] + [len(text)]
    return [(one[1], text[one.end() : end]) for one, end in zip(found, ends, strict=True)]


def held(said: str, values: dict[str, str]) -> list[str]:
    """What a part of the page says otherwise than the window."""
    wrong = []
    for name, number in _VALUE.findall(said):
        digits = len(number.partition(".")[2])
        there = values.get(name)
        if there is None or abs(float(there) - float(number.rstrip("."))) > 10.0**-digits + 4e-3 * abs(float(there)):
            wrong.append(f"{name} is {number} on the page, {there} in the window")
    return wrong


def take_all() -> None:
    """Go through the steps and take the pictures.

    Raises
    ------
    PluginError
        If a number on the page is not the one in the window, or a picture has no step.
    """
    from PIL import Image

    case = re.search(r"```toml\n# drive\.toml\n(.*?)```", (DOCS / "tutorial.md").read_text("utf-8"), re.DOTALL)
    told, steps = parts(PAGE.read_text("utf-8")), {step.__name__: step for step in STEPS}
    if [name for name, _ in told] != list(steps):
        raise PluginError(f"{PAGE.name} has the pictures {', '.join(n for n, _ in told)}, not {', '.join(steps)}")
    FOLDER.mkdir(parents=True, exist_ok=True)
    with opened(case[1], _SIZE) as browser:
        at = Session(browser)
        for name, said in told:
            steps[name](at)
            at.still()
            end = time.monotonic() + _PATIENCE
            while (wrong := held(said, browser.run(_VALUES))) and time.monotonic() < end:
                time.sleep(0.5)  # on a busy machine the window may not have begun to compute
            if wrong:
                raise PluginError(f"{PAGE.name}, below the picture {name}: {'; '.join(wrong)}")
            shot = b64decode(browser("Page.captureScreenshot", format="png")["data"])
            Image.open(io.BytesIO(shot)).convert("RGB").save(FOLDER / f"{name}.png", optimize=True)


def _wanted() -> bool:
    return chosen(PAGE.stem) and not why_not()


def make() -> None:
    """Take the pictures unless they are there, made by the same program."""
    stamp = FOLDER / "key"
    if not _wanted():
        return
    own = [Path(__file__), PAGE, DOCS / "tutorial.md", *sorted((DOCS.parent / "fegear" / "window").iterdir())]
    key = content_key(code_version(), {one.name: one.read_text("utf-8") for one in own if one.is_file()})
    if not (stamp.is_file() and stamp.read_text() == key):
        log.info("Going through the tutorial in the window")
        take_all()
        stamp.write_text(key)


def on_files(files, config):
    """Add the pictures to the site, which docs/made.py has had taken."""
    for step in STEPS if _wanted() else ():
        name = f"{step.__name__}.png"
        place = f"tutorial-in-the-window_files/{name}"
        files.append(File.generated(config, place, abs_src_path=str(FOLDER / name)))
    return files


def on_page_markdown(markdown, page, files, **_others):
    """Leave the pictures out where there are none."""
    first = f"tutorial-in-the-window_files/{STEPS[0].__name__}.png"
    if page.file.src_uri != PAGE.name or files.get_file_from_path(first) is not None:
        return markdown
    return _PICTURE.sub("", markdown)
