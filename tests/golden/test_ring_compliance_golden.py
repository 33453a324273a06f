"""The whole ring against the figures of the design study: 28 teeth, converged by several codes, not by this one."""

import numpy as np
import pytest

from fegear.fem import solve_gear, stiffness_table
from fegear.geometry import BasicRack, Gear, Material, Tooth

MODULE = 3.175e-3


def four_square_gear(**more):
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, material=Material(206.8e9, 0.3), **more)


def test_self_and_neighbour_compliance_of_the_full_ring_at_default_settings():
    gear = four_square_gear()
    table = stiffness_table(gear, [gear.pitch_radius], 0.08e-3)
    # 3.811e-5 and 7.752e-6 mm per N/mm, printed with four digits; asked for within 1e-3.
    assert table.c_self[0] == pytest.approx(3.811e-11, rel=1e-3)
    assert table.c_next[0] == pytest.approx(7.752e-12, rel=1e-3)
    assert abs(table.c_self[0] - 3.811e-11) < 2.0 * table.errors["c_self"][0] + 5e-15


def test_deflections_weighted_with_their_pressure_are_reciprocal_to_round_off():
    gear = four_square_gear()
    known = solve_gear(gear, estimate_error=False)
    p = np.linspace(gear.form_radius, gear.tip_radius, 9)
    forward, backward = known.neighbour(1, p, p), known.neighbour(-1, p, p)
    assert np.abs(forward - backward.T).max() < 1e-10 * np.abs(forward).max()


@pytest.mark.parametrize(("module", "young"), [(1e-3, 206.8e9), (3.175e-3, 70e9), (20e-3, 1.0)])
def test_compliance_times_modulus_and_stress_times_module_do_not_depend_on_size_or_steel(module, young):
    tooth = Tooth(28)

    def table(m, e):
        gear = Gear(tooth, m, 0.5 * tooth.root_radius * m, material=Material(e, 0.3))
        return stiffness_table(gear, np.linspace(13.3, 15.0, 7) * m, 0.025 * m)

    one, other = table(1.0, 1.0), table(module, young)
    assert np.allclose(other.c_self * young, one.c_self, rtol=1e-12)
    assert np.allclose(other.c_next * young, one.c_next, rtol=1e-12)
    assert np.allclose(other.root_tension * module, one.root_tension, rtol=1e-12)
