"""Stage ``mesh-stiffness-matrix``: stiffness of a loaded mesh against all motions of its gears, over the mesh cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Line, Map, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Every, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Subject, Task, Upstream, Work
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.pair.loaded_teeth import BASE_PITCH, wide_pairs
from fegear.results.pair.mesh_stiffness_data import MeshStiffnessData

if TYPE_CHECKING:
    from fegear.case.reading import Scene


#: Coordinates of a gear as the map names them: driver 1, driven gear 2.
_COORDINATES = ("y", "z", "bθx", "rθy", "rθz")


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


def _level(quantity: str, label: str, role: str) -> Line:
    """A number across the panel."""
    return Line(
        f"means.{quantity}", label, role, look={"dash": "dash", "markers": False}, ends=True, x="over_roll.roll"
    )


def _over_pitch(quantity: str, *levels: Line) -> Over:
    """A number of the matrix over the base pitch with its band, and what it is compared with."""
    drawn = Line(f"over_roll.{quantity}", "these teeth", "series:0", f"over_roll.{quantity}_error", "over_roll.roll")
    signed = quantity == "kappa"
    marks = (lambda _: (Mark("y", 0.0),)) if signed else None
    return Over(BASE_PITCH, (drawn, *levels), marks=marks, options={} if signed else {"zero": True})


#: Contact lines of the same stiffness everywhere, in the legend; the load that figures hold for.
_EVEN, _UNDER = "uniformly stiff lines", "{d.flanks.nominal:said}"


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
            f"pair.{name}.width", '"plane"', f"has no axial variation, which {result} requires",
            'set width = "solid"',
        )  # fmt: skip


_NAMES = tuple(f"{coordinate} {gear}" for gear in (1, 2) for coordinate in _COORDINATES)
_SHEET = Sheet(
    tables=(
        Rows(
            "mesh_stiffness_matrix_{name}", "Stiffness of the mesh of pair {name} over a base pitch",
            (
                Cell("flanks.found.lines.roll", of=""), "stiffness", "kappa", "mu",
                *(Off(key, f"over_roll.{key}_error", "estimated error") for key in ("stiffness", "kappa", "mu")),
                "transverse", "lever",
            ),
            of="over_roll",
        ),
        Rows(
            "mesh_stiffness_mean_{name}", "Mean stiffness matrix of the mesh of pair {name}",
            ("coordinate", Cell("force", name="{one.name}", each="mean_matrix.columns")), of="mean_matrix",
        ),
        Rows(
            "mesh_stiffness_harmonics_{name}", "Harmonics of the mesh stiffness of pair {name}",
            (Every("harmonics"),), of="harmonics",
        ),
        Rows(
            "mesh_stiffness_loads_{name}", "Mean mesh stiffness of pair {name} for every load",
            (Every("loads"),), of="over_loads", when=lambda seen: seen.data.found.load.size > 1,
        ),
    ),
    values=(
        Number("stiffness", "means.stiffness_error", "means"),
        Number("kappa", "means.kappa_error", "means"),
        Number("mu", "means.mu_error", "means"),
        Number("mu_even", exact, "means"),
        Number("kappa_even", exact, "means"),
        Number("tilt", "means.tilt_error", "means"),
        Number("kappa_driver", "means.kappa_error", "means"),
        Number("kappa_driven", "means.kappa_error", "means"),
        Number("mu_driver", of="means"),
        Number("mu_driven", of="means"),
        Number("lever", "means.lever_error", "means"),
        Number("lever_peak_to_peak", lambda seen: 2.0 * seen.data.means.lever_error, "over_roll"),
    ),
    figures=(
        Chart(
            "mesh_stiffness_matrix_{name}", "Mesh stiffness of pair {name} over a base pitch",
            "Pair {name}: stiffness along the tooth normal K_M, its lever arm kappa and tilting stiffness mu in units "
            "of b/2 (face width b); bands are estimated errors; grey: contact lines with uniform stiffness. "
            "The lever arm of the force varies (shuttling) at constant load.",
            (
                _over_pitch("stiffness", _level("stiffness", "mean", "ink")),
                _over_pitch(
                    "kappa", _level("kappa", "mean", "ink"), _level("kappa_even", _EVEN, "grey"),
                    Line(
                        "over_roll.relative_lever", "lever of the force / b", "orange", x="over_roll.roll",
                        look={"dash": "dot"},
                    ),
                ),
                _over_pitch("mu", _level("mu", "mean", "ink"), _level("mu_even", _EVEN, "grey")),
            ),
            under=_UNDER,
        ),
        Chart(
            "mesh_stiffness_mean_{name}", "Mean stiffness matrix of the mesh of pair {name}",
            "Pair {name}: force on the coordinate of the row by motion along that of the column; 1 is the driver, 2 "
            "the driven gear, right-handed coordinates at each gear axis. Rotations are arcs at half the face width "
            "b and at the base radius r.",
            (
                Over(
                    Axis("motion", categories=_NAMES),
                    (Map("matrix", "place", "place", centre=lambda seen: (0.0, seen.data.mean_matrix.size),
                         numbers=True),),
                    Axis("force", categories=_NAMES), panel={"height": 2.2},
                ),
            ),
            of="mean_matrix", under=_UNDER,
        ),
    ),
    remarks=(
        Remark(
            "Pair {name}: mu = {d.means.mu:.4g} and kappa = {d.means.kappa:.4g}; contact lines of uniform stiffness, "
            "the usual assumption of the two-parameter model, would give {d.means.mu_even:.4g} and "
            "{d.means.kappa_even:.4g}."
        ),
        Remark(
            "Pair {name}: kappa is for tilting about the pitch axis. For tilting about its own axis, with the moment "
            "of the axial force, it is {d.means.kappa_driver:.4g} for the driver and "
            "{d.means.kappa_driven:.4g} for the driven gear (table of the mean matrix).",
            when="means.two_kappas",
        ),
    ),
    settings={"positions": "flanks.flanks.positions", "load": "flanks.nominal"},
)  # fmt: skip


MESH_STIFFNESS_MATRIX = Stage(
    subjects=lambda scene: wide_pairs(scene) or tuple(scene.pairs),
    inputs=Subject.of,
    compute=_compute,
    present=_SHEET.present,
    needs=needs_flanks,
    check=_check,
    cites=citing(Citation("blankenship-singh", "mesh stiffness matrix, kappa and mu", "Eqs. 2 to 7")),
    forecast=lambda _scene, _name: Forecast({}, 0.1),
    why_external="signs of rotation and tilt apply to external pairs only",
)
