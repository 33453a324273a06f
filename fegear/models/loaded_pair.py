"""From a case's pair to its engagement: compliance source, modifications, spacing errors, effects."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.csv_columns import read_columns
from fegear.case.part import at
from fegear.errors import InputError
from fegear.geometry.relief import (
    CombinedRelief,
    Relief,
    TabulatedRelief,
    crowning,
    normalised_tip_relief,
    roll_of_radius,
    root_relief,
    tip_relief,
)
from fegear.models.assumed import bore_remarks, width_remarks
from fegear.models.tooth_influence import gear_influence

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.case.relief import EndReliefPart, ReliefPart, ReliefTablePart
    from fegear.contact import Engagement, GearCompliance, PairCompliance
    from fegear.geometry import Gear, GearPair
    from fegear.geometry.pair import Member

    Array = NDArray[np.float64]

MEMBERS: tuple[Member, Member] = ("driver", "driven")


@dataclass(frozen=True)
class LoadedPair:
    """A pair of the scene ready for load sharing.

    Parameters
    ----------
    name : str
    engagement : Engagement
        With the scene's effects.
    shifted : tuple of Engagement
        The same with one compliance each off by its estimated error; empty where the source states none.
    loads : tuple of float
        Every load of the case [N], ascending.
    nominal : float
        The load that the contract's tables are for [N].
    sources : tuple of str
        What the compliance sources say of themselves.
    """

    name: str
    engagement: Engagement
    shifted: tuple[Engagement, ...]
    loads: tuple[float, ...]
    nominal: float
    sources: tuple[str, ...]


def gear_name(scene: Scene, pair: str, member: Member) -> str:
    """Name of the driver or the driven gear of a pair."""
    part = scene.case.pair[pair]
    return part.driver if member == "driver" else part.driven


def check_pair(scene: Scene, name: str) -> None:
    """Refuse pairs that cannot be loaded as the case asks, and effects without data or data against an effect."""
    part, effects = scene.case.pair[name], scene.case.effects
    pair, key = scene.pairs[name], f"pair.{name}"
    if part.normal_load(pair) is None:
        raise InputError(f"{key}.load", "(not given)", "is needed for load sharing", "give load, loads or torque")
    if pair.contact_ratio < 1.0 and not effects.corner_contact:
        raise InputError(
            key, f"contact ratio {pair.contact_ratio:.4f}",
            "is below 1: at some roll positions no tooth pair is on the path of contact",
            "lengthen the teeth, raise the number of teeth, or set effects.corner_contact = true",
        )  # fmt: skip
    source = part.compliance.source
    if effects.neighbour_coupling and source != "fe":
        raise InputError(
            "effects.neighbour_coupling", "true", f'is not known to the compliances of {key}, source = "{source}"',
            f'set {key}.compliance.source = "fe", or leave the effect out',
        )  # fmt: skip
    if source == "table" and effects.hertz != "none":
        raise InputError(
            "effects.hertz", f'"{effects.hertz}"', f"cannot change the contact that the table of {key} holds already",
            'set effects.hertz = "none"',
        )  # fmt: skip
    if source == "table" and part.compliance.of != "pair" and pair.driver.base_radius != pair.driven.base_radius:
        raise InputError(
            f"{key}.compliance.of", '"tooth"', "takes the table for a tooth of either gear, but the gears differ",
            'give the compliance of the pair and set of = "pair"',
        )  # fmt: skip
    if effects.spacing_errors and all(gear.spacing_errors is None for gear in scene.case.gear.values()):
        raise InputError(
            "effects.spacing_errors", "true", "finds no gear with spacing_errors in this case",
            f"give gear.{part.driver}.spacing_errors, or leave the effect out",
        )  # fmt: skip


def check_relief(scene: Scene, name: str) -> None:
    """Refuse the effect relief where no gear of the case has any: other pairs may do without."""
    part = scene.case.pair[name]
    if scene.case.effects.relief and all(gear.relief is None for gear in scene.case.gear.values()):
        raise InputError(
            "effects.relief", "true", "finds no gear with a relief in this case",
            f"give gear.{part.driver}.relief, or leave the effect out",
        )  # fmt: skip


def effect_remarks(scene: Scene, name: str) -> tuple[str, ...]:
    """Data of the pair that its effects leave out, values taken for what is not given, corners that cannot touch."""
    remarks, effects = [], scene.case.effects
    for gear in dict.fromkeys(gear_name(scene, name, member) for member in MEMBERS):
        part = scene.case.gear[gear]
        if part.relief is not None and not effects.relief:
            remarks.append(f"Gear {gear} has a relief, but effects.relief is off: its flanks are taken as involutes.")
        if part.spacing_errors is not None and not effects.spacing_errors:
            remarks.append(f"Gear {gear} has spacing_errors, but the effect is off: its teeth are taken as even.")
        remarks += width_remarks(scene, gear)
        if scene.case.pair[name].compliance.source == "fe":
            remarks += bore_remarks(scene, gear)
    pair = scene.pairs[name]
    if effects.corner_contact:
        from fegear.geometry import interference

        remarks += [
            f"Pair {name}: the tip of the {member} gear reaches below the form circle of its mate, where the path "
            "ends: there is no corner contact at that end."
            for member in MEMBERS
            if interference(pair, member).below_form_circle
        ]
    return tuple(remarks)


# ---- compliance --------------------------------------------------------------------------------------------------
def pair_compliance_table(scene: Scene, name: str) -> tuple[Array, Array]:
    """Positions [m] and compliances [m/N] of the file that a pair names."""
    part, pair = scene.case.pair[name].compliance, scene.pairs[name]
    key = f"pair.{name}.compliance.file"
    dimensions = {
        "x": "length", "roll_angle": "angle", "compliance": "compliance", "load": "force", "deflection": "length"
    }  # fmt: skip
    columns = read_columns(scene.file(part.file or "", key), key, dimensions)
    if "compliance" in columns:
        c = columns["compliance"]
    elif "load" in columns and "deflection" in columns:
        if not (columns["load"] > 0.0).all():
            raise InputError(key, f'"{part.file}"', "has a load that is not positive, which leaves no compliance")
        c = columns["deflection"] / columns["load"]
    else:
        raise InputError(key, f'"{part.file}"', "has neither a column compliance nor load and deflection")
    if "roll_angle" in columns:
        rb = pair.driver.base_radius
        return columns["roll_angle"] * rb - rb * math.tan(pair.working_pressure_angle), c
    if "x" not in columns:
        raise InputError(key, f'"{part.file}"', "has neither a column x nor roll_angle")
    return columns["x"], c


def _sources(
    scene: Scene, name: str, progress: Callable[[str], None] | None
) -> tuple[tuple[GearCompliance, GearCompliance], list[tuple[GearCompliance, GearCompliance]]]:
    """The sources of driver and driven, and the pairs of sources shifted by their errors."""
    part, pair = scene.case.pair[name].compliance, scene.pairs[name]
    try:
        if part.source == "table":
            from fegear.contact import table_sources

            x, c = pair_compliance_table(scene, name)
            return table_sources(pair, x, c, part.of or "tooth", part.fit or "cubic"), []
        if part.source != "fe":
            from fegear.contact import closed_form_compliance

            driver, driven = (closed_form_compliance(pair.gear(member), part.source) for member in MEMBERS)
            return (driver, driven), []
    except InputError as error:
        raise at(f"pair.{name}", error) if error.key.startswith("compliance") else error from None
    from fegear.contact import finite_element_compliance
    from fegear.contact.shifted_compliance import neighbours_shifted_by_error, shifted_by_error

    names = [gear_name(scene, name, member) for member in MEMBERS]
    solved = {gear: finite_element_compliance(gear_influence(scene, gear, progress)) for gear in dict.fromkeys(names)}
    first, second = (solved[gear] for gear in names)
    own1 = shifted_by_error(first)
    own2 = own1 if second is first else shifted_by_error(second)
    shifted: list[tuple[GearCompliance, GearCompliance]] = [(own1, second), (first, own2)]
    if scene.case.effects.neighbour_coupling:
        beside = {gear: neighbours_shifted_by_error(found) for gear, found in solved.items()}
        shifted.append((beside[names[0]], beside[names[1]]))
    return (first, second), shifted


# ---- modifications -----------------------------------------------------------------------------------------------
def _active_ends(pair: GearPair, member: Member) -> tuple[float, float]:
    a, b = sorted(float(r) for r in pair.radius(np.array([pair.x_start, pair.x_end]), member))
    return a, b


def _table_relief(scene: Scene, gear: Gear, part: ReliefTablePart, key: str) -> TabulatedRelief:
    if part.file is not None:
        columns = read_columns(
            scene.file(part.file, f"{key}.file"), f"{key}.file",
            {"roll_angle": "angle", "radius": "length", "relief": "length"},
        )  # fmt: skip
        if "relief" not in columns or not ("roll_angle" in columns or "radius" in columns):
            raise InputError(f"{key}.file", f'"{part.file}"', "needs the columns relief and roll_angle or radius")
        values = columns["relief"]
        roll = columns["roll_angle"] if "roll_angle" in columns else _rolls(gear, columns["radius"], key)
    else:
        values = np.array(part.removals)
        roll = np.array(part.roll_angles) if part.roll_angles else _rolls(gear, np.array(part.radii), key)
    order = np.argsort(roll)
    return TabulatedRelief(roll[order], values[order], part.interpolation)


def _rolls(gear: Gear, radii: Array, key: str) -> Array:
    if (radii < gear.base_radius).any():
        raise InputError(f"{key}.radii", f"{radii.min() * 1e3:.6g} mm", "lies inside the base circle")
    return roll_of_radius(gear, radii)


def build_relief(scene: Scene, pair: GearPair, member: Member, part: ReliefPart, delta: float) -> Relief:
    """Modification of one gear of a pair.

    Parameters
    ----------
    scene : Scene
    pair : GearPair
    member : {"driver", "driven"}
    part : ReliefPart
    delta : float
        Welbourn's Delta [m], the unit of amount_over_delta.
    """
    gear = pair.gear(member)
    low, high = _active_ends(pair, member)
    found: list[Relief] = []

    def amount(end: EndReliefPart) -> float:
        return end.amount if end.amount is not None else (end.amount_over_delta or 0.0) * delta

    for tip in part.tip:
        if tip.normalised_length is not None:
            found.append(normalised_tip_relief(pair, member, amount(tip), tip.normalised_length, tip.shape))
        else:
            found.append(
                tip_relief(
                    gear,
                    amount(tip),
                    start_roll=tip.start_roll_angle,
                    start_radius=tip.start_radius,
                    length=tip.length,
                    shape=tip.shape,
                    at_radius=tip.at_radius,
                )
            )
    found += [
        root_relief(
            gear,
            amount(root),
            end_radius=root.end_radius or low,
            start_roll=root.start_roll_angle,
            start_radius=root.start_radius,
            length=root.length,
            shape=root.shape,
        )
        for root in part.root
    ]
    found += [
        crowning(gear, crown.amount, crown.start_radius or low, crown.end_radius or high) for crown in part.crowning
    ]
    found += [_table_relief(scene, gear, table, f"relief.table[{i}]") for i, table in enumerate(part.table)]
    return CombinedRelief(tuple(found))


def spacing_errors(scene: Scene, gear: str) -> Array:
    """Spacing error of each tooth of a gear [m]; empty for none."""
    part, key = scene.case.gear[gear].spacing_errors, f"gear.{gear}.spacing_errors"
    if part is None:
        return np.empty(0)
    if part.values is not None:
        errors = np.array(part.values)
    else:
        columns = read_columns(scene.file(part.file or "", f"{key}.file"), f"{key}.file", {"spacing_error": "length"})
        if "spacing_error" not in columns:
            raise InputError(f"{key}.file", f'"{part.file}"', "has no column spacing_error")
        errors = columns["spacing_error"]
    teeth = scene.gears[gear].teeth
    if errors.size != teeth:
        raise InputError(key, f"{errors.size} errors", f"must be one for each of the {teeth} teeth")
    return errors


def wants_delta(part: ReliefPart | None) -> bool:
    """Whether a relief's amount is given in Welbourn's Delta."""
    return part is not None and any(end.amount_over_delta is not None for end in (*part.tip, *part.root))


def spaced(scene: Scene, name: str, engagement: Engagement) -> Engagement:
    """The engagement with the spacing errors of its gears."""
    driver, driven = (spacing_errors(scene, gear_name(scene, name, member)) for member in MEMBERS)
    return replace(engagement, driver_spacing=driver, driven_spacing=driven)


def relieved(scene: Scene, name: str, engagement: Engagement) -> Engagement:
    """The engagement with the reliefs of its gears.

    Raises
    ------
    InputError
        If a relief does not fit its gear; the key is the one of the case file.
    """
    from fegear.design import welbourn_amount

    pair, nominal = engagement.pair, engagement.compliance.nominal_load
    names = {member: gear_name(scene, name, member) for member in MEMBERS}
    parts = {member: scene.case.gear[gear].relief for member, gear in names.items()}
    delta = math.nan
    if any(wants_delta(p) for p in parts.values()):
        spacing = (engagement.driver_spacing, engagement.driven_spacing)
        largest = max((float(np.abs(e).max()) for e in spacing if e.size), default=0.0)
        try:
            delta = welbourn_amount(engagement, nominal, largest)
        except InputError as error:
            raise at(f"gear.{names['driver']}", error, {"relief.amount": "relief.tip.amount_over_delta"}) from None
    built: dict[Member, Relief] = {}
    for member, p in parts.items():
        try:
            built[member] = CombinedRelief() if p is None else build_relief(scene, pair, member, p, delta)
        except InputError as error:
            raise at(f"gear.{names[member]}", error) from None
    return replace(engagement, driver_relief=built["driver"], driven_relief=built["driven"])


def build_loaded_pair(
    scene: Scene,
    name: str,
    progress: Callable[[str], None] | None = None,
    given: Callable[[str, Member], GearCompliance] | None = None,
) -> LoadedPair:
    """Make the engagement of a pair with the scene's effects.

    Parameters
    ----------
    scene : Scene
    name : str
    progress : callable, optional
    given : callable, optional
        ``given(pair, member)`` gives other compliances than those that the case names.

    Raises
    ------
    InputError
        If a relief or an error list does not fit its gear; the key is the one of the case file.
    """
    from fegear.contact import Engagement, PairCompliance

    part, pair, effects = scene.case.pair[name], scene.pairs[name], scene.case.effects
    nominal = part.normal_load(pair) or math.nan
    if given is None:
        (driver, driven), shifted = _sources(scene, name, progress)
    else:
        driver, driven, shifted = given(name, "driver"), given(name, "driven"), []
    compliance = PairCompliance(pair, driver, driven, effects.neighbour_coupling, effects.hertz, nominal)
    engagement = Engagement(compliance, corner_contact=effects.corner_contact)
    if effects.spacing_errors:
        engagement = spaced(scene, name, engagement)
    if effects.relief:
        engagement = relieved(scene, name, engagement)
    others = tuple(replace(engagement, compliance=_with(compliance, *sources)) for sources in shifted)
    told = tuple(dict.fromkeys((driver.describe(), driven.describe())))
    return LoadedPair(name, engagement, others, part.all_loads(pair), nominal, told)


def _with(compliance: PairCompliance, driver: GearCompliance, driven: GearCompliance) -> PairCompliance:
    return replace(compliance, driver=driver, driven=driven)
