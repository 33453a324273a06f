"""Stage ``mesh-stiffness-matrix``: stiffness of a loaded mesh against all motions of its gears, over the mesh cycle.

Figures of the mesh stiffness matrix: its three numbers over the mesh cycle, and its mean as a map.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, HeatMap, Mark
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Subject, Task, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.pair.loaded_teeth import wide_pairs

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Complex
    from fegear.case.reading import Scene
    from fegear.contact.fourier import Panels
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.contact.wide.mesh_matrix import MeshStiffness


@dataclass(frozen=True)
class MeshStiffnessData:
    """Stiffness matrix of a mesh under its loads.

    Parameters
    ----------
    flanks : LoadedWidePair
    found, other : MeshStiffness
        And what the coarser solution gives.
    even : ndarray, shape (3,)
        K_M over its own mean, kappa and mu of contact lines that are everywhere equally stiff.
    """

    flanks: LoadedWidePair
    found: MeshStiffness
    other: MeshStiffness
    even: Array

    @property
    def mean(self) -> Array:
        """K_M [N/m], kappa and mu of the mean matrix under the nominal load."""
        return np.asarray(self.found.mean_parameters[:, self.flanks.at])

    @property
    def mean_error(self) -> Array:
        """Their estimated errors: of the coarser solution, and of half as many roll positions."""
        from fegear.contact.wide.mesh_matrix import mesh_parameters_of
        from fegear.contact.wide.transmission_error import from_half

        i, found = self.flanks.at, self.found
        fewer = np.stack([from_half(found.points, moment) for moment in found.moments[:, :, i]], axis=1)
        half = mesh_parameters_of(found.pair, found.mean(fewer))
        return np.asarray(np.abs(self.other.mean_parameters[:, i] - self.mean) + np.abs(half - self.mean))

    @property
    def mean_over_q(self) -> Array:
        """Mean matrix under the nominal load over q of both gears, shape (10, 10) [N/m]; see `over_q`."""
        from fegear.contact.wide.mesh_matrix import over_q

        return over_q(self.found.pair, self.found.mean(self.found.matrix[:, self.flanks.at]))


def needs_mesh_stiffness(name: str) -> tuple[Task, ...]:
    """The task of this stage for a pair."""
    return (Task("mesh-stiffness-matrix", name),)


def mesh_stiffness_of(upstream: Upstream, name: str) -> MeshStiffnessData:
    """What this stage computed for a pair."""
    return cast("MeshStiffnessData", upstream[Task("mesh-stiffness-matrix", name)])


def _compute(asked: Subject, upstream: Upstream, _work: Work) -> MeshStiffnessData:
    from fegear.contact.wide.mesh_matrix import even_moments, mesh_parameters_of, mesh_stiffness

    flanks = loaded_flanks(upstream, asked.name)
    points = flanks.flanks.points
    even = mesh_parameters_of(flanks.found.pair, even_moments(flanks.found.pair, flanks.found.lines))
    found, other = (mesh_stiffness(one, points) for one in (flanks.found, flanks.error.coarse))
    return MeshStiffnessData(flanks, found, other, even)


def _over_roll(name: str, data: MeshStiffnessData) -> Table:
    i, found = data.flanks.at, data.found
    parameters, doubt = found.parameters[:, :, i], np.abs(data.other.parameters - found.parameters)[:, :, i]
    c = math.cos(found.pair.driver.base_helix_angle)
    columns = (
        column_of(data.flanks.found.lines, "roll"),
        Column("K_M", parameters[0], "N/um", "tangent stiffness along the tooth normal, over all pairs"),
        Column("kappa", parameters[1], "", "lever of the stiffness in the plane of action over half the face width"),
        Column("mu", parameters[2], "", "rotary stiffness over K_M b^2"),
        Column("K_M_error", doubt[0], "N/um", "estimated error"),
        Column("kappa_error", doubt[1], "", "estimated error"),
        Column("mu_error", doubt[2], "", "estimated error"),
        Column("transverse_stiffness", found.moments[0, :, i], "N/um", "dW/dzeta along the transverse line of action"),
        Column("force_lever", c * found.lever[:, i], "mm", "lever of the normal force in the plane of action"),
    )
    return Table(f"mesh_stiffness_matrix_{name}", columns, f"Stiffness of the mesh of pair {name} over a base pitch")


def _mean_matrix(name: str, data: MeshStiffnessData) -> Table:
    """The mean matrix, each gear turning about its own axis."""
    matrix = data.mean_over_q
    names = [f"{coordinate}_{gear}" for gear in ("driver", "driven")
             for coordinate in ("y", "z", "b_theta_x", "r_theta_y", "r_theta_z")]  # fmt: skip
    meaning = "force on the coordinate of the row per motion of this one; rotations as arcs at b or the base radius"
    columns = (
        Column("coordinate", np.array(names, dtype=str), "", "right-handed axes through the gear's own axis"),
        *(Column(head, column, "N/um", meaning) for head, column in zip(names, matrix.T, strict=True)),
    )
    return Table(f"mesh_stiffness_mean_{name}", columns, f"Mean stiffness matrix of the mesh of pair {name}")


def _harmonics(name: str, data: MeshStiffnessData) -> Table:
    i, found = data.flanks.at, data.found
    c, b = math.cos(found.pair.driver.base_helix_angle), found.half_width
    from fegear.contact.wide.transmission_error import series_over_pitch

    scale = (1.0 / c**2, 1.0 / (c * b), 1.0 / b**2, c)
    curves = (*found.moments[:, :, i], found.lever[:, i])
    series = [series_over_pitch(found.points, k * curve).amplitude for k, curve in zip(scale, curves, strict=True)]
    columns = (
        Column("n", np.arange(1, series[0].size + 1), "", "harmonic of the mesh frequency"),
        Column("K_M", series[0], "N/um", "0-peak"),
        Column("kappa_K_M", series[1], "N/um", "0-peak, coupling of translation and tilt"),
        Column("mu_K_M", series[2], "N/um", "0-peak, rotary stiffness over b^2"),
        Column("force_lever", series[3], "mm", "0-peak: the force wanders over the face under a constant load"),
    )
    return Table(f"mesh_stiffness_harmonics_{name}", columns, f"Harmonics of the mesh stiffness of pair {name}")


def _loads(name: str, data: MeshStiffnessData) -> Table:
    mean = data.found.mean_parameters
    lever = math.cos(data.found.pair.driver.base_helix_angle) * data.found.mean(data.found.lever)
    columns = (
        Column("load", data.flanks.found.load, "N", "along the transverse line of action"),
        Column("K_M", mean[0], "N/um", "of the mean matrix"),
        Column("kappa", mean[1], "", "of the mean matrix"),
        Column("mu", mean[2], "", "of the mean matrix"),
        Column("force_lever", lever, "mm", "mean over the base pitch"),
    )  # fmt: skip
    return Table(f"mesh_stiffness_loads_{name}", columns, f"Mean mesh stiffness of pair {name} under every load")


def own_axis_parameters(data: MeshStiffnessData) -> tuple[tuple[float, float], tuple[float, float]]:
    """Kappa and mu of driver and driven gear that tilt about their own axes: the axial force has a lever there."""
    pair, (_, kappa, mu) = data.found.pair, data.mean
    from fegear.contact.wide.lines import base_twist

    s = math.sin(math.atan(base_twist(pair))) * math.tan(pair.working_pressure_angle) / data.found.half_width
    moves = (-s * pair.driver.base_radius, s * pair.driven.base_radius)
    first, second = ((float(kappa + d), float(mu + 2.0 * kappa * d + d * d)) for d in moves)
    return first, second


def loaded_harmonics(data: MeshStiffnessData, count: int, shuttling: bool) -> tuple[Complex, Array]:
    """Harmonics of the static transmission error of loaded flanks over q = (y, z, b theta_x, ...), and their errors.

    Along y it is the transmission error. With `shuttling` the moment of the force about x varies as well: the motion
    that would hold both force and moment level is (y, b theta_x), for the mean stiffness matrix.

    Parameters
    ----------
    data : MeshStiffnessData
    count : int
        At most half as many as roll positions.
    shuttling : bool

    Returns
    -------
    ndarray of complex, shape (N, 5)
        0-peak [m].
    ndarray, shape (N, 5)
        Changes by the coarser solution and by half as many roll positions.
    """
    from fegear.contact.wide.transmission_error import from_half

    flanks = data.flanks
    found, other = (_over_q(one, te, flanks.at, shuttling) for one, te in (
        (data.found, flanks.found.transmission_error), (data.other, flanks.error.coarse.transmission_error)
    ))  # fmt: skip
    points = data.found.points
    fewer = np.stack([from_half(points, curve) for curve in found.T], axis=1)
    series, half, coarse = (_series(points, curves, count) for curves in (found, fewer, other))
    return series, np.abs(series - coarse) + np.abs(series - half)


def _series(points: Panels, curves: Array, count: int) -> Complex:
    """Complex 0-peak amplitudes of curves (P, k) over the base pitch, shape (N, k)."""
    from fegear.contact.wide.transmission_error import series_over_pitch

    found = [2.0 * series_over_pitch(points, curve).coefficients[1 : count + 1] for curve in curves.T]
    return np.stack(found, axis=1)


def _over_q(one: MeshStiffness, te: Array, case: int, shuttling: bool) -> Array:
    """Static transmission error over q at every roll position, shape (P, 5) [m]."""
    error = np.zeros((te.shape[0], 5))
    error[:, 0] = te[:, case]
    if shuttling:
        k, k1, k2 = one.mean_moments[:, case]
        load = (one.lever[:, case] - one.mean(one.lever[:, case])) * one.load[case]
        tilt = -load / (k2 - k1**2 / k)
        error[:, 0] -= k1 / k * tilt
        error[:, 2] = one.half_width * tilt
    return error


def _present(data: MeshStiffnessData, asked: Subject) -> Outcome:
    name, i, found = asked.name, data.flanks.at, data.found
    (stiffness, kappa, mu), doubt = data.mean, data.mean_error
    (kappa_i, mu_i), (kappa_j, mu_j) = own_axis_parameters(data)
    b, c = found.half_width, math.cos(found.pair.driver.base_helix_angle)
    lever = c * found.lever[:, i]
    lever_doubt = c * float(np.abs(data.other.lever[:, i] - found.lever[:, i]).max())
    tilt, tilt_doubt = stiffness * mu * b**2, b**2 * (mu * doubt[0] + stiffness * doubt[2])
    values = (
        Value(f"{name}.K_M", float(stiffness), "N/um", float(doubt[0]), "mean mesh stiffness along the tooth normal"),
        Value(f"{name}.mesh_kappa", float(kappa), "", float(doubt[1]),
              "mean lever of the mesh stiffness about the pitch axis over half the face width"),
        Value(f"{name}.mesh_mu", float(mu), "", float(doubt[2]), "mean rotary stiffness over K_M b^2"),
        Value(f"{name}.mesh_mu_even", float(data.even[2]), "", 0.0,
              "mu of contact lines that are everywhere equally stiff"),
        Value(f"{name}.mesh_kappa_even", float(data.even[1]), "", 0.0, "kappa of the same"),
        Value(f"{name}.mesh_tilt_stiffness", float(tilt), "N.m", float(tilt_doubt), "moment per radian: K_M mu b^2"),
        Value(f"{name}.mesh_kappa_driver", kappa_i, "", float(doubt[1]), "kappa about the driver's own axis"),
        Value(f"{name}.mesh_kappa_driven", kappa_j, "", float(doubt[1]), "kappa about the driven gear's own axis"),
        Value(f"{name}.mesh_mu_driver", mu_i, "", None, "mu about the driver's own axis"),
        Value(f"{name}.mesh_mu_driven", mu_j, "", None, "mu about the driven gear's own axis"),
        Value(f"{name}.force_lever", float(found.mean(lever)), "mm", lever_doubt, "mean lever of the normal force"),
        Value(f"{name}.force_lever_peak_to_peak", float(np.ptp(lever)), "mm", 2.0 * lever_doubt,
              "the normal force wanders so far over the face"),
    )  # fmt: skip
    tables = [_over_roll(name, data), _mean_matrix(name, data), _harmonics(name, data)]
    if found.moments.shape[2] > 1:
        tables.append(_loads(name, data))
    settings = {"positions": data.flanks.flanks.positions, "load": data.flanks.nominal}
    figures = mesh_stiffness_figures(name, data)
    return Outcome(data, tuple(tables), values, settings, _remarks(name, data), figures)


def _remarks(name: str, data: MeshStiffnessData) -> tuple[str, ...]:
    _, kappa, mu = data.mean
    even = (
        f"Pair {name}: contact lines that are everywhere equally stiff, as the two-parameter form is often taken, have "
        f"mu = {data.even[2]:.4g} and kappa = {data.even[1]:.4g}; these teeth have {mu:.4g} and {kappa:.4g}."
    )
    remarks = [even]
    (kappa_i, _), (kappa_j, _) = own_axis_parameters(data)
    if abs(kappa_i - kappa_j) > 1e-3:
        remarks.append(
            f"Pair {name}: one kappa holds for tilting about the pitch axis. About their own axes, where the axial "
            f"force has a lever, the driver has {kappa_i:.4g} and the driven gear {kappa_j:.4g}; the table of the mean "
            "matrix has these."
        )
    return tuple(remarks)


def _check(scene: Scene, name: str) -> None:
    needs_wide_pair(scene, name, "mesh-stiffness-matrix")


def needs_wide_pair(scene: Scene, name: str, result: str) -> None:
    """Refuse pairs of plane teeth, whose load does not vary along the face.

    Raises
    ------
    InputError
    """
    from fegear.base.errors import InputError

    if name not in scene.wide_pairs:
        raise InputError(
            f"pair.{name}.width", '"plane"', f"knows no motion along the face, which {result} is about",
            'write width = "solid"',
        )  # fmt: skip


#: Coordinates of a gear as the map names them: driver 1, driven gear 2.
_COORDINATES = ("y", "z", "bθx", "rθy", "rθz")


def mesh_stiffness_figures(name: str, data: MeshStiffnessData) -> tuple[Figure, ...]:
    """Describe both figures of one pair under its nominal load."""
    return _drawn_over_roll(name, data), _as_map(name, data)


def _drawn_over_roll(name: str, data: MeshStiffnessData) -> Figure:
    i, roll = data.flanks.at, data.flanks.found.lines.roll * 1e3
    found, mean, even = data.found.parameters[:, :, i], data.mean, data.even
    doubt = np.abs(data.other.parameters[:, :, i] - found)
    lever = math.cos(data.found.pair.driver.base_helix_angle) * data.found.lever[:, i] / data.found.half_width
    x = Axis("roll position over one base pitch", "mm")

    def curve(k: int, label: str, scale: float = 1.0) -> Curve:
        return Curve(roll, found[k] * scale, label, "series:0", doubt[k] * scale)

    def level(value: float, label: str, role: str) -> Curve:
        return Curve(roll[[0, -1]], np.full(2, value), label, role, dash="dash", markers=False)

    return Figure(
        f"mesh_stiffness_matrix_{name}",
        f"Mesh stiffness of pair {name} over a base pitch",
        f"Pair {name}: stiffness along the tooth normal K_M, its lever kappa and rotary stiffness mu in halves of the "
        "face width b; bands are estimated errors, grey what contact lines would have that are everywhere equally "
        "stiff. The lever of the force wanders though the load is constant.",
        (
            Panel(x, Axis("K_M", "N/um", zero=True), (curve(0, "these teeth", 1e-6),
                  level(float(mean[0]) * 1e-6, "mean", "ink"))),
            Panel(x, Axis("kappa"), (curve(1, "these teeth"), level(float(mean[1]), "mean", "ink"),
                  level(float(even[1]), "lines equally stiff", "grey"),
                  Curve(roll, lever, "lever of the force over b", "orange", dash="dot")), (Mark("y", 0.0),)),
            Panel(x, Axis("mu", zero=True), (curve(2, "these teeth"), level(float(mean[2]), "mean", "ink"),
                  level(float(even[2]), "lines equally stiff", "grey"))),
        ),
        under=f"{data.flanks.nominal:.5g} N",
    )  # fmt: skip


def _as_map(name: str, data: MeshStiffnessData) -> Figure:
    matrix = data.mean_over_q * 1e-6
    places = np.arange(10.0)
    names = tuple(f"{c} {gear}" for gear in (1, 2) for c in _COORDINATES)
    size = float(np.abs(matrix).max())
    field = HeatMap(places, places, matrix, "stiffness", "N/um", (0.0, size), numbers=True)
    return Figure(
        f"mesh_stiffness_mean_{name}",
        f"Mean stiffness matrix of the mesh of pair {name}",
        f"Pair {name}: force on the coordinate of the row by motion along that of the column; 1 is the driver, 2 the "
        "driven gear, each turning about right-handed axes through its own. Rotations are arcs at half the face width "
        "b and at the base radius r.",
        (Panel(Axis("motion", categories=names), Axis("force", categories=names), (field,), height=2.2),),
        under=f"{data.flanks.nominal:.5g} N",
    )


MESH_STIFFNESS_MATRIX = Stage(
    subjects=lambda scene: wide_pairs(scene) or tuple(scene.pairs),
    inputs=Subject.of,
    compute=_compute,
    present=_present,
    needs=needs_flanks,
    check=_check,
    cites=citing(Citation("blankenship-singh", "mesh stiffness matrix, kappa and mu", "Eqs. 2 to 7")),
    forecast=lambda _scene, _name: Forecast({}, 0.1),
    why_external="its signs of rotations and tilts are those of axes on either side of the pitch point",
)
