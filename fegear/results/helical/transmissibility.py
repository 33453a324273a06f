"""Stage ``transmissibility``: modes and force transmissibility of helical pairs."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fegear.base.errors import InputError
from fegear.base.printed import percent
from fegear.case.built.helical_pair import HelicalPairInputs, full_matrix_frequencies, helical_pair_inputs, mesh_of_pair
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters
from fegear.dynamics.helical_pair.model import HelicalPairModel, ReducedPairModel
from fegear.dynamics.helical_pair.transmissibility import ReducedTransmissibility, Transmissibility
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results.helical.drawn_curves import drawn_panels
from fegear.results.helical.mode_shapes import MODE_SHAPES, mesh_mode_shapes
from fegear.results.helical.transmissibility_shown import ShownTransmissibility, TransmissibilityData, mesh_forces
from fegear.results.pair.mesh_stiffness_data import MeshStiffnessData
from fegear.results.pair.mesh_stiffness_matrix import mesh_stiffness_of, needs_mesh_stiffness

#: Even points from which a drawn response starts; it is refined wherever it bends.
_DRAWN = 241


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


def _two_parameters(seen: Seen) -> tuple[str, ...]:
    """Say what the two-parameter form of the mesh does to the natural frequencies."""
    data: TransmissibilityData = seen.data.data
    own = data.modes.frequency
    flexible = (own > 0.0) & (data.full > 0.0) if data.full.size else np.zeros(own.size, dtype=bool)
    if not flexible.any():
        return ()
    change = np.where(flexible, data.full / np.where(flexible, own, 1.0) - 1.0, 0.0)
    worst = int(np.argmax(np.abs(change)))
    sentence = (
        f"Pair {seen.name}: the model tilts both gears about the pitch axis (one kappa). With the full mesh "
        "stiffness matrix (tilting about the own axes) natural frequencies change by up to "
        f"{percent(change[worst], signed=True)} (mode {worst + 1}, {own[worst] / (2.0 * math.pi):.5g} Hz); see the "
        "table."
    )
    return (sentence,)


def _forecast(scene: Scene, name: str) -> Forecast:
    """One response for each frequency."""
    count = scene.case.transmissibility[name].frequencies
    return Forecast({"frequencies": count}, 0.1 + 1e-5 * count)


#: What the mesh transmits, by the coordinates along which it does.
_GROUPS = (
    ("normal", "Line-of-action and torsional", ("y", "theta_z")),
    ("axial", "Axial", ("z",)),
    ("rocking", "Rocking", ("theta_y",)),
    ("bending", "Bending", ("theta_x",)),
)


def _transmitted(key: str, title: str, rows: tuple[str, ...]) -> Chart:
    """What the mesh transmits along some coordinates."""
    return Chart(
        f"transmissibility_{key}_{{name}}", f"{title} mesh force transmissibility of pair {{name}}",
        "Pair {name}: first index the mesh force, second the external force, over q = (y, z, b theta_x, a theta_y, a "
        "theta_z). Equal entries share a curve; zero entries are omitted.",
        (drawn_panels(lambda seen: seen.data.transmitted(rows)),),
    )  # fmt: skip


_SHEET = Sheet(
    of=lambda data, _asked: ShownTransmissibility(data),
    tables=(
        Rows(
            "helical_modes_{name}", "Modes of pair {name}",
            (
                "mode", "ratio", "frequency", "normal", "bending", "coupling", "rank_normal", "weight_normal",
                "rank_bending", "weight_bending", "whole",
            ),
            of="mode_rows",
        ),
        Rows(
            "mode_shapes_{name}", "Mode shapes of pair {name}",
            ("mode", "ratio", Cell("motion", name="{one.name}", meaning="{one.meaning}", each="shapes")),
            of="mode_rows",
        ),
        Rows(
            "transmissibility_{name}", "Force transmissibility of pair {name}",
            (
                "ratio", "frequency", Cell("value", name="{one.name}", each="response.stiffness"),
                Cell("value", name="{one.name}", each="response.forces"),
                Cell("value", name="{one.name}", meaning="amplitude of G - a_M", each="response.dynamic"),
            ),
            of="response",
        ),
    ),
    values=(
        Number("mesh.omega", "mesh.omega_error"),
        Number("mesh.stiffness", lambda seen: seen.data.mesh.errors[0]),
        Number("mesh.kappa", lambda seen: seen.data.mesh.errors[1]),
        Number("mesh.mu", lambda seen: seen.data.mesh.errors[2]),
    ),
    figures=(
        Chart(
            "helical_modes_{name}", "Modal indices of pair {name}",
            "Pair {name}: modes excited by a transmission error along the tooth normal or in bending.",
            (
                Over(
                    lambda seen: Axis("mode and its Λ_{r}", categories=seen.data.flexible.names),
                    (
                        Line("normal", "normal, Δ_{{η}}", "series:0", x="place", kind="bars"),
                        Line("bending", "bending, Δ_{{θx}}", "series:1", x="place", kind="bars"),
                        Line("coupling", "coupling energy ratio", "series:2", x="place", kind="bars"),
                    ),
                    Axis("modal index"),
                ),
            ),
            of="flexible",
        ),
        MODE_SHAPES,
        mesh_mode_shapes,
        Chart(
            "transmissibility_{name}", "Force transmissibility of pair {name}",
            "Pair {name}: spectral mesh stiffness and mesh force transmissibility for a transmission error and an "
            "external force along the plane of action; components over q = (y, z, b theta_x, a theta_y, a theta_z).",
            (drawn_panels("along_the_plane_of_action"),),
        ),
        Chart(
            "dynamic_load_factor_{name}", "Conventional frequency response of pair {name}",
            "Pair {name}: torsional response to a transmission error along the line of action, G - a_M over K_M (the "
            "dynamic load factor), and the mesh force transmissibility along the line of action and in torsion.",
            (drawn_panels("conventional"),),
        ),
        *(_transmitted(*group) for group in _GROUPS),
    ),
    remarks=(
        lambda seen: [f"Pair {seen.name}: {remark}." for remark in seen.data.modes.remarks],
        _two_parameters,
    ),
    settings={
        "damping_ratio": lambda seen: seen.asked.pair.part.damping_ratio,
        "frequencies": lambda seen: seen.asked.ratios.size,
    },
)  # fmt: skip


TRANSMISSIBILITY = Stage(
    subjects=lambda scene: tuple(scene.case.transmissibility),
    needs=mesh_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    cites=citing(
        Citation("blankenship-singh", "stiffness, transmissibility and modal indices", "Eqs. 2 to 30 and 37 to 39")
    ),
    forecast=_forecast,
)
