"""Result ``relief``: the profile relief of both gears that removes the transmission error at the design load."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from fegear.base.errors import InputError, RangeError
from fegear.case.built.design_range import design_range
from fegear.case.built.members import gear_name
from fegear.case.built.neglected_effects import neglected_in_design
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.relief_limits import relief_limits
from fegear.case.built.tip_tolerances import tip_tolerances
from fegear.case.design import DesignPart
from fegear.contact.loaded_teeth import HARMONICS, POSITIONS
from fegear.engine.citation import Citation, citing
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.results import forecasts
from fegear.results.pair.loaded_teeth import needs_teeth
from fegear.results.pair.root_stress_history import table_names
from fegear.results.relief.relief_data import ReliefData, ReliefInputs
from fegear.results.relief.relief_sheet import RELIEF_SHEET

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.design.loading import LoadingFunction


def design_part(scene: Scene) -> DesignPart:
    """``[design]``, or its defaults."""
    return scene.case.design or DesignPart()


def design_pairs(scene: Scene) -> tuple[str, ...]:
    """The plane pair that ``[design]`` names, or the only one."""
    named, plane = design_part(scene).pair, tuple(scene.plane_pairs)
    if named is not None:
        return () if named in scene.wide_pairs else (named,)
    if len(plane) > 1:
        raise InputError("design.pair", "(not given)", "is required with several pairs", "specify one of them")
    return plane


#: Stage of a result about the reliefs that a case asks to design.
relief_stage = partial(Stage, subjects=design_pairs, needs=needs_teeth)


def _loading(part: DesignPart, p: GearPair) -> LoadingFunction:
    from fegear.design.loading import LoadingFunction, Ramp

    length = part.length or (part.contact_ratio * p.base_pitch if part.contact_ratio else p.path_length)
    centre = 0.5 * (p.x_start + p.x_end) if part.centre is None else part.centre
    exponent = (part.exponent or 7) if part.family == "polynomial" else None
    peak = part.peak if isinstance(part.peak, float) else math.nan
    ramp, inner = Ramp(part.slope, exponent), Ramp(part.inner_slope, exponent)
    return LoadingFunction(length, p.base_pitch, centre, ramp, inner, peak)


def _check(scene: Scene, name: str) -> None:
    peak = design_part(scene).peak
    if isinstance(peak, str) and scene.case.pair[name].compliance.source != "fe":
        raise InputError(
            "design.peak", f'"{peak}"', "requires root stresses", f'set pair.{name}.compliance.source = "fe"'
        )
    from fegear.design.loading import refuse_beyond_path

    pair, part = scene.pairs[name], design_part(scene)
    if pair.contact_ratio < 1.0 and part.length is None and part.contact_ratio is None:
        rule = "is below 1: relief design requires at least 1"
        raise InputError(f"pair.{name}", f"contact ratio {pair.contact_ratio:.4f}", rule, "increase the contact ratio")
    refuse_beyond_path(_loading(part, pair), pair)
    relief_limits(part, pair)
    if part.metric == "peak_to_peak_max" and part.film is not None:
        raise InputError(
            "design.metric", '"peak_to_peak_max"', "requires tolerances, which are not evaluated with an oil film",
            'remove design.film or set metric = "peak_to_peak"',
        )  # fmt: skip
    design_range(scene, name)
    for member in MEMBERS:
        ends = [float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end)]
        for roll in design_part(scene).roll_angles or ():
            if not min(ends) - 1e-9 <= roll <= max(ends) + 1e-9:
                raise RangeError(
                    "design.roll_angles", f"{math.degrees(roll):.6g} deg",
                    f"is outside the active profile of the {member}, {math.degrees(min(ends)):.6g} to "
                    f"{math.degrees(max(ends)):.6g} deg",
                )  # fmt: skip


def _inputs(scene: Scene, name: str) -> ReliefInputs:
    gears = {member: gear_name(scene, name, member) for member in MEMBERS}
    case = scene.case
    return ReliefInputs(
        design_part(scene), pair_spec(scene, name), design_range(scene, name), tip_tolerances(scene, name),
        case.accuracy.tolerance, case.effects, scene.sizes_neglected, table_names(scene, name), gears,
        f"pair.{name}.{case.pair[name].load_key(scene.pairs[name])}",
    )  # fmt: skip


def _compute(inputs: ReliefInputs, upstream: Upstream, work: Work) -> ReliefData:
    from fegear.design.oil_film import OilFilm
    from fegear.design.relief_design import DesignTask, design_relief, relief_at
    from fegear.design.root_stress_loading import Allowed

    pair: LoadedPair
    (pair,) = upstream.values()
    part = inputs.part
    load = part.load or pair.nominal
    limits = part.allowable
    film = None if part.film is None else OilFilm(tuple(part.film.x), tuple(part.film.thickness))
    allowed = None if limits is None else Allowed(limits.root_tension, limits.hertz_pressure, load)
    task = DesignTask(
        _loading(part, pair.engagement.pair), load, isinstance(part.peak, str), tuple(part.grind), part.measure,
        tuple(sorted({*pair.loads, load})), POSITIONS, HARMONICS, allowed, film,
        inputs.over, inputs.tolerances, relief_limits(part, pair.engagement.pair),
        part.metric == "peak_to_peak_max",
    )  # fmt: skip
    try:
        design = design_relief(pair.engagement, pair.shifted, task, work.progress, work.cache)
    except RangeError as error:
        raise error.under("", {} if part.load else {"design.load": inputs.load_key}) from None
    best = design.best_ground if design.ground else None
    neglected: dict[str, tuple[str, ...]] = {}
    if inputs.neglected:
        neglected = neglected_in_design(inputs.asked, design.designed, best, task, inputs.tolerance, work.cache)
    wanted = part.roll_angles or ()
    points = {member: relief_at(design.designed, member, wanted) for member in MEMBERS if wanted}
    return ReliefData(pair, design, neglected, points)


def _forecast(scene: Scene, name: str) -> Forecast:
    """Reliefs to grind, fitted by repeated load sharing."""
    design = scene.case.design
    grind = len(design.grind) if design else 2
    over = design_range(scene, name)
    searches = 1.0 if over is None else 1.0 + 0.7 * len(over.loads)
    return forecasts.constant(0.3 + 1.2 * grind * searches * (1.3 if forecasts.engagements(scene, name) > 1 else 1.0))


RELIEF = relief_stage(
    inputs=_inputs,
    compute=_compute,
    present=RELIEF_SHEET.present,
    check=_check,
    cites=citing(
        Citation("mark", "relief with zero transmission error at the design load", "Eqs. 4.6 to 4.16, 5.4"),
        Citation("lin-townsend-oswald", "linear and parabolic tip relief"),
        Citation("harris", "Harris maps"),
    ),
    forecast=_forecast,
)
