"""Root tension under contacts beside the fillet: one limit for all meshes, steady in the contact's place."""

import functools

import numpy as np
import pytest

from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack

#: Fillets from .01 to .9 modules long, of radii down to .002 modules.
TEETH = {
    "usual": Tooth(28),
    "full fillet": Tooth(50, BasicRack(tip_radius=0.38), 0.2),
    "short": Tooth(45, BasicRack(tip_radius=0.1), 0.8),
    "sharp": Tooth(80, BasicRack(tip_radius=0.0), 0.8),
    "shorter than contacts": Tooth(36, BasicRack(0.7, 1.25, 0.0), 1.05),
    "undercut": Tooth(10),
}
#: Those that once went furthest wrong in the ordinary run, all of them in the long one.
FURTHEST = ("sharp", "shorter than contacts")
EVERY = pytest.mark.parametrize(
    "name", [name if name in FURTHEST else pytest.param(name, marks=pytest.mark.long) for name in TEETH]
)
#: Level of the solution that others are compared with.
FINE = 2
#: Above the start of the flank [modules]; contacts from a quarter of a usual one to four times it.
PLACES = np.array([0.0, 0.001, 0.003, 0.005, 0.008, 0.012, 0.016, 0.02, 0.025, 0.03, 0.06, 0.1, 0.15, 0.25])
WIDTHS = (0.005, 0.02, 0.08)


def gear(name):
    tooth = TEETH[name]
    return Gear(tooth, 1.0, 0.5 * tooth.root_radius, material=Material(1.0, 0.3))


@functools.cache
def solved(name, level, coarser=None):
    other = None if coarser is None else settings_at(coarser)
    return solve_gear(gear(name), settings_at(level), coarser=other, estimate_error=coarser is not None)


def radii(name, places):
    tooth = TEETH[name]
    start = max(tooth.form_radius, tooth.base_radius)
    return np.clip(np.sqrt(start**2 + 2.0 * tooth.base_radius * places), tooth.form_radius, tooth.involute_tip_radius)


def tension(name, known, half_width, places=PLACES):
    return known.largest_root_stress(0, "tension", radii(name, places), half_width)[0]


@pytest.mark.dear
@EVERY
def test_root_tension_beside_a_contact_tends_to_a_limit(name):
    """Its search once ended at a distance that shrank with the edges: 17.86, 18.10, 18.59, 19.03."""
    left = []
    for level in (-1, 0):
        left.append(0.0)
        for b in WIDTHS:
            exact = tension(name, solved(name, FINE), b)
            left[-1] = max(left[-1], np.abs(tension(name, solved(name, level), b) / exact - 1.0).max())
    assert left[0] < 3e-3
    assert left[1] < 1.5e-3


@pytest.mark.dear("shorter than contacts")
@EVERY
def test_root_tension_is_steady_in_the_contact_s_place(name):
    """It jumped by 9.4 % where the end of the search passed a Gauss point."""
    places = np.linspace(0.0, 0.2, 4001)
    for b in WIDTHS:
        found = tension(name, solved(name, -1), b, places)
        assert (np.abs(np.diff(found, 2)) < 1e-3 * found[1:-1]).all()


@pytest.mark.dear("-1-sharp", "-1-shorter than contacts", "0-shorter than contacts", "0-sharp")
@EVERY
@pytest.mark.parametrize("level", [-1, 0])
def test_the_stated_error_covers_contacts_beside_the_fillet(name, level):
    """Fillets shorter than the contact stated a tenth of their error.

    At the very start of the flank nothing is left of the contact's width, which no mesh resolves.
    """
    known = solved(name, level, level - 1)
    for b in WIDTHS:
        exact = tension(name, solved(name, FINE), b)
        true = np.abs(tension(name, known, b) - exact)
        stated = known.root_stress_error(0, "tension", radii(name, PLACES), b)
        assert (true < np.where(PLACES > 0.0, 1.5, 5.0) * stated + 2e-5 * exact).all()
        assert (stated < 0.02 * exact).all()


def test_a_contact_presses_on_the_flank_alone():
    """Wide contacts at the start of the flank turn a tooth by the load's torque about the base circle."""
    known = solved("usual", 0)
    narrow, wide = (tension("usual", known, b, np.array([0.0, 0.004])) for b in (0.004, 0.1))
    assert wide == pytest.approx(narrow, rel=1e-12)
