"""Figures of a gear with a width: compliance over the flank, root stress along the face, the deformed tooth."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, DeferredFigure, Figure, HeatMap, Panel, Skin, SolidMeshField

if TYPE_CHECKING:
    from fegear.arrays import Index
    from fegear.fem.solid.field import SolidField
    from fegear.fem.solid.table import SolidTable
    from fegear.geometry import Gear

#: Bands whose root stress is drawn along the face.
_MOST_CURVES = 5
#: Largest displacement as drawn, and depth below the root circle down to which the tooth is drawn [modules].
_DRAWN, _DEPTH = 0.25, 0.8
#: Where the scale of colours ends: this share of the nodes away from the band has less stress.
_TOP = 99.0
#: Layers of the field along the face per module, and how many at most.
_LAYERS, _MOST_LAYERS = 3.0, 60


def solid_figures(name: str, gear: Gear, t: SolidTable, force: float) -> tuple[Figure | DeferredFigure, ...]:
    """Describe all figures of a solid gear's table; `force` [N] is that of the deformed tooth."""
    title = f"Deformed tooth of gear {name}"
    deformed = DeferredFigure(f"deformed_tooth_{name}", title, partial(deformed_tooth, name, gear, t, force))
    return (*((_map(name, t),) if min(t.c_self.shape) > 1 else ()), _along(name, t), deformed)


def worst_band(t: SolidTable) -> tuple[int, int]:
    """Row and column of the band that causes the largest root tension, of those with room for a pressure of full width.

    Nearer to the flank's ends bands are narrower and the stress is that of the contact.
    """
    full = t.pressed_half_width >= 0.999 * t.pressed_half_width.max()
    tension = np.where(full[:, None], t.root["tension"].value, -np.inf)
    i, j = np.unravel_index(int(np.argmax(tension)), tension.shape)
    return int(i), int(j)


def _map(name: str, t: SolidTable) -> Figure:
    """c_self and the largest root tension over the flank."""
    x, y = Axis("face position", "mm"), Axis("roll angle of the load", "deg")
    order, sequence = np.argsort(t.roll_angle), np.argsort(t.position)
    at = t.position[sequence] * 1e3, np.rad2deg(t.roll_angle[order])

    def over(values: np.ndarray, label: str, unit: str) -> Panel:
        return Panel(x, y, (HeatMap(*at, values[np.ix_(order, sequence)], label, unit),), title=label)

    worst = float(np.max(t.errors["c_self"] / t.c_self))
    return Figure(
        f"flank_{name}",
        f"Flank of gear {name}",
        f"Gear {name}, per force on a band: approach of the contact, and the largest tension that it causes in the "
        f"fillet. Estimated error of c_0 at most {worst:.1e} of it.",
        (
            over(t.c_self * 1e6, "c_{0} of the contact", "um/N"),
            over(t.root["tension"].value * 1e-6, "largest root tension", "MPa/N"),
        ),
        columns=2,
    )


def _along(name: str, t: SolidTable) -> Figure:
    """Largest stress up each fillet along the face, at the radius of the largest tension."""
    row, _ = worst_band(t)
    count = t.position.size
    chosen = np.unique(np.round(np.linspace(0, count - 1, min(count, _MOST_CURVES))).astype(int))
    panels = []
    for side, sign, title in (
        ("tension", 1.0, "Fillet below the loaded flank"),
        ("compression", -1.0, "Fillet of the other flank"),
    ):
        found = t.root[side]  # type: ignore[index]
        curves = tuple(
            Curve(found.places * 1e3, sign * found.along[row, j] * 1e-6, f"band at {t.position[j] * 1e3:.4g} mm",
                  f"series:{i}", dash="solid", markers=False)
            for i, j in enumerate(chosen)
        )  # fmt: skip
        label = "largest tension up the fillet" if side == "tension" else "largest compression (magnitude)"
        panels.append(Panel(Axis("face position", "mm"), Axis(label, "MPa/N", zero=True), curves, title=title))
    return Figure(
        f"root_stress_over_face_{name}",
        f"Root stress of gear {name} along its face",
        f"Gear {name}: largest tangential stress up each fillet along the face, per force on bands at radius "
        f"{t.radius[row] * 1e3:.6g} mm.",
        tuple(panels),
        columns=2,
    )


def deformed_tooth(name: str, gear: Gear, t: SolidTable, force: float) -> Figure:
    """The loaded tooth in space under the band that causes the largest root tension, and its neighbours as a field."""
    from fegear.fem.solid import bands
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
        np.linspace(-0.5, 0.5, layers + 1) * influence.width,
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
    return Figure(
        f"deformed_tooth_{name}",
        f"Deformed tooth of gear {name}",
        f"Gear {name} under {force:.4g} N on a band ({where}), displacements "
        f"{scale:.3g} times as large. The colour scale ends at {top:.3g} MPa; under the band the stress is higher.",
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
