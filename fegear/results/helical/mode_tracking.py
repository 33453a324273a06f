"""Stage ``mode-tracking``: modes of a helical pair and their indices over a parameter, and its response at values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.case.built.helical_pair import HelicalPairInputs, helical_pair_inputs, model_at, own_value
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.case.transmissibility import TransmissibilityPart
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters
from fegear.dynamics.helical_pair.mode_following import FollowedModes, Meeting
from fegear.dynamics.helical_pair.model import HelicalPairModel, ReducedPairModel
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results.helical.drawn_curves import DrawnCurve, DrawnPanel, drawn_panels, ends
from fegear.results.helical.transmissibility import mesh_needs, own_mesh, resolved_response
from fegear.results.helical.transmissibility_shown import LAMBDA, mesh_forces

Model = HelicalPairModel | ReducedPairModel


@dataclass(frozen=True, eq=False)
class Response:
    """Response at one value of the parameter [SI], at p points that show every peak and zero, and Lambda of poles."""

    value: float
    undamped: Array
    ratio: Array = shown("", "frequency / sqrt(K_M/m_eq)", name="Lambda", table="response")
    dynamic: Array = shown(
        "", "amplitude of (G - a_M) / K_M", name="G_minus_a_theta_z_y_abs", label="|G − a_{M}|_{θz,y} / K_{M}",
        table="response",
    )  # fmt: skip
    line_of_action: Array = shown(
        "", "mesh force transmissibility, amplitude", name="R_y_y_abs", label="|R_{y,y}|", table="response"
    )
    torsion: Array = shown(
        "", "mesh force transmissibility, amplitude", name="R_theta_z_theta_z_abs", label="|R_{θz,θz}|",
        table="response",
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class FollowedData:
    """Modes over one parameter.

    Parameters
    ----------
    parameter : str
    modes : FollowedModes
    frequency : ndarray, shape (m, n)
        [rad/s].
    indices : dict of str to ndarray, shape (m, n)
        Delta_normal, Delta_bending and the coupling ratio of each branch.
    responses : tuple of Response
    """

    parameter: str
    modes: FollowedModes
    frequency: Array
    indices: dict[str, Array]
    responses: tuple[Response, ...]


@dataclass(frozen=True, slots=True)
class FollowedPair:
    """The pair with its mesh."""

    part: TransmissibilityPart
    mesh: MeshParameters
    name: str


def _compute(inputs: HelicalPairInputs, upstream: Upstream, work: Work) -> tuple[FollowedData, ...]:
    asked = FollowedPair(inputs.part, own_mesh(inputs, upstream)[0], inputs.name)
    follow = asked.part.follow
    ranges = follow.ranges if follow else {}
    found = []
    for number, (parameter, part) in enumerate(ranges.items()):
        found.append(_over(asked, parameter, part.array, part.responses))
        work.progress((number + 1) / len(ranges))
    return tuple(found)


def _over(asked: FollowedPair, parameter: str, values: NDArray[np.float64], responses: list[float]) -> FollowedData:
    from fegear.dynamics.helical_pair.mode_following import follow_modes

    def build(value: float) -> Model:
        return model_at(asked.part, asked.mesh, asked.name, parameter, value)

    modes = follow_modes(build, values, start=own_value(asked.part, asked.mesh, parameter))
    models = [build(float(value)) for value in values]
    scale = np.array([model.natural_frequency for model in models])
    rows = [_indices(*row) for row in zip(models, modes.ratio, modes.shapes, strict=True)]
    indices = {key: np.array([row[key] for row in rows]) for key, _, _ in INDICES}
    try:
        drawn = tuple(_response(asked, build(value), value) for value in responses)
    except InputError as error:
        raise at(f"transmissibility.{asked.name}", error) from None
    return FollowedData(parameter, modes, modes.ratio * scale[:, None], indices, drawn)


def _indices(model: Model, ratio: Array, shapes: Array) -> dict[str, Array]:
    from fegear.dynamics.helical_pair.modal_indices import coupling, mesh_displacements, over_largest

    eta, theta = mesh_displacements(model, ratio, shapes / np.linalg.norm(shapes, axis=0))
    return {"normal": over_largest(eta), "bending": over_largest(theta), "coupling": coupling(model, eta, theta)}


def _response(asked: FollowedPair, model: Model, value: float) -> Response:
    found, undamped = resolved_response(model, asked.part.lambda_from, asked.part.lambda_to)
    R = np.abs(next(iter(mesh_forces(found).values())))
    dynamic = np.abs(found.G_minus_a[:, 4, 0]) / model.mesh.stiffness
    return Response(value, undamped, found.ratio, dynamic, R[:, 0, 0], R[:, 4, 4])


def _remarks(seen: Seen) -> list[str]:
    """Where branches cross or veer."""
    name, one = seen.name, seen.one.data
    unit = PARAMETERS[one.parameter][1]

    def told(meeting: Meeting) -> str:
        place = f"{one.parameter} = {meeting.value * UNITS[unit]:.5g} {unit}".rstrip()
        gap = f" (Lambda {meeting.gap:.2g} apart)" if meeting.gap else ""
        return f"modes {meeting.first + 1} and {meeting.second + 1} at {place}{gap}"

    return [
        f"Pair {name}: {word} {'; '.join(told(meeting) for meeting in meetings)}."
        for word, meetings in (("crossings of", one.modes.crossings), ("veerings of", one.modes.veerings))
        if meetings
    ]


def _pairs(scene: Scene) -> tuple[str, ...]:
    names = tuple(scene.case.transmissibility)
    found = tuple(name for name in names if scene.case.transmissibility[name].follow is not None)
    return found or names[:1]  # which is refused with the remedy


def _check(scene: Scene, name: str) -> None:
    if scene.case.transmissibility[name].follow is None:
        raise InputError(
            f"transmissibility.{name}.follow", "(not given)", "is required for mode-tracking",
            'set follow.base_helix_angle = { start = "0 deg", stop = "40 deg" }',
        )  # fmt: skip


def _forecast(scene: Scene, name: str) -> Forecast:
    """Modes for each value, and each response."""
    follow = scene.case.transmissibility[name].follow
    ranges = follow.ranges.values() if follow else ()
    count = sum(part.count for part in ranges)
    return Forecast({"values": count}, 0.1 + 1e-3 * count + 0.05 * sum(len(part.responses) for part in ranges))


#: What a parameter is called in figures, and its unit in tables.
PARAMETERS = {
    "alpha_y": ("radial bearing stiffness ratio α_{y}", ""),
    "alpha_z": ("axial bearing stiffness ratio α_{z}", ""),
    "alpha_theta": ("bending bearing stiffness ratio α_{θ}", ""),
    "aspect_ratio": ("aspect ratio ν", ""),
    "bearing_stiffness": ("bearing stiffness relative to the case", ""),
    "base_helix_angle": ("base helix angle ψ_{b}", "deg"),
    "kappa": ("mesh coupling κ", ""),
    "mu": ("rotational mesh stiffness μ", ""),
    "mesh_stiffness": ("mesh stiffness K_{M}", "N/um"),
}


#: SI to these units.
UNITS = {"deg": 180.0 / math.pi, "N/um": 1e-6, "": 1.0}


#: Indices with their names in tables and figures.
INDICES = (
    ("normal", "Delta_normal", "Δ_{η}"),
    ("bending", "Delta_bending", "Δ_{θx}"),
    ("coupling", "coupling", "coupling ratio"),
)


_NONE = 1e-9


#: Steps of an even range differ by less than this share.
_EVEN = 1e-6


@dataclass(frozen=True)
class ParameterValue:
    """Values of a parameter, of one of three units."""

    plain: Array | float | None = shown("", "value of the parameter")
    angle: Array | float | None = shown("deg", "value of the parameter")
    stiffness: Array | float | None = shown("N/um", "value of the parameter")

    @classmethod
    def of(cls, parameter: str, values: Array | float) -> ParameterValue:
        """In the unit of a parameter."""
        unit = PARAMETERS[parameter][1]
        return cls(*(values if unit == own else None for own in ("", "deg", "N/um")))


@dataclass(frozen=True)
class Branch:
    """One mode over the parameter."""

    number: int
    ratio: Array = shown("", "frequency / sqrt(K_M/m_eq)", name="Lambda")
    frequency: Array = shown("Hz", "natural frequency")
    normal: Array = shown("", "modal index", name="Delta_normal")
    bending: Array = shown("", "modal index", name="Delta_bending")
    coupling: Array = shown("", "modal index")


@dataclass(frozen=True)
class ResponseAt:
    """Response at one value of the parameter."""

    parameter: str
    value: ParameterValue
    response: Response


@dataclass(frozen=True)
class Followed:
    """Modes over one parameter, and the response at values of it, as they are shown."""

    data: FollowedData

    @property
    def parameter(self) -> str:
        """Key in the case."""
        return self.data.parameter

    @property
    def label(self) -> str:
        """In words."""
        return PARAMETERS[self.parameter][0]

    @property
    def _scale(self) -> float:
        return UNITS[PARAMETERS[self.parameter][1]]

    @property
    def values(self) -> ParameterValue:
        """Over which the modes are followed."""
        return ParameterValue.of(self.parameter, self.data.modes.values)

    @property
    def branches(self) -> list[Branch]:
        """Every mode."""
        one = self.data
        return [
            Branch(
                r + 1, one.modes.ratio[:, r], one.frequency[:, r] / (2.0 * math.pi),
                *(one.indices[key][:, r] for key, _, _ in INDICES),
            )
            for r in range(one.modes.ratio.shape[1])
        ]  # fmt: skip

    @property
    def responses(self) -> list[ResponseAt]:
        """At values of the parameter."""
        return [
            ResponseAt(self.parameter, ParameterValue.of(self.parameter, row.value), row) for row in self.data.responses
        ]

    @cached_property
    def mode_panels(self) -> list[DrawnPanel]:
        """Frequencies and indices of the branches."""
        one, x = self.data, self.data.modes.values * self._scale
        steps = np.diff(x)
        log = bool(x[0] > 0.0 and np.ptp(steps) > _EVEN * steps.max())
        axis = Axis(self.label, PARAMETERS[self.parameter][1], log=log, limits=(float(x[0]), float(x[-1])))
        present = np.flatnonzero(one.modes.ratio.max(axis=0) > 0.0)
        rows = [("Λ_{r}", one.modes.ratio)]
        rows += [(title, one.indices[key]) for key, _, title in INDICES if one.indices[key].max() > _NONE]
        return [
            DrawnPanel(
                axis, Axis(title, zero=True),
                [DrawnCurve(f"mode {r + 1}", f"series:{k}", x, row[:, r], 3.0 - 0.3 * min(k, 5))
                 for k, r in enumerate(present)],
            )
            for title, row in rows
        ]  # fmt: skip

    @property
    def columns(self) -> int:
        """Of the figure."""
        return 2 if len(self.mode_panels) > 1 else 1

    @property
    def response_panels(self) -> list[DrawnPanel]:
        """The conventional responses at values of the parameter."""
        unit, found = PARAMETERS[self.parameter][1], self.data.responses
        symbol = self.label.rsplit(" ", 1)[-1] if self.parameter != "bearing_stiffness" else "bearing stiffness"
        names = [f"{symbol} = {row.value * self._scale:.6g} {unit}".rstrip() for row in found]
        poles = any(row.undamped.size for row in found)
        return [
            DrawnPanel(
                LAMBDA,
                axis_of(Response, key, log=True, limits=ends([getattr(row, key) for row in found]) if poles else None),
                [DrawnCurve.on_log(name, f"series:{k}", row.ratio, getattr(row, key), row.undamped)
                 for k, (name, row) in enumerate(zip(names, found, strict=True))],
            )
            for key in ("dynamic", "line_of_action", "torsion")
        ]  # fmt: skip


@dataclass(frozen=True)
class AllFollowed:
    """Every parameter that modes are followed over."""

    each: tuple[Followed, ...]

    @property
    def least_likeness(self) -> float:
        """Least modal assurance between neighbouring steps."""
        return min((one.data.modes.likeness for one in self.each), default=1.0)


def _values(owner: str, meaning: str) -> tuple[Cell, ...]:
    """The parameter in its unit."""
    return tuple(
        Cell(f"{owner}.{unit}", name="{one.parameter}", meaning=meaning) for unit in ("plain", "angle", "stiffness")
    )


_SHEET = Sheet(
    of=lambda data, _asked: AllFollowed(tuple(Followed(one) for one in data)),
    tables=(
        Each(
            "each",
            Rows(
                "modes_over_{one.parameter}_{name}",
                "Modes of pair {name} over {one.parameter}, numbered as in the case itself",
                (
                    *_values("values", "parameter value"),
                    Each(
                        "branches",
                        *(Cell(key, name=f"{name}_{{one.number}}")
                          for key, name in (("ratio", "Lambda"), ("frequency", "frequency"),
                                            *((key, name) for key, name, _ in INDICES))),
                    ),
                ),
            ),
            Rows(
                "response_over_{one.parameter}_{name}", "Response of pair {name} for values of {one.parameter}",
                (
                    *_values("value", "value of the parameter"),
                    *(f"response.{key}" for key in ("ratio", "dynamic", "line_of_action", "torsion")),
                ),
                stacked="responses", when="responses",
            ),
        ),
    ),
    figures=(
        Each(
            "each",
            Chart(
                "modes_over_{one.parameter}_{name}", "Modes of pair {name} over the {one.label}",
                "Pair {name}: modes followed by the continuity of their shapes, numbered by falling frequency in the "
                "case itself. Modes are tracked through crossings; mode shapes interchange at veerings. Mesh "
                "displacements along the tooth normal and about x are over the largest; the coupling ratio is "
                "|U_ηθx| / (U_η + U_θx).",
                (drawn_panels("mode_panels"),), columns="columns",
            ),
            Chart(
                "response_over_{one.parameter}_{name}",
                "Conventional frequency response of pair {name} by {one.label}",
                "Pair {name}: torsional response to a transmission error along the line of action, and the mesh force "
                "transmissibility along the line of action and in torsion.",
                (drawn_panels("response_panels"),), when="responses",
            ),
        ),
    ),
    remarks=(Each("each", _remarks),),
    settings={
        "least_likeness": "least_likeness",
        "damping_ratio": lambda seen: seen.asked.part.damping_ratio,
    },
)  # fmt: skip


def _inputs(scene: Scene, name: str) -> HelicalPairInputs:
    """What a case says of a pair, with its ranges: other results leave them be."""
    found = helical_pair_inputs(scene, name)
    found.refuse_unbuilt_ranges()
    return found


MODE_TRACKING = Stage(
    subjects=_pairs,
    needs=mesh_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(Citation("blankenship-singh", "modes and indices over bearing and mesh parameters", "Section 5")),
    forecast=_forecast,
)
