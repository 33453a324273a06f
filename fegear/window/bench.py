"""What all open pages share: the case on the desk, the computing process, and the results that are shown now."""

from __future__ import annotations

import asyncio
import itertools
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fegear.base.effects import RELIEF
from fegear.base.errors import InputError
from fegear.case.changed_text import literal, with_value, with_values
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.text import draft
from fegear.window.beginnings import gallery
from fegear.window.document import Desk
from fegear.window.drag_handles import drawn_at_once, moved_relief, own_name, without_relief
from fegear.window.glance import keep_view, read_view
from fegear.window.job_queue import Asked, Compare, Compute, Design, Export, Said, Stop
from fegear.window.judging import Judging
from fegear.window.told import Content, Told

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.case.changed_text import Path as KeyPath
    from fegear.results.relief.relief_in_case import How
    from fegear.window.computing import Computing
    from fegear.window.document import Verdict
    from fegear.window.glance import View
    from fegear.window.journal import Left
    from fegear.window.reach import Reach

#: Accuracy against time: factor of the case's own tolerance.
LEVELS = {"draft": 10.0, "normal": 1.0, "fine": 0.1}
#: A value that has not moved for so long stands still, whether or not anybody has said so [s].
_HELD = 2.0
#: What could not be kept beyond a crash is tried again after this [s].
_AGAIN = 3.0
#: While a value moves the case is judged and kept beyond a crash once in this time [s].
_KEPT = 0.3
#: Between two changes that are shown are so many times the time that one takes, and at most so much [s].
_TIMES, _PAUSE = 2.0, 0.5


class Bench:
    """The state of ``fegear open``.

    Parameters
    ----------
    case : Path, optional
        The case to begin with.
    computing : Computing, optional
        What answers; without it nothing does.
    reach : Reach, optional
        Where files are opened and written; None for anywhere.

    Attributes
    ----------
    desk : Desk or None
        None while a template is being chosen.
    level : str
        A key of `LEVELS`.
    pinned : Asked or None
        The variant A that is compared with.
    view : View
        What is shown at a glance, and how.
    """

    def __init__(self, case: Path | None, computing: Computing | None = None, reach: Reach | None = None) -> None:
        if reach is not None:  # copies of the gallery's cases may name the tables beside them
            reach = reach._replace(sources=tuple({str(path.parent.resolve()) for path in gallery().values()}))
        self.reach = reach
        self.desk = Desk.of_file(case, reach) if case is not None else None
        self.level = "normal"
        self.pinned: Asked | None = None
        self.view = read_view(case)
        self._settled: Asked | None = None
        self._listeners: list[Callable[[str, Content], None]] = []
        self._numbers = itertools.count(1)
        self._computing = computing
        self._loop: asyncio.AbstractEventLoop | None = None
        self._held: asyncio.TimerHandle | None = None
        self._keeping: asyncio.TimerHandle | None = None
        self._settling: asyncio.TimerHandle | None = None
        self._more: bool | None = None  # what has changed since: whether all of it moves
        self._judging = Judging(self._take_verdict)
        self._number = self._first = self._laid = self._comparing = self._stopped = 0
        self._busy = False
        self._sight: tuple[str, ...] = ()
        self._shows: tuple[tuple[str, str], ...] = ()
        self._asides: set[int] = set()
        self._told = Told()

    def begin(self) -> None:
        """Listen to what is computed, and ask for the case; called within the loop that the pages run in."""
        self._loop = asyncio.get_running_loop()
        if self.desk is not None:
            self.desk.patient = True
        if self._computing is not None:
            self._computing.hear = self._from_process
        self._draw()
        self.compute()

    def end(self) -> None:
        """Keep what has been changed: the window is closed."""
        if self.desk is not None:
            self.desk.keep_up()

    def _draw(self) -> None:
        """Keep the gears as they are drawn, so that a page has them while the process that computes still loads."""
        if self.desk is not None and not self.desk.heavy:
            self._told.last |= drawn_at_once(self.desk)

    # ---- pages ---------------------------------------------------------------------------------------------------

    def listen(self, listener: Callable[[str, Content], None]) -> Callable[[], None]:
        """Have a page hear of everything from now on; returns what ends that."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener) if listener in self._listeners else None

    def see(self, tasks: list[str]) -> None:
        """Note which results are in sight on the page that was scrolled last."""
        self._sight = tuple(tasks)

    def show(self, pair: str, kind: str, *, on: bool) -> None:
        """Have something shown at the gears in mesh of a pair, or no longer."""
        others = tuple(one for one in self._shows if one != (pair, kind))
        self._shows = (*others, (pair, kind)) if on else others
        if on:
            self.compute()

    def see_otherwise(self, told: dict[str, Any]) -> None:
        """Show other small pictures, or another stress inside the teeth; kept for the next time."""
        before, self.view = self.view, self.view.changed(told)
        keep_view(self.desk.path if self.desk is not None else None, self.view)
        self._tell_exercise(before)
        if (before.pictures, before.measure == "none") != (self.view.pictures, self.view.measure == "none"):
            self.compute()

    def _tell_exercise(self, before: View) -> None:
        """Have all pages ask the same, and hide or show the answers: a class sees what its lecturer does, no more."""
        now, earlier = (
            {"exercise": one.exercise, "revealed": one.revealed, "question": one.question, "words": one.words}
            for one in (self.view, before)
        )
        if now != earlier:
            self.tell("exercise", now)

    def tell(self, what: str, content: Content | None = None) -> None:
        """Tell every page."""
        for listener in list(self._listeners):
            listener(what, content or {})

    def shown_now(self) -> list[tuple[str, Content]]:
        """What a page that opens now has to be told."""
        told = self._told.in_order(self._shows)
        return [*told, ("asked", {"number": self._number, "moving": False})] if self._busy else told

    # ---- the case ------------------------------------------------------------------------------------------------

    def lay(self, desk: Desk | None) -> None:
        """Lay another case on the desk, or clear it to choose one."""
        if self.desk is not None:
            self.desk.leave()
        self.desk, self.pinned, self._laid, self._sight = desk, None, self._laid + 1, ()
        self._told = Told()
        self._shows = ()
        self._settled, self._busy = None, False
        if desk is not None:
            self.view = read_view(desk.path)
            desk.patient = self._loop is not None
        self._first = next(self._numbers)
        self._judge_aside()
        self._draw()
        self.tell("laid")
        self.compute()

    def from_template(self, kind: str) -> None:
        """Begin with a draft of a kind."""
        self.lay(Desk(draft(Answers(kind, {}), kind), kind, Path.cwd(), None, self.reach))

    def from_gallery(self, name: str) -> None:
        """Begin with a copy of a case of the gallery."""
        path = gallery()[name]
        self.lay(Desk(path.read_text("utf-8"), name, path.parent, None, self.reach))

    def from_left(self, left: Left) -> None:
        """Take up a case without a file that an earlier window left behind.

        Raises
        ------
        InputError
            If another window has taken it meanwhile.
        """
        self.lay(Desk.of_left(left, self.reach))

    def from_file(self, path: Path) -> None:
        """Open a case file.

        Raises
        ------
        InputError
            If it cannot be read, or must not be.
        """
        self.lay(Desk.of_file(path, self.reach))

    def changed(self, *, moving: bool = False) -> None:
        """Show the case as it is now everywhere, and compute it; a value that is moved has its errors later.

        What is changed while that takes, and some time after, is shown, computed and kept once, however much it is.
        """
        if self._settling is not None:
            self._more = moving and self._more is not False
            return
        begun = time.monotonic()
        self._show_change(moving=moving)
        if self._loop is not None:
            pause = min(_TIMES * (time.monotonic() - begun), _PAUSE)
            self._settling = self._loop.call_later(pause, self._settle)

    def _settle(self) -> None:
        more, self._settling, self._more = self._more, None, None
        if more is not None:
            self.changed(moving=more)

    def _show_change(self, *, moving: bool) -> None:
        self._judge_aside()
        before, self.view = self.view, self.view._replace(revealed=False)  # another case is another exercise
        self._tell_exercise(before)
        self.tell("changed", {"moving": moving})
        self.compute(moving=moving)
        if self._held is not None:
            self._held.cancel()
        # Who has let go may not have been able to say so: the page was closed, or loaded again.
        self._held = self._loop.call_later(_HELD, self.changed) if moving and self._loop is not None else None
        if not moving or self._loop is None:
            self._keep_up()
        elif self._keeping is None:  # behind what is sent at once, and not for each: it takes half of this process
            self._keeping = self._loop.call_later(_KEPT, self._keep_up)

    def _keep_up(self) -> None:
        """Keep the case beyond a crash; where that fails pages say so, and it is tried again until it does not."""
        if self._keeping is not None:
            self._keeping.cancel()
            self._keeping = None
        if self.desk is None:
            return
        before = self.desk.trouble
        self.desk.keep_up()
        if self.desk.trouble and self._loop is not None:
            self._keeping = self._loop.call_later(_AGAIN, self._keep_up)
        if self.desk.trouble != before:
            self.tell("kept")

    def _judge_aside(self) -> None:
        """Have a long text judged beside, where its answer can be taken."""
        if self._loop is not None:
            self._judging.begin(self.desk, self._loop)

    def _take_verdict(self, desk: Desk, text: str, verdict: Verdict) -> None:
        if desk.take_verdict(text, verdict) and desk is self.desk:
            self.changed()
        self._judge_aside()

    def asked(self) -> Asked:
        """The case as it would be computed now."""
        desk = self._on_desk()
        within = self.reach.readable if self.reach is not None else None
        return Asked(desk.text, desk.name, str(desk.folder), LEVELS[self.level], within=within)

    def compute(self, *, moving: bool = False) -> None:
        """Ask for the case as it is now, unless it is refused already."""
        if self.desk is None or self._computing is None:
            return
        self._judge_aside()
        if self.desk.pending:
            return
        if not self.desk.may_be_asked() if moving else self.desk.refusal is not None:
            self._outdate(stopped=False)
            return
        self._number, self._busy = next(self._numbers), True
        self._told.last.pop("outdated", None)
        self.tell("asked", {"number": self._number, "moving": moving})
        asked = self.asked()._replace(
            moving=moving, sight=self._sight, shows=self._shows, laid=self._laid,
            pictures=self.view.pictures, field=self.view.measure != "none",
        )  # fmt: skip
        self._computing.ask(Compute(self._number, asked))

    def _outdate(self, *, stopped: bool) -> None:
        """Say that what pages show is not of the case as it is."""
        refusal = None if stopped or self.desk is None else self.desk.refusal
        self._told.last["outdated"] = {"stopped": stopped, "sentence": str(refusal or "")}
        self.tell("outdated", self._told.last["outdated"])

    def stop(self) -> None:
        """Give up what is being computed, written or designed; the next change computes again."""
        if self._computing is None or self.desk is None:
            return
        self._number, self._busy = next(self._numbers), False
        self._stopped = self._number
        self._asides.clear()
        self._computing.ask(Stop(self._number))
        self._outdate(stopped=True)

    def export(self, what: str, target: str) -> None:
        """Write the report or the drawings of the case as it is, at its own tolerance.

        Raises
        ------
        InputError
            If the folder is one that must not be written to.
        """
        if self.reach is not None:
            self.reach.check(Path(target), "folder")
        if self._computing is not None:
            self._computing.ask(Export(self._aside(), self.asked()._replace(loosened=1.0), what, target))

    def _aside(self) -> int:
        """Number of a job beside the case itself; who asked for it is reported where it is refused."""
        number = next(self._numbers)
        self._asides.add(number)
        return number

    def design(self, pair: str, how: How = "exact") -> None:
        """Ask for the reliefs that remove the transmission error of a pair, or the nearest to them to grind."""
        if self._computing is not None:
            self._computing.ask(Design(self._aside(), self.asked(), pair, how))
            self.tell("asked")

    def pin(self) -> None:
        """Keep the present state as variant A."""
        self.pinned, self._comparing = self.asked(), 0
        self._told.last.pop("pinned", None)
        if self._settled == self.pinned:
            self._told.keep_pinned()
        self.tell("pinned", self._told.last.get("pinned"))

    def unpin(self) -> None:
        """Compare no more."""
        self.pinned, self._comparing = None, 0
        self._told.last.pop("compared", None)
        self._told.last.pop("pinned", None)
        self.tell("unpinned")

    def move_relief(self, gear: str, end: str, start: float, amount: float, *, moving: bool, index: int = 0) -> None:
        """Have a part of a relief start at a roll angle [deg] with an amount [um]; the others stay.

        Raises
        ------
        InputError
            If the text cannot be changed there.
        """
        desk = self._on_desk()
        self.put(moved_relief(desk, gear, end, start, amount, index), moving=moving)

    def name_driven(self, pair: str) -> None:
        """Make the driven gear of a pair a gear of its own, where it was the driver as well."""
        self.put(own_name((desk := self._on_desk()).text, desk.document, pair), moving=False)

    def move_load(self, pair: str, key: str, text: str, *, moving: bool) -> None:
        """Give a pair another load or torque, a quantity with its unit."""
        self.put(with_value(self._on_desk().text, ("pair", pair, key), literal(text)), moving=moving)

    def move_value(self, path: KeyPath, value: str | None, *, moving: bool) -> None:
        """Give a key of the case another value, as TOML writes it."""
        self.put(with_value(self._on_desk().text, path, value), moving=moving)

    def drop_relief(self, gear: str) -> None:
        """Leave a gear without relief."""
        desk = self._on_desk()
        self.put(without_relief(desk.text, desk.document, gear), moving=False)

    def _take_reliefs(self, reliefs: dict[str, Any]) -> None:
        """Give gears other reliefs; the case before is pinned, so that both are shown over each other."""
        text = self._on_desk().text
        text = with_values(text, {("gear", gear, "relief"): None for gear in reliefs})
        written: dict[KeyPath, str | None] = {("effects", RELIEF.name): "true"}
        written |= {("gear", name, "relief"): literal(one) for name, one in reliefs.items() if one is not None}
        if self.pinned is None:
            self.pin()
        self.put(with_values(text, written), moving=False)

    def _on_desk(self) -> Desk:
        if self.desk is None:
            raise InputError("case", "(none)", "is no longer open", "choose a template or a case")
        return self.desk

    def put(self, text: str, *, moving: bool) -> None:
        """Take another text of the case, one of those of a value that is moved."""
        desk = self._on_desk()
        desk.change(text, stroke=True)
        if not moving:
            desk.end_stroke()
        self.changed(moving=moving)

    # ---- what the computing process says -------------------------------------------------------------------------

    def _from_process(self, said: Said) -> None:
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._hear, said)

    def _hear(self, said: Said) -> None:
        what, content = said.what, {**said.content, "number": said.number}
        if self._heard_beside(what, content, said.number):
            return
        if said.number < self._first or what == "stopped":  # of the case that lay here before; pages know of the stop
            return
        # While a value is being moved, the answer to an earlier place of it is what there is; it ends nothing.
        if what in ("refused", "done") and said.number != self._number:
            return
        if what == "done":
            content["level"] = "" if self.level == "normal" else f" ({self.level}, differs from the case)"
        self._busy &= what not in ("refused", "done")
        self._told.keep(what, content)
        self.tell(what, content)
        if what == "done":
            self._done(moving=content["moving"])
            if "outdated" in self._told.last:  # refused meanwhile: these are of the case before
                self.tell("outdated", self._told.last["outdated"])

    def _heard_beside(self, what: str, content: Content, number: int) -> bool:
        """Take what is said of a job beside the case; False if it is about the case itself."""
        if number in self._asides and what in ("refused", "designed", "exported", "compared"):
            self._asides.discard(number)
            if what == "refused":
                self.tell("failed", content)
                return True
            if what != "exported" and number < self._first:  # for the case that lay here before
                return True
        if what == "designed":
            if number > self._stopped:
                self._told.last["designed"] = content
                self.tell(what, content)
                self._take_reliefs(content["reliefs"])
        elif what == "compared":
            if number == self._comparing:  # else with an A that is pinned no longer, or of an earlier B
                self._told.last[what] = content
                self.tell(what, content)
        elif what == "exported":
            self.tell(what, content)
        else:
            return False
        return True

    def _done(self, *, moving: bool) -> None:
        """Compare what was found with A, or keep it as A's own."""
        self._settled = None if moving else self.asked()
        if moving or self.pinned is None:
            return
        if self.pinned == self._settled and "pinned" not in self._told.last:
            self._told.keep_pinned()
            self.tell("pinned", self._told.last["pinned"])
        if self._computing is not None:
            self._comparing = self._aside()
            self._computing.ask(Compare(self._comparing, self.pinned, self.asked()))
