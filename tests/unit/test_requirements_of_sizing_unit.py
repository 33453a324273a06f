"""Ratings of variants: what goes into ISO 6336, and what the safety factors say of the load."""

from __future__ import annotations

from dataclasses import fields
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.design.sizing import rated
from fegear.design.sizing.rated import DutyLevel, Safeties, SizingDuty, as_rated, safeties
from fegear.formulas.iso6336.conditions import Replacement
from fegear.formulas.iso6336.part1_face_load import Alignment
from fegear.formulas.iso6336.rated import Strength
from fegear.formulas.many.ratings import rate_many
from fegear.geometry.gear import Material
from fegear.geometry.many_pairs import ManyGearPairs

STEEL = Material(206e9, 0.3, 7830.0)
STRENGTH = Strength("Eh", 1500e6, 430e6)


def pairs():
    """Two variants of 2 and 3 mm."""
    beta, m = np.array([0.2, 0.0]), np.array([2e-3, 3e-3])
    z, x = np.array([[25.0, 19.0], [41.0, 57.0]]), np.array([[0.2, 0.3], [-0.1, 0.1]])
    a = 0.5 * m * z.sum(axis=0) / np.cos(beta) + m * x.sum(axis=0) * 0.97
    of_pair = np.full(2, np.radians(20.0)), beta, np.ones(2), np.array([1.25, 1.3])
    return ManyGearPairs(z, x, m, *of_pair, np.array([0.38, 0.3]), np.zeros(2), a, np.array([30e-3, 25e-3]))


def duty(**other):
    given = {
        "pinion_torque": 120.0,
        "pinion_speed": 150.0,
        "cycles": 3e8,
        "unlimited": False,
        "strength": (STRENGTH, STRENGTH),
        "material": STEEL,
        "grade": 6,
        "flank_roughness": (4e-6, 5e-6),
        "root_roughness": (15e-6, 18e-6),
        "viscosity": 220e-6,
        "application_factor": 1.25,
        "mesh_load_factor": 1.1,
        "meshes": (1, 3),
        "stress_ratio": (0.0, -0.4),
        "mean_stress": None,
        "alignment": Alignment(face_load_factor=1.2),
        "edition": 2019,
        "dynamic_method": "B",
        "tip_relief_factor": 0.97,
        "computed": Replacement(K_v=1.1),
        "required": (1.1, 1.5),
    }
    return SizingDuty(**given | other)


@pytest.fixture
def asked(monkeypatch):
    """What was asked of the rating."""
    seen = []

    def single(conditions):
        seen.append((conditions, None))
        return rate_many(conditions)

    def spectra(conditions, levels):
        seen.append((conditions, levels))
        refused = (("none", np.zeros(2, bool)),)
        return SimpleNamespace(contact_safety=np.ones((2, 2)), bending_safety=2.0 * np.ones((2, 2)), refused=refused)

    monkeypatch.setattr(rated, "rate_many", single)
    monkeypatch.setattr(rated, "rate_many_spectra", spectra)
    return seen


def test_variants_are_rated_as_solid_discs_bored_to_half_the_root_diameter():
    one = pairs()
    found = as_rated(one, STEEL)
    same = {
        "teeth": one.teeth, "profile_shift": one.profile_shift, "generating_shift": one.profile_shift,
        "tip_diameter": one.tip_diameters, "active_tip_diameter": one.tip_diameters,
        "root_diameter": one.root_diameters, "bore_diameter": 0.5 * one.root_diameters,
        "face_widths": np.stack([one.face_width] * 2), "dedendum": np.stack([one.dedendum] * 2),
        "rack_tip_radius": np.stack([one.rack_tip_radius] * 2), "residual_undercut": np.zeros((2, 2)),
        "rim_thickness": np.full((2, 2), np.inf), "web_ratio": np.full((2, 2), np.nan),
        "young_modulus": np.full((2, 2), 206e9), "poisson_ratio": np.full((2, 2), 0.3),
        "density": np.full((2, 2), 7830.0), "module": one.module, "pressure_angle": one.pressure_angle,
        "helix_angle": one.helix_angle, "centre_distance": one.centre_distance, "contact_ratio": one.contact_ratio,
        "face_width": one.face_width,
    }  # fmt: skip
    assert {field.name for field in fields(found)} == {*same, "rings"}
    for name, value in same.items():
        np.testing.assert_array_equal(getattr(found, name), value, err_msg=name)


def test_a_duty_is_the_tangential_force_the_speed_and_the_turns_of_both_gears(asked):
    one = duty(mean_stress=(1e8, 0.0), annex_c=True)
    found = safeties(pairs(), one)
    ((conditions, _),) = asked
    load = conditions.duty
    # F_t d_1/2 is the torque: reference diameters z m / cos(beta).
    assert load.tangential == pytest.approx([240.0 / (25 * 2e-3 / np.cos(0.2)), 240.0 / (19 * 3e-3)])
    assert load.speed.tolist() == [150.0, 150.0]
    # A wheel turns z_1 / z_2 as often, and is loaded three times a turn.
    assert load.cycles == pytest.approx(np.array([[3e8, 3e8], [3e8 * 3 * 25 / 41, 3e8 * 3 * 19 / 57]]))
    assert (load.viscosity, load.application_factor, load.mesh_load_factor) == (220e-6, 1.25, 1.1)
    assert (load.meshes, load.stress_ratio, load.mean_stress) == ((1, 3), (0.0, -0.4), (1e8, 0.0))
    assert conditions.strength is one.strength
    assert conditions.alignment is one.alignment
    assert conditions.computed is one.computed
    assert (conditions.edition, conditions.dynamic_method, conditions.annex_c) == (2019, "B", True)
    assert (conditions.tip_relief, conditions.tip_relief_factor) == (None, 0.97)
    assert conditions.quality.grade == 6
    assert (conditions.quality.flank_roughness, conditions.quality.root_roughness) == ((4e-6, 5e-6), (15e-6, 18e-6))
    plain = rate_many(conditions)
    np.testing.assert_array_equal(found.contact, plain.contact_safety)
    np.testing.assert_array_equal(found.bending, plain.bending_safety)


def test_without_a_life_the_wheel_has_as_many_cycles_as_the_pinion(asked):
    safeties(pairs(), duty(unlimited=True))
    assert (asked[0][0].duty.cycles == 3e8).all()


def test_levels_of_a_spectrum_have_their_parts_of_torque_speed_and_cycles(asked):
    found = safeties(pairs(), duty(levels=(DutyLevel(0.5, 2.0, 1e7), DutyLevel(1.3, 0.25, 4e5))))
    ((conditions, levels),) = asked
    for one, (torque, speed, cycles) in zip(levels, ((0.5, 2.0, 1e7), (1.3, 0.25, 4e5)), strict=True):
        tangential, rate, turns = (getattr(one, field.name) for field in fields(one))
        assert tangential == pytest.approx(torque * conditions.duty.tangential)
        assert rate.tolist() == [150.0 * speed] * 2
        assert turns == pytest.approx(cycles / 3e8 * conditions.duty.cycles)
    assert (found.contact == 1.0).all()
    assert (found.bending == 2.0).all()
    assert found.refused[0][0] == "none"


def test_the_margin_is_the_load_at_which_the_first_safety_factor_is_down_to_its_minimum():
    required = 1.1, 1.5
    # Stress of the flank goes with the root of the load, that of the root with the load itself.
    contact, bending = np.array([[1.4, 2.2, 1.0], [1.3, 2.4, 1.2]]), np.array([[3.0, 1.8, 3.0], [2.5, 2.0, 3.0]])
    margin = Safeties(contact, bending, ()).margin(required)
    assert margin == pytest.approx([(1.3 / 1.1) ** 2, 1.8 / 1.5, (1.0 / 1.1) ** 2])
    at_limit = Safeties(contact / np.sqrt(margin), bending / margin, ())
    lowest = np.minimum(at_limit.contact.min(axis=0) / 1.1, at_limit.bending.min(axis=0) / 1.5)
    assert lowest == pytest.approx(1.0)


def test_half_the_torque_of_a_pair_with_given_factors_doubles_its_margin():
    given = Replacement(K_v=1.1, K_Halpha=1.0, K_Falpha=(1.0, 1.0))
    full, half = (safeties(pairs(), duty(pinion_torque=t, computed=given)) for t in (400.0, 200.0))
    assert half.margin((1.1, 1.5)) == pytest.approx(2.0 * full.margin((1.1, 1.5)))
