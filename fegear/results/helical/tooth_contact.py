"""Stage ``tooth-contact``: tooth contact analysis of helical pairs."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import failing, neglecting
from fegear.base.printed import percent
from fegear.case.part import at
from fegear.contact.unloaded.manufacture import lead_angle_error_of_cut, lead_error_as_cut
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.load_words import load_words
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results.helical.drawn_curves import drawn_panels
from fegear.results.helical.drawn_tooth_contact import in_space
from fegear.results.helical.tooth_contact_shown import PHI, ShownContact, ToothContactData

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.contact.unloaded.contact_ellipse import Bearing
    from fegear.contact.unloaded.pair import HelicalPair
    from fegear.contact.unloaded.tooth_contact import ToothContact


#: Kinds of contact that are drawn: all.
_ALL = 100
#: How far past an end of the face, over its width, an ellipse may reach without a remark.
_NEGLIGIBLE = 0.01


@dataclass(frozen=True, slots=True)
class ToothContactInputs:
    """What the analysis of a pair depends on.

    Parameters
    ----------
    pair : HelicalPair
    positions : int
        Pinion angles over a cycle.
    absorb : bool
        Whether a modification is designed that absorbs linear errors.
    load : float or None
        Normal to the flanks [N].
    modulus : float
        Contact modulus [Pa].
    name : str
        Of the pair.
    ignored : str
        Key of a load that the case gives the pair; empty where it gives none.
    lead : float or None
        Error of the pinion's lead that the case gives in place of a lead angle [m].
    relieved : tuple of str
        Gears whose relief, lead, bias or topography the analysis does not know.
    """

    pair: HelicalPair
    positions: int
    absorb: bool
    load: float | None
    modulus: float
    name: str = field(compare=False)
    ignored: str = field(default="", compare=False)
    lead: float | None = field(default=None, compare=False)
    relieved: tuple[str, ...] = field(default=(), compare=False)


def _pairs(scene: Scene) -> tuple[str, ...]:
    return tuple(scene.helical_pairs)


def check_misalignment(scene: Scene, name: str) -> None:
    """Refuse errors of a pair without the effect, the effect without errors, and what rigid flanks do not know."""
    part = scene.case.pair[name]
    shafts = () if part.misalignment is None else ("driver", "driven")
    for member in shafts:
        shaft = getattr(part.misalignment, member)
        if shaft is not None and shaft.in_plane:
            raise InputError(
                f"pair.{name}.misalignment.{member}.in_plane", f"{shaft.in_plane * 1e6:.6g} um",
                "is available for load-distribution only, not for tooth contact analysis of rigid flanks",
                "specify out_of_plane, or use a separate case for load-distribution",
            )  # fmt: skip
    if part.misalignment is not None and not scene.case.effects.misalignment:
        raise InputError(
            f"pair.{name}.misalignment", "(a table)", "is specified, but the effect is off",
            "set misalignment = true under [effects], or remove the table",
        )  # fmt: skip
    _check_data(scene)


def _check_data(scene: Scene) -> None:
    if scene.case.effects.misalignment and all(part.misalignment is None for part in scene.case.pair.values()):
        name = next(iter(scene.helical_pairs), "NAME")
        raise InputError(
            "effects.misalignment", "true", "has no effect: no pair of this case has a misalignment",
            f'specify pair.{name}.misalignment = {{ shaft_angle = "3 arcmin" }}, or remove the effect',
        )  # fmt: skip


def _lead_remark(name: str, asked: ToothContactInputs) -> tuple[str, ...]:
    if asked.lead is None:
        return ()
    pinion, angle = asked.pair.pinion, asked.pair.errors.lead_angle
    other = lead_angle_error_of_cut(pinion, asked.lead)
    minutes = math.degrees(60.0)
    remark = (
        f"Pair {name}: lead error {asked.lead * 1e3:.6g} mm (lead {pinion.lead * 1e3:.6g} mm) converted to a lead "
        f"angle error of {angle * minutes:.6g}' by Eq. 18 of TM-107451 (constant pitch radius). With the radius as "
        f"generated (Appendix 2) the lead error is {lead_error_as_cut(pinion, angle) * 1e3:.6g} mm; for the "
        f'specified lead error set lead_angle = "{other * minutes:.8g} arcmin".'
    )
    return (remark,)


def _remarks(name: str, t: ToothContact) -> tuple[str, ...]:
    kinds, counts = np.unique(t.mesh.kind, return_counts=True)
    share = {str(k): c / t.mesh.kind.size for k, c in zip(kinds, counts, strict=True)}
    edges = {k: s for k, s in share.items() if k != "surface"}
    remarks: list[str] = []
    total = t.pair.transverse_contact_ratio + t.pair.overlap_ratio
    if total < 1.0:
        remarks.append(
            failing(
                f"Pair {name}: total contact ratio {total:.3g} is below 1; over {percent(1.0 - total)} of a pitch "
                "motion is transmitted by edge contact."
            )
        )
    if edges:
        shares = ", ".join(f"{k} {percent(s)}" for k, s in sorted(edges.items(), key=lambda item: -item[1]))
        remarks.append(f"Pair {name}: edge contact over part of the mesh cycle: {shares}.")
    if any("circle" in k or "tangent" in k for k in edges):
        remarks.append(failing(f"Pair {name}: contact reaches the root form circle (interference with the fillet)."))
    for member, hit in zip(("pinion", "gear"), t.pair.interferes, strict=True):
        if hit:
            remarks.append(
                failing(
                    f"Pair {name}: the mating tip reaches below the root form circle of the {member}; contact with the "
                    "fillet is not analysed."
                )
            )
    vague = float(np.mean(t.mesh.ill_defined))
    if vague > 0.0:
        remarks.append(
            f"Pair {name}: (near) line contact over {percent(vague)} of the cycle; the contact point is "
            "ill-defined there, the transmission error is not affected."
        )
    return tuple(remarks)


def _ellipse_remarks(name: str, t: ToothContact, bearing: Bearing) -> tuple[str, ...]:
    """Ellipses that reach past an end of the common face: the half-space behind them ends there."""
    z, reach = t.mesh.z1[bearing.index], np.abs(bearing.long_axis[2]) * bearing.ellipse.long
    low, high = t.pair.overlap
    past, face = np.maximum(z + reach - high, low - z + reach), high - low
    if not (past > _NEGLIGIBLE * face).any():
        return ()
    longest = 2.0 * float(bearing.ellipse.long.max())
    than = f"longer than the common face of {1e3 * face:.4g} mm" if longest > face else "not as long as the common face"
    share = np.mean(past > _NEGLIGIBLE * face)
    remark = (
        f"Pair {name}: at {percent(share)} of the positions the contact ellipse reaches past an end of the face, by "
        f"up to {1e3 * past.max():.3g} mm (the longest, of {1e3 * longest:.4g} mm, is {than}). Hertz theory assumes "
        "unbounded flanks, so the pressure is underestimated there."
    )
    return (remark,)


def _inputs(scene: Scene, name: str) -> ToothContactInputs:
    part, asked = scene.case.pair[name], scene.case.tooth_contact
    a, b = (scene.case.gear[gear].material.build().plane_modulus("strain") for gear in (part.driver, part.driven))
    absorb = part.modification is not None and part.modification.absorb
    return ToothContactInputs(
        scene.helical_pairs[name], asked.positions, absorb, asked.load, 1.0 / (1.0 / a + 1.0 / b), name,
        next((key for key in ("load", "torque") if getattr(part, key) is not None), ""),
        part.misalignment.lead if part.misalignment is not None else None,
        tuple(gear for gear in dict.fromkeys((part.driver, part.driven))
              if scene.case.gear[gear].relieved or scene.case.gear[gear].over_face),
    )  # fmt: skip


def _compute(asked: ToothContactInputs, _upstream: Upstream, _work: Work) -> ToothContactData:
    from fegear.contact.unloaded.contact_ellipse import bearing_contact
    from fegear.contact.unloaded.predesign import absorb_linear_error
    from fegear.contact.unloaded.tooth_contact import tooth_contact

    pair, design, bearing, problem = asked.pair, None, None, ""
    if asked.absorb:
        try:
            design = absorb_linear_error(pair)
        except InputError as error:
            raise at(f"pair.{asked.name}.modification", error) from None
        pair = design.pair
    contact = tooth_contact(pair, asked.positions)
    if asked.load is not None:
        try:
            bearing = bearing_contact(pair, contact.mesh, asked.load, asked.modulus)
        except InputError as error:
            problem = f"{error.rule}; {error.remedy}"
    return ToothContactData(contact, bearing, design, problem)


def _all_remarks(seen: Seen) -> Iterator[str]:
    """What a reader should know of the contact, and what the analysis takes no account of."""
    name, data, asked = seen.name, seen.data.data, seen.asked
    yield from _remarks(name, data.contact)
    yield from _lead_remark(name, asked)
    if data.bearing is not None:
        yield from _ellipse_remarks(name, data.contact, data.bearing)
    if asked.relieved:
        of = " and ".join(f"gear {gear}" for gear in asked.relieved)
        yield (
            neglecting(
                f"Pair {name}: relief, lead, bias and topography of {of} ignored: tooth contact analysis uses the "
                "generated flanks with the modification of the pair."
            )
        )
    if asked.ignored:
        yield (
            neglecting(
                f"Pair {name}: {asked.ignored} is ignored in tooth contact analysis (rigid flanks); set "
                "tooth_contact.load for contact ellipses."
            )
        )
    if data.no_ellipses:
        yield f"Pair {name}: no contact ellipses: {data.no_ellipses}."


def _alone(key: str) -> Cell:
    """A quantity of one tooth pair alone."""
    return Cell(f"contact.single.{key}", lambda seen: seen.data.alone(key))


def _half_axis(key: str, label: str, role: str) -> Line:
    """A half axis of the ellipses, or their pressure."""
    return Line(f"ellipse.{key}", label, role, x="phi", kind="points", look={"size": 4.0})


def _pattern_caption(seen: Seen) -> str:
    ellipses = " Ellipses: contact under the load of the case, cut at the ends of the flank."
    vague = " Line contact: the position of the point on the line is arbitrary."
    return (
        f"Pair {seen.name}: contact points of one tooth pair over the engagement, by type of contact."
        + (ellipses if seen.data.data.bearing is not None else "")
        + (vague if seen.data.vague else "")
    )


def _under(seen: Seen) -> str:
    """The load of contact ellipses, where there are any."""
    return load_words(seen.data.load, 4) if seen.data.ellipses is not None and seen.data.load is not None else ""


_POINT = ("kind", "r1", "z1", "r2", "z2")
_TITLE = "Tooth contact of pair {name}"
_SHEET = Sheet(
    of=lambda data, asked: ShownContact(data, asked.load),
    tables=(
        Rows(
            "tooth_contact_{name}", f"{_TITLE}, gear set over one cycle",
            (
                Cell("contact.mesh.phi_1", "contact.phi_1"), Cell("contact.mesh.error", "contact.error"),
                *(f"contact.mesh.{key}" for key in _POINT), "leader",
                "contact.mesh.slope", "contact.mesh.spread",
            ),
        ),
        Rows(
            "tooth_contact_single_{name}", f"{_TITLE}, one tooth pair only",
            tuple(_alone(key) for key in ("phi_1", "error", *_POINT)),
        ),
        Rows(
            "tooth_contact_pieces_{name}", "Intervals of the mesh cycle of pair {name}",
            ("first", "last", "pair", "contact", "slope"), of="pieces",
        ),
        Rows(
            "tooth_contact_kinds_{name}", "Types of contact of pair {name}",
            ("contact", "share", "slope", "rise", "rise_spread"), of="kinds",
        ),
        Rows(
            "contact_ellipses_{name}", "Contact ellipses of pair {name}",
            ("phi", *(f"ellipse.{key}" for key in ("long", "short", "pressure", "approach"))), of="ellipses",
        ),
    ),
    values=(
        Number("peak_to_peak", "peak_to_peak_error"),
        Number("maximum", "contact.maximum.error"),
        Number("minimum", "contact.minimum.error"),
        Number("transverse_contact_ratio", exact),
        Number("common_overlap_ratio", exact),
        Number("centre_distance_as_cut", exact),
        Number("surface_share", "surface_share_error"),
        Number("lead_angle_error", exact),
        Number("lead_error_as_cut", exact),
        "crown",
        "predesigned_te",
    ),
    figures=(
        Chart(
            "unloaded_transmission_error_{name}", "Unloaded transmission error of pair {name}",
            "Pair {name}: transmission error of the driven gear over two mesh cycles (phi_2 - N1/N2 phi_1); the tooth "
            "pair in contact is the one with the largest value. Peak to peak {d.peak_to_peak:.4g}.",
            (drawn_panels("error_panels"),),
        ),
        Chart(
            "unloaded_contact_pattern_{name}", "Unloaded contact pattern of pair {name}", _pattern_caption,
            (
                Over(
                    lambda seen: Axis(f"height z on the {seen.one.which}", "mm"),
                    (
                        Line("r", role="ink", x="z", look={"width": 1.0, "markers": False}),
                        Line(
                            "r", x="z", kind="points", look=lambda seen: {"size": 4.5, "notes": seen.one.notes},
                            each=Family("kinds", "{one.kind}", "{one.role}", most=_ALL),
                        ),
                        Line(
                            "ellipses_r", "contact ellipses", "grey", x="ellipses_z",
                            look={"width": 0.8, "markers": False},
                        ),
                    ),
                    lambda seen: Axis(f"radius on the {seen.one.which}", "mm"), each="pattern",
                ),
            ),
            columns=2, under=_under,
        ),
        Chart(
            "contact_ellipses_{name}", "Contact ellipses of pair {name}",
            lambda seen: f"Pair {seen.name}: contact ellipses for flank contact, "
            f"{load_words(seen.data.load, 4)} on one tooth pair.",
            (
                Over(
                    PHI,
                    (
                        _half_axis("long", "semi-major axis", "blue"), _half_axis("short", "semi-minor axis", "orange"),
                    ),
                    Axis("semi-axes", "mm", zero=True),
                ),
                Over(PHI, (_half_axis("pressure", "pressure", "red"),)),
            ),
            of="ellipses", when=lambda seen: seen.data.load is not None, under=_under,
        ),
        in_space,
    ),
    remarks=(_all_remarks,),
    settings={
        "positions": lambda seen: seen.asked.positions,
        "load": lambda seen: seen.asked.load,
        "contact_modulus": lambda seen: None if seen.asked.load is None else seen.asked.modulus,
    },
)  # fmt: skip


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Contacts at every angle, and their extremes, which take the most."""
    positions = scene.case.tooth_contact.positions
    return Forecast({"positions": positions}, 0.22 + 1.3e-4 * positions)


TOOTH_CONTACT = Stage(
    subjects=_pairs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=check_misalignment,
    cites=citing(
        Citation("litvin", "surfaces, tooth contact analysis, edge contact", "Appendices 1 to 5"),
        Citation("johnson", "contact ellipses"),
    ),
    forecast=_forecast,
)
