"""Both gears' influence functions put together for the tooth pairs in contact (Mark, App. A)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from fegear.base.brief import Brief
from fegear.base.effects import RootEffects
from fegear.base.errors import InputError
from fegear.contact.plane.coupled_teeth import CoupledTeeth, Hertz

if TYPE_CHECKING:
    from fegear.contact.plane.compliance import GearCompliance
    from fegear.geometry.pair import GearPair


@dataclass(frozen=True)
class PairCompliance(CoupledTeeth, Brief):
    """Compliance of a gear pair from the sources of its two gears.

    Parameters
    ----------
    pair : GearPair
    driver, driven : GearCompliance
    coupling : bool
        Whether a loaded tooth deflects its neighbours.
    hertz : {"load-dependent", "linear", "none"}
        The contact's half-width follows each pair's own load; stays what it is under `nominal_load` on one pair; or
        stays the source's reference half-width.
    nominal_load : float
        Load [N] for the linear contact.
    roots : RootEffects
        Effects on root stress, which change no compliance.
    """

    pair: GearPair
    driver: GearCompliance
    driven: GearCompliance
    coupling: bool = True
    hertz: Hertz = "load-dependent"
    nominal_load: float = math.nan
    roots: RootEffects = field(default_factory=RootEffects)

    def __post_init__(self) -> None:
        """Refuse helical pairs, and a linear contact without a load to be linear about."""
        if self.pair.driver.helix_angle != 0.0:
            angle = f"helix angle {math.degrees(self.pair.driver.helix_angle):.6g} deg"
            raise InputError("pair", angle, "is not possible in the plane (2D) model", "use spur gears")
        if self.hertz not in ("load-dependent", "linear", "none"):
            raise InputError("effects.hertz", f'"{self.hertz}"', 'must be "load-dependent", "linear" or "none"')
        if self.hertz == "linear" and not self.nominal_load > 0.0:
            raise InputError("effects.hertz", '"linear"', "requires a load for the contact width")

    @property
    def face_width(self) -> float:
        """Common face width [m]."""
        return self.pair.face_width

    @property
    def contact_modulus(self) -> float:
        """E* [Pa], 1/E* = sum of (1 - nu^2)/E in plane strain, of 1/E in plane stress: Hertzian line contact."""
        return 1.0 / (1.0 / self.pair.driver.plane_modulus + 1.0 / self.pair.driven.plane_modulus)

    @property
    def middle_of_path(self) -> float:
        """Before it the driven tip is the nearer one [m]."""
        return 0.5 * (self.pair.x_start + self.pair.x_end)

    def refuse_unequal(self, asker: str) -> None:
        """Refuse gears whose teeth differ where one tooth stands for all.

        Raises
        ------
        InputError
        """
        if self.cycles > 1:
            raise InputError("pair", "teeth that differ", f"are not known to {asker}", "take gears of equal teeth")

    def reversed(self) -> PairCompliance:
        """The same gears with driver and driven exchanged."""
        return replace(self, pair=self.pair.reversed(), driver=self.driven, driven=self.driver)
