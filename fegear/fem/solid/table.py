"""The stiffness and root-stress table of a gear with a width, over the radius and the face position of a band."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Mask, ReadOnlyArrays, first_of_largest
from fegear.base.errors import RangeError
from fegear.base.shown import shown
from fegear.fem.plane.influence import Side
from fegear.fem.plane.root_stress import curves_apart, extreme
from fegear.fem.solid.bands import Bands, bands, hats
from fegear.fem.solid.contact import line_compliance
from fegear.fem.solid.influence import BESIDE_LARGEST, OF_OTHER_FILLET, SolidInfluence
from fegear.fem.solid.settings import whole
from fegear.fem.solid.solution import SolidSolution
from fegear.geometry.gear import Gear

#: What each number is called among the errors of the influence functions.
_MISSED = {
    "c_self": "contact", "c_prev": "neighbour", "c_next": "neighbour",
    "root_tension": "root_tension", "root_compression": "root_compression",
}  # fmt: skip
#: How far a band reaches to either side along the face, where the face goes on so far [modules].
BAND_REACH = 0.5
#: How far up and down the flank, as a share of it, the worst difference of two solutions is looked for.
_BESIDE = 0.26
#: Which estimate each number of the table goes by.
_ESTIMATE = {
    "c_self": "contact", "c_prev": "neighbour", "c_next": "neighbour", "root_tension": "root_tension",
    "root_compression": "root_compression",
}  # fmt: skip
#: Of root compression of spur gears: so many times what two solutions differ by as a root mean square. The largest
#: difference along the face is that of waves which the coarser polynomials lack, not that of the finer ones. Less where
#: the coarser solution's elements are an order lower, and the finer one has all functions (15 gears on a web need 1.1
#: and 0.5).
_USUAL_COMPRESSION, _OF_ANOTHER_ORDER = 1.3, 0.8
#: Places along the face per module at which root stress is looked at, and how many at least.
_PLACES_PER_MODULE, _FEWEST_PLACES = 5.0, 33


@dataclass(frozen=True)
class RootStressOfBands(ReadOnlyArrays):
    """The largest tangential stress of one fillet under each band, per unit force, SI; shape (R, Z) but `along`.

    `value` is in the transverse section, negative on the compressed side; `position` from the middle of the face.
    `places`, shape (S,), lie along the face, and `along`, shape (R, Z, S), is the largest up the fillet at each.
    """

    value: Array = shown(
        "MPa/N", "root stress, tension side: maximum tangential stress in the fillet over the face width"
    )
    position: Array = shown("mm", "face position of the maximum")
    radius: Array = shown("mm", "radius of the maximum")
    axial: Array = shown("MPa/N", "surface stress perpendicular to it at the maximum")
    shear: Array = shown("MPa/N", "surface shear stress at the maximum")
    places: Array = shown("mm", "face position from mid-face", label="face position")
    along: Array = shown("MPa/N", "maximum tangential stress in the fillet at this face position")


@dataclass(frozen=True)
class SolidTable(ReadOnlyArrays):
    """Compliance and root stress of a solid gear's tooth, SI; arrays of shape (R, Z) where nothing else is said.

    Every number is per unit force along the transverse line of action. The force presses on a band about its place, on
    the contact line there: a hat along the face, half a hat at an end of it.

    `radius`, `roll_angle` and both half-widths have shape (R,), places along the face shape (Z,). Errors are absolute,
    of c_self, c_neighbour, root_tension, root_compression: by what a coarser solution differs (stress: along the face,
    beside the largest), the worst along the face and over the radii beside each; NaN without one. `influence` is what
    the table was made from.
    """

    root: Mapping[Side, RootStressOfBands]
    errors: Mapping[str, Array]
    influence: SolidInfluence
    seconds: float
    radius: Array = shown("mm", "radius of the band centre")
    roll_angle: Array = shown("deg", "roll angle of the band centre", label="roll angle of the load")
    half_width: Array = shown("mm", "contact half-width used for c_self", name="contact_half_width")
    pressed_half_width: Array = shown(
        "mm", "half-width of the pressure distribution used for neighbours and root stress"
    )
    position: Array = shown(
        "mm", "face position of the band peak, from mid-face", name="face_position", label="face position"
    )
    before: Array = shown("mm", "extent of the band towards end I (-b/2)", name="band_before")
    after: Array = shown("mm", "extent of the band towards end II (+b/2)", name="band_after")
    c_self: Array = shown("um/N", "approach of the contact per force")
    c_prev: Array = shown("um/N", "deflection of the same band on the previous tooth")
    c_next: Array = shown("um/N", "deflection of the same band on the next tooth (facing the loaded flank)")


def solid_table(
    gear: Gear, influence: SolidInfluence, radii: ArrayLike, positions: ArrayLike, half_width: ArrayLike
) -> SolidTable:
    """Tabulate a solid gear's compliance and root stress.

    Parameters
    ----------
    gear : Gear
    influence : SolidInfluence
        Of this gear.
    radii : array_like, shape (R,)
        [m], on the flank.
    positions : array_like, shape (Z,)
        Along the face, from its middle [m].
    half_width : array_like, shape (R,) or ()
        Of the contact [m].

    Returns
    -------
    SolidTable

    Raises
    ------
    RangeError
        If a radius lies off the flank, or a position off the face.
    """
    started = time.perf_counter()
    m, r = gear.module, np.atleast_1d(np.asarray(radii, dtype=float))
    asked = bands_of_table(influence.fine, r / m, np.asarray(positions, dtype=float) / m, np.asarray(half_width) / m, m)
    z, before, after, b = (x * m for x in (asked.place, asked.before, asked.after, asked.half_width))
    fine = band_numbers(influence.fine, asked, m)
    root = fine.root
    relative = {key: np.full((r.size, 1), np.nan) for key in fine.names}
    if influence.settings.source == "slices":
        relative = {key: np.full((r.size, 1), influence.error[_MISSED[key]]) for key in fine.names}
    elif influence.coarse is not None:
        beside, coarse = _radii_beside(influence.fine, asked.radius), band_numbers(influence.coarse, asked, m)
        for key, difference in fine.apart(coarse).items():
            relative[key] = influence.entry_shares[_ESTIMATE[key]] * _worst_beside(difference.max(axis=1), beside)
        relative |= _no_less_than_part_of_the_other(relative)
        if influence.fine.tau == 0.0:
            usual = {side: _usual_beside(square, beside) for side, square in fine.usually_apart(coarse).items()}
            part = np.maximum(usual["compression"], OF_OTHER_FILLET * usual["tension"])
            relative["root_compression"] = _times_usual(influence.fine, influence.coarse) * part
    c = {key: value / (gear.material.young_modulus * m) for key, value in fine.compliance.items()}
    errors = {
        "c_self": relative["c_self"] * c["c_self"],
        "c_neighbour": np.maximum(relative["c_prev"] * c["c_prev"], relative["c_next"] * c["c_next"]),
        **{f"root_{side}": relative[f"root_{side}"] * np.abs(found.value) for side, found in root.items()},
    }
    roll = gear.tooth.roll(r / m)
    return SolidTable(
        root, errors, influence, time.perf_counter() - started, r, roll, b, asked.pressed_half_width * m, z, before,
        after, **c,
    )  # fmt: skip


@dataclass(frozen=True)
class BandsOfTable:
    """Places of the bands, lengths in modules: radius, widths (R,), place and reach along the face (Z,)."""

    radius: Array
    place: Array
    before: Array
    after: Array
    pressed_half_width: Array
    half_width: Array

    def bands(self, solution: SolidSolution) -> Bands:
        """All of them, radius by radius, along the contact lines through their places."""
        up = (x[:, None] for x in (self.radius, self.pressed_half_width, solution.line_slope(self.radius)))
        radius, width, slope = up
        return bands(radius, self.place, self.before, width, after=self.after, slope=slope)


def bands_of_table(
    solution: SolidSolution, radius: ArrayLike, place: ArrayLike, half_width: ArrayLike, module: float = math.nan
) -> BandsOfTable:
    """Bands at every radius and every place along the face; all in modules.

    Parameters
    ----------
    solution : SolidSolution
    radius, place : array_like, shape (R,), (Z,)
    half_width : array_like, shape (R,) or ()
        Of the contacts.
    module : float, optional
        [m]; if given, the refusal is in millimetres.

    Raises
    ------
    RangeError
        If a radius lies off the flank, or a place off the face.
    """
    r, z = (np.atleast_1d(np.asarray(x, dtype=float)) for x in (radius, place))
    half = 0.5 * solution.width
    if (off := z[np.abs(z) > half * (1.0 + 1e-9)]).size:
        unit, name = (1.0, "modules") if math.isnan(module) else (1e3 * module, "mm")
        end = half * unit
        rule = f"is outside the face width, {-end:.6g} to {end:.6g} {name}"
        raise RangeError("face_positions", f"{off[0] * unit:.6g} {name}", rule)
    z = np.clip(z, -half, half)
    width = np.broadcast_to(np.asarray(half_width, dtype=float), r.shape).copy()
    before, after = np.minimum(BAND_REACH, half + z), np.minimum(BAND_REACH, half - z)
    return BandsOfTable(r, z, before, after, solution.band_half_width(r), width)


@dataclass(frozen=True)
class BandNumbers:
    """What bands feel: compliances of shape (R, Z), module and Young's modulus one, and root stress by side."""

    compliance: Mapping[str, Array]
    root: Mapping[Side, RootStressOfBands]

    @property
    def names(self) -> tuple[str, ...]:
        """Of all numbers, in the order of the table's columns."""
        return (*self.compliance, *(f"root_{side}" for side in self.root))

    def apart(self, other: BandNumbers) -> dict[str, Array]:
        """How far another solution's numbers lie from these, over these, shape (R, Z) each.

        Of root stress the curves along the face are compared beside the largest: largest values may agree by chance.
        """
        found = {}
        for key, value in self.compliance.items():  # at the end of a rack there is no next tooth
            apart = np.abs(other.compliance[key] - value)
            found[key] = np.divide(apart, np.abs(value), out=np.zeros_like(apart), where=value != 0.0)
        for side, root in self.root.items():
            sign = 1.0 if side == "tension" else -1.0
            apart = curves_apart(sign * root.along, sign * other.root[side].along, BESIDE_LARGEST)
            found[f"root_{side}"] = apart / np.abs(root.value)
        return found

    def usually_apart(self, other: BandNumbers) -> dict[Side, Array]:
        """Mean square over the face of how far another solution's root stress lies from this one, shape (R,).

        The larger one of two: of the largest values, and of the curves along the face beside them, over these.
        """
        found = {}
        for side, root in self.root.items():
            high = root.along / root.value[..., None]
            counts = high >= BESIDE_LARGEST * high.max(axis=-1, keepdims=True)
            curves = (other.root[side].along - root.along) / root.value[..., None]
            along = np.where(counts, curves**2, 0.0).sum(axis=(1, 2)) / counts.sum(axis=(1, 2))
            found[side] = np.maximum(along, np.mean((other.root[side].value / root.value - 1.0) ** 2, axis=1))
        return found


def band_numbers(solution: SolidSolution, asked: BandsOfTable, module: float = 1.0) -> BandNumbers:
    """Compliances and largest root stresses, stress per unit force on a gear of this module."""
    pressed = asked.bands(solution)
    shape = asked.radius.size, asked.place.size
    found = {"c_self": np.empty(shape)}
    for i, (r, b) in enumerate(zip(asked.radius, asked.half_width, strict=True)):
        for j in range(shape[1]):
            found["c_self"][i, j] = _own(solution, float(r), asked, j, float(b))
    for k, name in ((-1, "c_prev"), (1, "c_next")):
        found[name] = np.diagonal(solution.deflection(k, pressed, pressed)).reshape(shape)
    return BandNumbers(found, {side: _root(solution, side, asked, module) for side in solution.fillets})


def _radii_beside(solution: SolidSolution, radius: Array) -> Mask:
    """Which radii lie within a share of the flank beside each: two solutions may agree at one of them by chance."""
    flank = solution.flank
    arc = flank.arc_of_radius(radius)
    return np.asarray(np.abs(arc[:, None] - arc) <= _BESIDE * (flank.flank_end - flank.flank_start))


def _times_usual(fine: SolidSolution, coarse: SolidSolution) -> float:
    """So many times what two solutions of a spur gear usually differ by is the error of root compression."""
    alike = fine.settings.section.order == coarse.settings.section.order
    return _USUAL_COMPRESSION if alike else _OF_ANOTHER_ORDER


def _worst_beside(apart: Array, beside: Mask) -> Array:
    """Largest of what two solutions differ by beside each radius, shape (R, 1)."""
    return np.where(beside, apart, 0.0).max(axis=1, keepdims=True)


def _usual_beside(square: Array, beside: Mask) -> Array:
    """Root mean square of what two solutions differ by beside each radius, shape (R, 1)."""
    return np.sqrt(np.where(beside, square, 0.0).sum(axis=1, keepdims=True) / beside.sum(axis=1, keepdims=True))


def _no_less_than_part_of_the_other(relative: Mapping[str, Array]) -> dict[str, Array]:
    """Relative errors of root stress of both sides, of what solutions differ by on either of them."""
    tension, compression = relative["root_tension"], relative["root_compression"]
    return {
        "root_tension": np.maximum(tension, OF_OTHER_FILLET * compression),
        "root_compression": np.maximum(compression, OF_OTHER_FILLET * tension),
    }


def _own(solution: SolidSolution, radius: float, asked: BandsOfTable, j: int, half_width: float) -> float:
    """Approach of one contact under its own force, on the contact line through its middle."""
    z, before, after = asked.place[j], asked.before[j], asked.after[j]
    stations = np.array([z - before, z, z + after])[[before > 0.0, True, after > 0.0]]
    flank = solution.flank
    slope = solution.line_slope(np.array([radius]))[0]
    arc = flank.arc_of_radius(np.array([radius]))[0] + slope * (stations - z)
    places = flank.radius_of_arc(np.clip(arc, flank.flank_start, flank.flank_end))
    line = hats(places, stations, solution.band_half_width(np.array([radius]))[0], slope=slope)
    own = int(before > 0.0)
    return float(line_compliance(solution, line, half_width)[own, own])


def _root(solution: SolidSolution, side: Side, asked: BandsOfTable, module: float) -> RootStressOfBands:
    """Look for the largest stress over a fillet and the face, load by load."""
    fillet, sign = solution.fillets[side], 1.0 if side == "tension" else -1.0
    pressed, shape = asked.bands(solution), (asked.radius.size, asked.place.size)
    count = max(_FEWEST_PLACES, 2 * whole(0.5 * _PLACES_PER_MODULE * solution.width) + 1)
    places = np.linspace(-0.5, 0.5, count) * solution.width
    stress = solution.fillet_stress(0, side, pressed, places)  # (3, points, S, P)
    flat = stress[0].reshape(stress.shape[1], -1)
    end = np.tile(solution.root_end(0, side, pressed), count)
    value, arc = (x.reshape(count, -1) for x in extreme(flat, fillet.arc, sign, end))
    best, load = first_of_largest(sign * value, axis=0), np.arange(value.shape[1])
    at = arc[best, load]
    beside = [
        np.array([np.interp(at[p], fillet.arc, stress[c, :, best[p], p]) for p in load]).reshape(shape) for c in (1, 2)
    ]
    return RootStressOfBands(
        value=value[best, load].reshape(shape) / module**2,
        position=places[best].reshape(shape) * module,
        radius=np.interp(at, fillet.arc, np.hypot(*fillet.place)).reshape(shape) * module,
        axial=beside[0] / module**2,
        shear=beside[1] / module**2,
        places=places * module,
        along=value.T.reshape(*shape, count) / module**2,
    )
