"""Hook of mkdocs: the short film of the window on its page, taken from the window itself in Debian's chromium.

The film is kept in ``results/film`` and taken anew when the window or the program changes. Where chromium or NiceGUI is
missing the site is built without it, and the page says so. ``FEGEAR_GALLERY``, if set, takes it only if it names
``window``.

``python docs/film.py docs/images/window.webp`` takes the part of it that stands in the README.
"""

from __future__ import annotations

import importlib.util
import io
import logging
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File
from shortened import chosen

from fegear.base.cache_keys import content_key
from fegear.base.code_version import code_version

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

ROOT = Path(__file__).resolve().parents[1]
MADE = ROOT / "results" / "film"
log = logging.getLogger("mkdocs.plugins.film")
#: The page, and the line of it that becomes the film.
_PAGE = "how-to/window.md"
_LINE = "The site that `./docs.sh` builds has a short film here."
_ABOUT = (
    "A pair of gears in the window: stress inside the teeth while they turn, teeth deformed, the case pinned as A and "
    "a tip relief dragged until the transmission error is even, the load moved; all pictures follow."
)
#: Size of the page as it is filmed, and width of the film [pixels].
_PAGE_SIZE, _WIDTH = (1300, 800), 1040
_CASE = """title = "Tip relief by hand"
results = ["transmission-error", "load-sharing", "root-stress-history"]

[gear.test]
teeth = 28
diametral_pitch = "8 / inch"
pressure_angle = "20 deg"
rack = { addendum = 1.0, dedendum = 1.25, tip_radius = 0.25 }
tip_radius_rounding = "0.381 mm"
bore_radius = "20.240625 mm"
face_width = "6.35 mm"

[pair.I]
driver = "test"
driven = "test"
load = "1615 N"

[effects]
neighbour_coupling = true
hertz = "load-dependent"
"""
#: The pointer and the words in the corner, which a picture of a page does not have of itself.
_OVERLAY = """
document.body.insertAdjacentHTML('beforeend', `
  <svg id="film-pointer" viewBox="0 0 24 24" width="34" height="34">
    <path d="M3 1l16 13h-8l4.500 8-3.500 1.500-4-8-5 5z" fill="#111" stroke="#fff" stroke-width="1.500"/></svg>
  <div id="film-words"></div>
  <style>
    #film-pointer, #film-words { position: fixed; z-index: 99; pointer-events: none; }
    #film-words { left: 22px; bottom: 84px; width: 280px; background: #14202ce8; color: #fff; padding: .8rem 1.2rem;
      font-size: 1.200rem; line-height: 1.350; border-radius: .6rem; white-space: pre-line; }
  </style>`);
"""
_IDLE = "!document.body.classList.contains('computing')"
_ERROR = "document.querySelector('figure[data-picture=te]')"
_PEAK_TO_PEAK = "document.querySelector('[data-number=te_peak_to_peak] b').textContent"


def why_not() -> str:
    """Why no film can be taken here; empty if it can."""
    if _chromium() is None:
        return "chromium is not installed"
    if importlib.util.find_spec("nicegui") is None:
        return "NiceGUI is not installed (pip install 'fegear[workbench]')"
    return ""


def _chromium() -> str | None:
    return shutil.which("chromium") or shutil.which("chromium-browser")


class Camera:
    """A page that is acted upon and photographed.

    Parameters
    ----------
    browser : Browser
        Of tests/cases/chromium.py.
    """

    def __init__(self, browser):
        self.browser, self.frames, self.seconds, self._at = browser, [], [], (0.0, 0.0)

    def shoot(self, seconds: float) -> None:
        """Take a frame that stands for so long."""
        from base64 import b64decode

        from PIL import Image

        shot = self.browser("Page.captureScreenshot", format="png", optimizeForSpeed=True)["data"]
        frame = Image.open(io.BytesIO(b64decode(shot))).convert("RGB")
        height = round(frame.height * _WIDTH / frame.width)
        self.frames.append(frame.resize((_WIDTH, height), Image.Resampling.LANCZOS))
        self.seconds.append(seconds)

    def say(self, words: str) -> None:
        """Change the words below."""
        self.browser.run(f"document.getElementById('film-words').textContent = {words!r}")

    def wait(self, script: str, patience: float = 60.0) -> bool:
        """Until something is so; whether it became so."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            if self.browser.run(script):
                return True
            time.sleep(0.03)
        return False

    def scroll(self, element: str, above: float) -> None:
        """Have an element so far below the top edge."""
        self.browser.run(f"scrollBy({{top: ({element}).getBoundingClientRect().y - {above}, behavior: 'instant'}})")
        time.sleep(0.4)  # figures out of sight are painted as they come near

    def point(self, place: tuple[float, float], pressed: bool = False) -> None:
        """Bring the pointer to a place."""
        x, y = self._at = place
        self.browser.run(
            f"Object.assign(document.getElementById('film-pointer').style, {{left: '{x}px', top: '{y}px'}})"
        )
        self.browser(
            "Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, button="left" if pressed else "none",
            buttons=int(pressed),
        )  # fmt: skip

    def middle(self, element: str) -> tuple[float, float]:
        """Where an element is."""
        x, y = self.browser.run(f"(b => [b.x + b.width / 2, b.y + b.height / 2])(({element}).getBoundingClientRect())")
        return x, y

    def go(self, place: tuple[float, float], steps: int = 4) -> None:
        """Move the pointer, seen."""
        start = self._at
        for i in range(1, steps + 1):
            self.point(tuple(a + (b - a) * i / steps for a, b in zip(start, place, strict=True)))
            self.shoot(0.09)

    def button(self, down: bool) -> None:
        """Press or let go of the mouse."""
        x, y = self._at
        kind = "mousePressed" if down else "mouseReleased"
        self.browser("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def click(self, element: str) -> None:
        """Go to an element and click it."""
        self.go(self.middle(element))
        self.point(self.middle(element))  # where it is by now
        self.button(True)
        self.button(False)

    def drag(self, element: str, lower: list[float], words: str) -> None:
        """Drag an element up and down; a frame for every step, once the transmission error has followed."""
        self.go(self.middle(element))
        self.button(True)
        x, y = self._at
        for by in lower:
            before = self.browser.run(f"{_ERROR}.dataset.count")
            self.point((x, y + by), pressed=True)
            self.wait(f"{_ERROR}.dataset.count !== '{before}'", 1.5)
            self.say(f"{words}\npeak to peak {self.browser.run(_PEAK_TO_PEAK)}")
            self.shoot(0.13)
        self.button(False)

    def save(self, path: Path) -> None:
        """Write the film."""
        path.parent.mkdir(parents=True, exist_ok=True)
        self.frames[0].save(
            path, "WEBP", save_all=True, append_images=self.frames[1:], loop=0, quality=62, method=4, allow_mixed=True,
            duration=[round(seconds * 1000) for seconds in self.seconds],
        )  # fmt: skip


def named(words: str) -> str:
    """The button with some words, for a script."""
    return f"[...document.querySelectorAll('button')].find(one => one.textContent.trim() === '{words}')"


def ready(camera: Camera) -> None:
    """Wait until everything is drawn; the pointer and the words in the corner appear."""
    camera.wait(f"{_IDLE} && {_ERROR}?.querySelector('.small-plot path') != null")
    camera.wait("document.querySelector('.mesh-scales').textContent.includes('von Mises')")
    time.sleep(0.5)
    camera.browser.run(_OVERLAY)


def dragged(camera: Camera) -> None:
    """A tip relief is dragged while the case without it is pinned."""
    words = "Pinned as A; a tip relief, dragged: everything follows"
    camera.say(words)
    camera.click(named("Pin as A"))
    camera.wait(f"{named('Unpin A')} !== undefined")
    camera.click(named("Add tip relief"))
    point = "document.querySelector('[data-handle=\"test tip amount\"]')"
    camera.wait(f"{point} !== null && {_IDLE}")
    camera.shoot(0.5)
    camera.drag(point, [-9.0 * i for i in range(1, 8)] + [-63.0 + 7.0 * i for i in range(1, 6)], words)
    camera.wait(_IDLE)
    camera.shoot(1.8)


def act(camera: Camera) -> None:
    """What is seen: everything is done with the mouse."""
    browser = camera.browser
    camera.say("fegear open drive.toml")
    camera.point((880.0, 700.0))
    camera.shoot(1.6)

    camera.say("Stress inside the teeth, over the path of contact")
    scrub = "document.querySelector('.mesh-tools input[type=range]')"
    for i in range(24):
        browser.run(f"(one => {{ one.value = {1000 * i / 24}; one.oninput(); }})({scrub})")
        time.sleep(0.06)
        camera.shoot(0.11)
    camera.say("Teeth deformed")
    camera.click(named("Deformed"))
    camera.wait(f"{_IDLE} && document.querySelector('.mesh-told').textContent.includes('times as large')")
    for i in range(0, 24, 3):
        browser.run(f"(one => {{ one.value = {1000 * i / 24}; one.oninput(); }})({scrub})")
        time.sleep(0.06)
        camera.shoot(0.13)
    camera.click(named("Deformed"))

    dragged(camera)

    camera.say("The load, moved")
    slider = "document.querySelector('[data-slider]')"
    camera.go(camera.middle(slider))
    for percent in (*range(96, 44, -8), *range(52, 104, 8)):
        browser.run(
            f"(one => {{ one.value = {percent}; one.oninput(); const box = one.getBoundingClientRect();"
            "document.getElementById('film-pointer').style.left = "
            f"`${{box.x + 8 + (box.width - 16) * {percent - 2} / 198}}px`; }})({slider})"
        )
        time.sleep(0.25)
        camera.shoot(0.13)
    browser.run(f"{slider}.onchange()")
    camera.wait(_IDLE)
    camera.shoot(2.0)


@contextmanager
def opened(text: str, size: tuple[int, int]) -> Iterator:
    """The window with a case, in a process of its own, and a browser that shows it.

    Raises
    ------
    PluginError
        If it does not come up.
    """
    spec = importlib.util.spec_from_file_location("chromium", ROOT / "tests" / "cases" / "chromium.py")
    chromium = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(chromium)
    with tempfile.TemporaryDirectory(prefix="fegear-film-") as folder:
        case = Path(folder, "drive.toml")
        case.write_text(text, "utf-8")
        window = subprocess.Popen(
            [sys.executable, "-m", "fegear", "open", "--no-browser", str(case)], stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL, text=True, env=os.environ | {"FEGEAR_STATE": folder, "PYTHONUNBUFFERED": "1"},
        )  # fmt: skip
        try:
            address = window.stdout.readline().split()[-1:]
            if not address:
                raise PluginError("the window of the film does not come up")
            with chromium.Browser(_chromium(), *size) as browser:
                browser("Page.navigate", url=address[0])
                browser.until("document.documentElement?.dataset.ready !== undefined")
                yield browser
        finally:
            window.send_signal(signal.SIGTERM)
            window.stdout.close()
            window.wait(20)


def take(path: Path, played: Callable[[Camera], None] = act) -> None:
    """Open the window in a process of its own and film it."""
    with opened(_CASE, _PAGE_SIZE) as browser:
        camera = Camera(browser)
        ready(camera)
        played(camera)
        camera.save(path)


def _wanted() -> bool:
    return chosen("window") and not why_not()


def make() -> None:
    """Take the film unless it is there, made by the same program."""
    film, stamp = MADE / "window.webp", MADE / "window.key"
    if not _wanted():
        if reason := why_not():
            log.info("The site has no film of the window: %s", reason)
        return
    own = [Path(__file__), *sorted((ROOT / "fegear" / "window").iterdir())]
    key = content_key(code_version(), {one.name: one.read_text("utf-8") for one in own if one.is_file()})
    if not (film.is_file() and stamp.is_file() and stamp.read_text() == key):
        log.info("Filming the window")
        take(film)
        stamp.write_text(key)


def on_files(files, config):
    """Add the film to the site, which docs/made.py has had taken."""
    if _wanted():
        place = "how-to/window_files/window.webp"
        files.append(File.generated(config, place, abs_src_path=str(MADE / "window.webp")))
    return files


def on_page_markdown(markdown, page, files, **_others):
    """Put the film where its page has a line for it, or say why there is none."""
    if page.file.src_uri != _PAGE:
        return markdown
    if files.get_file_from_path("how-to/window_files/window.webp") is None:
        return markdown.replace(_LINE, f"*This build of the site has no film: {why_not() or 'none was asked for'}.*")
    picture = f'<img src="window_files/window.webp" alt="{_ABOUT}" width="{_WIDTH}" loading="lazy">'
    return markdown.replace(_LINE, f"<details open><summary>Film</summary>{picture}</details>")


if __name__ == "__main__":
    take(Path(sys.argv[1]), dragged)
