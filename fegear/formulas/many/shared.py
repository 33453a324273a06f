"""What ISO 6336 asks of arrays of pairs besides their geometry: quality, duty and choices that all of them share.

The twin of `fegear.formulas.iso6336.conditions.Conditions`: materials, method, edition and alignment are those of all
pairs; deviations, loads and load cycles are each pair's own.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.formulas.iso1328 import CLASSES
from fegear.formulas.iso6336.conditions import Replacement
from fegear.formulas.iso6336.part1_face_load import Alignment

if TYPE_CHECKING:
    from fegear.base.arrays import Index, Mask
    from fegear.formulas.iso6336.part2_pitting import TipRelief
    from fegear.formulas.iso6336.rated import Both, Edition, Strength
    from fegear.formulas.many.pairs import ManyPairs

#: The class of ISO 1328-1 for which its formulas are written.
_WRITTEN_FOR = 5


@dataclass(frozen=True)
class ManyQualities(ReadOnlyArrays):
    """How well gears are made; deviations of pinion and wheel, shape (2, N) [m].

    Parameters
    ----------
    grade : int
        The coarser tolerance class.
    base_pitch, profile_form, helix_slope : ndarray, shape (2, N)
    flank_roughness, root_roughness, tip_relief : (float, float)
    helix_slope_5 : ndarray, shape (N,)
        f_Hbeta5 of the worse gear, for a favourable contact pattern.
    """

    grade: int
    base_pitch: Array
    profile_form: Array
    helix_slope: Array
    flank_roughness: Both
    root_roughness: Both
    tip_relief: Both = (0.0, 0.0)
    helix_slope_5: Array = field(default_factory=lambda: np.zeros(0))

    def at(self, rows: Index | Mask | slice) -> ManyQualities:
        """Those of some of the pairs."""
        some = self.helix_slope_5[rows] if self.helix_slope_5.size else self.helix_slope_5
        deviations = (self.base_pitch[:, rows], self.profile_form[:, rows], self.helix_slope[:, rows])
        return ManyQualities(self.grade, *deviations, self.flank_roughness, self.root_roughness, self.tip_relief, some)


def rounded_tolerances(values: Array) -> Array:
    """Tolerances [m] as ISO 1328-1, 5.2.3, rounds them: whole micrometres above 10, halves above 5, tenths to 5 um."""
    micrometres = np.round(np.asarray(values) / 1e-6, 9)
    per_unit = np.where(micrometres > 10.0, 1.0, np.where(micrometres > 5.0, 2.0, 10.0))
    # decimals as they are written: a half that has lost its last bit is still rounded up
    return np.asarray(np.floor(np.round(micrometres * per_unit, 8) + 0.5) / per_unit * 1e-6)


def helix_slopes(tolerance_class: int, pairs: ManyPairs) -> Array:
    """f_HbetaT of a class of ISO 1328-1, rounded, shape (2, N) [m]."""
    step = np.sqrt(2.0) ** (tolerance_class - _WRITTEN_FOR) * 1e-6
    d, b = np.abs(pairs.diameters) / 1e-3, pairs.face_widths / 1e-3
    return rounded_tolerances((0.05 * np.sqrt(d) + 0.35 * np.sqrt(b) + 4.0) * step)


def qualities_of_class(
    tolerance_class: int, pairs: ManyPairs, flank_roughness: Both, root_roughness: Both, tip_relief: Both = (0.0, 0.0)
) -> ManyQualities:
    """Deviations by a class of ISO 1328-1:2013, rounded as it says.

    Parameters
    ----------
    tolerance_class : int
        1 to 11, of both gears.
    pairs : ManyPairs
    flank_roughness, root_roughness, tip_relief : (float, float)
        Rz and C_a of pinion and wheel [m].
    """
    if tolerance_class not in CLASSES:
        raise ValueError(tolerance_class)
    step = np.sqrt(2.0) ** (tolerance_class - _WRITTEN_FOR) * 1e-6
    d, m = np.abs(pairs.diameters) / 1e-3, pairs.module / 1e-3
    pitch = rounded_tolerances((0.001 * d + 0.4 * m + 5.0) * step) * np.cos(pairs.transverse_pressure_angle)
    form = rounded_tolerances(np.broadcast_to((0.55 * m + 5.0) * step, d.shape))
    return ManyQualities(
        tolerance_class, pitch, form, helix_slopes(tolerance_class, pairs), flank_roughness, root_roughness,
        tip_relief, helix_slopes(5, pairs).max(axis=0),
    )  # fmt: skip


@dataclass(frozen=True)
class ManyDuties(ReadOnlyArrays):
    """What pairs transmit, how fast and how long.

    Parameters
    ----------
    tangential, speed : ndarray, shape (N,)
        F_t [N]; of the pinion [rad/s].
    cycles : ndarray, shape (2, N)
        N_L of pinion and wheel.
    viscosity, application_factor, mesh_load_factor : float
        nu_40 [m^2/s], K_A, K_gamma.
    meshes : (int, int)
        With how many mates pinion and wheel mesh at once.
    stress_ratio : (float, float)
        R of the roots of pinion and wheel, for Y_M.
    mean_stress : (float, float), optional
        Y_M as specified.
    """

    tangential: Array
    speed: Array
    cycles: Array
    viscosity: float
    application_factor: float = 1.0
    mesh_load_factor: float = 1.0
    meshes: tuple[int, int] = (1, 1)
    stress_ratio: Both = (0.0, 0.0)
    mean_stress: Both | None = None

    @property
    def applied(self) -> Array:
        """F_t K_A K_gamma [N]."""
        return np.asarray(self.tangential * self.application_factor * self.mesh_load_factor)

    def at(self, rows: Index | Mask | slice) -> ManyDuties:
        """Those of some of the pairs."""
        values = {one.name: getattr(self, one.name) for one in fields(self)}
        values |= {"tangential": self.tangential[rows], "speed": self.speed[rows], "cycles": self.cycles[:, rows]}
        return ManyDuties(**values)


@dataclass(frozen=True)
class ManyConditions:
    """Pairs to be rated; what all of them share is the field of `Conditions` of the same name.

    Parameters
    ----------
    pairs : ManyPairs
    strength : (Strength, Strength)
    quality : ManyQualities
    duty : ManyDuties
    alignment : Alignment
    edition, dynamic_method, tip_relief, tip_relief_factor
    computed : Replacement
        Load factors in place of those of the formulas: K_v, K_Halpha, K_Falpha.
    annex_c : bool
        Whether S-N lines of the flanks are those of ISO 6336-6, annex C.
    """

    pairs: ManyPairs
    strength: tuple[Strength, Strength]
    quality: ManyQualities
    duty: ManyDuties
    alignment: Alignment = field(default_factory=Alignment)
    edition: Edition = 2019
    dynamic_method: Literal["B", "C"] = "B"
    tip_relief: TipRelief | None = None
    tip_relief_factor: float | None = None
    computed: Replacement = field(default_factory=Replacement)
    annex_c: bool = False
