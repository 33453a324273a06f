"""Loaded pairs for the results that ask something of them: which there are, who makes them, what their figures share.

A kind of pair is one row here: `PLANE` and `WIDE`. A result that stands on `LoadedTeeth` takes subjects, needs, checks
and effects from here and knows no kind.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, Self, cast

from fegear.base.effects import PLANE_EFFECTS, ROOT_EFFECTS, WIDE_EFFECTS
from fegear.case.built.members import gear_name
from fegear.case.built.neglected_effects import neglected_remarks
from fegear.case.built.odd_gears import odd_gears_of
from fegear.case.built.pair_checks import check_relief
from fegear.case.built.solid_influence import flank_pairs
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.load_words import load_words
from fegear.engine.stage import Stage, Task, Upstream
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.results.gear.path_marks import path_marks
from fegear.results.gear.solved_gear import needs_solid_solution, needs_solution

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fegear.base.arrays import Array
    from fegear.case.effects import EffectsPart
    from fegear.case.reading import Scene
    from fegear.contact.loaded_teeth import Answer
    from fegear.contact.loaded_teeth import LoadedTeeth as LoadedTeeth  # noqa: PLC0414  (for the window)
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.engine.figure.items import Mark

#: Abscissa of figures over one base pitch.
BASE_PITCH = Axis("mesh position over one base pitch", "mm")


@dataclass(frozen=True)
class AskedOfTeeth:
    """A pair that is to be loaded, and what is asked about it besides.

    Parameters
    ----------
    spec : PairSpec
    estimates, neglected : bool
        Whether errors and neglected effects are estimated.
    effects : EffectsPart
        All of the case, for remedies.
    tolerance : float
        That the sizes of neglected effects are compared with.
    notes : tuple of str
        What is assumed of it.
    answers : tuple of str
        What the results stand on that read the pair: these sizes are of it.
    loads : tuple of float
        For which they are estimated [N].
    """

    spec: PairSpec
    estimates: bool
    neglected: bool
    effects: EffectsPart = field(compare=False)
    tolerance: float = field(compare=False)
    notes: tuple[str, ...] = field(compare=False)
    answers: tuple[Answer, ...] = ()
    loads: tuple[float, ...] = ()

    @property
    def name(self) -> str:
        """Of the pair."""
        return self.spec.name

    @classmethod
    def of(cls, scene: Scene, spec: PairSpec, notes: tuple[str, ...]) -> Self:
        """What a scene asks."""
        case = scene.case
        return cls(spec, scene.estimates, scene.sizes_neglected, case.effects, case.accuracy.tolerance, notes)

    def neglected_notes(self, teeth: LoadedTeeth) -> tuple[str, ...]:
        """Effects that are off and change the answers by more than the tolerance."""
        return neglected_remarks(
            self.spec.name, teeth.neglected, self.effects, self.tolerance, teeth.nominal, load_words
        )


def plane_pairs(scene: Scene) -> tuple[str, ...]:
    """All pairs of plane teeth that carry a load; all of them where none does, so that the missing load is reported."""
    pairs = scene.plane_pairs
    loaded = tuple(name for name, pair in pairs.items() if scene.case.pair[name].normal_load(pair) is not None)
    return loaded or tuple(pairs)


def wide_pairs(scene: Scene) -> tuple[str, ...]:
    """All pairs with a width that carry a load; all of them where none does, so that the missing load is reported."""
    return tuple(name for name in flank_pairs(scene) if name in scene.wide_pairs) or tuple(scene.wide_pairs)


def solid_pairs(scene: Scene) -> tuple[str, ...]:
    """Those of solid gears."""
    return tuple(name for name in wide_pairs(scene) if scene.width_of(name) == "solid")


def _fine(_scene: Scene, _name: str) -> None:
    return None


@dataclass(frozen=True)
class Kind:
    """How pairs of one kind are loaded.

    Parameters
    ----------
    stage : str
        That makes them.
    effects : tuple of str
        That change them.
    check : callable
        What results of such a pair refuse besides what its maker refuses.
    solutions : callable
        Gears to the tasks that solve them.
    """

    stage: str
    effects: tuple[str, ...]
    solutions: Callable[..., tuple[Task, ...]]
    check: Callable[[Scene, str], None] = _fine


PLANE = Kind("loaded-pair", (*PLANE_EFFECTS, *ROOT_EFFECTS), needs_solution, check_relief)
#: Stage of plane pairs with odd teeth, whose results go over a revolution.
ODD = "odd-pair"
#: That of 3D pairs, with or without odd teeth.
ODD_WIDE = "odd-flanks"
WIDE = Kind("loaded-flanks", WIDE_EFFECTS, needs_solid_solution)


def loaded_pairs(scene: Scene) -> tuple[str, ...]:
    """Subjects of results that stand on loaded pairs of any kind."""
    return (*plane_pairs(scene), *wide_pairs(scene))


def kind_of(scene: Scene, name: str) -> Kind:
    """How a pair is loaded."""
    return WIDE if name in scene.wide_pairs else PLANE


def needs_teeth(scene: Scene, name: str) -> tuple[Task, ...]:
    """The task that makes a loaded pair."""
    return (Task(kind_of(scene, name).stage, name),)


def odd_teeth_task(scene: Scene, name: str) -> Task:
    """The task that loads a pair, a plane one with the odd teeth of its gears, if they have any."""
    kind = kind_of(scene, name)
    return Task(ODD if kind is PLANE and odd_gears_of(scene, name) else kind.stage, name)


def over_revolution_task(scene: Scene, name: str) -> Task:
    """The task that makes a pair ready to be followed over a revolution, also one of 3D gears with odd teeth."""
    return Task(ODD_WIDE, name) if name in scene.wide_pairs else odd_teeth_task(scene, name)


def needs_gears(scene: Scene, name: str) -> tuple[Task, ...]:
    """The tasks that make a loaded pair and solve both of its gears."""
    gears = (gear_name(scene, name, member) for member in MEMBERS)
    return (*needs_teeth(scene, name), *kind_of(scene, name).solutions(*gears))


def check_teeth(scene: Scene, name: str) -> None:
    """Refuse what results of a loaded pair cannot be asked for."""
    kind_of(scene, name).check(scene, name)


def effects_of_teeth(scene: Scene, name: str) -> tuple[str, ...]:
    """Effects that change a pair."""
    return kind_of(scene, name).effects


#: Stage of a result that stands on loaded pairs of any kind.
teeth_stage = partial(
    Stage, subjects=loaded_pairs, needs=needs_teeth, check=check_teeth,
    effects_of=effects_of_teeth,
)  # fmt: skip


def teeth_of(task: Task, data: Any) -> LoadedTeeth | None:
    """The loaded pair that a task computed; None where it is none of its makers."""
    if task.stage not in (PLANE.stage, WIDE.stage, ODD):
        return None
    return cast("LoadedTeeth", data)


def loaded_teeth(upstream: Upstream, name: str) -> LoadedTeeth:
    """What its maker left of a pair, among the tasks that a task needs."""
    made = (teeth_of(task, data) for task, data in upstream.items() if task.subject == name)
    return next(teeth for teeth in made if teeth is not None)


def loaded_pair(upstream: Mapping[Task, object], name: str) -> LoadedPair:
    """A pair of plane teeth, for what is known of these alone."""
    return cast("LoadedPair", upstream[Task(PLANE.stage, name)])


def pair_over_revolution(upstream: Mapping[Task, object], name: str) -> LoadedPair:
    """The same with odd teeth, where its gears have any."""
    odd = Task(ODD, name)
    return cast("LoadedPair", upstream[odd]) if odd in upstream else loaded_pair(upstream, name)


def gears_of(scene: Scene, name: str) -> dict[Member, str]:
    """Names of a pair's gears by member."""
    return {member: gear_name(scene, name, member) for member in MEMBERS}


def pitch_marks(pair: GearPair, x: Array) -> tuple[Mark, ...]:
    """Marks of those points that a roll over one base pitch passes, between the ends of x [m]."""
    low, high = float(x.min()) * 1e3, float(x.max()) * 1e3
    room = 1e-6 * (high - low)
    return tuple(m for m in path_marks(pair) if low - room <= m.at <= high + room)
