"""Stage ``tooth-contact``: tooth contact analysis of helical pairs."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.part import at
from fegear.contact.unloaded.manufacture import lead_angle_error_of_cut, lead_error_as_cut
from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.helical.drawn_tooth_contact import tooth_contact_figures

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.unloaded.contact_ellipse import Bearing
    from fegear.contact.unloaded.pair import HelicalPair
    from fegear.contact.unloaded.pair_contact import PairContact
    from fegear.contact.unloaded.predesign import Predesign
    from fegear.contact.unloaded.tooth_contact import ToothContact


#: How far past an end of the face, over its width, an ellipse may reach without a remark.
_NEGLIGIBLE = 0.01


@dataclass(frozen=True, slots=True)
class ToothContactData:
    """The analysis of a pair.

    Parameters
    ----------
    contact : ToothContact
    bearing : Bearing or None
        Contact ellipses, where load and surfaces give them.
    design : Predesign or None
        Modification that absorbs linear errors, where the case asks for it.
    no_ellipses : str
        Why there are none although a load is given.
    """

    contact: ToothContact
    bearing: Bearing | None
    design: Predesign | None = None
    no_ellipses: str = ""


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
                "is known to a pair with a width, not to rigid tooth contact analysis",
                "give out_of_plane, or ask for load-distribution in a case of its own",
            )  # fmt: skip
    if part.misalignment is not None and not scene.case.effects.misalignment:
        raise InputError(
            f"pair.{name}.misalignment", "(a table)", "is given, but the effect is off",
            "write misalignment = true under [effects], or remove the table",
        )  # fmt: skip
    _check_data(scene)


def _check_data(scene: Scene) -> None:
    if scene.case.effects.misalignment and all(part.misalignment is None for part in scene.case.pair.values()):
        name = next(iter(scene.helical_pairs), "NAME")
        raise InputError(
            "effects.misalignment", "true", "finds no pair with a misalignment in this case",
            f'give pair.{name}.misalignment = {{ shaft_angle = "3 arcmin" }}, or remove the effect',
        )  # fmt: skip


def _contact_columns(contact: PairContact) -> tuple[Column, ...]:
    return (
        Column("contact", contact.kind, "", "surface, or the edge that touches"),
        Column("r1", contact.r1, "mm", "radius of the contact point on the pinion"),
        Column("z1", contact.z1, "mm", "its height on the pinion"),
        Column("r2", contact.r2, "mm", "radius of the contact point on the gear"),
        Column("z2", contact.z2, "mm", "its height on the gear"),
    )


def _tables(name: str, t: ToothContact, bearing: Bearing | None) -> tuple[Table, ...]:
    error = "transmission error phi2 - (N1/N2) phi1, positive where the gear runs ahead"
    spread = Column("spread", t.mesh.spread, "mm", "length over which the flanks are within a nanometre")
    pieces = t.pieces()
    reach = t.single.kind != "none"
    tables = [
        Table(
            f"tooth_contact_{name}",
            (
                Column("phi1", t.phi_1, "deg", "pinion angle"),
                Column("te", t.error, "arcsec", error),
                *_contact_columns(t.mesh),
                Column("pair", t.leader, "", "which tooth pair touches first"),
                Column("slope", t.mesh.slope, "", "derivative of the transmission error by phi1"),
                spread,
            ),
            f"Tooth contact of pair {name}, gear set over one cycle",
        ),
        Table(
            f"tooth_contact_single_{name}",
            (
                Column("phi1", t.single.phi_1[reach], "deg", "pinion angle"),
                Column("te", t.single.error[reach], "arcsec", error),
                *(Column(c.name, c.si[reach], c.unit, c.meaning) for c in _contact_columns(t.single)),
            ),
            f"Tooth contact of pair {name}, one tooth pair alone",
        ),
        Table(
            f"tooth_contact_pieces_{name}",
            (
                Column("phi1_first", np.array([p[0] for p in pieces]), "deg", "first pinion angle of the piece"),
                Column("phi1_last", np.array([p[1] for p in pieces]), "deg", "last pinion angle of the piece"),
                Column("pair", np.array([p[2] for p in pieces]), "", "tooth pair that leads"),
                Column("contact", np.array([p[3] for p in pieces]), "", "kind of contact"),
                Column("slope", np.array([p[4] for p in pieces]), "", "mean slope of the transmission error"),
            ),
            f"Pieces of the cycle of pair {name}",
        ),
    ]
    tables.append(_kinds_table(name, t))
    if bearing is not None:
        tables.append(
            Table(
                f"contact_ellipses_{name}",
                (
                    Column("phi1", t.phi_1[bearing.index], "deg", "pinion angle"),
                    Column("long", bearing.ellipse.long, "mm", "half the long axis"),
                    Column("short", bearing.ellipse.short, "mm", "half the short axis"),
                    Column("pressure", bearing.ellipse.pressure, "MPa", "largest pressure"),
                    Column("approach", bearing.ellipse.approach, "um", "approach of the flanks"),
                ),
                f"Contact ellipses of pair {name}",
            )
        )
    return tuple(tables)


def _kinds_table(name: str, t: ToothContact) -> Table:
    """Each kind of contact with its share of the cycle, and how fast and how evenly the gear runs ahead in it."""
    kinds = np.unique(t.mesh.kind)
    slopes, pitch = [t.mesh.slope[t.mesh.kind == kind] for kind in kinds], t.pair.pinion.angular_pitch
    mean, spread = np.array([s.mean() for s in slopes]), np.array([np.ptp(s) for s in slopes])
    return Table(
        f"tooth_contact_kinds_{name}",
        (
            Column("contact", kinds, "", "kind of contact"),
            Column("share", np.array([s.size / t.phi_1.size for s in slopes]), "", "of the cycle's positions"),
            Column("slope", mean, "", "mean slope of the transmission error"),
            Column("rise", mean * pitch, "arcsec", "mean slope times the pitch"),
            Column("rise_spread", spread * pitch, "arcsec", "peak to peak of the slope, times the pitch"),
        ),
        f"Kinds of contact of pair {name}",
    )


def _surface_share(name: str, t: ToothContact) -> Value:
    inside = t.mesh.kind == "surface"
    changes = np.count_nonzero(inside != np.roll(inside, 1))
    error = max(1, changes) / inside.size  # each change lies somewhere between two positions
    return Value(f"{name}.surface_share", float(inside.mean()), "", error, "share of the cycle without edge contact")


def _lead_values(name: str, pair: HelicalPair) -> tuple[Value, ...]:
    """The pinion's lead error as an angle, and as the lead of the pinion that Appendix 2 makes of it."""
    angle = pair.errors.lead_angle
    if angle == 0.0 or angle >= pair.pinion.helix_angle:  # without an error, or without a finite lead of its hand
        return ()
    return (
        Value(f"{name}.lead_angle_error", angle, "arcsec", 0.0, "on the pinion's pitch cylinder"),
        Value(f"{name}.lead_error_as_cut", lead_error_as_cut(pair.pinion, angle), "mm", 0.0,
              "of the pinion's lead H, pitch radius as cut"),
    )  # fmt: skip


def _lead_remark(name: str, asked: ToothContactInputs) -> tuple[str, ...]:
    if asked.lead is None:
        return ()
    pinion, angle = asked.pair.pinion, asked.pair.errors.lead_angle
    other = lead_angle_error_of_cut(pinion, asked.lead)
    minutes = math.degrees(60.0)
    remark = (
        f"Pair {name}: a lead of {pinion.lead * 1e3:.6g} mm that is off by {asked.lead * 1e3:.6g} mm is taken as "
        f"{angle * minutes:.6g}' of lead angle by Eq. 18 of TM-107451, which holds the pitch radius. Its Appendix 2 "
        f"lets the radius follow: the lead as cut is off by {lead_error_as_cut(pinion, angle) * 1e3:.6g} mm, and by "
        f'what is given with lead_angle = "{other * minutes:.8g} arcmin".'
    )
    return (remark,)


def _values(name: str, t: ToothContact) -> tuple[Value, ...]:
    error = t.maximum.error + t.minimum.error
    pair = t.pair
    return (
        Value(f"{name}.unloaded_te_peak_to_peak", t.peak_to_peak, "arcsec", error,
              "variation over a cycle of the gear set"),
        Value(f"{name}.unloaded_te_max", t.maximum.value, "arcsec", t.maximum.error, "largest transmission error"),
        Value(f"{name}.unloaded_te_min", t.minimum.value, "arcsec", t.minimum.error, "smallest transmission error"),
        Value(f"{name}.transverse_contact_ratio", pair.transverse_contact_ratio, "", 0.0, "aligned drive"),
        Value(f"{name}.common_overlap_ratio", pair.overlap_ratio, "", 0.0, "common face over axial pitch"),
        Value(f"{name}.centre_distance_as_cut", pair.centre_distance, "mm", 0.0, "with the pinion as cut"),
        _surface_share(name, t),
        *_lead_values(name, pair),
    )  # fmt: skip


def _remarks(name: str, t: ToothContact) -> tuple[str, ...]:
    kinds, counts = np.unique(t.mesh.kind, return_counts=True)
    share = {str(k): c / t.mesh.kind.size for k, c in zip(kinds, counts, strict=True)}
    edges = {k: s for k, s in share.items() if k != "surface"}
    remarks = []
    total = t.pair.transverse_contact_ratio + t.pair.overlap_ratio
    if total < 1.0:
        remarks.append(
            f"Pair {name}: contact ratio {total:.3g}, overlap included, is below 1: over {1.0 - total:.0%} of a pitch "
            "no tooth pair is on its path of contact, and edges carry the motion on."
        )
    if edges:
        shares = ", ".join(f"{k} {s:.0%}" for k, s in sorted(edges.items(), key=lambda item: -item[1]))
        remarks.append(f"Pair {name}: contact is on an edge over part of the cycle: {shares}.")
    if any("circle" in k or "tangent" in k for k in edges):
        remarks.append(f"Pair {name}: contact reaches the end of the involute near the root: the fillet would be hit.")
    for member, hit in zip(("pinion", "gear"), t.pair.interferes, strict=True):
        if hit:
            remarks.append(
                f"Pair {name}: the mating tip reaches below the {member}'s form circle; that fillet is not analysed."
            )
    vague = float(np.mean(t.mesh.ill_defined))
    if vague > 0.0:
        remarks.append(
            f"Pair {name}: over {vague:.0%} of the cycle the flanks touch along a line, or nearly so; the place of the "
            "contact point is ill-defined there, the transmission error is not."
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
        f"Pair {name}: at {share:.0%} of the positions the contact ellipse reaches past an end "
        f"of the face, by up to {1e3 * past.max():.3g} mm (the longest, of {1e3 * longest:.4g} mm, is {than}). Hertz's "
        "flanks do not end: pressures there are too low."
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


def _present(data: ToothContactData, asked: ToothContactInputs) -> Outcome:
    name, contact, design = asked.name, data.contact, data.design
    values, remarks = _values(name, contact), (*_remarks(name, contact), *_lead_remark(name, asked))
    if design is not None:
        pinion = design.pair.pinion
        arm = pinion.base_radius * np.cos(pinion.base_helix_angle)
        end = design.crown * arm * (0.5 * pinion.face_width) ** 2
        values += (
            Value(f"{name}.crown", end, "um", None, "material to remove at each end of the face, along the normal"),
            Value(f"{name}.predesigned_te", design.peak_to_peak, "arcsec", None, "parabolic error it is designed for"),
        )
    settings: dict[str, object] = {"positions": asked.positions}
    if asked.load is not None:
        settings |= {"load": asked.load, "contact_modulus": asked.modulus}
    if data.bearing is not None:
        remarks += _ellipse_remarks(name, contact, data.bearing)
    if asked.relieved:
        of = " and ".join(f"gear {gear}" for gear in asked.relieved)
        idle = (
            f"Pair {name}: relief, lead, bias and topography of {of} change nothing here: tooth contact analysis takes "
            "the flanks as cut, with the pair's own modification."
        )
        remarks += (idle,)
    if asked.ignored:
        idle = (
            f"Pair {name}: {asked.ignored} changes nothing in tooth contact analysis, which takes the flanks as rigid; "
            "tooth_contact.load gives contact ellipses."
        )
        remarks += (idle,)
    if data.no_ellipses:
        remarks += (f"Pair {name}: no contact ellipses: {data.no_ellipses}.",)
    figures = tooth_contact_figures(name, contact, data.bearing, asked.load)
    return Outcome(data, _tables(name, contact, data.bearing), values, settings, remarks, figures)


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Contacts at every angle, and their extremes."""
    positions = scene.case.tooth_contact.positions
    return Forecast({"positions": positions}, 0.1 + 6e-4 * positions)


TOOTH_CONTACT = Stage(
    subjects=_pairs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=check_misalignment,
    cites=citing(
        Citation("litvin", "surfaces, tooth contact analysis, edge contact", "Appendices 1 to 5"),
        Citation("johnson", "contact ellipses"),
    ),
    forecast=_forecast,
)
