"""``[gauge.NAME]``: a strain gauge in a root fillet, and what it measured."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import (
    Angle,
    Length,
    LengthOrZero,
    Number,
    Part,
    PositiveLength,
    PositiveNumber,
    PositiveSpeed,
    PositiveVoltage,
    Table,
    refuse,
)
from fegear.case.trace import TracePart

#: Keys that say where the middle of the grid lies.
PLACES = ("tangent_angle", "centre_angle", "arc", "diameter", "height")


class StrainFilePart(Part):
    """File with a measured strain: its first key."""

    file: str = Field(
        description="CSV file with the columns `angle [deg]` (rotation of the gear of the gauge), or `time [s]` at a "
        "constant speed, and `strain [um/m]` or `[mV/V]`."
    )


class MeasuredStrainPart(TracePart, StrainFilePart):
    """``measured = { file, angle, strain, fit }``: a trace of the gauge over the rotation of its gear."""

    strain: str | None = Field(
        default=None,
        description="Unit of the strain column, if its head has none: `um/m`, `ustrain`, `m/m`; of the output of the "
        "bridge `mV/V` (requires `gauge_factor`) or `mV`, `V` (requires `excitation`, too).",
    )
    gauge_factor: PositiveNumber | None = Field(
        default=None,
        description="Gauge factor k, if the strain column is the output of the bridge: strain = 4 U/U_0 / (k N), with "
        "N `active_arms`.",
    )
    active_arms: Annotated[Number, Field(gt=0.0, le=4.0)] = Field(
        default=1.0,
        description="Number N of active arms of the bridge: 1 (quarter bridge), 2 (half), 4 (full); with transverse "
        "gauges 1 + nu or 2 (1 + nu).",
    )
    bridge: str | None = Field(
        default=None,
        description="Second gauge of a half bridge (adjacent arm), e.g. in the other fillet of the tooth. The strain "
        "computed is that of this gauge less that of the second; a strain column has it, or half of it with "
        "`active_arms = 2`.",
    )
    excitation: PositiveVoltage | None = Field(
        default=None, description="Excitation voltage U_0 of the bridge, if the strain column is a voltage."
    )
    amplification: PositiveNumber = Field(
        default=1.0, description="Amplification of the output of the bridge, voltage over voltage."
    )
    strain_column: str = Field(default="strain", description="Name of the strain column.")
    speed: PositiveSpeed | None = Field(
        default=None,
        description="Constant speed of the gear of the gauge (of `shaft`) during the trace, if it is over time; from "
        "two turns on it is found from the period of the trace within ±5 %. Default: that of the pair.",
    )
    fit: list[Literal["offset", "scale", "shift", "drift", "runout"]] = Field(
        default_factory=list,
        description="Parameters fitted by least squares: `offset` (zero of the bridge), `scale` (gauge factor, load), "
        "`shift` (zero of the angle); with `offset` also `drift` (linear over the turns) and `runout` (once per turn, "
        "outside the mesh).",
    )
    shaft: Literal["driver", "driven"] | None = Field(
        default=None,
        description="Shaft whose rotation is in the angle column, if the encoder is on the shaft of the mate. Default: "
        "that of the gear of the gauge.",
    )

    @model_validator(mode="after")
    def _sensible(self) -> Self:
        self.check_columns(self.fit, self.strain_column, "strain_column", "strain")
        for one in ("drift", "runout"):
            if one in self.fit and "offset" not in self.fit:
                raise refuse(f"contains {one} without offset", "add offset", value=list(self.fit), key="fit")
        return self


class GaugePart(Part):
    """A strain gauge on one tooth of a gear."""

    gear: str = Field(description="Gear that has the gauge.")
    pair: str | None = Field(
        default=None, description="Pair in which the gear is loaded. Default: the only pair of the gear."
    )
    member: Literal["driver", "driven"] | None = Field(
        default=None,
        description="Whether the gear is the driver or the driven gear, if it meshes with an identical one. Default: "
        "driver.",
    )
    tooth: Annotated[int, Field(ge=1)] = Field(
        default=1,
        description="Number of the tooth in meshing order, as in `spacing_errors`; of influence with pitch deviations "
        "only.",
    )
    fillet: Literal["tension", "compression"] = Field(
        default="tension",
        description="Fillet of the loaded flank (tension) or the opposite one (compression).",
    )
    tangent_angle: Angle | None = Field(
        default=None,
        description="Place by the angle between tangent and tooth centre line. Default: 30 deg (internal gears: 60 "
        "deg), ISO 6336-3.",
    )
    centre_angle: Angle | None = Field(
        default=None, description="Place by the angle about the gear axis from the tooth centre line."
    )
    arc: LengthOrZero | None = Field(
        default=None, description="Place by the arc length along the fillet, from the root land towards the tip."
    )
    diameter: PositiveLength | None = Field(default=None, description="Place by the diameter.")
    height: LengthOrZero | None = Field(default=None, description="Place by the radial distance from the root circle.")
    grid_length: LengthOrZero = Field(
        default=0.0, description="Length of the measuring grid in its direction; the strain is its mean over the grid."
    )
    grid_width: LengthOrZero = Field(default=0.0, description="Width of the measuring grid.")
    direction: Angle = Field(
        default=0.0,
        description="Angle between the direction of measurement and the profile (in the transverse section), -90 to "
        "90 deg; of 3D gears positive from the tip towards end II.",
    )
    face_position: Length = Field(
        default=0.0,
        description="Place of the grid centre along the face of 3D gears, from the middle of the common face, positive "
        "towards end II.",
    )
    placement_tolerance: LengthOrZero = Field(
        default=1e-4, description="Uncertainty (±) of the position along the fillet. Default: 0.1 mm."
    )
    load_tolerance: Annotated[Number, Field(ge=0.0, le=1.0)] = Field(
        default=0.01, description="Relative uncertainty (±) of load and gauge factor together."
    )
    measured: Table[MeasuredStrainPart] | None = Field(default=None, description="Measured strain to compare with.")

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        given = [key for key in PLACES if getattr(self, key) is not None]
        if len(given) > 1:
            raise refuse(f"contradicts {given[0]}", f"specify one of {', '.join(PLACES)}", key=given[1])
        return self
