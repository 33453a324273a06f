"""The fillet with the least root stress of one gear of a pair: proof, gain, and what is lost where it is not met."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import ConvergenceError, GeometryError
from fegear.contact.loaded_teeth import silent
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.loaded_pair import LoadedPair
from fegear.contact.plane.maker import load_plane
from fegear.contact.plane.tooth_stress import loaded_states, tooth_stress
from fegear.design.fillet.fillet_bench import FilletBench, Objective
from fegear.design.fillet.fillet_limits import Limits
from fegear.design.fillet.fillet_search import Designed, Family, Found, search
from fegear.design.fillet.moved_ellipses import Basis, MovedEllipses
from fegear.design.fillet.shared_bottom import BothFillets, BothSides, with_bottom
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.plane.solution import solve_to_tolerance
from fegear.geometry.asymmetric_fillets import kept_land
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricSide
from fegear.geometry.conjugate_rack import ConjugateRack, conjugate_rack
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_shapes import PointsFillet
from fegear.geometry.gear import Gear
from fegear.geometry.involute_side import FLANKS, InvoluteSide
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.rack import BasicRack
from fegear.geometry.shaped_side import ShapedSide

#: Searches: basis, where the flank begins at first (share of the way to the base circle), and height of the first wave
#: or bump. The first is the design, the others are its proof.
SEARCHES: dict[str, tuple[Basis, float, float]] = {
    "waves": ("waves", 0.0, 0.0),
    "waves, other start": ("waves", 0.4, 0.02),
    "bumps": ("bumps", 0.3, 0.0),
}
#: Waves along a fillet.
WAVES = 7
#: Starts that are tried in turn where an ellipse cannot be: nearer to the base circle, and higher.
_STARTS = ((0.0, 0.0), (0.2, 0.0), (0.4, 0.0), (0.7, 0.0), (0.2, 0.05), (0.5, 0.05), (0.9, 0.1))
#: Where a rack makes no fillet that starts farther up.
_DEEPER = [(0.0, -0.03), (0.0, -0.02), (0.0, -0.01)]
#: Roll positions of the final numbers; how far off a fillet is tried, halfway up [modules].
_POSITIONS, OFF = 48, 0.01


@dataclass(frozen=True)
class Stressed:
    """A tooth and its largest stress by the objective in the pair, loaded with it [Pa]; its error is estimated.

    Parameters
    ----------
    name : str
    tooth : InvoluteSide
    stress, error : float
    along : ndarray, shape (S,)
        Largest stress over the mesh along the fillet, at `SHARES` of its length from the root circle [Pa].
    back : ndarray, shape (S,), optional
        The same of the other fillet of an asymmetric tooth, if both are designed.
    """

    name: str
    tooth: InvoluteSide
    stress: float
    error: float
    along: Array
    back: Array | None = None

    @property
    def sides(self) -> list[tuple[InvoluteSide, Array]]:
        """Each fillet that is judged, below the flank that its tooth is seen from, and the stress along it."""
        return [(self.tooth, self.along), *([] if self.back is None else [(self.tooth.back, self.back)])]


@dataclass(frozen=True)
class FilletDesign:
    """The best fillet of one gear.

    Parameters
    ----------
    member : {"driver", "driven"}
    present, best : Stressed
    full : Stressed or None
        With the full fillet of a rack as deep as the present one; None of gears that no rack generates.
    found : mapping of str to Found
        By search, see `SEARCHES`.
    off : (float, float)
        Stress over the best where half of the fillet's length is `OFF` modules deeper, and higher.
    """

    member: Member
    present: Stressed
    best: Stressed
    full: Stressed | None
    found: dict[str, Found]
    off: tuple[float, float]

    @property
    def shapes(self) -> tuple[PointsFillet, ...]:
        """The fillet, of both sides that below the other flank behind it."""
        shape = self.found[self.first].shape
        return tuple(shape) if isinstance(shape, BothFillets) else (shape,)

    @property
    def first(self) -> str:
        """The search that found it."""
        return _first(self.found)

    @property
    def kept(self) -> bool:
        """Whether it keeps its limits."""
        return self.found[self.first].kept

    @property
    def tools(self) -> tuple[ConjugateRack, ...]:
        """Tip of the rack that generates it beside each fillet, if there is one: none of internal gears."""
        return () if self.best.tooth.internal else tuple(conjugate_rack(side) for side, _ in self.best.sides)

    @property
    def off_by(self) -> float:
        """How far a fillet was tried deeper and higher [modules]."""
        return OFF

    @property
    def tried(self) -> int:
        """Fillets that were solved."""
        return sum(one.tried for one in self.found.values())

    @property
    def spread(self) -> float:
        """How far the worst search ended above the best, relative."""
        stress = [one.stress for one in self.found.values()]
        return max(stress) / min(stress) - 1.0

    def gain(self, over: Stressed) -> tuple[float, float]:
        """By how much the best is below another fillet, relative, and its estimated error."""
        ratio = self.best.stress / over.stress
        return 1.0 - ratio, ratio * (self.best.error / self.best.stress + over.error / over.stress)


@dataclass(frozen=True)
class LoadedSolved:
    """A pair under its load, what it was made of, and which of its gears gets a fillet.

    Parameters
    ----------
    loaded : LoadedPair
    spec : PairSpec
    solved : (GearInfluence, GearInfluence)
        Driver and driven gear.
    member : {"driver", "driven"}
    alike : bool
        Whether the gear meshes with its like, which has the same fillet in the final numbers.
    """

    loaded: LoadedPair
    spec: PairSpec
    solved: tuple[GearInfluence, GearInfluence]
    member: Member
    alike: bool = False

    def bench(self, limits: Limits, objective: Objective, other: FilletBench | None = None) -> FilletBench:
        """What fillets are judged by in it."""
        return FilletBench(self.loaded.engagement, self.loaded.nominal, self.member, limits, objective, other=other)

    @property
    def gear(self) -> Gear:
        """That gets a fillet."""
        return self.loaded.pair.gear(self.member)

    @property
    def reach(self) -> int:
        """Neighbours that a tooth of the gear is coupled to."""
        return self.solved[MEMBERS.index(self.member)].reach

    def with_gear(self, gear: Gear, known: GearInfluence) -> Engagement:
        """The pair with another gear in the place of the one that gets a fillet."""
        gears, solved = [self.loaded.pair.driver, self.loaded.pair.driven], list(self.solved)
        for g, member in enumerate(MEMBERS):
            if member == self.member or self.alike:
                gears[g], solved[g] = gear, known
        pair = GearPair(gears[0], gears[1], self.loaded.pair.centre_distance, self.loaded.pair.axial_offset)
        return load_plane(replace(self.spec, pair=pair), solved, estimates=False).engagement


def _first(found: dict[str, Found]) -> str:
    """The least stressed fillet of those that keep their limits; of all where none does."""
    return min(found, key=lambda name: (not found[name].kept, found[name].stress))


def design_fillet(
    pair: LoadedSolved,
    limits: Limits,
    objective: Objective = "tension",
    tolerance: float = 1e-2,
    progress: Callable[[float], None] = silent,
    searches: int = len(SEARCHES),
    waves: int = WAVES,
    other: LoadedSolved | None = None,
) -> FilletDesign:
    """Find the fillet of one gear of a pair of plane gears with the least root stress.

    Parameters
    ----------
    pair : LoadedSolved
        The present pair, and which of its gears gets the fillet.
    limits : Limits
        What the fillet must keep.
    objective : {"tension", "alternating"}
    tolerance : float
        Of the final numbers.
    progress : callable, optional
    searches : int
        How many of `SEARCHES`: one is quick and proves nothing.
    waves : int
        Of the first family; the bumps of the other are one less.
    other : LoadedSolved, optional
        The pair that loads the other flanks of the same gear, as of a planet between sun and ring. By default those
        are loaded as in `pair`.

    Raises
    ------
    GeometryError
        If no ellipse across the tooth space touches root circle and flank, from which the search could begin.
    """
    bench = pair.bench(limits, objective, None if other is None else other.bench(limits, objective))
    member = pair.member
    tooth = bench.gear.tooth
    present = bench.largest(tooth)
    found = {}
    for n, (name, (basis, share, height)) in enumerate(islice(SEARCHES.items(), searches)):
        family = family_of(bench, basis, waves if basis == "waves" else max(1, waves - 1))
        start = _start(bench, family, share, height)
        if start is not None:
            found[name] = search(bench, family, present, start)
        progress((n + 1) / (searches + 1))
    if not found:
        raise GeometryError(
            "fillet_design", "(start)", "has no ellipse tangent to root circle and flank to start from",
            "reduce smallest_radius or clearance, or choose another root circle",
        )  # fmt: skip
    best = found[_first(found)]
    finally_ = _Final(pair, other, objective, tolerance)
    full = full_rounded(tooth)
    rows = [
        None if one is None else finally_.stressed(name, one)
        for name, one in (("present", tooth), ("optimum", bench.tooth(best.shape)), ("full fillet of a rack", full))
    ]
    progress(1.0)
    if rows[0] is None or rows[1] is None:
        raise ConvergenceError("fillet design: the present or the best fillet could not be solved")
    return FilletDesign(member, rows[0], rows[1], rows[2], found, _off(bench, best.shape, tooth.side))


def family_of(bench: FilletBench, basis: Basis, count: int) -> Family:
    """Fillets of the gear by so many waves or bumps, of asymmetric teeth below one flank, or each of both."""
    tooth = bench.gear.tooth
    own = MovedEllipses(bench.flank(tooth.root_radius), bench.active_roll, basis, count)
    if not bench.gear.asymmetric:
        return own
    if bench.both and bench.other is not None:
        return BothSides(
            own, MovedEllipses(bench.other.flank(tooth.root_radius), bench.other.active_roll, basis, count)
        )
    return with_bottom(own, tooth.root_radius * kept_land(tooth))  # up to where the kept fillet ends


def _start(bench: FilletBench, family: Family, share: float, height: float) -> Array | None:
    """Numbers of the first start that is a fillet within reach, by a rack if it is to be generated by one.

    Far beyond what a rack can make, slopes lead nowhere: starts come nearer to the plain ellipse until one can, or lie
    deeper than it, so that a search from another start is one.
    """
    first = None
    asked = [(share, height)]
    if (share, height) != (0.0, 0.0):
        asked += [(share / n, height / n) for n in (2.0, 4.0, 8.0)]
        asked += _DEEPER if bench.limits.generated else []
    for one, up in (*asked, *_STARTS):
        numbers = family.start(one, up)
        try:
            tooth = bench.tooth(family.shape(numbers))
        except GeometryError:
            continue
        first = numbers if first is None else first
        if not bench.limits.generated or bench.rack_room(tooth) > 0.0:
            return numbers
    return first


def full_rounded(tooth: InvoluteSide) -> InvoluteSide | None:
    """The tooth that a rack with a full fillet of the same depth makes; None where there is none.

    Beside asymmetric teeth it has equal tip roundings, which are one arc.
    """
    made = tooth.as_generated if isinstance(tooth, ShapedSide) else tooth
    try:
        if isinstance(made, AsymmetricSide):
            rack, radius = made.tooth.rack, made.tooth.rack.full_fillet_radius
            drive, coast = (RackFlank(rack.half(flank).pressure_angle, radius) for flank in FLANKS)
            whole = AsymmetricRack(drive, coast, rack.addendum, rack.dedendum)
            return replace(made.tooth, rack=whole, tip_radius=made.tip_radius).side(made.flank)
        if not isinstance(made, Tooth) or made.rack.residual_undercut:
            return None
        full = BasicRack.full_fillet(made.rack.addendum, made.rack.dedendum, made.rack.pressure_angle)
        return replace(made, rack=full, tip_radius=made.tip_radius)
    except GeometryError:
        return None


def moved(shape: PointsFillet, by: float) -> PointsFillet:
    """A fillet whose middle lies farther out of the material by so many modules."""
    points = np.array(shape.points).T
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points)))])
    s = along / along[-1]
    step = np.gradient(points, along, axis=1)
    outward = np.stack([step[1], -step[0]]) / np.hypot(*step)
    moved_points = points + outward * (16.0 * by * s**2 * (1.0 - s) ** 2)
    return replace(shape, points=tuple(map(tuple, moved_points.T.tolist())))


def _off(bench: FilletBench, shape: Designed, side: int) -> tuple[float, float]:
    here = bench.largest(bench.tooth(shape))
    found = []
    for by in (-side * OFF, side * OFF):
        off = BothFillets(*(moved(one, by) for one in shape)) if isinstance(shape, BothFillets) else moved(shape, by)
        try:
            found.append(bench.largest(bench.tooth(off)) / here - 1.0)
        except GeometryError:
            found.append(math.nan)
    return found[0], found[1]


@dataclass(frozen=True)
class _Final:
    """Largest stress with a fillet in the pair that is loaded with it."""

    pair: LoadedSolved
    other: LoadedSolved | None
    objective: Objective
    tolerance: float

    def stressed(self, name: str, tooth: InvoluteSide) -> Stressed:
        """Of a tooth, with its estimated error."""
        both = [one for one in (self.other, self.pair) if one is not None]
        apart = self.other is not None and self.pair.gear.asymmetric
        known, bench, found = {}, None, []
        for one in both:  # that of the pair itself last, with the other one in it
            new = replace(one.gear, tooth=tooth.back if apart and one is self.other else tooth)
            if new not in known:
                known[new] = solve_to_tolerance(new, self.tolerance, reach=max(pair.reach for pair in both))
            of_new = known[new]
            e = one.with_gear(new, of_new)
            states = loaded_states(e, (), (one.loaded.nominal,), roll_positions(e, _POSITIONS))
            found.append(tooth_stress(e, states, one.member, finite_element_compliance(of_new)))
            bench = FilletBench(
                e, one.loaded.nominal, one.member, objective=self.objective, settings=of_new.settings, other=bench
            )
        assert bench is not None  # noqa: S101  (for mypy: there is a pair)
        along = bench.stress(*(finite_element_compliance(solved) for solved in reversed(known.values())))
        each = tuple(along.reshape(1 + apart, -1))
        behind = each[1] if apart else None
        pulled = max(one.error(0) or 0.0 for one in found)
        if self.objective == "tension" or found[-1].largest_compression is None:
            largest = max(float(one.largest_tension[0]) for one in found)
            return Stressed(name, tooth, largest, pulled, each[0], behind)
        pressed = max(one.compression_off(0) or 0.0 for one in found)
        return Stressed(name, tooth, float(along.max()), 0.5 * (pulled + pressed), each[0], behind)
