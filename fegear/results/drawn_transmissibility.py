"""Figures of a helical pair's frequency response: every entry of the mesh force transmissibility, and the indices."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.helical_pair import COORDINATES
from fegear.dynamics.resolved_response import broken
from fegear.engine.figure import Axis, Bars, Curve, Figure, Panel

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fegear.arrays import Array, Complex
    from fegear.dynamics.modal_indices import ModeTable
    from fegear.dynamics.transmissibility import ReducedTransmissibility, Transmissibility

    Response = Transmissibility | ReducedTransmissibility
    Entry = tuple[str, Array]

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
            "dynamic load factor), beside the mesh force transmissibility along the line of action and in torsion.",
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
