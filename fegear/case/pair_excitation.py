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
        description="Pair whose transmission error excites the vibration; alternatively `file` or `amplitude`.",
    )
    flanks: Literal["rigid", "loaded"] | None = Field(
        default=None,
        description="Transmission error of rigid or of loaded flanks. Default: loaded for the plane (2D) model and "
        "if the mesh is that of the pair, otherwise rigid.",
    )
    shuttling: bool = Field(
        default=False, description="Include the moment about x due to axial shuttling of the mesh force."
    )
    file: str | None = Field(
        default=None, description="CSV file with `n`, `cosine [um]`, `sine [um]`, or `amplitude [um]`."
    )
    amplitude: Length | None = Field(default=None, description="Single amplitude.")
    harmonic: Annotated[int, Field(ge=1, le=20_000)] | None = Field(
        default=None, description="Mesh harmonic of `amplitude`. Default: 1."
    )
    harmonics: Annotated[int, Field(ge=1, le=64)] | None = Field(
        default=None,
        description="Number of harmonics of pair or file. Default: 8, for loaded flanks at most half of "
        "`load_distribution.positions`.",
    )
    along: Coordinate = Field(
        default="y",
        description="Coordinate in which the error acts; angles as a length at half the face width or at the base "
        "radius.",
    )

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        given = [key for key in ("pair", "file", "amplitude") if getattr(self, key) is not None]
        if len(given) != 1:
            raise refuse(
                "must be specified in one way", "specify pair, file or amplitude", key="pair",
                value=", ".join(given) or "(not given)",
            )  # fmt: skip
        if self.harmonic is not None and given != ["amplitude"]:
            raise refuse("belongs to amplitude", "remove it", key="harmonic")
        for key in ("flanks", "shuttling"):
            if key in self.given and given != ["pair"]:
                raise refuse("belongs to pair", "remove it", key=key)
        if self.shuttling and self.along != "y":
            raise refuse("requires an error along y", "remove along", key="shuttling")
        if self.harmonics is not None and given == ["amplitude"]:
            raise refuse("is not used with amplitude", "use harmonic for its order", key="harmonics")
        return self


class ExternalForcePart(Part):
    """A force on a gear: 0-peak amplitudes that are in phase, at an order of its gear's shaft or at a frequency."""

    on: Literal["driver", "driven"] = Field(description="The gear on which the force acts.")
    order: PositiveNumber | None = Field(
        default=None, description="Order of that gear's shaft; alternatively `frequency`."
    )
    frequency: Frequency | None = Field(default=None, description="Frequency of the force; alternatively `order`.")
    phase: Angle = Field(default=0.0, description="Phase of the force.")
    y: Force = Field(default=0.0, description="Amplitude of the force along the transverse line of action.")
    z: Force = Field(default=0.0, description="Amplitude of the axial force.")
    theta_x: Torque = Field(default=0.0, description="Amplitude of the moment about x.")
    theta_y: Torque = Field(default=0.0, description="Amplitude of the moment about y.")
    theta_z: Torque = Field(default=0.0, description="Amplitude of the moment about the gear axis.")

    @model_validator(mode="after")
    def _one_frequency(self) -> Self:
        if self.order is not None and self.frequency is not None:
            raise refuse("contradicts order", "specify only one", key="frequency")
        if self.order is None and self.frequency is None:
            raise refuse("must be given, or a frequency instead", "specify only one", key="order")
        if not any(self.components):
            raise refuse(
                "must have a force or moment",
                'specify y, z, theta_x, theta_y or theta_z: theta_z = "10 N*m"',
                key="y",
                value=self.y,
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
        default=None, description="Speed of the plotted spectrum. Default: speed of the maximum mesh force."
    )
    teeth: Annotated[int, Field(ge=1, le=100_000)] | None = Field(
        default=None, description="Number of driver teeth, if the transmission error is not from a pair."
    )
    transmission_error: MeshErrorPart | None = Field(default=None, description="Transmission error excitation.")
    external: list[ExternalForcePart] = Field(
        default_factory=list, max_length=100, description="External forces and moments on the gears."
    )

    @model_validator(mode="after")
    def _something(self) -> Self:
        error = self.transmission_error
        if error is None and not self.external:
            raise refuse(
                "is required, or external", 'set transmission_error = { amplitude = "1 um" }',
                key="transmission_error", value="(not given)",
            )  # fmt: skip
        if error is not None and error.pair is None and self.teeth is None:
            raise refuse(
                "is required for the frequency of the transmission error",
                "specify the number of teeth of the driver", key="teeth", value="(not given)",
            )  # fmt: skip
        if error is not None and error.pair is not None and self.teeth is not None:
            raise refuse("is already defined by the pair", "remove it", key="teeth")
        return self
