"""What gears have: sizes, reliefs, spacing errors and loads beyond which a number is a slip of the unit."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import GeometryError, InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.geometry.gear import Gear, Material
    from fegear.geometry.pair import GearPair
    from fegear.geometry.relief import Crowning, EndRelief, Relief, TabulatedRelief

#: Modules of gears [m], from micromachined ones to the racks of jack-up rigs, twice over.
MODULES = (1e-6, 0.25)
#: Face widths in modules; the default of 1 mm is far below any, and fits the largest module.
FACE_WIDTHS = (4e-3, 300.0)
#: Young's moduli [Pa], from rubber to diamond, and densities [kg/m^3], from foam to osmium.
YOUNG_MODULI, DENSITIES = (1e6, 1.5e12), (10.0, 25e3)
#: Longest shaft in a gearbox, longest in a train (the propeller's), and thickest [m]; and how many times as thick as
#: the tip circle of its largest gear.
LONGEST_SHAFT, LONGEST_OF_TRAIN, THICKEST_SHAFT, THICKEST_BELOW_GEARS = 30.0, 300.0, 20.0, 5.0
#: Below this Young's modulus [Pa] there is no solid: the gear is one of pure numbers, of module 1 and modulus 1.
_NUMBERS = 1e3
#: Deepest relief in modules. Deflections reach it only under line loads that no steel carries (some 1.5 GPa times the
#: module), and the influence functions, which are those of the unrelieved tooth, no longer hold there.
DEEPEST_RELIEF = 0.1
#: Shortest relief over the active profile: some ten micrometres of a module of 3 mm.
_SHORTEST_RELIEF = 2e-3
#: Largest spread of the spacing errors of a gear in modules: a third of a tooth's thickness.
_LARGEST_SPACING_ERROR = 0.5
#: Line load over module and Young's modulus: above the first no metal carries it (root stresses, some three times as
#: large, pass 3 GPa in steel), above the second the teeth fold, of which a theory of small strains knows nothing.
_HEAVY_LOAD, _ABSURD_LOAD = 5e-3, 5e-2
#: Young's modulus [Pa] that metals exceed; plastics carry larger shares of theirs.
_METAL = 40e9
#: Largest Hertzian pressure over Young's modulus that hardened flanks bear once: 4.2 GPa of steel (ISO 76).
_HEAVY_PRESSURE = 0.02


def is_of_pure_numbers(material: Material) -> bool:
    """Whether a gear of this material is one of pure numbers, which may have any size."""
    return material.young_modulus < _NUMBERS


def refuse_size(module: float, face_width: float, key: str = "module") -> None:
    """Refuse a module and a face width [m] that no gear has, which are numbers in another unit than SI.

    Raises
    ------
    GeometryError
        With the remedy.
    """
    _refuse(key, module, MODULES, "m", "the modules of gears", "a module of 3 mm is 3e-3 m")
    ends = (FACE_WIDTHS[0] * module, FACE_WIDTHS[1] * module)
    _refuse(
        "face_width", face_width, ends, "m", f"the face widths of gears of module {module:.4g} m", "20 mm are 20e-3 m"
    )


def refuse_shaft(length: float, diameter: float, longest: float = LONGEST_SHAFT) -> None:
    """Refuse a length and a diameter [m] that no shaft has: millimetres that were taken for metres.

    Raises
    ------
    GeometryError
        With the remedy; its key is "length" or "diameter".
    """
    for key, value, most in (("length", length, longest), ("diameter", diameter, THICKEST_SHAFT)):
        if not 0.0 <= value <= most:
            raise GeometryError(
                key, f"{value:.6g} m", f"is beyond the shafts of gears, up to {most:g} m",
                "check the unit: 40 mm are 40e-3 m in SI",
            )  # fmt: skip


def refuse_material(material: Material) -> None:
    """Refuse moduli and densities that no solid has.

    Raises
    ------
    GeometryError
        With the remedy.
    """
    _refuse("material.young_modulus", material.young_modulus, YOUNG_MODULI, "Pa", "solids", "206.8 GPa are 206.8e9 Pa")
    _refuse("material.density", material.density, DENSITIES, "kg/m^3", "solids", "steel has 7850 kg/m^3")


def _refuse(key: str, value: float, ends: tuple[float, float], unit: str, what: str, remedy: str) -> None:
    if not ends[0] <= value <= ends[1]:
        raise GeometryError(
            key, f"{value:.6g} {unit}", f"is beyond {what}, {ends[0]:.3g} to {ends[1]:.3g} {unit}",
            f"check the unit: {remedy} in SI",
        )  # fmt: skip


def deepest_relief(gear: Gear, roll: ArrayLike) -> Array:
    """Removal along the normal that a tooth can take at roll angles [rad], same shape [m].

    A tenth of the module, and nowhere beyond the middle of the tooth: a removal m moves the flank by m / cos(alpha_r)
    along the arc of its radius, alpha_r the pressure angle there.
    """
    angle = np.asarray(roll, dtype=float)
    radius = np.hypot(1.0, angle) * gear.base_radius
    half_thickness = radius * np.maximum(gear.tooth.half_thickness_angle(radius / gear.module), 0.0)
    return np.asarray(np.minimum(DEEPEST_RELIEF * gear.module, half_thickness / np.hypot(1.0, angle)))


def refuse_deep_relief(gear: Gear, relief: Relief, low: float, high: float) -> None:
    """Refuse a modification that takes more than the tooth has, or adds as much, between two roll angles [rad].

    Raises
    ------
    InputError
        With the place where it is deepest for what the tooth can take.
    """
    roll = np.union1d(np.linspace(low, high, 101), np.clip(relief.kinks, low, high))
    removal = relief.removal(roll)
    share = np.abs(removal) / deepest_relief(gear, roll)
    worst = int(np.nanargmax(share)) if np.isfinite(share).any() else 0
    if share[worst] > 1.0:
        radius = float(gear.tooth.radius_of_roll(roll[worst])) * gear.module
        raise InputError(
            "relief", f"{removal[worst] * 1e6:.4g} um at radius {radius * 1e3:.6g} mm",
            f"is {share[worst]:.3g} times what the tooth can take ({DEEPEST_RELIEF:g} module, to its middle at most)",
            "check the unit: reliefs are some tens of micrometres",
        )  # fmt: skip


def refuse_relief_elsewhere(relief: EndRelief | Crowning | TabulatedRelief, low: float, high: float) -> None:
    """Refuse a modification that lies off an active profile, or is a thousandth of it long.

    Parameters
    ----------
    relief : EndRelief, Crowning or TabulatedRelief
    low, high : float
        Roll angles of the active profile's ends [rad].

    Raises
    ------
    InputError
    """
    kinks = relief.kinks if hasattr(relief, "roll") else (relief.start, relief.end)
    first, last, room = min(kinks), max(kinks), high - low
    if hasattr(relief, "amount") and 0.0 < last - first < _SHORTEST_RELIEF * room:
        raise InputError(
            "relief", f"from roll angle {math.degrees(first):.7g} to {math.degrees(last):.7g} deg",
            f"is {(last - first) / room:.2g} of the active profile long, which cannot be ground",
            "check the unit of its length or its start; write tip_chamfer for a broken edge",
        )  # fmt: skip
    missed = hasattr(relief, "roll") and (first >= high or last <= low)
    if missed or (not hasattr(relief, "roll") and (first < low - room or last > high + room)):
        raise InputError(
            "relief", f"from roll angle {math.degrees(first):.5g} to {math.degrees(last):.5g} deg",
            f"lies elsewhere than the active profile, {math.degrees(low):.5g} to {math.degrees(high):.5g} deg",
            "check the units of its radii, lengths and angles",
        )  # fmt: skip


def refuse_spacing_errors(errors: ArrayLike, module: float) -> None:
    """Refuse spacing errors [m] that are no errors any more beside a tooth of this module [m].

    Raises
    ------
    InputError
    """
    found = np.asarray(errors, dtype=float)
    spread = max(float(np.ptp(found)), float(np.abs(found).max())) if found.size else 0.0
    if spread > _LARGEST_SPACING_ERROR * module:
        raise InputError(
            "spacing_errors", f"up to {spread * 1e6:.4g} um",
            f"is {spread / module:.3g} modules, and teeth are {0.5 * math.pi:.3g} modules thick",
            "check the unit: spacing errors are some micrometres",
        )  # fmt: skip


def _load_share(pair: GearPair, load: float) -> float:
    """Line load over module and Young's modulus of the softer gear."""
    stiff = min(gear.material.young_modulus for gear in (pair.driver, pair.driven))
    return load / (pair.face_width * pair.driver.module * stiff)


def refuse_load(pair: GearPair, load: float) -> None:
    """Refuse a load along the line of action [N] under which teeth of any material fold.

    Raises
    ------
    InputError
    """
    share, width = _load_share(pair, load), pair.face_width
    if share > _ABSURD_LOAD:
        raise InputError(
            "load", f"{load:.6g} N on a face of {width * 1e3:.6g} mm",
            f"is {load / width * 1e-3:.4g} N/mm, {share:.2g} times module and Young's modulus: the teeth would fold",
            "check the units of load, torque and face_width",
        )  # fmt: skip


def heavy_load(pair: GearPair, load: float, pressure: float = 0.0) -> str:
    """Sentence about a load along the line of action [N], or a Hertzian pressure [Pa], that no metal carries; or empty.

    Parameters
    ----------
    pair : GearPair
    load : float
        [N].
    pressure : float
        Largest on the flanks under it, where it is known [Pa].
    """
    stiff = min(gear.material.young_modulus for gear in (pair.driver, pair.driven))
    line_load = load / pair.face_width
    if stiff <= _METAL:
        return ""
    if _load_share(pair, load) > _HEAVY_LOAD:
        return (
            f"{line_load * 1e-3:.4g} N/mm are {line_load / pair.driver.module * 1e-6:.4g} MPa of load over face width "
            "and module, some three times that at the root: no metal carries it. Check load and face_width."
        )
    if pressure > _HEAVY_PRESSURE * stiff:
        return (
            f"under {load:.4g} N the largest Hertzian pressure is {pressure * 1e-6:.4g} MPa, under which the hardest "
            "flanks of metal yield. Check the load, and crowning and misalignment."
        )
    return ""
