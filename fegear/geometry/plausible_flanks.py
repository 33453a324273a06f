"""Reliefs, spacing errors and loads beyond which a number is a slip of the unit."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.printed import figures

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair
    from fegear.geometry.relief import Crowning, EndRelief, Relief, TabulatedRelief


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


def deepest_relief(gear: Gear, roll: ArrayLike) -> Array:
    """Removal along the normal that a tooth can take at roll angles [rad], same shape [m].

    A tenth of the module, and nowhere beyond the middle of the tooth: a removal m moves the flank by m / cos(alpha_r)
    along the arc of its radius, alpha_r the pressure angle there.
    """
    angle = np.asarray(roll, dtype=float)
    radius = np.hypot(1.0, angle) * gear.base_radius
    half_thickness = radius * np.maximum(gear.tooth.flank_angle(radius / gear.module), 0.0)
    return np.asarray(np.minimum(DEEPEST_RELIEF * gear.module, half_thickness / np.hypot(1.0, angle)))


def refuse_deep_relief(gear: Gear, relief: Relief, low: float, high: float) -> None:
    """Refuse a modification that takes more than the tooth has, or adds as much, between two roll angles [rad].

    Raises
    ------
    InputError
        With the place where it is deepest for what the tooth can take.
    """
    roll = np.sort(np.concatenate([np.linspace(low, high, 101), np.clip(relief.kinks, low, high)]))
    removal = relief.removal(roll)
    with np.errstate(divide="ignore", invalid="ignore"):  # a pointed tooth has nothing to take
        share = np.abs(removal) / deepest_relief(gear, roll)
    worst = int(np.nanargmax(share)) if np.isfinite(share).any() else 0
    if share[worst] > 1.0:
        radius = float(gear.tooth.radius_of_roll(roll[worst])) * gear.module
        raise InputError(
            "relief", f"{removal[worst] * 1e6:.4g} um at radius {radius * 1e3:.6g} mm",
            f"is {share[worst]:.3g} times the maximum of {DEEPEST_RELIEF:g} module (at most half the tooth thickness)",
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
            f"is {(last - first) / room:.2g} of the active profile long: too short to be ground",
            "check the unit of its length or its start; use tip_chamfer for a chamfered edge",
        )  # fmt: skip
    missed = hasattr(relief, "roll") and (first >= high or last <= low)
    if missed or (not hasattr(relief, "roll") and (first < low - room or last > high + room)):
        raise InputError(
            "relief", f"from roll angle {math.degrees(first):.5g} to {math.degrees(last):.5g} deg",
            f"lies outside the active profile, {math.degrees(low):.5g} to {math.degrees(high):.5g} deg",
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
            f"is {spread / module:.3g} modules; the tooth thickness is {0.5 * math.pi:.3g} modules",
            "check the unit: pitch deviations are some micrometres",
        )  # fmt: skip


def _load_share(pair: GearPair, load: float) -> float:
    """Line load over module and Young's modulus of the softer gear."""
    stiff = min(gear.material.young_modulus for gear in (pair.driver, pair.driven))
    return load / (pair.face_width * pair.driver.module * stiff)


def refuse_load(pair: GearPair, load: float, key: str = "load") -> None:
    """Refuse a load along the line of action [N] under which teeth of any material fold.

    Parameters
    ----------
    pair : GearPair
    load : float
    key : str
        By which the load is given: ``"load"`` or ``"loads"``; any other one is said as a torque on the driver.

    Raises
    ------
    InputError
    """
    share, width = _load_share(pair, load), pair.face_width
    if share > _ABSURD_LOAD:
        stiff = min(gear.material.young_modulus for gear in (pair.driver, pair.driven))
        most = _HEAVY_LOAD if stiff > _METAL else _ABSURD_LOAD
        lever, unit = (1.0, "N") if key.startswith("load") else (pair.driver.base_radius, "N m")
        raise InputError(
            key, f"{load * lever:.6g} {unit} on {width * 1e3:.6g} mm face width",
            f"gives a line load of {load / width * 1e-3:.4g} N/mm ({share:.2g} times m E), far above the strength of "
            "any tooth",
            f"check the units of {key} and face_width; choose at most {figures(load * lever * most / share, 2)} {unit}",
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
        mean = figures(line_load / pair.driver.module * 1e-6, 4)
        return (
            f"line load {figures(line_load * 1e-3, 4)} N/mm: F/(b m) = {mean} MPa, root "
            "stress about three times that, above the strength of any metal. Check load and face_width."
        )
    if pressure > _HEAVY_PRESSURE * stiff:
        return (
            f"maximum Hertzian pressure {figures(pressure * 1e-6, 4)} MPa at {figures(load, 4)} N exceeds the yield "
            "limit of the hardest steels. Check load, crowning and misalignment."
        )
    return ""
