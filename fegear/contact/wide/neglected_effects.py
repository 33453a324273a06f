"""What an effect that is off would change of a pair with its width: it is loaded once more, under the nominal load."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from fegear.base.effects import CORNER_CONTACT, GAPS, WIDE_EFFECTS
from fegear.base.errors import InputError
from fegear.contact.loaded_teeth import Change, Neglected
from fegear.contact.wide.flanks import as_specified, open_gaps
from fegear.contact.wide.tip_edges import usual_gap

if TYPE_CHECKING:
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.wide.gaps import FlankGaps
    from fegear.contact.wide.loaded import FlankPair, LoadedFlanks
    from fegear.contact.wide.over_pitch import OverPitch

#: Roll positions that show what tip edges change.
_FEW = 24


def neglected_effects(spec: PairSpec, flanks: FlankPair, gaps: FlankGaps, over: OverPitch) -> Neglected:
    """What each effect that is off, and has data, would change of mean transmission error and K_Hbeta.

    Parameters
    ----------
    spec : PairSpec
    flanks : FlankPair
        Made of it.
    gaps : FlankGaps
        Of the effects that are on.
    over : OverPitch
        What is known of the whole base pitch without the effects.
    """
    stated, i = over.stated, spec.loads.index(spec.nominal)
    mean, factor = float(stated.mean[i]), float(stated.face_load_factor[i])
    changes: dict[str, tuple[Change, ...]] = {}
    wrong: dict[str, InputError] = {}
    for effect in WIDE_EFFECTS:
        if spec.is_on(effect) or not spec.has_data(effect):
            continue
        try:
            if effect == CORNER_CONTACT.name:
                sizes = _with_edges(spec, flanks, gaps, over)
            else:
                finer = replace(flanks, positions=over.found.lines.roll.size)
                sizes = _with(effect, spec, finer, over.found, gaps)
        except InputError as error:  # data that nothing uses may be wrong: the run goes on without its size
            wrong[effect] = error
            continue
        changes[effect] = (
            Change("mean transmission error", sizes[0], mean, spec.nominal, math.nan),
            Change("K_Hbeta", sizes[1], factor, spec.nominal, math.nan),
        )
    return Neglected(changes, wrong)


def _with_edges(spec: PairSpec, flanks: FlankPair, gaps: FlankGaps, over: OverPitch) -> tuple[float, float]:
    """What contact along tip edges changes, at no more roll positions than means over a base pitch need."""
    stated, i = over.stated, spec.loads.index(spec.nominal)
    edged = replace(flanks, positions=_FEW, most_gap=usual_gap(spec.placed, spec.nominal))
    found = edged.solve([spec.nominal], gaps)
    changes = found.mean_transmission_error[0] - stated.mean[i], found.face_load_factor[0] - stated.face_load_factor[i]
    return float(changes[0]), float(changes[1])


def _with(
    effect: str, spec: PairSpec, flanks: FlankPair, without: LoadedFlanks, gaps: FlankGaps
) -> tuple[float, float]:
    """What an effect that is off changes of mean transmission error and K_Hbeta, at the roll positions of both."""
    for flank in spec.both:
        if effect in flank.wrong:
            raise flank.wrong[effect]
    known, i, more = without.known, spec.loads.index(spec.nominal), spec.with_effect(effect)
    changed = as_specified(more, flanks)
    if (changed.pair, changed.coupling) != (flanks.pair, flanks.coupling):
        flanks, known = changed, changed.compliance(spec.nominal)
    elif changed.hertz != flanks.hertz:
        known = replace(known, fixed_half_width=None)
    if effect in GAPS:
        gaps = open_gaps(more)
    found = flanks.solve([spec.nominal], gaps, known)
    return (
        float(found.mean_transmission_error[0] - without.mean_transmission_error[i]),
        float(found.face_load_factor[0] - without.face_load_factor[i]),
    )
