"""Stage ``root-stress-history``: root stress of one tooth of either gear on its way through the mesh."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fegear.engine.citation import Citation
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage
from fegear.geometry.pair import MEMBERS
from fegear.models.pair_checks import check_relief
from fegear.models.pair_inputs import gear_name
from fegear.models.root_stress_source import FINITE_ELEMENTS, check_formulas, root_stress_source
from fegear.results import forecasts
from fegear.results.gear_solution import solution_of
from fegear.results.loaded_pair import EFFECTS, loaded_pair, needs_pair, plane_pairs
from fegear.results.root_stress_parts import (
    cited_sources,
    ending,
    formula_remarks,
    needs_sources,
    seconds_of,
    stress_sources,
    told,
)
from fegear.results.shown_root_stress import stress_figure, stress_table, stress_values
from fegear.results.transmission_error import POSITIONS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.case.reading import Scene
    from fegear.contact.compliance import RootStressInfluence
    from fegear.contact.tooth_stress import ToothStress
    from fegear.engine.stage import Task, Upstream, Work
    from fegear.geometry.pair import Member
    from fegear.models.loaded_pair import LoadedPair


@dataclass(frozen=True)
class RootStressData:
    """Root stress of one tooth of either gear by every source, and what formulas say of their values."""

    pair: LoadedPair
    stress: dict[Member, dict[str, ToothStress]]
    notes: dict[Member, dict[str, tuple[str, ...]]]


def _check(scene: Scene, name: str) -> None:
    check_relief(scene, name)
    check_formulas(scene, name, tips=scene.case.effects.corner_contact)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return (*needs_pair(scene, name), *needs_sources(scene, name))


def table_names(scene: Scene, name: str) -> dict[Member, str]:
    """``<pair>_<gear>``; where a gear meshes with its like the driven one's name ends in ``_driven``."""
    names = {member: gear_name(scene, name, member) for member in MEMBERS}
    twins = names["driver"] == names["driven"]
    return {m: f"{name}_{g}" + ("_driven" if twins and m == "driven" else "") for m, g in names.items()}


@dataclass(frozen=True)
class RootStressInputs:
    """What this stage reads.

    Parameters
    ----------
    rate : float or None
        Velocity of the contact along the line of action [m/s], where the case gives a speed.
    sources : tuple of str
        Of root stress; the first is the result.
    coupled, tips : bool
        Whether neighbours' loads count, and whether tip corners touch beyond the path of contact.
    name : str
        Of the pair.
    labels, gears : mapping of str to str
        Names of the tables and of the gears by member.
    estimates : bool
        Whether errors are estimated.
    """

    rate: float | None
    sources: tuple[str, ...]
    coupled: bool
    tips: bool
    name: str = field(compare=False)
    labels: Mapping[Member, str] = field(compare=False)
    gears: Mapping[Member, str] = field(compare=False)
    estimates: bool = True


def _inputs(scene: Scene, name: str) -> RootStressInputs:
    speed = scene.case.pair[name].speed
    rate = None if speed is None else speed * scene.pairs[name].driver.base_radius
    gears, effects = {member: gear_name(scene, name, member) for member in MEMBERS}, scene.case.effects
    sources = stress_sources(scene, name)
    labels = table_names(scene, name)
    coupled, tips = effects.neighbour_coupling, effects.corner_contact
    return RootStressInputs(rate, sources, coupled, tips, name, labels, gears, scene.estimates)


def _compute(asked: RootStressInputs, upstream: Upstream, work: Work) -> RootStressData:
    from fegear.contact.mesh_curve import roll_positions
    from fegear.contact.tooth_stress import loaded_states, tooth_stress, with_peaks

    pair = loaded_pair(upstream, asked.name)
    solved = {} if FINITE_ELEMENTS not in asked.sources else {g: solution_of(upstream, g) for g in asked.gears.values()}
    sources: dict[Member, dict[str, RootStressInfluence]] = {member: {} for member in MEMBERS}
    for member in MEMBERS:
        gear = asked.gears[member]
        for name in asked.sources:
            source: RootStressInfluence = pair.engagement.compliance.source(member)  # knows what was asked before
            if name != FINITE_ELEMENTS or getattr(source, "influence", None) is not solved[gear]:
                source = root_stress_source(
                    name, asked.name, gear, pair.engagement.pair, member, solved, tips=asked.tips
                )  # fmt: skip
            sources[member][name] = source
    x = roll_positions(pair.engagement, POSITIONS)
    x = with_peaks(pair.engagement, pair.nominal, x, {member: (*sources[member].values(),) for member in MEMBERS})
    states = loaded_states(pair.engagement, pair.shifted, pair.loads, x)
    stress: dict[Member, dict[str, ToothStress]] = {}
    notes: dict[Member, dict[str, tuple[str, ...]]] = {}
    for number, member in enumerate(MEMBERS):
        stress[member], notes[member] = {}, {}
        for name, source in sources[member].items():
            stress[member][name] = tooth_stress(pair.engagement, states, member, source, estimates=asked.estimates)
            notes[member][name] = source.remarks
        work.progress((number + 1) / len(MEMBERS))
    return RootStressData(pair, stress, notes)


def _present(data: RootStressData, inputs: RootStressInputs) -> Outcome:
    name, pair = inputs.name, data.pair
    i = pair.loads.index(pair.nominal)
    tables, values = [], []
    for member, label in inputs.labels.items():
        gear = inputs.gears[member]
        tables.append(stress_table(label, gear, data.stress[member], i, inputs.rate, pair.loads))
        for k, (source, s) in enumerate(data.stress[member].items()):
            values += stress_values(f"{name}.{member}", ending(inputs.sources, k), f"gear {gear}, {told(source)}", s, i)
    settings: dict[str, object] = {"root_stress": list(inputs.sources)}
    notes = {inputs.gears[member]: found for member, found in data.notes.items()}
    remarks = formula_remarks(name, notes, coupled=inputs.coupled)
    figure = stress_figure(name, pair.engagement.pair, pair.nominal, data.stress, i, inputs.gears)
    return Outcome(data, tuple(tables), tuple(values), settings, remarks, (figure,))


def _cites(scene: Scene, name: str) -> Iterator[Citation]:
    yield from cited_sources(scene, name)
    yield Citation("mark", "root stress of a tooth on its way through the mesh", "section 3, Appendix B")


def _forecast(scene: Scene, name: str) -> Forecast:
    """Kernels of both gears over the path, those of their neighbours, and the formulas' tables."""
    seconds = 0.25 if scene.case.effects.corner_contact else 0.12
    seconds *= 1.0 if scene.case.effects.neighbour_coupling else 0.3
    return forecasts.constant(seconds + seconds_of(stress_sources(scene, name)))


ROOT_STRESS_HISTORY = Stage(
    subjects=plane_pairs,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    effects=EFFECTS,
    cites=_cites,
    forecast=_forecast,
)
