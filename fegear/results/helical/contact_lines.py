"""Stage ``contact-lines``: the lines along which the flanks of an aligned helical pair touch, and their length.

Figures of the contact lines of helical pairs: on both flanks, in space, and their total length over a cycle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from fegear.base.arrays import Array
from fegear.case.reading import Scene
from fegear.contact.unloaded.contact_lines import LineContact, LineLength
from fegear.contact.unloaded.pair import HelicalPair
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_of, columns_of, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.figure.items import Curve, Mark, Surface, outline, ramp
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.helicoid import InvoluteHelicoid
from fegear.results.helical.drawn_tooth_contact import solid_tooth
from fegear.results.helical.tooth_contact import check_misalignment


@dataclass(frozen=True, slots=True)
class ContactLinesInputs:
    """What the lines depend on.

    Parameters
    ----------
    pair : HelicalPair
        Aligned, flanks as designed.
    positions : int
        Pinion angles over a cycle.
    left_out : bool
        Whether the case has errors or a modification that the lines do without.
    name : str
        Of the pair.
    """

    pair: HelicalPair
    positions: int
    left_out: bool = field(compare=False)
    name: str = field(compare=False)


@dataclass(frozen=True, slots=True)
class ContactLinesData:
    """Lines of one tooth pair, and the length of all of them over a cycle."""

    pair: HelicalPair
    lines: LineContact
    length: LineLength


def _inputs(scene: Scene, name: str) -> ContactLinesInputs:
    from fegear.contact.unloaded.contact_lines import aligned

    given = scene.helical_pairs[name]
    pair = aligned(given)
    return ContactLinesInputs(pair, scene.case.tooth_contact.positions, pair != given, name)


def _compute(asked: ContactLinesInputs, _upstream: Upstream, _work: Work) -> ContactLinesData:
    from fegear.contact.unloaded.contact_lines import contact_lines, line_length

    return ContactLinesData(asked.pair, contact_lines(asked.pair), line_length(asked.pair, asked.positions))


def _lines_table(name: str, found: LineContact) -> Table:
    number = np.repeat(np.arange(1, found.phi_1.shape[0] + 1), found.phi_1.shape[1])
    given = ("phi_1", "u_1", "theta_1", "u_2", "theta_2", "phi_2", "z", "r_1", "r_2")
    columns = (column_of(found, key, getattr(found, key).ravel()) for key in given)
    # The line of a spur gear is parallel to its base helix: it has no length from there.
    finite = [column for column in columns if np.isfinite(column.si).all()]
    return Table(
        f"contact_lines_{name}",
        (Column("line", number, "", "number of the line"), *finite),
        f"Contact lines of pair {name}",
    )


def _present(data: ContactLinesData, asked: ContactLinesInputs) -> Outcome:
    name, pair, length = asked.name, data.pair, data.length
    tables = (
        _lines_table(name, data.lines),
        Table(
            f"contact_line_length_{name}",
            columns_of(length, table="cycle"),
            f"Total length of the contact lines of pair {name}",
        ),
    )
    play = float((data.lines.phi_2 - pair.ratio * data.lines.phi_1).mean())
    values = (
        *(value_of(length, key, name, 0.0) for key in ("mean", "least", "largest")),
        Value(
            f"{name}.aligned_transmission_error", play, "arcsec", 1e-15, "of the aligned pair, the same at all angles"
        ),
    )
    remarks = []
    if asked.left_out:
        remarks.append(
            f"Pair {name}: contact lines are those of the aligned pair with flanks as designed; errors of the case "
            "other than that of the centre distance, and its modification, leave points in place of lines."
        )
    if pair.pinion.helix_angle == 0.0:
        remarks.append(f"Pair {name}: lines of a spur gear are parallel to its axis, so that u1 and u2 do not exist.")
    figures = contact_lines_figures(name, data.pair, data.lines, length)
    return Outcome(data, tables, values, {"positions": asked.positions}, tuple(remarks), figures, sharper_by="")


#: Width of a line drawn on a tooth in space, over the face width, and its height above the flank, over its width.
_RIBBON, _LIFT = 0.014, 0.2


#: Points of a drawn flank along and across.
_ALONG, _ACROSS = 41, 25


def contact_lines_figures(
    name: str, pair: HelicalPair, lines: LineContact, length: LineLength
) -> tuple[Figure | DeferredFigure, ...]:
    """Describe all figures of one pair."""
    title = f"Contact lines on the teeth of pair {name}"
    space = DeferredFigure(f"contact_lines_on_teeth_{name}", title, partial(_on_teeth, name, pair, lines, title))
    return _on_flanks(name, pair, lines), space, _length(name, length)


def _on_flanks(name: str, pair: HelicalPair, lines: LineContact) -> Figure:
    """Each line over height and radius of either flank, seen from the side."""
    panels = []
    for gear, radius, centre, which in (
        (pair.pinion, lines.r_1, 0.0, "pinion"),
        (pair.gear, lines.r_2, pair.axial_offset, "gear"),
    ):
        half, low, high = 0.5 * gear.face_width, gear.form_radius, gear.tip_radius
        width = centre + half * np.array([-1.0, 1.0, 1.0, -1.0, -1.0])
        side = np.stack([width, np.array([low, low, high, high, low])])
        items = [outline(side * 1e3, "", "ink", 1.0)]
        roles = ramp(len(lines.z))
        for k, (z, r) in enumerate(zip(lines.z, radius, strict=True)):
            shown = k in (0, len(lines.z) - 1)
            label = f"φ_{{1}} = {math.degrees(lines.phi_1[k, 0]):.3g}°" if shown else ""
            items.append(Curve(z * 1e3, r * 1e3, label, roles[k], dash="solid", width=1.6, markers=False))
        panels.append(Panel(Axis(f"height z on the {which}", "mm"), Axis(f"radius on the {which}", "mm"), tuple(items)))
    return Figure(
        f"contact_lines_{name}",
        f"Contact lines of pair {name}",
        f"Pair {name}, aligned: lines along which one tooth pair touches, at even steps of the pinion angle. They are "
        "straight in space, tangent to the base helix; over the radius they bend.",
        tuple(panels),
        columns=2,
    )


def _on_teeth(name: str, pair: HelicalPair, lines: LineContact, title: str) -> Figure:
    """A tooth of the pinion and one of the gear side by side, with the lines on their flanks."""
    panels = []
    for gear, axis, t, which in ((pair.pinion, "space", lines.t_1, "pinion"), (pair.gear, "tooth", lines.t_2, "gear")):
        flank = InvoluteHelicoid.of(gear, axis)  # type: ignore[arg-type]
        r = np.linspace(max(gear.form_radius, gear.base_radius * (1.0 + 1e-9)), gear.tip_radius, _ACROSS)
        shift = pair.axial_offset if which == "gear" else 0.0
        along = shift + np.linspace(-0.5, 0.5, _ALONG) * gear.face_width
        tangents, z = np.meshgrid(flank.tangent_length(r), along)
        middle = gear.twist * z - (0.5 * gear.angular_pitch if which == "pinion" else 0.0)
        tooth = solid_tooth(flank.points(tangents, z), middle)
        items = [Surface(_turned(part), "grey", name="tooth") for part in tooth]
        ribbons = _ribbons(flank, t, lines.z, gear.face_width)
        items += [Surface(_turned(part), "red", name="contact lines") for part in ribbons]
        # Seen against the flank's normal, from above tip and face end.
        spot = flank.tangent_length(gear.pitch_radius)
        centre = _turned(flank.points(spot, shift))
        eye = centre + gear.face_width * _turned(1.6 * flank.normals(spot, shift) + np.array([1.0, 0.0, 1.0]))
        camera = (tuple(eye.tolist()), tuple(centre.tolist()), (0.0, 0.0, 1.0))
        panels.append(Panel(Axis(), Axis(), tuple(items), title=which, height=1.25, camera=camera))
    return Figure(
        f"contact_lines_on_teeth_{name}", title,
        f"Pair {name}: the straight lines along which pinion and gear touch one after the other, on a tooth of either.",
        tuple(panels), columns=2,
    )  # fmt: skip


def _turned(points: Array) -> Array:
    """Points (3, ...) of a gear that has been turned by half a turn, so that its flank is on the near side [mm]."""
    return np.stack([-points[0], -points[1], points[2]]) * 1e3


def _ribbons(flank: InvoluteHelicoid, t: Array, z: Array, face: float) -> list[Array]:
    """A narrow strip on the flank for each line, shape (3, points, 2)."""
    width = _RIBBON * face
    found = []
    for tangents, heights in zip(t, z, strict=True):
        normal = flank.normals(tangents, heights)
        across = np.cross(normal, flank.generators(tangents, heights), axis=0)
        middle = flank.points(tangents, heights) + _LIFT * width * normal
        found.append(np.stack([middle - 0.5 * width * across, middle + 0.5 * width * across], axis=2))
    return found


def _length(name: str, length: LineLength) -> Figure:
    phi = np.degrees(np.append(length.phi_1, 2.0 * length.phi_1[-1] - length.phi_1[-2]))
    total = np.append(length.total, length.total[0]) * 1e3
    low, high = length.least * 1e3, length.largest * 1e3
    room = max(0.2 * (high - low), 0.02 * high)
    axis = Axis("length of all contact lines", "mm", limits=(max(0.0, low - room), high + room))
    curve = Curve(phi, total, "total length", "blue", markers=False)
    return Figure(
        f"contact_line_length_{name}",
        f"Total length of the contact lines of pair {name}",
        f"Pair {name}, aligned: length of all lines of contact over a cycle, {low:.4g} to {high:.4g} mm.",
        (Panel(Axis("pinion angle φ_{1}", "deg"), axis, (curve,), (Mark("y", length.mean * 1e3, "mean"),)),),
    )


CONTACT_LINES = Stage(
    subjects=lambda scene: tuple(scene.helical_pairs),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=check_misalignment,
    cites=citing(Citation("litvin", "line contact of aligned helicoids", "Appendix 3, A.3.1 to A.3.9")),
    forecast=lambda scene, _name: Forecast({"positions": scene.case.tooth_contact.positions}, 0.02),
)
