"""Stage ``transmissibility``: modes and force transmissibility of helical pairs."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.csv_columns import read_columns
from fegear.case.part import at
from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Bars, Curve, Figure, Panel
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.case.transmissibility import MeshStiffnessPart
    from fegear.dynamics.helical_pair import HelicalPairModel, ReducedPairModel
    from fegear.dynamics.mesh_parameters import MeshParameters
    from fegear.dynamics.modal_indices import ModeTable, RankedMode
    from fegear.dynamics.transmissibility import ReducedTransmissibility, Transmissibility
    from fegear.engine.stage import Upstream, Work

#: Components of the mesh force in figures; smaller ones than this are none.
_COMPONENTS = ("y", "z", "θ_{x}", "θ_{y}", "θ_{z}")
_ROUND_OFF, _TINY = 1e-9, 1e-12
#: Columns of a load distribution file.
_DISTRIBUTION = {"z": "length", "load": "line_load", "deflection": "length"}
_HEADS = ("z [mm]", "load [N/mm]", "deflection [um]")


@dataclass(frozen=True, slots=True)
class TransmissibilityData:
    """Modes, ranking and frequency response."""

    mesh: MeshParameters
    modes: ModeTable
    ranking: list[RankedMode]
    response: Transmissibility | ReducedTransmissibility


def _read_distribution(path: Path, key: str) -> list[NDArray[np.float64]]:
    columns = read_columns(path, key, _DISTRIBUTION)
    for name, head in zip(_DISTRIBUTION, _HEADS, strict=True):
        if name not in columns:
            raise InputError(key, f'"{path.name}"', f"has no column {head}", f"heads are {', '.join(_HEADS)}")
    return [columns[name] for name in _DISTRIBUTION]


def _mesh(scene: Scene, name: str, part: MeshStiffnessPart) -> MeshParameters:
    from fegear.dynamics.mesh_parameters import mesh_parameters

    prefix = f"transmissibility.{name}.mesh"
    try:
        if part.distribution is None:
            return part.build()
        key = f"{prefix}.distribution"
        z, load, deflection = _read_distribution(scene.file(part.distribution, key), key)
        return mesh_parameters(
            z, load, deflection, face_width=part.face_width or math.nan, base_helix_angle=part.base_helix_angle
        )
    except InputError as error:
        raise at("", error) if error.key.startswith(prefix) else at(prefix, error) from None


def _mode_table(name: str, modes: ModeTable, ranking: list[RankedMode]) -> Table:
    def ranked(excitation: str, field: str) -> NDArray[np.float64]:
        rows = sorted((row for row in ranking if row.excitation == excitation), key=lambda row: row.mode)
        return np.array([getattr(row, field) for row in rows])

    count = modes.ratio.size
    return Table(
        f"helical_modes_{name}",
        (
            Column("mode", np.arange(1, count + 1), "", "by falling frequency"),
            Column("Lambda", modes.ratio, "", "frequency over sqrt(K_M/m_eq); 0 for rigid-body motion"),
            Column("frequency", modes.frequency / (2.0 * math.pi), "Hz", "natural frequency"),
            Column("Delta_normal", modes.normal, "", "relative mesh displacement along the tooth normal"),
            Column("Delta_bending", modes.bending, "", "relative mesh rotation about x"),
            Column("coupling", modes.coupling, "", "coupling strain energy over the sum of the two"),
            Column("rank_normal", ranked("normal", "rank"), "", "rank for normal transmission error and forces"),
            Column("weight_normal", ranked("normal", "weight"), "", "modal mesh force over the largest"),
            Column("rank_bending", ranked("bending", "rank"), "", "rank for bending error and moments"),
            Column("weight_bending", ranked("bending", "weight"), "", "modal mesh moment over the largest"),
        ),
        f"Modes of pair {name}",
    )


def _response_table(name: str, response: Transmissibility | ReducedTransmissibility) -> Table:
    from fegear.dynamics.helical_pair import COORDINATES
    from fegear.dynamics.transmissibility import Transmissibility

    if isinstance(response, Transmissibility):
        matrices = {"G": response.G, "R_ii": response.R_ii, "R_ij": response.R_ij}
    else:
        matrices = {"G": response.G, "R": response.R}
    columns = [
        Column("Lambda", response.ratio, "", "frequency over sqrt(K_M/m_eq)"),
        Column("frequency", response.frequency / (2.0 * math.pi), "Hz", "frequency"),
    ]
    for label, matrix in matrices.items():
        unit, meaning = ("N/um", "spectral mesh stiffness") if label == "G" else ("", "mesh force transmissibility")
        for i, row in enumerate(COORDINATES):
            for j, column in enumerate(COORDINATES):
                for part, values in (("re", matrix[:, i, j].real), ("im", matrix[:, i, j].imag)):
                    columns.append(Column(f"{label}_{row}_{column}_{part}", values, unit, meaning))
    return Table(f"transmissibility_{name}", tuple(columns), f"Force transmissibility of pair {name}")


@dataclass(frozen=True, slots=True)
class TransmissibilityInputs:
    """What modes and transmissibility of a pair depend on.

    Parameters
    ----------
    model : HelicalPairModel or ReducedPairModel
    mesh : MeshParameters
    ratios : ndarray, shape (F,)
        Frequencies over sqrt(K_M/m_eq).
    damping_ratio : float
    name : str
        Of the pair.
    """

    model: HelicalPairModel | ReducedPairModel
    mesh: MeshParameters
    ratios: NDArray[np.float64]
    damping_ratio: float
    name: str = field(compare=False)


def _inputs(scene: Scene, name: str) -> TransmissibilityInputs:
    part = scene.case.transmissibility[name]
    mesh = _mesh(scene, name, part.mesh)
    model = part.build(mesh, f"transmissibility.{name}")
    ratios = np.linspace(part.lambda_from, part.lambda_to, part.frequencies)
    return TransmissibilityInputs(model, mesh, ratios, part.damping_ratio, name)


def _compute(asked: TransmissibilityInputs, _upstream: Upstream, _work: Work) -> TransmissibilityData:
    from fegear.dynamics.helical_pair import HelicalPairModel
    from fegear.dynamics.modal_indices import mode_table, rank_modes
    from fegear.dynamics.transmissibility import reduced_transmissibility, transmissibility

    model = asked.model
    frequency = model.natural_frequency * asked.ratios
    response: Transmissibility | ReducedTransmissibility
    try:
        if isinstance(model, HelicalPairModel):
            response = transmissibility(model, frequency)
        else:
            response = reduced_transmissibility(model, frequency)
    except InputError as error:
        raise at(f"transmissibility.{asked.name}", error) from None
    return TransmissibilityData(asked.mesh, mode_table(model), rank_modes(model), response)


def _present(data: TransmissibilityData, asked: TransmissibilityInputs) -> Outcome:
    name, mesh = asked.name, data.mesh
    omega = asked.model.natural_frequency / (2.0 * math.pi)
    values = (
        Value(f"{name}.omega", omega, "Hz", 0.0, "sqrt(K_M/m_eq)"),
        Value(f"{name}.mesh_stiffness", mesh.stiffness, "N/um", 0.0, "K_M"),
        Value(f"{name}.kappa", mesh.kappa, "", 0.0, "axial centre of the mesh stiffness over half the face"),
        Value(f"{name}.mu", mesh.mu, "", 0.0, "rotary mesh stiffness"),
    )
    tables = (_mode_table(name, data.modes, data.ranking), _response_table(name, data.response))
    settings = {"damping_ratio": asked.damping_ratio, "frequencies": asked.ratios.size}
    remarks = tuple(f"Pair {name}: {remark}." for remark in data.modes.remarks)
    return Outcome(data, tables, values, settings, remarks, _figures(name, data))


def _figures(name: str, data: TransmissibilityData) -> tuple[Figure, ...]:
    modes = data.modes
    shown = np.flatnonzero(modes.ratio > 0.0)
    place = np.arange(shown.size)
    named = tuple(f"{r + 1}\n{modes.ratio[r]:.4g}" for r in shown)
    indices = (
        ("normal, Δ_{η}", modes.normal),
        ("bending, Δ_{θx}", modes.bending),
        ("coupling energy ratio", modes.coupling),
    )
    bars = tuple(Bars(place, values[shown], label, f"series:{k}") for k, (label, values) in enumerate(indices))
    return (
        Figure(
            f"helical_modes_{name}",
            f"Modal indices of pair {name}",
            f"Pair {name}: which modes a transmission error along the tooth normal or a bending one excites.",
            (Panel(Axis("mode and its Λ_{r}", categories=named), Axis("modal index"), bars),),
        ),
        _response_figure(name, data),
    )


def _response_figure(name: str, data: TransmissibilityData) -> Figure:
    """Size of G over K_M and of R for transmission errors and forces along y, by component."""
    response = data.response
    external = np.asarray(getattr(response, "R", None) if hasattr(response, "R") else response.R_ii)
    panels = []
    for values, label in (
        (response.G / data.mesh.stiffness, "|G_{iy}| / K_{M}, per transmission error"),
        (external, "|R_{iy}|, per external force"),
    ):
        curves = []
        for i, component in enumerate(_COMPONENTS):
            size = np.abs(values[:, i, 0])
            if size.max() > _ROUND_OFF:
                curve = np.where(size > _TINY, size, np.nan)
                curves.append(
                    Curve(response.ratio, curve, component, f"series:{i}", width=3.4 - 0.5 * i, markers=False)
                )
        panels.append(Panel(Axis("Λ = ω / √(K_{M}/m_{eq})"), Axis(label, log=True), tuple(curves)))
    return Figure(
        f"transmissibility_{name}",
        f"Force transmissibility of pair {name}",
        f"Pair {name}: spectral mesh stiffness and mesh force transmissibility for a transmission error and an "
        "external force along the plane of action; components over q = (y, z, b theta_x, a theta_y, a theta_z).",
        tuple(panels),
    )


def _forecast(scene: Scene, name: str) -> Forecast:
    """One response for each frequency."""
    count = scene.case.transmissibility[name].frequencies
    return Forecast({"frequencies": count}, 0.005 + 1e-5 * count)


TRANSMISSIBILITY = Stage(
    name="transmissibility",
    title="Force transmissibility",
    results=("transmissibility",),
    about="forces that a helical pair passes from its mesh to its bearings, over frequency",
    subjects=lambda scene: tuple(scene.case.transmissibility),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    cites=citing(
        Citation("blankenship-singh", "stiffness, transmissibility and modal indices", "Eqs. 2 to 30 and 37 to 39")
    ),
    forecast=_forecast,
)
