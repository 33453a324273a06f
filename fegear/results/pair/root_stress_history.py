"""Stage ``root-stress-history``: root stress of one tooth of either gear on its way through the mesh.

What the results of root stress share: where ``pair.NAME.root_stress`` takes it from, and how that is reported.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.case.built.pair_inputs import FINITE_ELEMENTS, check_formulas, gear_name, root_stress_source
from fegear.engine.citation import Citation
from fegear.engine.declared import axis_of, column_of, columns_of, curve_of, error_column, value_of
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import HeatMap, Mark
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Task, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.pair import MEMBERS, Member
from fegear.results import forecasts
from fegear.results.forecasts import ROOT_STRESS_CITATIONS
from fegear.results.gear.drawing import path_marks
from fegear.results.gear.solved_gear import needs_solution, solid_solution_of, solution_of
from fegear.results.pair.loaded_teeth import (
    check_teeth,
    gears_of,
    loaded_pair,
    loaded_teeth,
    needs_gears,
    needs_teeth,
    teeth_stage,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.case.reading import Scene
    from fegear.contact.loaded_teeth import LoadedTeeth, RootStressInMesh
    from fegear.contact.plane.tooth_stress import ToothStress
    from fegear.contact.wide.root_stress import StressOverFace
    from fegear.fem.plane.influence import Side

#: Of a pair with a width: seconds to begin with, and of a roll position, both gears and both solutions, for each load.
_WIDE, _WIDE_POSITION = 0.5, 0.05
#: Points of a map over the way of the tooth and along the face.
_ACROSS, _ALONG = 181, 81


@dataclass(frozen=True)
class RootStressData:
    """The loaded teeth, and the root stress of one tooth of either gear in the mesh."""

    teeth: LoadedTeeth
    found: RootStressInMesh


@dataclass(frozen=True)
class RootStressInputs:
    """What this stage reads.

    Parameters
    ----------
    rate : float or None
        Velocity of the contact along the line of action [m/s], where the case gives a speed.
    sources : tuple of str
        Of root stress; the first is the result. None are named for pairs with a width: that is finite elements.
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


def table_names(scene: Scene, name: str) -> dict[Member, str]:
    """``<pair>_<gear>``; where a gear meshes with its like the driven one's name ends in ``_driven``."""
    names = {member: gear_name(scene, name, member) for member in MEMBERS}
    twins = names["driver"] == names["driven"]
    return {m: f"{name}_{g}" + ("_driven" if twins and m == "driven" else "") for m, g in names.items()}


def _inputs(scene: Scene, name: str) -> RootStressInputs:
    speed, effects = scene.case.pair[name].speed, scene.case.effects
    rate = None if speed is None else speed * scene.pairs[name].driver.base_radius
    sources = () if name in scene.wide_pairs else stress_sources(scene, name)
    return RootStressInputs(
        rate, sources, effects.neighbour_coupling, effects.corner_contact, name, table_names(scene, name),
        gears_of(scene, name), scene.estimates,
    )  # fmt: skip


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    if name in scene.wide_pairs:
        return needs_gears(scene, name)
    return (*needs_teeth(scene, name), *needs_sources(scene, name))


def _sources(asked: RootStressInputs, upstream: Upstream) -> dict[Member, dict[str, Any]]:
    """Where root stress comes from: the gears' solids, or what the case names for plane teeth."""
    if not asked.sources:
        return {member: {FINITE_ELEMENTS: solid_solution_of(upstream, gear)} for member, gear in asked.gears.items()}
    pair = loaded_pair(upstream, asked.name)
    solved = {} if FINITE_ELEMENTS not in asked.sources else {g: solution_of(upstream, g) for g in asked.gears.values()}
    sources: dict[Member, dict[str, Any]] = {member: {} for member in MEMBERS}
    for member, gear in asked.gears.items():
        for name in asked.sources:
            source: Any = pair.engagement.compliance.source(member)  # knows what was asked before
            if name != FINITE_ELEMENTS or getattr(source, "influence", None) is not solved[gear]:
                source = root_stress_source(name, asked.name, gear, pair.pair, member, solved, tips=asked.tips)
            sources[member][name] = source
    return sources


def _compute(asked: RootStressInputs, upstream: Upstream, work: Work) -> RootStressData:
    teeth = loaded_teeth(upstream, asked.name)
    found = teeth.root_stress(_sources(asked, upstream), work.progress, estimates=asked.estimates)
    return RootStressData(teeth, found)


def _present(data: RootStressData, inputs: RootStressInputs) -> Outcome:
    name, teeth, found = inputs.name, data.teeth, data.found
    i = teeth.loads.index(teeth.nominal)
    tables, values = [], []
    for member, label in inputs.labels.items():
        gear, of, over = inputs.gears[member], f"{name}.{member}", found.over_face.get(member)
        more = () if over is None else _places(over)
        tables.append(_stress_table(label, gear, found.stress[member], i, inputs.rate, teeth.loads, more))
        if over is not None:
            tables.append(_over_face(label, gear, over))
        for k, (source, s) in enumerate(found.stress[member].items()):
            by = told(source) if over is None else _where(s, over, i)
            values += _stress_values(of, ending(inputs.sources, k), f"gear {gear}, {by}", s, i)
        values += _across_the_root(of, gear, found.across.get(member))
    notes = {inputs.gears[member]: said for member, said in found.notes.items()}
    remarks = formula_remarks(name, notes, coupled=inputs.coupled)
    remarks += (_direction(data, name, i),) if found.across else ()
    figures = [_stress_figure(name, data, i, inputs.gears)]
    settings: dict[str, object] = {"root_stress": list(inputs.sources)}
    if found.over_face:
        settings = {"places_along_the_face": int(found.over_face["driver"]["tension"].z.size)}
        figures.append(_map(name, teeth.nominal, found.over_face, inputs.gears))
    return Outcome(data, tuple(tables), tuple(values), settings, remarks, tuple(figures))


def _check(scene: Scene, name: str) -> None:
    check_teeth(scene, name)
    if name not in scene.wide_pairs:
        check_formulas(scene, name, tips=scene.case.effects.corner_contact)


def _cites(scene: Scene, name: str) -> Iterator[Citation]:
    yield from ROOT_STRESS_CITATIONS[FINITE_ELEMENTS] if name in scene.wide_pairs else cited_sources(scene, name)
    yield Citation("mark", "root stress of a tooth on its way through the mesh", "section 3, Appendix B")


def _forecast(scene: Scene, name: str) -> Forecast:
    """Kernels of both gears over the path, those of their neighbours, and the formulas' tables."""
    if name in scene.wide_pairs:
        positions, loads = scene.case.load_distribution.positions, forecasts.loads(scene, name)
        return Forecast({"positions": positions, "loads": loads}, _WIDE + _WIDE_POSITION * positions * loads)
    seconds = 0.25 if scene.case.effects.corner_contact else 0.12
    seconds *= 0.5 * math.ceil(scene.pairs[name].contact_ratio) if scene.case.effects.neighbour_coupling else 0.3
    return forecasts.constant(seconds + seconds_of(stress_sources(scene, name)))


#: Seconds of a formula's table over one flank; those that look for a place on the trochoid take longer.
_FORMULA_SECONDS = {"cornell-trochoid": 0.2, "heywood": 0.15, "agma-908": 0.12, "dolan-broghamer": 0.1}


def stress_sources(scene: Scene, pair: str) -> tuple[str, ...]:
    """Names of a pair's sources of root stress; the first is the result, the others are compared with it."""
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


def _stress_table(
    name: str,
    gear: str,
    found: Mapping[str, ToothStress],
    i: int,
    rate: float | None,
    loads: tuple[float, ...],
    more: tuple[Column, ...],
) -> Table:
    """One tooth of a gear by every source, at load `i` and the others; `rate` [m/s] makes a time of its way."""
    sources = tuple(found)
    first = found[sources[0]]
    columns = [*columns_of(first, "x")]
    if rate is not None:
        columns.insert(0, Column("t", (first.x - first.x[0]) / rate, "s", "from the first position"))
    for k, (source, s) in enumerate(found.items()):
        end = ending(sources, k)
        tension = column_of(s, "tension", load=i, name=f"stress{end}")
        tension = replace(tension, meaning=f"{tension.meaning}, by {told(source)}")
        columns.append(tension)
        if s.compression is not None:
            columns.append(column_of(s, "compression", load=i, name=f"compression{end}"))
        if s.knows_error:
            error = s.tension_error[:, i]
            columns.append(replace(error_column(tension, error), name=f"stress_error{end}"))
        for j, load in enumerate(loads):
            if j != i:
                head, meaning = f"stress{end} at {load:.6g} N", f"as stress{end}, under this load"
                columns.append(column_of(s, "tension", load=j, name=head, meaning=meaning))
    return Table(f"root_stress_history_{name}", (*columns, *more), f"Root stress of a tooth of gear {gear} in the mesh")


def _stress_values(of: str, end: str, by: str, s: ToothStress, i: int) -> list[Value]:
    """Largest stresses by one source, under load `i`."""

    def value(key: str, error: float | None = None, at: int | None = None) -> Value:
        where = "" if at is None else f"{by}, contact at x = {s.x[at] * 1e3:.5g} mm"
        found = value_of(s, key, of, error, load=i, meaning=where)
        return replace(found, name=f"{found.name}{end}")

    if np.isnan(s.tension[:, i]).all():
        return []
    pressed = [] if s.compression is None else [
        value("largest_compression", s.compression_off(i), s.largest_pressed(i))
    ]  # fmt: skip
    return [value("largest_tension", s.error(i), s.worst(i)), *pressed, value("tension_range", s.range_off(i))]


def _places(over: Mapping[Side, StressOverFace]) -> tuple[Column, ...]:
    tension, along = over["tension"], "where stress is largest along the face, from its middle"
    (_, pull, radius), (_, press, _) = tension.largest(1.0), over["compression"].largest(-1.0)
    return (
        column_of(tension, "z", pull, name="stress_face_position", meaning=along),
        column_of(tension, "radius", radius, name="stress_radius", meaning="and its distance from the axis"),
        column_of(tension, "z", press, name="compression_face_position",
                  meaning="where compression is largest along the face"),
    )  # fmt: skip


def _where(stress: ToothStress, over: Mapping[Side, StressOverFace], i: int) -> str:
    z = float(over["tension"].largest(1.0)[1][stress.worst(i)])
    return f"largest tension at face position {z * 1e3:.4g} mm"


def _over_face(label: str, gear: str, over: Mapping[Side, StressOverFace]) -> Table:
    """Every place along the face at every position of the tooth, at the nominal load."""
    pull, press = over["tension"], over["compression"]
    columns = (
        column_of(pull, "x", np.repeat(pull.x, pull.z.size)),
        column_of(pull, "z", np.tile(pull.z, pull.x.size)),
        column_of(pull, "value", pull.value.ravel()),
        column_of(pull, "radius", pull.radius.ravel()),
        column_of(press, "value", press.value.ravel(), name="compression",
                  meaning="most negative stress up the other fillet"),
        column_of(press, "radius", press.radius.ravel(), name="compression_radius"),
    )  # fmt: skip
    return Table(f"root_stress_over_face_{label}", columns, f"Root stress of gear {gear} along its face in the mesh")


def _across_the_root(of: str, gear: str, found: tuple[float, float] | None) -> list[Value]:
    if found is None:
        return []
    value, error = found
    said = f"gear {gear}: largest tension at right angles to the helix, as formulas for the normal section mean it"
    return [Value(f"{of}.largest_root_tension_across", value, "MPa", None if np.isnan(error) else error, said)]


def _direction(data: RootStressData, name: str, i: int) -> str:
    """What the direction of the stress makes of it."""
    largest = {m: next(iter(s.values())).largest_tension[i] for m, s in data.found.stress.items()}
    across = data.found.across.items()
    more = " and ".join(f"{100.0 * (value / largest[m] - 1.0):+.1f} % ({m})" for m, (value, _) in across)
    return (
        f"Pair {name}: root stresses over the mesh and the face are those along the transverse section; the "
        f"largest at right angles to the helix differs by {more}: values largest_root_tension_across."
    )


def _stress_figure(name: str, data: RootStressData, i: int, gears: Mapping[Member, str]) -> Figure:
    """Draw the largest stresses of both gears over the way of a tooth at the nominal load, number `i`."""
    pair, load, stress = data.teeth.pair, data.teeth.nominal, data.found.stress
    curves, largest = [], []
    several = len(stress["driver"]) > 1
    for g, (member, found) in enumerate(stress.items()):
        for k, (source, s) in enumerate(found.items()):
            label = f"{member} {gears[member]}" + (f", {told(source)}" if several else "")
            error, role = s.tension_error[:, i] if s.knows_error else None, f"series:{g + 2 * k}" if k else member
            curves.append(curve_of(s, "x", "tension", f"{label}, tension", role, error, load=i))
            if s.compression is not None:
                pressed = curve_of(s, "x", "compression", f"{label}, compression", f"{member} compression", load=i)
                curves.append(replace(pressed, width=1.2))
            most = float(s.largest_tension[i]) * 1e-6
            if np.isfinite(most):
                largest.append(f"{most:.4g} MPa ({member}{f', {told(source)}' if several else ''})")
    of, marks = type(next(iter(stress["driver"].values()))), (*path_marks(pair), Mark("y", 0.0))
    return Figure(
        f"root_stress_history_{name}",
        f"Root stress through the mesh of pair {name}",
        f"Pair {name} at {load:.5g} N: fillet stress of one tooth; by finite elements its own load's and its "
        f"neighbours' added. A to E: points of the path of contact. Largest tension {' and '.join(largest)}.",
        (Panel(axis_of(of, "x"), axis_of(of, "tension"), tuple(curves), marks),),
        under=f"{load:.5g} N",
    )


def _map(
    name: str, load: float, over_face: Mapping[Member, Mapping[Side, StressOverFace]], gears: Mapping[Member, str]
) -> Figure:
    """Draw the largest tension of both gears along the face over the way of a tooth, with one scale of colours."""
    maps = {member: over["tension"] for member, over in over_face.items()}
    top = max(float(one.value.max()) for one in maps.values()) * 1e-6
    panels = []
    for member, one in maps.items():
        # Roll positions stand unevenly; straight between them.
        x, z = np.linspace(one.x[0], one.x[-1], _ACROSS), np.linspace(one.z[0], one.z[-1], _ALONG)
        way = np.stack([np.interp(x, one.x, along) for along in one.value.T]) * 1e-6
        value = np.stack([np.interp(z, one.z, along) for along in way.T], axis=1)
        panels.append(
            Panel(
                axis_of(type(one), "x", "position of the tooth's contact on the line of action"),
                axis_of(type(one), "z"),
                (HeatMap(x * 1e3, z * 1e3, value, "largest root tension", "MPa", limits=(0.0, top)),),
                title=f"{member} {gears[member]}: {one.value.max() * 1e-6:.4g} MPa",
            )
        )
    return Figure(
        f"root_stress_over_face_{name}",
        f"Root stress over the face of pair {name}",
        f"Pair {name}: largest tension up the fillet of a tooth of either gear along its face, on its way through the "
        "mesh; the position is that of its contact line in the middle of the face.",
        tuple(panels),
        under=f"{load:.5g} N",
    )


ROOT_STRESS_HISTORY = teeth_stage(
    answers=("root tension",),
    every_load=True,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
