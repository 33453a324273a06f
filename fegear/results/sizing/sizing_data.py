"""What a sizing found: variants with their numbers as estimated and as verified, reasons, and the present design."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fegear.base.shown import shown, shows
from fegear.design.sizing.space import VariantRelief

if TYPE_CHECKING:
    from fegear.design.sizing.space import Variant
    from fegear.results.sizing.by_fe import FromFE

#: What the load margin is: the load at the minimum safety factors over the load, by the contact or the bending.
MARGIN = "minimum of (S_H/S_Hmin)² and S_F/S_Fmin"


@dataclass(frozen=True)
class BestRelief:
    """The best short or long tip relief of a variant.

    Parameters
    ----------
    te : float
        Estimated transmission error with it [m].
    amount : float
        Of both gears [m]; 0 where no relief is better than none.
    kind : str
    lengths : (float, float)
        [m].
    """

    te: float
    amount: float
    kind: str
    lengths: tuple[float, float]


@dataclass(frozen=True)
class SizedVariant:
    """A variant that was chosen from those that live, or the present design.

    Parameters
    ----------
    variant : Variant
    costs : tuple of float
        Of the criteria, in their order; NaN where one is not known.
    on_bounds : tuple of str
        What lies at the end of what may vary.
    estimate, verified : FromFE or None
        Of unmodified flanks.
    relief : BestRelief or None
        Where one was searched.
    verified_relieved : FromFE or None
        With it.
    """

    number: int = shown("", "number of the variant", name="variant", table="sizing")
    place: int = shown("", "rank on the Pareto front, best first; 0: not on it", table="sizing")
    teeth_1: int = shown("", "number of teeth of the pinion", name="z_1", table="sizing")
    teeth_2: int = shown("", "number of teeth of the wheel", name="z_2", table="sizing")
    module: float = shown("mm", "normal module", name="normal_module", table="sizing")
    helix_angle: float = shown("deg", "helix angle", table="sizing")
    pressure_angle: float = shown("deg", "normal pressure angle", table="sizing")
    shift_1: float = shown("", "profile shift coefficient of the pinion", name="x_1", table="sizing")
    shift_2: float = shown("", "profile shift coefficient of the wheel", name="x_2", table="sizing")
    addendum: float = shown("", "addendum of the basic racks in modules", table="sizing")
    centre_distance: float = shown("mm", "centre distance", table="sizing")
    face_width: float = shown("mm", "face width", table="sizing")
    tip_diameter_1: float = shown("mm", "tip diameter of the pinion", table="sizing")
    tip_diameter_2: float = shown("mm", "tip diameter of the wheel", table="sizing")
    contact_ratio: float = shown("", "transverse contact ratio", table="sizing")
    overlap_ratio: float = shown("", "overlap ratio", table="sizing")
    mass: float = shown("kg", "mass of both gears (discs)", table="sizing")
    loss_factor: float = shown("", "tooth loss factor H_V (formula)", table="sizing")
    sliding: float = shown("", "minimum specific sliding", name="specific_sliding", table="sizing")
    contact_safety: float = shown("", "minimum safety factor for pitting", name="S_H", table="sizing")
    bending_safety: float = shown("", "minimum safety factor for tooth breakage", name="S_F", table="sizing")
    margin: float = shown("", f"load margin: {MARGIN}", name="load_margin",
                          table="sizing")  # fmt: skip
    variant: Variant = field(kw_only=True)
    costs: tuple[float, ...] = field(kw_only=True)
    on_bounds: tuple[str, ...] = field(kw_only=True, default=())
    estimate: FromFE | None = field(kw_only=True, default=None)
    verified: FromFE | None = field(kw_only=True, default=None)
    relief: BestRelief | None = field(kw_only=True, default=None)
    verified_relieved: FromFE | None = field(kw_only=True, default=None)

    @property
    @shows("", "source of the estimates: atlas of solved gears, or coarse FE", table="sizing")
    def estimated_by(self) -> str:
        """Empty without an estimate."""
        return "" if self.estimate is None else self.estimate.source

    @property
    @shows("um", "peak-to-peak transmission error, maximum over the torques, estimated", table="sizing")
    def te_estimated(self) -> float:
        """NaN without an estimate."""
        return math.nan if self.estimate is None else self.estimate.te

    @property
    @shows("um", "estimated error of te_estimated", table="sizing")
    def te_estimated_error(self) -> float:
        """NaN without an estimate, or without its error."""
        return math.nan if self.estimate is None else self.estimate.te_error

    @property
    @shows("um", "peak-to-peak transmission error, maximum over the torques, verified by FE", table="sizing")
    def te_verified(self) -> float:
        """NaN where it was not verified."""
        return math.nan if self.verified is None else self.verified.te

    @property
    @shows("um", "estimated error of te_verified", table="sizing")
    def te_verified_error(self) -> float:
        """NaN where it was not verified."""
        return math.nan if self.verified is None else self.verified.te_error

    @property
    @shows("um", "amount of linear tip relief of both gears", table="relief")
    def relief_amount(self) -> float:
        """Zero where no relief is better than none, NaN where none was searched."""
        return math.nan if self.relief is None else self.relief.amount

    @property
    @shows("", "length of the tip relief: short or long", table="relief")
    def relief_kind(self) -> str:
        """Empty without a relief."""
        return "" if self.relief is None else self.relief.kind

    @property
    @shows("mm", "length of the tip relief of the pinion along the line of action", table="relief")
    def relief_length_1(self) -> float:
        """NaN where none was searched."""
        return math.nan if self.relief is None else self.relief.lengths[0]

    @property
    @shows("mm", "length of the tip relief of the wheel along the line of action", table="relief")
    def relief_length_2(self) -> float:
        """NaN where none was searched."""
        return math.nan if self.relief is None else self.relief.lengths[1]

    @property
    @shows("um", "te_estimated with this tip relief", table="relief")
    def te_relieved_estimated(self) -> float:
        """NaN where none was searched."""
        return math.nan if self.relief is None else self.relief.te

    @property
    @shows("um", "te_verified with this tip relief", table="relief")
    def te_relieved_verified(self) -> float:
        """NaN where it was not verified."""
        return math.nan if self.verified_relieved is None else self.verified_relieved.te

    @property
    @shows("um", "estimated error of te_relieved_verified", table="relief")
    def te_relieved_verified_error(self) -> float:
        """NaN where it was not verified."""
        return math.nan if self.verified_relieved is None else self.verified_relieved.te_error

    @property
    @shows("MPa", "maximum root stress of both gears by FE, estimated", table="sizing")
    def root_stress_estimated(self) -> float:
        """NaN without an estimate."""
        return math.nan if self.estimate is None else self.estimate.root_stress

    @property
    @shows("MPa", "maximum root stress of both gears by FE, verified", table="sizing")
    def root_stress_verified(self) -> float:
        """NaN where it was not verified."""
        by = self.verified or self.verified_relieved
        return math.nan if by is None else by.root_stress

    @property
    @shows("", "values at the end of their range", table="sizing")
    def bounds(self) -> str:
        """In words of the case."""
        return ", ".join(self.on_bounds)

    @property
    def te(self) -> float:
        """Peak-to-peak transmission error, verified where it was."""
        known = self.te_verified
        return self.te_estimated if math.isnan(known) else known

    @property
    def te_relieved(self) -> float:
        """The same with its tip relief."""
        known = self.te_relieved_verified
        return self.te_relieved_estimated if math.isnan(known) else known

    @property
    def root_stress(self) -> float:
        """Maximum root stress of unmodified flanks, verified where it was."""
        by = self.estimate if self.verified is None else self.verified
        return math.nan if by is None else by.root_stress

    @property
    def relieved_variant(self) -> Variant:
        """Itself with its tip relief."""
        one = self.relief
        if one is None or not one.amount > 0.0:
            return self.variant
        return self.variant._replace(relief=VariantRelief(one.amount, one.lengths))

    @property
    def words(self) -> str:
        """``21/85 teeth, m_n 2 mm, 12 deg, x 0.3/-0.1``."""
        lean = f", {math.degrees(self.helix_angle):.3g} deg" if self.helix_angle else ""
        return (
            f"{self.teeth_1}/{self.teeth_2} teeth, m_n {self.module * 1e3:.4g} mm{lean}, x {self.shift_1:.3g}/"
            f"{self.shift_2:.3g}"
        )


@dataclass(frozen=True)
class Excluded:
    """How many variants a reason excluded."""

    reason: str = shown("", "reason, the first that applies", table="reasons")
    variants: int = shown("", "variants excluded by it", table="reasons")


@dataclass(frozen=True)
class Placed:
    """Where the present design stands by one criterion."""

    criterion: str = shown("", "criterion", table="present")
    present: float = shown("", "present design, in the unit of the criterion", table="present")
    best: float = shown("", "best of the variants compared, in the same unit", table="present")
    better: int = shown("", "variants that are better by this criterion; all where the design has no number",
                        table="present")  # fmt: skip
    compared: int = shown("", "variants compared", table="present")
    unit: str = shown("", "unit of the criterion", table="present")


@dataclass(frozen=True)
class PresentPlaced:
    """The present design among the variants.

    Parameters
    ----------
    design : SizedVariant
    reasons : tuple of str
        All limits that it breaks.
    placed : tuple of Placed
    dominating : int
        Variants that are no worse by any of the criteria and better by one; where the transmission error of all is not
        known, by those that formulas give.
    by_all : bool
        Whether these are all criteria.
    better : SizedVariant or None
        The best of the front that dominates it by all criteria.
    """

    design: SizedVariant
    reasons: tuple[str, ...]
    placed: tuple[Placed, ...]
    dominating: int
    by_all: bool
    better: SizedVariant | None


@dataclass(frozen=True)
class SizingData:
    """Everything that a sizing found.

    Parameters
    ----------
    count, feasible : int
        Variants enumerated, and those that meet all limits.
    on_front : int
        Of those whose criteria are all known, as estimated, on the front; without a transmission error of all feasible.
    known : int
        Feasible variants whose transmission error is known, by the atlas or by finite elements.
    by_atlas : bool
        Whether an atlas contains any.
    relieved : int
        Variants for which a relief was searched.
    reasons : tuple of Excluded
    chosen : tuple of SizedVariant
        Compared by all criteria, the front first, by its order.
    present : PresentPlaced or None
    failed : tuple of (int, str)
        Variants without a number by finite elements, and why.
    """

    count: int = shown("", "variants enumerated")
    feasible: int = shown("", "variants that meet all limits", name="variants_feasible")
    on_front: int = shown("", "variants on the Pareto front", name="variants_on_front")
    known: int = shown("", "variants with known transmission error", name="variants_te_known", default=0)
    by_atlas: bool = False
    relieved: int = 0
    reasons: tuple[Excluded, ...] = ()
    chosen: tuple[SizedVariant, ...] = ()
    present: PresentPlaced | None = None
    failed: tuple[tuple[int, str], ...] = ()

    @property
    def front(self) -> tuple[SizedVariant, ...]:
        """Those that none is better than, in order."""
        return tuple(one for one in self.chosen if one.place)

    @property
    def best(self) -> SizedVariant | None:
        """The first of the front."""
        return self.front[0] if self.front else None
