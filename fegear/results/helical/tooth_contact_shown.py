"""Tooth contact of a helical pair as it is shown: pieces and kinds of contact, the pattern on both flanks, numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.contact.unloaded.manufacture import lead_error_as_cut
from fegear.engine.colours import ROLES
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import polylines
from fegear.results.helical.drawn_curves import DrawnCurve, DrawnPanel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.contact.unloaded.contact_ellipse import Bearing, ContactEllipse
    from fegear.contact.unloaded.predesign import Predesign
    from fegear.contact.unloaded.tooth_contact import ToothContact

_ARCSEC = 648000.0 / math.pi
#: Abscissa of figures over a cycle.
PHI = Axis("pinion angle φ_{1}", "deg")
#: Ellipses drawn in a contact pattern.
_ELLIPSES = 12
#: Least room above and below a transmission error [arcsec].
_LEAST_ROOM = 1e-3


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


@dataclass(frozen=True)
class Pieces:
    """Pieces of the cycle with one leading pair and one kind of contact, arrays of shape (n,)."""

    first: Array = shown("deg", "first pinion angle of the interval", name="phi1_first")
    last: Array = shown("deg", "last pinion angle of the interval", name="phi1_last")
    pair: NDArray[np.int_] = shown("", "tooth pair in contact")
    contact: NDArray[np.str_] = shown("", "type of contact")
    slope: Array = shown("", "mean slope of the transmission error")


@dataclass(frozen=True)
class Kinds:
    """Kinds of contact: their shares of the cycle, how fast and how evenly the gear runs ahead in them."""

    contact: NDArray[np.str_] = shown("", "type of contact")
    share: Array = shown("", "fraction of the mesh cycle")
    slope: Array = shown("", "mean slope of the transmission error")
    rise: Array = shown("arcsec", "mean slope times the pitch")
    rise_spread: Array = shown("arcsec", "peak-to-peak slope times the pitch")


@dataclass(frozen=True)
class Ellipses:
    """Contact ellipses over the pinion angle."""

    ellipse: ContactEllipse
    phi: Array = shown("deg", "pinion angle", name="phi1")


@dataclass(frozen=True)
class KindOnFlank:
    """Where one kind of contact touches a flank."""

    kind: str
    role: str
    notes: tuple[str, ...]
    z: Array = shown("mm", "height")
    r: Array = shown("mm", "radius")


@dataclass(frozen=True)
class PatternOnFlank:
    """A flank seen from the side: its outline, where it touches, and ellipses."""

    which: str
    kinds: list[KindOnFlank]
    ellipses: Array | None
    z: Array = shown("mm", "height of the outline")
    r: Array = shown("mm", "radius of the outline")

    @property
    @shows("mm", "height of the ellipses")
    def ellipses_z(self) -> Array | None:
        """None where there are none."""
        return None if self.ellipses is None else self.ellipses[0]

    @property
    @shows("mm", "radius of the ellipses")
    def ellipses_r(self) -> Array | None:
        """None where there are none."""
        return None if self.ellipses is None else self.ellipses[1]


@dataclass(frozen=True)
class ShownContact:
    """The analysis of a pair; the load is that of contact ellipses [N]."""

    data: ToothContactData
    load: float | None

    @property
    def contact(self) -> ToothContact:
        """Of the pair."""
        return self.data.contact

    @property
    @shows("", "first tooth pair in contact", name="pair")
    def leader(self) -> NDArray[np.int_]:
        """At each angle of the cycle."""
        return self.contact.leader

    def alone(self, key: str) -> Array:
        """What is known of one pair alone, where its flanks face each other."""
        single = self.contact.single
        return np.asarray(getattr(single, key)[single.kind != "none"])

    @property
    def pieces(self) -> Pieces:
        """Of the cycle."""
        return Pieces(*(np.array(one) for one in zip(*self.contact.pieces(), strict=True)))

    @property
    def kinds(self) -> Kinds:
        """Of the cycle."""
        t = self.contact
        kinds = np.unique(t.mesh.kind)
        slopes, pitch = [t.mesh.slope[t.mesh.kind == kind] for kind in kinds], t.pair.pinion.angular_pitch
        mean, spread = np.array([s.mean() for s in slopes]), np.array([np.ptp(s) for s in slopes])
        return Kinds(kinds, np.array([s.size / t.phi_1.size for s in slopes]), mean, mean * pitch, spread * pitch)

    @property
    def ellipses(self) -> Ellipses | None:
        """Where load and surfaces give them."""
        bearing = self.data.bearing
        return None if bearing is None else Ellipses(bearing.ellipse, self.contact.phi_1[bearing.index])

    # ---- single numbers

    @property
    @shows("arcsec", "variation over a mesh cycle", name="unloaded_te_peak_to_peak")
    def peak_to_peak(self) -> float:
        """[rad]."""
        return self.contact.peak_to_peak

    @property
    def peak_to_peak_error(self) -> float:
        """[rad]."""
        return self.contact.maximum.error + self.contact.minimum.error

    @property
    @shows("arcsec", "maximum transmission error", name="unloaded_te_max")
    def maximum(self) -> float:
        """[rad]."""
        return self.contact.maximum.value

    @property
    @shows("arcsec", "minimum transmission error", name="unloaded_te_min")
    def minimum(self) -> float:
        """[rad]."""
        return self.contact.minimum.value

    @property
    @shows("", "aligned drive")
    def transverse_contact_ratio(self) -> float:
        """Of the pair."""
        return self.contact.pair.transverse_contact_ratio

    @property
    @shows("", "common face width / axial pitch")
    def common_overlap_ratio(self) -> float:
        """Of the pair."""
        return self.contact.pair.overlap_ratio

    @property
    @shows("mm", "with the pinion as generated")
    def centre_distance_as_cut(self) -> float:
        """[m]."""
        return self.contact.pair.centre_distance

    @property
    @shows("", "fraction of the mesh cycle without edge contact")
    def surface_share(self) -> float:
        """Of the positions."""
        return float((self.contact.mesh.kind == "surface").mean())

    @property
    def surface_share_error(self) -> float:
        """Each change of the kind of contact lies somewhere between two positions."""
        inside = self.contact.mesh.kind == "surface"
        return float(max(1, np.count_nonzero(inside != np.roll(inside, 1))) / inside.size)

    @property
    def _lead_angle(self) -> float | None:
        """Error of the pinion's lead angle [rad]; None without one, or without a finite lead of its hand."""
        pair = self.contact.pair
        angle = pair.errors.lead_angle
        return None if angle == 0.0 or angle >= pair.pinion.helix_angle else angle

    @property
    @shows("arcsec", "at the reference cylinder of the pinion")
    def lead_angle_error(self) -> float | None:
        """[rad]."""
        return self._lead_angle

    @property
    @shows("mm", "change of the pinion lead H, with generated reference radius")
    def lead_error_as_cut(self) -> float | None:
        """As the lead of the pinion that Appendix 2 makes of it [m]."""
        angle = self._lead_angle
        return None if angle is None else lead_error_as_cut(self.contact.pair.pinion, angle)

    @property
    @shows("um", "amount of lead crowning at each face end, normal to the flank")
    def crown(self) -> float | None:
        """[m]; None where no modification is designed."""
        if (design := self.data.design) is None:
            return None
        pinion = design.pair.pinion
        arm = pinion.base_radius * np.cos(pinion.base_helix_angle)
        return float(design.crown * arm * (0.5 * pinion.face_width) ** 2)

    @property
    @shows("arcsec", "parabolic transmission error of the design")
    def predesigned_te(self) -> float | None:
        """[rad]; None where no modification is designed."""
        return None if self.data.design is None else self.data.design.peak_to_peak

    # ---- what is drawn

    @property
    def error_panels(self) -> list[DrawnPanel]:
        """Transmission error over two cycles with each tooth pair on its own, and that of one pair alone."""
        contact = self.contact
        pitch, single = contact.pair.pinion.angular_pitch, contact.single
        numbers, inside = np.unique(contact.leader), single.kind != "none"
        first, last = contact.phi_1[0], contact.phi_1[0] + 2.0 * pitch
        alone = []
        for k in range(int(numbers.min()) - 2, int(numbers.max()) + 4):
            phi = single.phi_1[inside] + k * pitch
            here = (phi >= first) & (phi <= last)
            alone.append(np.stack([np.degrees(phi[here]), single.error[inside][here] * _ARCSEC]))
        along, size = polylines(alone)
        curves = [DrawnCurve("one pair only", "grey", along, size, 1.0)]
        for turn in (0, 1):
            phi = np.degrees(contact.phi_1 + turn * pitch)
            for k in numbers.tolist():
                error = np.where(contact.leader == k, contact.error * _ARCSEC, np.nan)
                curves.append(
                    DrawnCurve(f"pair {k + turn} in contact", f"series:{(k + turn) % 6}", phi, error, dash="solid")
                )
        low, high = float(contact.error.min()) * _ARCSEC, float(contact.error.max()) * _ARCSEC
        room = max(0.6 * (high - low), _LEAST_ROOM)
        y = Axis("transmission error Δφ_{2}", "arcsec", limits=(low - room, high + 0.5 * room))
        return [DrawnPanel(Axis(PHI.label, PHI.unit, limits=(math.degrees(first), math.degrees(last))), y, curves)]

    @cached_property
    def pattern(self) -> list[PatternOnFlank]:
        """The path of contact of one pair on both flanks, by kind of contact, with ellipses where there are any."""
        pair, single = self.contact.pair, self.contact.single
        panels: list[PatternOnFlank] = []
        kinds = [str(kind) for kind in dict.fromkeys(single.kind) if kind != "none"]
        for gear, z, r, centre, which in (
            (pair.cut_pinion, single.z1, single.r1, 0.0, "pinion"),
            (pair.gear, single.z2, single.r2, pair.axial_offset, "gear"),
        ):
            low, high = gear.form_radius, gear.involute_tip_radius
            side = centre + 0.5 * gear.face_width * np.array([-1.0, 1.0, 1.0, -1.0, -1.0])
            edge = np.array([low, low, high, high, low])
            each = []
            for number, kind in enumerate(kinds):
                here = single.kind == kind
                notes = tuple(f"{kind}, φ_{{1}} = {math.degrees(phi):.4g}°" for phi in single.phi_1[here])
                role = kind if kind in ROLES else f"series:{number}"
                each.append(KindOnFlank(kind, role, notes, z[here], r[here]))
            cut = None
            if self.data.bearing is not None and not panels:
                outline = np.stack([side, edge])
                ends = outline.min(axis=1)[:, None], outline.max(axis=1)[:, None]
                cut = np.clip(_outlines(self.contact, self.data.bearing), *ends)
            panels.append(PatternOnFlank(which, each, cut, side, edge))
        return panels

    @property
    def vague(self) -> bool:
        """Whether the flanks touch along lines somewhere, so that the point on them is arbitrary."""
        single = self.contact.single
        return bool(single.ill_defined[single.kind == "surface"].any())


def _outlines(contact: ToothContact, bearing: Bearing) -> Array:
    """Up to a dozen ellipses in height and radius [m]; the flank is seen from the side, not developed."""
    angle, found = np.linspace(0.0, 2.0 * np.pi, 181), []
    for k in np.unique(np.linspace(0, bearing.index.size - 1, _ELLIPSES).astype(int)):
        centre = contact.mesh.point[:, bearing.index[k], None]
        long = bearing.ellipse.long[k] * bearing.long_axis[:, k, None] * np.cos(angle)
        short = bearing.ellipse.short[k] * bearing.short_axis[:, k, None] * np.sin(angle)
        x, y, z = centre + long + short
        found.append(np.stack([z, np.hypot(x, y)]))
    return polylines(found)
