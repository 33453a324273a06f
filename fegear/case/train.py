"""``[train]``: bodies that turn, shafts, gear pairs between them, dampers and torques."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import (
    LengthOrZero,
    Number,
    Part,
    PositiveInertia,
    PositiveLength,
    PositiveNumber,
    PositivePressure,
    PositiveStiffness,
    quantity,
    refuse,
)

TorsionalStiffness = Annotated[float, quantity("torsional_stiffness", positive=True)]
TorsionalDamping = Annotated[float, quantity("torsional_damping", not_negative=True)]
MeshDamping = Annotated[float, quantity("damping", not_negative=True)]
TorqueValue = Annotated[float, quantity("torque")]
Ratio = Annotated[Number, Field(ge=0.0)]


class BodyPart(Part):
    """A body that turns: its inertia, or the gears that it is made of (discs with their bores, density by material)."""

    inertia: PositiveInertia | None = None
    gears: Annotated[list[str], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _some_inertia(self) -> Self:
        if self.inertia is None and self.gears is None:
            raise refuse(
                "is missing", 'write inertia = "0.002 kg*m^2", or gears = ["a"] to take it from their geometry',
                key="inertia", value="(not given)",
            )  # fmt: skip
        return self


class ShaftPart(Part):
    """A shaft between two bodies: stiffness, or length, diameter and shear modulus; or rigid."""

    a: str
    b: str
    stiffness: TorsionalStiffness | None = None
    length: PositiveLength | None = None
    diameter: PositiveLength | None = None
    bore_diameter: LengthOrZero = 0.0
    shear_modulus: PositivePressure = 79.5e9
    rigid: bool = False
    damping: TorsionalDamping | None = None
    damping_ratio: Ratio | None = None

    @model_validator(mode="after")
    def _one_stiffness(self) -> Self:
        size = {"length", "diameter", "bore_diameter", "shear_modulus"} & self.model_fields_set
        ways = [self.stiffness is not None, bool(size), self.rigid]
        if sum(ways) != 1:
            raise refuse(
                "must be given in exactly one way", "give stiffness, or length and diameter, or rigid = true",
                key="stiffness", value=f"{sum(ways)} ways",
            )  # fmt: skip
        if size:
            for key in ("length", "diameter"):
                if getattr(self, key) is None:
                    raise refuse("is missing", f'write {key} = "40 mm"', key=key, value="(not given)")
        if self.damping is not None and self.damping_ratio is not None:
            raise refuse("contradicts damping", "give either", key="damping_ratio")
        if self.rigid and (self.damping or self.damping_ratio):
            raise refuse("has no meaning for a rigid shaft", "leave it out", key="damping")
        return self


class LikePart(Part):
    """``like = { pair = "I", width_ratio = 6.0 }``: teeth of another pair, unmodified, so many times as wide."""

    pair: str
    width_ratio: PositiveNumber = 1.0


class TrainMeshPart(Part):
    """A gear pair between two bodies; the pair of the same name unless given otherwise."""

    pair: str | None = None
    driver: str
    driven: str
    like: LikePart | None = None
    stiffness: PositiveStiffness | None = None
    damping: MeshDamping | None = None
    damping_ratio: Ratio | None = None
    damping_law: Literal["constant", "momentary"] = "constant"
    backlash: LengthOrZero | None = None
    phase: Number = 0.0

    @model_validator(mode="after")
    def _one_damping(self) -> Self:
        if self.damping is not None and self.damping_ratio is not None:
            raise refuse("contradicts damping", "give either", key="damping_ratio")
        if "damping_law" in self.model_fields_set and self.damping is None and self.damping_ratio is None:
            raise refuse(
                "has a meaning only with damping", "give damping_ratio or damping, or leave it out", key="damping_law"
            )
        return self


class DamperPart(Part):
    """A viscous damper between two bodies, or between one and the ground."""

    a: str
    b: str | None = None
    damping: TorsionalDamping


class TrainPart(Part):
    """A gear train as a graph; angles and torques of all bodies count in one sense of rotation."""

    body: Annotated[dict[str, BodyPart], Field(min_length=1)]
    shaft: dict[str, ShaftPart] = Field(default_factory=dict)
    mesh: Annotated[dict[str, TrainMeshPart], Field(min_length=1)]
    damper: dict[str, DamperPart] = Field(default_factory=dict)
    torque: Annotated[dict[str, TorqueValue], Field(min_length=1)]
    balance: str | None = None

    @model_validator(mode="after")
    def _balanced_by_a_free_body(self) -> Self:
        if self.balance in self.torque:
            raise refuse("has a torque of its own already", "leave one of them out", key="balance")
        return self

    def pair_of(self, mesh: str) -> str:
        """Name of the pair that a mesh refers to."""
        return self.mesh[mesh].pair or mesh

    def loaded_pair_of(self, mesh: str) -> str:
        """Name of the pair whose teeth a mesh has."""
        like = self.mesh[mesh].like
        return like.pair if like else self.pair_of(mesh)
