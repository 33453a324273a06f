"""``[shaft.NAME]`` and ``[bearing.NAME]``: shafts in space with their gears, what holds them and what turns them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.base.errors import GeometryError, InputError
from fegear.case.derived import keys_of
from fegear.case.gear_material import MaterialPart
from fegear.case.part import (
    Angle,
    Force,
    Length,
    LengthOrZero,
    Number,
    Part,
    PositiveLength,
    StiffnessOrZero,
    TorsionalStiffnessOrZero,
    at_most,
    quantity,
    refuse,
)
from fegear.geometry.plausible import refuse_shaft
from fegear.shafts.axial_factors import AxialFactors, ribs_of
from fegear.shafts.life import LifeRating
from fegear.shafts.permissible_tilt import PermissibleTilt, tilt_of_kind
from fegear.shafts.printed_bearing import Kind, PrintedBearing
from fegear.shafts.section import Section
from fegear.shafts.shaft_strength import ShaftStrength
from fegear.shafts.static_safety import StaticRating

if TYPE_CHECKING:
    from fegear.shafts.beam import Shaft
    from fegear.shafts.bearing import Bearing
    from fegear.shafts.catalogue_bearing import CatalogueBearing

#: Keys of `catalogue` that replace dimensions of a designation.
ENVELOPE = frozenset(("kind", "bore", "outside_diameter", "width", "contact_angle"))

Torque = Annotated[float, quantity("torque")]


if TYPE_CHECKING:

    class _SectionKeys(Part, Section):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

    class _LifeKeys(Part, LifeRating):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

    class _CatalogueKeys(Part, PrintedBearing):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

else:
    _SectionKeys = keys_of(Section)
    _LifeKeys = keys_of(
        LifeRating,
        otherwise={
            "dynamic_rating": "that of `catalogue`, then of the designation (SKF General Catalogue), otherwise "
            "estimated from the dimensions",
            "kind": "that of the designation, of `catalogue` or `elements`; ball otherwise",
            **dict.fromkeys(
                ("radial_factor", "axial_factor", "limit"),
                "ISO 281, from the axial force, the rolling elements and their contact angle, if known and none of X, "
                "Y and e is specified",
            ),
        },
    )
    _CatalogueKeys = keys_of(
        PrintedBearing,
        otherwise={
            **dict.fromkeys(("kind", "bore", "outside_diameter", "width"), "that of the designation"),
            "dynamic_rating": "that of `life`, if specified",
            "contact_angle": "that of the designation; 14 deg for other tapered, 10.5 deg for other spherical "
            "bearings, 0 for others",
        },
    )


class SectionPart(_SectionKeys):  # type: ignore[misc]  # frozen by pydantic
    """``{ length = "40 mm", outer = "35 mm", inner = "0 mm" }``; a cone where an end has another diameter."""


class GearPlacePart(Part):
    """``{ gear = "pinion", at = "60 mm" }``: the middle of a gear's face on the shaft."""

    gear: str = Field(description="Name of a gear of the case.")
    at: LengthOrZero = Field(description="Position of mid-face from the left shaft end.")
    stiffens: bool = Field(
        default=True,
        description="Gear body rigidly connected to the shaft over its `seat` (stiffens it in torsion and bending). "
        "If false, the gear follows the bare shaft.",
    )
    seat: PositiveLength | None = Field(
        default=None,
        description="Length of the rigid connection, centred on mid-face. Default: face width, or hub width of the "
        "body.",
    )

    @model_validator(mode="after")
    def _fast(self) -> Self:
        if self.seat is not None and not self.stiffens:
            raise refuse("contradicts stiffens = false", "remove one of them", key="seat")
        return self


class BearingPlacePart(Part):
    """``{ bearing = "6208", at = "12 mm" }``: a bearing on the shaft."""

    bearing: str = Field(description="Name of a bearing of the case.")
    at: LengthOrZero = Field(description="Position of the bearing force from the left shaft end.")
    around: str | None = Field(
        default=None,
        description="Name of the outer (hollow) shaft that carries the outer ring; specify at the inner shaft only. "
        "Default: housing.",
    )
    reversed: bool = Field(
        default=False,
        description="Bearing mounted reversed (contact angle and coupling of force and tilt change sign).",
    )


class LoadPart(Part):
    """``{ at = "0 mm", force = ["0 N", "-800 N", "0 N"] }``: a force from outside, at the axis."""

    at: LengthOrZero = Field(description="Position from the left shaft end.")
    force: Annotated[list[Force], Field(min_length=3, max_length=3)] | None = Field(
        default=None, description="Force components along x, y and z (axial)."
    )
    moment: Annotated[list[Torque], Field(min_length=3, max_length=3)] | None = Field(
        default=None, description="Moment components about x, y and z (axial)."
    )


class _ShaftPart(Part):
    """What a shaft has besides its strength."""

    axis: Annotated[list[Length], Field(min_length=2, max_length=2)] = Field(
        default=[0.0, 0.0], description="Position of the axis: x and y."
    )
    start: Length = Field(default=0.0, description="z coordinate of the left end.")
    sections: Annotated[list[SectionPart], Field(min_length=1), at_most(1000, "sections")] = Field(
        description="Sections in order from the left end."
    )
    material: MaterialPart = Field(default_factory=MaterialPart, description="Material of the shaft.")
    rigid: bool = Field(default=False, description="Rigid shaft (for comparison).")
    gears: Annotated[list[GearPlacePart], at_most(100, "gears")] = Field(
        default=[], description="Gears mounted on the shaft."
    )
    bearings: Annotated[list[BearingPlacePart], at_most(100, "bearings")] = Field(
        default=[], description="Bearings of the shaft."
    )
    coupling: LengthOrZero | None = Field(
        default=None, description="Position of the coupling that balances the torque. Default: none."
    )
    loads: Annotated[list[LoadPart], at_most(1000, "loads")] = Field(
        default=[], description="External forces and moments."
    )
    clockwise: bool = Field(
        default=False,
        description="Direction of rotation seen from +z; that of driven shafts follows from it. The other direction "
        "loads the coast flanks and reverses axial forces.",
    )

    @model_validator(mode="after")
    def _of_a_gearbox(self) -> Self:
        thickest = max(max(one.outer, one.outer_end or 0.0) for one in self.sections)
        try:
            refuse_shaft(sum(one.length for one in self.sections), thickest)
        except GeometryError as error:
            raise refuse(f"{error.rule} in {error.key}", error.remedy, key="sections", value=error.value) from None
        return self

    def build(self, *, rigid: bool = False) -> Shaft:
        """Make the shaft."""
        from fegear.shafts.beam import Shaft

        made = tuple(Section(one.length, one.outer, one.inner, one.outer_end, one.inner_end) for one in self.sections)
        modulus = math.inf if rigid or self.rigid else self.material.modulus
        return Shaft(made, modulus, self.material.poisson_ratio)


if TYPE_CHECKING:

    class _ShaftKeys(_ShaftPart, ShaftStrength):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

else:
    _ShaftKeys = keys_of(ShaftStrength, base=_ShaftPart)


class ShaftInSpacePart(_ShaftKeys):  # type: ignore[misc]  # frozen by pydantic
    """A shaft parallel to z: sections from its left end on, its gears, bearings, coupling, loads and strength."""

    @property
    def strength(self) -> ShaftStrength:
        """Against yielding."""
        return ShaftStrength(self.yield_strength, self.safety_yield)


class RollingElementsPart(Part):
    """``elements = { kind = "ball", count = 9, diameter = "12.7 mm", pitch_diameter = "65 mm" }``."""

    kind: Literal["ball", "roller"] = Field(description="Rolling element type: ball (Hertz) or roller (ISO/TS 16281).")
    count: Annotated[int, Field(ge=3, le=500)] = Field(description="Number of balls or rollers.")
    diameter: PositiveLength = Field(description="Diameter of a ball, or of a roller at mid-length.")
    pitch_diameter: PositiveLength = Field(description="Pitch diameter of the rolling elements.")
    contact_angle: Angle = Field(
        default=0.0,
        description="Nominal contact angle; 0 for deep groove and cylindrical roller bearings; positive "
        "if axial load towards +z is supported.",
    )
    groove_ratio: Annotated[list[Number], Field(min_length=2, max_length=2)] = Field(
        default=[0.52, 0.52], description="Ratio of groove radius to ball diameter, inner and outer ring."
    )
    roller_length: PositiveLength | None = Field(default=None, description="Effective roller length.")
    clearance: Length = Field(default=0.0, description="Diametral clearance as mounted; negative for preload.")


class BearingLifePart(_LifeKeys):  # type: ignore[misc]  # frozen by pydantic
    """``life = { dynamic_rating = "32.5 kN", axial_factor = 1.6, ... }`` of the catalogue, for ISO 281."""

    @model_validator(mode="after")
    def _whole(self) -> Self:
        """Refuse X or e without Y: P would be less than without an axial force."""
        partial = [key for key in ("radial_factor", "limit") if key in self.given]
        if partial and "axial_factor" not in self.given:
            key = partial[0]
            raise refuse(f"is required with {key}", f"specify it, or remove {key}", key="axial_factor")
        return self


class CataloguePart(_CatalogueKeys):  # type: ignore[misc]  # frozen by pydantic
    """``catalogue = { kind = "ball", bore = "30 mm", outside_diameter = "62 mm", width = "16 mm", ... }``."""


class BearingPart(Part):
    """A bearing: stiffness with or without clearance, its elements, or what a catalogue prints; rigid otherwise."""

    radial: StiffnessOrZero | None = Field(default=None, description="Radial stiffness. Default: rigid.")
    axial: StiffnessOrZero | None = Field(default=None, description="Axial stiffness. Default: none, unless `fixed`.")
    tilting: TorsionalStiffnessOrZero = Field(default=0.0, description="Tilting stiffness.")
    fixed: bool = Field(default=False, description="Axially rigid (locating bearing).")
    radial_clearance: LengthOrZero = Field(default=0.0, description="Radial play (half the diametral clearance).")
    axial_clearance: LengthOrZero = Field(default=0.0, description="Axial play to either side.")
    matrix: Annotated[list[list[Number]], Field(min_length=5, max_length=5)] | None = Field(
        default=None, description="5 x 5 stiffness matrix (x, y, z and tilt about x and y) in N, m, rad."
    )
    elements: RollingElementsPart | None = Field(default=None, description="Rolling elements, for nonlinear stiffness.")
    designation: str | None = Field(
        default=None,
        description="Designation, such as 6206, 7206-B, 30206, 22206 or NU206: rolling elements are estimated from its "
        "dimensions (ISO 15, ISO 355) and the ratings of `catalogue`. NUP bearings locate the shaft axially.",
    )
    catalogue: CataloguePart | None = Field(
        default=None,
        description="Dimensions and load ratings of a catalogue, to estimate rolling elements from.",
    )
    housing_radial: StiffnessOrZero | None = Field(
        default=None, description="Radial stiffness of the bearing seat in the housing. Default: rigid."
    )
    housing_axial: StiffnessOrZero | None = Field(
        default=None, description="Axial stiffness of the bearing seat in the housing. Default: rigid."
    )
    permissible_tilt: Angle | None = Field(
        default=None,
        description="Permissible tilt of the inner ring in the outer one (catalogue). Default: guide values by kind, "
        "0.003 rad for deep groove ball, 0.0012 rad for cylindrical and tapered, 0.045 rad for spherical roller "
        "bearings.",
    )
    life: BearingLifePart | None = Field(
        default=None,
        description="Catalogue ratings, for bearing life to ISO 281; `{}` for the C that one maker prints of the "
        "designation, otherwise an estimate from the dimensions.",
    )

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        stiffness = {"radial", "axial", "tilting", "fixed", "radial_clearance", "axial_clearance"}
        ways = [key for key in ("matrix", "elements") if getattr(self, key) is not None]
        printed = [key for key in ("designation", "catalogue") if getattr(self, key) is not None]
        ways += printed[:1]
        if len(ways) + bool(stiffness & self.given) > 1:
            raise refuse(
                "contradicts other keys", "specify stiffness, a matrix, elements, or a designation or catalogue",
                key=ways[0],
            )  # fmt: skip
        if printed:
            self._refuse_printed()
        elif self.life is not None and "dynamic_rating" not in self.life.given:
            raise refuse("is required without a designation or catalogue", "specify it", key="life.dynamic_rating")
        if self.matrix is not None and any(len(row) != 5 for row in self.matrix):
            raise refuse("must have 5 numbers per row", "specify five numbers per row", key="matrix", value="(rows)")
        if (self.radial_clearance or self.axial_clearance) and (self.radial is None or self.fixed):
            raise refuse(
                "requires a stiffness in addition to the clearance", "specify radial and axial", key="radial_clearance"
            )
        for key in ("housing_radial", "housing_axial"):
            if getattr(self, key) == 0.0:
                raise refuse("must be greater than zero", "specify a stiffness above zero, or remove it", key=key)
        if self.permissible_tilt is not None and not self.permissible_tilt > 0.0:
            raise refuse("must be greater than zero", "specify that of the catalogue, or remove it",
                         key="permissible_tilt")  # fmt: skip
        if self.elements is not None and self.elements.kind == "roller" and self.elements.roller_length is None:
            raise refuse("is required for rollers", 'set roller_length = "12 mm"', key="elements.roller_length")
        return self

    def _refuse_printed(self) -> None:
        """Refuse a designation that none has, and dimensions from which no bearing can be estimated."""
        if self.designation is None and self.catalogue is not None:
            for key in ("kind", "bore", "outside_diameter", "width"):
                if getattr(self.catalogue, key) is None:
                    raise refuse("is required without a designation", "specify it", key=f"catalogue.{key}")
        try:
            printed = self.printed
            assert printed is not None  # noqa: S101  (for mypy: there is a designation here)
            _ = printed.inside
        except InputError as error:
            key = error.key if error.key == "designation" else f"catalogue.{error.key}"
            if error.key == "dynamic_rating" and not (self.catalogue and self.catalogue.dynamic_rating):
                key = "life.dynamic_rating"
            raise refuse(error.rule, error.remedy, key=key, value=error.value) from None

    @property
    def rating(self) -> LifeRating | None:
        """What its life follows from; C and exponent are those of the bearing where they are not given."""
        if (life := self.life) is None:
            return None
        printed, rated = self.printed, life.dynamic_rating
        if printed is not None and "dynamic_rating" not in life.given:
            rated = printed.dynamic_rating or self.catalogue_rating or printed.estimated_rating
        known = printed.inside if printed else self.elements
        kind = life.kind if "kind" in life.given else known.kind if known else "ball"
        factors = {
            key: one for key in ("radial_factor", "axial_factor", "limit") if (one := getattr(life, key)) is not None
        }
        axial = None
        if known is not None and not factors:
            size = known.diameter if isinstance(known, RollingElementsPart) else known.element_diameter
            rows = printed.inside.rows if printed else 1
            axial = AxialFactors(known.kind == "ball", abs(known.contact_angle), known.count * size**2, self.ribs, rows)
        return LifeRating(rated, kind, **factors, axial=axial)

    @property
    def static(self) -> StaticRating | None:
        """What its static safety follows from: C_0 of `catalogue`, otherwise of what rolls; None without either."""
        from fegear.shafts.load_ratings import static_rating
        from fegear.shafts.rolling_bearing import RollingBearing

        inside = self.build()
        if not isinstance(inside, RollingBearing):
            return None
        printed = self.printed
        rated = (printed.static_rating if printed else None) or static_rating(inside)
        return StaticRating(rated, inside.kind == "ball", abs(inside.contact_angle), inside.rows)

    @property
    def catalogue_rating(self) -> float | None:
        """C that a maker prints of its designation [N]; None where none is known, or dimensions are given."""
        from fegear.shafts.designations import catalogue_rating

        if self.designation is None or (self.catalogue is not None and self.catalogue.given & ENVELOPE):
            return None
        return catalogue_rating(self.designation)

    @property
    def ribs(self) -> tuple[float, float] | None:
        """Y and e of a bearing whose ribs locate its shaft (NUP); None of any other."""
        from fegear.shafts.designations import plain_designation

        return None if self.designation is None else ribs_of(plain_designation(self.designation))

    @property
    def tilt(self) -> PermissibleTilt | None:
        """How far its rings may tilt against each other: as given, or by kind; None where no kind is known."""
        if self.permissible_tilt is not None:
            return PermissibleTilt(self.permissible_tilt, self.permissible_tilt)
        if (printed := self.printed) is not None:
            return tilt_of_kind(printed.kind, printed.inside.contact_angle)
        if (rolling := self.elements) is None:
            return None
        kind: Kind = "ball" if rolling.kind == "ball" else "tapered" if rolling.contact_angle else "cylindrical"
        return tilt_of_kind(kind, rolling.contact_angle)

    @property
    def printed(self) -> CatalogueBearing | None:
        """What a catalogue prints of it: the keys given, the rest from the designation."""
        from fegear.shafts.catalogue_bearing import CatalogueBearing
        from fegear.shafts.designations import envelope_of

        if self.designation is None and self.catalogue is None:
            return None
        known = envelope_of(self.designation) if self.designation is not None else None
        said = self.catalogue or CataloguePart()
        kind = said.kind if "kind" in said.given else known.kind if known else "ball"
        angle = said.contact_angle
        if angle is None and known is not None and kind == known.kind:
            angle = known.contact_angle or None
        rated = said.dynamic_rating or (self.life.dynamic_rating if self.life else None)
        bore, outside, width = (
            getattr(said, key) or (getattr(known, key) if known else 0.0)
            for key in ("bore", "outside_diameter", "width")
        )
        return CatalogueBearing(kind, bore, outside, width, rated, said.static_rating, angle, said.clearance)

    def build(self, *, mirrored: bool = False) -> Bearing:
        """Make the bearing."""
        from dataclasses import replace

        import numpy as np

        from fegear.shafts.bearing import LooseBearing, StiffBearing, stiff
        from fegear.shafts.rolling_bearing import RollingBearing

        if self.matrix is not None:
            sign = np.array([1.0, 1.0, -1.0, -1.0, -1.0] if mirrored else [1.0] * 5)
            return StiffBearing(np.array(self.matrix) * np.outer(sign, sign))
        if (printed := self.printed) is not None:
            made = replace(printed.inside, ribs=self.ribs is not None)
            return replace(made, contact_angle=-made.contact_angle) if mirrored else made
        if self.elements is not None:
            e = self.elements
            return RollingBearing(
                e.kind, e.count, e.diameter, e.pitch_diameter, -e.contact_angle if mirrored else e.contact_angle,
                (e.groove_ratio[0], e.groove_ratio[1]), e.roller_length or 0.0, e.clearance,
            )  # fmt: skip
        if self.radial_clearance or self.axial_clearance:
            return LooseBearing(
                self.radial or 0.0, self.axial or 0.0, self.tilting, self.radial_clearance, self.axial_clearance
            )
        return stiff(
            math.inf if self.radial is None else self.radial,
            math.inf if self.fixed else self.axial or 0.0, self.tilting,
        )  # fmt: skip
