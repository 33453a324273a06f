"""Exposure of surface-hardened flanks over depth below places of the path: what is read and what is found."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING

from fegear.base.shown import shown, shows
from fegear.formulas.iso6336.part4_flank_fracture import PERMISSIBLE, Exposure
from fegear.geometry.pair import Member

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.built.rated_pair import PairToRate
    from fegear.formulas.hardened_case import HardenedCase


#: Places from A to E besides the named points, and depths.
PLACES, DEPTHS = 61, 241


@dataclass(frozen=True)
class FlankFractureInputs:
    """What the stage reads.

    Parameters
    ----------
    asked : PairToRate
    cases : (HardenedCase, HardenedCase)
        Of driver and driven.
    materials, qualities : (str, str)
        As `strength` names them, of driver and driven.
    material_factor : float
        K_material.
    said : tuple of str
    alone : bool
        Whether no other pair of the case can be evaluated: then a formula's range ends the run, not a remark.
    """

    asked: PairToRate
    cases: tuple[HardenedCase, HardenedCase]
    materials: tuple[str, str]
    qualities: tuple[str, str]
    material_factor: float
    said: tuple[str, ...] = field(compare=False)
    alone: bool = False


@dataclass(frozen=True)
class Below:
    """A gear over depth below one place of the path, shape (M,)."""

    letter: str
    depth: Array = shown("mm", "depth y below the flank", label="depth below the flank")
    load_stress: Array = shown("MPa", "tau_eff,L", label="shear stress")
    stress: Array = shown("MPa", "tau_eff")
    exposure: Array = shown("", "A_FF", label="material exposure A_FF")
    strength: Array = shown("MPa", "tau_per(y)")
    hardness: Array = shown("", "HV(y), Vickers", label="hardness HV")
    residual: Array = shown(
        "MPa", "residual stress sigma_RS(y), uniform over profile and face width", name="residual_stress"
    )

    @property
    def key(self) -> str:
        """Its letter as names of columns have it."""
        return self.letter.translate(str.maketrans("", "", "_{}"))

    def every(self, step: int) -> Below:
        """It at every so manyth depth."""
        arrays = [one.name for one in fields(self) if one.name != "letter"]
        return replace(self, **{name: getattr(self, name)[::step] for name in arrays})


@dataclass(frozen=True)
class GearExposure:
    """One gear below its flank.

    Parameters
    ----------
    found : Exposure
    depth, hardness, residual : ndarray, shape (M,)
    over_path : ndarray, shape (N,)
        Largest A_FF below each place, from the depth of the half-width on.
    most : float
        Largest of these.
    most_load : float
        The same without residual stress.
    place, at_depth : float
        Where it is: on the path of contact, and how deep [m].
    crushing, least_agma : float
        NaN where there is none for the material.
    """

    found: Exposure
    depth: Array
    hardness: Array
    residual: Array
    over_path: Array = shown("", "A_FF, maximum below b_H", name="exposure")
    place: float = shown("mm", "position of the maximum exposure on the line of action, from the pitch point")
    most: float = shown("", f"maximum material exposure (permissible {PERMISSIBLE:g})", name="A_FF")
    most_load: float = shown("", "maximum exposure without residual stress (upper bound)", name="A_FF_load")
    at_depth: float = shown("mm", "depth of the maximum exposure", name="A_FF_depth")
    crushing: float = shown("mm", "Eht_c of ISO 6336-5, minimum against case crushing")
    least_agma: float = shown("mm", "h_e,min of AGMA 2101 with ISO's sigma_H")

    @property
    @shows("", f"safety factor, 1/A_FF (minimum {1.0 / PERMISSIBLE:g})", name="S_FF")
    def safety(self) -> float:
        """Against flank fracture."""
        return 1.0 / self.most

    def below(self, k: int, letter: str = "") -> Below:
        """It below the k-th place of the path, under the letter of that place."""
        stress, load, exposure = (one[k] for one in (self.found.stress, self.found.load_stress, self.found.exposure))
        return Below(letter, self.depth, load, stress, exposure, self.found.strength, self.hardness, self.residual)


@dataclass(frozen=True)
class FlankFractureData:
    """What the stage finds.

    Parameters
    ----------
    x, sharing, pressure, half_width, radius : ndarray, shape (N,)
    points : mapping of str to int
        Named points A to E among the places.
    gears : mapping of Member to GearExposure
    load : float
        Along the line of action, of the spectrum's largest level where there is one [N].
    """

    points: dict[str, int]
    gears: dict[Member, GearExposure]
    load: float
    x: Array = shown("mm", "on the line of action, from the pitch point")
    sharing: Array = shown("", "X_CP, that of ISO/TS 6336-22 without relief", name="load_sharing")
    pressure: Array = shown("MPa", "p_dyn,CP with all load factors", name="hertz_pressure")
    half_width: Array = shown("mm", "b_H of the contact")
    radius: Array = shown("mm", "rho_red,CP in the normal section", name="relative_radius")
