"""Tooth contact of helical pairs: transmission error, contact pattern, bearing ellipses, flanks in mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.output.pictures.deformed import offscreen_pyvista
from fegear.output.pictures.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    YELLOW,
    Picture,
    figure,
    in_house_style,
    legend_above,
    save,
)

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from fegear.helical.bearing import Bearing
    from fegear.helical.contact import PairContact, ToothContact

    Array = NDArray[np.float64]

_ARCSEC = 648000.0 / np.pi
_COLOURS = {
    "surface": GREEN,
    "gear tip": BLUE,
    "pinion tip": SKY,
    "gear face end": ORANGE,
    "pinion face end": RED,
    "corner": PURPLE,
}
_MARKERS = {"surface": "o", "gear tip": "^", "pinion tip": "v", "gear face end": "s", "pinion face end": "D"}
_PAIRS = (BLUE, ORANGE, GREEN, RED, PURPLE, SKY)


@in_house_style
def draw_transmission_error(contact: ToothContact, path: Path, name: str) -> Picture:
    """Draw the transmission error over two cycles with tooth pairs told apart, and that of one pair alone."""
    pitch = contact.pair.pinion.angular_pitch
    made, axes = figure(size=(7.6, 4.4))
    numbers = np.unique(contact.leader)
    single = contact.single
    inside = single.kind != "none"
    first, last = contact.phi_1[0], contact.phi_1[0] + 2.0 * pitch
    for k in range(int(numbers.min()) - 2, int(numbers.max()) + 4):
        phi = single.phi_1[inside] + k * pitch
        shown = (phi >= first) & (phi <= last)
        label = "one pair alone" if k == int(numbers.min()) else None
        axes.plot(np.degrees(phi[shown]), single.error[inside][shown] * _ARCSEC, color="0.75", lw=1.0, label=label)
    for turn in (0, 1):
        for k in numbers:
            phi, error = contact.phi_1.copy(), contact.error * _ARCSEC
            error = np.where(contact.leader == k, error, np.nan)
            colour = _PAIRS[int(k + turn) % len(_PAIRS)]
            label = f"pair {k + turn} leads" if not turn or k == numbers[-1] else None
            axes.plot(np.degrees(phi + turn * pitch), error, color=colour, label=label)
    low, high = float(contact.error.min()) * _ARCSEC, float(contact.error.max()) * _ARCSEC
    room = max(0.6 * (high - low), 1e-3)
    axes.set_ylim(low - room, high + 0.5 * room)
    axes.set_xlabel("pinion angle $\\phi_1$ [deg]")
    axes.set_ylabel("transmission error $\\Delta\\phi_2$ [arcsec]")
    legend_above(axes, 5)
    caption = (
        f"Pair {name}: turn of the gear ahead of N1/N2 times the pinion's, over two cycles. The pair that touches "
        f"first leads. Peak to peak {contact.peak_to_peak * _ARCSEC:.4g} arcsec."
    )
    return save(made, path, f"Transmission error of pair {name}", caption)


def _flank_outline(axes: Axes, r: tuple[float, float], width: float, centre: float = 0.0) -> None:
    z0, z1 = 1e3 * (centre - 0.5 * width), 1e3 * (centre + 0.5 * width)
    lo, hi = 1e3 * r[0], 1e3 * r[1]
    axes.plot([z0, z1, z1, z0, z0], [lo, lo, hi, hi, lo], color=BLACK, lw=1.0)


def _points(axes: Axes, contact: PairContact, z: Array, r: Array, kinds: list[str]) -> None:
    for kind in kinds:
        here = contact.kind == kind
        axes.plot(
            z[here] * 1e3, r[here] * 1e3, _MARKERS.get(kind, "x"), color=_COLOURS.get(kind, YELLOW), ms=3.5, label=kind
        )


@in_house_style
def draw_contact_pattern(contact: ToothContact, path: Path, name: str, bearing: Bearing | None = None) -> Picture:
    """Draw the path of contact of one pair on both flanks, by kind of contact, with ellipses where there are any."""
    pair, single = contact.pair, contact.single
    kinds = [str(k) for k in dict.fromkeys(single.kind) if k != "none"]
    made, both = figure(1, 2, size=(10.4, 4.4))
    a, b = pair.cut_pinion, pair.gear
    for axes, gear, z, r, centre, title in (
        (both[0], a, single.z1, single.r1, 0.0, "Pinion flank"),
        (both[1], b, single.z2, single.r2, pair.axial_offset, "Gear flank"),
    ):
        _flank_outline(axes, (gear.form_radius, gear.tip_radius), gear.face_width, centre)
        _points(axes, single, z, r, kinds)
        axes.set_title(title)
        axes.set_xlabel("height z [mm]")
        axes.set_ylabel("radius [mm]")
    if bearing is not None:
        _draw_ellipses(both[0], contact.mesh, bearing)
    both[0].legend(fontsize=8, loc="best")
    vague = bool(single.ill_defined[single.kind == "surface"].any())
    caption = (
        f"Pair {name}: where one tooth pair touches over its engagement, by kind of contact."
        + (" Ellipses: contact under the load of the case." if bearing is not None else "")
        + (" The flanks touch along lines: the place of the point on them is arbitrary." if vague else "")
    )
    return save(made, path, f"Contact pattern of pair {name}", caption)


def _draw_ellipses(axes: Axes, contact: PairContact, bearing: Bearing) -> None:
    """Outline up to a dozen ellipses in radius and height; the flank is seen from the side, not developed."""
    chosen = np.unique(np.linspace(0, bearing.index.size - 1, 12).astype(int))
    angle = np.linspace(0.0, 2.0 * np.pi, 61)
    for k in chosen:
        centre = contact.point[:, bearing.index[k], None]
        long = bearing.ellipse.long[k] * bearing.long_axis[:, k, None] * np.cos(angle)
        short = bearing.ellipse.short[k] * bearing.short_axis[:, k, None] * np.sin(angle)
        x, y, z = centre + long + short
        axes.plot(z * 1e3, np.hypot(x, y) * 1e3, color="0.35", lw=0.8)


@in_house_style
def draw_bearing(contact: ToothContact, bearing: Bearing, path: Path, name: str, load: float) -> Picture:
    """Draw the half axes and the pressure of the contact ellipses over the cycle."""
    made, (top, bottom) = figure(2, 1, size=(7.2, 5.2), sharex=True)
    phi = np.degrees(contact.phi_1[bearing.index])
    order = np.argsort(phi)
    top.plot(phi[order], bearing.ellipse.long[order] * 1e3, ".", color=BLUE, label="long half axis")
    top.plot(phi[order], bearing.ellipse.short[order] * 1e3, ".", color=ORANGE, label="short half axis")
    top.set_ylabel("half axes [mm]")
    top.set_ylim(bottom=0.0)
    top.legend(fontsize=9)
    bottom.plot(phi[order], bearing.ellipse.pressure[order] * 1e-6, ".", color=RED)
    middle = 1e-6 * float(bearing.ellipse.pressure.mean())
    if np.ptp(bearing.ellipse.pressure) < 1e-3 * float(bearing.ellipse.pressure.mean()):
        bottom.set_ylim(0.95 * middle, 1.05 * middle)  # as good as constant: its last digits say nothing
    bottom.set_ylabel("largest pressure [MPa]")
    bottom.set_xlabel("pinion angle $\\phi_1$ [deg]")
    caption = f"Pair {name}: contact ellipses where the flanks touch on their surfaces, one pair carrying {load:.4g} N."
    return save(made, path, f"Contact ellipses of pair {name}", caption)


def _tooth_surfaces(pv: Any, contact: ToothContact, phi_1: float, phi_2: float) -> list[tuple[Any, str]]:
    """Grids of some pinion and gear flanks in the fixed frame [mm]."""
    pair, flank, helicoid = contact.pair, contact.pair.flank, contact.pair.mating_flank
    a, b, g = pair.cut_pinion, pair.gear, pair.errors.shaft_angle
    s, z = np.meshgrid(np.linspace(flank.s_form, flank.s_tip, 25), np.linspace(-0.5, 0.5, 41) * a.face_width)
    grids = []
    for k in range(-2, 3):
        turn = phi_1 - k * a.angular_pitch
        x, y, z1 = flank.points(s, z)
        x, y = np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y
        grids.append((pv.StructuredGrid(x * 1e3, y * 1e3, z1 * 1e3), BLUE))
    r = np.linspace(max(b.form_radius, b.base_radius * (1.0 + 1e-9)), b.tip_radius, 25)
    t, z = np.meshgrid(helicoid.tangent_length(r), np.linspace(-0.5, 0.5, 41) * b.face_width + pair.axial_offset)
    for k in range(-2, 3):
        turn = phi_2 - k * b.angular_pitch
        x, y, z2 = helicoid.points(t, z)
        x, y = np.cos(turn) * x + np.sin(turn) * y, -np.sin(turn) * x + np.cos(turn) * y
        xf, yf = pair.centre_distance - x, -y * np.cos(g) - z2 * np.sin(g)
        grids.append((pv.StructuredGrid(xf * 1e3, yf * 1e3, (z2 * np.cos(g) - y * np.sin(g)) * 1e3), ORANGE))
    return grids


@in_house_style
def draw_flanks(contact: ToothContact, path: Path, name: str) -> Picture:
    """Draw the flanks in mesh in space with the points where one pair touches over its engagement."""
    pv = offscreen_pyvista()
    middle = contact.phi_1.size // 2
    phi_1 = float(contact.phi_1[middle])
    phi_2 = float(contact.error[middle]) + contact.pair.ratio * phi_1
    plotter = pv.Plotter(off_screen=True, window_size=(1400, 900))
    plotter.set_background("white")
    for grid, colour in _tooth_surfaces(pv, contact, phi_1, phi_2):
        opacity = 1.0 if colour == BLUE else 0.6
        plotter.add_mesh(grid, color=colour, opacity=opacity, ambient=0.5, diffuse=0.5)
        outline = grid.extract_feature_edges(
            boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
        )
        plotter.add_mesh(outline, color=BLACK, line_width=2)
    plotter.add_mesh(
        pv.PolyData(contact.mesh.point[:, middle] * 1e3), color=RED, point_size=16.0, render_points_as_spheres=True
    )
    pitch = contact.pair.cut_pinion.pitch_radius * 1e3
    width = contact.pair.pinion.face_width * 1e3
    plotter.camera.focal_point = (pitch, 0.0, 0.0)
    plotter.camera.position = (pitch - 1.2 * width, -2.2 * width, 1.8 * width)
    plotter.camera.up = (0.0, 0.0, 1.0)
    plotter.reset_camera_clipping_range()
    image = plotter.screenshot(return_img=True)
    plotter.close()
    made, axes = figure(size=(8.4, 5.4))
    axes.imshow(image)
    axes.set_axis_off()
    caption = (
        f"Pair {name}: pinion flanks (blue) and gear flanks (orange) in mesh; the red point is the earliest contact."
    )
    return save(made, path, f"Flanks of pair {name} in mesh", caption)
