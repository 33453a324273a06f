"""What ISO 6336 asks of gears beside their geometry: strength, quality and duty, as plain data in SI.

Pairs of values are those of pinion and wheel, as the standard numbers them: the pinion is the gear with fewer teeth.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from fegear.errors import RangeError

if TYPE_CHECKING:
    from fegear.formulas.iso6336.groups import Group

#: Which editions of parts 1, 2 and 3 a rating follows.
Edition = Literal[2006, 2019]
#: Two values, of pinion and wheel.
Both = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Strength:
    """What a material bears (ISO 6336-5).

    Parameters
    ----------
    group : Group
        The material's letters in ISO 6336-5, such as "Eh".
    contact : float
        sigma_Hlim, allowable stress number (contact) [Pa].
    bending : float
        sigma_Flim, nominal stress number (bending) [Pa]; sigma_FE is Y_ST = 2 times it.
    hardness : float
        Brinell hardness of the flanks, for Z_W; NaN where it is not known.
    yield_strength : float
        R_e or R_p0.2 [Pa], for the notch sensitivity of St, V, GGG and GTS; NaN where it is not known.
    tensile_strength : float
        R_m [Pa], for that of GG; NaN where it is not known.
    limited_pitting : bool
        Whether some pitting is permitted: another branch of Z_NT.
    long_life : (float, float)
        Z_NT and Y_NT at 1e10 load cycles: .85, up to 1 with optimum lubrication, material and manufacturing.
    """

    group: Group
    contact: float
    bending: float
    hardness: float = math.nan
    yield_strength: float = math.nan
    tensile_strength: float = math.nan
    limited_pitting: bool = False
    long_life: Both = (0.85, 0.85)

    def __post_init__(self) -> None:
        """Refuse what no material has."""
        for name, value in (("sigma_Hlim", self.contact), ("sigma_Flim", self.bending)):
            if not (math.isfinite(value) and value > 0.0):
                raise RangeError(name, value, "must be positive and finite")
        for name, value in zip(("Z_NT", "Y_NT"), self.long_life, strict=True):
            if not 0.85 <= value <= 1.0:
                raise RangeError(f"{name} at 1e10 cycles", value, "must lie between 0.85 and 1")


@dataclass(frozen=True, slots=True)
class Quality:
    """How well a gear is made; lengths [m], deviations by ISO 1328-1.

    Parameters
    ----------
    grade : int
        Flank tolerance class (ISO accuracy grade).
    base_pitch, profile_form, helix_slope : float
        f_pb = f_p cos(alpha_t), f_falpha, f_Hbeta.
    flank_roughness, root_roughness : float
        Rz of the flank and of the root fillet.
    tip_relief : float
        C_a, from design; 0 for none (running in gives some: `part1_dynamic.running_in_relief`).
    """

    grade: int
    base_pitch: float
    profile_form: float
    helix_slope: float
    flank_roughness: float
    root_roughness: float
    tip_relief: float = 0.0

    def __post_init__(self) -> None:
        """Refuse negative deviations and roughnesses of nothing."""
        for name in ("base_pitch", "profile_form", "helix_slope", "tip_relief"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise RangeError(name, value, "must be finite and not negative")
        for name in ("flank_roughness", "root_roughness"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise RangeError(name, value, "must be positive and finite")


@dataclass(frozen=True, slots=True)
class Duty:
    """What a pair transmits, how fast and how long.

    Parameters
    ----------
    tangential : float
        F_t, nominal tangential load at the reference circle [N].
    speed : float
        Of the pinion [rad/s].
    cycles : (float, float)
        N_L of pinion and wheel.
    viscosity : float
        nu_40, nominal kinematic viscosity of the lubricant at 40 degC [m^2/s].
    application_factor, mesh_load_factor : float
        K_A; K_gamma, for load paths in parallel.
    mean_stress : (float, float)
        Y_M: 1 for pulsating loads, see `part3_strength.mean_stress_factor`.
    meshes : (int, int)
        With how many mates each gear meshes at once: (3, 1) for a sun with three planets.
    mean_stress_static : (float, float) or None
        Y_M of static strength; None where it is that of endurance.
    """

    tangential: float
    speed: float
    cycles: Both
    viscosity: float
    application_factor: float = 1.0
    mesh_load_factor: float = 1.0
    mean_stress: Both = (1.0, 1.0)
    meshes: tuple[int, int] = (1, 1)
    mean_stress_static: Both | None = None

    def __post_init__(self) -> None:
        """Refuse loads, speeds and lives that are not positive."""
        for name in ("tangential", "speed", "viscosity", "application_factor", "mesh_load_factor"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise RangeError(name, value, "must be positive and finite")
        for name, values in (
            ("N_L", self.cycles),
            ("Y_M", self.mean_stress),
            ("static Y_M", self.mean_stress_static or (1.0, 1.0)),
            ("meshes", self.meshes),
        ):
            for value in values:
                if not value > 0.0:
                    raise RangeError(name, value, "must be positive")
