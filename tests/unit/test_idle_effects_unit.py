"""Which effects change nothing in an engagement that has them: no corner, no neighbour, no contact of its own."""

from itertools import product
from types import SimpleNamespace

import pytest

from fegear.base.effects import CORNER_CONTACT, HERTZ, NEIGHBOUR_COUPLING
from fegear.contact.plane.neglected_effects import _IDLE
from fegear.geometry.pair import MEMBERS


def engagement(*, corners=(False, False), reach=(0, 0), log_slope=(0.0, 0.0), power=(0.0, 0.0)):
    both = [SimpleNamespace(reach=one) for one in reach]
    return SimpleNamespace(
        meshing=SimpleNamespace(corners=[SimpleNamespace(exists=one) for one in corners]),
        compliance=SimpleNamespace(
            both=both,
            contact_slope=dict(zip(MEMBERS, log_slope, strict=True)).get,
            power=dict(zip(MEMBERS, power, strict=True)).get,
        ),
    )


@pytest.mark.parametrize("own", list(product([False, True], repeat=2)))
def test_an_effect_is_idle_where_neither_gear_has_what_it_acts_on(own):
    size = tuple(0.5 * one for one in own)
    idle = not any(own)
    assert _IDLE[CORNER_CONTACT.name](engagement(corners=own)) is idle
    assert _IDLE[NEIGHBOUR_COUPLING.name](engagement(reach=tuple(map(int, own)))) is idle
    assert _IDLE[HERTZ.name](engagement(log_slope=size)) is idle
    assert _IDLE[HERTZ.name](engagement(power=size)) is idle
    # Each looks at its own alone.
    assert _IDLE[HERTZ.name](engagement(corners=own, reach=(3, 3)))
    assert _IDLE[NEIGHBOUR_COUPLING.name](engagement(corners=own, power=size))
