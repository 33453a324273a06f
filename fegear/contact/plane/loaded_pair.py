"""A pair of plane teeth under all its loads: the maker of `LoadedTeeth` whose contacts are points of a section."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, distinct
from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.contact.fourier import FourierSeries
from fegear.contact.loaded_teeth import (
    HARMONICS,
    MOST_CYCLES,
    POSITIONS,
    Answer,
    FlankLoad,
    LoadHistory,
    Neglected,
    RootStressInMesh,
    in_a_sentence,
    silent,
)
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.base_pitch import BESIDE, mean_secant_stiffness, roll_positions, secant_stiffness
from fegear.contact.plane.compliance import RootStressInfluence
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.independent_errors import independent_errors
from fegear.contact.plane.largest_on_pair import largest_on_pair
from fegear.contact.plane.neglected_effects import neglected_effects
from fegear.contact.plane.over_revolution import OverRevolution, over_revolution
from fegear.contact.plane.pair_history import PairHistory, pair_history, pair_history_with, quick_history
from fegear.contact.plane.peaks import PASSES
from fegear.contact.plane.shifted_loads import load_shift, transmission_error_shift
from fegear.contact.plane.tooth_stress import ToothStress, alike_states, loaded_states, tooth_stress, with_peaks
from fegear.contact.plane.transmission_error import (
    pair_stiffness,
    quick_points,
    quick_transmission_errors,
    revolution,
    thinned,
    transmission_error,
)
from fegear.geometry.pair import MEMBERS, GearPair, Member

if TYPE_CHECKING:
    from fegear.contact.fourier import Panels
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.contact.surface import FrictionLaw
    from fegear.contact.tooth_loss import ToothLoss

#: Places along the path at which losses are integrated (half as many for the estimate of their error), and at which the
#: state of the flanks is looked at.
_LOSSES, _SURFACE = 801, 400


@dataclass(frozen=True)
class LoadedPair:
    """A pair ready for load sharing.

    Parameters
    ----------
    engagement : Engagement
        With the effects of its case.
    shifted : tuple of Engagement
        The same with one compliance each off by its estimated error; empty where the source states none.
    spec : PairSpec
        What it was made of: loads, effects, flanks.
    sources : tuple of str
        How the compliance sources describe themselves.
    neglected : Neglected
        What the effects that are off would change.
    exact : bool
        Whether the transmission error is integrated between changes of contact, too: not while a value is being moved.
    """

    engagement: Engagement
    shifted: tuple[Engagement, ...]
    spec: PairSpec
    sources: tuple[str, ...]
    neglected: Neglected = field(default_factory=Neglected, compare=False)
    exact: bool = True

    __repr__ = in_a_sentence

    @property
    def pair(self) -> GearPair:
        """Both gears in mesh."""
        return self.engagement.pair

    @property
    def loads(self) -> tuple[float, ...]:
        """All of them, ascending [N]."""
        return self.spec.loads

    @property
    def nominal(self) -> float:
        """The one that single numbers are for [N]."""
        return self.spec.nominal

    def neglects(self, answers: Sequence[Answer], loads: Sequence[float]) -> Neglected:
        """See `LoadedTeeth`."""
        return neglected_effects(self.spec, self.engagement, answers, loads)

    @property
    def about(self) -> str:
        """Its sources of compliance."""
        return f"Compliances: {'; '.join(self.sources)}."

    @property
    def _at(self) -> int:
        return self.loads.index(self.nominal)

    def history(self) -> LoadHistory:
        """See `LoadedTeeth`.

        The error of the loads is the change by the shifted compliances; where these cancel no less than that by the
        part of their errors which every tooth pair has by itself.
        """
        e = self.engagement
        where = ", corner contact outside it" if e.corner_contact else ""
        if self._quick is not None:
            found = quick_history(e, e.solve(e.grid(self._quick.x), self.loads))
            largest = largest_on_pair(e, (), self.nominal, found, self._at, 0)
            return LoadHistory(found, self._at, None, self._off_path(found), where, found.x.size, largest)
        path = self.pair.x_start, self.pair.x_end
        found, apart = pair_history_with(
            e, self.loads, POSITIONS, 0, lambda state: independent_errors(state, self.shifted, path).load
        )
        shifts = [load_shift(found, pair_history(other, self.loads, POSITIONS)) for other in self.shifted]
        error = np.maximum(np.sum(shifts, axis=0), apart) if shifts else None
        passes = PASSES if self.exact else 1
        largest = largest_on_pair(e, self.shifted, self.nominal, found, self._at, passes)
        return LoadHistory(found, self._at, error, self._off_path(found), where, POSITIONS, largest)

    @cached_property
    def _quick(self) -> Panels | None:
        """Points at which all is read while a value is being moved, of gears whose teeth are alike."""
        return None if self.exact or self.engagement.uneven else quick_points(self.engagement)

    @property
    def _positions(self) -> Array:
        """Roll positions of curves over the base pitch [m]."""
        return roll_positions(self.engagement, POSITIONS) if self._quick is None else self._quick.x

    def _curve_positions(self, exact: Sequence[TransmissionError]) -> Array:
        """The same, and both sides of each change of contact under every load, so that curves are straight between."""
        if self._quick is not None or not self.exact:
            return self._positions
        known = self.engagement.breaks
        # the same place found anew for every load, to its last digits
        every = distinct(known, *(te.points.breaks for te in exact), within=4.0 * BESIDE)
        return roll_positions(self.engagement, POSITIONS, every[~np.isin(every, known)].tolist())

    def _off_path(self, found: PairHistory) -> Array:
        return np.where((found.x < self.pair.x_start) | (found.x > self.pair.x_end), 1.0, 0.0)

    def transmission_error(self, progress: Callable[[float], None] = silent) -> ErrorOverPitch:
        """See `LoadedTeeth`; integrated exactly between its jumps."""
        e, i = self.engagement, self._at
        exact = [] if self.exact else quick_transmission_errors(e, self.loads, HARMONICS)
        for number, load in enumerate(self.loads if self.exact else ()):
            exact.append(transmission_error(e, load, HARMONICS))
            progress((number + 1) / (len(self.loads) + 2))
        curve = e.solve(e.grid(self._curve_positions(exact)), self.loads)
        # with a contact ratio below 1 perfect flanks have positions without any pair on the path
        perfect = pair_stiffness(e, self.nominal, HARMONICS, self._quick) if e.pair.contact_ratio >= 1.0 else None
        te_mean, peak_to_peak, effective, local = (
            np.array([getattr(te, key) for te in exact])
            for key in ("mean", "peak_to_peak", "effective_error", "average_stiffness")
        )
        shifts = [transmission_error_shift(te, self.shifted) for te in exact]
        on_path = self._on_path()
        return ErrorOverPitch(
            self.pair,
            self.loads,
            i,
            POSITIONS,
            "integrated exactly between discontinuities"
            if self.exact
            else "integrated between geometric discontinuities",
            tuple(te.series for te in exact),
            shifts[i],
            x=curve.x,
            te=curve.transmission_error,
            mesh_stiffness=secant_stiffness(curve),
            pairs_in_contact=(curve.loads > 0.0).sum(axis=0),
            local_stiffness=curve.local_stiffness,
            te_mean=te_mean,
            te_peak_to_peak=peak_to_peak,
            te_effective=effective,
            local_stiffness_mean=local,
            mesh_stiffness_mean=mean_secant_stiffness(exact[i]),
            mesh_compliance_mean=None if perfect is None else perfect.mean_compliance,
            rotational=self._rotational(),
            cycles=e.cycles,
            shifts=tuple(one for one in shifts if one is not None),
            corner_contact=e.corner_contact,
            mesh_stiffness_on_path=None if on_path is None else mean_secant_stiffness(on_path),
            local_stiffness_on_path=None if on_path is None else on_path.average_stiffness,
        )

    def _on_path(self) -> TransmissionError | None:
        """Under the nominal load without contact outside the path of contact, where there is such contact."""
        e = self.engagement
        if not (self.exact and e.corner_contact) or e.uneven or e.pair.contact_ratio < 1.0:
            return None
        return transmission_error(replace(e, corner_contact=False), self.nominal, HARMONICS)

    def _rotational(self) -> FourierSeries | None:
        """Harmonics over the base pitches after which the same teeth meet again, where they are not too many."""
        e, cycles = self.engagement, self.engagement.cycles
        return revolution(e, self.nominal, cycles, 3 * cycles) if e.uneven and cycles <= MOST_CYCLES else None

    def over_revolution(self, positions: int = POSITIONS) -> OverRevolution:
        """Load sharing, transmission error and mesh stiffness until the same teeth meet again, under the nominal load.

        Of gears whose teeth are alike that is one base pitch.

        Parameters
        ----------
        positions : int
            Even steps over a base pitch.
        """
        return over_revolution(self.engagement, self.nominal, positions, self.shifted)

    def error_under(self, loads: ArrayLike, positions: int) -> tuple[Array, Array, Array]:
        """See `LoadedTeeth`."""
        wanted = np.atleast_1d(np.asarray(loads, dtype=float))
        x = roll_positions(self.engagement, positions)
        state = self.engagement.solve(self.engagement.grid(x), tuple(wanted.tolist()))
        return x, wanted, state.transmission_error

    def root_stress(
        self,
        sources: Mapping[Member, Mapping[str, RootStressInfluence]],
        progress: Callable[[float], None] = silent,
        *,
        estimates: bool = True,
    ) -> RootStressInMesh:
        """See `LoadedTeeth`; with estimates its positions have the peaks of every source."""
        e = self.engagement
        if self._quick is not None:
            states = alike_states(e.solve(e.grid(self._quick.x), self.loads).at(thinned(self._quick)))
        else:
            x = self._positions
            if estimates:
                x = with_peaks(e, self.nominal, x, {member: (*sources[member].values(),) for member in MEMBERS})
            states = loaded_states(e, self.shifted, self.loads, x)
        stress: dict[Member, dict[str, ToothStress]] = {}
        for number, member in enumerate(MEMBERS):
            stress[member] = {
                name: tooth_stress(e, states, member, source, estimates=estimates)
                for name, source in sources[member].items()
            }
            progress((number + 1) / len(MEMBERS))
        notes = {member: {name: source.remarks for name, source in sources[member].items()} for member in MEMBERS}
        return RootStressInMesh(stress, notes)

    def losses(self, speed: float, law: Callable[[float], FrictionLaw]) -> tuple[tuple[ToothLoss, ...], float]:
        """See `LoadedTeeth`."""
        from fegear.contact.tooth_loss import change_of_loss, loss_over_path

        pair, i = self.pair, self._at
        fine, coarse = (pair_history(self.engagement, self.loads, count) for count in (_LOSSES, _LOSSES // 2))
        found = tuple(loss_over_path(pair, fine, k, speed, law(load)) for k, load in enumerate(self.loads))
        return found, change_of_loss(found[i], loss_over_path(pair, coarse, i, speed, law(self.nominal)))

    def flank_load(self, pair: GearPair) -> FlankLoad:
        """See `LoadedTeeth`."""
        found = pair_history(self.engagement, [self.nominal], _SURFACE)
        off = self._off_path(found) > 0.0
        outside = float(np.where(off, found.share[:, 0], 0.0).max(initial=0.0))
        return FlankLoad(found.x[~off], np.zeros(1), (found.load[~off, 0] / pair.face_width)[None, :], False, outside)
