"""The law of `mesh_law` for teeth with a width: solved all over the flanks at the roll positions of their pair.

Contact lines are solved at the roll positions of the whole base pitch alone, under every force of the law. Between them
a curve is the polynomial through those of its piece of the base pitch, or straight where flanks come to bear or let go
on the way.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Mask
from fegear.base.errors import InputError
from fegear.contact.fourier import Panels
from fegear.contact.wide.loaded import FlankPair, LoadedFlanks
from fegear.contact.wide.loaded_pair import LoadedWidePair
from fegear.contact.wide.over_pitch import every_second
from fegear.contact.wide.transmission_error import curve_through
from fegear.dynamics.planetary.mesh_law import MeshSprings, forces, springs

#: Forces from this share of the mean one on tell where a curve has corners; below it flanks touch in spots.
_TELLS = 0.3
#: Roll positions of a law: corner contact bends the curve over a twentieth of a base pitch, and phases of a set leave
#: the harmonics that come of it alone. With half as many a set's peak to peak is 7 % off, with twice as many .04 %.
_POSITIONS = 96
#: What half of the roll positions change of straight lines is three times what all of them miss.
_OF_HALF = 1.0 / 3.0


@dataclass(frozen=True)
class FlankSprings:
    """Teeth with a width whose contact lines are solved for forces up to that of all planets together.

    Parameters
    ----------
    teeth : LoadedWidePair
    load : float
        Mean mesh force: that of an equal share [N].
    planets : int
        Which may all come to rest on one.
    """

    teeth: LoadedWidePair
    load: float
    planets: int

    def __post_init__(self) -> None:
        """Refuse teeth that differ from one another."""
        if self.teeth.gaps.driver_spacing.size or self.teeth.gaps.driven_spacing.size:
            raise InputError("spacing_errors", "(given)", "are not supported in a planetary set", "use identical teeth")

    @property
    def cycles(self) -> int:
        """All base pitches are the same."""
        return 1

    @cached_property
    def solved(self) -> LoadedFlanks:
        """The flanks under every force of the law."""
        return self._flanks.solve(
            forces(self.load, self.planets)[0], self.teeth.gaps, self._flanks.compliance(self.load)
        )

    @property
    def _flanks(self) -> FlankPair:
        flanks = self.teeth.flanks
        return replace(flanks, positions=max(flanks.positions, _POSITIONS))

    @property
    def _points(self) -> Panels:
        return self._flanks.points

    @cached_property
    def _straight(self) -> Mask:
        """Pieces of the base pitch, by number, within which a tooth pair comes to bear or lets go."""
        points, force = self._points, forces(self.load, self.planets)[0]
        found = np.zeros(points.breaks.size + 1, dtype=bool)
        bears = self.solved.pair_load[:, :, force >= _TELLS * self.load] > 0.0
        own = np.searchsorted(points.breaks, points.x)
        for piece in np.unique(own):
            here = bears[:, own == piece]
            found[piece] = bool((here.any(axis=1) & ~here.all(axis=1)).any())
        return found

    @property
    def breaks(self) -> Array:
        """Places of jumps and kinks [base pitches]."""
        points = self._points
        corners = points.x[self._straight[np.searchsorted(points.breaks, points.x)]]
        return np.concatenate([points.breaks, corners]) / points.period

    def at(self, place: Array) -> MeshSprings:
        """Springs at places [base pitches from the pitch point], shape (Q,)."""
        points, solved, (force, at_mean) = self._points, self.solved, forces(self.load, self.planets)
        x = points.breaks[0] + np.mod(place * points.period - points.breaks[0], points.period)
        straight = self._straight[np.searchsorted(points.breaks, x)]

        def curve(values: Array) -> Array:
            through = curve_through(points, values, x)
            return np.where(straight, np.interp(x, points.x, values, period=points.period), through)

        te = solved.transmission_error
        approach = np.stack([curve(one) for one in te.T], axis=1)
        return springs(force, approach, curve(solved.contact.stiffness[:, 0]), self._off(x, te[:, at_mean]))

    def _off(self, x: Array, mean: Array) -> Array:
        """Estimated errors of the approach under the mean force, by the solutions and by the roll positions, (2, Q)."""
        points, teeth = self._points, self.teeth
        if not teeth.estimated:
            return np.zeros((0, x.size))
        by_solution = np.interp(x, teeth.found.lines.roll, teeth.error.transmission_error[:, teeth.at],
                                period=points.period)  # fmt: skip
        kept = every_second(points)
        fewer = np.interp(points.x, points.x[kept], mean[kept], period=points.period)
        by_half = np.interp(x, points.x, _OF_HALF * (fewer - mean), period=points.period)
        return np.stack([by_solution, by_half])
