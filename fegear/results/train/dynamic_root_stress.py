"""Stage ``dynamic-root-stress``: root stress of one tooth of either gear under the forces of the moving train."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.arrays import Array
from fegear.base.effects import RootEffects
from fegear.base.shown import shown, shows
from fegear.case.built.members import gear_name
from fegear.case.built.odd_gears import odd_gears_of
from fegear.case.built.root_stress_sources import FINITE_ELEMENTS, check_formulas, root_stress_source
from fegear.case.built.train import train_part
from fegear.case.reading import Scene
from fegear.dynamics.train.single_tooth import ToothRootStress
from fegear.dynamics.train.tooth_force import ToothForce
from fegear.engine.citation import Citation
from fegear.engine.declared import axis_of
from fegear.engine.sheet.chart import ALL, Bundle, Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS, Member
from fegear.results import forecasts
from fegear.results.forecasts import ROOT_STRESS_CITATIONS
from fegear.results.gear.solved_gear import solid_solution_of, teeth_of
from fegear.results.pair.loaded_teeth import loaded_teeth, needs_gears
from fegear.results.pair.root_stress_data import ending, told
from fegear.results.pair.root_stress_history import (
    cited_sources,
    formula_remarks,
    needs_sources,
    seconds_of,
    stress_sources,
    table_names,
)
from fegear.results.train.gear_train import ORDINARY_ROOTS, RPM, needs_one_speed, own_meshes
from fegear.results.train.tooth_force import ToothForceData, others_of, over_time, rippled

if TYPE_CHECKING:
    from fegear.contact.wide.loaded_pair import LoadedWidePair

#: Seconds of a gear of a 3D pair: two states of the forces, and the errors of both fillets.
_SECONDS_WIDE = 1.0


@dataclass(frozen=True)
class DynamicRootStress:
    """Root stress of one tooth of either gear over the positions of the force, by every source, and their notes."""

    force: ToothForceData
    stress: Mapping[Member, Mapping[str, ToothRootStress]]
    notes: Mapping[Member, Mapping[str, tuple[str, ...]]]


def _check(scene: Scene, name: str) -> None:
    needs_one_speed(scene, name)
    if (pair := train_part(scene).pair_of(name)) not in scene.wide_pairs:
        check_formulas(scene, pair, tips=False)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    pair = train_part(scene).pair_of(name)
    of_teeth = needs_gears(scene, pair) if pair in scene.wide_pairs else needs_sources(scene, pair)
    return (Task("tooth-force", name), *of_teeth)


@dataclass(frozen=True)
class DynamicRootInputs:
    """What the dynamic root stress of a mesh depends on besides forces and influence functions.

    Parameters
    ----------
    speed : float
        Of the body that speeds refer to [rad/s].
    coupled : bool
        Whether the loads of the teeth around count.
    effects : RootEffects
    sources : tuple of str
        Of root stress; the first is the result.
    mesh, pair : str
    gears, labels : mapping of str to str
        Names of the gears, and ends of the tables' names, by member.
    odd : bool
        Whether some of the teeth differ from the others.
    wide : bool
        Whether the gears are 3D.
    halves : int
        2 of a double helical pair, whose teeth are one half.
    """

    speed: float
    coupled: bool
    effects: RootEffects
    sources: tuple[str, ...]
    wide: bool
    halves: int
    mesh: str
    pair: str
    gears: Mapping[Member, str]
    labels: Mapping[Member, str] = field(compare=False)
    odd: bool = field(default=False, compare=False)


def _inputs(scene: Scene, name: str) -> DynamicRootInputs:
    pair = train_part(scene).pair_of(name)
    gears = {member: gear_name(scene, pair, member) for member in MEMBERS}
    labels = {member: label.removeprefix(f"{pair}_") for member, label in table_names(scene, pair).items()}
    effects, speed = scene.case.effects, scene.case.dynamics.one_speed
    coupled, roots, odd = effects.neighbour_coupling, RootEffects.of(effects), bool(odd_gears_of(scene, pair))
    wide = pair in scene.wide_pairs
    sources = (FINITE_ELEMENTS,) if wide else stress_sources(scene, pair)
    return DynamicRootInputs(
        speed, coupled, roots, sources, wide, scene.case.pair[pair].halves, name, pair, gears, labels, odd
    )


def _compute(asked: DynamicRootInputs, upstream: Upstream, work: Work) -> DynamicRootStress:
    data: ToothForceData = upstream[Task("tooth-force", asked.mesh)]
    return (_on_face if asked.wide else _in_plane)(asked, upstream, data, work)


def _on_face(asked: DynamicRootInputs, upstream: Upstream, data: ToothForceData, work: Work) -> DynamicRootStress:
    from fegear.contact.wide.roots_about_load import roots_about_load
    from fegear.dynamics.train.stress_on_face import stress_on_face

    mesh, teeth = data.train.meshes[data.mesh], cast("LoadedWidePair", loaded_teeth(upstream, asked.pair))
    load = mesh.force / asked.halves or teeth.nominal
    stress: dict[Member, dict[str, ToothRootStress]] = {}
    for member, gear in asked.gears.items():
        known = roots_about_load(teeth, member, solid_solution_of(upstream, gear), load)
        stress[member] = {
            FINITE_ELEMENTS: stress_on_face(data.train, data.mesh, known, data.force.x, asked.speed, data.harmonics)
        }
        work.progress((1 + MEMBERS.index(member)) / len(MEMBERS))
    return DynamicRootStress(data, stress, {member: {} for member in MEMBERS})


def _in_plane(asked: DynamicRootInputs, upstream: Upstream, data: ToothForceData, work: Work) -> DynamicRootStress:
    from fegear.dynamics.train.single_tooth import forces_around, tooth_root_stress

    mesh = data.train.meshes[data.mesh]
    solved = {} if FINITE_ELEMENTS not in asked.sources else {g: teeth_of(upstream, g) for g in asked.gears.values()}
    stress: dict[Member, dict[str, ToothRootStress]] = {member: {} for member in MEMBERS}
    notes: dict[Member, dict[str, tuple[str, ...]]] = {member: {} for member in MEMBERS}
    around: dict[int, dict[int, ToothForce]] = {}
    for member in MEMBERS:
        gear, role = asked.gears[member], mesh.role(member)
        for name in asked.sources:
            source = root_stress_source(name, asked.pair, gear, mesh.pair, role, solved, tips=False)
            reach = source.reach if asked.coupled else 0
            if reach not in around:
                around[reach] = forces_around(
                    data.train, data.mesh, data.force, data.number, asked.speed, data.harmonics, reach
                )
            stress[member][name] = tooth_root_stress(source, mesh.pair, role, around[reach], asked.effects)
            notes[member][name] = source.remarks
        work.progress((1 + MEMBERS.index(member)) / len(MEMBERS))
    return DynamicRootStress(data, stress, notes)


@dataclass(frozen=True)
class LargestTension:
    """Largest root tension of a gear by one source, and where the contact is."""

    member: Member
    end: str
    meaning: str
    error: float | None
    x: float = shown("mm", "position of the contact on the line of action")
    tension: float = shown("MPa", "maximum root stress (tension side)", name="largest_dynamic_root_tension")


@dataclass(frozen=True)
class SourceStress:
    """Root stress of one gear by one source.

    Parameters
    ----------
    end, by : str
        Of names, and in words.
    about : str
        What follows a label where there are several sources.
    with_others : bool
        Whether the increments of other exciters are drawn.
    """

    found: ToothRootStress
    force: ToothForce
    end: str
    by: str
    about: str
    role: str
    first: bool
    with_others: bool

    @property
    @shows("mm", "position of the tooth pair on the line of action")
    def x(self) -> Array:
        """[m]."""
        return self.force.x

    @property
    def error(self) -> Array | None:
        """Where the source knows it [Pa]."""
        return None if np.isnan(self.found.error).any() else self.found.error

    def tension(self, member: Member, gear: str, end: str, about: str, of: Array) -> LargestTension:
        """Largest of one sum of its parts."""
        at = int(np.argmax(np.where(np.isnan(of), -np.inf, of)))
        error = None if self.error is None else float(self.error[at] * of[at] / self.found.own[at])
        along = "" if self.found.z is None else f"face position {self.found.z[at] * 1e3:.4g} mm, "
        meaning = f"gear {gear}, {self.by}, {about}{along}contact"
        return LargestTension(member, f"{end}{self.end}", meaning, error, float(self.x[at]), float(np.fmax.reduce(of)))


@dataclass(frozen=True)
class MemberStress:
    """Root stress of one gear."""

    member: Member
    gear: str
    label: str
    sources: list[SourceStress]


@dataclass(frozen=True)
class ShownRootStress:
    """Root stress of both gears as it is tabulated and drawn."""

    made: DynamicRootStress
    asked: DynamicRootInputs

    @property
    def force(self) -> ToothForce:
        """On the tooth pair."""
        return self.made.force.force

    @cached_property
    def members(self) -> list[MemberStress]:
        """Both gears."""
        return [
            MemberStress(member, self.asked.gears[member], self.asked.labels[member], self._sources(found))
            for member, found in self.made.stress.items()
        ]

    def _sources(self, found: Mapping[str, ToothRootStress]) -> list[SourceStress]:
        return [
            SourceStress(
                stress, self.force, ending(self.asked.sources, k), told(source),
                f", {told(source)}" if len(found) > 1 else "", f"series:{k}", k == 0,
                k == 0 and not self.made.force.alone,
            )
            for k, (source, stress) in enumerate(found.items())
        ]  # fmt: skip

    @property
    def largest(self) -> list[LargestTension]:
        """Of both gears by every source: with, at any phase of, and without what else excites the train."""
        train, found = self.made.force.train, []
        others = others_of(train)
        for member in self.members:
            for source in member.sources:
                s, words = source.found, (member.member, member.gear)
                if self.made.force.alone:
                    found.append(source.tension(*words, "", "", s.total))
                    continue
                found += [
                    source.tension(*words, "", f"all meshes{rippled(train)}, at the phases of the case, ", s.total),
                    source.tension(*words, "_any_phase", f"upper bound over all phases of {others}, ", s.any_phase),
                    source.tension(*words, "_own_mesh", f"without {others}, ", s.own),
                ]
        return found


_SHEET = Sheet(
    name=lambda asked: str(asked.mesh),
    of=ShownRootStress,
    tables=(
        Rows(
            "root_stress_history_{name}_{one.label}",
            "Dynamic root stress of gear {one.gear} as {one.member}, mesh {name}",
            (
                Cell("time", of=lambda seen: seen.data.force), Cell("x", of=lambda seen: seen.data.force),
                Each(
                    "sources",
                    Cell(
                        "found.total", name="stress{one.end}",
                        meaning="maximum root stress (tension side) by {one.by}, excited by all meshes",
                    ),
                    Cell("found.own", name="stress_own_mesh{one.end}"),
                    Cell("found.static", name="static_stress{one.end}"),
                    Cell(
                        "found.error", "error", name="stress_error{one.end}",
                        meaning="estimated error of {one.by} in stress_own_mesh{one.end}",
                    ),
                    Cell("found.z"),
                    Cell("found.static_z"),
                ),
            ),
            each="members",
        ),
    ),
    values=(
        Number(
            "tension", "error", owner="{name}.{one.member}", name="largest_dynamic_root_tension{one.end}",
            meaning="{one.meaning} at x = {one.x:.5g}", each="largest",
        ),
    ),
    figures=(
        Chart(
            "dynamic_root_stress_{name}", "Dynamic root stress of mesh {name}",
            "Mesh {name}: root stress of one tooth of each gear over the engagement, with and without vibration. A to "
            "E: points of the path of contact.",
            (
                Over(
                    lambda seen: over_time(seen.data.force),
                    (
                        Bundle(
                            Family("sources", role="{one.role}", most=ALL),
                            (
                                Line("found.own", "static and own increment{one.about}"),
                                Line(
                                    "found.total",
                                    lambda seen: f"with {others_of(seen.data.made.force.train)}{seen.one.about}",
                                    "with other meshes", look={"width": 1.2}, when="with_others",
                                ),
                                Line("found.static", "quasi-static{one.about}", "static", when="first"),
                            ),
                        ),
                    ),
                    lambda _seen: axis_of(ToothRootStress, "total", zero=True),
                    lambda seen: seen.data.made.force.letters, title="Gear {one.gear} as {one.member}", each="members",
                ),
            ),
            under=lambda seen: f"{seen.asked.speed * RPM:.6g} rpm",
        ),
    ),
    remarks=(
        Remark(ORDINARY_ROOTS, when=lambda seen: seen.asked.odd),
        lambda seen: formula_remarks(
            seen.asked.pair, {seen.asked.gears[member]: found for member, found in seen.data.made.notes.items()},
            coupled=seen.asked.coupled,
        ),
    ),
    settings={"root_stress": lambda seen: list(seen.asked.sources)},
)  # fmt: skip


def _forecast(scene: Scene, name: str) -> Forecast:
    """Root stress from influence functions or formulas, and the neighbours' forces."""
    if train_part(scene).pair_of(name) in scene.wide_pairs:
        return forecasts.constant(2.0 * _SECONDS_WIDE)
    sources = stress_sources(scene, train_part(scene).pair_of(name))
    return forecasts.constant((0.12 if scene.case.effects.neighbour_coupling else 0.04) + seconds_of(sources))


def _cites(scene: Scene, name: str) -> Iterator[Citation]:
    yield Citation("mark", "root stress of a single tooth in motion", "Eq. 3.37")
    pair = train_part(scene).pair_of(name)
    yield from ROOT_STRESS_CITATIONS[FINITE_ELEMENTS] if pair in scene.wide_pairs else cited_sources(scene, pair)


DYNAMIC_ROOT_STRESS = Stage(
    holds=("root-stress-history",),
    subjects=own_meshes,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
