"""Modes and force transmissibility of a helical pair as they are shown: rows, entries, panels."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Complex
from fegear.base.shown import shown, shows
from fegear.dynamics.helical_pair.model import COORDINATES
from fegear.engine.figure.axis import Axis
from fegear.results.helical.drawn_curves import DrawnCurve, DrawnPanel, ends
from fegear.results.helical.mode_shapes import ModeMotion, mode_motions

if TYPE_CHECKING:
    from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters
    from fegear.dynamics.helical_pair.modal_indices import ModeTable, RankedMode
    from fegear.dynamics.helical_pair.model import HelicalPairModel, ReducedPairModel
    from fegear.dynamics.helical_pair.transmissibility import ReducedTransmissibility, Transmissibility

    Response = Transmissibility | ReducedTransmissibility

Entry = tuple[str, Array]

#: The coordinates as figures write them, and as lengths in q.
SYMBOLS = dict(zip(COORDINATES, ("y", "z", "θx", "θy", "θz"), strict=True))
LENGTHS = dict(zip(COORDINATES, ("y", "z", "b_theta_x", "a_theta_y", "a_theta_z"), strict=True))
#: Frequency axis of all of them.
LAMBDA = Axis("Λ = ω / √(K_{M}/m_{eq})")
#: Entries below this share of the largest are none, and entries that differ by less are one.
_ROUND_OFF = 1e-9
#: Titles of panels, by matrix.
_ON = {"R": "", "R_ii": "External forces on the driver", "R_ij": "External forces on the driven gear"}


def mesh_forces(response: Response) -> dict[str, Complex]:
    """The matrices R of either model, by name."""
    keys = ("R",) if hasattr(response, "R") else ("R_ii", "R_ij")
    return {key: getattr(response, key) for key in keys}


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


@dataclass(frozen=True)
class ModeRows:
    """Modes of a pair, arrays of shape (n,)."""

    mode: NDArray[np.int64] = shown("", "mode number, descending frequency")
    ratio: Array = shown("", "frequency / sqrt(K_M/m_eq); 0: rigid-body motion", name="Lambda")
    frequency: Array = shown("Hz", "natural frequency")
    normal: Array = shown("", "relative mesh displacement along the tooth normal", name="Delta_normal")
    bending: Array = shown("", "relative mesh rotation about x", name="Delta_bending")
    coupling: Array = shown("", "coupling strain energy / sum of both")
    rank_normal: Array = shown("", "rank for normal transmission error and forces")
    weight_normal: Array = shown("", "modal mesh force / maximum")
    rank_bending: Array = shown("", "rank for bending error and moments")
    weight_bending: Array = shown("", "modal mesh moment / maximum")
    whole: Array | None = shown(
        "Hz", "with the full mesh stiffness matrix (tilting about each gear axis)",
        name="frequency_full_matrix",
    )  # fmt: skip


@dataclass(frozen=True)
class FlexibleModes:
    """Modal indices of the modes that are no rigid-body motion, as bars."""

    names: tuple[str, ...]
    normal: Array = shown("", "normal, Δ_{η}")
    bending: Array = shown("", "bending, Δ_{θx}")
    coupling: Array = shown("", "coupling energy ratio")

    @property
    @shows("", "number of the mode among them")
    def place(self) -> Array:
        """From 0."""
        return np.arange(self.normal.size, dtype=float)


@dataclass(frozen=True)
class Motion:
    """Motion along one coordinate in every mode."""

    name: str
    meaning: str
    motion: Array = shown("", "motion over q")


@dataclass(frozen=True)
class StiffnessEntry:
    """An entry of the spectral mesh stiffness, or of what is dynamic in it, over frequency."""

    name: str
    value: Array = shown("N/um", "spectral mesh stiffness")


@dataclass(frozen=True)
class ForceEntry:
    """An entry of the force transmissibility over frequency."""

    name: str
    value: Array = shown("", "mesh force transmissibility")


@dataclass(frozen=True)
class ResponseRows:
    """Frequency response at the frequencies of the case."""

    found: Response
    ratio: Array = shown("", "frequency / sqrt(K_M/m_eq)", name="Lambda")
    frequency: Array = shown("Hz", "frequency")

    @property
    def stiffness(self) -> list[StiffnessEntry]:
        """Real and imaginary parts of G."""
        return [StiffnessEntry(*one) for one in _parts("G", self.found.G)]

    @property
    def forces(self) -> list[ForceEntry]:
        """Those of R."""
        return [ForceEntry(*one) for key, matrix in mesh_forces(self.found).items() for one in _parts(key, matrix)]

    @property
    def dynamic(self) -> list[StiffnessEntry]:
        """Amplitudes of G - a_M."""
        return [
            StiffnessEntry(f"G_minus_a_{row}_{column}_abs", np.abs(self.found.G_minus_a[:, i, j]))
            for i, row in enumerate(COORDINATES)
            for j, column in enumerate(COORDINATES)
        ]


def _parts(label: str, matrix: Complex) -> Iterable[tuple[str, Array]]:
    """Real and imaginary parts of every entry of a matrix with their names."""
    for i, row in enumerate(COORDINATES):
        for j, column in enumerate(COORDINATES):
            for part, values in (("re", matrix[:, i, j].real), ("im", matrix[:, i, j].imag)):
                yield f"{label}_{row}_{column}_{part}", values


@dataclass(frozen=True)
class PairMesh:
    """What a pair's model has of its mesh, and estimated errors of K_M, kappa and mu."""

    errors: tuple[float, float, float]
    omega: float = shown("Hz", "sqrt(K_M/m_eq)")
    stiffness: float = shown("N/um", "K_M", name="mesh_stiffness")
    kappa: float = shown("", "axial centre of the mesh stiffness / half face width")
    mu: float = shown("", "rotational mesh stiffness")

    @property
    def omega_error(self) -> float:
        """Of the reference frequency [Hz]."""
        return 0.5 * self.omega * self.errors[0] / self.stiffness


@dataclass(frozen=True)
class ShownTransmissibility:
    """Modes, ranking and frequency response of a pair."""

    data: TransmissibilityData

    @property
    def model(self) -> HelicalPairModel | ReducedPairModel:
        """Of the pair."""
        return self.data.model

    @property
    def modes(self) -> ModeTable:
        """Of the pair."""
        return self.data.modes

    def _ranked(self, excitation: str, key: str) -> Array:
        rows = sorted((row for row in self.data.ranking if row.excitation == excitation), key=lambda row: row.mode)
        return np.array([getattr(row, key) for row in rows])

    @property
    def mode_rows(self) -> ModeRows:
        """Every mode."""
        modes, full = self.data.modes, self.data.full
        ranks = [self._ranked(excitation, key) for excitation in ("normal", "bending") for key in ("rank", "weight")]
        return ModeRows(
            np.arange(1, modes.ratio.size + 1), modes.ratio, modes.frequency / (2.0 * math.pi), modes.normal,
            modes.bending, modes.coupling, ranks[0], ranks[1], ranks[2], ranks[3],
            full / (2.0 * math.pi) if full.size else None,
        )  # fmt: skip

    @property
    def flexible(self) -> FlexibleModes:
        """Modes that are no rigid-body motion."""
        modes = self.data.modes
        on = np.flatnonzero(modes.ratio > 0.0)
        names = tuple(f"{r + 1}\n{modes.ratio[r]:.4g}" for r in on)
        return FlexibleModes(names, modes.normal[on], modes.bending[on], modes.coupling[on])

    @cached_property
    def motions(self) -> list[ModeMotion]:
        """Of the flexible modes."""
        return mode_motions(self.data.model, self.data.modes)

    @property
    def shapes(self) -> list[Motion]:
        """Mode shape vectors over q, of unit Euclidean norm."""
        shapes = self.data.modes.shapes
        both = shapes.shape[0] > len(COORDINATES)
        what = (
            "mode shape in q, unit norm" if both
            else "q_i + P q_j, unit norm: each gear moves half, the driven mirrored"
        )  # fmt: skip
        gears = ("_driver", "_driven") if both else ("",)
        names = [f"{LENGTHS[coordinate]}{gear}" for gear in gears for coordinate in COORDINATES]
        return [Motion(name, what, row) for name, row in zip(names, shapes, strict=True)]

    @property
    def response(self) -> ResponseRows:
        """At the frequencies of the case."""
        found = self.data.response
        return ResponseRows(found, found.ratio, found.frequency / (2.0 * math.pi))

    @property
    def mesh(self) -> PairMesh:
        """Of the model."""
        mesh, (stiffness, kappa, mu) = self.data.mesh, self.data.mesh_error.tolist()
        omega = self.data.model.natural_frequency / (2.0 * math.pi)
        return PairMesh((stiffness, kappa, mu), omega, mesh.stiffness, mesh.kappa, mesh.mu)

    def _panel(self, label: str, entries: Iterable[Entry], title: str = "") -> DrawnPanel:
        """Curves of the entries that are something; equal ones are one curve with all their names."""
        each, poles = list(entries), self.data.undamped
        largest = max((float(np.nanmax(values)) for _, values in each), default=0.0)
        drawn: list[tuple[list[str], Array]] = []
        for name, values in each:
            if not float(np.nanmax(values)) > _ROUND_OFF * largest:
                continue
            same = next((names for names, other in drawn if _equal(values, other)), None)
            if same is not None:
                same.append(name)
            else:
                drawn.append(([name], values))
        ratio = self.data.drawn.ratio
        curves = [
            DrawnCurve.on_log(" = ".join(names), f"series:{k}", ratio, values, poles, 3.0 - min(0.3 * k, 1.8))
            for k, (names, values) in enumerate(drawn)
        ]
        limits = ends([values for _, values in drawn]) if poles.size else None
        return DrawnPanel(LAMBDA, Axis(label, log=True, limits=limits), curves, title)

    def _entries(self, matrix: str, rows: Sequence[str], columns: Sequence[str]) -> Iterable[Entry]:
        values = mesh_forces(self.data.drawn)[matrix]
        for row in rows:
            for column in columns:
                size = np.abs(values[:, COORDINATES.index(row), COORDINATES.index(column)])
                yield _entry(matrix, row, column), size

    @property
    def along_the_plane_of_action(self) -> list[DrawnPanel]:
        """G and R for a transmission error and an external force along it."""
        drawn, first = self.data.drawn, next(iter(mesh_forces(self.data.drawn)))
        y, stiffness = COORDINATES.index("y"), self.data.mesh.stiffness
        by_error = [(_entry("G", row, "y"), np.abs(drawn.G[:, i, y]) / stiffness) for i, row in enumerate(COORDINATES)]
        return [
            self._panel("|G| / K_{M}, per transmission error", by_error),
            self._panel(f"|{_matrix(first)}|, per external force", self._entries(first, COORDINATES, ("y",))),
        ]

    @property
    def conventional(self) -> list[DrawnPanel]:
        """The dynamic load factor, and R along the line of action and in torsion."""
        drawn, first = self.data.drawn, next(iter(mesh_forces(self.data.drawn)))
        place = COORDINATES.index("theta_z"), COORDINATES.index("y")
        dynamic = np.abs(drawn.G_minus_a[:, place[0], place[1]]) / self.data.mesh.stiffness
        entries = (
            ("(G − a_{M})_{θz,y} / K_{M}", dynamic), *self._entries(first, ("theta_z",), ("theta_z",)),
            *self._entries(first, ("y",), ("y",)),
        )  # fmt: skip
        return [self._panel("amplitude", entries)]

    def transmitted(self, rows: Sequence[str]) -> list[DrawnPanel]:
        """Entries of every R in some rows."""
        return [
            self._panel(f"|{_matrix(matrix)}|", self._entries(matrix, rows, COORDINATES), _ON[matrix])
            for matrix in mesh_forces(self.data.drawn)
        ]


def _matrix(name: str) -> str:
    return name if "_" not in name else f"{name[0]}_{{{name[2:]}}}"


def _entry(matrix: str, row: str, column: str) -> str:
    kind, _, gears = matrix.partition("_")
    return f"{kind}_{{{gears + ' ' if gears else ''}{SYMBOLS[row]},{SYMBOLS[column]}}}"


def _equal(a: Array, b: Array) -> bool:
    return bool(np.abs(a - b).max() <= _ROUND_OFF * np.abs(a).max())
