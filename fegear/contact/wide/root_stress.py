"""Root stress of a tooth with a width on its way through the mesh, over the face, from the solved line loads.

The stress of a fillet is linear in the forces on the flanks: those on the stations of the tooth's own contact line and,
through the body, those of the teeth beside it. Along the face it is looked for up the fillet at one place after the
other.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Index, Mask, ReadOnlyArrays, first_of_largest
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.contact.wide.compliance import line_bands, places_of, teeth_on
from fegear.contact.wide.fillet_ends import FilletEnds, LineOnTooth
from fegear.contact.wide.lines import ContactLines, base_twist
from fegear.fem.plane.influence import Side
from fegear.fem.plane.root_stress import extreme
from fegear.fem.solid.bands import Bands, loads_of
from fegear.fem.solid.fillet import SolidFillet
from fegear.fem.solid.odd.odd_solid import OddSolid, SolidTooth
from fegear.fem.solid.rooted_tooth import RootedTooth
from fegear.fem.solid.solution import SolidSolution
from fegear.geometry.pair import GearPair, Member

#: Teeth beside the lines in contact that are followed too, where neighbours count.
_BESIDE = 1
#: What pulls and what presses counts as large.
SIGN: dict[Side, float] = {"tension": 1.0, "compression": -1.0}
#: The largest of points up the fillet misses the largest of the curve through them by much less than this share.
_FITTED = 0.1
#: Places along the face per module, at which root stress is looked for, and how many at least.
_PER_MODULE, _FEWEST = 4.0, 17


@dataclass(frozen=True)
class StressOverFace(ReadOnlyArrays):
    """Stress of one fillet of a tooth at T positions of the tooth and Z places along the face; arrays (T, Z).

    Parameters
    ----------
    x : ndarray, shape (T,)
        Where the tooth's contact line crosses the middle of the face, ascending [m].
    z : ndarray, shape (Z,)
        From the middle of the common face [m].
    value : ndarray
        Largest tension up the fillet, or most negative stress of the other one: along the fillet, in the transverse
        section [Pa].
    radius : ndarray
        Where it sits [m].
    """

    x: Array = shown("mm", "contact position of the tooth at mid-face")
    z: Array = shown("mm", "face position from mid-face", name="face_position", label="face position z")
    value: Array = shown("MPa", "root stress, tension side: maximum over the fillet of the loaded flank", name="stress")
    radius: Array = shown("mm", "radius of the maximum")

    def largest(self, sign: float) -> tuple[Array, Array, Array]:
        """Largest (sign 1) or most negative (-1) stress over the face, its place along it, its radius; shape (T,)."""
        tooth, at = np.arange(self.x.size), first_of_largest(sign * self.value, axis=1)
        return self.value[tooth, at], self.z[at], self.radius[tooth, at]


@dataclass(frozen=True)
class RootedLines:
    """Contact lines of all roll positions on one gear, ready to tell of its roots.

    Parameters
    ----------
    pair : GearPair
    member : {"driver", "driven"}
    lines : ContactLines
    solution : RootedTooth
        What tells of the fillets of the teeth that are followed.
    bands : Bands
        Of all stations.
    loads : tuple of ndarray, shape (n, stations of the line)
        Of each line on its flank's ports, per unit force on each station.
    teeth : ndarray of int, shape (T, 2)
        Roll position and number of the pair of every tooth that is followed, in the order of its x.
    sources : mapping of int to ndarray of int, shape (m, 2)
        By k: tooth, as a row of `teeth`, and line whose load is felt on it as on tooth k beside the loaded one.
    """

    pair: GearPair
    member: Member
    lines: ContactLines
    solution: RootedTooth
    bands: Bands
    loads: tuple[Array, ...]
    teeth: Index
    sources: dict[int, Index]

    @property
    def x(self) -> Array:
        """Positions of the teeth, shape (T,) [m]."""
        return np.asarray(self.lines.roll[self.teeth[:, 0]] + self.teeth[:, 1] * self.pair.base_pitch)

    def stress(self, side: Side, force: Array, z: ArrayLike, surface: Array | None = None) -> StressOverFace:
        """Stress of the fillets under forces on the stations.

        Parameters
        ----------
        side : {"tension", "compression"}
        force : ndarray, shape (P, M)
            [N].
        z : array_like, shape (Z,)
            Along the face, from the middle of the common one [m].
        surface : ndarray, optional
            What `surface` gives for these, where it is at hand.
        """
        m, places = self.pair.driver.module, np.atleast_1d(np.asarray(z, dtype=float))
        fillet, sign = self.solution.fillets[side], SIGN[side]
        total = (self.surface(side, force, places) if surface is None else surface)[0]
        end = self.ends(side).at(places / m, force)
        value, arc = fillet.largest(total.reshape(fillet.arc.size, -1), sign, end.ravel())
        radius = np.interp(arc, fillet.arc, np.hypot(*fillet.place)) * m
        shape = places.size, len(self.teeth)
        return StressOverFace(self.x, places, value.reshape(shape).T / m**2, radius.reshape(shape).T)

    def along_fillets(self, side: Side, force: Array, z: ArrayLike) -> Array:
        """Stress at every point up the fillets of every tooth, for pictures, shape (points, Z, T) [Pa].

        Arguments are those of `stress`. Beside a contact line that presses near the fillet, where stress is that of the
        contact, it is NaN.
        """
        m, places = self.pair.driver.module, np.atleast_1d(np.asarray(z, dtype=float))
        root = self.solution.fillets[side].arc[:, None, None] <= self.ends(side).at(places / m, force)
        return np.where(root, self.surface(side, force, places)[0] / m**2, np.nan)

    def largest(
        self,
        side: Side,
        force: Array,
        z: ArrayLike,
        surface: Array | None = None,
        *,
        across: bool = False,
        at: Mask | None = None,
    ) -> float:
        """Largest value of `stress` [Pa]: curves are laid through the highest of all points alone.

        With `across` it is that of the stress across the root, at right angles to the helix through the place, which
        is what a formula for the normal section means, rather than of that along the transverse section. With `at`,
        shape (P,), only these roll positions count.
        """
        m, places = self.pair.driver.module, np.atleast_1d(np.asarray(z, dtype=float))
        arc, sign = self.solution.fillets[side].arc, SIGN[side]
        felt = self.surface(side, force, places) if surface is None else surface
        total = _across(felt, self.solution.fillets[side], self.solution.tau) if across else felt[0]
        teeth = slice(None) if at is None else at[self.teeth[:, 0]]
        end = self.ends(side).at(places / m, force)[:, teeth]
        return _highest(total[:, :, teeth].reshape(arc.size, -1), arc, sign, end.ravel()) / m**2

    def influence(self, side: Side, z: ArrayLike) -> RootInfluence:
        """The stress of every place as a sum over the stations' forces, for many states of forces.

        Parameters
        ----------
        side : {"tension", "compression"}
        z : array_like, shape (Z,)
            Along the face, from the middle of the common one [m].
        """
        m, places = self.pair.driver.module, np.atleast_1d(np.asarray(z, dtype=float))
        present, columns = self.lines.present, []
        for station in range(present.shape[1]):
            force = np.zeros(present.shape)
            force[:, station] = 1.0
            columns.append(self.surface(side, force, places)[0])
        felt = np.stack(columns, axis=-1) / m**2
        at = self.teeth[:, 0]
        parts = tuple(np.ascontiguousarray(felt[:, :, at == p]) for p in range(self.lines.roll.size))
        rows = tuple(np.flatnonzero(at == p) for p in range(self.lines.roll.size))
        return RootInfluence(self.solution.fillets[side].arc, SIGN[side], places / m, self.ends(side), rows, parts)

    def surface(self, side: Side, force: Array, z: Array) -> Array:
        """The three stresses of `fegear.fem.solid.fillet.surface_stress` under forces on the stations.

        Parameters
        ----------
        side : {"tension", "compression"}
        force : ndarray, shape (P, M)
            [N].
        z : ndarray, shape (Z,)
            Along the face, from the middle of the common one [m].

        Returns
        -------
        ndarray, shape (3, points, Z, T)
            At every point up the fillets of every tooth [N/module^2].
        """
        _, spans = places_of(self.lines)
        on = force[self.lines.present]
        loads = [own @ on[s] for own, s in zip(self.loads, spans, strict=True)]
        moved: Array | float = 0.0
        for k, felt in self.sources.items():
            there = np.stack([loads[line] for line in felt[:, 1]], axis=1)
            under = np.zeros((there.shape[0], len(self.teeth)))
            under[:, felt[:, 0]] = there  # at most one line is k teeth away
            moved = moved + self.solution.moved(k, side, under)
        return self.solution.surface_stress(side, np.asarray(moved), z / self.pair.driver.module)

    def ends(self, side: Side) -> FilletEnds:
        """How far up the fillets stress is root stress: less beside a line that presses near their foot."""
        places, spans = places_of(self.lines)
        own = []
        for tooth, line in self.sources[0].tolist():
            (position, stations), bands = places[line], self.bands.part(spans[line])
            beyond = float(bands.half_width[0]), float(bands.half_width[-1])
            end = self.solution.root_end(0, side, bands)
            own.append(LineOnTooth(tooth, position, stations, bands.zeta, beyond, end))
        return FilletEnds(self.solution.fillets[side].length, len(self.teeth), tuple(own))


@dataclass(frozen=True)
class RootInfluence:
    """Stress of one fillet per unit force on the stations: small, and without the solution behind it.

    Parameters
    ----------
    arc : ndarray, shape (points,)
        Up the fillet [module].
    sign : float
        1 for tension, -1 for compression.
    zeta : ndarray, shape (Z,)
        Places along the face, from the middle of the common one [module].
    ends : FilletEnds
        How far up the fillet stress is root stress.
    rows : tuple of ndarray of int
        Which of the teeth of `ends` are followed at each roll position.
    felt : tuple of ndarray, shape (points, Z, teeth, M)
        Of the teeth that are followed at each roll position [Pa/N].
    """

    arc: Array
    sign: float
    zeta: Array
    ends: FilletEnds
    rows: tuple[Index, ...]
    felt: tuple[Array, ...]

    def largest(self, force: Array) -> float:
        """As `RootedLines.largest`, under forces of shape (P, M) [N]."""
        total = [(felt * force[p]).sum(axis=-1).reshape(self.arc.size, -1) for p, felt in enumerate(self.felt)]
        ends = self.ends.at(self.zeta, force)
        end = np.concatenate([ends[:, own].ravel() for own in self.rows])
        return _highest(np.concatenate(total, axis=1), self.arc, self.sign, end)


def _highest(total: Array, arc: Array, sign: float, end: Array) -> float:
    """Largest value of curves through points up the fillet, shape (points, N), laid through the highest alone."""
    on = np.maximum(np.searchsorted(arc, end, side="right"), 1) > np.arange(arc.size)[:, None]
    top = np.where(on, sign * total, -np.inf).max(axis=0)
    high = top >= top.max() - _FITTED * abs(top.max())
    return float((sign * extreme(total[:, high], arc, sign, end[high])[0]).max())


def _across(surface: Array, fillet: SolidFillet, tau: float) -> Array:
    """Stress at right angles to the helix, from those along the section, across it, and the shear between both.

    In the surface the helix through a place leans by its component along the section's tangent.
    """
    (x, y), (tx, ty) = fillet.place, fillet.tangent
    skew = tau * (ty * x - tx * y)
    across = np.sqrt(1.0 + tau**2 * (x * x + y * y) - skew**2)
    lean = np.arctan2(skew, across)[:, None, None]
    c, s = np.cos(lean), np.sin(lean)
    return np.asarray(c * c * surface[0] + s * s * surface[1] - 2.0 * s * c * surface[2])


def rooted_lines(
    pair: GearPair, member: Member, lines: ContactLines, solution: SolidSolution, *, coupling: bool
) -> RootedLines:
    """Press the contact lines of all roll positions on a gear.

    Parameters
    ----------
    pair : GearPair
    member : {"driver", "driven"}
    lines : ContactLines
    solution : SolidSolution
        Of this gear.
    coupling : bool
        Whether a tooth feels the loads of those beside it.
    """
    if solution.period > 1:
        raise InputError("gear", "teeth that differ", "are not available for root stress over the face")
    bands, (_, spans) = line_bands(pair, member, solution, lines), places_of(lines)
    loads = loads_of(bands, solution.flank, solution.face)
    beside, reach = (_BESIDE if coupling else 0), abs(base_twist(pair)) * 0.5 * pair.face_width
    number = _numbers(lines)
    reach += pair.base_pitch if coupling else 0.0
    teeth = []
    for p, roll in enumerate(lines.roll.tolist()):
        own = number[p]
        followed = range(min(own) - beside, max(own) + beside + 1)
        teeth += [(p, j) for j in followed if pair.x_start - reach < roll + j * pair.base_pitch < pair.x_end + reach]
    teeth.sort(key=lambda one: float(lines.roll[one[0]] + one[1] * pair.base_pitch))
    rooted = RootedLines(
        pair, member, lines, solution, bands, tuple(loads[:, span] for span in spans), np.array(teeth), {}
    )
    return replace(rooted, sources=_sources(rooted, coupling=coupling))


def rooted_teeth(
    pair: GearPair, member: Member, lines: ContactLines, gear: OddSolid, cycle: int, *, coupling: bool
) -> dict[int, RootedLines]:
    """The same of a gear with odd teeth in a base pitch, by the numbers of the pairs that its teeth are on.

    Each tooth is followed at the roll positions at which its pair has a line; missing ones are left out.
    """
    bands, (places, spans) = line_bands(pair, member, gear, lines), places_of(lines)
    loads = gear.pressed(bands, spans, teeth_on(member, lines, places, cycle)).loads
    number, found = _numbers(lines), {}
    for j in sorted(set().union(*number)):
        tooth = j - cycle if member == "driver" else cycle - j
        if not gear.is_missing(tooth):
            teeth = np.array([(p, j) for p, own in enumerate(number) if j in own])
            one = RootedLines(pair, member, lines, SolidTooth(gear, tooth), bands, tuple(loads), teeth, {})
            found[j] = replace(one, sources=_sources(one, coupling=coupling))
    return found


def _numbers(lines: ContactLines) -> list[list[int]]:
    """Numbers of the pairs that have a line at each roll position."""
    return [[int(lines.pair[p, s.start]) for s in lines.at(p)] for p in range(lines.roll.size)]


def _sources(rooted: RootedLines, *, coupling: bool) -> dict[int, Index]:
    lines, forward = rooted.lines, (1 if rooted.member == "driver" else -1)
    places, _ = places_of(lines)
    number = [int(lines.pair[p, s.start]) for p, s in places]
    at = np.array([p for p, _ in places])
    sources: dict[int, list[tuple[int, int]]] = {0: []}
    for t, (p, j) in enumerate(rooted.teeth.tolist()):
        for line in np.flatnonzero(at == p).tolist():
            k = forward * (j - number[line])
            if k == 0 or (coupling and abs(k) <= rooted.solution.reach):
                sources.setdefault(k, []).append((t, line))
    return {k: np.array(felt) for k, felt in sources.items()}


def places_along(lines: ContactLines, module: float) -> Array:
    """Places along the face at which root stress is looked for, both ends among them, shape (Z,) [m]."""
    count = max(_FEWEST, 2 * round(0.5 * _PER_MODULE * (lines.high - lines.low) / module) + 1)
    return np.linspace(lines.low, lines.high, count)
