"""Figures of the tooth contact of helical pairs: transmission error, contact pattern, ellipses, flanks in space."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.colours import ROLES
from fegear.engine.figure import Axis, Curve, DeferredFigure, Figure, Panel, Points, Spot, Surface, outline, polylines

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.helical.bearing import Bearing
    from fegear.helical.contact import ToothContact


_ARCSEC = 648000.0 / math.pi
_PHI = Axis("pinion angle φ_{1}", "deg")
#: Ellipses drawn in a contact pattern.
_ELLIPSES = 12
#: Flanks drawn on either side of the one in the middle, and points along and across each.
_BESIDE, _ALONG, _ACROSS = 2, 41, 25
#: Least room above and below a transmission error [arcsec].
_LEAST_ROOM = 1e-3


def tooth_contact_figures(
    name: str, contact: ToothContact, bearing: Bearing | None, load: float | None
) -> tuple[Figure | DeferredFigure, ...]:
    """Describe all figures of one pair."""
    ellipses = (_ellipses(name, contact, bearing, load),) if bearing is not None and load is not None else ()
    flanks = DeferredFigure(f"flanks_{name}", f"Teeth of pair {name} in mesh", partial(_flanks, name, contact))
    return _transmission_error(name, contact), _pattern(name, contact, bearing, load), *ellipses, flanks


def _transmission_error(name: str, contact: ToothContact) -> Figure:
    """Over two cycles with each tooth pair on its own, and that of one pair alone."""
    pitch, single = contact.pair.pinion.angular_pitch, contact.single
    numbers, inside = np.unique(contact.leader), single.kind != "none"
    first, last = contact.phi_1[0], contact.phi_1[0] + 2.0 * pitch
    alone = []
    for k in range(int(numbers.min()) - 2, int(numbers.max()) + 4):
        phi = single.phi_1[inside] + k * pitch
        shown = (phi >= first) & (phi <= last)
        alone.append(np.stack([np.degrees(phi[shown]), single.error[inside][shown] * _ARCSEC]))
    curves = [outline(polylines(alone), "one pair alone", "grey", 1.0)]
    for turn in (0, 1):
        for k in numbers:
            error = np.where(contact.leader == k, contact.error * _ARCSEC, np.nan)
            label, role = f"pair {k + turn} leads", f"series:{int(k + turn) % 6}"
            phi = np.degrees(contact.phi_1 + turn * pitch)
            curves.append(Curve(phi, error, label, role, dash="solid", markers=False))
    low, high = float(contact.error.min()) * _ARCSEC, float(contact.error.max()) * _ARCSEC
    room = max(0.6 * (high - low), _LEAST_ROOM)
    axis = Axis("transmission error Δφ_{2}", "arcsec", limits=(low - room, high + 0.5 * room))
    ends = (math.degrees(first), math.degrees(last))
    return Figure(
        f"transmission_error_{name}",
        f"Transmission error of pair {name}",
        f"Pair {name}: turn of the gear ahead of N1/N2 times the pinion's, over two cycles. The pair that touches "
        f"first leads. Peak to peak {contact.peak_to_peak * _ARCSEC:.4g} arcsec.",
        (Panel(Axis(_PHI.label, _PHI.unit, limits=ends), axis, tuple(curves)),),
    )


def _pattern(name: str, contact: ToothContact, bearing: Bearing | None, load: float | None) -> Figure:
    """The path of contact of one pair on both flanks, by kind of contact, with ellipses where there are any."""
    pair, single = contact.pair, contact.single
    kinds = [str(kind) for kind in dict.fromkeys(single.kind) if kind != "none"]
    panels: list[Panel] = []
    for gear, z, r, centre, which in (
        (pair.cut_pinion, single.z1, single.r1, 0.0, "pinion"),
        (pair.gear, single.z2, single.r2, pair.axial_offset, "gear"),
    ):
        half = 0.5 * gear.face_width
        low, high = gear.form_radius, gear.involute_tip_radius
        width = centre + half * np.array([-1.0, 1.0, 1.0, -1.0, -1.0])
        side = np.stack([width, np.array([low, low, high, high, low])])
        items: list[Curve | Points] = [outline(side * 1e3, "", "ink", 1.0)]
        for number, kind in enumerate(kinds):
            here = single.kind == kind
            notes = tuple(f"{kind}, φ_{{1}} = {math.degrees(phi):.4g}°" for phi in single.phi_1[here])
            role = kind if kind in ROLES else f"series:{number}"
            items.append(Points(z[here] * 1e3, r[here] * 1e3, kind, role, size=4.5, notes=notes))
        if bearing is not None and not panels:
            cut = np.clip(_outlines(contact, bearing), side.min(axis=1)[:, None] * 1e3, side.max(axis=1)[:, None] * 1e3)
            items.append(outline(cut, "contact ellipses", "grey", 0.8))
        panels.append(Panel(Axis(f"height z on the {which}", "mm"), Axis(f"radius on the {which}", "mm"), tuple(items)))
    vague = bool(single.ill_defined[single.kind == "surface"].any())
    return Figure(
        f"contact_pattern_{name}",
        f"Contact pattern of pair {name}",
        f"Pair {name}: where one tooth pair touches over its engagement, by kind of contact."
        + (
            " Ellipses: contact under the load of the case, cut at the ends of the flank."
            if bearing is not None
            else ""
        )
        + (" The flanks touch along lines: the place of the point on them is arbitrary." if vague else ""),
        tuple(panels),
        columns=2,
        under=f"{load:.4g} N" if bearing is not None and load is not None else "",
    )


def _outlines(contact: ToothContact, bearing: Bearing) -> Array:
    """Up to a dozen ellipses in height and radius [mm]; the flank is seen from the side, not developed."""
    angle, found = np.linspace(0.0, 2.0 * np.pi, 181), []
    for k in np.unique(np.linspace(0, bearing.index.size - 1, _ELLIPSES).astype(int)):
        centre = contact.mesh.point[:, bearing.index[k], None]
        long = bearing.ellipse.long[k] * bearing.long_axis[:, k, None] * np.cos(angle)
        short = bearing.ellipse.short[k] * bearing.short_axis[:, k, None] * np.sin(angle)
        x, y, z = (centre + long + short) * 1e3
        found.append(np.stack([z, np.hypot(x, y)]))
    return polylines(found)


def _ellipses(name: str, contact: ToothContact, bearing: Bearing, load: float) -> Figure:
    phi, e = np.degrees(contact.phi_1[bearing.index]), bearing.ellipse
    pressure = Points(phi, e.pressure * 1e-6, "pressure", "red", size=4.0)
    return Figure(
        f"contact_ellipses_{name}",
        f"Contact ellipses of pair {name}",
        f"Pair {name}: contact ellipses where the flanks touch on their surfaces, one pair carrying {load:.4g} N.",
        (
            Panel(_PHI, Axis("half axes", "mm", zero=True), (
                Points(phi, e.long * 1e3, "long half axis", "blue", size=4.0),
                Points(phi, e.short * 1e3, "short half axis", "orange", size=4.0),
            )),
            Panel(_PHI, Axis("largest pressure", "MPa"), (pressure,)),
        ),
        under=f"{load:.4g} N",
    )  # fmt: skip


def _flanks(name: str, contact: ToothContact) -> Figure:
    """The flanks in mesh in space, with the earliest contact in the middle of the cycle."""
    middle = contact.phi_1.size // 2
    phi_1 = float(contact.phi_1[middle])
    phi_2 = float(contact.error[middle]) + contact.pair.ratio * phi_1
    spot = Spot(contact.mesh.point[:, middle] * 1e3, "red", "earliest contact")
    pitch, width = contact.pair.cut_pinion.pitch_radius * 1e3, contact.pair.pinion.face_width * 1e3
    camera = ((pitch - 1.2 * width, -2.2 * width, 1.8 * width), (pitch, 0.0, 0.0), (0.0, 0.0, 1.0))
    items: tuple[Surface | Spot, ...] = (*_surfaces(contact, phi_1, phi_2), spot)
    return Figure(
        f"flanks_{name}",
        f"Teeth of pair {name} in mesh",
        f"Pair {name}: teeth of pinion and gear in mesh, in the pinion's frame at rest; the red point is the earliest "
        "contact. Below the form circles the teeth are not drawn.",
        (Panel(Axis(), Axis(), items, height=1.25, camera=camera),),
    )


def _surfaces(contact: ToothContact, phi_1: float, phi_2: float) -> list[Surface]:
    """Some teeth of pinion and gear in the fixed frame [mm], from the form circle to the tip."""
    pair, flank, helicoid = contact.pair, contact.pair.flank, contact.pair.mating_flank
    a, b, g = pair.cut_pinion, pair.gear, pair.errors.shaft_angle
    along = np.linspace(-0.5, 0.5, _ALONG)
    s, z = np.meshgrid(np.linspace(flank.s_form, flank.s_tip, _ACROSS), along * a.face_width)
    found = []
    for k in range(-_BESIDE, _BESIDE + 1):
        turn = phi_1 - k * a.angular_pitch
        for x, y, z1 in solid_tooth(flank.points(s, z), a.twist * z - 0.5 * a.angular_pitch):
            x1, y1 = np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y
            found.append(Surface(np.stack([x1, y1, z1]) * 1e3, "blue", name="pinion"))
    r = np.linspace(max(b.form_radius, b.base_radius * (1.0 + 1e-9)), b.involute_tip_radius, _ACROSS)
    t, z = np.meshgrid(helicoid.tangent_length(r), along * b.face_width + pair.axial_offset)
    for k in range(-_BESIDE, _BESIDE + 1):
        turn = phi_2 - k * b.angular_pitch
        for x, y, z2 in solid_tooth(helicoid.points(t, z), b.twist * z):
            x2, y2 = np.cos(turn) * x + np.sin(turn) * y, -np.sin(turn) * x + np.cos(turn) * y
            fixed = pair.centre_distance - x2, -y2 * np.cos(g) - z2 * np.sin(g), z2 * np.cos(g) - y2 * np.sin(g)
            found.append(Surface(np.stack(fixed) * 1e3, "orange", 0.6, "gear"))
    return found


def solid_tooth(flank: Array, middle: Array) -> list[Array]:
    """A tooth from a flank, shape (3, along, across), and the azimuth of its middle: flanks with top land, and ends."""
    x, y, z = flank
    c, s = np.cos(2.0 * middle), np.sin(2.0 * middle)
    other = np.stack([c * x + s * y, s * x - c * y, z])
    ends = [np.stack([flank[:, end], other[:, end]], axis=1) for end in (0, -1)]
    return [np.concatenate([flank, other[:, :, ::-1]], axis=2), *ends]
