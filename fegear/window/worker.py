"""The computing process: one case at a time, given up where a later one is wanted, with all it has solved kept."""

from __future__ import annotations

import contextlib
import gc
import tempfile
import time
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fegear.base.errors import FegearError, InputError
from fegear.base.memory import give_back
from fegear.base.solution_cache import SolutionCache
from fegear.base.store import Store
from fegear.engine.processes import loading
from fegear.results.pair.loaded_teeth import teeth_of
from fegear.window.ahead import compute_ahead, next_texts
from fegear.window.assemblies import assemblies_of, on_the_assembly
from fegear.window.computing import SAME, Sent
from fegear.window.designs import design_asked, designed, draft_of, preview_told
from fegear.window.drag_handles import hands_of
from fegear.window.glance import keys_of, numbers_of
from fegear.window.job_queue import Asked, Compare, Compute, Design, Export, Inbox, Job, Newer, Said, Stop, Unwanted
from fegear.window.notes import notes_by_task, notes_of
from fegear.window.on_gears import gears_in_mesh, on_the_gears
from fegear.window.order import HarrisMaps, load_now_of
from fegear.window.time_left import TimeLeft
from fegear.window.wanted import scene_of, wanted_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from multiprocessing.connection import Connection

    from fegear.case.reading import Scene
    from fegear.engine.outcome import Outcome
    from fegear.engine.plan import Plan
    from fegear.engine.run import Results
    from fegear.engine.stage import Task


#: For so long a computation goes on while a value is being moved [s].
_STROKE = 1.5
#: A value that has not moved for so long stands still [s].
_STILL = 0.2
#: The next place of a value is computed ahead where the present one took no more CPU time than this [s].
_SOON = 0.15
#: Pictures that a page cannot draw wait so long for another move: drawing one, half a second, is not interrupted [s].
_AT_REST = 1.0
#: After so many answers to a value being moved, of some 2 MB each, what is kept is bounded again: it takes 30 ms.
_STROKES = 24
#: Between two reports of progress inside a task is so much time [s].
_OFTEN = 0.3
#: Bytes that results in memory may take beside those of the present case; a plane gear takes some 35 MB, and comes
#: back from the folder of solved teeth.
_MOST = 120_000_000
#: Bytes that the folder of solved teeth may take, which may lie in memory, too; a plane gear takes some 3 MB.
_MOST_ON_DISK = 256_000_000


class Worker:
    """Reads jobs from a connection and answers them.

    Parameters
    ----------
    connection : Connection
    folder : Path
        Where tooth shapes are kept, so that they outlive this process where it has to be stopped.
    """

    def __init__(self, connection: Connection, folder: Path) -> None:
        self._inbox, self._folder = Inbox(connection), folder
        self._seconds: dict[str, float] = {}
        self._number, self._begun, self._wait_before, self._spent = 0, 0.0, 0, 0.0
        self._asked: Asked | None = None
        self._next: tuple[str, ...] = ()
        self._later: list[tuple[str, Callable[[], None]]] = []
        self._left = TimeLeft(())
        self._reported, self._reports = 0.0, False
        self._begin_anew()

    def _begin_anew(self) -> None:
        """Keep nothing of what was computed and told, but for what is on the disk."""
        store = Store(self._folder, _MOST_ON_DISK)
        self._cache = SolutionCache(store, check=lambda: self._inbox.look(), at_leisure=True)
        self._meshes: dict[str, object] = {}
        self._assemblies: dict[str, object] = {}
        self._drawn: Mapping[str, object] = {}
        self._on_gears: dict[Task, object] = {}
        self._laid, self._sent = 0, Sent()
        self._previews: frozenset[str] = frozenset()
        self._text = ""
        self._maps = HarrisMaps()
        self._untidy = 0

    def serve(self) -> None:
        """Answer jobs until nobody is there to ask."""
        self._inbox.open()
        with loading():
            _load()
        while True:
            try:
                self.answer(self._inbox.take())
                while self._inbox.empty and self._cache.write_one():
                    pass
            except (EOFError, OSError):
                return

    def _say(self, what: str, **content: object) -> None:
        self._inbox.say(Said(self._number, what, content))

    def answer(self, job: Job) -> None:
        """Do one job."""
        self._number, self._begun, self._wait_before = job.number, time.monotonic(), 0
        self._asked, self._later = (job.asked if isinstance(job, Compute) else None), []
        self._next, self._spent = (), time.process_time()
        moving = self._asked is not None and self._asked.moving
        self._left = TimeLeft(())
        self._reports = isinstance(job, Compute | Export | Design) and not moving  # who moves a value sees the results
        self._inbox.watch(self._gives_way if isinstance(job, Compute) else _is_stop, Worker._do.__code__)
        try:
            self._do(job)
        except Unwanted:
            self._say("dropped")
        except MemoryError:
            self._begin_anew()
            self._say(
                "refused", sentence="Out of memory: reduce the problem size or increase the memory limit.", key=""
            )
        except Exception as error:  # noqa: BLE001 - told and printed below; the window stays open
            if self._inbox.given_up:
                self._say("dropped")
            elif isinstance(error, FegearError):
                self._say("refused", sentence=str(error), key=error.key if isinstance(error, InputError) else "")
            else:
                traceback.print_exc()
                self._begin_anew()  # nobody knows what it has left half done
                fault = f"{type(error).__name__}: {error}"
                sentence = f"Internal error in fegear ({fault}), not caused by the case; see the terminal for details."
                self._say("refused", sentence=sentence, key="")
        finally:
            self._inbox.watch(None)
            self._asked = None
            self._tidy(moving)

    def _tidy(self, moving: bool) -> None:
        """Bound what is kept; while a value moves the next answer waits, and each adds little."""
        self._untidy = self._untidy + 1 if moving else _STROKES
        if self._untidy >= _STROKES:
            self._untidy = 0
            if self._cache.shrink(_MOST):
                give_back()

    def _do(self, job: Job) -> None:
        """In here, and nowhere else, a computation that is unwanted is given up."""
        if isinstance(job, Compute):
            self._compute(job.asked)
        elif isinstance(job, Stop):
            self._say("stopped")
        elif isinstance(job, Export):
            self._export(job)
        elif isinstance(job, Design):
            self._design(job)
        else:
            self._compare(job)

    # ---- as a watcher of a run: every report of progress is an occasion to notice that another case is wanted ----

    def begin(self, title: str, number: int, count: int) -> None:
        """Tell that a task begins; what nobody waits for does not begin while a value moves."""
        if number == self._wait_before:
            self._pause()
        self._inbox.look()
        self._left.begin(number)
        if self._reports:
            self._reported = time.monotonic()
            self._say("begin", title=title, step=number, count=count, left=self._left.left())

    def advance(self, fraction: float) -> None:
        """Look whether another case is wanted, and tell now and then how far the task is."""
        self._inbox.look()
        if self._reports and time.monotonic() - self._reported > _OFTEN:
            self._reported = time.monotonic()
            self._say("advance", fraction=round(fraction, 3), left=self._left.left(fraction))

    def end(self, seconds: float) -> None:
        """Look whether another case is wanted."""
        self._inbox.look()
        self._left.end(seconds)

    def _gives_way(self, to: Newer) -> bool:
        """Whether what is being computed is given up for another case, or for none."""
        if isinstance(to, Stop):
            return True
        # While a value is being moved every answer is soon followed by another question: what is dragged for is
        # finished first.
        dragged = self._asked is not None and self._asked.moving and to.asked.moving and self._wait_before >= 0
        return not dragged or time.monotonic() - self._begun > _STROKE

    # ---- jobs ----------------------------------------------------------------------------------------------------

    def _results(self, asked: Asked, *, told: bool = False) -> Results:
        from fegear.engine.own_speed import own_speed
        from fegear.engine.plan_in_words import forecast_seconds
        from fegear.engine.run import run_plan

        wanted = wanted_of(asked, self._cache if asked.moving and told else None, self._previews)
        scene, plan = wanted.scene, wanted.plan
        if told:
            if asked.laid != self._laid:
                self._laid, self._sent, self._meshes, self._on_gears = asked.laid, Sent(), {}, {}
                self._assemblies, self._drawn = {}, {}
                self._maps = HarrisMaps()
            tasks = [str(step.task) for step in plan.steps]
            self._say("plan", tasks=tasks)
            self._sent.forget_others(tasks)
            plan, at_once = wanted.in_order(asked, self._seconds)
            self._wait_before = at_once + 1 if asked.moving and at_once < len(plan.steps) else 0
            self._later.append(("hands", lambda: self._tell_hands(scene)))
            if not asked.moving:
                self._tell_later()
            elif scene.pairs != self._drawn:  # gears follow at once; what else is in the hand the page moves itself
                self._tell_gears(scene)
                self._next = next_texts(self._text, asked.text)
            self._previews = scene.previews if asked.moving else self._previews
            self._text = asked.text
            for content in () if asked.moving else wanted.told:
                self._say("meshed", **content)
            self._on_gears = {task: data for task, data in self._on_gears.items() if str(task) in tasks}
            self._draft(asked, scene, plan, wanted.planned)
        self._left = TimeLeft(own_speed().scaled(plan, forecast_seconds(scene, plan)) if self._reports else ())
        return run_plan(
            scene, plan, self, cache=self._cache, found=(lambda task, outcome: self._found(scene, plan, task, outcome))
            if told else None,
        )  # fmt: skip

    def _pause(self) -> None:
        """See whether a value that has been answered moves on; what else follows from it is told where it does not."""
        self._wait_before = -1
        if self._asked is not None and self._asked.sight:  # the map beside the load stands among these
            self._tell_later("load_now")
        if self._untidy + len(self._next) + 1 >= _STROKES:  # now, while nobody waits
            self._tidy(moving=True)
        self._inbox.look()
        spent = self._compute_ahead() if time.process_time() - self._spent < _SOON else 0.0
        self._inbox.wait(max(0.0, _STILL - spent))
        self._inbox.look()
        self._tell_later()

    def _compute_ahead(self) -> float:
        """Compute places where a gear that is changed step by step may be next; gives way as soon as it moves."""
        begun, asked, places, self._next = time.monotonic(), self._asked, self._next, ()
        if asked is None:
            return 0.0
        for text in places:
            self._inbox.look()
            self._untidy += 1
            with contextlib.suppress(Exception):  # nobody has asked for it: who does is told
                compute_ahead(asked._replace(text=text), self._cache, self._previews, self._seconds)
        return time.monotonic() - begun

    def _tell_later(self, *kinds: str) -> None:
        """Tell what comes behind the answers while a value moves, or some of it: the page moves what is in the hand."""
        now = [one for one in self._later if one[0] in kinds or not kinds]
        self._later = [one for one in self._later if one not in now]
        for _, tell in now:
            tell()

    def _tell_gears(self, scene: Scene) -> None:
        """Tell how gears in mesh that the page knows look now; reliefs, which go with them, follow at rest."""
        if scene.pairs.keys() != self._meshes.keys():
            self._tell_later("hands")
        else:
            self._tell_pairs(scene, {name: {"mesh": gears_in_mesh(scene, name)} for name in scene.pairs})

    def _tell_hands(self, scene: Scene) -> None:
        """Tell what is changed by hand."""
        self._tell_pairs(scene, hands_of(scene))

    def _tell_pairs(self, scene: Scene, pairs: dict[str, Any]) -> None:
        meshes = {name: one["mesh"] for name, one in pairs.items()}
        self._drawn = scene.pairs
        for name, one in pairs.items():  # outlines are long, and most changes leave them as they are
            if self._meshes.get(name) == one["mesh"]:
                one["mesh"] = None
            else:  # what is shown on other teeth is not shown on these: it is sent again, though it may be known
                self._on_gears = {task: data for task, data in self._on_gears.items() if task.subject != name}
        self._say("hands", pairs=pairs)
        self._meshes = meshes
        if (drawn := assemblies_of(scene)) != self._assemblies:
            self._say("assemblies", **drawn)
            self._assemblies = drawn

    def _draft(self, asked: Asked, scene: Scene, plan: Plan, planned: Callable[[Scene], Plan]) -> None:
        """Tell a first answer where a gear has to be solved anew."""
        from fegear.engine.run import run_plan

        if not asked.moving and (draft := draft_of(scene, plan, self._cache, planned)) is not None:
            run_plan(
                draft.scene, draft.plan, self, cache=self._cache,
                found=lambda task, outcome: self._found(draft.scene, draft.plan, task, outcome, draft.told),
            )  # fmt: skip

    def _compute(self, asked: Asked) -> None:
        started = time.perf_counter()
        results = self._results(asked, told=True)
        if asked.moving and self._wait_before >= 0:
            self._pause()
        self._tell_later()
        seconds = {str(task): (one.seconds, one.origin) for task, one in results.timings.items()}
        tolerance = results.scene.case.accuracy.tolerance
        self._seconds.update({str(task): one.when_computed for task, one in results.timings.items()})
        self._say(
            "done", remarks=list(results.remarks), notes=notes_of(results), told=notes_by_task(results),
            seconds=time.perf_counter() - started, timings=seconds, tolerance=tolerance, moving=asked.moving,
            answer=list(results.answer.sentences),
        )  # fmt: skip
        if not asked.moving:
            self._say("harris", pairs=self._maps.at_rest(results))
            self._pictures(results)

    def _found(self, scene: Scene, plan: Plan, task: Task, outcome: Outcome, draft: str = "") -> None:
        from fegear.engine.figure.figure import Figure
        from fegear.output.draw_plotly.layout import darker, plotly_json
        from fegear.output.report.blocks import Values
        from fegear.output.report.page import fragment

        teeth = teeth_of(task, outcome.data)
        if teeth is not None and self._asked is not None and self._asked.moving:
            self._later.append(("load_now", lambda: self._say("load_now", **load_now_of(task.subject, teeth))))
        title = next(step.stage.title for step in plan.steps if step.task == task)
        figures = [one for one in outcome.figures if isinstance(one, Figure) and one.drawable_in_page]
        values = Values(outcome.values, scene.case.accuracy.tolerance)
        loads = outcome.tables[0] if task.stage == "load-sharing" else None
        found = {
            "task": str(task),
            "title": f"{title}: {task.subject}" if task.subject else title,
            "values": None if self._unseen(task) else fragment([values]) if outcome.values else "",
            "figures": [
                SAME | {"key": one.key} if self._waits(task, one.key)
                else {"key": one.key, "heading": one.heading, "caption": one.caption, **plotly_json(one)}
                for one in figures
            ],
            "darker": darker(figures),
            "draft": draft or preview_told(scene),
            "numbers": numbers_of(outcome.values),
            "loads": None if loads is None else {
                "pair": task.subject, "x": loads.column("x").si.tolist(), "load": loads.column("load").si.tolist(),
            },
        }  # fmt: skip
        if (news := self._sent.news(found)) is not None:
            self._say("found", **news)
        if draft:
            return
        if self._on_gears.get(task) is outcome.data:
            return  # what is recalled is on the page already
        shown = on_the_gears(task, outcome.data) or on_the_assembly(task, outcome.data, scene)
        if shown is not None:
            self._on_gears[task] = outcome.data
            self._say("meshed", task=str(task), **shown)

    def _unseen(self, task: Task) -> bool:
        """Whether a result is out of sight while a value moves, and was told before."""
        asked = self._asked
        if asked is None or not asked.moving or asked.pictures is None:
            return False
        return str(task) not in asked.sight and self._sent.knows(str(task))

    def _waits(self, task: Task, figure: str) -> bool:
        """Whether a figure is drawn when all is at rest: out of sight while a value moves, and known of before."""
        asked = self._asked
        if asked is None or asked.pictures is None or not self._unseen(task):
            return False
        small = {f"{key}{task.subject}" for key in keys_of(asked.pictures)}
        return figure not in small and self._sent.knows(str(task), figure)

    def _pictures(self, results: Results) -> None:
        """Draw what a page cannot draw itself, after all numbers are there."""
        import base64

        from fegear.output.draw_png import draw_pictures

        for task, outcome in results.outcomes.items():
            for one in outcome.figures:
                self._inbox.look()
                figure = one.made()
                if figure.drawable_in_page and figure is one:
                    continue
                self._inbox.wait(_AT_REST)
                self._inbox.look()
                with tempfile.TemporaryDirectory() as folder:
                    for number, picture in enumerate(draw_pictures(figure, Path(folder))):
                        self._say(
                            "picture", task=str(task), key=f"{figure.key}-{number}", heading=picture.title,
                            caption=picture.caption, data=base64.b64encode(picture.path.read_bytes()).decode(),
                        )  # fmt: skip

    def _export(self, job: Export) -> None:
        from fegear.engine.run import Silence
        from fegear.output.export import export_gears, wanted_formats
        from fegear.output.folder import whole_or_nothing
        from fegear.output.run_files import write_results
        from fegear.output.tables import write_table
        from fegear.studies.comparison.compare import side_of

        target = Path(job.target)
        with whole_or_nothing(target) as scratch:
            if job.what == "report":
                remarks = write_results(self._results(job.asked), scratch, Silence())
            elif job.what == "tables":
                found = self._results(job.asked)
                for table in found.tables:
                    write_table(scratch, table)
                remarks = list(found.remarks)
            else:
                taken = any(row.takes_results for row in wanted_formats(job.what).values())
                results = side_of(self._results(job.asked), job.asked.name) if taken else None
                remarks = list(export_gears(scene_of(job.asked), scratch, (), job.what, results).remarks)
        self._say("exported", target=str(target.resolve()), remarks=remarks)

    def _compare(self, job: Compare) -> None:
        from fegear.output.comparison import comparison_page
        from fegear.output.draw_plotly.layout import darker, plotly_json
        from fegear.output.report.blocks import DataTable, Plot
        from fegear.output.report.page import fragment
        from fegear.studies.comparison.compare import compare, side_of
        from fegear.studies.comparison.drawn import comparison_figures

        found = compare(side_of(self._results(job.first), "pinned"), side_of(self._results(job.second), "now"), 1e-9)
        figures = comparison_figures(found)
        page = comparison_page(found)
        sections = [
            (section.title, fragment(block for block in section.blocks if not isinstance(block, (Plot, DataTable))))
            for section in page.sections
        ]
        self._say(
            "compared",
            sections=[(title, html) for title, html in sections if html],
            figures=[
                {"key": f"compared-{one.key}", "heading": one.heading, "caption": one.caption, **plotly_json(one)}
                for one in figures
            ],
            darker=darker(figures),
        )

    def _design(self, job: Design) -> None:
        results = self._results(design_asked(job.asked, job.pair, job.how))
        self._say("designed", **designed(results, job.pair, job.how))


def _is_stop(to: Newer) -> bool:
    """What is asked for beside the case is finished before another case, and given up for none."""
    return isinstance(to, Stop)


def _load() -> None:
    """Load what every case needs, while the page opens."""
    import fegear.case.built.tooth_influence
    import fegear.engine.run
    import fegear.output.draw_plotly
    import fegear.results.catalogue
    from fegear.output.report.page import templates

    templates()
    import fegear.contact.plane.root_stress_history
    import fegear.contact.plane.transmission_error
    import fegear.design.relief_design
    import fegear.fem.plane.table  # noqa: F401  (loaded ahead)

    gc.freeze()  # what is loaded stays: the collector need not look through it again and again


def serve(connection: Connection, folder: str) -> None:
    """Entry of the process, once it has settled."""
    tempfile.tempdir = folder  # so that nothing of it is left where it is stopped
    Worker(connection, Path(folder)).serve()
