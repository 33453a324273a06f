"""``operation`` and ``shafts`` of a pair: what it has to bear, for how long, and what carries it.

``[rating]``: what is compared with the rating by ISO 6336.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from fegear.case.part import (
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


#: What is done to the flanks along the face: rows of ISO 6336-1's table of B_1 and B_2.
HelixModification = Literal[
    "none", "crowned", "crowned for manufacture", "helix corrected", "helix corrected and crowned", "end relief"
]


#: Shares of a spectrum may miss their sum of 1 by so much: they are often given in percent of one decimal.
_SHARES = 2e-3


#: Factors K_A and K_gamma above this are slips of the pen.
_LARGEST = 10.0


class SpectrumPart(Part):
    """One bin of ``spectrum = [{ torque or load_factor, speed, share or time }, ...]``."""

    torque: TorqueOrZero | None = Field(default=None, description="Torque of the driver in this bin.")
    load_factor: NumberOrZero | None = Field(
        default=None, description="Load of this bin as a multiple of the pair's load, in place of torque."
    )
    speed: PositiveSpeed | None = Field(default=None, description="Speed of the driver here; the pair's without.")
    share: NumberOrZero | None = Field(
        default=None, description="Share of the time spent in this bin; they add up to 1."
    )
    time: PositiveTime | None = Field(default=None, description="Time spent in this bin, in place of share.")

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
        default=1.0,
        description="Application factor K_A: what both machines add to the nominal load; 1 with a spectrum.",
    )
    mesh_load_factor: Factor | None = Field(
        default=None,
        description="Mesh load factor K_gamma: what uneven sharing between several paths adds to the load. Default: 1, "
        "in a pair of a planetary set that of its planet-load-sharing.",
    )
    dynamic_factor: Factor | None = Field(
        default=None,
        description="Own K_v in place of that of ISO 6336-1 method B, for example from the result dynamic-factor.",
    )
    face_load_factor: Factor | None = Field(default=None, description="Own K_Hbeta in place of that of ISO 6336-1.")
    transverse_load_factor: Factor | None = Field(
        default=None, description="Own K_Halpha = K_Falpha in place of that of ISO 6336-1."
    )
    life: PositiveTime | None = Field(
        default=None, description="Required life at the pair's speed or under the spectrum; unlimited without."
    )
    load_cycles: Annotated[Number, Field(ge=1.0)] | None = Field(
        default=None, description="Load cycles that a flank of the driver must bear, in place of life."
    )
    contacts: list[Annotated[int, Field(ge=1, le=100)]] | None = Field(
        default=None,
        description="How often a flank of driver and driven gear is loaded per revolution: 3 for a sun with three "
        "planets, of whose mass K_v takes a third for each mesh. Default: `[1, 1]`, in a planetary set the planets of "
        "sun and ring.",
    )
    idler: Literal["driver", "driven", "both"] | None = Field(
        default=None, description="Gear whose teeth are bent to either side once per revolution, as those of an idler."
    )
    reversed_load: Annotated[Number, Field(ge=0.0, le=1.0)] = Field(
        default=0.0,
        description="Load of the rear flanks of both gears as a part of that of the working flanks, of a drive that "
        "reverses: R = -1.2 times it in Y_M of annex B of ISO 6336-3.",
    )
    mean_stress_factor: list[Annotated[Number, Field(ge=0.4, le=1.5)]] | None = Field(
        default=None,
        description="Own Y_M of the driver and of the driven gear in place of that of annex B of ISO 6336-3, such as "
        "`[1.0, 0.7]` with an idler driven.",
    )
    spectrum: Annotated[list[SpectrumPart], Field(min_length=1), at_most(1000, "bins")] | None = Field(
        default=None, description="Loads of the life in bins, which are added up by Miner's rule (ISO 6336-6)."
    )
    spectrum_line: Literal["part-2", "annex-c"] = Field(
        default="part-2",
        description="S-N line of the flanks under the spectrum: that of ISO 6336-2, whose film factors come in between "
        "static strength and reference, or that of the example in annex C of ISO 6336-6, which has them at every "
        "number of load cycles.",
    )
    safety_contact: PositiveNumber = Field(default=1.0, description="Required safety against pitting S_Hmin.")
    safety_root: PositiveNumber = Field(
        default=1.4, description="Required safety against breakage of the tooth root S_Fmin."
    )

    @property
    def applied_factor(self) -> float:
        """K_A K_gamma, by which ISO 6336-1 multiplies F_t before it asks for stiffness and dynamic factor."""
        return self.application_factor * self.k_gamma

    @property
    def k_gamma(self) -> float:
        """K_gamma as given, else that of loads which are shared evenly."""
        return self.mesh_load_factor or 1.0

    @property
    def loaded_per_turn(self) -> list[int]:
        """Contacts of a flank of driver and driven gear in a turn."""
        return [1, 1] if self.contacts is None else self.contacts

    @model_validator(mode="after")
    def _one_life(self) -> Self:
        if self.life is not None and self.load_cycles is not None:
            raise refuse("contradicts life", "give life or load_cycles", key="load_cycles")
        for key in ("application_factor", "mesh_load_factor"):
            if (getattr(self, key) or 1.0) > _LARGEST:
                raise refuse(
                    f"multiplies the load by more than {_LARGEST:g}, as no drive does",
                    "check the decimal point, or give a larger load", key=key,
                )  # fmt: skip
        if len(self.loaded_per_turn) != 2:
            raise refuse(
                "must hold two numbers, of the driver and of the driven gear", "[1, 1] as a rule", key="contacts"
            )
        if self.mean_stress_factor is not None and len(self.mean_stress_factor) != 2:
            raise refuse(
                "must hold two numbers, of the driver and of the driven gear", "[1.0, 0.7] with an idler driven",
                key="mean_stress_factor",
            )  # fmt: skip
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
        if not bins and self.spectrum_line != "part-2":
            raise refuse("has a meaning only with a spectrum", "give a spectrum, or remove it", key="spectrum_line")
        if bins and self.load_cycles is not None:
            raise refuse("has no meaning with a spectrum", "give life", key="load_cycles")
        return self


class ShaftsPart(Part):
    """``shafts = { arrangement, bearing_span, offset, diameter, ... }``: the pinion's, by ISO 6336-1, method C.

    The pinion is the gear with fewer teeth; the standard's formula knows its shaft alone.
    """

    arrangement: Literal["a", "b", "c", "d", "e"] | None = Field(
        default=None,
        description="Where the pinion sits and the torque enters: letter of the figure of ISO 6336-1 for K'.",
    )
    bearing_span: PositiveLength | None = Field(default=None, description="Distance l of the pinion shaft's bearings.")
    offset: LengthOrZero = Field(
        default=0.0,
        description="Distance s of the pinion's middle from that of the bearings, as drawn for the arrangement.",
    )
    diameter: PositiveLength | None = Field(
        default=None, description="Outer diameter d_sh of the pinion shaft where it bends."
    )
    power_share: Annotated[Number, Field(gt=0.0, le=1.0)] = Field(
        default=1.0, description="Share of the input power that goes through this one mesh, k% of ISO 6336-1."
    )
    deformation: LengthOrZero | None = Field(
        default=None,
        description="Misalignment f_sh of the loaded shafts over the face, where it is known better; then without "
        "arrangement, bearing_span and diameter.",
    )
    misalignment: LengthOrZero | None = Field(
        default=None,
        description="Misalignment f_ma from manufacture over the face; from the tolerance classes without.",
    )
    modification: HelixModification | None = Field(
        default=None,
        description="What is done to the flanks along the face against misalignment (B_1, B_2 of ISO 6336-1); "
        "from lead of the gears without.",
    )
    contact_pattern: Literal["unknown", "favourable", "verified"] = Field(
        default="unknown",
        description="Whether the contact pattern is known: deformation and manufacture offset each other, or it fits.",
    )

    @model_validator(mode="after")
    def _whole_shaft(self) -> Self:
        shaft = ("arrangement", "bearing_span", "diameter")
        missing = [key for key in shaft if getattr(self, key) is None]
        if self.deformation is None and missing:
            raise refuse("is missing", "give arrangement, bearing_span and diameter, or deformation", key=missing[0])
        if self.deformation is not None and len(missing) < len(shaft):
            key = next(key for key in shaft if key not in missing)
            raise refuse("contradicts deformation", "give either the shaft or f_sh", key=key)
        return self


Beside = Literal["computed", "agma-2101"]


def _several(value: Any) -> Any:
    """Let one name stand for a list of it."""
    return (value,) if isinstance(value, str) else tuple(value) if isinstance(value, list) else value


class RatingPart(Part):
    """``[rating]``: ``beside = ["computed", "agma-2101"]``, ``reliability``.

    Formulas take milliseconds; what is computed (finite elements, load distribution) takes seconds to minutes, and is
    done where a case asks for it.
    """

    beside: Annotated[tuple[Beside, ...], BeforeValidator(_several, json_schema_input_type=Beside | list[Beside])] = (
        Field(
            default=("agma-2101",),
            description="What is evaluated in addition to ISO 6336: computed load distribution and root stress, which "
            "take seconds to minutes, and those of ANSI/AGMA 2101-D04.",
        )
    )
    reliability: Annotated[float, Field(ge=0.5, le=0.9999)] = Field(
        default=0.99, description="Reliability that ANSI/AGMA 2101 rates for; ISO 6336's stress numbers are for 0.99."
    )
