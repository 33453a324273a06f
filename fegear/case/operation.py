"""``operation`` and ``shafts`` of a pair: what it has to bear, for how long, and what carries it."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import (
    Length,
    LengthOrZero,
    Number,
    Part,
    PositiveLength,
    PositiveNumber,
    PositiveSpeed,
    PositiveTime,
    TorqueOrZero,
    at_most,
    refuse,
)

NumberOrZero = Annotated[Number, Field(ge=0.0)]
Factor = Annotated[Number, Field(ge=1.0)]
#: Shares of a spectrum may miss their sum of 1 by so much: they are often given in percent of one decimal.
_SHARES = 2e-3


class SpectrumPart(Part):
    """One bin of ``spectrum = [{ torque or load_factor, speed, share or time }, ...]``."""

    torque: TorqueOrZero | None = Field(default=None, description="torque of the driver in this bin")
    load_factor: NumberOrZero | None = Field(
        default=None, description="load of this bin as a multiple of the pair's load or torque, in place of torque"
    )
    speed: PositiveSpeed | None = Field(default=None, description="speed of the driver in this bin; the pair's without")
    share: NumberOrZero | None = Field(
        default=None, description="share of the time spent in this bin; they add up to 1"
    )
    time: PositiveTime | None = Field(default=None, description="time spent in this bin, in place of share")

    @model_validator(mode="after")
    def _one_of_each(self) -> Self:
        for one, other in (("torque", "load_factor"), ("share", "time")):
            given = [key for key in (one, other) if getattr(self, key) is not None]
            if not given:
                raise refuse(f"is missing, or {other}", f"give {one} or {other} of every bin", key=one)
            if len(given) == 2:
                raise refuse(f"contradicts {one}", f"give {one} or {other}", key=other)
        return self


class OperationPart(Part):
    """``operation = { application_factor, life, spectrum, ... }``: loads and life that a rating is for."""

    application_factor: PositiveNumber = Field(
        default=1.0, description="K_A, what driving and driven machine add to the nominal load; 1 with a spectrum"
    )
    mesh_load_factor: Factor = Field(
        default=1.0, description="K_gamma, what uneven sharing between several paths, as planets, adds to the load"
    )
    dynamic_factor: Factor | None = Field(
        default=None, description="own K_v in place of that of ISO 6336-1 method B, e.g. from result dynamic-factor"
    )
    face_load_factor: Factor | None = Field(default=None, description="own K_Hbeta in place of that of ISO 6336-1")
    transverse_load_factor: Factor | None = Field(
        default=None, description="own K_Halpha = K_Falpha in place of that of ISO 6336-1"
    )
    life: PositiveTime | None = Field(default=None, description="required life at the pair's speed or of the spectrum")
    load_cycles: PositiveNumber | None = Field(
        default=None, description="load cycles that a flank of the driver must bear, in place of life"
    )
    contacts: list[Annotated[int, Field(ge=1, le=100)]] = Field(
        default=[1, 1],
        description="how often a flank of the driver and of the driven gear is loaded per revolution: 3 for a sun "
        "gear with three planets",
    )
    idler: Literal["driver", "driven", "both"] | None = Field(
        default=None, description="gear whose teeth are bent to either side once per revolution, as those of an idler"
    )
    spectrum: Annotated[list[SpectrumPart], Field(min_length=1), at_most(1000, "bins")] | None = Field(
        default=None, description="loads of the life in bins, which are added up by Miner's rule (ISO 6336-6)"
    )
    safety_contact: PositiveNumber = Field(default=1.0, description="S_Hmin, safety against pitting that is required")
    safety_root: PositiveNumber = Field(
        default=1.4, description="S_Fmin, safety against breakage of the tooth root that is required"
    )

    @model_validator(mode="after")
    def _one_life(self) -> Self:
        if self.life is not None and self.load_cycles is not None:
            raise refuse("contradicts life", "give life or load_cycles", key="load_cycles")
        if len(self.contacts) != 2:
            raise refuse(
                "must hold two numbers, of the driver and of the driven gear", "[1, 1] as a rule", key="contacts"
            )
        bins = self.spectrum or []
        timed = [one.time is not None for one in bins]
        if any(timed) and not all(timed):
            raise refuse("mixes bins of a share with bins of a time", "give one of them for all", key="spectrum")
        shares = sum(one.share or 0.0 for one in bins)
        if bins and not timed[0] and abs(shares - 1.0) > _SHARES:
            raise refuse(
                f"has shares that add up to {shares:.6g}", "shares of the time add up to 1", key="spectrum",
                value="(a list)",
            )  # fmt: skip
        if bins and self.load_cycles is not None:
            raise refuse("has no meaning with a spectrum", "give life", key="load_cycles")
        return self


class ShaftsPart(Part):
    """``shafts = { arrangement, bearing_span, offset, diameter, ... }``: the pinion's, by ISO 6336-1, method C.

    The pinion is the gear with fewer teeth; the standard's formula knows its shaft alone.
    """

    arrangement: Literal["a", "b", "c", "d", "e"] = Field(
        description="where the pinion sits and the torque enters: letter of the figure of ISO 6336-1 for K'"
    )
    bearing_span: PositiveLength = Field(description="l, distance of the bearings of the pinion shaft")
    offset: LengthOrZero = Field(description="s, distance of the pinion's middle from the middle of the bearing span")
    diameter: PositiveLength = Field(description="d_sh, outer diameter of the pinion shaft where it bends")
    stiffened: bool = Field(
        default=True,
        description="whether the pinion's body stiffens its shaft: of one piece with it, or shrunk on",
    )
    power_share: Annotated[Number, Field(gt=0.0, le=1.0)] = Field(
        default=1.0, description="share of the input power that goes through this one mesh, k% of ISO 6336-1"
    )
    misalignment: Length | None = Field(
        default=None,
        description="f_ma, misalignment of the mesh from manufacture over the face; from the tolerance classes without",
    )
    pattern: Literal["unproved", "favourable"] = Field(
        default="unproved",
        description="whether the contact pattern is proved to lie so that shaft deflection and manufacture make up for "
        "each other",
    )
