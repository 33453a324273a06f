"""ISO 6336 of a whole pair: c', c_gamma and the nominal root stress sigma_F0 of both gears with all its factors.

Helical gears are rated as the standard does, through their virtual spur teeth: z_n teeth in the normal section, loaded
at the outer point of single pair contact of the virtual pair (ISO 6336-3, 6.2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from fegear.base.errors import RangeError
from fegear.formulas.iso6336 import part3_root_stress as root
from fegear.formulas.root_section import refuse_helix
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair, Member


@dataclass(frozen=True, slots=True)
class RatingChoice:
    """What the standard asks for besides the geometry.

    Parameters
    ----------
    edition : {2006, 2019}
        Of ISO 6336-3.
    accuracy_grade : int
        ISO 1328 grade of the gears; Y_DT relieves deep teeth of grade 4 or better only.
    """

    edition: root.Edition = 2006
    accuracy_grade: int = 6


@dataclass(frozen=True, slots=True)
class RootRating:
    """Nominal root stress of one gear and what it is made of.

    Parameters
    ----------
    teeth : float
        z_n of the virtual spur gear.
    load_diameter : float
        d_en [modules].
    form : RootForm
        Section, Y_F without f_epsilon, Y_S.
    load_distribution, helix, rim, deep_tooth : float
        f_epsilon, Y_beta, Y_B, Y_DT.
    stress : float
        sigma_F0 [Pa].
    """

    teeth: float
    load_diameter: float
    form: root.RootForm
    load_distribution: float
    helix: float
    rim: float
    deep_tooth: float
    stress: float


@dataclass(frozen=True, slots=True)
class ToothLoad:
    """Load of a pair as ISO 6336 counts it.

    Parameters
    ----------
    specific_load : float
        F_t / b [N/m], tangential at the reference circle per face width.
    contact_ratio : float
        epsilon_alpha_n of the virtual pair, from 1 to below 2: beyond there is no single pair contact.
    overlap_ratio : float
        epsilon_beta.
    helix_angle : float
        beta [rad].
    deep : bool
        Whether a contact ratio from 2 to below 3 is let through: the formula of the load's diameter goes on there, as
        the standard's Y_DT presumes.
    """

    specific_load: float
    contact_ratio: float
    overlap_ratio: float = 0.0
    helix_angle: float = 0.0
    deep: bool = False

    def __post_init__(self) -> None:
        """Refuse contact ratios without single pair contact."""
        most = 3 if self.deep else 2
        if not 1.0 <= self.contact_ratio < most:
            rule = f"must be between 1 and {most} for a single contact point"
            raise RangeError("contact ratio", f"{self.contact_ratio:.4g}", rule)


def rate(
    gear: root.RackTooth,
    load_diameter: float,
    module: float,
    load: ToothLoad,
    choice: RatingChoice,
    backup_ratio: float = math.inf,
) -> RootRating:
    """Rate one (virtual) gear.

    Parameters
    ----------
    gear : RackTooth
    load_diameter : float
        d_en [modules].
    module : float
        m_n [m].
    load : ToothLoad
    choice : RatingChoice
    backup_ratio : float
        s_R / h_t, rim thickness over tooth height; inf for a solid gear.
    """
    rim = 1.0 if math.isinf(backup_ratio) else root.rim_factor(backup_ratio, 1.0)
    return rate_form(gear.teeth, root.root_form(gear, load_diameter), load_diameter, module, load, choice, rim)


def rate_form(
    teeth: float,
    form: root.RootForm,
    load_diameter: float,
    module: float,
    load: ToothLoad,
    choice: RatingChoice,
    rim: float = 1.0,
) -> RootRating:
    """Rate one gear, external or internal, of a known critical section; Y_B is `rim`, the rest is that of `rate`."""
    shared = root.load_distribution_factor(load.contact_ratio, load.overlap_ratio, choice.edition)
    helix = root.helix_factor(load.overlap_ratio, load.helix_angle, choice.edition)
    deep = root.deep_tooth_factor(load.contact_ratio) if choice.accuracy_grade <= 4 else 1.0
    stress = root.nominal_root_stress(
        form, load.specific_load, 1.0, module, helix=helix, rim=rim, deep_tooth=deep, load_distribution=shared
    )
    return RootRating(teeth, load_diameter, form, shared, helix, rim, deep, stress)


def rate_spur(
    pair: GearPair, member: Member, line_load: float, choice: RatingChoice, rim_thickness: float | None = None
) -> RootRating:
    """Rate one gear of a spur pair under a line load w = F_bt / b [N/m]; rim thickness in m, None for solid."""
    gear = pair.gear(member)
    refuse_helix(gear.external_tooth)
    load = ToothLoad(pair.tangential_load(line_load), pair.contact_ratio)
    at = pair.x_hpstc if member == "driver" else pair.x_lpstc
    height = gear.tip_radius - gear.root_radius
    backup = math.inf if rim_thickness is None else rim_thickness / height
    d_en = 2.0 * float(pair.radius(at, member)) / gear.module
    return rate(root.rack_tooth(gear.external_tooth), d_en, gear.module, load, choice, backup)


def virtual_tooth(gear: Gear) -> root.RackTooth:
    """The virtual spur tooth of a helical gear: its rack and its profile shift on z_n teeth."""
    z_n = root.virtual_teeth(gear.teeth, gear.helix_angle, gear.normal_pressure_angle)
    return replace(root.rack_tooth(gear.external_tooth), teeth=z_n)


def virtual_contact_ratio(gear: Gear, contact_ratio: float) -> float:
    """epsilon_alpha_n = epsilon_alpha / cos^2(beta_b) (ISO 6336-3, 6.2)."""
    return contact_ratio / math.cos(gear.base_helix_angle) ** 2


def rate_helical(gear: Gear, load: ToothLoad, choice: RatingChoice, rim_thickness: float | None = None) -> RootRating:
    """Rate a helical gear through its virtual spur tooth.

    Parameters
    ----------
    gear : Gear
    load : ToothLoad
    choice : RatingChoice
    rim_thickness : float, optional
        [m]; None for a solid gear.
    """
    tooth = virtual_tooth(gear)
    addendum = (gear.tip_radius - gear.pitch_radius) / gear.module
    d_en = root.outer_single_contact_diameter(tooth, tooth.teeth + 2.0 * addendum, load.contact_ratio)
    backup = math.inf if rim_thickness is None else rim_thickness / (gear.tip_radius - gear.root_radius)
    return rate(tooth, d_en, gear.module, load, choice, backup)
