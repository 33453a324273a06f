"""Result ``relief``: the profile relief of both gears that removes the transmission error at the design load."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fegear.case.design import DesignPart
from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome, Value
from fegear.engine.stage import Forecast, Stage
from fegear.errors import InputError, RangeError
from fegear.geometry.pair import MEMBERS
from fegear.models.neglected_effects import design_remarks, neglected_in_design
from fegear.models.pair_inputs import gear_name, pair_inputs
from fegear.results import forecasts
from fegear.results.drawn_relief import relief_figures
from fegear.results.loaded_pair import needs_pair
from fegear.results.relief_tables import (
    grindable_table,
    harris_table,
    least_stress_table,
    points_table,
    relief_tables,
    relief_values,
)
from fegear.results.root_stress_history import table_names
from fegear.results.transmission_error import HARMONICS, POSITIONS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.effects import EffectsPart
    from fegear.case.reading import Scene
    from fegear.design import LoadingFunction
    from fegear.design.minimum_excitation import ReliefTable
    from fegear.design.relief_design import ReliefDesign
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry import GearPair
    from fegear.geometry.pair import Member
    from fegear.models.loaded_pair import LoadedPair
    from fegear.models.pair_inputs import PairInputs

#: What the design knows of the effects; the gears' own reliefs are what it replaces.
DESIGN_EFFECTS = ("neighbour_coupling", "hertz", "corner_contact")


@dataclass(frozen=True)
class ReliefData:
    """A designed relief.

    Parameters
    ----------
    pair : LoadedPair
    design : ReliefDesign
    neglected : mapping of str to tuple of str
        What effects that are off would change, in words.
    points : mapping of member to ReliefTable
        At the roll angles that the case asks for; empty where it names none.
    """

    pair: LoadedPair
    design: ReliefDesign
    neglected: Mapping[str, tuple[str, ...]]
    points: Mapping[Member, ReliefTable]


@dataclass(frozen=True)
class ReliefInputs:
    """What the design of a pair's relief depends on.

    Parameters
    ----------
    part : DesignPart
    asked : PairInputs
    tolerance : float
        That neglected effects are held against.
    effects : EffectsPart
        All of the case, for the remedies.
    labels, gears : mapping of str to str
        Names of the tables and of the gears by member.
    """

    part: DesignPart
    asked: PairInputs
    tolerance: float
    effects: EffectsPart = field(compare=False)
    labels: Mapping[Member, str] = field(compare=False)
    gears: Mapping[Member, str] = field(compare=False)


def design_part(scene: Scene) -> DesignPart:
    """``[design]``, or its defaults."""
    return scene.case.design or DesignPart()


def design_pairs(scene: Scene) -> tuple[str, ...]:
    """The pair that ``[design]`` names, or the only pair of spur gears."""
    named = design_part(scene).pair
    if named is not None:
        return (named,)
    if len(scene.spur_pairs) > 1:
        raise InputError("design.pair", "(not given)", "is needed where there are several pairs", "name one of them")
    return tuple(scene.spur_pairs)


def _loading(part: DesignPart, p: GearPair) -> LoadingFunction:
    from fegear.design import LoadingFunction, Ramp

    length = part.length or (part.contact_ratio * p.base_pitch if part.contact_ratio else p.path_length)
    centre = 0.5 * (p.x_start + p.x_end) if part.centre is None else part.centre
    exponent = (part.exponent or 7) if part.family == "polynomial" else None
    peak = part.peak if isinstance(part.peak, float) else math.nan
    ramp, inner = Ramp(part.slope, exponent), Ramp(part.inner_slope, exponent)
    return LoadingFunction(length, p.base_pitch, centre, ramp, inner, peak)


def _check(scene: Scene, name: str) -> None:
    peak = design_part(scene).peak
    if isinstance(peak, str) and scene.case.pair[name].compliance.source != "fe":
        raise InputError("design.peak", f'"{peak}"', "needs root stresses", f'set pair.{name}.compliance.source = "fe"')
    pair = scene.pairs[name]
    for member in MEMBERS:
        ends = [float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end)]
        for roll in design_part(scene).roll_angles or ():
            if not min(ends) - 1e-9 <= roll <= max(ends) + 1e-9:
                raise RangeError(
                    "design.roll_angles", f"{math.degrees(roll):.6g} deg",
                    f"is off the active profile of the {member}, {math.degrees(min(ends)):.6g} to "
                    f"{math.degrees(max(ends)):.6g} deg",
                )  # fmt: skip


def _inputs(scene: Scene, name: str) -> ReliefInputs:
    gears = {member: gear_name(scene, name, member) for member in MEMBERS}
    case = scene.case
    return ReliefInputs(
        design_part(scene), pair_inputs(scene, name), case.accuracy.tolerance, case.effects,
        table_names(scene, name), gears,
    )  # fmt: skip


def _compute(inputs: ReliefInputs, upstream: Upstream, work: Work) -> ReliefData:
    from fegear.design.oil_film import OilFilm
    from fegear.design.relief_design import DesignTask, design_relief, relief_at
    from fegear.design.root_stress_loading import Allowed

    (found,) = upstream.values()
    pair: LoadedPair = found.pair
    part = inputs.part
    load = part.load or pair.nominal
    limits = part.allowable
    film = None if part.film is None else OilFilm(tuple(part.film.x), tuple(part.film.thickness))
    allowed = None if limits is None else Allowed(limits.root_tension, limits.hertz_pressure, load)
    task = DesignTask(
        _loading(part, pair.engagement.pair), load, isinstance(part.peak, str), tuple(part.grind), part.metric,
        tuple(sorted({*pair.loads, load})), POSITIONS, HARMONICS, allowed, film,
    )  # fmt: skip
    design = design_relief(pair.engagement, pair.shifted, task, work.progress)
    neglected = neglected_in_design(inputs.asked, design.designed, load, inputs.tolerance)
    wanted = part.roll_angles or ()
    points = {member: relief_at(design.designed, member, wanted) for member in MEMBERS if wanted}
    return ReliefData(pair, design, neglected, points)


def _present(data: ReliefData, inputs: ReliefInputs) -> Outcome:
    name, design, load = inputs.asked.name, data.design, data.design.task.load
    loading, tables = design.task.loading, []
    values: list[Value] = []
    if design.chosen is not None:
        table, stresses = least_stress_table(name, design.chosen, load)
        tables.append(table)
        values += stresses
    reliefs = relief_tables(name, design, inputs)
    tables += reliefs
    tables += [points_table(name, inputs.labels[m], inputs.gears[m], table) for m, table in data.points.items()]
    if design.ground:
        tables.append(grindable_table(name, design.ground, design.te, data.pair.engagement.pair))
    tables.append(harris_table(name, design.curves))
    settings = {
        "design_load": load, "design_contact_ratio": loading.length / loading.base_pitch, "peak": loading.peak,
        "slope": loading.ramp.slope, "exponent": loading.ramp.exponent or 0, "centre": loading.centre,
    }  # fmt: skip
    figures = relief_figures(name, data, reliefs, [inputs.gears[member] for member in MEMBERS])
    values += relief_values(name, design)
    return Outcome(data, tuple(tables), tuple(values), settings, _remarks(data, inputs), figures)


def _remarks(data: ReliefData, inputs: ReliefInputs) -> tuple[str, ...]:
    remarks, te, name = [], data.design.te, inputs.asked.name
    if inputs.part.film is not None:
        remarks.append(
            f"Pair {name}: each relief makes up for half the oil film at the design load, and what is left counts the "
            "film, as thick at every other load; tip reliefs to grind were searched without it."
        )
    if "diagonal only" in te:
        d, n = te["diagonal only"].peak_to_peak, te["no relief"].peak_to_peak
        remarks.append(
            f"Pair {name}: a design without the neighbours' loads (Mark 5.4) would leave {d * 1e6:.3g} um, "
            f"{d / te['diagonal only'].mean:.1%} of the mean, peak to peak, and {d / n:.0%} of what no relief leaves."
        )
    return (*remarks, *design_remarks(name, data.neglected, inputs.effects, inputs.tolerance))


def _forecast(scene: Scene, name: str) -> Forecast:
    """Reliefs to grind, fitted by repeated load sharing."""
    design = scene.case.design
    grind = len(design.grind) if design else 2
    return forecasts.constant(0.1 + 0.3 * grind * (1.3 if forecasts.engagements(scene, name) > 1 else 1.0))


RELIEF = Stage(
    subjects=design_pairs,
    needs=needs_pair,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    effects=DESIGN_EFFECTS,
    cites=citing(
        Citation("mark", "relief that leaves no transmission error at the design load", "Eqs. 4.6 to 4.16, 5.4"),
        Citation("lin-townsend-oswald", "linear and parabolic tip relief"),
        Citation("harris", "Harris maps"),
    ),
    forecast=_forecast,
)
