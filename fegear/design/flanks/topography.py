"""Topographic relief that makes the transmission error of loaded flanks constant at the design load.

Mark's Eq. 4.6 along contact lines: the stations of all lines are loaded as designed, their approach u(x, z) under all
those loads is computed, and e(x, z) = zeta - u(x, z) is what both flanks together are relieved by. Contact with the
design load everywhere then meets all conditions with the same zeta at every roll position. Every point (x, z) of the
plane of action is passed by one contact line at one roll position, so e is one function of the flank point, and the
same for all teeth. zeta is the largest u, so that nothing is added to the flanks.

Beyond the design zone, where a pair carries nothing at the design load, the relief goes on with the slope that it has
at the zone's end: teeth that only just failed to touch would come into contact under any greater load at once.

How tooth pairs are to share a design load over the plane of action: Mark's loading functions, spread over the face.

The line load is f(x, z) = W w(x) q(z): w is a loading function of the path whose values at all pairs add up to one, q a
distribution over the face with the integral one. At every height z the pairs in reach then carry W q(z) together at
every roll position, whatever the helix angle, for their positions are a base pitch apart there; the forces of all
contact lines add up to W, and the load over the face is q at every instant. (Mark, Eqs. 4.9 to 4.14, taken along the
contact lines.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import RangeError
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.lines import ContactLines, base_twist, contact_lines
from fegear.contact.wide.load_sharing import deflection
from fegear.design.loading import LoadingFunction
from fegear.geometry.flank_modification import Topography
from fegear.geometry.pair import GearPair, Member

#: Stations from which a node of a table is interpolated.
_NEIGHBOURS = 20
#: Nodes are looked for so far beside their place, in stations: of equally distant ones no last digit chooses (3e-4 of
#: the removal).
_BESIDE = np.array([1e-6, 0.618e-6])


#: The slope beyond the design zone is that of the chord over this part of the ramp inside it.
_CHORD = 0.25


@dataclass(frozen=True)
class StationRelief(ReadOnlyArrays):
    """Relief at the stations of the contact lines it was designed on, arrays of shape (P, M).

    Parameters
    ----------
    lines : ContactLines
    force : ndarray
        Design load on the stations [N]; its sum is the design load at every roll position.
    relief : ndarray
        Removal by both gears together, averaged over each station's hat [m]; zero where no station is.
    deflection : ndarray
        u under the design load [m].
    """

    lines: ContactLines
    force: Array
    relief: Array
    deflection: Array


def design_lines(pair: GearPair, loading: FlankLoading, count: int, panel: float) -> ContactLines:
    """Contact lines on which a relief is designed, at roll positions evenly spread over a base pitch.

    Where lines run along the teeth, all of a line meets the start of the loading at once, and positions crowd there.

    Parameters
    ----------
    pair : GearPair
    loading : FlankLoading
    count : int
        Roll positions, not counting those that crowd.
    panel : float
        Length of a panel, at most [m].
    """
    start, pitch = pair.x_start, pair.base_pitch
    roll = start + pitch * (np.arange(count) + 0.5) / count
    if _is_straight(pair, count):
        near = pitch / count * np.array([0.0, 0.02, 0.1, 0.35])
        kinks = np.array([*loading.over_path.kinks, pair.x_start, pair.x_end])
        kinks = kinks[(kinks >= pair.x_start - 1e-9 * pitch) & (kinks <= pair.x_end + 1e-9 * pitch)]
        more = start + np.mod(np.concatenate([kinks + d for d in (*near, *-near)]) - start, pitch)
        roll = np.unique(np.concatenate([roll, more]))
        roll = roll[np.concatenate([[True], np.diff(roll) > 1e-4 * pitch / count])]
    return lines_at(pair, roll, panel)


def lines_at(pair: GearPair, roll: Array, panel: float) -> ContactLines:
    """Contact lines at ascending roll positions of one base pitch, each for half of the way to both its neighbours."""
    step = np.diff(roll, append=roll[0] + pair.base_pitch)
    return contact_lines(pair, roll, panel, 0.5 * (step + np.roll(step, 1)) / pair.base_pitch)


def _is_straight(pair: GearPair, count: int) -> bool:
    """Whether a contact line lies, with all its length, between two of so many roll positions."""
    return abs(base_twist(pair)) * pair.face_width < pair.base_pitch / count


def design_force(lines: ContactLines, loading: FlankLoading, load: float) -> Array:
    """Design load on the stations of contact lines, shape (P, M) [N]; its sum is the load at every roll position."""
    force = np.where(lines.present, loading.line_load(lines.x, lines.z), 0.0) * lines.support
    # Hats carry what straight pieces between the stations do: the sum is off by the square of a panel's length.
    return np.asarray(force * (load / force.sum(axis=1))[:, None])


def station_relief(known: FlankCompliance, apart: Array, loading: FlankLoading, load: float) -> StationRelief:
    """Relief at the stations of contact lines that makes their approach the same at all roll positions.

    Parameters
    ----------
    known : FlankCompliance
    apart : ndarray, shape (P, M)
        Gap that is there without the relief, and that it makes up for, too [m].
    loading : FlankLoading
    load : float
        Design load along the transverse line of action [N].
    """
    lines = known.lines
    force = design_force(lines, loading, load)
    u = deflection(known, force)
    zone = loading.over_path
    inside = lines.present & (lines.x >= zone.x_start) & (lines.x <= zone.x_end)
    relief = (u + apart)[inside].max() - u - apart
    before, after = np.maximum(zone.x_start - lines.x, 0.0), np.maximum(lines.x - zone.x_end, 0.0)
    slopes = _end_slopes(lines, relief, loading)
    relief = relief + slopes[0] * before + slopes[1] * after
    return StationRelief(lines, force, np.where(lines.present, relief, 0.0), np.where(lines.present, u, 0.0))


def _end_slopes(lines: ContactLines, relief: Array, loading: FlankLoading) -> tuple[float, float]:
    """Growth of the relief per length towards both ends of the design zone, averaged over the face [m/m]."""
    zone = loading.over_path
    reach = _CHORD * max(zone.terms[0][2], 0.05 * zone.length)
    found = []
    for distance in (lines.x - zone.x_start, zone.x_end - lines.x):
        near = lines.present & (distance >= 0.0) & (distance <= reach)
        d, e = distance[near], relief[near]
        varies = d.size > 1 and float(np.ptp(d)) > 0.0
        found.append(max(-float(np.polyfit(d, e, 1)[0]), 0.0) if varies else 0.0)
    return found[0], found[1]


def tabulated(found: StationRelief, pair: GearPair, x: Array, z: Array) -> Array:
    """Relief at the nodes of a table, by thin plates through the stations nearby.

    Parameters
    ----------
    found : StationRelief
    pair : GearPair
    x, z : ndarray, shapes (n,), (m,)
        Nodes in the plane of action, ascending [m].

    Returns
    -------
    ndarray, shape (n, m)
        [m]; the least is zero.
    """
    from scipy.interpolate import RBFInterpolator

    lines, on = found.lines, found.lines.present
    slope, panel = base_twist(pair), float(lines.panel.max())
    step = float(np.median(np.diff(lines.roll))) if lines.roll.size > 1 else pair.base_pitch

    def places(x: Array, z: Array) -> Array:
        # Stations stand on lines x + slope z = const.
        return np.stack([(x + slope * z) / step, z / panel], axis=-1)

    known = places(lines.x[on], lines.z[on])
    plates = RBFInterpolator(known, found.relief[on], neighbors=min(_NEIGHBOURS, known.shape[0]))
    nodes = places(*np.meshgrid(x, z, indexing="ij"))
    removal = plates(nodes.reshape(-1, 2) + _BESIDE).reshape(x.size, z.size)
    return np.asarray(removal - removal.min())


def topography(pair: GearPair, member: Member, x: Array, z: Array, removal: Array) -> Topography:
    """What `tabulated` gave, as the topography of one gear, over its roll angles and its own face."""
    roll = np.asarray(pair.roll_angle(x, member))
    order = np.argsort(roll)
    return Topography(roll[order], z + pair.face_height(member), removal[order])


def table_nodes(found: StationRelief, pair: GearPair) -> tuple[Array, Array]:
    """Nodes of a table as dense as the stations of the design; those of a spur pair are the stations."""
    lines = found.lines
    panels = max(4, round((lines.high - lines.low) / float(lines.panel.max())))
    z = np.linspace(lines.low, lines.high, panels + 1)
    if _is_straight(pair, lines.roll.size):
        x = np.unique(lines.x[lines.present])
        ends = np.array([pair.x_start, pair.x_end])
        return np.unique(np.concatenate([x[(x > ends[0]) & (x < ends[1])], ends])), z
    count = max(8, round(lines.roll.size * pair.contact_ratio))
    return np.linspace(pair.x_start, pair.x_end, count + 1), z


@dataclass(frozen=True, slots=True)
class FlankLoading:
    """Design load of a tooth pair per length of face, over the plane of action.

    Parameters
    ----------
    over_path : LoadingFunction
    face_width : float
        [m].
    end_length : float
        Length at both ends of the face over which the load falls to nothing, as half a wave of a cosine [m].

    Raises
    ------
    RangeError
        If both ends are longer than the face.
    """

    over_path: LoadingFunction
    face_width: float
    end_length: float = 0.0

    def __post_init__(self) -> None:
        """Refuse ends that meet."""
        if not 0.0 <= self.end_length <= 0.5 * self.face_width * (1.0 + 1e-12):
            raise RangeError(
                "flank_design.end_length", f"{self.end_length * 1e3:.6g} mm",
                f"must be between 0 and half the face width, {0.5e3 * self.face_width:.6g} mm",
            )  # fmt: skip

    @property
    def face_load_factor(self) -> float:
        """K_Hbeta of the design load: largest q(z) over 1/b."""
        return self.face_width / (self.face_width - self.end_length)

    def over_face(self, z: ArrayLike) -> Array:
        """q(z) [1/m] at heights from the middle of the face [m]; zero beyond its ends."""
        inside = 0.5 * self.face_width - np.abs(np.asarray(z, dtype=float))
        whole = 1.0 / (self.face_width - self.end_length)
        if self.end_length == 0.0:
            return np.where(inside >= -1e-9 * self.face_width, whole, 0.0)
        return np.asarray(0.5 * whole * (1.0 - np.cos(np.pi * np.clip(inside / self.end_length, 0.0, 1.0))))

    def line_load(self, x: ArrayLike, z: ArrayLike) -> Array:
        """f(x, z) / W [1/m]: share of the load on a tooth pair per length of face."""
        return np.asarray(self.over_path.fraction(x) * self.over_face(z))
