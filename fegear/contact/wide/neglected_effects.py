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
    for effect in effects_off(spec):
        try:
            found = flanks_with(effect, spec, flanks, gaps, over)
        except InputError as error:  # data that nothing uses may be wrong: the run goes on without its size
            wrong[effect] = error
            continue
        # means over a base pitch hardly depend on the positions; beside edges they are not those of what is known
        edges, one = effect == CORNER_CONTACT.name, over.found
        before = (mean, factor) if edges else (float(one.mean_transmission_error[i]), float(one.face_load_factor[i]))
        changes[effect] = (
            Change(
                "mean transmission error", float(found.mean_transmission_error[0]) - before[0], mean, spec.nominal,
                math.nan,
            ),
            Change("K_Hbeta", float(found.face_load_factor[0]) - before[1], factor, spec.nominal, math.nan),
        )  # fmt: skip
    return Neglected(changes, wrong)


def effects_off(spec: PairSpec) -> list[str]:
    """Effects of a pair with its width that are off and have data."""
    return [effect for effect in WIDE_EFFECTS if not spec.is_on(effect) and spec.has_data(effect)]


def flanks_with(
    effect: str, spec: PairSpec, flanks: FlankPair, gaps: FlankGaps, over: OverPitch
) -> LoadedFlanks:  # fmt: skip
    """The pair under its nominal load with one effect more.

    Contact along tip edges is followed at no more roll positions than means over a base pitch need; other effects at
    those of what is known without them.

    Raises
    ------
    InputError
        If the data of the effect are wrong.
    """
    if effect == CORNER_CONTACT.name:
        edged = replace(flanks, positions=_FEW, most_gap=usual_gap(spec.placed, spec.nominal))
        return edged.solve([spec.nominal], gaps)
    for flank in spec.both:
        if effect in flank.wrong:
            raise flank.wrong[effect]
    known, more = over.found.known, spec.with_effect(effect)
    finer = replace(flanks, positions=over.found.lines.roll.size)
    changed = as_specified(more, finer)
    if (changed.pair, changed.coupling) != (finer.pair, finer.coupling):
        finer, known = changed, changed.compliance(spec.nominal)
    elif changed.hertz != finer.hertz:
        known = replace(known, fixed_half_width=None)
    if effect in GAPS:
        gaps = open_gaps(more)
    return finer.solve([spec.nominal], gaps, known)
