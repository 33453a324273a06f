"""Deviations of a gear's flanks: its own, measured or agreed, and those of its tolerance class where it has none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Collection

    from fegear.case.gear import GearPart
    from fegear.geometry.gear import Gear


#: f_pb along the line of action, f_Halpha, f_falpha and f_Hbeta, as ``deviations`` of a gear names them.
Deviation = Literal["base_pitch", "profile_slope", "profile_form", "helix_slope"]


def own_deviation(part: GearPart, kind: Deviation) -> float | None:
    """What the case itself says of a deviation [m]; None where it says nothing."""
    found: float | None = getattr(part.deviations, kind, None)
    return found


def gear_deviations(
    part: GearPart, made: Gear, grade: int | None, kinds: Collection[Deviation], *, rounded: bool = False
) -> dict[Deviation, float]:
    """Deviations of some kinds [m]: the gear's own, else by class; kinds that neither tells are left out.

    Parameters
    ----------
    part : GearPart
    made : Gear
    grade : int or None
        Flank tolerance class; None where the gear has none.
    kinds : collection of str
    rounded : bool
        Whether tolerances are rounded as ISO 1328-1:2013 prints them.

    Raises
    ------
    RangeError
        If a class is asked of a gear outside the sizes of the standard; a gear whose own deviations say all is not.
    """
    from fegear.formulas.iso1328 import tolerances_of

    own = {kind: value for kind in kinds if (value := own_deviation(part, kind)) is not None}
    if grade is None or len(own) == len(kinds):
        return own
    allowed = tolerances_of(made, grade)
    allowed = allowed.rounded if rounded else allowed
    by_class: dict[Deviation, float] = {
        "base_pitch": allowed.base_pitch(made.transverse_pressure_angle), "profile_slope": allowed.profile_slope,
        "profile_form": allowed.profile_form, "helix_slope": allowed.helix_slope,
    }  # fmt: skip
    return {kind: own.get(kind, by_class[kind]) for kind in kinds}
