"""Strain under a gauge in a root fillet of a vibrating train: forces on its tooth and those around it (Mark, 3.37).

On a 3D tooth the forces along the contact lines change with the transmission error, each station's by its part of the
tangent mesh stiffness: the strain is the quasi-static one and its slope times what vibration adds to that error.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.effects import RootEffects
from fegear.base.shown import shown, shows
from fegear.contact.gauge_strain import at_positions, reach_of_places
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.root_stress import Felt, RootStress
from fegear.dynamics.train.single_tooth import error_increments, force_at, forces_around, positions, rows_around

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.contact.wide.gauge_on_face import GaugeAboutLoad
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.dynamics.train.tooth_force import ToothForce
    from fegear.fem.plane.gauge import GaugesOnFillet
    from fegear.geometry.pair import GearPair, Member

#: Positions in each of the base pitches before and after the contact of the tooth.
_BESIDE = 60
#: Radii at which the error of the stress per load is looked at.
_FEW = 9


@dataclass(frozen=True)
class ToothStrain:
    """What a gauge sees in motion; arrays over P positions of its tooth.

    Parameters
    ----------
    pair : GearPair
        As it runs.
    member : {"driver", "driven"}
        What the gear of the gauge is there.
    displacement : ndarray, shape (G,)
        Of grids that are glued elsewhere along the fillet [m].
    displaced : ndarray, shape (P, G)
        Their strain, excited by all meshes.
    error : ndarray, shape (P,)
        Estimated error of what finite elements give per load, of all loads together; NaN if unknown.
    """

    pair: GearPair
    member: Member
    displacement: Array
    displaced: Array
    error: Array
    x: Array = shown("mm", "position of the tooth's contact on the line of action", table="strain")
    time: Array = shown("s", "time from phase zero of the mesh", name="t", table="strain")
    total: Array = shown(
        "um/m", "mean strain under the grid, excited by all meshes", name="strain", label="strain", table="strain"
    )
    own: Array = shown("um/m", "without the contribution of the other meshes", name="strain_own_mesh", table="strain")
    static: Array = shown("um/m", "quasi-static", name="static_strain", table="strain")

    @property
    @shows(
        "deg", "rotation of the gear, zero with its tooth in contact at the pitch point", label="rotation of the gear",
        table="strain",
    )  # fmt: skip
    def angle(self) -> Array:
        """Of the gear of the gauge, in the sense of its rotation [rad], shape (P,)."""
        return self.x / self.pair.gear(self.member).base_radius

    @property
    def speed(self) -> float:
        """Of the gear of the gauge [rad/s]."""
        return float(np.ptp(self.angle) / np.ptp(self.time))

    @property
    def _peak(self) -> int:
        """Position of the largest strain, in the sense of the largest static one."""
        sign = np.sign(self.static[int(np.argmax(np.abs(self.static)))])
        return int(np.argmax(sign * self.total))

    @property
    @shows("um/m", "peak of the mean strain under the grid, excited by all meshes", name="dynamic_peak_strain")
    def peak(self) -> float:
        """In motion."""
        return float(self.total[self._peak])

    @property
    def peak_error(self) -> float | None:
        """Estimated; None where it is not known."""
        found = float(self.error[self._peak])
        return None if np.isnan(found) else found

    @property
    @shows("deg", "rotation of the gear at the dynamic peak", name="dynamic_peak_angle")
    def peak_angle(self) -> float:
        """[rad]."""
        return float(self.angle[self._peak])

    @property
    @shows("", "dynamic / quasi-static peak strain", name="dynamic_strain_ratio")
    def ratio(self) -> float:
        """Of the peaks."""
        return self.peak / float(self.static[int(np.argmax(np.abs(self.static)))])

    @property
    @shows("um/m", "maximum change of the dynamic peak within placement_tolerance", name="dynamic_change_by_placement")
    def change_by_placement(self) -> float:
        """Of the peaks at all displacements."""
        return max(self.reach_of_placement)

    @property
    def reach_of_placement(self) -> tuple[float, float]:
        """How far below and above the dynamic peak, in size, that of another place is."""
        return reach_of_places(self.peak_of_places, self.peak)

    @property
    def peak_of_places(self) -> Array:
        """Dynamic peak at every displacement, shape (G,)."""
        sign = np.sign(self.peak)
        return np.asarray(sign * (sign * self.displaced).max(axis=0))

    def less(self, second: ToothStrain) -> ToothStrain:
        """What a half bridge sees that has a second gauge of the tooth in the adjacent arm; errors add.

        Displaced is the grid of the first gauge.
        """
        total, own, static, error = (
            at_positions(self.x, second.x, one) for one in (second.total, second.own, second.static, second.error)
        )
        return replace(
            self, displaced=self.displaced - total[:, None], error=self.error + error, total=self.total - total,
            own=self.own - own, static=self.static - static,
        )  # fmt: skip

    def less_displaced(self, second: ToothStrain) -> Array:
        """The same with the grid of the second gauge displaced, shape (P, G)."""
        return self.total[:, None] - at_positions(self.x, second.x, second.displaced)


def tooth_strain(
    train: GearTrain, mesh: int, member: Member, gauges: GaugesOnFillet, displacement: Array, speed: float, count: int,
    harmonics: int, number: int = 0, *, coupled: bool = True, effects: RootEffects | None = None,
) -> ToothStrain:  # fmt: skip
    """Follow a gauge from a base pitch before its tooth's contact to one after it, at one speed.

    Parameters
    ----------
    train : GearTrain
    mesh : int
    member : {"driver", "driven"}
        What the gear of the gauge is as the mesh runs.
    gauges : GaugesOnFillet
        At every displacement.
    displacement : ndarray, shape (G,)
        Zero is among them [m].
    speed : float
        Of the body that speeds refer to [rad/s].
    count : int
        Even positions over the path of contact.
    harmonics : int
    number : int
        Of the tooth pair, in meshing order.
    coupled : bool
        Whether the forces on the teeth around count.
    effects : RootEffects, optional
        On root stress only; by default the usual ones.
    """
    pair = train.meshes[mesh].pair
    inside, pitch = positions(train, mesh, count, number), pair.base_pitch
    before, after = (np.linspace(end - pitch, end, _BESIDE, endpoint=False) for end in (inside[0], inside[-1] + pitch))
    x = np.concatenate([before, inside, np.append(after[1:], inside[-1] + pitch)])
    force = force_at(train, mesh, speed, x, harmonics, number)
    source = finite_element_compliance(gauges.influence)
    roots = RootStress(source, member, gauges.side, coupled, effects or RootEffects())
    around = forces_around(train, mesh, force, number, speed, harmonics, roots.reach)
    rows, seen = rows_around(roots, pair, around), gauges.strain_per_stress * gauges.weights().T
    displaced, own, static = (
        roots.superposed(
            [Felt(getattr(one, part) / pair.face_width, rows[k]) for k, one in around.items()], rows[0].shape
        )
        @ seen
        for part in ("with_others", "total", "static")
    )
    at = int(np.argmin(np.abs(displacement)))
    return ToothStrain(
        pair, member, displacement, displaced, _error(gauges.only(at), roots, pair, around),
        x, force.time, displaced[:, at], own[:, at], static[:, at],
    )  # fmt: skip


def strain_on_face(
    train: GearTrain, mesh: int, member: Member, known: GaugeAboutLoad, displacement: Array, speed: float, count: int,
    harmonics: int,
) -> ToothStrain:  # fmt: skip
    """Follow a gauge on a 3D tooth over all positions at which its strain is known, at one speed.

    Parameters
    ----------
    train : GearTrain
    mesh : int
    member : {"driver", "driven"}
        What the gear of the gauge is as the mesh runs.
    known : GaugeAboutLoad
        About the mean force of the mesh.
    displacement : ndarray, shape (G,)
        Zero is among them [m].
    speed : float
        Of the body that speeds refer to [rad/s].
    count : int
        Even positions, beside those at which the strain is known.
    harmonics : int
    """
    made, at = train.meshes[mesh], int(np.argmin(np.abs(displacement)))
    # where the named driven gear drives, x counts the other way
    places, rows = (known.x, slice(None)) if made.a_drives else (-known.x[::-1], slice(None, None, -1))
    x = np.unique(np.concatenate([places, np.linspace(places[0], places[-1], count)]))
    phase = x / made.pair.base_pitch
    own, others = error_increments(train, mesh, speed, phase, harmonics)

    def over(values: Array) -> Array:
        return at_positions(x, places, values[rows].reshape(places.size, -1))

    static, slope = over(known.strain), over(known.slope)
    total, alone = static + slope * (own + others)[:, None], static + slope * own[:, None]
    error = over(known.error)[:, 0] + over(known.slope_error)[:, 0] * np.abs(own + others)
    time = phase / float(train.train.mesh_frequencies(speed / train.speed_ratio)[mesh])
    return ToothStrain(
        made.pair, member, displacement, total, error, x, time, total[:, at], alone[:, at], static[:, at]
    )  # fmt: skip


def _error(gauge: GaugesOnFillet, roots: RootStress, pair: GearPair, around: Mapping[int, ToothForce]) -> Array:
    """What finite elements leave in the strain under each load, as the root of the sum of squares, shape (P,)."""
    few = np.linspace(pair.x_start, pair.x_end, _FEW)
    squares = np.zeros(around[0].x.size)
    for k, force in around.items():
        usual = gauge.stress_error(-roots.tooth(k), pair.radius(few, roots.member))[0] / pair.face_width
        squares += (np.interp(force.x, few, usual) * force.with_others) ** 2
    return np.asarray(abs(gauge.strain_per_stress) * np.sqrt(squares))
