"""Stage ``stress-in-mesh``: root stress along the fillets of two gears in mesh, for their moving picture."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.engine.citation import citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage
from fegear.frozen import ReadOnlyArrays
from fegear.geometry.pair import MEMBERS
from fegear.models.pair_checks import check_relief
from fegear.models.root_stress_source import FINITE_ELEMENTS, root_stress_source
from fegear.results import forecasts
from fegear.results.drawn_pair import placed_in_mesh
from fegear.results.gear_solution import solution_of
from fegear.results.gears_in_mesh import mesh_inputs, needs_mesh, picture_positions
from fegear.results.loaded_pair import EFFECTS, loaded_pair, plane_pairs
from fegear.results.sources import RING
from fegear.results.transmission_error import POSITIONS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.arrays import Array
    from fegear.engine.stage import Upstream, Work
    from fegear.fem import GearInfluence
    from fegear.fem.influence import Side
    from fegear.geometry import GearPair
    from fegear.geometry.pair import Member
    from fegear.results.gears_in_mesh import MeshInputs

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
    from fegear.contact.mesh_curve import BESIDE, roll_positions
    from fegear.contact.root_stress_history import superposed_stress
    from fegear.contact.tooth_stress import with_peaks

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
    largest = _largest(state.x, pairs, gears, solved, asked)
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
) -> LargestStress:
    found = []
    for member, one in gears.items():
        values = one.stress["tension"]
        p, tooth, at = (int(i) for i in np.unravel_index(int(values.argmax()), values.shape))
        known = solved[asked.gears[member]]
        radius = float(known.fine.fillets["tension"].radius[at]) * known.gear.module
        place = one.places["tension"][tooth, :, at]
        found.append(
            LargestStress(float(values[p, tooth, at]), member, int(pairs[tooth]), float(roll[p]), place, radius)
        )
    return max(found, key=lambda one: one.value)


STRESS_IN_MESH = Stage(
    subjects=plane_pairs,
    needs=needs_mesh,
    inputs=mesh_inputs,
    compute=_stress,
    present=lambda data, _inputs: Outcome(data),
    check=check_relief,
    effects=EFFECTS,
    cites=citing(*RING),
    forecast=lambda _scene, _name: forecasts.constant(0.15),
)
