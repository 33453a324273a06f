"""``[transmissibility.NAME]``: a helical pair as rigid gears on bearings, and what is looked at.

Frequencies, parameters over which modes are followed, and an excitation: each in a table of its own.

``[transmissibility.NAME.follow]``: parameters over which the modes of a helical pair are followed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from fegear.base.errors import InputError
from fegear.case.pair_excitation import ExcitationPart
from fegear.case.part import (
    Angle,
    Number,
    Part,
    PositiveInertia,
    PositiveLength,
    PositiveMass,
    PositiveStiffness,
    StiffnessOrZero,
    TorsionalStiffnessOrZero,
    at,
    at_most,
    refuse,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters
    from fegear.dynamics.helical_pair.model import HelicalPairModel, ReducedPairModel, RigidGear


_Count = Annotated[int, Field(ge=2, le=10_000)]
_MOST = at_most(24, "responses")
NotNegative = Annotated[Number, Field(ge=0.0)]


class _Range(Part):
    """What all ranges share."""

    count: _Count = Field(default=61, description="Number of values.")
    spacing: Literal["linear", "logarithmic"] = Field(
        default="linear", description="Spacing of the values: linear or logarithmic."
    )

    @property
    def ends(self) -> tuple[float, float]:
        """Start and stop in SI."""
        return getattr(self, "start"), getattr(self, "stop")  # noqa: B009  (fields of what derives from this)

    @model_validator(mode="after")
    def _rising(self) -> Self:
        start, stop = self.ends
        if stop <= start:
            raise refuse("must be greater than start", key="stop")
        if self.spacing == "logarithmic" and start <= 0.0:
            raise refuse("must be greater than zero on a logarithmic scale", key="start")
        return self

    @property
    def array(self) -> NDArray[np.float64]:
        """All values, rising."""
        space = np.linspace if self.spacing == "linear" else np.geomspace
        return np.asarray(space(*self.ends, self.count))


class NumbersPart(_Range):
    """``{ start, stop, count, spacing, responses }`` of a plain number."""

    start: Number = Field(description="First value.")
    stop: Number = Field(description="Last value.")
    responses: Annotated[list[Number], _MOST] = Field(
        default_factory=list, description="Values for which the frequency response is plotted."
    )


class AnglesPart(_Range):
    """The same of an angle."""

    start: Angle = Field(description="First angle.")
    stop: Angle = Field(description="Last angle.")
    responses: Annotated[list[Angle], _MOST] = Field(
        default_factory=list, description="Angles for which the frequency response is plotted."
    )


class StiffnessesPart(_Range):
    """The same of a stiffness."""

    start: PositiveStiffness = Field(description="First stiffness.")
    stop: PositiveStiffness = Field(description="Last stiffness.")
    responses: Annotated[list[PositiveStiffness], _MOST] = Field(
        default_factory=list, description="Stiffnesses for which the frequency response is plotted."
    )


class FactorsPart(_Range):
    """The same of a factor, which is not negative."""

    start: Annotated[Number, Field(ge=0.0)] = Field(description="First factor.")
    stop: Number = Field(description="Last factor.")
    responses: Annotated[list[Annotated[Number, Field(ge=0.0)]], _MOST] = Field(
        default_factory=list, description="Factors for which the frequency response is plotted."
    )


class FollowPart(Part):
    """Ranges by parameter; `bearing_stiffness` is a factor of all bearing stiffnesses of the case."""

    alpha_y: NumbersPart | None = Field(default=None, description="Range of `unity_ratio.alpha_y`.")
    alpha_z: NumbersPart | None = Field(default=None, description="Range of `unity_ratio.alpha_z`.")
    alpha_theta: NumbersPart | None = Field(default=None, description="Range of `unity_ratio.alpha_theta`.")
    aspect_ratio: NumbersPart | None = Field(default=None, description="Range of `unity_ratio.aspect_ratio`.")
    bearing_stiffness: FactorsPart | None = Field(
        default=None, description="Range of a factor of all bearing stiffnesses."
    )
    base_helix_angle: AnglesPart | None = Field(default=None, description="Range of the base helix angle.")
    kappa: NumbersPart | None = Field(default=None, description="Range of kappa; mu follows it if not specified.")
    mu: NumbersPart | None = Field(default=None, description="Range of mu.")
    mesh_stiffness: StiffnessesPart | None = Field(default=None, description="Range of the mesh stiffness K_M.")

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.ranges:
            raise refuse(
                "must have at least one parameter",
                'set base_helix_angle = { start = "0 deg", stop = "40 deg" }',
                value="(empty)",
            )
        return self

    @property
    def ranges(self) -> dict[str, NumbersPart | FactorsPart | AnglesPart | StiffnessesPart]:
        """What is given, by parameter."""
        return {key: getattr(self, key) for key in type(self).model_fields if getattr(self, key) is not None}


Row = Annotated[list[Number], Field(min_length=5, max_length=5)]
Matrix = Annotated[list[Row], Field(min_length=5, max_length=5)]


class MeshStiffnessPart(Part):
    """``mesh = { stiffness, kappa, mu, base_helix_angle }``, a load distribution over the face in a file, or a pair.

    ``mesh = { pair = "I" }`` takes all of it from the loaded flanks of a pair of the case with its width.
    """

    pair: str | None = Field(default=None, description="Pair whose loaded flanks define K_M, kappa and mu.")
    stiffness: PositiveStiffness | None = Field(
        default=None, description="Mesh stiffness K_M; alternatively `distribution` or `pair`."
    )
    kappa: Number = Field(
        default=0.0,
        description="kappa: axial distance from the centre of mass of the gear to the centre of the mesh stiffness, "
        "over half the face width.",
    )
    mu: Number | None = Field(
        default=None,
        description="mu: rotational stiffness about x over K_M times the square of half the face width, at least "
        "kappa^2. Default: uniform contact reaching one face end.",
    )
    base_helix_angle: Angle = Field(default=0.0, description="Base helix angle.")
    distribution: str | None = Field(
        default=None, description="CSV file with `z [mm]`, `load [N/mm]` and `deflection [um]` over the face."
    )
    face_width: PositiveLength | None = Field(default=None, description="Face width of `distribution`.")

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if self.pair is not None:
            for key in sorted(self.given - {"pair"}):
                raise refuse("is already defined by the pair", "remove it", key=key)
            return self
        if (self.stiffness is None) == (self.distribution is None):
            raise refuse(
                "is required, or a distribution over the face width, or a pair", "specify one", key="stiffness"
            )
        if self.distribution is not None and self.face_width is None:
            raise refuse("is required for the distribution", 'set face_width = "25 mm"', key="face_width")
        return self

    def build(self) -> MeshParameters:
        """Make the parameters from the numbers (a distribution is read by the stage, which knows the folder)."""
        from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters, partial_face_mu

        mu = partial_face_mu(self.kappa) if self.mu is None else self.mu
        return MeshParameters(self.stiffness or math.nan, self.kappa, mu, self.base_helix_angle)


class BearingPart(Part):
    """Bearing stiffness of one gear: the diagonal by name, or the whole matrix in SI over (y, z, three angles)."""

    y: StiffnessOrZero = Field(default=0.0, description="Stiffness along the transverse line of action.")
    z: StiffnessOrZero = Field(default=0.0, description="Axial stiffness.")
    theta_x: TorsionalStiffnessOrZero = Field(default=0.0, description="Tilting stiffness about x.")
    theta_y: TorsionalStiffnessOrZero = Field(default=0.0, description="Tilting stiffness about y.")
    matrix: Matrix | None = Field(
        default=None,
        description="Complete stiffness matrix for (y, z, theta_x, theta_y, theta_z) in SI, five rows of five numbers.",
    )

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if self.matrix is not None and self.given != {"matrix"}:
            raise refuse("contradicts the single stiffnesses", "specify only one", key="matrix")
        return self

    def build(self) -> NDArray[np.float64]:
        """Make the matrix [N/m, N/rad, N m/rad]."""
        if self.matrix is not None:
            return np.array(self.matrix)
        return np.diag([self.y, self.z, self.theta_x, self.theta_y, 0.0])


#: What a gear of the case knows of itself.
OF_THE_GEAR = ("mass", "inertia_x", "inertia_y", "inertia_z", "base_radius", "half_face_width")


class RigidGearPart(Part):
    """One gear: mass, inertia, size and bearing; where the mesh is a pair's, what is not given is that of its gear."""

    mass: PositiveMass | None = Field(default=None, description="Mass of the gear.")
    inertia_x: PositiveInertia | None = Field(default=None, description="Moment of inertia about x.")
    inertia_y: PositiveInertia | None = Field(default=None, description="Moment of inertia about y.")
    inertia_z: PositiveInertia | None = Field(default=None, description="Moment of inertia about the gear axis.")
    base_radius: PositiveLength | None = Field(default=None, description="Base radius.")
    half_face_width: PositiveLength | None = Field(default=None, description="Half the face width.")
    bearing: BearingPart = Field(default_factory=BearingPart, description="Stiffness of the bearing.")
    damping: Matrix | None = Field(
        default=None,
        description="Damping matrix for (y, z, theta_x, theta_y, theta_z) in SI, five rows of five numbers. Default: "
        "zero.",
    )

    def build(self) -> RigidGear:
        """Make the gear."""
        from fegear.dynamics.helical_pair.model import RigidGear

        damping = np.zeros((5, 5)) if self.damping is None else np.array(self.damping)
        mass, *inertia, radius, half = (getattr(self, key) for key in OF_THE_GEAR)
        return RigidGear(mass, (inertia[0], inertia[1], inertia[2]), radius, half, self.bearing.build(), damping)

    def filled(self, known: Mapping[str, float]) -> RigidGearPart:
        """The same with what was left out."""
        return self.model_copy(update={key: v for key, v in known.items() if getattr(self, key) is None})


class UnityRatioPart(Part):
    """The unity-ratio pair by its dimensionless numbers."""

    mass: PositiveMass = Field(description="Mass of either gear.")
    aspect_ratio: Annotated[Number, Field(gt=0.0)] = Field(description="Half face width over base radius.")
    alpha_y: NotNegative = Field(description="Bearing stiffness ratio along the transverse line of action.")
    alpha_z: NotNegative = Field(description="Bearing stiffness ratio along the axis.")
    alpha_theta: NotNegative = Field(description="Bearing stiffness ratio for tilting.")
    base_radius: PositiveLength | None = Field(
        default=None, description="Base radius, for moments in `pair-forced-response`."
    )


#: Parameters of the unity-ratio pair alone.
_OF_UNITY_RATIO = {"alpha_y", "alpha_z", "alpha_theta", "aspect_ratio"}


class TransmissibilityPart(Part):
    """One pair and the range of Lambda = frequency / sqrt(K_M/m_eq) to look at."""

    mesh: MeshStiffnessPart = Field(description="Mesh stiffness and its distribution over the face width.")
    driver: RigidGearPart | None = Field(
        default=None,
        description="Driver as a rigid gear on its bearing. Default with `mesh.pair`: values of its gear.",
    )
    driven: RigidGearPart | None = Field(
        default=None,
        description="Driven gear as a rigid gear on its bearing. Default with `mesh.pair`: values of its gear.",
    )
    unity_ratio: UnityRatioPart | None = Field(
        default=None,
        description="Identical gears (ratio 1) by dimensionless parameters, instead of `driver` and `driven`.",
    )
    damping_ratio: Annotated[Number, Field(ge=0.0)] = Field(
        default=0.0, description="Damping ratio of every flexible mode."
    )
    lambda_from: Annotated[Number, Field(ge=0.0)] = Field(
        default=0.01, description="Minimum frequency over sqrt(K_M/m_eq)."
    )
    lambda_to: Annotated[Number, Field(gt=0.0)] = Field(
        default=2.0, description="Maximum frequency over sqrt(K_M/m_eq)."
    )
    frequencies: Annotated[int, Field(ge=2, le=1_000_000)] = Field(
        default=400, description="Number of frequencies in the range; refined in figures where a curve bends."
    )
    follow: FollowPart | None = Field(default=None, description="Parameters for `mode-tracking`.")
    excitation: ExcitationPart | None = Field(
        default=None, description="Excitation of the pair, for `pair-forced-response`."
    )

    @model_validator(mode="after")
    def _one_model(self) -> Self:
        self._check_gears()
        general = self.driver is not None and self.driven is not None
        if self.mesh.pair is None and (
            general == (self.unity_ratio is not None) or (self.driver is None) != (self.driven is None)
        ):
            raise refuse("is not specified", "specify driver and driven, or unity_ratio", key="driver", value="(pair)")
        if self.lambda_to <= self.lambda_from:
            raise refuse("must be greater than lambda_from", key="lambda_to", value=self.lambda_to)
        if self.follow is not None and self.unity_ratio is None:
            for key in _OF_UNITY_RATIO & set(self.follow.ranges):
                raise refuse("requires unity_ratio", "use bearing_stiffness instead", key=f"follow.{key}")
        return self

    def _check_gears(self) -> None:
        if self.mesh.pair is not None:
            if self.unity_ratio is not None:
                raise refuse(
                    "contradicts mesh.pair, which defines the gears", "specify driver and driven, or remove it",
                    key="unity_ratio", value="(given)",
                )  # fmt: skip
            return
        for role, gear in (("driver", self.driver), ("driven", self.driven)):
            for key in OF_THE_GEAR if gear else ():
                if getattr(gear, key) is None:
                    raise refuse(
                        "is missing", 'specify it, or take the mesh from a pair: mesh = { pair = "I" }',
                        key=f"{role}.{key}", value="(not given)",
                    )  # fmt: skip

    def with_gears(self, driver: Mapping[str, float], driven: Mapping[str, float]) -> TransmissibilityPart:
        """The same with what the gears of the mesh's pair know of themselves."""
        first, second = (given or RigidGearPart() for given in (self.driver, self.driven))
        return self.model_copy(update={"driver": first.filled(driver), "driven": second.filled(driven)})

    def _both(self) -> tuple[RigidGearPart, RigidGearPart]:
        if self.driver is None or self.driven is None:
            raise InputError("driver", "(pair)", "is not specified", "specify driver and driven, or unity_ratio")
        return self.driver, self.driven

    def build(self, mesh: MeshParameters, prefix: str) -> HelicalPairModel | ReducedPairModel:
        """Make the model."""
        from fegear.dynamics.helical_pair.model import HelicalPairModel, ReducedPairModel

        try:
            if self.unity_ratio is not None:
                u = self.unity_ratio
                return ReducedPairModel.from_ratios(
                    mesh, mass=u.mass, aspect_ratio=u.aspect_ratio, alpha_y=u.alpha_y, alpha_z=u.alpha_z,
                    alpha_theta=u.alpha_theta, modal_damping=self.damping_ratio,
                )  # fmt: skip
            driver, driven = (gear.build() for gear in self._both())
            return HelicalPairModel(driver, driven, mesh, modal_damping=self.damping_ratio)
        except InputError as error:
            raise at(prefix, error) from None

    def build_both(self, mesh: MeshParameters, prefix: str) -> HelicalPairModel:
        """Make the model of both gears, in which every force on either has its place."""
        model = self.build(mesh, prefix)
        if self.unity_ratio is None:
            return model  # type: ignore[return-value]  # driver and driven make no other
        u = self.unity_ratio
        if u.base_radius is None:
            raise InputError(
                f"{prefix}.unity_ratio.base_radius", "(not given)", "is required for moments",
                'set base_radius = "70.48 mm"',
            )  # fmt: skip
        return model.both_gears(u.base_radius, u.aspect_ratio * u.base_radius)  # type: ignore[union-attr]  # as above
