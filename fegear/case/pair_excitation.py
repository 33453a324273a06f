"""``[transmissibility.NAME.excitation]``: what shakes a helical pair, and the speeds at which it does."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.dynamics import Frequency, SpeedsPart
from fegear.case.part import Angle, Force, Length, Part, PositiveNumber, PositiveSpeed, quantity, refuse

Torque = Annotated[float, quantity("torque")]
Coordinate = Literal["y", "z", "theta_x", "theta_y", "theta_z"]


class MeshErrorPart(Part):
    """``transmission_error``: harmonics of a pair of the case, of a table, or one amplitude; along y unless told.

    ``flanks`` says which of a pair with a width: rigid or loaded ones; loaded by default where the mesh is that pair's.
    ``shuttling`` adds the moment about x of a force that wanders over the face.
    """

    pair: str | None = None
    flanks: Literal["rigid", "loaded"] | None = None
    shuttling: bool = False
    file: str | None = None
    amplitude: Length | None = None
    harmonic: Annotated[int, Field(ge=1, le=20_000)] | None = None
    harmonics: Annotated[int, Field(ge=1, le=64)] | None = None
    along: Coordinate = "y"

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        given = [key for key in ("pair", "file", "amplitude") if getattr(self, key) is not None]
        if len(given) != 1:
            raise refuse(
                "must be given in one way", "give pair, file or amplitude", key="pair",
                value=", ".join(given) or "(not given)",
            )  # fmt: skip
        if self.harmonic is not None and given != ["amplitude"]:
            raise refuse("belongs to amplitude", "leave it out", key="harmonic")
        for key in ("flanks", "shuttling"):
            if key in self.model_fields_set and given != ["pair"]:
                raise refuse("belongs to pair", "leave it out", key=key)
        if self.shuttling and self.along != "y":
            raise refuse("goes with an error along y", "leave along out", key="shuttling")
        if self.harmonics is not None and given == ["amplitude"]:
            raise refuse("has no meaning with amplitude", "write harmonic for the one that it has", key="harmonics")
        return self


class ExternalForcePart(Part):
    """A force on a gear: 0-peak amplitudes that are in phase, at an order of its gear's shaft or at a frequency."""

    on: Literal["driver", "driven"]
    order: PositiveNumber | None = None
    frequency: Frequency | None = None
    phase: Angle = 0.0
    y: Force = 0.0
    z: Force = 0.0
    theta_x: Torque = 0.0
    theta_y: Torque = 0.0
    theta_z: Torque = 0.0

    @model_validator(mode="after")
    def _one_frequency(self) -> Self:
        if self.order is not None and self.frequency is not None:
            raise refuse("contradicts order", "give either", key="frequency")
        if self.order is None and self.frequency is None:
            raise refuse("must be given, or a frequency instead", "give either", key="order")
        if not any(self.components):
            raise refuse(
                "is no force", 'give y, z, theta_x, theta_y or theta_z: theta_z = "10 N*m"', key="y", value=self.y
            )
        return self

    @property
    def components(self) -> tuple[float, ...]:
        """Along y, z [N] and about x, y, z [N m]."""
        return self.y, self.z, self.theta_x, self.theta_y, self.theta_z


class ExcitationPart(Part):
    """Speeds of the driver, its teeth, and what excites."""

    speeds: SpeedsPart
    speed: PositiveSpeed | None = None
    teeth: Annotated[int, Field(ge=1, le=100_000)] | None = None
    transmission_error: MeshErrorPart | None = None
    external: list[ExternalForcePart] = Field(default_factory=list, max_length=100)

    @model_validator(mode="after")
    def _something(self) -> Self:
        error = self.transmission_error
        if error is None and not self.external:
            raise refuse(
                "is missing, and external as well", 'write transmission_error = { amplitude = "1 um" }',
                key="transmission_error", value="(not given)",
            )  # fmt: skip
        if error is not None and error.pair is None and self.teeth is None:
            raise refuse(
                "is missing, but the transmission error needs it: its frequency is teeth times speed",
                "write the driver's number of teeth", key="teeth", value="(not given)",
            )  # fmt: skip
        if error is not None and error.pair is not None and self.teeth is not None:
            raise refuse("is that of the pair already", "leave it out", key="teeth")
        return self
