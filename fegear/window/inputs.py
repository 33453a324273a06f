"""The case as a form and as its text; each changes the other, and a refusal stands at its field.

A typed quantity one step up or down, as the arrow keys change it.
"""

from __future__ import annotations

import asyncio
import re
import time
from decimal import Decimal
from difflib import SequenceMatcher
from functools import partial
from typing import TYPE_CHECKING, Any

from nicegui import ui

from fegear.base.errors import InputError
from fegear.window.document import LARGEST, check_text
from fegear.window.form import Field, Section, beside, fields, fields_told, form, in_rows, shortened, tables_to_add

if TYPE_CHECKING:
    from collections.abc import Iterator

    from nicegui.element import Element

    from fegear.case.changed_text import Path
    from fegear.window.bench import Bench


#: Kinds of fields that are typed into.
_TYPED = frozenset({"text", "toml", "number"})
#: How long nobody types before a text is read [ms].
_PAUSE = 500


class Inputs:
    """Form and text of one page."""

    #: Why what is in the text's field is not the case's; empty as a rule.
    _not_taken = ""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self._elements: dict[Path, Element] = {}
        self._places: dict[Path, Element] = {}
        self._held: dict[Path, Field] = {}
        self._refused_at: Path | None = None
        self._warned: dict[Path, str] = {}
        with ui.tabs().props("dense no-caps align=left inline-label") as tabs:
            self._as_form, as_text = ui.tab("Form"), ui.tab("Text")
        with ui.tab_panels(tabs, value=self._as_form).props("keep-alive").style("background: transparent"):
            with ui.tab_panel(self._as_form).style("padding: .4rem 0"):
                self._refusal = ui.label().classes("refusal").props("role=alert")
                self._form = ui.element("div")
            with ui.tab_panel(as_text).style("padding: .4rem 0"):
                self._text = ui.textarea(value=self._desk.text).props(
                    f'outlined autogrow spellcheck=false debounce={_PAUSE} aria-label="Text of the case (TOML)"'
                )
                self._text.style("width: 100%").on_value_change(self._text_typed)
                self._shown, self._typing = self._desk.text, 0.0
                for event in ("keydown", "paste"):  # before the text itself comes, when nobody has typed for a while
                    self._text.on(event, self._begun, args=[], throttle=0.1)
                self._text_refusal = ui.label().classes("refusal")
        self._build()
        self._judge()

    @property
    def _desk(self) -> Any:
        return self._bench.desk

    def hear(self, what: str, content: dict[str, Any]) -> None:
        """Show the case as it has become, and what the computation says of it."""
        if what == "changed":
            self._refresh()
        elif what == "done" and not content["moving"] and self._desk is not None:
            self._warn(fields_told(self._sections()[0], content["remarks"]))
        elif what == "refused" and self._desk is not None and self._desk.refusal is None:
            self._say(content["sentence"], content["key"])

    # ---- building ------------------------------------------------------------------------------------------------

    def _build(self) -> None:
        typed = self._unconfirmed()
        self._form.clear()
        self._elements, self._places, self._held = {}, {}, {}
        sections, left = self._sections()
        with self._form:
            for row in beside(sections, self._desk.document):
                if len(row) == 2:
                    self._beside((row[0], row[1]))
                else:
                    self._section(row[0])
            if left:
                ui.label(f"{left} more tables in the text only.").classes("about")
            more = tables_to_add(self._desk.document)
            if more:
                ui.html("Add a table", tag="h3")
                choice = ui.select(more_labels(more), label="Add further input", on_change=self._table_chosen)
                choice.props("outlined dense options-dense").style("width: 100%")
        for path, text in typed.items():
            again: Any = self._elements.get(path)
            if again is not None:
                again.set_value(text)

    def _sections(self) -> tuple[tuple[Section, ...], int]:
        """What the form shows, and how many tables it leaves out."""
        document, left = shortened(self._desk.document)
        return form(document), left

    def _unconfirmed(self) -> dict[Path, str]:
        """What somebody has typed and not confirmed yet: no change that comes from elsewhere takes it away."""
        found = {}
        for path, element in self._elements.items():
            held, text = self._held[path], getattr(element, "value", None)
            if held.kind in _TYPED and isinstance(text, str) and text.strip() != held.shown.strip():
                found[path] = text
        return found

    def _section(self, section: Section) -> None:
        with ui.element("div").classes("inner" if len(section.path) > 2 else ""):
            if section.path:
                ui.html(
                    section.title if len(section.path) < 3 else section.path[-1].replace("_", " "),
                    tag="h3",
                    sanitize=_escaped,
                )
                if section.about and len(section.path) < 3:
                    ui.html(section.about, tag="p", sanitize=_escaped).classes("about")
            for field in section.given:
                self._field(field)
            self._rest(section, section.left_out)

    def _beside(self, two: tuple[Section, Section]) -> None:
        """The gears of a pair beside each other, key by key; what one of them has besides stands below."""
        rows = in_rows(two)
        shown = {field.path for row in rows for field in row}
        with ui.element("div").classes("two"):
            for section in two:
                ui.html(section.title, tag="h3", sanitize=_escaped)
            for row in rows:
                for field in row:
                    self._field(field)
            for section in two:
                with ui.element("div"):
                    for field in section.given:
                        if field.path not in shown:
                            self._field(field)
                    self._rest(section, tuple(field for field in section.left_out if field.path not in shown))

    def _rest(self, section: Section, left: tuple[Field, ...]) -> None:
        """Tables in a section, and what it leaves out, folded."""
        for inner in section.sections:
            self._section(inner)
        if left:
            with ui.expansion(f"{len(left)} further keys (defaults)").props("dense dense-toggle") as more:
                opened: list[bool] = []

                def fill(event: Any, more: Any = more, left: Any = left, opened: Any = opened) -> None:
                    if event.value and not opened:  # not before somebody looks: most of a case is left out
                        opened.append(True)
                        with more:
                            for field in left:
                                self._field(field)

                more.on_value_change(fill)
            for field in left:
                self._places[field.path] = more
                self._held[field.path] = field
            if marked := [field.label for field in left if field.path in self._warned]:
                more.props["caption"] = f"assumed or not specified: {', '.join(marked)}"

    def _field(self, field: Field) -> None:
        commit = partial(self._typed, field)
        made: Any
        if field.kind == "switch":
            with ui.element("div").classes("switch"):
                made = ui.switch(field.label, value=bool(field.value)).props("dense")
                ui.label(field.about).classes("about")
            made.on_value_change(lambda event: self._set(field, "true" if event.value else "false"))
        elif field.kind == "several":
            made = ui.select(list(field.choices), value=known(field), multiple=True, label=field.label)
            made.props("outlined dense options-dense use-chips hide-hint hide-bottom-space").style("width: 100%")
            made.on_value_change(lambda event: self._set(field, _listed(event.value)))
        elif field.kind == "choice":
            options = {"": f"({field.default or 'not given'})"} | {name: name for name in field.choices}
            made = ui.select(options, value=field.shown if field.shown in options else "", label=field.label)
            made.props("outlined dense options-dense hide-hint hide-bottom-space").style("width: 100%")
            made.on_value_change(lambda event: self._set(field, event.value or ""))
        else:
            made = ui.input(field.label, value=field.shown, placeholder=field.default or None)
            made.props("outlined dense hide-hint hide-bottom-space autocomplete=off").style("width: 100%")
            if field.default:
                made.props("stack-label")
            if _NUMBER.fullmatch(field.shown or field.default):
                made.classes("scrubs whole" if field.whole else "scrubs")  # by its arrow (scrub.js)
            made.on("keydown.enter", commit).on("blur", commit)
            for key, way in (("up", 1), ("down", -1)):
                made.on(f"keydown.{key}.prevent", partial(self._step, field, way), args=["shiftKey"])
        made.classes("given" if field.given else "absent").props["data-key"] = field.key
        self._elements[field.path] = made
        self._held[field.path] = field
        self._tell(field.path)

    def _tell(self, path: Path) -> None:
        """Say what a field means and what results say of it: below it while it has the focus, beside the pointer."""
        made, warned = self._elements.get(path), self._warned.get(path, "")
        if made is None:
            return
        words = " ".join(filter(None, [warned, told(self._held[path])]))
        made.classes(add="warned" if warned else "", remove="" if warned else "warned")
        made.props["title"] = words
        if self._held[path].kind != "switch":
            made.props["hint"] = words
        made.update()

    def _warn(self, told: dict[Path, str]) -> None:
        """Mark the fields that results say something of, and the folds in which such fields lie."""
        before, self._warned = self._warned, told
        if before == told:
            return
        for path in {*before, *told}:
            if before.get(path) != told.get(path):  # a field that is sent anew loses what is typed at that moment
                self._tell(path)
        for fold in set(self._places.values()):
            inside = [path[-1].replace("_", " ") for path in told if self._places.get(path) is fold]
            fold.props["caption"] = f"assumed or not specified: {', '.join(inside)}" if inside else ""
            fold.update()

    # ---- changes -------------------------------------------------------------------------------------------------

    def _typed(self, field: Field, _event: object = None) -> None:
        element: Any = self._elements[field.path]
        self._set(field, element.value or "")

    def _step(self, field: Field, way: int, event: Any) -> None:
        element: Any = self._elements[field.path]
        far = isinstance(event.args, dict) and event.args.get("shiftKey") is True
        text = stepped(element.value or field.default, way * (10 if far else 1))
        if text is not None:
            element.set_value(text)
            self._set(field, text)

    def move(self, key: str, text: str, *, moving: bool) -> None:
        """Give a field the number that its arrow is dragged to.

        Raises
        ------
        InputError
            If there is no such field, or what it is given does not begin with a number.
        """
        path = next((one for one, field in self._held.items() if field.key == key and field.kind in _TYPED), None)
        if path is None or _NUMBER.fullmatch(check_text(text, key)) is None:
            raise InputError(key, f'"{text}"', "is not a number of this form", "reload the page")
        if not moving and (element := self._elements.get(path)) is not None:  # on its way the page shows it itself
            element.set_value(text)
        self._bench.move_value(path, self._held[path].written(text), moving=moving)

    def _set(self, field: Field, text: str) -> None:
        now = self._held[field.path]
        if text == now.shown or (not now.given and text == now.default and now.kind == "switch"):
            return
        try:
            self._desk.set(field.path, now.written(check_text(text, field.key)))
        except InputError as error:
            self._say(str(error), field.key)
            return
        self._bench.changed()

    def _begun(self) -> None:
        """Note that somebody types in the text: what others change meanwhile is not written over it."""
        self._typing = time.monotonic()

    def _text_typed(self, event: Any) -> None:
        before, refused = self._desk.text, self._not_taken
        try:
            text = merged(self._shown, check_text(event.value or ""), before)
            self._desk.change(text)
        except InputError as error:
            self._leave_untaken(str(error))
            return
        self._typing, self._shown, self._not_taken = 0.0, text, ""
        if text != event.value:  # with what another page has changed since
            self._text.set_value(text)
        if text != before:
            self._bench.changed()
        elif refused:
            self._judge()

    def leave_too_long(self) -> None:
        """Say that the text is too long to be taken: the page has not sent it."""
        self._leave_untaken(f"it exceeds {LARGEST} characters; move tables to separate files.")

    def _leave_untaken(self, sentence: str) -> None:
        """Leave a text that cannot be the case's in its field, and say so, until it can."""
        self._not_taken = f"Not accepted (kept in this field only): {sentence}"
        self._text_refusal.set_text(self._not_taken)
        self._refusal.set_text(f"Text not accepted: {sentence}")

    def _table_chosen(self, event: Any) -> None:
        if not event.value:
            return
        try:
            self._desk.change(f"{self._desk.text.rstrip()}\n\n[{event.value}]\n")
        except InputError as error:
            self._say(str(error), "")
            return
        self._bench.changed()

    # ---- showing -------------------------------------------------------------------------------------------------

    def _refresh(self) -> None:
        if self._desk is None:
            return
        self._refresh_text()
        now = {field.path: field for field in fields(self._sections()[0])}
        if set(now) != set(self._held) or any(now[path].kind != self._held[path].kind for path in now):
            self._build()
        else:
            typed = self._unconfirmed()
            for path, field in now.items():
                before, self._held[path] = self._held[path], field
                if path in typed and field.shown == before.shown:  # nobody has changed this one
                    continue
                element: Any = self._elements.get(path)
                if element is None:
                    continue
                value: Any = field.shown
                if field.kind == "switch":
                    value = bool(field.value)
                elif field.kind == "several":
                    value = known(field)
                if element.value != value and not (value == "" and element.value is None):
                    element.set_value(value)
                element.classes(add="given" if field.given else "absent", remove="absent" if field.given else "given")
        self._judge()

    def _refresh_text(self) -> None:
        """Show the text as it is now; where somebody types, later: what is typed comes soon, and is merged with it."""
        if self._desk is None or self._not_taken:
            return
        if time.monotonic() - self._typing < 2e-3 * _PAUSE:
            asyncio.get_running_loop().call_later(2e-3 * _PAUSE, self._refresh_text)
            return
        self._shown = self._desk.text
        if self._text.value != self._desk.text:
            self._text.set_value(self._desk.text)

    def _judge(self) -> None:
        refusal = self._desk.refusal
        self._say(str(refusal) if refusal else "", refusal.key if isinstance(refusal, InputError) else "")

    def _say(self, sentence: str, key: str) -> None:
        if self._refused_at is not None and (old := self._elements.get(self._refused_at)) is not None:
            old.props(remove="error error-message")
        self._refused_at = self._nearest(key) if sentence else None
        self._text_refusal.set_text(self._not_taken or sentence)
        element: Any = self._elements.get(self._refused_at) if self._refused_at else None
        at_field = element is not None and hasattr(element, "value") and not isinstance(element, ui.switch)
        self._refusal.set_text("" if at_field else sentence)
        if at_field and element is not None:
            element.props["error"], element.props["error-message"] = True, sentence
            element.update()

    def _nearest(self, key: str) -> Path | None:
        """The field that a refusal is about: of its own key, or of the table around it."""
        steps = key.split(".")
        for depth in range(len(steps), 0, -1):
            for path in self._elements:
                if path == tuple(steps[:depth]):
                    return path
        return None


def merged(base: str, mine: str, theirs: str) -> str:
    """One text of two that were changed from the same: what was typed, a piece of `mine`, in `theirs`.

    Where both have changed the same lines, what was typed last, which is `mine`, counts alone.
    """
    if base in (mine, theirs):
        return theirs if mine == base else mine
    old, own, other = (text.splitlines(keepends=True) for text in (base, mine, theirs))
    first = next((i for i, (a, b) in enumerate(zip(old, own, strict=False)) if a != b), min(len(old), len(own)))
    most = min(len(old), len(own)) - first
    same = next((i for i, (a, b) in enumerate(zip(old[::-1], own[::-1], strict=False)) if a != b), most)
    last = len(old) - min(same, most)
    start, end = first, last
    for i, j, k, n in _changes(old, other):
        if i <= last and j >= first:
            return mine
        if j < first:
            start, end = start + (n - k) - (j - i), end + (n - k) - (j - i)
    return "".join([*other[:start], *own[first : len(own) - (len(old) - last)], *other[end:]])


#: Pairs of lines that are compared with each other; of longer texts all between the first change and the last is one.
_PAIRS = 1_000_000


def _changes(old: list[str], new: list[str]) -> Iterator[tuple[int, int, int, int]]:
    """Where lines differ: first and last of the old ones, first and last of those in their place."""
    first = next((i for i, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), min(len(old), len(new)))
    most = min(len(old), len(new)) - first
    same = next((i for i, (a, b) in enumerate(zip(old[::-1], new[::-1], strict=False)) if a != b), most)
    before, after = old[first : len(old) - min(same, most)], new[first : len(new) - min(same, most)]
    if len(before) * len(after) > _PAIRS:
        yield first, first + len(before), first, first + len(after)
        return
    for kind, i, j, k, n in SequenceMatcher(None, before, after, autojunk=False).get_opcodes():
        if kind != "equal":
            yield first + i, first + j, first + k, first + n


def more_labels(tables: dict[str, str]) -> dict[str, str]:
    """Tables to add with what each is, on one line."""
    return {name: f"{name.replace('_', ' ')}: {about}" for name, about in tables.items()}


def told(field: Field) -> str:
    """What a field means, and what may be typed into it."""
    return " ".join(filter(None, [field.about, field.hint and f"{field.hint[0].upper()}{field.hint[1:]}"]))


def known(field: Field) -> list[str]:
    """Names of a list that are among its choices."""
    return [one for one in field.value or () if one in field.choices] if isinstance(field.value, list) else []


def _listed(names: list[str]) -> str:
    return "[" + ", ".join(f'"{name}"' for name in names) + "]" if names else ""


def _escaped(text: str) -> str:
    from html import escape

    return escape(text)


_NUMBER = re.compile(r"\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)(.*)", re.DOTALL)


def stepped(text: str, steps: int) -> str | None:
    """The text with its leading number changed by so many units of its last digit; None where there is no number.

    Parameters
    ----------
    text : str
        ``23``, ``0.30``, ``20 deg``.
    steps : int

    Returns
    -------
    str or None
        As many decimals as before; the unit stays.
    """
    found = _NUMBER.fullmatch(text)
    if found is None:
        return None
    number = Decimal(found[1])
    exponent = number.as_tuple().exponent
    if not isinstance(exponent, int):
        return None
    unit = Decimal(1).scaleb(exponent)
    made = number + steps * unit
    return f"{made:f}{found[2]}" if "e" not in found[1].lower() else f"{made}{found[2]}"
