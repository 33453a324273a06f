"""A computing stage: what it provides, for which part of a scene, and what it needs first."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from fegear.engine.progress import Progress

if TYPE_CHECKING:
    from fegear.base.solution_cache import SolutionCache
    from fegear.case.reading import Scene
    from fegear.engine.citation import Citation, Cites
    from fegear.engine.executor import Executor
    from fegear.engine.outcome import Outcome


P = TypeVar("P")


class Task(NamedTuple):
    """A stage applied to one gear, pair or train of the scene; the subject is empty where there is only one."""

    stage: str
    subject: str = ""

    def __str__(self) -> str:
        """``stage of subject``."""
        return f"{self.stage} of {self.subject}" if self.subject else self.stage


#: What the tasks that a task needs have computed, by task.
Upstream = Mapping[Task, Any]


@dataclass(frozen=True, slots=True)
class Work:
    """What is handed to a computation besides its inputs; none of it changes a number.

    Parameters
    ----------
    progress : Progress
        Where it reports how far it is.
    cache : SolutionCache
        Where it keeps solutions of its own parts (tooth shapes, points of a chart).
    executor : Executor
        Who computes points that do not depend on each other.
    """

    progress: Progress
    cache: SolutionCache
    executor: Executor


@dataclass(frozen=True, slots=True)
class Subject:
    """Inputs of a stage that reads nothing of the case: all comes from the tasks before it.

    Parameters
    ----------
    name : str
        Of the gear, pair or train, for the names of its tables.
    """

    name: str = field(compare=False)

    @classmethod
    def of(cls, _scene: Scene, name: str) -> Subject:
        """As `Stage.inputs`."""
        return cls(name)


@dataclass(frozen=True)
class Reads(Generic[P]):
    """Inputs of a stage that are one table of the case as it is, for one gear, pair or mesh.

    Parameters
    ----------
    part : Part
    name : str
        Of the subject; part of the key, for several meshes of a train may read the same table.
    """

    part: P
    name: str

    @staticmethod
    def of(table: Callable[[Scene], P]) -> Callable[[Scene, str], Reads[P]]:
        """As `Stage.inputs`: ``Reads.of(lambda scene: scene.case.dynamics)``."""
        return lambda scene, name: Reads(table(scene), name)


class Need(NamedTuple):
    """An effect without which a stage has no meaning.

    Attributes
    ----------
    effect : str
        Its key under ``[effects]``.
    reason : str
        Clause that says why: "it is what the tooth force rises above the load by".
    results : tuple of str
        The wanted results that need it; empty if the stage itself does.
    """

    effect: str
    reason: str
    results: tuple[str, ...] = ()


class Forecast(NamedTuple):
    """What can be said of a task before it runs.

    Attributes
    ----------
    settings : mapping
        Settings that it will use, plain numbers and texts.
    seconds : float or None
        What it will take, alone on one core of a usual machine; None where it is unknown.
    shapes : mapping
        Seconds of the gear shapes that it solves besides, unless an earlier task has solved them, by shape.
    """

    settings: Mapping[str, object] = MappingProxyType({})
    seconds: float | None = None
    shapes: Mapping[object, float] = MappingProxyType({})


def _nothing(_scene: Scene, _subject: str) -> tuple[Task, ...]:
    return ()


def _fine(_scene: Scene, _subject: str) -> None:
    return None


def _uncited(_scene: Scene, _subject: str) -> tuple[Citation, ...]:
    return ()


def _unknown(_scene: Scene, _subject: str) -> Forecast:
    return Forecast()


@dataclass(frozen=True, slots=True)
class Stage:
    """One kind of computation.

    Parameters
    ----------
    subjects : callable
        ``subjects(scene)`` -> names it will be done for when asked for by name.
    inputs : callable
        ``inputs(scene, subject)`` -> a frozen dataclass of all that the result reads of the case, files included.
        Its content is the key under which the result is remembered; names that only appear in words are fields with
        ``compare=False``.
    compute : callable
        ``compute(inputs, upstream, work)`` -> the numerical result; `upstream` holds what the needed tasks computed.
    present : callable
        ``present(data, inputs)`` -> `Outcome`: tables, values, figures and remarks. It computes nothing of weight.
    needs : callable
        ``needs(scene, subject)`` -> tasks that must run first.
    check : callable
        ``check(scene, subject)`` raises `InputError` when the scene lacks something the stage cannot do without.
    effects_of : callable or None
        ``effects_of(scene, subject)`` -> those of its `effects` that change it for this subject; None where all do.
    forecast : callable
        ``forecast(scene, subject)`` -> `Forecast`, for ``fegear plan``.
    cites : callable
        ``cites(scene, subject)`` -> what the result rests on.
    internal : bool
        Whether it takes internal gears and pairs; a plan refuses those of other stages. Given by the catalogue, by the
        stage itself where another distribution adds it.
    asymmetric : bool
        The same of teeth with two different flanks.
    generated : bool
        Whether it needs fillets as a tool generates them; a plan refuses others there.
    why_external : str
        Why it does not.
    holds : tuple of str
        Results whose tables and numbers it has, too, so that a plan refuses both.
    instead_of : tuple of str
        Stages that would write the same tables of the same subject, so that a plan refuses both.
    answers : tuple of str
        Answers of loaded pairs that the result stands on (`fegear.contact.loaded_teeth.Answer`): for these, the pairs
        under it estimate what they neglect.
    every_load : bool
        Whether it is for every load of a pair, not for the nominal one alone.
    for_readers : callable or None
        ``for_readers(inputs, readers)`` -> the inputs with what the stages ask of it that read the task in a plan, at
        first hand or not; None where nothing depends on who reads it.
    in_points : bool
        Whether it consists of points that other processes, or a cluster, can compute.
    name, title, results, about, extra : str, str, tuple of str, str, str
        What it is called: given by the catalogue, see `Entry`.
    effects : tuple of str
        Effects that change what it computes: given by the catalogue.
    requires : tuple of Need
        Effects that must be on: given by the catalogue.
    """

    subjects: Callable[[Scene], tuple[str, ...]]
    inputs: Callable[[Scene, str], Any]
    compute: Callable[[Any, Upstream, Work], Any]
    present: Callable[[Any, Any], Outcome]
    needs: Callable[[Scene, str], tuple[Task, ...]] = _nothing
    check: Callable[[Scene, str], None] = _fine
    effects_of: Callable[[Scene, str], tuple[str, ...]] | None = None
    forecast: Callable[[Scene, str], Forecast] = _unknown
    cites: Cites = _uncited
    internal: bool = False
    asymmetric: bool = False
    generated: bool = False
    why_external: str = ""
    holds: tuple[str, ...] = ()
    instead_of: tuple[str, ...] = ()
    answers: tuple[str, ...] = ()
    every_load: bool = False
    for_readers: Callable[[Any, Sequence[Stage]], Any] | None = None
    in_points: bool = False
    name: str = ""
    title: str = ""
    results: tuple[str, ...] = ()
    about: str = ""
    extra: str = ""
    effects: tuple[str, ...] = ()
    requires: tuple[Need, ...] = ()

    def effects_on(self, scene: Scene, subject: str) -> tuple[str, ...]:
        """Effects that change what it computes for a subject."""
        if self.effects_of is None:
            return self.effects
        return tuple(effect for effect in self.effects_of(scene, subject) if effect in self.effects)
