"""What ISO 6336 asks of gears besides their geometry: strength, quality and duty, as plain data in SI.

Pairs of values are those of pinion and wheel, as the standard numbers them: the pinion is the gear with fewer teeth.

What ISO/TS 6336-20, -21 and -22 ask of a gear pair: load and its factors, speed, oil, flanks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from numpy.typing import ArrayLike

from fegear.base.errors import RangeError
from fegear.formulas.flank_speeds import FlankSpeeds, flank_speeds
from fegear.formulas.flash_temperature import reduced_modulus
from fegear.formulas.friction import Surface
from fegear.formulas.iso6336.part5_materials import Group
from fegear.geometry.pair import GearPair

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
                raise RangeError(f"{name} at 1e10 cycles", value, "must be between 0.85 and 1")


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


#: X_S, lubrication: how hot the teeth become against the oil (ISO/TR 13989-1, clause 6; 15144-1, clause 10).
SUPPLY_FACTOR = {"dip": 1.0, "spray": 1.2, "spray-with-dip": 1.0, "submerged": 0.2}


#: X_W, structural (welding) factor of the flanks (ISO/TR 13989-1, Table 2; -2, Table 3).
STRUCTURE_FACTOR = {
    "through-hardened": 1.0,
    "phosphated": 1.25,
    "copper-plated": 1.5,
    "nitrided": 1.5,
    "case-carburized-low-austenite": 1.15,
    "case-carburized": 1.0,
    "case-carburized-high-austenite": 0.85,
    "austenitic": 0.45,
}


@dataclass(frozen=True)
class LoadFactors:
    """K_A, K_v, K_Hbeta and K_Halpha (K_Bbeta and K_Balpha of scuffing are the same).

    Parameters
    ----------
    application, dynamic, face, transverse : float
    """

    application: float = 1.0
    dynamic: float = 1.0
    face: float = 1.0
    transverse: float = 1.0

    @property
    def product(self) -> float:
        """All four."""
        return self.application * self.dynamic * self.face * self.transverse


@dataclass(frozen=True)
class RatedSurface:
    """A pair whose flanks are rated.

    Parameters
    ----------
    pair : GearPair
    speed : float
        Of the driver [rad/s].
    load : float
        F_bt, nominal force in the plane of action in the section across the axes [N].
    factors : LoadFactors
    surface : Surface
    supply : float
        X_S.
    structure : float
        X_W, the smaller one of both gears.
    tip_relief : (float, float)
        C_a of driver and driven gear [m].
    single_stiffness, mesh_stiffness : float
        c' and c_gamma per face width [Pa].
    grade : int
        ISO 1328-1 tolerance class of the flanks, the coarser one.

    Raises
    ------
    RangeError
        Where speed, load or a factor is not positive.
    """

    pair: GearPair
    speed: float
    load: float
    factors: LoadFactors
    surface: Surface
    supply: float = 1.0
    structure: float = 1.0
    tip_relief: tuple[float, float] = (0.0, 0.0)
    single_stiffness: float = 14e9
    mesh_stiffness: float = 20e9
    grade: int = 6

    def __post_init__(self) -> None:
        """Refuse what no film and no temperature can be given for."""
        if not (math.isfinite(self.speed) and self.speed > 0.0):
            raise RangeError("speed", f"{self.speed:.6g} rad/s", "must be above zero")
        if not (math.isfinite(self.load) and self.load > 0.0):
            raise RangeError("load", f"{self.load:.6g} N", "must be above zero")
        if not self.factors.product > 0.0:
            raise RangeError("load factors", self.factors.product, "must be above zero")

    @property
    def modulus(self) -> float:
        """E_r [Pa]."""
        one, other = self.pair.driver.material, self.pair.driven.material
        return reduced_modulus(
            (one.young_modulus, other.young_modulus), (one.poisson_ratio, other.poisson_ratio)
        )  # fmt: skip

    @property
    def tangential_load(self) -> float:
        """F_t at the reference cylinders [N]."""
        return self.pair.tangential_load(self.load)

    @property
    def unit_load(self) -> float:
        """w_Bt = K_A K_v K_Bbeta K_Balpha F_t / b [N/m] (ISO/TR 13989-1, Eq. 11)."""
        return self.factors.product * self.tangential_load / self.pair.face_width

    @property
    def line_load(self) -> float:
        """The same in the plane of action, K_A K_v K_Hbeta K_Halpha F_bt / b [N/m]."""
        return self.factors.product * self.load / self.pair.face_width

    @property
    def optimal_relief(self) -> float:
        """C_eff = K_A F_t / (b cos(alpha_t) c_gamma) [m] (ISO/TR 13989-1, Eq. B.1)."""
        return self.factors.application * self.load / (self.pair.face_width * self.mesh_stiffness)

    @property
    def power(self) -> float:
        """Nominal power that the pair transmits [W]."""
        return self.load * self.speed * self.pair.driver.base_radius

    @property
    def reference_speed(self) -> float:
        """Circumferential speed of the reference cylinders [m/s]."""
        return self.speed * self.pair.driver.pitch_radius

    @property
    def pitch_line_speed(self) -> float:
        """v_t, circumferential speed of the working pitch cylinders [m/s]."""
        return self.speed * self.pair.driver.base_radius / math.cos(self.pair.working_pressure_angle)

    def at(self, x: ArrayLike) -> FlankSpeeds:
        """Curvature and speeds at places on the path of contact [m]."""
        return flank_speeds(self.pair, x, self.speed)
