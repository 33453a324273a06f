"""Strain under a gauge in a root fillet while its tooth passes through the mesh, its own load's and its neighbours'."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.effects import PLANE_EFFECTS, ROOT_EFFECTS
from fegear.base.errors import InputError
from fegear.contact.gauge_strain import GaugeHistory, StrainWith
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.neglected_effects import effects_off, with_effect
from fegear.contact.plane.peaks import refined_peaks
from fegear.contact.plane.root_stress import RootStress
from fegear.contact.plane.root_stress_history import superposed_stress
from fegear.contact.plane.tooth_stress import LoadedStates, loaded_states

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.plane.compliance import RootStressInfluence
    from fegear.contact.plane.engagement import Engagement, Loaded
    from fegear.fem.plane.gauge import GaugesOnFillet
    from fegear.geometry.pair import Member

#: Even roll positions over the base pitch; both sides of every jump and the peaks come in addition.
_POSITIONS = 200
#: Radii at which errors of unit loads are looked at.
_FEW = 9
#: Teeth before the first and after the last pair that can touch: a base pitch on either side.
_BEYOND = 1


def gauge_history(
    e: Engagement,
    shifted: Sequence[Engagement],
    loads: Sequence[float],
    nominal: float,
    member: Member,
    gauges: GaugesOnFillet,
    opposite: GaugesOnFillet,
    displacement: Array,
    tooth: int = 0,
    *,
    estimates: bool = True,
    peaks: bool = False,
    positions: int = _POSITIONS,
) -> GaugeHistory:
    """Follow a gauge from a base pitch before its tooth's contact to one after it.

    Parameters
    ----------
    e : Engagement
    shifted : sequence of Engagement
        The same with one compliance each off by its error.
    loads : sequence of float, shape (L,)
        Along the line of action [N].
    nominal : float
        Load of which the peak is looked for between positions [N].
    member : {"driver", "driven"}
        Gear that has the gauge.
    gauges : GaugesOnFillet
        At every displacement.
    opposite : GaugesOnFillet
        One like it in the other fillet.
    displacement : ndarray, shape (G,)
        Zero is among them [m].
    tooth : int
        That has the gauge, in the order of meshing.
    estimates : bool
        Whether errors are estimated, and peaks looked for between positions.
    peaks : bool
        Whether peaks are looked for without errors, too.
    positions : int
        Even steps over the base pitch.
    """
    source: RootStressInfluence = e.compliance.source(member)
    if getattr(source, "influence", None) is not gauges.influence:  # the pair's compliance comes from elsewhere
        source = finite_element_compliance(gauges.influence)
    at = int(np.argmin(np.abs(displacement)))
    centre = gauges.only(at)
    x = roll_positions(e, positions)
    if estimates or peaks:
        x = _with_peaks(e, nominal, x, member, source, (centre, opposite), tooth)
    states = loaded_states(e, shifted if estimates else (), loads, x, tooth)
    displaced = _teeth(e, states.rows, member, source, gauges)
    error = np.full(displaced.shape[:3], np.nan)
    if estimates:
        error = _error(e, states, member, source, centre, displaced[..., at])
    beside = _teeth(e, states.rows, member, source, opposite)[..., 0]
    contacts, first = states.rows[0].grid.contacts.x, np.arange(-_BEYOND, displaced.shape[0] - _BEYOND)
    places = (contacts[0] + first[:, None] * e.pair.base_pitch).ravel()
    low, high = e.pair.x_start - e.pair.base_pitch, e.pair.x_end + e.pair.base_pitch
    order = np.argsort(places, kind="stable")
    order = order[(places[order] > low) & (places[order] < high)]
    displaced, error, beside = (one.reshape(-1, *one.shape[2:])[order] for one in (displaced, error, beside))
    seen, sense = gauges.strain_per_stress, 1.0 if gauges.side == "tension" else -1.0
    return GaugeHistory(
        e.pair, member, gauges.side, math.copysign(sense, sense * seen), abs(seen) * error, error, seen * displaced,
        places[order], seen * displaced[:, :, at], seen * beside, displaced[:, :, at], displacement,
    )  # fmt: skip


def gauge_neglects(
    spec: PairSpec, e: Engagement, member: Member, gauges: GaugesOnFillet, opposite: GaugesOnFillet, tooth: int = 0
) -> dict[str, StrainWith]:
    """Strain at the nominal load with each effect that is off, by its name.

    Data that are wrong while nothing uses them are passed over.

    Parameters
    ----------
    spec : PairSpec
    e : Engagement
        Made of it.
    member : {"driver", "driven"}
    gauges : GaugesOnFillet
        The grid alone.
    opposite : GaugesOnFillet
    tooth : int
    """
    nowhere = np.zeros(1)

    def seen(one: Engagement) -> tuple[GaugeHistory, float]:
        found = gauge_history(
            one, (), [spec.nominal], spec.nominal, member, gauges, opposite, nowhere, tooth, estimates=False, peaks=True
        )
        return found, float(found.strain[found.peak_position(0), 0])

    before = seen(e)[1]
    strains: dict[str, StrainWith] = {}
    for effect in effects_off(spec, (*PLANE_EFFECTS, *ROOT_EFFECTS)):
        try:
            other = with_effect(spec, e, effect)
        except InputError:
            continue
        if other is not None:
            found, peak = seen(other)
            strains[effect] = StrainWith(peak / before - 1.0, found.angle, found.strain[:, 0])
    return strains


def _with_peaks(
    e: Engagement,
    load: float,
    x: Array,
    member: Member,
    source: RootStressInfluence,
    gauges: Sequence[GaugesOnFillet],
    tooth: int,
) -> Array:
    """Roll positions and, in addition, those where gauges see most, ascending [m]."""

    def curves(at: Array) -> Array:
        states = loaded_states(e, (), [load], at, tooth).rows
        found = []
        for gauge in gauges:
            sign = 1.0 if gauge.side == "tension" else -1.0
            found.append((sign * _teeth(e, states, member, source, gauge)[:, :, 0, 0]).max(axis=0))
        return np.array(found)

    return np.sort(np.concatenate([x, refined_peaks(curves, x)[0]]))


def _teeth(
    e: Engagement, states: Sequence[Loaded], member: Member, source: RootStressInfluence, gauges: GaugesOnFillet
) -> Array:
    """Mean stress under grids on each tooth that passes, each in its own state, shape (n + 2, P, L, G) [Pa]."""
    weights, rows = gauges.weights().T, []
    known: dict[int, Array] = {}
    for row, state in enumerate(states):
        if id(state) not in known:
            along = superposed_stress(e, state, member, gauges.side, _BEYOND, source)
            known[id(state)] = np.stack([tooth @ weights for tooth in along])
        rows.append(known[id(state)][row])
    return np.stack(rows)


def _error(
    e: Engagement,
    states: LoadedStates,
    member: Member,
    source: RootStressInfluence,
    gauge: GaugesOnFillet,
    stress: Array,
) -> Array:
    """Estimated error of the stress under one gauge, shape (n + 2, P, L) [Pa].

    What errors of the compliances change, by the loads together or by each load, and what finite elements leave in the
    stress of each. A tooth that carries nothing is strained by its neighbours' loads; their sum may pass through zero,
    its error does not.
    """
    by_shift = np.zeros_like(stress)
    for number in range(len(states.shifted[0])):
        again = [shifted[number] for shifted in states.shifted]
        by_shift += np.abs(_teeth(e, again, member, source, gauge)[..., 0] - stress)
    contacts, face = states.rows[0].grid.contacts, e.compliance.face_width
    radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
    few, n = np.linspace(radius.min(), radius.max(), _FEW), radius.shape[0]
    roots = RootStress.of(e.compliance, member, gauge.side, source)
    reach, weights = min(roots.reach, n + _BEYOND), gauge.weights()[0]
    unit = {
        k: (np.abs(roots.known_row(k, 0, few) @ weights) / face, gauge.stress_error(k, few)[0] / face)
        for k in range(-reach, reach + 1)
    }
    by_load, by_source = np.zeros_like(stress), np.zeros_like(stress)
    for row, (state, apart) in enumerate(zip(states.rows, states.apart, strict=True)):
        for other in range(n):
            k = roots.tooth(row - _BEYOND - other)
            if k in unit:
                size, left = (np.interp(radius[other], few, one)[:, None] for one in unit[k])
                by_load[row] += (apart[other] * size) ** 2
                by_source[row] += (state.loads[other] * left) ** 2
    return np.asarray(np.hypot(np.maximum(by_shift, np.sqrt(by_load)), np.sqrt(by_source)))
