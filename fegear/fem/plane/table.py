"""The stiffness and root-stress table of one gear: what most users come for first."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.base.shown import shown
from fegear.fem.plane.contact_width import check_half_widths
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import Progress, check_gear, solve_gear
from fegear.geometry.gear import Gear

#: Load positions at a time: compliances between neighbours come as a matrix over all of them.
_BLOCK = 512


@dataclass(frozen=True)
class StiffnessTable:
    """Compliance and root stress of a gear's tooth over load positions, per unit face width, SI; arrays of shape (P,).

    Compliances are per unit line load; tooth +1 ("next") is the one that the loaded flank faces. Root stresses are
    tangential, in the fillets of the loaded tooth. Errors are absolute: of c_self, c_neighbour, root_tension,
    root_compression. `influence` is what the table was made from.
    """

    errors: Mapping[str, Array]
    influence: GearInfluence
    seconds: float
    radius: Array = shown("mm", "radius of the contact point", label="radius of the load", table="flank")
    roll_angle: Array = shown("deg", "roll angle of the contact point", label="roll angle of the load", table="flank")
    c_self: Array = shown(
        "um.mm/N", "deflection of the loaded tooth at the contact per line load", label="compliance", table="flank"
    )
    c_prev: Array = shown(
        "um.mm/N",
        "deflection of the previous tooth at the same radius per line load",
        label="compliance",
        table="flank",
    )
    c_next: Array = shown(
        "um.mm/N",
        "deflection of the next tooth (facing the loaded flank) per line load",
        label="compliance",
        table="flank",
    )
    half_width: Array = shown("mm", "contact half-width used for c_self", name="contact_half_width", table="flank")
    root_tension: Array = shown(
        "MPa.mm/N", "root stress, tension side: maximum tangential stress in the fillet of the loaded flank",
        label="maximum root stress per line load", table="flank")  # fmt: skip
    root_tension_radius: Array = shown("mm", "radius of the maximum", table="flank")
    root_tension_angle: Array = shown(
        "deg",
        "angle of the fillet tangent to the tooth centre line at the maximum",
        label="angle of fillet tangent to tooth centre line",
    )
    root_compression: Array = shown(
        "MPa.mm/N", "root stress, compression side: minimum tangential stress in the opposite fillet", table="flank"
    )
    root_compression_radius: Array = shown("mm", "radius of the maximum", table="flank")
    root_compression_angle: Array = shown("deg", "angle of the fillet tangent on the compression side")
    c_self_reduction: Array = shown(
        "um.mm/N", "reduction of c_self for contact with a mating flank near the tip; not included in c_self"
    )

    @cached_property
    def over_roll(self) -> StiffnessTable:
        """The same in the order of the roll angle, root compression as a magnitude."""
        order = np.argsort(self.roll_angle)
        arrays = {one.name: getattr(self, one.name)[order] for one in fields(self) if one.metadata}
        arrays["root_compression"] = -arrays["root_compression"]
        return replace(self, errors={key: error[order] for key, error in self.errors.items()}, **arrays)


def stiffness_table(
    gear: Gear,
    radii: ArrayLike,
    half_width: ArrayLike,
    settings: MeshSettings | None = None,
    *,
    influence: GearInfluence | None = None,
    progress: Progress | None = None,
) -> StiffnessTable:
    """Tabulate one gear's compliance and root stress.

    Parameters
    ----------
    gear : Gear
    radii : array_like, shape (P,)
        Load radii [m], on the flank.
    half_width : array_like
        Contact half-width [m], one or one for each radius.
    settings : MeshSettings, optional
    influence : GearInfluence, optional
        If the gear has been solved already.
    progress : callable, optional

    Returns
    -------
    StiffnessTable

    Raises
    ------
    InputError
        If it is not a gear of the geometry package.
    RangeError
        If a radius lies off the flank, or a half-width is one that no flank holds (`check_half_widths`).
    """
    check_gear(gear)
    started = time.perf_counter()
    r = np.atleast_1d(np.asarray(radii, dtype=float))
    b = np.broadcast_to(np.asarray(half_width, dtype=float), r.shape).copy()
    low, high = gear.involute_radii
    off = ~((r >= low * (1 - 1e-9)) & (r <= high * (1 + 1e-9)))
    if off.any():
        raise RangeError(
            "radii",
            f"{r[off][0] * 1e3:.6g} mm",
            f"is outside the involute flank, {low * 1e3:.6g} to {high * 1e3:.6g} mm",
        )
    check_contacts(gear, r, b)
    known = influence or solve_gear(gear, settings, progress=progress)
    parts = [_columns(known, r[i : i + _BLOCK], b[i : i + _BLOCK]) for i in range(0, r.size, _BLOCK)]
    found = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    for array in (r, b, *found.values()):
        array.flags.writeable = False
    errors = {name.removeprefix("error_of_"): found.pop(name) for name in tuple(found) if name.startswith("error_of_")}
    angle = gear.tooth.side * np.sqrt((r - gear.base_radius) * (r + gear.base_radius)) / gear.base_radius
    return StiffnessTable(
        errors, known, time.perf_counter() - started, radius=r, roll_angle=angle, half_width=b, **found
    )


def _columns(known: GearInfluence, r: Array, b: Array) -> dict[str, Array]:
    """Every column over some of the load positions, and each error as ``error_of_<column>``."""
    module = known.gear.module
    c_self, c_self_error, less = known.contact(r, b)
    c_next, c_neighbour_error = known.neighbour_with_error(1, r, r)
    found = {
        "c_self": c_self,
        "c_self_reduction": less,
        "c_prev": np.diagonal(known.neighbour(-1, r, r)),
        "c_next": np.diagonal(c_next),
        "error_of_c_self": c_self_error,
        "error_of_c_neighbour": np.diagonal(c_neighbour_error),
    }
    for side in SIDES:
        value, arc, error = known.root_stress_with_error(0, side, r, b)
        fillet = known.fine.fillets[side]
        found[f"root_{side}"] = value
        found[f"root_{side}_radius"] = np.interp(arc / module, fillet.arc, fillet.radius) * module
        found[f"root_{side}_angle"] = np.interp(arc / module, fillet.arc, fillet.tangent_angle)
        found[f"error_of_root_{side}"] = error
    return found


def check_contacts(gear: Gear, radii: ArrayLike, half_width: ArrayLike, key: str = "contact_half_width") -> None:
    """Refuse contacts that the gear's flank cannot hold, in millimetres.

    Parameters
    ----------
    gear : Gear
    radii, half_width : array_like, shape (P,)
        [m].
    key : str
        What the refusal is about.

    Raises
    ------
    RangeError
    """
    r, m = np.asarray(radii, dtype=float), gear.module
    low, high = gear.involute_radii
    # On an involute the squared radius grows by twice the base radius times the arc length.
    room = np.minimum(r**2 - low**2, high**2 - r**2) / (2.0 * gear.base_radius)
    check_half_widths(np.asarray(half_width) / m, room / m, unit="mm", scale=1e3 * m, key=key)
