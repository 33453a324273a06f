"""The bar at the head of the page: the case's name, undo and redo, saving, accuracy, variants, what is going on."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nicegui import ui

from fegear.base.errors import FegearError, InputError
from fegear.case.text_file import named_path
from fegear.output.export_formats import formats
from fegear.output.folder import default_folder
from fegear.window.bench import LEVELS
from fegear.window.document import OverwriteError

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.window.bench import Bench
    from fegear.window.document import Desk


#: What can be written of a run: words of the menu, the job's name for it, ending of the folder that is offered.
_OF_RUN = (("Report, tables, figures", "report", ""), ("Tables only (CSV)", "tables", "_tables"))


def exports() -> tuple[tuple[str, str, str], ...]:
    """All that can be written: what a run leaves, then the formats of ``fegear export``."""
    of_formats = ((f"{name}: {row.about}", name, f"_{name}") for name, row in formats().items())
    return (*_OF_RUN, *of_formats)


#: What the bar says of a text that takes a while to be judged.
_CHECKED = "Checking the text ..."


def in_words(do: Callable[[], object]) -> None:
    """Do what was asked for; what is refused is said on the page."""
    try:
        do()
    except FegearError as error:
        ui.notify(str(error), type="warning", multi_line=True)


class Bar:
    """The bar of one page."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        with ui.element("div").classes("headbar").props('role=toolbar aria-label="Case"'):
            self._name = ui.label().classes("name")
            self._unsaved = ui.label().classes("unsaved")
            self._undo = self._button("Undo", lambda: self._step("undo"))
            self._redo = self._button("Redo", lambda: self._step("redo"))
            self._button("Save", self._save)
            self._button("Save as", lambda: self._ask_path("Save as", self._own_path(), self._save_as))
            self._give_up = self._button("Discard changes", self._give_up_changes)
            with ui.button("Export").props("flat dense no-caps"), ui.menu():
                ui.menu_item("Case (TOML), current state", lambda: in_words(self._download))
                ui.menu_item("Gears in mesh as shown (SVG)", lambda: in_words(self._save_gears))
                for words, what, ending in exports():
                    ui.menu_item(words, partial(in_words, partial(self._ask_folder, what, ending)))
            self._pin = self._button("Pin as A", self._pin_or_not)
            self._button("Other case", lambda: bench.lay(None))
            self._level = ui.toggle(list(LEVELS), value=bench.level, on_change=self._level_chosen)
            self._level.props('dense no-caps unelevated toggle-text-color=paper aria-label="Accuracy against time"')
            for name in ("to-report", "to-fold"):  # the page names them and answers them
                ui.element("button").classes("button").props(f"type=button id={name}")
            with ui.element("details").classes("views"):
                ui.html("View", tag="summary").classes("button")
                with ui.element("div"):
                    for name in ("to-large", "to-digits", "to-exercise"):
                        ui.element("button").classes("button").props(f"type=button id={name}")
            ui.element("button").classes("button").props("type=button id=stop hidden")
            ui.element("div").classes("state").props("role=status id=state")  # the page writes it: it changes often
        self._told = ui.label().classes("told")
        self.refresh()

    @staticmethod
    def _button(text: str, pressed: Callable[[], object]) -> ui.button:
        return ui.button(text, on_click=lambda: in_words(pressed)).props("flat dense no-caps")

    @property
    def _desk(self) -> Desk:
        desk = self._bench.desk
        if desk is None:
            raise InputError("case", "(none)", "is no longer open", "choose a template or a case")
        return desk

    def refresh(self) -> None:
        """Show the state of the desk."""
        desk = self._bench.desk
        if desk is None:
            return
        self._name.set_text(desk.name)
        self._unsaved.set_text(
            "has no file yet" if desk.path is None else "changed, not saved" if desk.changed else "saved"
        )
        self._undo.set_enabled(desk.can_undo)
        self._redo.set_enabled(desk.can_redo)
        self._give_up.set_visibility(desk.path is not None and desk.changed)
        self._pin.set_text("Unpin A" if self._bench.pinned else "Pin as A")
        self._told.set_text(desk.trouble or (_CHECKED if desk.pending else "") or desk.restored)

    def hear(self, what: str, content: dict[str, Any]) -> None:
        """Follow what goes on."""
        if what in ("changed", "kept", "pinned", "unpinned"):
            self.refresh()
            self._level.set_value(self._bench.level)
        elif what == "designed":
            ui.notify(content["told"], type="positive", multi_line=True, timeout=10_000)
        elif what == "failed":
            ui.notify(content["sentence"], type="warning", multi_line=True, timeout=10_000)
        elif what == "exported":
            ui.notify("\n".join([f"Wrote {content['target']}", *content["remarks"]]), type="positive", multi_line=True)

    def _step(self, way: str) -> None:
        getattr(self._desk, way)()
        self._bench.changed()

    def _level_chosen(self, event: Any) -> None:
        if event.value not in LEVELS:
            self._level.set_value(self._bench.level)
        elif event.value != self._bench.level:
            self._bench.level = event.value
            self._bench.changed()

    def _give_up_changes(self) -> None:
        try:
            self._desk.give_up()
        except FegearError as error:
            ui.notify(str(error), type="warning", multi_line=True)
        self._bench.changed()

    def _pin_or_not(self) -> None:
        if self._bench.pinned:
            self._bench.unpin()
        elif self._desk.refusal is None:
            self._bench.pin()
        else:
            ui.notify(str(self._desk.refusal), type="warning")

    # ---- files ---------------------------------------------------------------------------------------------------

    def save(self) -> None:
        """Save the case, or ask for a name."""
        in_words(self._save)

    def _save(self) -> None:
        desk = self._desk
        if desk.path is None:
            self._ask_path("Save as", self._own_path(), self._save_as)
            return
        try:
            desk.save()
        except OverwriteError as error:
            self._confirm(str(error), "Overwrite", partial(self._save_over, desk))
            return
        self._saved()

    def _save_over(self, desk: Desk) -> None:
        desk.save(over_others=True)
        self._saved()

    def _saved(self) -> None:
        ui.notify(f"Saved {self._desk.path}", type="positive")
        self._bench.changed()

    def _save_as(self, text: str, *, replace: bool = False) -> None:
        path = named_path(text, "case", home=True)
        try:
            self._desk.save_as(path, replace=replace)
        except OverwriteError as error:
            self._confirm(str(error), "Overwrite", partial(self._save_as, text, replace=True))
            return
        self._saved()

    def _own_path(self) -> str:
        desk = self._desk
        return str(desk.path or Path.cwd() / f"{desk.name}.toml")

    def _download(self) -> None:
        """Hand the text to the browser, whether or not it can be read or has a file."""
        ui.download.content(self._desk.text.encode(), f"{self._desk.name}.toml", "application/toml")

    def _save_gears(self) -> None:
        """Have the page save its drawing, with what is switched on; a page without one says so."""
        none = "document.getElementById('state').textContent = 'no gears in mesh are shown'"
        ui.run_javascript(f"fegearSaved.gears({json.dumps(self._desk.name)}) || ({none})")

    def _ask_folder(self, what: str, ending: str) -> None:
        def chosen(text: str) -> None:
            self._bench.export(what, str(named_path(text, "folder", home=True)))
            ui.notify("Writing ...")

        self._ask_path("Folder to write into", str(default_folder(self._desk.name, ending).resolve()), chosen)

    @staticmethod
    def _ask_path(title: str, value: str, chosen: Callable[[str], None]) -> None:
        def take() -> None:
            try:
                chosen(path.value.strip())
            except FegearError as error:
                path.props["error"], path.props["error-message"] = True, str(error)
                path.update()
            else:
                dialog.close()

        with ui.dialog(value=True) as dialog, ui.card().style("min-width: min(40rem, 90vw)"):
            path = (
                ui.input(title, value=value).props("outlined autofocus").style("width: 100%").on("keydown.enter", take)
            )
            with ui.row():
                ui.button("OK", on_click=take).props("no-caps unelevated")
                ui.button("Cancel", on_click=dialog.close).props("flat no-caps")
        dialog.on("hide", dialog.delete)

    @staticmethod
    def _confirm(said: str, yes: str, do: Callable[[], None]) -> None:
        def take() -> None:
            dialog.close()
            in_words(do)

        with ui.dialog(value=True) as dialog, ui.card():
            ui.label(said)
            with ui.row():
                ui.button(yes, on_click=take).props("no-caps unelevated")
                ui.button("Cancel", on_click=dialog.close).props("flat no-caps")
        dialog.on("hide", dialog.delete)
