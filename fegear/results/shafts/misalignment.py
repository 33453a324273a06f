"""Result ``misalignment``: how far shafts, bearings and housing misalign each mesh, and what opens over its face."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.shafts import mesh_places
from fegear.case.reading import Scene
from fegear.contact.wide.on_shafts import LoadedShafts
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, column_of, columns_of, curve_of, drawn, stacked, value_of
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results import forecasts
from fegear.results.shafts.loaded_shafts import LOADED_SHAFTS_TASK, loaded_shafts, shafts_of
from fegear.shafts.gearbox import CAUSES, MeshMisalignment, MeshState

_WORDS = {"bearings": "of the rings in their bearings", "housing": "of the bearings' seats",
          "bending": "of the shafts that bend", "torsion": "of the shafts that twist"}  # fmt: skip


@dataclass(frozen=True)
class MisalignmentData:
    """Misalignment of every mesh, under every load.

    Parameters
    ----------
    shafts : LoadedShafts
    states : tuple of tuple of MeshState
        One row for each of its states.
    """

    shafts: LoadedShafts
    states: tuple[tuple[MeshState, ...], ...]


def _compute(_inputs: None, upstream: Upstream, _work: Work) -> MisalignmentData:
    shafts = loaded_shafts(upstream)
    rows = tuple(shafts.gearbox.misalignment(one.bent, one.forces) for one in shafts.states)
    return MisalignmentData(shafts, rows)


def _present(data: MisalignmentData, _inputs: None) -> Outcome:
    meshes, nominal = data.shafts.gearbox.meshes, data.states[data.shafts.states.index(data.shafts.nominal)]
    tables, figures, values = [_by_cause(data)], [], []
    for mesh, (shares, gap) in zip(meshes, nominal, strict=True):
        values.append(_value(mesh.pair, shares))
        tables.append(Table(
            f"shaft_gap_{mesh.pair}",
            (*columns_of(gap, "z", "gap"),
             *(column_of(gap, "by_cause", gap.by_cause[n], name=f"gap_{cause}", meaning=_WORDS[cause])
               for n, cause in enumerate(CAUSES)),
             *columns_of(gap, "line_load")),
            f"Gap that shafts open over the face of pair {mesh.pair}",
        ))  # fmt: skip
        z = drawn(gap, "z")
        curves = tuple(
            Curve(z, drawn(gap, "by_cause", gap.by_cause[n]), cause, f"series:{n + 1}", markers=False)
            for n, cause in enumerate(CAUSES)
        )
        figures.append(Figure(
            f"shaft_gap_{mesh.pair}", f"What shafts open over the face of pair {mesh.pair}",
            f"Pair {mesh.pair}: gap of the flanks in the plane of action by shafts, bearings and housing, in all and "
            "by cause.",
            (Panel(axis_of(gap, "z"), axis_of(gap, "gap"),
                   (replace(curve_of(gap, "z", "gap", "in all", "series:0"), markers=False), *curves)),),
        ))  # fmt: skip
    return Outcome(data, tuple(tables), tuple(values), {}, (), tuple(figures))


def _value(pair: str, shares: MeshMisalignment) -> Value:
    return value_of(
        shares, "over_face", pair, name="shaft_misalignment", si=shares.over_face[0],
        meaning="over the face in the plane of action, toward end II, by shafts, bearings and housing",
    )  # fmt: skip


def _by_cause(data: MisalignmentData) -> Table:
    meshes, scales = data.shafts.gearbox.meshes, [state.scale for state in data.shafts.states]
    rows = [(mesh, scale, shares) for n, mesh in enumerate(meshes)
            for scale, shares in zip(scales, (state[n][0] for state in data.states), strict=True)]  # fmt: skip
    keys = tuple(MeshMisalignment.__dataclass_fields__)
    times = 1 + len(CAUSES)
    return Table(
        "misalignment",
        (Column("pair", np.repeat([mesh.pair for mesh, *_ in rows], times), "", "name of the pair"),
         Column("load", np.repeat([scale * mesh.load for mesh, scale, _ in rows], times), "N",
                "along the transverse line of action"),
         Column("cause", np.tile(("all", *CAUSES), len(rows)), "", "what misaligns the mesh"),
         *stacked([columns_of(shares, *keys) for *_, shares in rows]),
         Column("end_II", np.repeat(["left" if mesh.sense > 0 else "right" for mesh, *_ in rows], times), "",
                "end of the shafts toward which it lies")),
        "Misalignment of the meshes by cause",
    )  # fmt: skip


def _check(scene: Scene, _name: str) -> None:
    if not mesh_places(scene):
        raise InputError(
            "shaft", "(no pair)", "leaves no mesh to misalign", "name both gears of a pair in gears of shafts"
        )


MISALIGNMENT = Stage(
    subjects=shafts_of,
    inputs=lambda _scene, _name: None,
    compute=_compute,
    present=_present,
    needs=lambda _scene, _name: (LOADED_SHAFTS_TASK,),
    cites=citing(Citation("cowper", "shear coefficient of hollow circles")),
    check=_check,
    forecast=lambda _scene, _name: forecasts.constant(0.01),
    internal=True,
)
