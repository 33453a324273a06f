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

    torque: TorqueOrZero | None = Field(default=None, description="Driver torque in this bin.")
    load_factor: NumberOrZero | None = Field(
        default=None, description="Load of this bin as a multiple of the pair's load, instead of torque."
    )
    speed: PositiveSpeed | None = Field(
        default=None, description="Driver speed in this bin. Default: speed of the pair."
    )
    share: NumberOrZero | None = Field(default=None, description="Time share of this bin; the sum over all bins is 1.")
    time: PositiveTime | None = Field(default=None, description="Operating time in this bin, instead of share.")

    @model_validator(mode="after")
    def _one_of_each(self) -> Self:
        for one, other in (("torque", "load_factor"), ("share", "time")):
            given = [key for key in (one, other) if getattr(self, key) is not None]
            if not given:
                raise refuse(f"is required, or {other}", f"specify {one} or {other} for every bin", key=one)
            if len(given) == 2:
                raise refuse(f"contradicts {one}", f"specify {one} or {other}", key=other)
        return self


class OperationPart(Part):
    """``operation = { application_factor, life, spectrum, ... }``: loads and life that a rating is for."""

    application_factor: PositiveNumber = Field(
        default=1.0,
        description="Application factor K_A (external dynamic loads); 1 with a load spectrum of actual loads.",
    )
    mesh_load_factor: Factor | None = Field(
        default=None,
        description="Mesh load factor K_gamma (uneven load sharing between load paths). Default: 1, in a planetary set "
        "that of planet-load-sharing, of a double helical pair that of double-helical.",
    )
    dynamic_factor: Factor | None = Field(
        default=None,
        description="User-defined dynamic factor K_v, for example from dynamic-factor. Default: ISO 6336-1 method B.",
    )
    face_load_factor: Factor | None = Field(
        default=None, description="User-defined face load factor K_Hbeta. Default: ISO 6336-1."
    )
    transverse_load_factor: Factor | None = Field(
        default=None, description="User-defined transverse load factor K_Halpha = K_Falpha. Default: ISO 6336-1."
    )
    life: PositiveTime | None = Field(
        default=None,
        description="Required life at the speed of the pair or under the load spectrum. Default: unlimited.",
    )
    load_cycles: Annotated[Number, Field(ge=1.0)] | None = Field(
        default=None, description="Required number of load cycles of the driver, instead of life."
    )
    contacts: list[Annotated[int, Field(ge=1, le=100)]] | None = Field(
        default=None,
        description="Load cycles of a flank of driver and driven gear per revolution, e.g. 3 for a sun with three "
        "planets (K_v uses a third of its mass for each mesh). Default: `[1, 1]`, in a planetary set the "
        "number of planets for sun and ring.",
    )
    idler: Literal["driver", "driven", "both"] | None = Field(
        default=None, description="Gear with alternating bending (idler or planet)."
    )
    reversed_load: Annotated[Number, Field(ge=0.0, le=1.0)] = Field(
        default=0.0,
        description="Reversing drive: load on the non-working flanks relative to the working flanks; stress ratio R "
        "= -1.2 times this value for Y_M (ISO 6336-3 annex B).",
    )
    mean_stress_factor: list[Annotated[Number, Field(ge=0.4, le=1.5)]] | None = Field(
        default=None,
        description="User-defined Y_M of driver and driven gear, e.g. `[1.0, 0.7]` if the driven gear is an idler. "
        "Default: ISO 6336-3 annex B.",
    )
    spectrum: Annotated[list[SpectrumPart], Field(min_length=1), at_most(1000, "bins")] | None = Field(
        default=None, description="Load spectrum in bins, damage by Miner's rule (ISO 6336-6)."
    )
    spectrum_line: Literal["part-2", "annex-c"] = Field(
        default="part-2",
        description="S-N curve for pitting with a load spectrum: ISO 6336-2 (Z_L, Z_v, Z_R interpolated between "
        "static and reference life) or ISO 6336-6 annex C (applied at all load cycles).",
    )
    safety_contact: PositiveNumber = Field(default=1.0, description="Minimum safety factor for pitting S_Hmin.")
    safety_root: PositiveNumber = Field(default=1.4, description="Minimum safety factor for tooth breakage S_Fmin.")

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
            raise refuse("contradicts life", "specify life or load_cycles", key="load_cycles")
        for key in ("application_factor", "mesh_load_factor"):
            if (getattr(self, key) or 1.0) > _LARGEST:
                raise refuse(
                    f"is above the plausible maximum of {_LARGEST:g}",
                    "check the decimal point, or increase the load", key=key,
                )  # fmt: skip
        if len(self.loaded_per_turn) != 2:
            raise refuse("must be two numbers, for driver and driven gear", "usually [1, 1]", key="contacts")
        if self.mean_stress_factor is not None and len(self.mean_stress_factor) != 2:
            raise refuse(
                "must be two numbers, for driver and driven gear",
                    "[1.0, 0.7] if the driven gear is an idler",
                key="mean_stress_factor",
            )  # fmt: skip
        bins = self.spectrum or []
        timed = [one.time is not None for one in bins]
        if any(timed) and not all(timed):
            raise refuse(
                "must not mix bins with share and bins with time", "use one of them for all bins", key="spectrum"
            )
        shares = sum(one.share or 0.0 for one in bins)
        if bins and not timed[0] and abs(shares - 1.0) > _SHARES:
            raise refuse(
                f"has shares that add up to {shares:.6g}", "time shares must add up to 1", key="spectrum",
                value="(a list)",
            )  # fmt: skip
        if not bins and self.spectrum_line != "part-2":
            raise refuse("requires a spectrum", "specify a spectrum, or remove it", key="spectrum_line")
        if bins and self.load_cycles is not None:
            raise refuse("is not used with a spectrum", "specify life", key="load_cycles")
        return self


class ShaftsPart(Part):
    """``shafts = { arrangement, bearing_span, offset, diameter, ... }``: the pinion's, by ISO 6336-1, method C.

    The pinion is the gear with fewer teeth; the standard's formula knows its shaft alone.
    """

    arrangement: Literal["a", "b", "c", "d", "e"] | None = Field(
        default=None,
        description="Pinion arrangement (a to e) for K' of ISO 6336-1.",
    )
    bearing_span: PositiveLength | None = Field(default=None, description="Bearing span l of the pinion shaft.")
    offset: LengthOrZero = Field(
        default=0.0,
        description="Distance s from the pinion centre to mid-span, as in the figure of the arrangement.",
    )
    diameter: PositiveLength | None = Field(
        default=None, description="Outer diameter d_sh of the pinion shaft (nominal for bending)."
    )
    power_share: Annotated[Number, Field(gt=0.0, le=1.0)] = Field(
        default=1.0, description="Share of the input power transmitted by this mesh, k% of ISO 6336-1."
    )
    deformation: LengthOrZero | None = Field(
        default=None,
        description="Misalignment f_sh from shaft and pinion deformation, if known; replaces arrangement, "
        "bearing_span and diameter.",
    )
    misalignment: LengthOrZero | None = Field(
        default=None,
        description="Manufacturing misalignment f_ma. Default: from the tolerance classes.",
    )
    modification: HelixModification | None = Field(
        default=None,
        description="Helix modification for B_1, B_2 of ISO 6336-1. Default: from `lead` of the gears.",
    )
    contact_pattern: Literal["unknown", "favourable", "verified"] = Field(
        default="unknown",
        description="Contact pattern (ISO 6336-1): `unknown`, `favourable` (deformation and manufacturing "
        "misalignment compensate each other) or `verified`.",
    )

    @model_validator(mode="after")
    def _whole_shaft(self) -> Self:
        shaft = ("arrangement", "bearing_span", "diameter")
        missing = [key for key in shaft if getattr(self, key) is None]
        if self.deformation is None and missing:
            raise refuse("is missing", "specify arrangement, bearing_span and diameter, or deformation", key=missing[0])
        if self.deformation is not None and len(missing) < len(shaft):
            key = next(key for key in shaft if key not in missing)
            raise refuse("contradicts deformation", "specify either the shaft or f_sh", key=key)
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
            description="Evaluations in addition to ISO 6336: FE load distribution and root stress (seconds to "
            "minutes), ANSI/AGMA 2101-D04.",
        )
    )
    reliability: Annotated[float, Field(ge=0.5, le=0.9999)] = Field(
        default=0.99, description="Reliability for ANSI/AGMA 2101; the stress numbers of ISO 6336 are for 0.99."
    )
