"""Stage ``transmissibility``: modes and force transmissibility of helical pairs.

Figures of a helical pair's frequency response: every entry of the mesh force transmissibility, and the indices.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Complex
from fegear.base.errors import InputError
from fegear.case.built.helical_pair import HelicalPairInputs, full_matrix_frequencies, helical_pair_inputs, mesh_of_pair
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters
from fegear.dynamics.helical_pair.modal_indices import ModeTable, RankedMode
from fegear.dynamics.helical_pair.model import COORDINATES, HelicalPairModel, ReducedPairModel
from fegear.dynamics.helical_pair.transmissibility import ReducedTransmissibility, Transmissibility
from fegear.dynamics.train.resolved_response import broken
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.helical.mode_shapes import mode_shape_figures
from fegear.results.pair.mesh_stiffness_data import MeshStiffnessData
from fegear.results.pair.mesh_stiffness_matrix import mesh_stiffness_of, needs_mesh_stiffness

Response = Transmissibility | ReducedTransmissibility
Entry = tuple[str, Array]


#: Even points from which a drawn response starts; it is refined wherever it bends.
_DRAWN = 241


@dataclass(frozen=True, slots=True)
class TransmissibilityData:
    """Modes, ranking and frequency response.

    Parameters
    ----------
    mesh : MeshParameters
    modes : ModeTable
    ranking : list of RankedMode
    response : Transmissibility or ReducedTransmissibility
        At the frequencies of the case.
    drawn : Transmissibility or ReducedTransmissibility
        At frequencies that show every peak and every zero.
    undamped : ndarray
        Lambda of the poles among them.
    model : HelicalPairModel or ReducedPairModel
    mesh_error : ndarray, shape (3,)
        Estimated errors of K_M [N/m], kappa and mu; zero where the case gives them.
    full : ndarray
        Natural frequencies [rad/s] with the whole mesh stiffness matrix, each gear tilting about its own axis; empty
        where the mesh is not a pair's.
    """

    mesh: MeshParameters
    modes: ModeTable
    ranking: list[RankedMode]
    response: Transmissibility | ReducedTransmissibility
    drawn: Transmissibility | ReducedTransmissibility
    undamped: NDArray[np.float64]
    model: HelicalPairModel | ReducedPairModel
    mesh_error: NDArray[np.float64]
    full: NDArray[np.float64]


def _mode_table(name: str, modes: ModeTable, ranking: list[RankedMode], full: NDArray[np.float64]) -> Table:
    def ranked(excitation: str, field: str) -> NDArray[np.float64]:
        rows = sorted((row for row in ranking if row.excitation == excitation), key=lambda row: row.mode)
        return np.array([getattr(row, field) for row in rows])

    count = modes.ratio.size
    what = "with the whole mesh stiffness matrix, each gear tilting about its own axis"
    whole = (Column("frequency_full_matrix", full / (2.0 * math.pi), "Hz", what),) if full.size else ()
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
            *whole,
        ),
        f"Modes of pair {name}",
    )


def _shapes_table(name: str, modes: ModeTable) -> Table:
    """Mode shape vectors over q, of unit Euclidean norm."""
    from fegear.dynamics.helical_pair.model import COORDINATES

    both = modes.shapes.shape[0] > len(COORDINATES)
    what = "motion over q, unit norm" if both else "q_i + P q_j, unit norm: each gear moves half, the driven mirrored"
    names = [f"{LENGTHS[c]}{gear}" for gear in (("_driver", "_driven") if both else ("",)) for c in COORDINATES]
    count = modes.ratio.size
    return Table(
        f"mode_shapes_{name}",
        (
            Column("mode", np.arange(1, count + 1), "", "by falling frequency"),
            Column("Lambda", modes.ratio, "", "frequency over sqrt(K_M/m_eq); 0 for rigid-body motion"),
            *(Column(head, row, "", what) for head, row in zip(names, modes.shapes, strict=True)),
        ),
        f"Mode shapes of pair {name}",
    )


def _response_table(name: str, response: Transmissibility | ReducedTransmissibility) -> Table:
    from fegear.dynamics.helical_pair.model import COORDINATES
    from fegear.dynamics.helical_pair.transmissibility import Transmissibility

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
    columns += [
        Column(f"G_minus_a_{row}_{column}_abs", np.abs(response.G_minus_a[:, i, j]), "N/um", "amplitude of G - a_M")
        for i, row in enumerate(COORDINATES)
        for j, column in enumerate(COORDINATES)
    ]
    return Table(f"transmissibility_{name}", tuple(columns), f"Force transmissibility of pair {name}")


@dataclass(frozen=True, slots=True)
class TransmissibilityInputs:
    """What modes and transmissibility of a pair depend on.

    Parameters
    ----------
    pair : HelicalPairInputs
    ratios : ndarray, shape (F,)
        Frequencies over sqrt(K_M/m_eq).
    name : str
        Of the pair.
    """

    pair: HelicalPairInputs
    ratios: NDArray[np.float64]
    name: str = field(compare=False)


def _inputs(scene: Scene, name: str) -> TransmissibilityInputs:
    part = scene.case.transmissibility[name]
    ratios = np.linspace(part.lambda_from, part.lambda_to, part.frequencies)
    return TransmissibilityInputs(helical_pair_inputs(scene, name), ratios, name)


def mesh_needs(scene: Scene, name: str) -> tuple[Task, ...]:
    """The mesh of the pair that ``[transmissibility.NAME]`` takes its mesh from."""
    pair = scene.case.transmissibility[name].mesh.pair
    return () if pair is None else needs_mesh_stiffness(pair)


def own_mesh(asked: HelicalPairInputs, upstream: Upstream) -> tuple[MeshParameters, NDArray[np.float64]]:
    """The mesh of the model, and the estimated errors of K_M [N/m], kappa and mu."""
    if asked.mesh is not None or asked.pair is None or asked.part.mesh.pair is None:
        return asked.mesh or asked.part.mesh.build(), np.zeros(3)
    found = mesh_stiffness_of(upstream, asked.part.mesh.pair)
    stiffness, kappa, mu = (float(v) for v in found.mean)
    return mesh_of_pair(asked.pair, stiffness, kappa, mu), found.mean_error


def _compute(asked: TransmissibilityInputs, upstream: Upstream, _work: Work) -> TransmissibilityData:
    from fegear.dynamics.helical_pair.modal_indices import mode_table, rank_modes

    mesh, doubt = own_mesh(asked.pair, upstream)
    model = asked.pair.part.build(mesh, asked.pair.prefix)
    try:
        response = frequency_response(model, model.natural_frequency * asked.ratios)
        drawn, undamped = resolved_response(model, float(asked.ratios[0]), float(asked.ratios[-1]))
    except InputError as error:
        raise at(f"transmissibility.{asked.name}", error) from None
    full = np.empty(0)
    if asked.pair.part.mesh.pair is not None:
        full = _with_full_matrix(model, mesh_stiffness_of(upstream, asked.pair.part.mesh.pair))
    return TransmissibilityData(
        mesh, mode_table(model), rank_modes(model), response, drawn, undamped, model, doubt, full
    )  # fmt: skip


def _with_full_matrix(model: HelicalPairModel | ReducedPairModel, found: MeshStiffnessData) -> NDArray[np.float64]:
    from fegear.dynamics.helical_pair.model import HelicalPairModel

    if not isinstance(model, HelicalPairModel):
        return np.empty(0)
    return full_matrix_frequencies(model, found.mean_over_q)


def frequency_response(
    model: HelicalPairModel | ReducedPairModel, frequency: NDArray[np.float64]
) -> Transmissibility | ReducedTransmissibility:
    """Response of either model at circular frequencies [rad/s]."""
    from fegear.dynamics.helical_pair.model import HelicalPairModel
    from fegear.dynamics.helical_pair.transmissibility import reduced_transmissibility, transmissibility

    if isinstance(model, HelicalPairModel):
        return transmissibility(model, frequency)
    return reduced_transmissibility(model, frequency)


def resolved_response(
    model: HelicalPairModel | ReducedPairModel, low: float, high: float
) -> tuple[Transmissibility | ReducedTransmissibility, NDArray[np.float64]]:
    """Response between two values of Lambda, at points that show every peak and zero, and Lambda of undamped poles."""
    from fegear.dynamics.helical_pair.transmissibility import natural_frequencies
    from fegear.dynamics.train.resolved_response import resolved_grid

    scale = model.natural_frequency
    poles, undamped = (found / scale for found in natural_frequencies(model))

    def sizes(ratios: NDArray[np.float64]) -> NDArray[np.float64]:
        found = frequency_response(model, scale * ratios)
        parts = [found.G / model.mesh.stiffness, found.G_minus_a / model.mesh.stiffness, *mesh_forces(found).values()]
        return np.abs(np.stack(parts, axis=1))

    even, damped = np.linspace(low, high, _DRAWN), np.setdiff1d(poles, undamped)
    ratios = resolved_grid(sizes, even, damped, undamped)
    return frequency_response(model, scale * ratios), undamped[(undamped > low) & (undamped < high)]


def _present(data: TransmissibilityData, asked: TransmissibilityInputs) -> Outcome:
    name, mesh = asked.name, data.mesh
    omega = data.model.natural_frequency / (2.0 * math.pi)
    stiffness, kappa, mu = (float(v) for v in data.mesh_error)
    values = (
        Value(f"{name}.omega", omega, "Hz", 0.5 * omega * stiffness / mesh.stiffness, "sqrt(K_M/m_eq)"),
        Value(f"{name}.mesh_stiffness", mesh.stiffness, "N/um", stiffness, "K_M"),
        Value(f"{name}.kappa", mesh.kappa, "", kappa, "axial centre of the mesh stiffness over half the face"),
        Value(f"{name}.mu", mesh.mu, "", mu, "rotary mesh stiffness"),
    )
    tables = (
        _mode_table(name, data.modes, data.ranking, data.full), _shapes_table(name, data.modes),
        _response_table(name, data.response),
    )  # fmt: skip
    figures = (
        indices_figure(name, data.modes), *mode_shape_figures(name, data.model, data.modes),
        *response_figures(name, data.mesh.stiffness, data.drawn, data.undamped),
    )  # fmt: skip
    settings = {"damping_ratio": asked.pair.part.damping_ratio, "frequencies": asked.ratios.size}
    remarks = tuple(f"Pair {name}: {remark}." for remark in data.modes.remarks)
    return Outcome(data, tables, values, settings, (*remarks, *_two_parameters(name, data)), figures)


def _two_parameters(name: str, data: TransmissibilityData) -> tuple[str, ...]:
    """Say what the two-parameter form of the mesh does to the natural frequencies."""
    own = data.modes.frequency
    flexible = (own > 0.0) & (data.full > 0.0) if data.full.size else np.zeros(own.size, dtype=bool)
    if not flexible.any():
        return ()
    change = np.where(flexible, data.full / np.where(flexible, own, 1.0) - 1.0, 0.0)
    worst = int(np.argmax(np.abs(change)))
    sentence = (
        f"Pair {name}: one kappa for both gears lets them tilt about the pitch axis. With the whole mesh stiffness "
        f"matrix, each tilting about its own axis, natural frequencies move by up to {change[worst]:+.2%} (mode "
        f"{worst + 1}, {own[worst] / (2.0 * math.pi):.5g} Hz); the table has them."
    )
    return (sentence,)


def _forecast(scene: Scene, name: str) -> Forecast:
    """One response for each frequency."""
    count = scene.case.transmissibility[name].frequencies
    return Forecast({"frequencies": count}, 0.1 + 1e-5 * count)


#: The coordinates as figures write them, and as lengths in q.
SYMBOLS = dict(zip(COORDINATES, ("y", "z", "θx", "θy", "θz"), strict=True))


LENGTHS = dict(zip(COORDINATES, ("y", "z", "b_theta_x", "a_theta_y", "a_theta_z"), strict=True))


#: Frequency axis of all of them.
LAMBDA = Axis("Λ = ω / √(K_{M}/m_{eq})")


#: Entries below this share of the largest are none, and entries that differ by less are one.
_ROUND_OFF = 1e-9


#: An axis with poles or zeros that nothing limits ends so far above and below the middle of its curves.
_ABOVE, _BELOW = 1e3, 1e-4


#: Titles of panels, by matrix.
_ON = {"R": "", "R_ii": "External forces on the driver", "R_ij": "External forces on the driven gear"}


#: What the mesh transmits, by the coordinates along which it does.
_GROUPS = (
    ("normal", "Line-of-action and torsional", ("y", "theta_z")),
    ("axial", "Axial", ("z",)),
    ("rocking", "Rocking", ("theta_y",)),
    ("bending", "Bending", ("theta_x",)),
)


def mesh_forces(response: Response) -> dict[str, Complex]:
    """The matrices R of either model, by name."""
    keys = ("R",) if hasattr(response, "R") else ("R_ii", "R_ij")
    return {key: getattr(response, key) for key in keys}


def indices_figure(name: str, modes: ModeTable) -> Figure:
    """Modal indices as bars."""
    shown = np.flatnonzero(modes.ratio > 0.0)
    place = np.arange(shown.size)
    named = tuple(f"{r + 1}\n{modes.ratio[r]:.4g}" for r in shown)
    indices = (
        ("normal, Δ_{η}", modes.normal),
        ("bending, Δ_{θx}", modes.bending),
        ("coupling energy ratio", modes.coupling),
    )
    bars = tuple(Bars(place, values[shown], label, f"series:{k}") for k, (label, values) in enumerate(indices))
    return Figure(
        f"helical_modes_{name}",
        f"Modal indices of pair {name}",
        f"Pair {name}: which modes a transmission error along the tooth normal or a bending one excites.",
        (Panel(Axis("mode and its Λ_{r}", categories=named), Axis("modal index"), bars),),
    )


def response_figures(name: str, stiffness: float, response: Response, undamped: Array) -> tuple[Figure, ...]:
    """All figures over frequency.

    Parameters
    ----------
    name : str
        Of the pair.
    stiffness : float
        K_M [N/m].
    response : Transmissibility or ReducedTransmissibility
        At points that show every peak and zero.
    undamped : ndarray
        Lambda of its poles, across which nothing is drawn.
    """
    ratio, matrices = response.ratio, mesh_forces(response)

    def panel(label: str, entries: Iterable[Entry], title: str = "") -> Panel:
        return _panel(ratio, label, tuple(entries), undamped, title)

    def entries(matrix: str, rows: Sequence[str], columns: Sequence[str]) -> Iterable[Entry]:
        for row in rows:
            for column in columns:
                values = matrices[matrix][:, COORDINATES.index(row), COORDINATES.index(column)]
                yield _entry(matrix, row, column), np.abs(values)

    first = next(iter(matrices))
    y, theta_z = COORDINATES.index("y"), COORDINATES.index("theta_z")
    dynamic = np.abs(response.G_minus_a[:, theta_z, y]) / stiffness
    figures = [
        Figure(
            f"transmissibility_{name}",
            f"Force transmissibility of pair {name}",
            f"Pair {name}: spectral mesh stiffness and mesh force transmissibility for a transmission error and an "
            "external force along the plane of action; components over q = (y, z, b theta_x, a theta_y, a theta_z).",
            (
                panel("|G| / K_{M}, per transmission error", (
                    (_entry("G", row, "y"), np.abs(response.G[:, i, y]) / stiffness)
                    for i, row in enumerate(COORDINATES)
                )),
                panel(f"|{_matrix(first)}|, per external force", entries(first, COORDINATES, ("y",))),
            ),
        ),
        Figure(
            f"dynamic_load_factor_{name}",
            f"Conventional frequency response of pair {name}",
            f"Pair {name}: torsional response to a transmission error along the line of action, G - a_M over K_M (the "
            "dynamic load factor), and the mesh force transmissibility along the line of action and in torsion.",
            (
                panel("amplitude", (
                    ("(G − a_{M})_{θz,y} / K_{M}", dynamic),
                    *entries(first, ("theta_z",), ("theta_z",)), *entries(first, ("y",), ("y",)),
                )),
            ),
        ),
    ]  # fmt: skip
    for key, title, rows in _GROUPS:
        figures.append(Figure(
            f"transmissibility_{key}_{name}",
            f"{title} mesh force transmissibility of pair {name}",
            f"Pair {name}: first index the mesh force, second the external force, over q = (y, z, b theta_x, "
            "a theta_y, a theta_z). Entries that are equal share a curve; what is zero is not drawn.",
            tuple(
                panel(f"|{_matrix(matrix)}|", entries(matrix, rows, COORDINATES), _ON[matrix]) for matrix in matrices
            ),
        ))  # fmt: skip
    return tuple(figures)


def _matrix(name: str) -> str:
    return name if "_" not in name else f"{name[0]}_{{{name[2:]}}}"


def _entry(matrix: str, row: str, column: str) -> str:
    kind, _, gears = matrix.partition("_")
    return f"{kind}_{{{gears + ' ' if gears else ''}{SYMBOLS[row]},{SYMBOLS[column]}}}"


def _panel(ratio: Array, label: str, entries: tuple[Entry, ...], undamped: Array, title: str) -> Panel:
    """Curves of the entries that are something; equal ones are one curve with all their names."""
    largest = max((float(np.nanmax(values)) for _, values in entries), default=0.0)
    shown: list[tuple[list[str], Array]] = []
    for name, values in entries:
        if not float(np.nanmax(values)) > _ROUND_OFF * largest:
            continue
        same = next((names for names, other in shown if _equal(values, other)), None)
        if same is not None:
            same.append(name)
        else:
            shown.append(([name], values))
    curves = []
    for k, (names, values) in enumerate(shown):
        x, y = broken(ratio, values, undamped)
        curves.append(Curve(x, np.where(y > 0.0, y, np.nan), " = ".join(names), f"series:{k}", markers=False,
                            width=3.0 - min(0.3 * k, 1.8)))  # fmt: skip
    limits = ends([values for _, values in shown]) if undamped.size else None
    return Panel(LAMBDA, Axis(label, log=True, limits=limits), tuple(curves), title=title)


def ends(rows: Sequence[Array]) -> tuple[float, float] | None:
    """Ends of a logarithmic axis for curves with poles and zeros that nothing limits."""
    if not rows:
        return None
    middles = [float(np.median(row)) for row in rows]
    least = min(float(row[row > 0.0].min()) for row in rows)
    return max(_BELOW * min(middles), 0.5 * least), _ABOVE * max(middles)


def _equal(a: Array, b: Array) -> bool:
    return bool(np.abs(a - b).max() <= _ROUND_OFF * np.abs(a).max())


TRANSMISSIBILITY = Stage(
    subjects=lambda scene: tuple(scene.case.transmissibility),
    needs=mesh_needs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    cites=citing(
        Citation("blankenship-singh", "stiffness, transmissibility and modal indices", "Eqs. 2 to 30 and 37 to 39")
    ),
    forecast=_forecast,
)
