"""``[train]``: bodies that turn, shafts, gear pairs between them, dampers and torques."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.base.errors import GeometryError
from fegear.case.part import (
    Angle,
    LengthOrZero,
    Number,
    Part,
    PositiveLength,
    PositiveNumber,
    PositivePressure,
    PositiveStiffness,
    quantity,
    refuse,
)
from fegear.geometry.plausible import LONGEST_OF_TRAIN, refuse_shaft

TorsionalStiffness = Annotated[float, quantity("torsional_stiffness", positive=True)]
#: What a body has besides its gears; zero where it has nothing.
InertiaOrZero = Annotated[float, quantity("inertia", not_negative=True)]
TorsionalDamping = Annotated[float, quantity("torsional_damping", not_negative=True)]
MeshDamping = Annotated[float, quantity("damping", not_negative=True)]
FrequencyOrZero = Annotated[float, quantity("frequency")]
AmplitudeOrZero = Annotated[float, quantity("torque", not_negative=True)]
TorqueValue = Annotated[float, quantity("torque")]
Ratio = Annotated[Number, Field(ge=0.0)]
#: Largest order and frequency [Hz] of a torque ripple: far above what teeth, poles of motors or cylinders do.
FASTEST = {"order": 10_000.0, "frequency": 1e6}
#: A length, or the word for back flanks that never touch.
Backlash = LengthOrZero | Literal["unlimited"]


class BodyPart(Part):
    """A body that turns: its inertia, or the gears that it is made of, with their teeth and bodies."""

    inertia: InertiaOrZero | None = Field(
        default=None,
        description="Moment of inertia, in addition to that of `gears`; zero only beside these.",
    )
    gears: Annotated[list[str], Field(min_length=1)] | None = Field(
        default=None,
        description="Gears of the body, whose inertia (teeth, rim, web, hub, bore; density of the material) is "
        "included.",
    )

    @model_validator(mode="after")
    def _some_inertia(self) -> Self:
        if self.inertia is None and self.gears is None:
            raise refuse(
                "is missing", 'set inertia = "0.002 kg*m^2", or gears = ["a"] to take it from their geometry',
                key="inertia", value="(not given)",
            )  # fmt: skip
        if self.inertia == 0.0 and self.gears is None:
            raise refuse(
                "must be greater than zero",
                'replace it by gears = ["a"] for the inertia of gears from their geometry', key="inertia",
            )  # fmt: skip
        return self


class ShaftPart(Part):
    """A shaft between two bodies: stiffness, or length, diameter and shear modulus; or rigid."""

    a: str = Field(description="Body at one end.")
    b: str = Field(description="Body at the other end.")
    stiffness: TorsionalStiffness | None = Field(
        default=None, description="Torsional stiffness; give this, or `length` and `diameter`, or `rigid`."
    )
    length: PositiveLength | None = Field(default=None, description="Length of the shaft, with `diameter`.")
    diameter: PositiveLength | None = Field(default=None, description="Outer diameter of the shaft, with `length`.")
    bore_diameter: LengthOrZero = Field(default=0.0, description="Diameter of the shaft's bore.")
    shear_modulus: PositivePressure = Field(default=79.5e9, description="Shear modulus of the shaft.")
    rigid: bool = Field(default=False, description="Rigid shaft.")
    damping: TorsionalDamping | None = Field(
        default=None, description="Torsional damping; alternatively `damping_ratio`."
    )
    damping_ratio: Ratio | None = Field(
        default=None, description="Damping ratio of the shaft; alternatively `damping`."
    )

    @model_validator(mode="after")
    def _one_stiffness(self) -> Self:
        size = {"length", "diameter", "bore_diameter", "shear_modulus"} & self.given
        ways = [self.stiffness is not None, bool(size), self.rigid]
        if sum(ways) != 1:
            raise refuse(
                "must be specified in exactly one way", "specify stiffness, or length and diameter, or rigid = true",
                key="stiffness", value=f"{sum(ways)} ways",
            )  # fmt: skip
        if size:
            for key in ("length", "diameter"):
                if getattr(self, key) is None:
                    raise refuse("is missing", f'set {key} = "40 mm"', key=key, value="(not given)")
            try:
                refuse_shaft(self.length or 0.0, self.diameter or 0.0, LONGEST_OF_TRAIN)
            except GeometryError as error:
                raise refuse(error.rule, error.remedy, key=error.key, value=error.value) from None
        if self.damping is not None and self.damping_ratio is not None:
            raise refuse("contradicts damping", "specify only one", key="damping_ratio")
        if self.rigid and (self.damping or self.damping_ratio):
            raise refuse("is not used for a rigid shaft", "remove it", key="damping")
        return self


class LikePart(Part):
    """``like = { pair = "I", width_ratio = 6.0 }``: teeth of another pair, unmodified, so many times as wide."""

    pair: str = Field(description="Pair with the same teeth (unmodified).")
    width_ratio: PositiveNumber = Field(default=1.0, description="Face width relative to that of the pair.")


class TrainMeshPart(Part):
    """A gear pair between two bodies; the pair of the same name unless given otherwise."""

    pair: str | None = Field(
        default=None, description="Gear pair of the case for this mesh. Default: pair of the same name."
    )
    driver: str = Field(description="Driving body.")
    driven: str = Field(description="Driven body.")
    like: LikePart | None = Field(default=None, description="Teeth of another pair (unmodified).")
    stiffness: PositiveStiffness | None = Field(
        default=None, description="Mean mesh stiffness. Default: from the tooth compliances."
    )
    damping: MeshDamping | None = Field(
        default=None, description="Damping along the line of action; alternatively `damping_ratio`."
    )
    damping_ratio: Ratio | None = Field(default=None, description="Damping ratio of the mesh; alternatively `damping`.")
    damping_law: Literal["constant", "momentary"] = Field(
        default="constant",
        description="Mesh damping: constant (mean stiffness) or proportional to the instantaneous mesh stiffness "
        "(TM-100180).",
    )
    backlash: Backlash | None = Field(
        default=None,
        description='Backlash along the line of action, or "unlimited" (no back-side contact). Default: from tooth '
        "thickness and centre distance, at least zero.",
    )
    back_pair: str | None = Field(
        default=None,
        description="Pair of the same gears with driver and driven exchanged, which loads the other flanks of "
        "asymmetric teeth: their stiffness in back-side contact.",
    )
    phase: Number = Field(default=0.0, description="Mesh phase at time zero, in base pitches.")

    @model_validator(mode="after")
    def _one_damping(self) -> Self:
        if self.damping is not None and self.damping_ratio is not None:
            raise refuse("contradicts damping", "specify only one", key="damping_ratio")
        if self.damping_law != "constant" and self.damping is None and self.damping_ratio is None:
            raise refuse("requires damping", "specify damping_ratio or damping, or remove it", key="damping_law")
        return self


class DamperPart(Part):
    """A viscous damper between two bodies, or between one and the ground."""

    a: str = Field(description="Body at one end.")
    b: str | None = Field(default=None, description="Body at the other end. Default: the ground.")
    damping: TorsionalDamping = Field(description="Torsional damping.")


class TorqueRipplePart(Part):
    """Torque that fluctuates about the constant torque of a body: a harmonic, or a curve over one period in a file.

    ``T(t) = amplitude cos(order angle + phase)``, positive as in ``[train.torque]``; the angle is that which the body
    has turned since time zero, in the sense in which it runs.
    """

    body: str = Field(description="Body on which the torque acts.")
    order: Number | None = Field(
        default=None, description="Order (periods per revolution of `body` or `order_of`); alternatively `frequency`."
    )
    order_of: str | None = Field(
        default=None, description="Body to whose rotation `order` and the angles of `file` refer. Default: `body`."
    )
    frequency: FrequencyOrZero | None = Field(
        default=None, description="Fixed frequency, independent of speed; alternatively `order`."
    )
    amplitude: AmplitudeOrZero | None = Field(
        default=None, description="Amplitude of the torque; alternatively `amplitude_over_mean`."
    )
    amplitude_over_mean: Annotated[Number, Field(ge=0.0)] | None = Field(
        default=None,
        description="Amplitude relative to the constant torque of the body; with `phase` zero the torque starts at "
        "its maximum.",
    )
    phase: Angle = Field(default=0.0, description="Phase of the cosine at time zero.")
    file: str | None = Field(
        default=None,
        description="CSV file with `angle [deg]` or `time [s]` and `torque [N*m]` over one period, last line equal "
        "to the first torque; linear interpolation, mean removed.",
    )
    harmonics: Annotated[int, Field(ge=1, le=512)] = Field(default=32, description="Number of harmonics of `file`.")

    @model_validator(mode="after")
    def _a_harmonic_or_a_file(self) -> Self:
        if self.file is not None:
            for key in ("order", "frequency", "amplitude", "amplitude_over_mean", "phase"):
                if key in self.given:
                    raise refuse("contradicts file, which defines the complete torque", "specify only one", key=key)
            return self
        if "harmonics" in self.given:
            raise refuse("requires file", "remove it", key="harmonics")
        if (self.order is None) == (self.frequency is None):
            raise refuse(
                "is required, or frequency", 'set order = 2, or frequency = "100 Hz", or a file',
                key="order", value="(both)" if self.order is not None else "(not given)",
            )  # fmt: skip
        if self.frequency is not None and self.order_of is not None:
            raise refuse("is not used with a fixed frequency", "remove it", key="order_of")
        for key in ("order", "frequency"):
            value = getattr(self, key)
            if value is not None and value <= 0.0:
                remedy = "add a constant torque to train.torque" if value == 0.0 else "use phase instead"
                raise refuse("must be greater than zero", remedy, key=key)
            if value is not None and value > FASTEST[key]:
                raise refuse(f"exceeds {FASTEST[key]:,.0f}{' Hz' if key == 'frequency' else ''}", "check it", key=key)
        if (self.amplitude is None) == (self.amplitude_over_mean is None):
            raise refuse(
                "must be specified in one way", 'set amplitude = "8 N*m" or amplitude_over_mean', key="amplitude",
                value="(both)" if self.amplitude is not None else "(not given)",
            )  # fmt: skip
        return self


class TrainPart(Part):
    """A gear train as a graph; angles and torques of all bodies count in one sense of rotation."""

    body: Annotated[dict[str, BodyPart], Field(min_length=1)] = Field(
        description="Rotating bodies, by name; the first is the reference for speeds."
    )
    shaft: dict[str, ShaftPart] = Field(default_factory=dict, description="Shafts between bodies, by name.")
    mesh: Annotated[dict[str, TrainMeshPart], Field(min_length=1)] = Field(
        description="Gear meshes between bodies, by name."
    )
    damper: dict[str, DamperPart] = Field(
        default_factory=dict, description="Dampers between bodies, or from a body to the ground."
    )
    torque: Annotated[dict[str, TorqueValue], Field(min_length=1)] = Field(
        description="Constant torques by body; loads of the pairs must be consistent."
    )
    torque_ripple: dict[str, TorqueRipplePart] = Field(
        default_factory=dict,
        description="Fluctuating torques in addition to the constant ones, by name; active with the effect "
        "`torque_ripple`.",
    )
    balance: str | None = Field(
        default=None,
        description="Body whose torque is calculated from equilibrium. Default: the given torques must balance.",
    )

    @model_validator(mode="after")
    def _names_of_their_own(self) -> Self:
        for name in self.torque_ripple:
            if name in self.mesh:
                raise refuse(
                    "is also the name of a mesh; excitations must have unique names", "choose another name",
                    key="torque_ripple", value=f'"{name}"',
                )  # fmt: skip
        return self

    @model_validator(mode="after")
    def _balanced_by_a_free_body(self) -> Self:
        if self.balance in self.torque:
            raise refuse("already has a torque", "remove one of them", key="balance")
        return self

    def pair_of(self, mesh: str) -> str:
        """Name of the pair that a mesh refers to."""
        return self.mesh[mesh].pair or mesh

    def loaded_pair_of(self, mesh: str) -> str:
        """Name of the pair whose teeth a mesh has."""
        like = self.mesh[mesh].like
        return like.pair if like else self.pair_of(mesh)
