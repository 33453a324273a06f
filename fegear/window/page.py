"""The page: what is changed on the left, what follows from it on the right."""

from __future__ import annotations

import asyncio
import json
import tomllib
from functools import partial
from importlib import resources
from typing import TYPE_CHECKING, Any

from nicegui import app, ui
from starlette.responses import Response

from fegear.base.errors import FegearError
from fegear.output.draw_plotly.layout import template
from fegear.output.report.page import plotly_file
from fegear.window.access import LOOKS
from fegear.window.bar import Bar
from fegear.window.crack_handle import moved_crack
from fegear.window.document import LARGEST
from fegear.window.first_drawing import first_drawing
from fegear.window.glance import told_of_view
from fegear.window.inputs import Inputs
from fegear.window.messages import PIECE, TOO_LONG, Messages, checked, refuse
from fegear.window.start_page import start_page

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.window.bench import Bench


#: What bar and form hear; each change of theirs has the browser go through the whole form.
_OF_THE_FORM = frozenset({"laid", "pinned", "unpinned", "refused", "exported", "designed", "failed", "kept"})


#: What the page's scripts have no use for.
_NOT_OF_THE_PAGE = frozenset({"changed", "kept"})


#: A value that has not moved for so long stands still [s].
_STILL = 0.4


#: Its own scripts, in their order.
_SCRIPTS = (
    "pieces",
    "packed",
    "moved",
    "window",
    "layers",
    "flanks",
    "field",
    "plots",
    "exercise",
    "glance",
    "middle",
    "circles",
    "gears",
    "saved",
    "crack",
    "sets",
    "gearbox",
    "hands",
    "scrub",
    "look",
)


#: Where the page's own files are served, its scripts as one: each request costs what fifteen of them would.
_AT, _ALL = "/fegear", "scripts.js"


def _serve_files(bench: Bench) -> None:
    """Offer plotly.js and the files of this package and of the report to the page, and hear what pages say."""
    if any(getattr(route, "path", "").startswith(f"{_AT}/plotly") for route in app.routes):
        return
    messages = Messages()
    messages.install()
    app.on_shutdown(messages.end)
    app.on_shutdown(bench.end)  # keeps what these have changed
    own, report = resources.files("fegear.window"), resources.files("fegear.output.report")
    app.add_static_file(local_file=str(plotly_file()), url_path=f"{_AT}/plotly.js")
    for folder, name in ((report, "page.css"), (own, "window.css")):
        app.add_static_file(local_file=str(folder / name), url_path=f"{_AT}/{name}", max_cache_age=0)
    files = (report / "figure.js", *(own / f"{script}.js" for script in _SCRIPTS))
    scripts = "\n".join(file.read_text("utf-8") for file in files).encode()
    # A browser that kept an old script would show a page that half works.
    app.add_api_route(
        f"{_AT}/{_ALL}",
        lambda: Response(scripts, media_type="text/javascript", headers={"cache-control": "public, max-age=0"}),
    )


class Page:
    """One open page.

    Parameters
    ----------
    bench : Bench
    looks : bool
        Whether it is of somebody who only looks on.
    """

    def __init__(self, bench: Bench, *, looks: bool = False) -> None:
        self._bench = bench
        self._client = ui.context.client
        self._looks = looks
        with ui.element("div").classes("window").style("width: 100%") as self._root:
            pass
        self._bar: Bar | None = None
        self._inputs: Inputs | None = None
        self._soon: asyncio.TimerHandle | None = None
        self._unsent: list[tuple[str, dict[str, Any]]] = []
        for kind, do in (
            ("relief", bench.move_relief), ("load", bench.move_load), ("drop", bench.drop_relief),
            ("crack", self._move_crack), ("name_driven", bench.name_driven), ("design", bench.design),
            ("shows", bench.show), ("sight", bench.see), ("value", self._move_value),
        ):  # fmt: skip
            ui.on(kind, partial(self._said, kind, do))
        ui.on("untaken", self._too_long)
        ui.on("unwritten", lambda: refuse(self._client, TOO_LONG))
        ui.on("stop", bench.stop)
        ui.on("compute", lambda: bench.compute())
        ui.on("save", lambda: self._bar.save() if self._bar is not None else None)
        ui.on("view", lambda event: bench.see_otherwise(event.args if isinstance(event.args, dict) else {}))
        parts = json.dumps({"piece": PIECE, "most": LARGEST})
        self._client.run_javascript(f"fegearPieces.begin({parts})")
        self._client.run_javascript(f"fegear.begin({json.dumps(template())}, {_AT + '/plotly.js'!r})")
        if self._looks:
            self._client.run_javascript("fegearLook.begin()")
        self._client.on_delete(bench.listen(self._hear))
        self._client.on_delete(self._forget)
        self._lay()

    def _lay(self) -> None:
        """Show the case on the desk, or what one may begin with."""
        self._root.clear()
        self._bar = self._inputs = None
        with self._root:
            if self._bench.desk is None and self._looks:
                ui.label("No case is open.").classes("told")
                return
            if self._bench.desk is None:
                start_page(self._bench)
                return
            self._bar = Bar(self._bench)
            with ui.element("div").classes("bench").props("id=bench"):
                with ui.element("div").classes("inputs").props('role=region aria-label="Case"'):
                    self._inputs = Inputs(self._bench)
                with ui.element("main").classes("outputs").props('aria-label="Results"'):
                    with ui.element("section").props('id=question hidden aria-label="Exercise"'):
                        ui.element("div").props("id=asked")  # the page writes it
                        ui.element("button").classes("button").props("type=button id=to-answers")
                    with ui.element("div").props("id=glance"):
                        ui.element("div").props("id=hands")
                        ui.element("div").props('id=small role=region aria-label="Thumbnails"')
                        ui.element("div").props('id=strip role=region aria-label="Numbers"')
                        ui.element("ul").props('id=answer aria-label="Answer"')
                    with ui.element("div").props("id=report"):
                        for name in ("remarks", "maps", "designed", "compared", "results"):
                            ui.element("ul" if name == "remarks" else "div").props(f"id={name}")
        self._client.run_javascript(f"fegearGlance.begin({json.dumps(told_of_view(self._bench.view))})")
        for what, content in self._bench.shown_now():
            self._send(what, content)
            if what == "done":
                self._inputs.hear(what, content)

    def _said(self, kind: str, do: Callable[..., None], event: Any) -> None:
        """Do what a page says, with the parts that it says it with."""
        self._by_hand(lambda: do(**checked(kind, event.args)))

    def _move_value(self, field: str, text: str, *, moving: bool) -> None:
        if self._inputs is not None:
            self._inputs.move(field, text, moving=moving)

    def _move_crack(self, gear: str, place: int, depth: float, angle: float, *, moving: bool) -> None:
        desk = self._bench.desk
        if desk is not None:
            self._bench.put(moved_crack(desk, gear, place, depth, angle), moving=moving)

    def _too_long(self) -> None:
        if self._inputs is not None:
            self._inputs.leave_too_long()

    @staticmethod
    def _by_hand(do: Callable[[], None]) -> None:
        """Change the case as the hand on the page says; what cannot be changed so is reported."""
        try:
            do()
        except FegearError as error:
            ui.notify(str(error), type="warning", multi_line=True)
        except tomllib.TOMLDecodeError as error:
            ui.notify(f"The case is not valid TOML: {error}. Correct the text first.", type="warning", multi_line=True)

    def _hear(self, what: str, content: dict[str, Any]) -> None:
        if what == "changed":
            self._later(content)
        elif what in _OF_THE_FORM or (what == "done" and not content["moving"]):
            self._tell_form(what, content)
        if what != "laid" and what not in _NOT_OF_THE_PAGE:
            self._send(what, content)

    def _forget(self) -> None:
        if self._soon is not None:
            self._soon.cancel()
            self._soon = None

    def _later(self, content: dict[str, Any]) -> None:
        """Show the changed case in the form: while a value moves not before it stands still, for it takes long."""
        self._forget()
        if content.get("moving"):
            self._soon = asyncio.get_running_loop().call_later(_STILL, self._tell_form, "changed", content)
        else:
            self._tell_form("changed", content)

    def _tell_form(self, what: str, content: dict[str, Any]) -> None:
        with self._root:
            if what == "laid":
                self._send(what, {})
                self._lay()
                return
            if self._bar is not None:
                self._bar.hear(what, content)
            if self._inputs is not None:
                self._inputs.hear(what, content)

    def _send(self, what: str, content: dict[str, Any]) -> None:
        # What comes at once travels together: every message costs both sides more than what it holds.
        if not self._unsent:
            asyncio.get_running_loop().call_soon(self._send_all)
        self._unsent.append((what, content))

    def _send_all(self) -> None:
        told, self._unsent = json.dumps(self._unsent), []
        if not self._client.is_deleted:
            self._client.run_javascript(f"fegear.hearAll({told})")


def _title(bench: Bench) -> str:
    """Of the case on the desk, or its name."""
    desk = bench.desk
    return "" if desk is None else (desk.scene.case.title if desk.scene is not None else "") or desk.name


def show(bench: Bench) -> None:
    """Build the page for who has just opened it."""
    _serve_files(bench)
    for name in ("page.css", "window.css"):
        ui.add_head_html(f'<link rel="stylesheet" href="{_AT}/{name}">')
    ui.add_head_html(f'<script defer src="{_AT}/{_ALL}"></script>')
    hands = dict(bench.shown_now()).get("hands")
    if hands is not None:
        ui.add_body_html(first_drawing(hands["pairs"], bench.view, _title(bench)))
    Page(bench, looks=bool(ui.context.client.request.scope.get(LOOKS)))
