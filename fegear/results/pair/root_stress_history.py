"""Stage ``root-stress-history``: root stress of one tooth of either gear on its way through the mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.case.built.members import gear_name
from fegear.case.built.root_stress_sources import FINITE_ELEMENTS, check_formulas, root_stress_source
from fegear.engine.citation import Citation
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Bundle, Chart, Family, Line, Map, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS, Member
from fegear.results import forecasts
from fegear.results.forecasts import ROOT_STRESS_CITATIONS
from fegear.results.gear.path_marks import path_marks
from fegear.results.gear.solved_gear import needs_teeth_of, solid_solution_of, teeth_of
from fegear.results.pair.loaded_teeth import (
    check_teeth,
    gears_of,
    loaded_pair,
    loaded_teeth,
    needs_gears,
    needs_teeth,
    teeth_stage,
)
from fegear.results.pair.root_stress_data import StressAlongFace, StressBySource, StressedTooth, StressInMesh, ending

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.case.reading import Scene
    from fegear.contact.loaded_teeth import LoadedTeeth, RootStressInMesh

#: Of a pair with a width: seconds to begin with, and of a roll position, both gears and both solutions, for each load.
_WIDE, _WIDE_POSITION = 0.5, 0.05
#: Curves of every source are drawn.
_ALL = 100


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
    solved = {} if FINITE_ELEMENTS not in asked.sources else {g: teeth_of(upstream, g) for g in asked.gears.values()}
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


def _shown(data: RootStressData, asked: RootStressInputs) -> StressInMesh:
    """Both gears' teeth with the names that they have in tables."""
    found, loads, i = data.found, data.teeth.loads, data.teeth.loads.index(data.teeth.nominal)
    teeth: dict[Member, StressedTooth] = {}
    for g, (member, label) in enumerate(asked.labels.items()):
        gear, by, over = asked.gears[member], found.stress[member], found.over_face.get(member)
        face = None if over is None else StressAlongFace(over["tension"], over["compression"])
        sources = tuple(
            StressBySource(
                stress, member, gear, source, ending(tuple(by), k), f"series:{g + 2 * k}" if k else member,
                len(found.stress["driver"]) > 1, loads, i, face,
            )
            for k, (source, stress) in enumerate(by.items())
        )  # fmt: skip
        across, off = found.across.get(member, (None, None))
        off = None if off is None or np.isnan(off) else off
        teeth[member] = StressedTooth(member, gear, label, sources, asked.rate, face, off, across)
    return StressInMesh(data.teeth.pair, loads, i, found.notes, teeth)


def _place(quantity: str, key: str, name: str, meaning: str) -> Cell:
    """Where stress of a tooth with a width is largest."""
    return Cell(f"over_face.{quantity}", f"over_face.{key}", name=name, meaning=meaning)


def _row(side: str, quantity: str, name: str = "", meaning: str = "") -> Cell:
    """A quantity of one fillet along the face, at every position of the tooth."""
    return Cell(f"{side}.{quantity}", lambda seen: seen.one.over_face.rows(side, quantity), name=name, meaning=meaning)


_TABLES = Each(
    "teeth",
    Rows(
        "root_stress_history_{one.label}", "Root stress of a tooth of gear {one.gear} in the mesh",
        (
            "t", "first.x",
            Each(
                "sources",
                Cell("stress.tension", name="stress{one.ending}", further=", by {one.said}"),
                Cell("stress.compression", name="compression{one.ending}"),
                Cell(
                    "stress.tension_error", "known_error", name="stress_error{one.ending}",
                    meaning="estimated error of stress{one.ending}",
                ),
                Each(
                    "under_others",
                    Cell(
                        "stress.tension", "tension", name="stress{one.ending} at {one.load:.6g}",
                        meaning="as stress{one.ending}, under this load",
                    ),
                ),
            ),
            _place("tension.z", "pulled_z", "stress_face_position",
                   "face position of the maximum, from mid-face"),
            _place("tension.radius", "pulled_radius", "stress_radius", "and its distance from the axis"),
            _place("compression.z", "pressed_z", "compression_face_position",
                   "face position of the maximum compression"),
        ),
    ),
    Rows(
        "root_stress_over_face_{one.label}", "Root stress of gear {one.gear} along its face in the mesh",
        (
            Cell("tension.x", "over_face.x"), _row("tension", "z"), _row("tension", "value"), _row("tension", "radius"),
            _row("compression", "value", "compression", "minimum stress in the opposite fillet"),
            _row("compression", "radius", "compression_radius"),
        ),
        of="over_face",
    ),
)  # fmt: skip
_OWNER = "{name}.{one.member}"
_VALUES = Each(
    "teeth",
    Each(
        "sources",
        Number(
            "stress.largest_tension", "tension_off", owner=_OWNER, name="largest_root_tension{one.ending}",
            meaning="{one.at_tension}",
        ),
        Number(
            "stress.largest_compression", "compression_off", owner=_OWNER,
            name="largest_root_compression{one.ending}", meaning="{one.at_compression}",
        ),
        Number("stress.tension_range", "range_off", owner=_OWNER, name="root_stress_range{one.ending}"),
        when="known",
    ),
    Number(
        "across", "across_off", owner=_OWNER,
        meaning="gear {one.gear}: maximum root stress, tension side, in the normal section (comparable with formulas)",
    ),
)  # fmt: skip
_FIGURES = (
    Chart(
        "root_stress_history_{name}", "Root stress over the mesh cycle of pair {name}",
        "Pair {name} at {load:said}: fillet stress of one tooth; FE values include the loads on neighbouring "
        "teeth. A to E: points of the path of contact. Maximum root stress, tension side: {d.largest}.",
        (
            Over(
                "stress.x",
                (
                    Bundle(
                        Family("sources", role="{one.role}", most=_ALL),
                        (
                            Line("stress.tension", "{one.label}, tension", error="known_error"),
                            Line(
                                "stress.compression", "{one.label}, compression", "{one.member} compression",
                                look={"width": 1.2},
                            ),
                        ),
                    ),
                ),
                "stress.tension", marks=lambda seen: (*path_marks(seen.data.pair), Mark("y", 0.0)),
            ),
        ),
        of=lambda seen: seen.data.sources[0], under="{load:said}",
    ),
    Chart(
        "root_stress_over_face_{name}", "Root stress over the face width of pair {name}",
        "Pair {name}: root stress (tension side) of one tooth of each gear over the face width and the engagement; "
        "position of the contact line at mid-face.",
        (
            Over(
                "x", (Map("value", "z", limits=lambda seen: (0.0, seen.data.top)),), each="maps",
                title="{one.member} {one.gear}: {one.most:.4g}",
            ),
        ),
        when="maps", under="{load:said}",
    ),
)  # fmt: skip


def _settings(seen: Seen) -> dict[str, object]:
    over: StressAlongFace | None = seen.data.teeth["driver"].over_face
    if over is None:
        return {"root_stress": list(seen.asked.sources)}
    return {"places_along_the_face": int(over.tension.z.size)}


def _remarks(seen: Seen) -> Iterator[str]:
    """What formulas say of themselves, and what the direction of the stress makes of it."""
    notes = {seen.asked.gears[member]: said for member, said in seen.data.notes.items()}
    yield from formula_remarks(seen.name, notes, coupled=seen.asked.coupled)
    teeth: Mapping[Member, StressedTooth] = seen.data.teeth
    across = [(m, one.across, one.first.largest_tension[seen.nominal]) for m, one in teeth.items()]
    if differ := [f"{100.0 * (a / most - 1.0):+.1f} % ({m})" for m, a, most in across if a is not None]:
        yield (
            f"Pair {seen.name}: root stresses over the mesh and the face are those along the transverse section; the "
            f"largest at right angles to the helix differs by {' and '.join(differ)}: values "
            "largest_root_tension_across."
        )


def _most(seen: Seen) -> float:
    """Largest tension of both gears [Pa]."""
    return max(float(one.first.largest_tension[seen.nominal]) for one in seen.data.teeth.values())


_SHEET = Sheet(
    of=_shown,
    loads="loads",
    nominal="at",
    tables=(_TABLES,),
    values=(_VALUES,),
    figures=_FIGURES,
    remarks=(_remarks,),
    settings=_settings,
    answer=Answer(
        "Pair {name} at {d.torque:.3g}: maximum root stress {v[driver.largest_root_tension]} (driver) and "
        "{v[driven.largest_root_tension]} (driven).",
        "Pair {name}: stress range over the time in mesh {v[driver.root_stress_range]} (driver) and "
        "{v[driven.root_stress_range]} (driven).",
        figure="root_stress_history_{name}", rank=lambda seen: -_most(seen),
        among="the highest of {count} pairs",
    ),
)  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    check_teeth(scene, name)
    if name not in scene.wide_pairs:
        check_formulas(scene, name, tips=scene.case.effects.corner_contact)


def _cites(scene: Scene, name: str) -> Iterator[Citation]:
    yield from ROOT_STRESS_CITATIONS[FINITE_ELEMENTS] if name in scene.wide_pairs else cited_sources(scene, name)
    yield Citation("mark", "root stress history of a tooth in mesh", "section 3, Appendix B")


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
    return needs_teeth_of(scene, part.driver, part.driven) if FINITE_ELEMENTS in part.root_stress.source else ()


def cited_sources(scene: Scene, pair: str) -> Iterator[Citation]:
    """What they rest on."""
    for source in stress_sources(scene, pair):
        yield from ROOT_STRESS_CITATIONS[source]


def seconds_of(sources: tuple[str, ...]) -> float:
    """What the formulas among them take for both gears."""
    return 2.0 * sum(_FORMULA_SECONDS.get(source, 0.03) for source in sources if source != FINITE_ELEMENTS)


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
        remarks.append(
            f"Pair {pair}: root stress by {', '.join(alone)} does not include the loads on neighbouring teeth."
        )
    return tuple(remarks)


ROOT_STRESS_HISTORY = teeth_stage(
    answers=("root tension",),
    every_load=True,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
