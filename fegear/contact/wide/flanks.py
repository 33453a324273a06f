"""From a spec to a pair of flanks with a width that is ready to be loaded: the effects that are on."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.wide.loaded import FlankPair


def as_specified(spec: PairSpec, flanks: FlankPair) -> FlankPair:
    """The flanks with the effects of a spec that change more than what keeps them apart."""
    return replace(flanks, pair=spec.placed, coupling=spec.neighbour_coupling, hertz=spec.hertz)
