"""Stage ``loaded-pair``: compliances, modifications and errors of a pair, for the stages that load it."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from fegear.engine.figure import Axis, Mark, few, ramp
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage, Task
from fegear.models.loaded_pair import MEMBERS, LoadedPair, build_loaded_pair, check_pair, effect_remarks, gear_name
from fegear.models.neglected_effects import pair_remarks
from fegear.models.tooth_influence import solution_remarks, solution_told
from fegear.results import forecasts

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.case.reading import Scene
    from fegear.contact import Engagement, Loaded
    from fegear.contact.engagement import RollGrid
    from fegear.engine.stage import Done, Progress

#: Abscissae of figures.
LINE_OF_ACTION = Axis("position on the line of action from the pitch point", "mm")
BASE_PITCH = Axis("roll position over one base pitch", "mm")
#: How many times the finite-element parts of both gears report that they go on.
_STEPS = 4
#: Effects that load sharing knows.
EFFECTS = ("neighbour_coupling", "hertz", "relief", "spacing_errors", "corner_contact")


def drawn_loads(loads: Sequence[float], nominal: float, word: str = "nominal") -> list[tuple[int, str, str]]:
    """Index, label and role of the loads that are drawn: all, or evenly many with the nominal one."""
    near = min(range(len(loads)), key=lambda i: abs(loads[i] - nominal))
    chosen = few(len(loads), (near,))
    labels = [f"{loads[i]:.5g} N" + (f" ({word})" if loads[i] == nominal and len(loads) > 1 else "") for i in chosen]
    return list(zip(chosen, labels, ramp(len(chosen)), strict=True))


def path_ends(pair: LoadedPair) -> tuple[Mark, ...]:
    """Marks of the ends of the path of contact, beyond which only tip corners touch."""
    p = pair.engagement.pair
    return tuple(Mark("x", x * 1e3) for x in (p.x_start, p.x_end))


def spur_pairs(scene: Scene) -> tuple[str, ...]:
    """All pairs of spur gears that carry a load; all pairs where none does, so that the missing load is told."""
    loaded = tuple(name for name, pair in scene.pairs.items() if scene.case.pair[name].normal_load(pair) is not None)
    return loaded or tuple(scene.pairs)


def needs_pair(_scene: Scene, name: str) -> tuple[Task, ...]:
    """The task of this stage for a pair."""
    return (Task("loaded-pair", name),)


def loaded_pair(done: Done, name: str) -> LoadedPair:
    """What this stage left for a pair."""
    return cast("LoadedPair", done[Task("loaded-pair", name)].data)


def change_by_shifts(pair: LoadedPair, grid: RollGrid, loaded: Loaded) -> list[Loaded]:
    """The same sharing solved again with each compliance off by its error."""
    return [solve_again(other, grid, loaded) for other in pair.shifted]


def solve_again(other: Engagement, grid: RollGrid, loaded: Loaded) -> Loaded:
    """Solve with another engagement's compliances at the same contacts, loads and separations."""
    from fegear.contact import Loaded, RollGrid, share_load

    m = other.compliance.matrices(grid.contacts)
    shared = share_load(m.compliance, loaded.separation, loaded.load, m.log_slope, m.reference_load, m.tilt, m.power)
    return Loaded(RollGrid(grid.x, grid.contacts, m), loaded.load, shared, loaded.separation)


def _run(scene: Scene, name: str, _done: Done, progress: Progress) -> Outcome:
    from fegear.contact.fe_compliance import FiniteElementCompliance

    steps = iter(range(_STEPS))
    pair = build_loaded_pair(scene, name, lambda _title: progress(next(steps, _STEPS) / _STEPS))
    settings: dict[str, object] = {
        "compliance": "; ".join(pair.sources),
        "hertz": scene.case.effects.hertz,
        "neighbour_coupling": scene.case.effects.neighbour_coupling,
        "corner_contact": scene.case.effects.corner_contact,
        "face_width": pair.engagement.compliance.face_width,
        "nominal_load": pair.nominal,
        "loads": list(pair.loads),
    }
    remarks: list[str] = []
    for gear, source in zip(
        (gear_name(scene, name, member) for member in MEMBERS),
        (pair.engagement.compliance.driver, pair.engagement.compliance.driven),
        strict=True,
    ):
        if isinstance(source, FiniteElementCompliance):
            settings[f"gear_{gear}"] = solution_told(source.influence)
            remarks += solution_remarks(scene, gear, source.influence)
    remarks += [*effect_remarks(scene, name), *pair_remarks(scene, pair)]
    return Outcome(pair, (), (), settings, tuple(dict.fromkeys(remarks)))


LOADED_PAIR = Stage(
    name="loaded-pair",
    title="Compliances of a loaded pair",
    results=(),
    subjects=spur_pairs,
    run=_run,
    check=check_pair,
    effects=EFFECTS,
    forecast=forecasts.loaded_pair,
)
