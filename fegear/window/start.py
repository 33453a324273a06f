"""What a case may begin with: templates, and the cases of the gallery."""

from __future__ import annotations

import tomllib
from typing import TYPE_CHECKING

from nicegui import ui

from fegear.case.text_file import named_path
from fegear.errors import FegearError
from fegear.window.bench import TEMPLATES, gallery
from fegear.window.desk import Desk
from fegear.window.journal import left_behind

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.window.bench import Bench
    from fegear.window.journal import Left


def _offer(name: str, about: str, chosen: Callable[[], None]) -> None:
    with ui.element("button").classes("offer").props("type=button").on("click", chosen):
        ui.html(name, tag="b")
        ui.html(about, tag="span")


def start_page(bench: Bench) -> None:
    """Offer templates, cases of the gallery, a file, and what was left behind unsaved."""

    def open_file() -> None:
        try:
            bench.from_file(named_path(path.value.strip(), "case", home=True))
        except FegearError as error:
            path.props["error"] = True
            path.props["error-message"] = str(error)
            path.update()

    def lay_left(left: Left) -> None:
        try:
            bench.lay(Desk.of_left(left))
        except FegearError as error:
            ui.notify(str(error), type="warning", multi_line=True)

    with ui.element("div").classes("start"):
        ui.html("fegear", tag="h1")
        unsaved = left_behind(None)
        if unsaved:
            ui.html("Left unsaved", tag="h2")
            with ui.element("div").classes("offers"):
                for left in unsaved:
                    about = f"not saved under a name, last changed {left.kept.when}"
                    _offer(left.kept.name, about, lambda left=left: lay_left(left))  # type: ignore[misc]
        ui.html("Begin with a template", tag="h2")
        with ui.element("div").classes("offers"):
            for kind, about in TEMPLATES.items():
                _offer(kind, about, lambda kind=kind: bench.from_template(kind))  # type: ignore[misc]
        cases = gallery()
        if cases:
            ui.html("Or with a copy of a case of the gallery", tag="h2")
            with ui.element("div").classes("offers"):
                for name, file in cases.items():
                    title = str(tomllib.loads(file.read_text("utf-8")).get("title", ""))
                    _offer(name, title, lambda name=name: bench.from_gallery(name))  # type: ignore[misc]
        ui.html("Or open a case file", tag="h2")
        with ui.row().classes("items-start w-full"):
            path = (
                ui.input("Path of a case file (TOML)")
                .props("outlined dense hide-bottom-space")
                .style("min-width: 26rem")
            )
            path.on("keydown.enter", open_file)
            ui.button("Open", on_click=open_file).props("outline no-caps")
