"""Stage ``contact-lines``: the lines along which the flanks of an aligned helical pair touch, and their length."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.case.reading import Scene
from fegear.contact.unloaded.contact_lines import LineContact, LineLength
from fegear.contact.unloaded.pair import HelicalPair
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.figure.items import Mark, Surface
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Every, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
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


#: Width of a line drawn on a tooth in space, over the face width, and its height above the flank, over its width.
_RIBBON, _LIFT = 0.014, 0.2


#: Points of a drawn flank along and across.
_ALONG, _ACROSS = 41, 25


#: All lines are drawn.
_ALL = 1000
#: What is left of the transmission error of an aligned pair [rad].
_PLAY = 1e-15


@dataclass(frozen=True)
class DrawnLine:
    """A line of contact over the face and the radius of a flank."""

    label: str
    z: Array = shown("mm", "height")
    r: Array = shown("mm", "radius")


@dataclass(frozen=True)
class DrawnFlank:
    """A flank with its lines, seen from the side."""

    which: str
    lines: list[DrawnLine]
    z: Array = shown("mm", "height of the outline")
    r: Array = shown("mm", "radius of the outline")


@dataclass(frozen=True)
class LengthOverCycle:
    """Total length over a cycle, the first position once more at its end."""

    found: LineLength

    @property
    @shows("deg", "pinion angle φ_{1}")
    def phi(self) -> Array:
        """[rad]."""
        phi = self.found.phi_1
        return np.append(phi, 2.0 * phi[-1] - phi[-2])

    @property
    @shows("mm", "length of all contact lines")
    def total(self) -> Array:
        """[m]."""
        return np.append(self.found.total, self.found.total[0])

    @property
    def ends(self) -> tuple[float, float]:
        """Of the axis [mm]."""
        low, high = self.found.least * 1e3, self.found.largest * 1e3
        room = max(0.2 * (high - low), 0.02 * high)
        return max(0.0, low - room), high + room


@dataclass(frozen=True)
class ShownLines:
    """Contact lines of a pair as they are shown."""

    pair: HelicalPair
    lines: LineContact
    length: LineLength

    @property
    @shows("", "number of the contact line", name="line")
    def number(self) -> Array:
        """In each row, from 1."""
        return np.repeat(np.arange(1, self.lines.phi_1.shape[0] + 1), self.lines.phi_1.shape[1])

    def finite(self, key: str) -> Array | None:
        """A parameter in rows; none that is infinite: the line of a spur gear is parallel to its base helix."""
        values = getattr(self.lines, key).ravel()
        return values if np.isfinite(values).all() else None

    @property
    @shows(
        "arcsec", "transmission error of the aligned pair, constant over all angles", name="aligned_transmission_error"
    )
    def play(self) -> float:
        """[rad]."""
        return float((self.lines.phi_2 - self.pair.ratio * self.lines.phi_1).mean())

    @property
    def over_cycle(self) -> LengthOverCycle:
        """Total length."""
        return LengthOverCycle(self.length)

    @property
    def flanks(self) -> list[DrawnFlank]:
        """Of both gears."""
        lines, last = self.lines, len(self.lines.z) - 1
        labels = [f"φ_{{1}} = {math.degrees(phi):.3g}°" if k in (0, last) else ""
                  for k, phi in enumerate(lines.phi_1[:, 0])]  # fmt: skip
        drawn = []
        for gear, radius, centre, which in (
            (self.pair.pinion, lines.r_1, 0.0, "pinion"),
            (self.pair.gear, lines.r_2, self.pair.axial_offset, "gear"),
        ):
            half, low, high = 0.5 * gear.face_width, gear.form_radius, gear.tip_radius
            side = centre + half * np.array([-1.0, 1.0, 1.0, -1.0, -1.0])
            each = [DrawnLine(*one) for one in zip(labels, lines.z, radius, strict=True)]
            drawn.append(DrawnFlank(which, each, side, np.array([low, low, high, high, low])))
        return drawn


def _on_teeth(name: str, pair: HelicalPair, lines: LineContact, title: str) -> Figure:
    """A tooth of the pinion and one of the gear side by side, with the lines on their flanks."""
    panels = []
    for gear, axis, t, which in ((pair.pinion, "space", lines.t_1, "pinion"), (pair.gear, "tooth", lines.t_2, "gear")):
        flank = InvoluteHelicoid.of(gear, axis)  # type: ignore[arg-type]  # two texts of two allowed
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
        f"Pair {name}: contact lines on one tooth of pinion and gear.",
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


def _in_space(seen: Seen) -> tuple[DeferredFigure, ...]:
    """A tooth of either gear with its lines."""
    name, title = seen.name, f"Contact lines on the teeth of pair {seen.name}"
    made = partial(_on_teeth, name, seen.data.pair, seen.data.lines, title)
    return (DeferredFigure(f"contact_lines_on_teeth_{name}", title, made),)


_PARAMETERS = ("phi_1", "u_1", "theta_1", "u_2", "theta_2", "phi_2", "z", "r_1", "r_2")


def _finite(key: str) -> Cell:
    """A parameter of the lines, where it is finite."""
    return Cell(f"lines.{key}", lambda seen: seen.data.finite(key))


_SHEET = Sheet(
    of=lambda data, _asked: ShownLines(data.pair, data.lines, data.length),
    tables=(
        Rows("contact_lines_{name}", "Contact lines of pair {name}", ("number", *map(_finite, _PARAMETERS))),
        Rows(
            "contact_line_length_{name}", "Total length of the contact lines of pair {name}", (Every("cycle"),),
            of="length",
        ),
    ),
    values=(
        *(Number(f"length.{key}", exact) for key in ("mean", "least", "largest")),
        Number("play", lambda _: _PLAY),
    ),
    figures=(
        Chart(
            "contact_lines_{name}", "Contact lines of pair {name}",
            "Pair {name}, aligned: contact lines of one tooth pair at equal steps of the pinion angle; straight and "
            "tangent to the base helix, curved over the radius.",
            (
                Over(
                    lambda seen: Axis(f"height z on the {seen.one.which}", "mm"),
                    (
                        Line("r", role="ink", x="z", look={"width": 1.0, "markers": False}),
                        Line(
                            "r", x="z", look={"dash": "solid", "width": 1.6, "markers": False},
                            each=Family("lines", "{one.label}", "ramp", most=_ALL),
                        ),
                    ),
                    lambda seen: Axis(f"radius on the {seen.one.which}", "mm"), each="flanks",
                ),
            ),
            columns=2,
        ),
        _in_space,
        Chart(
            "contact_line_length_{name}", "Total length of the contact lines of pair {name}",
            "Pair {name}, aligned: length of all lines of contact over a cycle, {d.length.least:.4g!} to "
            "{d.length.largest:.4g}.",
            (
                Over(
                    "phi", (Line("total", "total length", look={"markers": False}),),
                    lambda seen: axis_of(LengthOverCycle, "total", limits=seen.data.over_cycle.ends),
                    marks=lambda seen: (Mark("y", seen.data.length.mean * 1e3, "mean"),),
                ),
            ),
            of="over_cycle",
        ),
    ),
    remarks=(
        Remark(
            "Pair {name}: contact lines of the aligned, unmodified pair; misalignment or modification gives point "
            "contact instead.",
            when=lambda seen: seen.asked.left_out,
        ),
        Remark(
            "Pair {name}: contact lines of spur gears are parallel to the axis; u1 and u2 are not defined.",
            when=lambda seen: seen.data.pair.pinion.helix_angle == 0.0,
        ),
    ),
    settings={"positions": lambda seen: seen.asked.positions},
    sharper_by="",
)  # fmt: skip


CONTACT_LINES = Stage(
    subjects=lambda scene: tuple(scene.helical_pairs),
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=check_misalignment,
    cites=citing(Citation("litvin", "line contact of aligned helicoids", "Appendix 3, A.3.1 to A.3.9")),
    forecast=lambda scene, _name: Forecast({"positions": scene.case.tooth_contact.positions}, 0.02),
)
