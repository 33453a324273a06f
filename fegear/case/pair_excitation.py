"""``[transmissibility.NAME.excitation]``: what shakes a helical pair, and the speeds at which it does."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.dynamics import Frequency, SpeedsPart
from fegear.case.part import Angle, Force, Length, Part, PositiveNumber, PositiveSpeed, quantity, refuse

Torque = Annotated[float, quantity("torque")]
Coordinate = Literal["y", "z", "theta_x", "theta_y", "theta_z"]


class MeshErrorPart(Part):
    """``transmission_error``: harmonics of a pair of the case, of a table, or one amplitude; along y by default.

    ``flanks`` says which of a pair with a width: rigid or loaded ones; loaded by default where the mesh is that pair's.
    ``shuttling`` adds the moment about x of a force that wanders over the face.
    """

    pair: str | None = Field(
        default=None,
        description="A pair of the case whose transmission error it is; give this, a `file` or an `amplitude`.",
    )
    flanks: Literal["rigid", "loaded"] | None = Field(
        default=None,
        description="Whether that of rigid or of loaded flanks is taken; without it loaded for plane teeth and where "
        "the mesh is the pair's, else rigid.",
    )
    shuttling: bool = Field(
        default=False, description="Whether the moment about x of the force that wanders over the face is added."
    )
    file: str | None = Field(
        default=None, description="CSV file with `n`, `cosine [um]`, `sine [um]`, or `amplitude [um]`."
    )
    amplitude: Length | None = Field(default=None, description="One amplitude, 0-peak.")
    harmonic: Annotated[int, Field(ge=1, le=20_000)] | None = Field(
        default=None, description="The mesh harmonic of `amplitude`; without it the first."
    )
    harmonics: Annotated[int, Field(ge=1, le=64)] | None = Field(
        default=None,
        description="Harmonics taken of a pair or file; without it 8, of loaded flanks at most half as many as "
        "`load_distribution.positions`.",
    )
    along: Coordinate = Field(
        default="y",
        description="Coordinate in which the error acts; angles count as a length at half the face width or at the "
        "base radius.",
    )

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
            if key in self.given and given != ["pair"]:
                raise refuse("belongs to pair", "leave it out", key=key)
        if self.shuttling and self.along != "y":
            raise refuse("goes with an error along y", "leave along out", key="shuttling")
        if self.harmonics is not None and given == ["amplitude"]:
            raise refuse("has no meaning with amplitude", "write harmonic for the one that it has", key="harmonics")
        return self


class ExternalForcePart(Part):
    """A force on a gear: 0-peak amplitudes that are in phase, at an order of its gear's shaft or at a frequency."""

    on: Literal["driver", "driven"] = Field(description="The gear on which the force acts.")
    order: PositiveNumber | None = Field(
        default=None, description="Order of that gear's shaft; give this or `frequency`."
    )
    frequency: Frequency | None = Field(default=None, description="Frequency of the force; give this or `order`.")
    phase: Angle = Field(default=0.0, description="Phase of the force.")
    y: Force = Field(default=0.0, description="Force along the transverse line of action, 0-peak.")
    z: Force = Field(default=0.0, description="Force along the axis, 0-peak.")
    theta_x: Torque = Field(default=0.0, description="Moment about x, 0-peak.")
    theta_y: Torque = Field(default=0.0, description="Moment about y, 0-peak.")
    theta_z: Torque = Field(default=0.0, description="Moment about the axis, 0-peak.")

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

    speeds: SpeedsPart = Field(description="Speeds of the driver: a list, or a range.")
    speed: PositiveSpeed | None = Field(
        default=None, description="Speed whose spectrum is drawn; without it that of the largest mesh force."
    )
    teeth: Annotated[int, Field(ge=1, le=100_000)] | None = Field(
        default=None, description="Teeth of the driver, where the transmission error is not a pair's."
    )
    transmission_error: MeshErrorPart | None = Field(default=None, description="The transmission error that excites.")
    external: list[ExternalForcePart] = Field(
        default_factory=list, max_length=100, description="Forces and moments on the gears."
    )

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
