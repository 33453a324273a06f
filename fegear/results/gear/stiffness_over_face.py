"""Result ``stiffness`` over the face: the table of one gear with its width, band by band.

Figures of a gear with a width: compliance over the flank, root stress along the face, the deformed tooth.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.arrays import Array, Index, first_of_largest
from fegear.base.errors import InputError
from fegear.base.printed import percent
from fegear.base.shown import declared
from fegear.case.built.solid_influence import check_source
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, drawn
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results.forecasts import RING
from fegear.results.gear.load_positions import StiffnessInputs, check_contacts_of, stiffness_inputs
from fegear.results.gear.solved_gear import needs_solid_solution
from fegear.results.gear.stiffness import COMPLIANCE_ERRORS, tolerance_remarks
from fegear.results.gear.teeth_over_holes import HOLES_FIGURE, HOLES_TABLE

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.engine.figure.figure import DeferredFigure, Figure
    from fegear.engine.figure.panel import Panel
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.plane.influence import Side
    from fegear.fem.solid.field import SolidField
    from fegear.fem.solid.table import RootStressOfBands, SolidTable
    from fegear.geometry.gear import Gear


#: Reading off one band of a solved gear, and the fixed part [s].
_SECONDS_PER_BAND, _SECONDS_OF_TABLE = 5e-3, 0.1


#: Of the picture of the deformed tooth when the case names none [N].
_USUAL_FORCE = 1e3


_SIDES: dict[Side, str] = {
    "tension": "root stress, tension side: maximum over the face width",
    "compression": "root stress, compression side: minimum over the face width",
}


def _over_positions(key: str) -> Cell:
    """A quantity that is known for each radius, in every row of it."""
    return Cell(key, si=lambda seen: np.repeat(getattr(seen.data, key), seen.data.position.size))


def _over_radii(key: str) -> Cell:
    """A quantity that is known for each face position, in every row of it."""
    return Cell(key, si=lambda seen: np.tile(getattr(seen.data, key), seen.data.radius.size))


def _flat(key: str) -> Cell:
    """A quantity of every band."""
    return Cell(key, si=lambda seen: getattr(seen.data, key).ravel())


def _root(side: Side, key: str, name: str, meaning: str = "") -> Cell:
    return Cell(
        key, of=f"root.{side}", si=lambda seen: getattr(seen.data.root[side], key).ravel(), name=name, meaning=meaning
    )


def _root_error(side: Side) -> Off:
    key = f"root_{side}"
    return Off("value", lambda seen: seen.data.errors[key].ravel(), of=f"root.{side}", name=key)


def _extreme(name: str, of: str, quantity: str, error: str, sign: float) -> Number:
    """The largest value of a quantity over all bands, or the smallest."""

    def at(seen: Seen) -> tuple[int, int]:
        values = getattr(seen.find(of), quantity)
        i, j = np.unravel_index(int(first_of_largest(sign * values)), values.shape)
        return int(i), int(j)

    def where(seen: Seen) -> str:
        (i, j), t = at(seen), seen.data
        return f"per force on a band at radius {t.radius[i] * 1e3:.6g} mm, face position {t.position[j] * 1e3:.6g} mm"

    return Number(
        quantity, lambda seen: seen.data.errors[error][at(seen)], of,
        si=lambda seen: getattr(seen.find(of), quantity)[at(seen)], name=name, meaning=where,
    )  # fmt: skip


def _compute(asked: StiffnessInputs, upstream: Upstream, _work: Work) -> SolidTable:
    from fegear.fem.solid.table import solid_table

    (influence,) = upstream.values()
    places = cast("Array", asked.positions)
    return solid_table(asked.gear, influence, asked.radii, places, asked.half_widths)


def _bands(seen: Seen) -> str:
    """Say what a band is, and what is known of it."""
    t: SolidTable = seen.data
    reach = float(max(t.before.max(), t.after.max())) * 1e3
    width = f"{t.pressed_half_width.min() * 1e3:.4g} to {t.pressed_half_width.max() * 1e3:.4g}"
    return (
        f"Gear {seen.name} over its face: each load patch is triangular along the contact line, {reach:.4g} mm to "
        "either side (shorter at the face ends). c_self is for the contact half-width; neighbours and root stress are "
        f"for a pressure half-width of {width} mm."
    )


def _missed(seen: Seen) -> list[str]:
    """Say where the tolerance is missed."""
    t: SolidTable = seen.data
    values = {"c_self": t.c_self, **{f"root_{side}": found.value for side, found in t.root.items()}}
    relative = {label: np.abs(t.errors[label] / value).max(axis=1) for label, value in values.items()}
    who = f"Gear {seen.name} over its face"
    return [
        remark for label, one in relative.items()
        for remark in tolerance_remarks(who, label, one, t.radius, seen.asked.tolerance, "radii")
    ]  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    check_contacts_of(scene, name)
    check_source(scene, name, "stiffness.source", scene.case.stiffness.source)
    wanted, half = scene.case.stiffness.face_positions, 0.5 * scene.gears[name].face_width
    for i, place in enumerate(wanted if isinstance(wanted, list) else ()):
        if abs(place) > half * (1.0 + 1e-9):
            raise InputError(
                f"stiffness.face_positions[{i}]", f"{place * 1e3:.9g} mm", f"is outside the face width of gear {name}",
                f"valid range {-half * 1e3:.6g} mm to {half * 1e3:.6g} mm from mid-face",
            )  # fmt: skip


def _subjects(scene: Scene) -> tuple[str, ...]:
    """The gear that ``[stiffness]`` names, spur or helical; every gear of the case if it names none."""
    part = scene.case.stiffness
    if part.face_positions is None:
        return ()
    return (part.gear,) if part.gear else tuple(scene.gears)


def _forecast(scene: Scene, _name: str) -> Forecast:
    part = scene.case.stiffness
    wanted = part.face_positions or 0
    places = wanted if isinstance(wanted, int) else len(wanted)
    bands = part.band_radii * places
    return Forecast({"bands": bands}, _SECONDS_OF_TABLE + _SECONDS_PER_BAND * bands)


#: Bands whose root stress is drawn along the face.
_MOST_CURVES = 5


#: Largest displacement as drawn, and depth below the root circle down to which the tooth is drawn [modules].
_DRAWN, _DEPTH = 0.25, 0.8


#: Where the scale of colours ends: this share of the nodes away from the band has less stress.
_TOP = 99.0


#: Layers of the field along the face per module, and how many at most.
_LAYERS, _MOST_LAYERS = 3.0, 60


def _deformed(seen: Seen) -> Iterator[DeferredFigure]:
    """The tooth as a usual force bends it."""
    from fegear.engine.figure.figure import DeferredFigure

    name, gear = seen.name, seen.asked.gear
    draw = partial(deformed_tooth, name, gear, seen.data, _USUAL_FORCE * gear.module / 1e-3)
    yield DeferredFigure(f"deformed_tooth_{name}", f"Deformed tooth of gear {name}", draw)


def worst_band(t: SolidTable) -> tuple[int, int]:
    """Row and column of the band that causes the largest root tension, of those with room for a pressure of full width.

    Nearer to the flank's ends bands are narrower and the stress is that of the contact.
    """
    full = t.pressed_half_width >= 0.999 * t.pressed_half_width.max()
    tension = np.where(full[:, None], t.root["tension"].value, -np.inf)
    i, j = np.unravel_index(int(first_of_largest(tension)), tension.shape)
    return int(i), int(j)


def _map(seen: Seen) -> Iterator[Figure]:
    """c_self and the largest root tension over the flank."""
    from fegear.engine.figure.figure import Figure
    from fegear.engine.figure.items import HeatMap
    from fegear.engine.figure.panel import Panel

    name, t = seen.name, seen.data
    if min(t.c_self.shape) < 2:
        return
    x, y = axis_of(t, "position"), axis_of(t, "roll_angle")
    order, sequence = np.argsort(t.roll_angle), np.argsort(t.position)
    at = drawn(t, "position")[sequence], drawn(t, "roll_angle")[order]

    def over(owner: object, attribute: str, label: str) -> Panel:
        values, unit = drawn(owner, attribute)[np.ix_(order, sequence)], declared(type(owner), attribute).unit
        return Panel(x, y, (HeatMap(*at, values, label, unit),), title=label)

    worst = float(np.max(t.errors["c_self"] / t.c_self))
    yield Figure(
        f"flank_{name}",
        f"Flank of gear {name}",
        f"Gear {name}, per force on a band: approach of the contact and maximum root stress (tension side). "
        f"Estimated error of c_0 at most {percent(worst)}.",
        (over(t, "c_self", "c_{0} of the contact"), over(t.root["tension"], "value", "largest root tension")),
        columns=2,
    )


def _bands_drawn(seen: Seen) -> list[int]:
    count = seen.data.position.size
    return np.unique(np.round(np.linspace(0, count - 1, min(count, _MOST_CURVES))).astype(int)).tolist()


def _up_fillet(side: Side, sign: float, title: str, label: str) -> Over:
    """Largest stress up a fillet along the face, at the radius of the largest tension; a curve for each band."""

    def fillet(seen: Seen) -> RootStressOfBands:
        return seen.data.root[side]

    def along(seen: Seen) -> Array:
        row, _ = worst_band(seen.data)
        return np.asarray(sign * fillet(seen).along[row, seen.one])

    def band(seen: Seen) -> str:
        return f"band at {seen.data.position[seen.one] * 1e3:.4g} mm"

    look = {"dash": "solid", "markers": False}
    line = Line("along", x="places", of=fillet, si=along, each=Family(_bands_drawn, band, most=None), look=look)
    return Over(
        "places", (line,), lambda seen: axis_of(fillet(seen), "along", label, zero=True), title=title,
        of=fillet,
    )  # fmt: skip


_OVER_FACE = Chart(
    "root_stress_over_face_{name}", "Root stress of gear {name} over the face width",
    lambda seen: f"Gear {seen.name}: maximum tangential stress in both fillets over the face width, per force on bands "
    f"at radius {seen.data.radius[worst_band(seen.data)[0]] * 1e3:.6g} mm.",
    (
        _up_fillet(
            "tension", 1.0, "Fillet of the loaded flank (tension side)", "maximum tension in the fillet"
        ),
        _up_fillet(
            "compression", -1.0, "Opposite fillet (compression side)", "maximum compression (magnitude)"
        ),
    ),
    columns=2,
)  # fmt: skip


def deformed_tooth(name: str, gear: Gear, t: SolidTable, force: float) -> Figure:
    """The loaded tooth in space under the band that causes the largest root tension, and its neighbours as a field."""
    from fegear.engine.figure.figure import Figure, SolidMeshField
    from fegear.engine.figure.items import Skin
    from fegear.engine.figure.panel import Panel
    from fegear.fem.solid.bands import bands
    from fegear.fem.solid.field import solid_field

    influence, m = t.influence, gear.module * 1e3
    i, j = worst_band(t)
    radius, place, before, after, width = (
        x / gear.module for x in (t.radius[i], t.position[j], t.before[j], t.after[j], t.pressed_half_width[i])
    )
    slope = influence.fine.line_slope(radius)[0]
    band = bands(radius, place, before, width, after=after, slope=slope)
    layers = min(max(8, round(_LAYERS * influence.width)), _MOST_LAYERS)
    fine = influence.fine
    field = solid_field(
        gear.tooth, fine.tau, influence.width, fine.poisson_ratio, fine.bore_radius, influence.settings, band,
        np.linspace(-0.5, 0.5, layers + 1) * influence.width, body=fine.body,
    )  # fmt: skip
    # Deflection x E x module over force; stress x module^2 over force.
    moved = field.displacement[0] * force / (gear.material.young_modulus * gear.module) * 1e3
    stress = field.von_mises[0] * force / gear.module**2 * 1e-6
    scale = _DRAWN * m / float(np.sqrt((moved**2).sum(axis=0)).max())
    rest = field.mesh.points * m
    skin = _skin(field)
    nodes, corners = np.unique(skin, return_inverse=True)
    fillets = np.hstack([field.sector.edges["fillet"], field.sector.edges["back_fillet"]])
    top = float(np.percentile(stress[field.mesh.nodes_of(fillets)], _TOP))
    where = f"radius {t.radius[i] * 1e3:.4g} mm, face position {t.position[j] * 1e3:.4g} mm"
    shown = Skin(
        (rest + scale * moved)[:, nodes],
        corners.reshape(skin.shape),
        stress[nodes],
        top,
        "von Mises stress",
        "MPa",
        floor=(gear.tooth.root_radius - _DEPTH) * m,
    )
    camera = ((0.9, 0.75, 1.3), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    holed = fine.body is not None and fine.body.holes is not None
    holes = " Web holes are neglected here." if holed else ""
    return Figure(
        f"deformed_tooth_{name}",
        f"Deformed tooth of gear {name}",
        f"Gear {name} under {force:.4g} N on a band ({where}), displacements scaled by {scale:.3g}. Colour scale "
        f"limited to {top:.3g} MPa; stress under the band is higher.{holes}",
        (Panel(Axis(), Axis(), (shown,), height=1.5, camera=camera),),
        field=SolidMeshField(f"{name}_tooth", rest, field.mesh.wedges, {"displacement": moved.T, "von_mises": stress}),
        under=f"{force:.4g} N",
    )


def _skin(field: SolidField) -> Index:
    """Triangles of the tooth's outline along the face and of both its ends, shape (3, M)."""
    mesh, sector = field.mesh, field.sector
    free = [edges for key, edges in sector.edges.items() if key not in ("bore", "side_a", "side_b")]
    a, b, c, d, low, right, up, left = mesh.faces(np.hstack(free)).reshape(8, -1)
    strips = [(a, low, left), (low, up, left), (up, d, left), (low, b, right), (low, right, up), (right, c, up)]
    t = sector.triangles
    four = np.hstack([t[[i, j, k]] for i, j, k in ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))])
    ends = [mesh.at_station(four, station) for station in (0, mesh.layers)]
    return np.hstack([*(np.stack(strip) for strip in strips), *ends])


_SHEET = Sheet(
    tables=(
        Rows(
            "stiffness_over_face_{name}",
            "Compliance and root stress of gear {name} over the face width, per force on a band",
            (
                *map(_over_positions, ("radius", "roll_angle")), _over_radii("position"),
                *map(_flat, ("c_self", "c_prev", "c_next")),
                *map(_over_positions, ("half_width", "pressed_half_width")), *map(_over_radii, ("before", "after")),
                *(
                    _root(side, key, f"root_{side}" + ("" if key == "value" else f"_{key}"),
                          meaning if key == "value" else "")
                    for side, meaning in _SIDES.items() for key in ("value", "position", "radius", "axial", "shear")
                ),
                *COMPLIANCE_ERRORS,
                *map(_root_error, _SIDES),
            ),
        ),
        HOLES_TABLE,
    ),
    values=(
        _extreme("largest_band_c_self", "", "c_self", "c_self", 1.0),
        _extreme("smallest_band_c_self", "", "c_self", "c_self", -1.0),
        _extreme("largest_band_root_tension", "root.tension", "value", "root_tension", 1.0),
        _extreme("largest_band_root_compression", "root.compression", "value", "root_compression", -1.0),
    ),
    figures=(_map, _OVER_FACE, _deformed, HOLES_FIGURE),
    remarks=(
        Remark(_bands),
        Remark(
            "Gear {name} over its face: coupled slices of its plane section are used instead of the solid; errors are "
            "their largest on solid gears.",
            when=lambda seen: seen.data.influence.settings.source != "solid",
        ),
        _missed,
        lambda seen: seen.asked.assumed,
    ),
    answer=Answer(
        "Gear {name}, force on one band of the flank: self-compliance {v[smallest_band_c_self]} to "
        "{v[largest_band_c_self]}.",
        "Gear {name}: root stress, tension side, at most {v[largest_band_root_tension]} of force on one band.",
        figure="flank_{name}",
    ),
)  # fmt: skip


SOLID_STIFFNESS = Stage(
    subjects=_subjects,
    needs=lambda _scene, name: needs_solid_solution(name),
    inputs=stiffness_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(*RING, Citation("iso-21771", "transverse section, rotated along the face width")),
    forecast=_forecast,
)
