"""The stiffness and root-stress table of a gear with a width, over the radius and the face position of a band."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError
from fegear.fem.root_stress import extreme
from fegear.fem.solid.bands import bands
from fegear.frozen import ReadOnlyArrays

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.fem.influence import Side
    from fegear.fem.solid.bands import Bands
    from fegear.fem.solid.influence import SolidInfluence
    from fegear.geometry.gear import Gear

#: How far a band reaches to either side along the face, where the face goes on so far [modules].
BAND_REACH = 0.5
#: Places along the face per module at which root stress is looked at, and how many at least.
_PLACES_PER_MODULE, _FEWEST_PLACES = 5.0, 33


@dataclass(frozen=True)
class RootStressOfBands(ReadOnlyArrays):
    """The largest tangential stress of one fillet under each band, per unit force [1/m^2]; shape (R, Z) but `along`.

    Parameters
    ----------
    value : ndarray
        Tangential stress in the transverse section, negative on the compressed side.
    position, radius : ndarray
        Where it sits along the face, from its middle, and from the gear's axis [m].
    axial, shear : ndarray
        Stress across it in the surface, all but along the axis, and the shear between both, at the same place.
    places : ndarray, shape (S,)
        Along the face [m].
    along : ndarray, shape (R, Z, S)
        The largest up the fillet at each of these places.
    """

    value: Array
    position: Array
    radius: Array
    axial: Array
    shear: Array
    places: Array
    along: Array


@dataclass(frozen=True)
class SolidTable(ReadOnlyArrays):
    """Compliance and root stress of a solid gear's tooth, SI; arrays of shape (R, Z) where nothing else is said.

    Every number is per unit force along the transverse line of action. The force presses on a band about its place:
    semi-elliptic up the flank, a hat along the face, half a hat at an end of the face.

    Parameters
    ----------
    radius, roll_angle, half_width : ndarray, shape (R,)
        Of the bands' middles [m], [rad]; half-width of the pressure up the flank [m].
    position, before, after : ndarray, shape (Z,)
        Place along the face from its middle, and how far the band reaches to either side [m].
    c_self, c_prev, c_next : ndarray
        Mean deflection per force [m/N] of the band itself, and of the same band on the teeth before and after.
    root : mapping of {"tension", "compression"} to RootStressOfBands
    errors : mapping of str to ndarray
        Estimated absolute error of c_self, c_neighbour, root_tension, root_compression.
    influence : SolidInfluence
        What the table was made from.
    seconds : float
    """

    radius: Array
    roll_angle: Array
    half_width: Array
    position: Array
    before: Array
    after: Array
    c_self: Array
    c_prev: Array
    c_next: Array
    root: Mapping[Side, RootStressOfBands]
    errors: Mapping[str, Array]
    influence: SolidInfluence
    seconds: float


def solid_table(gear: Gear, influence: SolidInfluence, radii: ArrayLike, positions: ArrayLike) -> SolidTable:
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

    Returns
    -------
    SolidTable

    Raises
    ------
    RangeError
        If a radius lies off the flank, or a position off the face.
    """
    started = time.perf_counter()
    m, half = gear.module, 0.5 * influence.width
    r, z = (np.atleast_1d(np.asarray(x, dtype=float)) for x in (radii, positions))
    if (off := z[np.abs(z) > half * m * (1.0 + 1e-9)]).size:
        end = half * m * 1e3
        raise RangeError(
            "face_positions", f"{off[0] * 1e3:.6g} mm", f"lies off the face, which runs from {-end:.6g} to {end:.6g} mm"
        )
    place = np.clip(z / m, -half, half)
    before, after = np.minimum(BAND_REACH, half + place), np.minimum(BAND_REACH, half - place)
    width = influence.band_half_width(r / m)
    pressed = bands((r / m)[:, None], place, before, width[:, None], after=after)
    shape = (r.size, z.size)

    def own(k: int) -> Array:
        return np.diagonal(influence.deflection(k, pressed, pressed)).reshape(shape) / (gear.material.young_modulus * m)

    c = {k: own(k) for k in (-1, 0, 1)}
    root = {side: _root(influence, side, pressed, shape, m) for side in influence.fine.fillets}
    relative = influence.error
    errors = {
        "c_self": relative.get("deflection", np.nan) * c[0],
        "c_neighbour": relative.get("neighbour", np.nan) * c[0],
        **{f"root_{side}": relative.get(f"root_{side}", np.nan) * np.abs(found.value) for side, found in root.items()},
    }
    roll = np.sqrt((r - gear.base_radius) * (r + gear.base_radius)) / gear.base_radius
    return SolidTable(
        r, roll, width * m, z, before * m, after * m, c[0], c[-1], c[1], root, errors, influence,
        time.perf_counter() - started,
    )  # fmt: skip


def _root(
    influence: SolidInfluence, side: Side, pressed: Bands, shape: tuple[int, int], module: float
) -> RootStressOfBands:
    """Look for the largest stress over a fillet and the face, load by load."""
    fillet, sign = influence.fine.fillets[side], 1.0 if side == "tension" else -1.0
    count = max(_FEWEST_PLACES, 2 * round(0.5 * _PLACES_PER_MODULE * influence.width) + 1)
    places = np.linspace(-0.5, 0.5, count) * influence.width
    stress = influence.fillet_stress(0, side, pressed, places)  # (3, points, S, P)
    flat = stress[0].reshape(stress.shape[1], -1)
    end = influence.fine.root_end(0, side, pressed)
    value, arc = (x.reshape(count, -1) for x in extreme(flat, fillet.arc, sign, np.tile(end, count)))
    best, load = np.argmax(sign * value, axis=0), np.arange(value.shape[1])
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
