"""Every slope that Newton's method is given in unloaded contact is the derivative of its function, by differences.

A wrong one costs steps and no digits: brackets hold the root. So nothing else would notice.
"""

import math

import numpy as np
import pytest
from helical_gears import helical_gear

from fegear.contact.unloaded import earliest, reach
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.tooth_contact import mesh_cycle

DEG = math.pi / 180.0


@pytest.fixture(scope="module")
def searches():
    """Functions of one parameter that are searched for roots in a cycle of two badly misaligned helical pairs."""
    found = []
    with pytest.MonkeyPatch.context() as patch:
        for module in (reach, earliest):
            search = module.falling_root

            def noted(function, lo, hi, guess, parameters, search=search):
                found.append((getattr(function, "__qualname__", "?"), function, lo, hi, parameters))
                return search(function, lo, hi, guess, parameters)

            patch.setattr(module, "falling_root", noted)
        for shaft in (1.5, -0.8):
            gears = [
                helical_gear(z, 4e-3, 20.0 * DEG, 20.0 * DEG, 0.03, hand) for z, hand in ((24, "left"), (31, "right"))
            ]
            errors = Misalignment(shaft_angle=shaft * DEG, profile_angle=0.05 * DEG)
            mesh_cycle(HelicalPair(*gears, errors, parabola=2e-3), 6)
    return found


def test_slopes_are_the_derivatives_of_their_functions(searches):
    good, all_of_them = {}, {}
    for name, function, lo, hi, parameters in searches:
        open_ = hi > lo
        if not open_.any():
            continue
        own = [one[open_] for one in parameters]
        for share in (0.2, 0.37, 0.71):
            x = lo[open_] + share * (hi - lo)[open_]
            step = 1e-5 * (hi - lo)[open_]
            value, slope = function(x, *own)
            above, below = function(x + step, *own)[0], function(x - step, *own)[0]
            by_differences = (above - below) / (2.0 * step)
            # Kinks, and what round-off leaves of differences, are few.
            noise = 1e-15 * np.maximum(np.abs(above), np.abs(value)) / step
            size = np.maximum(np.abs(slope), np.abs(by_differences))
            close = np.abs(slope - by_differences) <= 1e-4 * size + 10.0 * noise
            good[name] = good.get(name, 0) + int(close.sum())
            all_of_them[name] = all_of_them.get(name, 0) + close.size
    shares = {name: good[name] / count for name, count in all_of_them.items()}
    assert len(shares) >= 4
    assert sum(all_of_them.values()) > 500
    assert min(shares.values()) > 0.9, shares
