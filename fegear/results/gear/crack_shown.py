"""Stage ``crack-shown``: cracked teeth of a gear as they open under a load, for the window.

The whole load stands on the cracked tooth, where it is the last one that carries all of it: at the outer end of single
contact; without a pair 100 N/mm in the middle of the flank.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.case.built.odd_gears import cracked_gears
from fegear.case.built.odd_teeth import OddTeeth, odd_teeth_of
from fegear.engine.sheet.sheet import UNSHOWN
from fegear.engine.stage import Stage, Upstream, Work
from fegear.fem.alike_teeth import meshing_order
from fegear.geometry.outline import tooth_outline
from fegear.results import forecasts
from fegear.results.gear.odd_gear import needs_odd_solution, odd_solution_of

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.geometry.gear import Gear

#: Line load without a pair [N/m].
_UNIT = 1e5


@dataclass(frozen=True)
class CrackInputs:
    """Cracks of a gear, and the load that they are shown under.

    Parameters
    ----------
    teeth : OddTeeth
    places : tuple of int
        Which of the gear's `odd_tooth` each crack is.
    ends : tuple of str
        Key that says where each crack ends.
    radius : float
        Of the load [m].
    load : float
        Per face width [N/m].
    pair : str
        Whose load it is; empty without one.
    """

    teeth: OddTeeth
    places: tuple[int, ...]
    ends: tuple[str, ...]
    radius: float
    load: float
    pair: str


@dataclass(frozen=True)
class CrackShown(ReadOnlyArrays):
    """One cracked tooth under the load; lengths in its own frame [m].

    Parameters
    ----------
    tooth : int
        In meshing order.
    place : int
        Which of the gear's `odd_tooth`.
    ends : str
        Key that says where the crack ends.
    back : bool
        Whether it starts in the fillet of the flank that is not loaded.
    path, outline : ndarray, shape (2, n)
        Crack from its mouth to its tip, and the tooth.
    points, moved : ndarray, shape (2, N)
        Of the mesh, and their displacement.
    triangles : ndarray of int, shape (3, M)
    mises : ndarray, shape (N,)
        [Pa].
    left, right, fillets : ndarray of int
        As of `CrackField`.
    contact : ndarray, shape (2,)
        Where the load acts.
    k_1, k_2 : (float, float)
        Stress intensity and its estimated error [Pa m^(1/2)]; the error NaN while a value is moved.
    loss : float
        Of stiffness under that load, beside an ordinary tooth.
    closed : float
        Share of the faces that press on each other.
    """

    tooth: int
    place: int
    ends: str
    back: bool
    path: Array
    outline: Array
    points: Array
    moved: Array
    triangles: Index
    mises: Array
    left: Index
    right: Index
    fillets: Index
    contact: Array
    k_1: tuple[float, float]
    k_2: tuple[float, float]
    loss: float
    closed: float


@dataclass(frozen=True)
class CracksShownData:
    """All cracked teeth of a gear.

    Parameters
    ----------
    gear : Gear
    cracks : tuple of CrackShown
    radius, load, pair
        As of `CrackInputs`.
    """

    gear: Gear
    cracks: tuple[CrackShown, ...]
    radius: float
    load: float
    pair: str


def _inputs(scene: Scene, name: str) -> CrackInputs:
    from fegear.case.odd_tooth import ENDS

    parts = [(n, one.crack) for n, one in enumerate(scene.case.gear[name].odd_tooth) if one.crack is not None]
    places = tuple(n for n, _ in parts)
    ends = tuple(next(key for key in ENDS if getattr(crack, key) is not None) for _, crack in parts)
    gear, teeth = scene.gears[name], odd_teeth_of(scene, name)
    low, high = gear.involute_radii
    for pair in scene.plane_pairs:
        part, meshed = scene.case.pair[pair], scene.pairs[pair]
        load = part.normal_load(meshed)
        if name == getattr(part, teeth.member) and load:
            driver = teeth.member == "driver"
            x = meshed.x_start + meshed.base_pitch if driver else meshed.x_end - meshed.base_pitch
            if not meshed.x_start < x < meshed.x_end:
                x = 0.0
            line = gear.base_radius * np.tan(meshed.working_pressure_angle) + (x if driver else -x)
            radius = float(np.clip(np.hypot(gear.base_radius, line), low, high))
            return CrackInputs(teeth, places, ends, radius, load / meshed.face_width, pair)
    return CrackInputs(teeth, places, ends, 0.5 * (low + high), _UNIT, "")


def _compute(asked: CrackInputs, upstream: Upstream, _work: Work) -> CracksShownData:
    from fegear.fem.plane.odd.crack_field import crack_field

    known = odd_solution_of(upstream, asked.teeth.name)
    gear, plain, fine = known.gear, known.ordinary, known.fine
    m, modulus, shape = gear.module, gear.material.young_modulus, gear.symmetric_tooth
    half = plain.reference_half_width
    found = []
    for (tooth, crack), place, ends in zip(asked.teeth.cracks, asked.places, asked.ends, strict=True):
        number = meshing_order(tooth, gear.teeth, asked.teeth.member)
        near = known.from_middle(number)
        ends_of_flank = known.ends(near)
        radius = float(np.clip(asked.radius, *ends_of_flank))
        field = crack_field(fine, near, radius / m, half / m, known.settings, plain.fine.support)
        k, off = known.stress_intensity(number, number, radius)
        closed = 0.0
        if near in fine.closing:
            loads = {number: (np.array([radius]), np.array([1.0]))}
            change, more = known.closed_intensity(number, loads)
            k, off = np.stack([np.maximum(k[0] + change[0], 0.0), k[1] + change[1]]), off + more
            closed = float(known.faces_under(number, loads)[0])
        own, usual = known.own(number, radius, half), plain.self_compliance(np.array([radius]), np.array([half]))
        angle = float(shape.flank_angle(radius / m))
        found.append(
            CrackShown(
                tooth, place, ends, crack.back, crack.path(shape) * m, tooth_outline(shape) * m, field.points * m,
                field.moved * asked.load / modulus, field.triangles, field.mises * asked.load / m, field.left,
                field.right, field.fillets, radius * np.array([np.sin(angle), np.cos(angle)]),
                (float(k[0, 0]) * asked.load, float(off[0, 0]) * asked.load),
                (float(k[1, 0]) * asked.load, float(off[1, 0]) * asked.load),
                1.0 - float(usual[0] / own[0]), closed,
            )
        )  # fmt: skip
    return CracksShownData(gear, tuple(found), asked.radius, asked.load, asked.pair)


CRACK_SHOWN = Stage(
    subjects=cracked_gears,
    needs=lambda _scene, name: needs_odd_solution(name),
    inputs=_inputs,
    compute=_compute,
    present=UNSHOWN.present,
    forecast=lambda _scene, _name: forecasts.constant(0.1),
)
