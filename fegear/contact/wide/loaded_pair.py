"""A pair of gears with a width under all its loads: the maker of `LoadedTeeth` whose contacts are lines."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, first_of_largest
from fegear.contact.error_over_pitch import ErrorOverPitch, TransmissionErrorShift
from fegear.contact.loaded_teeth import (
    Answer,
    FlankLoad,
    Largest,
    LoadHistory,
    Neglected,
    RootStressInMesh,
    in_a_sentence,
    silent,
)
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.tooth_stress import ToothStress
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.error import OF_GEARS_HARMONICS, OF_GEARS_MEAN, OF_GEARS_SHAPE, FlankError
from fegear.contact.wide.flanks import open_gaps
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.largest_root_stress import largest_over_face
from fegear.contact.wide.loaded import FlankPair, LoadedFlanks
from fegear.contact.wide.neglected_effects import neglected_effects
from fegear.contact.wide.over_pitch import OverPitch, Stated, every_second
from fegear.contact.wide.root_stress import RootedLines, StressOverFace
from fegear.contact.wide.transmission_error import (
    FlankTransmissionError,
    flank_transmission_error_shift,
    flank_transmission_errors,
)
from fegear.fem.plane.influence import Side
from fegear.fem.solid.influence import SolidInfluence
from fegear.fem.solid.solution import SolidSolution
from fegear.geometry.pair import MEMBERS, GearPair, Member

if TYPE_CHECKING:
    from fegear.contact.surface import FrictionLaw
    from fegear.contact.tooth_loss import ToothLoss

#: Places along path and face at which the state of the flanks is looked at, and the share of both at either end at
#: which the load is known by extrapolation alone.
_SURFACE, _MARGIN = (121, 41), 1e-3


@dataclass(frozen=True)
class LoadedWidePair:
    """A pair with a width under every load, and all that further questions about it need.

    Parameters
    ----------
    flanks : FlankPair
        The pair, ready to be loaded again under other gaps and loads.
    spec : PairSpec
        What it was made of: loads, effects, flanks.
    known : FlankCompliance
        Its compliances at all roll positions, made for the nominal load.
    gaps : FlankGaps
        What keeps the flanks apart, of the effects that are on.
    found : LoadedFlanks
        Under every load.
    over : OverPitch
        What is stated of the whole base pitch under every load, at as many roll positions as that needs.
    error : FlankError
        Estimated errors of `found`, and of what is stated.
    unloaded : ndarray, shape (P,)
        Transmission error of the rigid flanks at the roll positions of `found` [m]; NaN where no error is estimated.
    beside : float
        By how much gaps are off because modified flanks touch beside the contact lines of unmodified ones [m]; 0 where
        no error is estimated.
    missed : float
        Share by which compliances of slices are known to be off; 0 for solids.
    neglected : Neglected
        What the effects that are off would change, where it was asked for; see `neglects`.
    """

    flanks: FlankPair
    spec: PairSpec
    known: FlankCompliance
    gaps: FlankGaps
    found: LoadedFlanks
    over: OverPitch
    error: FlankError
    unloaded: Array
    beside: float
    missed: float
    neglected: Neglected = field(default_factory=Neglected)

    __repr__ = in_a_sentence

    @property
    def pair(self) -> GearPair:
        """Both gears in mesh."""
        return self.found.pair

    @property
    def loads(self) -> tuple[float, ...]:
        """All of them, ascending [N]."""
        return self.spec.loads

    @property
    def nominal(self) -> float:
        """The one that single numbers are for [N]."""
        return self.spec.nominal

    @property
    def unrelieved(self) -> FlankGaps:
        """What keeps the flanks apart of the effects that are on, without reliefs and spacing errors."""
        return open_gaps(replace(self.spec, relief=False, spacing_errors=False))

    def neglects(self, answers: Sequence[Answer], loads: Sequence[float]) -> Neglected:  # noqa: ARG002  (as of every loaded pair)
        """See `LoadedTeeth`: of mean transmission error and K_Hbeta, at the nominal load."""
        return neglected_effects(self.spec, self.flanks, self.gaps, self.over)

    @property
    def at(self) -> int:
        """Number of the nominal load."""
        return self.loads.index(self.nominal)

    @property
    def coupling(self) -> bool:
        """Whether a tooth feels the loads of those beside it."""
        return self.flanks.coupling

    @property
    def estimated(self) -> bool:
        """Whether errors were estimated."""
        return self.error.coarse is not self.found

    @property
    def _missed(self) -> float:
        """Share by which compliances are known to be off, not a number where no error is estimated."""
        return self.missed if self.estimated else math.nan

    @property
    def about(self) -> str:
        """What the gears are solved as."""
        return f"3D gears, {'coupled slices' if self.missed else 'solid'}."

    @cached_property
    def stated(self) -> Stated:
        """Numbers of the whole base pitch under every load."""
        return self.over.stated

    @cached_property
    def largest(self) -> Largest:
        """Largest share and pressure at the nominal load, for every result that states them.

        Both stand between the roll positions of `found`, and are looked for at those of the whole base pitch; what half
        of these miss of the share counts as an error of it.
        """
        i, lines = self.at, self.over.found.lines
        share = self.over.found.share[:, :, i].max(axis=0)
        missed = float(share.max() - share[every_second(self.over.points)].max())
        inner = self.over.found.smooth_pressure[:, :, i]
        p, s = np.unravel_index(int(first_of_largest(inner)), inner.shape)
        place = (
            "on contact lines longer than one module, away from tip and form circles, at x = "
            f"{lines.x[p, s] * 1e3:.4g} mm, z = {lines.z[p, s] * 1e3:.4g} mm"
        )
        return Largest(
            float(share.max()), float(self.error.share[:, :, i].max()) + missed, float(inner.max()),
            float(self.error.largest_pressure[i]), place,
        )  # fmt: skip

    @property
    def places_along(self) -> Array:
        """Places along the face at which root stress is looked for [m], both ends among them."""
        from fegear.contact.wide.root_stress import places_along

        return places_along(self.found.lines, self.pair.driver.module)

    def history(self) -> LoadHistory:
        """See `LoadedTeeth`; errors are the change by the coarser solution, and what slices miss."""
        from fegear.contact.wide.pair_history import flank_pair_history, history_error

        coarse, missed = self.error.coarse, self._missed
        found = flank_pair_history(self.found, self.gaps.at(self.pair, self.found.lines, self.found.load))
        again = flank_pair_history(coarse, self.gaps.at(self.pair, coarse.lines, coarse.load))
        error = history_error(found, again) + missed * found.load * (1.0 - found.share)
        where = (
            " at mid-face; outside it the contact line covers only part of the face width"
            if self.pair.driver.helix_angle
            else ""
        )
        return LoadHistory(found, self.at, error, None, where, found.x.size, self.largest)

    def transmission_error(self, progress: Callable[[float], None] = silent) -> ErrorOverPitch:
        """See `LoadedTeeth`; numbers of the base pitch are of more roll positions than the curves, where these need."""
        over, i, found = self.over, self.at, self.found
        each = [
            replace(te, peak_to_peak=float(swing))
            for te, swing in zip(
                flank_transmission_errors(over.found, over.points), over.stated.peak_to_peak, strict=True
            )
        ]
        curves = flank_transmission_errors(found, self.flanks.points)
        longer, coarse = (
            flank_transmission_errors(one, self.flanks.points) if self.estimated else curves
            for one in (self.error.longer, self.error.coarse)
        )
        progress(0.5)
        perfect = self._mean_without_gaps()
        parts = zip(each, curves, longer, coarse, strict=True)
        of_gears = OF_GEARS_MEAN, OF_GEARS_SHAPE, OF_GEARS_HARMONICS
        shifts = [_missed_too(flank_transmission_error_shift(*one, of_gears), one[0], self._missed) for one in parts]
        # What is stated of the whole base pitch is stated once.
        means, swings = self.error.mean.tolist(), self.error.peak_to_peak.tolist()
        shifts = [
            replace(one, mean=mean, peak_to_peak=swing) for one, mean, swing in zip(shifts, means, swings, strict=True)
        ]
        uneven = bool(self.gaps.driver_spacing.size or self.gaps.driven_spacing.size)
        effective, local = (
            np.array([getattr(te, key) for te in each]) for key in ("effective_error", "average_stiffness")
        )
        return ErrorOverPitch(
            self.pair,
            self.loads,
            i,
            each[i].values.size,
            f"from {each[i].values.size} mesh positions over the base pitch",
            tuple(te.series for te in each),
            shifts[i],
            x=found.lines.roll,
            te=found.transmission_error,
            mesh_stiffness=np.stack([te.secant for te in curves], axis=1),
            pairs_in_contact=(found.pair_load > 0.0).sum(axis=0),
            local_stiffness=np.stack([te.local for te in curves], axis=1),
            te_mean=self.stated.mean,
            te_peak_to_peak=self.stated.peak_to_peak,
            te_effective=effective,
            local_stiffness_mean=local,
            mesh_stiffness_mean=each[i].mean_secant,
            # else tip edges carry where no pair is on the path, and perfect flanks have no stiffness there
            mesh_compliance_mean=perfect / self.nominal if self.pair.total_contact_ratio >= 1.0 else None,
            te_error=self.error.transmission_error[:, i],
            only=self.gaps.base_pitch if uneven else None,
            shifts=tuple(shifts) if self.estimated else (),
            corner_contact=self.spec.corner_contact,
        )

    def _mean_without_gaps(self) -> float:
        """Mean transmission error of perfect flanks at the nominal load [m], recalled where it is known."""
        known, flanks = self.over.found.known, self.flanks
        return flanks.cache.call(mean_without_gaps, flanks, known, self.nominal).value

    def error_under(self, loads: ArrayLike, positions: int) -> tuple[Array, Array, Array]:  # noqa: ARG002  (as of every loaded pair)
        """See `LoadedTeeth`; the nominal load alone is what was solved before."""
        wanted, found = np.atleast_1d(np.asarray(loads, dtype=float)), self.found
        if wanted.tolist() == [self.nominal]:
            return found.lines.roll, found.load[[self.at]], found.transmission_error[:, [self.at]]
        found = self.flanks.solve(wanted, self.gaps, self.known)
        return found.lines.roll, found.load, found.transmission_error

    def root_stress(
        self,
        sources: Mapping[Member, Mapping[str, SolidInfluence]],
        progress: Callable[[float], None] = silent,
        *,
        estimates: bool = True,  # noqa: ARG002  (as in the plane; here errors cost next to nothing)
    ) -> RootStressInMesh:
        """See `LoadedTeeth`; one source for each gear, its solid or its slices, looked at all along the face."""
        stress: dict[Member, dict[str, ToothStress]] = {}
        over_face: dict[Member, dict[Side, StressOverFace]] = {}
        across: dict[Member, tuple[float, float]] = {}
        for number, member in enumerate(MEMBERS):
            ((name, influence),) = sources[member].items()
            largest, helical = largest_over_face(self, member, influence, over_face)
            stress[member] = {name: largest}
            if self.pair.driver.helix_angle and influence.coarse:  # slices know no shear along the face
                error = largest.error(self.at)
                off = math.nan if error is None else error / largest.largest_tension[self.at]
                across[member] = helical, float(off * helical)
            progress((number + 1) / len(MEMBERS))
        return RootStressInMesh(stress, {}, over_face, across)

    def rooted(self, member: Member, found: LoadedFlanks, solution: SolidSolution) -> RootedLines:
        """Contact lines of all roll positions on a gear; recalled where known: neither gaps nor loads change it."""
        from fegear.contact.wide.root_stress import rooted_lines

        return self.flanks.cache.call(
            rooted_lines, self.pair, member, found.lines, solution, coupling=self.coupling
        ).value

    def tooth_stress(self, member: Member, influence: SolidInfluence) -> ToothStress:
        """Largest root stress over the face of one gear under every load, with its errors."""
        return largest_over_face(self, member, influence, {})[0]

    def losses(self, speed: float, law: Callable[[float], FrictionLaw]) -> tuple[tuple[ToothLoss, ...], float]:
        """See `LoadedTeeth`; the error is the change by the coarser solution, and what slices miss."""
        from fegear.contact.tooth_loss import change_of_loss, loss_over_face, moved_at_most

        i, nominal = self.at, law(self.nominal)
        found = tuple(loss_over_face(self.found, k, speed, law(load)) for k, load in enumerate(self.loads))
        if not self.estimated:
            return found, math.nan
        error = change_of_loss(found[i], loss_over_face(self.error.coarse, i, speed, nominal))
        return found, error + (self.missed * moved_at_most(self.found, i, speed, nominal) if self.missed else 0.0)

    def flank_load(self, pair: GearPair) -> FlankLoad:
        """See `LoadedTeeth`."""
        found, (along, across) = self.found, _SURFACE
        x = _between(pair.x_start, pair.x_end, along)
        z = _between(found.lines.low, found.lines.high, across)
        return FlankLoad(x, z, np.maximum(found.spread(x, z, _without_edges(found, self.at)), 0.0), True, 0.0)


def mean_without_gaps(flanks: FlankPair, known: FlankCompliance, load: float) -> float:
    """Mean transmission error of perfect flanks under one load [m], whose compliances are known."""
    perfect = replace(flanks, positions=known.lines.roll.size).solve([load], None, known)
    return float(perfect.mean_transmission_error[0])


def _without_edges(found: LoadedFlanks, case: int) -> Array:
    """Line load at the stations; at tips and form circles that of the station beside them, (P, M) [N/m].

    An edge of an unrelieved tooth presses harder than smooth flanks do, and no formula of the surface is for edges.
    """
    lines, load = found.lines, found.line_load[:, :, case].copy()
    for p in range(lines.roll.size):
        for s in lines.at(p):
            inner = s.start + np.flatnonzero(~lines.at_edge[p, s])
            if inner.size:
                load[p, s] = np.interp(lines.z[p, s], lines.z[p, inner], load[p, inner])
    return np.asarray(load)


def _between(low: float, high: float, count: int) -> Array:
    """Places from end to end, those of the path with the pitch point among them."""
    room = _MARGIN * (high - low)
    places = np.linspace(low + room, high - room, count)
    return np.unique(np.append(places, 0.0)) if low < 0.0 < high else places


def _missed_too(shift: TransmissionErrorShift, te: FlankTransmissionError, missed: float) -> TransmissionErrorShift:
    """The same with what slices are known to miss of compliances."""
    return replace(
        shift,
        mean=shift.mean + missed * te.mean,
        peak_to_peak=shift.peak_to_peak + missed * te.peak_to_peak,
        effective=shift.effective + missed * te.effective_error,
        amplitude=shift.amplitude + missed * te.series.amplitude,
        stiffness=shift.stiffness + missed * te.mean_secant,
    )
