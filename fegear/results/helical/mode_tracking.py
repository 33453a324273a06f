"""Stage ``mode-tracking``: modes of a helical pair and their indices over a parameter, and its response at values.

Figures of modes followed over a parameter, and of the response at values of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

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
from fegear.dynamics.train.resolved_response import broken
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, columns_of, repeated, stacked
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.results.helical.transmissibility import LAMBDA, ends, mesh_needs, own_mesh, resolved_response

Model = HelicalPairModel | ReducedPairModel


@dataclass(frozen=True, eq=False)
class Response:
    """Response at one value of the parameter [SI], at p points that show every peak and zero, and Lambda of poles."""

    value: float
    undamped: Array
    ratio: Array = shown("", "frequency over sqrt(K_M/m_eq)", name="Lambda", table="response")
    dynamic: Array = shown(
        "", "G - a_M over K_M, amplitude", name="G_minus_a_theta_z_y_abs", label="|G − a_{M}|_{θz,y} / K_{M}",
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
    from fegear.results.helical.transmissibility import mesh_forces

    found, undamped = resolved_response(model, asked.part.lambda_from, asked.part.lambda_to)
    R = np.abs(next(iter(mesh_forces(found).values())))
    dynamic = np.abs(found.G_minus_a[:, 4, 0]) / model.mesh.stiffness
    return Response(value, undamped, found.ratio, dynamic, R[:, 0, 0], R[:, 4, 4])


def _present(data: tuple[FollowedData, ...], asked: HelicalPairInputs) -> Outcome:
    tables, figures, remarks = [], [], []
    for one in data:
        tables.append(_table(asked.name, one))
        figures.append(modes_figure(asked.name, one))
        remarks += _remarks(asked.name, one)
        if one.responses:
            tables.append(_response_table(asked.name, one))
            figures.append(response_figure(asked.name, one))
    least = min((one.modes.likeness for one in data), default=1.0)
    settings: dict[str, object] = {"least_likeness": least, "damping_ratio": asked.part.damping_ratio}
    return Outcome(data, tuple(tables), (), settings, tuple(remarks), tuple(figures))


def _table(name: str, one: FollowedData) -> Table:
    columns = [
        Column(one.parameter, one.modes.values, PARAMETERS[one.parameter][1], "over which the modes are followed")
    ]
    for r in range(one.modes.ratio.shape[1]):
        columns.append(Column(f"Lambda_{r + 1}", one.modes.ratio[:, r], "", "frequency over sqrt(K_M/m_eq)"))
        columns.append(Column(f"frequency_{r + 1}", one.frequency[:, r] / (2.0 * math.pi), "Hz", "natural frequency"))
        columns += [Column(f"{key}_{r + 1}", one.indices[index][:, r], "", "modal index") for index, key, _ in INDICES]
    return Table(
        f"modes_over_{one.parameter}_{name}", tuple(columns),
        f"Modes of pair {name} over {one.parameter}, numbered as in the case itself",
    )  # fmt: skip


def _response_table(name: str, one: FollowedData) -> Table:
    value = Column(
        one.parameter, np.array([row.value for row in one.responses]), PARAMETERS[one.parameter][1],
        "value of the parameter",
    )  # fmt: skip
    return Table(
        f"response_over_{one.parameter}_{name}",
        (
            *repeated([value], [row.ratio.size for row in one.responses]),
            *stacked([columns_of(row, table="response") for row in one.responses]),
        ),
        f"Response of pair {name} at values of {one.parameter}",
    )


def _remarks(name: str, one: FollowedData) -> list[str]:
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
            f"transmissibility.{name}.follow", "(not given)", "is missing, but mode-tracking needs it",
            'write follow.base_helix_angle = { start = "0 deg", stop = "40 deg" }',
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
    "bearing_stiffness": ("bearing stiffness over that of the case", ""),
    "base_helix_angle": ("base helix angle ψ_{b}", "deg"),
    "kappa": ("mesh coupling κ", ""),
    "mu": ("rotary mesh stiffness μ", ""),
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


def modes_figure(name: str, one: FollowedData) -> Figure:
    """Frequencies and indices of the branches."""
    label, unit = PARAMETERS[one.parameter]
    x = one.modes.values * UNITS[unit]
    steps = np.diff(x)
    log = bool(x[0] > 0.0 and np.ptp(steps) > _EVEN * steps.max())
    axis = Axis(label, unit, log=log, limits=(float(x[0]), float(x[-1])))
    present = np.flatnonzero(one.modes.ratio.max(axis=0) > 0.0)

    def panel(title: str, rows: Array) -> Panel:
        return Panel(axis, Axis(title, zero=True), tuple(
            Curve(x, rows[:, r], f"mode {r + 1}", f"series:{k}", markers=False, width=3.0 - 0.3 * min(k, 5))
            for k, r in enumerate(present)
        ))  # fmt: skip

    panels = [panel("Λ_{r}", one.modes.ratio)]
    panels += [panel(title, one.indices[key]) for key, _, title in INDICES if one.indices[key].max() > _NONE]
    return Figure(
        f"modes_over_{one.parameter}_{name}",
        f"Modes of pair {name} over the {label}",
        f"Pair {name}: modes followed by the continuity of their shapes, numbered by falling frequency in the case "
        "itself. Crossings are passed straight; at veerings the shapes are exchanged. Mesh displacements along the "
        "tooth normal and about x are over the largest; the coupling ratio is |U_ηθx| / (U_η + U_θx).",
        tuple(panels), columns=2 if len(panels) > 1 else 1,
    )  # fmt: skip


def response_figure(name: str, one: FollowedData) -> Figure:
    """The conventional responses at values of the parameter."""
    label, unit = PARAMETERS[one.parameter]
    symbol = label.rsplit(" ", 1)[-1] if one.parameter != "bearing_stiffness" else "bearing stiffness"
    panels = []
    for key in ("dynamic", "line_of_action", "torsion"):
        curves = []
        for k, row in enumerate(one.responses):
            x, y = broken(row.ratio, getattr(row, key), row.undamped)
            value = f"{symbol} = {row.value * UNITS[unit]:.6g} {unit}".rstrip()
            curves.append(Curve(x, np.where(y > 0.0, y, np.nan), value, f"series:{k}", markers=False))
        poles = any(row.undamped.size for row in one.responses)
        limits = ends([getattr(row, key) for row in one.responses]) if poles else None
        panels.append(Panel(LAMBDA, axis_of(Response, key, log=True, limits=limits), tuple(curves)))
    return Figure(
        f"response_over_{one.parameter}_{name}",
        f"Conventional frequency response of pair {name} by {label}",
        f"Pair {name}: torsional response to a transmission error along the line of action, and the mesh force "
        "transmissibility along the line of action and in torsion.",
        tuple(panels),
    )


MODE_TRACKING = Stage(
    subjects=_pairs,
    needs=mesh_needs,
    inputs=helical_pair_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(Citation("blankenship-singh", "modes and indices over bearing and mesh parameters", "Section 5")),
    forecast=_forecast,
)
