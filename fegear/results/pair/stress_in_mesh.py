"""Stage ``stress-in-mesh``: root stress along the fillets of two gears in mesh, for their moving picture.

Of gears with a width it is shown in sections along the face. In the section at z the flanks of a helical pair touch
where those of its middle section do when the gears have turned back by z tan(beta_b) on the line of action: so one
picture of the teeth serves all sections.

What the stages of the moving picture of a pair read: its loads, and both gears solved by finite elements.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.arrays import Array, Index, ReadOnlyArrays, first_of_largest
from fegear.case.built.root_stress_sources import FINITE_ELEMENTS, root_stress_source
from fegear.contact.loaded_teeth import POSITIONS
from fegear.engine.citation import citing
from fegear.engine.sheet.sheet import UNSHOWN
from fegear.engine.stage import Task, Upstream, Work
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.results import forecasts
from fegear.results.forecasts import RING
from fegear.results.gear.drawing import placed_in_mesh
from fegear.results.gear.solved_gear import solid_solution_of, solution_of
from fegear.results.pair.loaded_flanks import loaded_flanks
from fegear.results.pair.loaded_teeth import PLANE, gears_of, loaded_pair, needs_gears, teeth_stage

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.contact.plane.root_stress import RootStress
    from fegear.contact.wide.root_stress import RootedLines
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.influence import Side


_SIDES: tuple[Side, ...] = ("tension", "compression")


class LargestStress(NamedTuple):
    """The largest root tension of both gears over the mesh cycle.

    Attributes
    ----------
    value : float
        [Pa].
    member : {"driver", "driven"}
    pair : int
        Whose tooth it is, as `Contacts.number` counts.
    roll : float
        Roll position [m].
    place : ndarray, shape (2,)
        On the fillet of that tooth, in the frame of `placed_in_mesh` [m].
    radius : float
        Of that place from the gear's centre [m].
    z : float
        Along the face from its middle [m]; 0 for plane teeth.
    """

    value: float
    member: Member
    pair: int
    roll: float
    place: Array
    radius: float
    z: float = 0.0


@dataclass(frozen=True)
class FilletStress(ReadOnlyArrays):
    """Tangential stress along both fillets of the teeth of one gear near the mesh.

    Parameters
    ----------
    places : mapping of str to ndarray, shape (T, 2, n)
        By fillet (``tension`` lies below the loaded flank): points from the root land up to the flank, where the teeth
        stand while pair 0 touches at the pitch point, which is the origin [m].
    stress : mapping of str to ndarray, shape (P, T, n), or (Z, P, T, n) over the face
        There, over the roll positions [Pa]; NaN where it is that of a contact beside the fillet.
    """

    places: Mapping[Side, Array]
    stress: Mapping[Side, Array]


@dataclass(frozen=True)
class StressInMeshData:
    """Root stress of both gears in mesh at P roll positions; the largest is of all that `root-stress-history` has.

    Parameters
    ----------
    pair : GearPair
    roll : ndarray, shape (P,)
        x of pair 0 [m].
    pairs : ndarray of int, shape (T,)
        Pairs that the teeth belong to.
    gears : mapping of str to FilletStress
        By member.
    largest : LargestStress
    z : ndarray, shape (Z,)
        Sections along the face, ascending, that of the largest stress among them [m]; empty for plane teeth.
    """

    pair: GearPair
    roll: Array
    pairs: Array
    gears: Mapping[Member, FilletStress]
    largest: LargestStress
    z: Array = field(default_factory=lambda: np.empty(0))


def _stress(asked: MeshInputs, upstream: Upstream, _work: Work) -> StressInMeshData:
    from fegear.contact.plane.base_pitch import BESIDE, roll_positions
    from fegear.contact.plane.root_stress import RootStress
    from fegear.contact.plane.root_stress_history import superposed_stress, touching_radius
    from fegear.contact.plane.tooth_stress import with_peaks

    found = loaded_pair(upstream, asked.name)
    e, pair = found.engagement, found.engagement.pair
    solved = {gear: solution_of(upstream, gear) for gear in asked.gears.values()}
    sources = {
        member: root_stress_source(
            FINITE_ELEMENTS, asked.name, asked.gears[member], pair, member, solved, tips=asked.tips
        )
        for member in MEMBERS
    }
    at_peaks = {member: (source,) for member, source in sources.items()}
    x = with_peaks(e, found.nominal, roll_positions(e, POSITIONS), at_peaks)
    apart = np.diff(x, prepend=-np.inf) > BESIDE * pair.base_pitch  # peaks of two teeth at one kink are one place
    state = e.solve(e.grid(x[apart]), [found.nominal])
    contacts = state.grid.contacts
    pairs = np.arange(contacts.number[0] - 1, contacts.number[-1] + 2)
    gears: dict[Member, FilletStress] = {}
    for member in MEMBERS:
        gear, source = asked.gears[member], sources[member]
        places, stress = {}, {}
        for side in _SIDES:
            teeth = [one[:, 0] for one in superposed_stress(e, state, member, side, 1, source)]
            fillet = solved[gear].fine.fillets[side]
            points = np.stack([fillet.radius * np.sin(fillet.angle), fillet.radius * np.cos(fillet.angle)])
            own = points * pair.gear(member).module
            places[side] = np.stack([placed_in_mesh(pair, member, own, j) for j in pairs.tolist()])
            stress[side] = np.stack(teeth, axis=1)
        gears[member] = FilletStress(places, stress)
    touched = {member: touching_radius(state, member, 1)[:, :, 0].T for member in MEMBERS}
    roots = {member: RootStress.of(e.compliance, member, "tension", source) for member, source in sources.items()}
    largest = _largest(state.x, pairs, gears, solved, asked, roots, touched)
    few = picture_positions(state.x, pair.base_pitch, largest.roll)
    drawn = {
        member: FilletStress(one.places, {side: all_of[few].astype(np.float32) for side, all_of in one.stress.items()})
        for member, one in gears.items()
    }
    return StressInMeshData(pair, state.x[few], pairs, drawn, largest)


def _largest(
    roll: Array,
    pairs: Array,
    gears: Mapping[Member, FilletStress],
    solved: Mapping[str, GearInfluence],
    asked: MeshInputs,
    roots: Mapping[Member, RootStress],
    touched: Mapping[Member, Array],
) -> LargestStress:
    found = []
    for member, one in gears.items():
        along, known = one.stress["tension"], solved[asked.gears[member]]
        fillet, m = known.fine.fillets["tension"], known.gear.module
        flat = along.reshape(-1, along.shape[2])
        values, arc = roots[member].largest_and_place(0, flat, touched[member].ravel())
        most = int(first_of_largest(values))
        p, tooth = divmod(most, pairs.size)
        place = np.array([np.interp(arc[most], fillet.arc * m, axis) for axis in one.places["tension"][tooth]])
        radius = float(np.interp(arc[most], fillet.arc * m, fillet.radius * m))
        found.append(LargestStress(float(values[most]), member, int(pairs[tooth]), float(roll[p]), place, radius))
    return max(found, key=lambda one: one.value)


_FACE_SIDES: tuple[Side, ...] = ("tension", "compression")


#: Sections along the face that a picture has, at most, and how many of the places at which stress is looked for make
#: one step between them.
_SECTIONS, _EVERY = 25, 2


class _Moments(NamedTuple):
    """Roll positions of a moving picture, from one end of a base pitch to the other: which, and how many pitches on."""

    roll: Array
    position: Index
    on: Index


def _moments(roll: Array, start: float, pitch: float) -> _Moments:
    """The roll positions that a picture from `start` over a base pitch needs, both ends enclosed, ascending."""
    first = int(np.floor((start - roll.max()) / pitch))
    turns = range(first, first + 4)
    at = np.concatenate([roll + on * pitch for on in turns])
    position, on = np.tile(np.arange(roll.size), len(turns)), np.repeat(list(turns), roll.size)
    low, high = at[at <= start].max(), at[at >= start + pitch].min()
    order = np.argsort(at, kind="stable")
    order = order[(at[order] >= low) & (at[order] <= high)]
    return _Moments(at[order], position[order], on[order])


def _sections(places: Array, largest: float) -> Array:
    """Places along the face that are shown, that of the largest stress among them."""
    step = max(_EVERY, -(-(places.size - 1) // (_SECTIONS - 1)))
    count = max(2, -(-(places.size - 1) // step) + 1)
    return np.unique(np.append(places[np.round(np.linspace(0, places.size - 1, count)).astype(int)], largest))


def _stress_over_face(asked: MeshInputs, upstream: Upstream, _work: Work) -> StressInMeshData:
    from fegear.contact.wide.root_stress import rooted_lines

    loaded = loaded_flanks(upstream, asked.name)
    found, pair = loaded.found, loaded.found.pair
    force, coupling = found.contact.force[:, :, loaded.at], loaded.coupling
    rooted = {
        member: rooted_lines(
            pair, member, found.lines, solid_solution_of(upstream, asked.gears[member]).fine, coupling=coupling
        )
        for member in MEMBERS
    }
    moments = _moments(found.lines.roll, pair.x_start, pair.base_pitch)
    along = loaded.places_along
    largest = max((_largest_over_face(one, force, along, moments) for one in rooted.values()), key=_value)
    z = _sections(along, largest.z)
    numbers = np.unique([one.teeth[:, 1] for one in rooted.values()])
    pairs = np.arange(numbers[0] - moments.on.max(), numbers[-1] - moments.on.min() + 1)
    gears = {member: _along(one, force, z, moments, pairs) for member, one in rooted.items()}
    shown = np.zeros(pairs.size, dtype=bool)
    for gear in gears.values():
        shown |= (np.nan_to_num(gear.stress["tension"], nan=1.0) != 0.0).any(axis=(0, 1, 3))
    gears = {
        member: FilletStress(
            {side: one.places[side][shown] for side in _FACE_SIDES},
            {side: one.stress[side][:, :, shown] for side in _FACE_SIDES},
        )
        for member, one in gears.items()
    }
    return StressInMeshData(pair, moments.roll, pairs[shown], gears, largest, z)


def _value(largest: LargestStress) -> float:
    return largest.value


def _along(rooted: RootedLines, force: Array, z: Array, moments: _Moments, pairs: Index) -> FilletStress:
    """One gear's fillets in all sections at all moments; teeth that are not followed feel nothing."""
    pair, member = rooted.pair, rooted.member
    places, stress = {}, {}
    row = {(p, j): t for t, (p, j) in enumerate(rooted.teeth.tolist())}
    tooth = np.array([[row.get((p, j + on), -1) for j in pairs.tolist()] for p, on in zip(*moments[1:], strict=True)])
    for side in _FACE_SIDES:
        felt = rooted.along_fillets(side, force, z)
        felt = np.concatenate([felt, np.zeros((*felt.shape[:2], 1))], axis=2)  # the last is of no tooth
        stress[side] = np.ascontiguousarray(felt[:, :, tooth].transpose(1, 2, 3, 0))
        own = rooted.solution.fillets[side].place * pair.driver.module
        places[side] = np.stack([placed_in_mesh(pair, member, own, j) for j in pairs.tolist()])
    return FilletStress(places, stress)


def _largest_over_face(rooted: RootedLines, force: Array, z: Array, moments: _Moments) -> LargestStress:
    """As ``root-stress-history`` finds it, and where it stands in the picture."""
    pair, member, fillet = rooted.pair, rooted.member, rooted.solution.fillets["tension"]
    one = rooted.stress("tension", force, z)
    tooth, place = (int(i) for i in np.unravel_index(int(first_of_largest(one.value)), one.value.shape))
    position, number = rooted.teeth[tooth].tolist()
    shown = int(np.flatnonzero(moments.position == position)[0])
    number -= int(moments.on[shown])
    radius = float(one.radius[tooth, place])
    up = np.hypot(*fillet.place) * pair.driver.module
    at = np.array([np.interp(radius, up, line * pair.driver.module) for line in fillet.place])
    return LargestStress(
        float(one.value[tooth, place]), member, number, float(moments.roll[shown]),
        placed_in_mesh(pair, member, at, number), radius, float(z[place]),
    )  # fmt: skip


#: Roll positions of a moving picture stand so far apart at least [base pitches].
_STEP = 0.019


@dataclass(frozen=True)
class MeshInputs:
    """What these stages read of the case besides the loaded pair.

    Parameters
    ----------
    tips : bool
        Whether tip corners touch beyond the path of contact.
    name : str
        Of the pair.
    gears : mapping of str to str
        Names of the gears by member.
    """

    tips: bool
    name: str = field(compare=False)
    gears: Mapping[Member, str] = field(compare=False)


def mesh_inputs(scene: Scene, name: str) -> MeshInputs:
    """Read them."""
    return MeshInputs(scene.case.effects.corner_contact, name, gears_of(scene, name))


def picture_positions(roll: Array, pitch: float, kept: float) -> Index:
    """Numbers of the roll positions that a moving picture needs: evenly many, both sides of every jump, and one more.

    Parameters
    ----------
    roll : ndarray, shape (P,)
        Ascending [m].
    pitch : float
        Base pitch [m].
    kept : float
        Roll position that is needed in any case [m].
    """
    chosen, jump = [0], np.diff(roll) < 1e-5 * pitch
    for i in range(1, roll.size):
        beside = jump[i - 1] or (i < roll.size - 1 and jump[i])
        if beside or i == roll.size - 1 or roll[i] == kept or roll[i] - roll[chosen[-1]] >= _STEP * pitch:
            chosen.append(i)
    return np.array(chosen)


def _compute(asked: MeshInputs, upstream: Upstream, work: Work) -> StressInMeshData:
    plane = Task(PLANE.stage, asked.name) in upstream
    return (_stress if plane else _stress_over_face)(asked, upstream, work)


STRESS_IN_MESH = teeth_stage(
    needs=needs_gears,
    inputs=mesh_inputs,
    compute=_compute,
    present=UNSHOWN.present,
    cites=citing(*RING),
    forecast=lambda _scene, _name: forecasts.constant(0.15),
)
