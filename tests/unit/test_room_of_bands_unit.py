"""How much of the flank there is beside a contact: the arc to its nearer end, by adding up chords of the involute."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.output.solid_mesh_files import _room


@pytest.mark.parametrize("module", [1e-3, 4e-3])
@pytest.mark.parametrize("share", [0.0, 0.1, 0.4, 0.9, 1.0])
def test_room_is_the_arc_of_the_involute_to_the_nearer_end(module, share):
    tooth = Tooth(25)
    gear = Gear(tooth, module, 0.5 * tooth.root_radius * module, 20e-3)
    base, low, high = gear.base_radius / module, tooth.form_radius, tooth.involute_tip_radius
    radius = low + share * (high - low)

    def arc(start, end):
        t = np.linspace(*(math.sqrt((one / base) ** 2 - 1.0) for one in (start, end)), 20001)
        x, y = base * (np.sin(t) - t * np.cos(t)), base * (np.cos(t) + t * np.sin(t))
        return float(np.hypot(np.diff(x), np.diff(y)).sum())

    assert _room(gear, radius * module) == pytest.approx(min(arc(low, radius), arc(radius, high)), rel=1e-7, abs=1e-12)
