"""Stage ``root-stress-history``: root stress of one tooth of either gear on its way through the mesh.

What the results of root stress share: where ``pair.NAME.root_stress`` takes it from, and how that is told.

Tables, values and figure of root stress on a tooth's way through the mesh, in the plane and over the face.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.loaded_pair import check_relief
from fegear.case.built.pair_inputs import FINITE_ELEMENTS, check_formulas, gear_name, root_stress_source
from fegear.engine.citation import Citation
from fegear.engine.figure.figure import Axis, Figure, Panel
from fegear.engine.figure.items import Curve, Mark
from fegear.engine.outcome import Outcome, Value
from fegear.engine.stage import Forecast, Stage
from fegear.engine.table import Column, Table
from fegear.geometry.pair import MEMBERS
from fegear.results import forecasts
from fegear.results.forecasts import ROOT_STRESS_CITATIONS
from fegear.results.gear.drawing import path_marks
from fegear.results.gear.stiffness import needs_solution, solution_of
from fegear.results.pair.loaded_pair import EFFECTS, loaded_pair, needs_pair, plane_pairs
from fegear.results.pair.transmission_error import POSITIONS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.case.built.loaded_pair import LoadedPair
    from fegear.case.reading import Scene
    from fegear.contact.plane.compliance import RootStressInfluence
    from fegear.contact.plane.tooth_stress import ToothStress
    from fegear.engine.stage import Task, Upstream, Work
    from fegear.geometry.pair import GearPair, Member


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
    from fegear.contact.plane.tooth_stress import loaded_states, tooth_stress, with_peaks
    from fegear.contact.plane.transmission_error import roll_positions

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


#: Seconds of a formula's table over one flank; those that look for a place on the trochoid take longer.
_FORMULA_SECONDS = {"cornell-trochoid": 0.2, "heywood": 0.15, "agma-908": 0.12, "dolan-broghamer": 0.1}


def stress_sources(scene: Scene, pair: str) -> tuple[str, ...]:
    """Names of a pair's sources of root stress; the first is the result, the others stand beside it."""
    return scene.case.pair[pair].root_stress.source


def needs_sources(scene: Scene, pair: str) -> tuple[Task, ...]:
    """The finite-element solutions that they ask for."""
    part = scene.case.pair[pair]
    return needs_solution(part.driver, part.driven) if FINITE_ELEMENTS in part.root_stress.source else ()


def cited_sources(scene: Scene, pair: str) -> Iterator[Citation]:
    """What they rest on."""
    for source in stress_sources(scene, pair):
        yield from ROOT_STRESS_CITATIONS[source]


def seconds_of(sources: tuple[str, ...]) -> float:
    """What the formulas among them take for both gears."""
    return 2.0 * sum(_FORMULA_SECONDS.get(source, 0.03) for source in sources if source != FINITE_ELEMENTS)


def ending(sources: tuple[str, ...], k: int) -> str:
    """What the names of columns and values of the k-th source end in: nothing for the first."""
    return f"_{sources[k].replace('-', '_')}" if k else ""


def told(source: str) -> str:
    """A source in words."""
    return "finite elements" if source == FINITE_ELEMENTS else source


def formula_remarks(pair: str, notes: Mapping[str, Mapping[str, tuple[str, ...]]], *, coupled: bool) -> tuple[str, ...]:
    """What formulas say of their own values, and that they leave the neighbours' loads out where those count.

    Parameters
    ----------
    pair : str
    notes : mapping of str to mapping of str to tuple of str
        What each source says of itself, by gear and source.
    coupled : bool
        Whether the case counts the loads of neighbouring teeth.
    """
    remarks = [
        f"Pair {pair}, gear {gear}, root stress by {source}: {note}."
        for gear, sources in notes.items()
        for source, found in sources.items()
        for note in found
    ]
    alone = dict.fromkeys(source for found in notes.values() for source in found if source != FINITE_ELEMENTS)
    if coupled and alone:
        remarks.append(f"Pair {pair}: root stress by {', '.join(alone)} is that of a tooth's own load alone.")
    return tuple(remarks)


def stress_table(
    name: str,
    gear: str,
    found: Mapping[str, ToothStress],
    i: int,
    rate: float | None,
    loads: tuple[float, ...],
    more: tuple[Column, ...] = (),
) -> Table:
    """One tooth of a gear by every source, at load `i` and the others; `rate` [m/s] makes a time of its way."""
    sources = tuple(found)
    first = found[sources[0]]
    columns = [Column("x", first.x, "mm", "position of the tooth's contact on the line of action")]
    if rate is not None:
        columns.insert(0, Column("t", (first.x - first.x[0]) / rate, "s", "from the first position"))
    for k, (source, s) in enumerate(found.items()):
        end = ending(sources, k)
        meaning = f"largest tangential tension of the fillet below the loaded flank, by {told(source)}"
        columns.append(Column(f"stress{end}", s.tension[:, i], "MPa", meaning))
        if s.compression is not None:
            columns.append(
                Column(f"compression{end}", s.compression[:, i], "MPa", "most negative stress of the other fillet")
            )
        if not np.isnan(s.tension_error).any():
            columns.append(
                Column(f"stress_error{end}", s.tension_error[:, i], "MPa", f"estimated error of stress{end}")
            )
        for j, load in enumerate(loads):
            if j != i:
                head = f"stress{end} at {load:.6g} N"
                columns.append(Column(head, s.tension[:, j], "MPa", f"as stress{end}, under this load"))
    return Table(f"root_stress_history_{name}", (*columns, *more), f"Root stress of a tooth of gear {gear} in the mesh")


def stress_values(of: str, end: str, by: str, s: ToothStress, i: int) -> list[Value]:
    """Largest stresses by one source, under load `i`."""
    worst = int(np.argmax(s.tension[:, i]))
    error = float(s.tension_error[worst, i])
    values = [
        Value(
            f"{of}.largest_root_tension{end}", float(s.tension[worst, i]), "MPa", None if np.isnan(error) else error,
            f"{by}, contact at x = {s.x[worst] * 1e3:.5g} mm",
        ),
        Value(
            f"{of}.root_stress_range{end}", float(np.ptp(s.tension[:, i])), "MPa", None,
            "largest less smallest stress below the loaded flank over the mesh",
        ),
    ]  # fmt: skip
    if s.compression is not None:
        least = int(np.argmin(s.compression[:, i]))
        place = f"{by}, contact at x = {s.x[least] * 1e3:.5g} mm"
        values.insert(
            1, Value(f"{of}.largest_root_compression{end}", float(s.compression[least, i]), "MPa", None, place)
        )
    return values


def stress_figure(
    name: str,
    pair: GearPair,
    load: float,
    stress: Mapping[Member, Mapping[str, ToothStress]],
    i: int,
    gears: Mapping[Member, str],
) -> Figure:
    """Draw the largest stresses of both gears over the way of a tooth at load `i`, which is `load` [N]."""
    curves, largest = [], []
    several = len(stress["driver"]) > 1
    for g, (member, found) in enumerate(stress.items()):
        for k, (source, s) in enumerate(found.items()):
            label = f"{member} {gears[member]}" + (f", {told(source)}" if several else "")
            tension, error = s.tension[:, i] * 1e-6, s.tension_error[:, i] * 1e-6
            role = f"series:{g + 2 * k}" if k else member
            curves.append(
                Curve(s.x * 1e3, tension, f"{label}, tension", role, None if np.isnan(error).any() else error)
            )
            if s.compression is not None:
                style = f"{member} compression"
                curves.append(Curve(s.x * 1e3, s.compression[:, i] * 1e-6, f"{label}, compression", style, width=1.2))
            largest.append(f"{tension.max():.4g} MPa ({member}{f', {told(source)}' if several else ''})")
    x = Axis("position of the tooth's contact on the line of action", "mm")
    return Figure(
        f"root_stress_history_{name}",
        f"Root stress through the mesh of pair {name}",
        f"Pair {name} at {load:.5g} N: fillet stress of one tooth; by finite elements its own load's and its "
        f"neighbours' added. A to E: points of the path of contact. Largest tension {' and '.join(largest)}.",
        (Panel(x, Axis("largest root stress", "MPa"), tuple(curves), (*path_marks(pair), Mark("y", 0.0))),),
        under=f"{load:.5g} N",
    )


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
