"""The page that one begins with: jobs with their pictures, a file, and what was left behind unsaved."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from nicegui import ui

from fegear.base.errors import FegearError
from fegear.case.text_file import named_path
from fegear.window.beginnings import JOBS, examples, picture, templates_of
from fegear.window.journal import left_behind

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.window.beginnings import Job
    from fegear.window.bench import Bench
    from fegear.window.journal import Left


def _offer(name: str, about: str, chosen: Callable[[], None]) -> None:
    with ui.element("button").classes("offer").props(f"type=button title={json.dumps(about)}").on("click", chosen):
        if name:
            ui.html(name, tag="b")
        ui.html(about, tag="span")


def start_page(bench: Bench) -> None:
    """Offer jobs with templates and cases of the gallery, a file, and what was left behind unsaved."""

    def open_file() -> None:
        try:
            bench.from_file(named_path(path.value.strip(), "case", home=True))
        except FegearError as error:
            path.props["error"] = True
            path.props["error-message"] = str(error)
            path.update()

    def lay_left(left: Left) -> None:
        try:
            bench.from_left(left)
        except FegearError as error:
            ui.notify(str(error), type="warning", multi_line=True)

    with ui.element("div").classes("start"):
        ui.html("fegear", tag="h1")
        unsaved = left_behind(None)
        if unsaved:
            ui.html("Unsaved cases", tag="h2")
            with ui.element("div").classes("offers"):
                for left in unsaved:
                    about = f"unsaved, last changed {left.kept.when}"
                    _offer(left.kept.name, about, lambda left=left: lay_left(left))  # type: ignore[misc]  # mypy cannot infer a lambda with a default
        ui.html("What do you want to do?", tag="h2")
        of_gallery = examples()
        with ui.element("div").classes("jobs"):
            for name, job in JOBS.items():
                _job(bench, name, job, of_gallery[name])
        ui.html("Open a case file", tag="h2")
        with ui.row().classes("items-start w-full"):
            path = (
                ui.input("Path of a case file (TOML)")
                .props("outlined dense hide-bottom-space")
                .style("min-width: 26rem")
            )
            path.on("keydown.enter", open_file)
            ui.button("Open", on_click=open_file).props("outline no-caps")


def _job(bench: Bench, name: str, job: Job, cases: tuple[tuple[str, str], ...]) -> None:
    """One job: its picture, its templates, and example cases, folded."""
    with ui.element("section").classes("job"):
        ui.html(picture(name), sanitize=False)
        ui.html(job.title, tag="h3")
        ui.html(job.about, tag="p").classes("about")
        for kind, about in templates_of(name):
            _offer(kind, about, lambda kind=kind: bench.from_template(kind))  # type: ignore[misc]  # mypy cannot infer a lambda with a default
        if cases:
            with ui.element("details"):
                count = f"{len(cases)} examples" if len(cases) > 1 else "1 example"
                ui.html(count, tag="summary")
                for case, title in cases:
                    _offer("", title, lambda case=case: bench.from_gallery(case))  # type: ignore[misc]  # mypy cannot infer a lambda with a default
