"""Floors of the valleys of tip reliefs by the quick way: its slopes, its steps, and what is found with few of them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from fegear.contact.wide.loaded import FlankPair
from fegear.design.flanks import valley_floors as floors
from fegear.design.flanks.quick import quick_flanks
from fegear.design.flanks.scatter import normal_scatter
from fegear.design.flanks.trials import FlankTrials
from fegear.design.flanks.valley_floors import valley_floors
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

STEEL = Material(206.8e9, 0.3, 7850.0)
COARSE = SolidSettings().scaled(2.0)
MODULE, WIDTH = 3e-3, 7.5e-3
LOADS = np.array([900.0, 2000.0])
LOW = np.array([0.0, 1e-3, 0.0, 1e-3])
HIGH = np.array([30e-6, 9e-3, 30e-6, 9e-3])
BOX = np.append(LOW, np.zeros(5)), np.append(HIGH, np.zeros(5))
TIPS = np.array([[9e-6, 4e-3, 12e-6, 3e-3], [3e-6, 6e-3, 0.0, 2e-3], [25e-6, 2.5e-3, 25e-6, 3.2e-3]])


def solid(hand):
    tooth = Tooth(20, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(15.0))
    gear = Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, STEEL, "strain", hand)
    found = solve_solid(tooth, gear.twist * MODULE, WIDTH / MODULE, 0.3, gear.bore_radius / MODULE, COARSE, reach=2)
    return gear, found


@pytest.fixture(scope="module")
def tips():
    """Under two loads and two misalignments, with the driver's flanks 2 um askew besides."""
    (first, driver), (second, driven) = solid("right"), solid("left")
    flanks = FlankPair(GearPair(first, second), {"driver": driver, "driven": driven}, panel=0.5, positions=9)
    known = flanks.compliance(float(LOADS[-1]))
    apart = np.where(known.lines.present, 2e-6 * known.lines.z / WIDTH, 0.0)
    trials = FlankTrials(flanks.pair, known, apart, LOADS, normal_scatter(3e-6, 2), (1.0, 0.8))
    plain = trials.of_gap(np.zeros(known.lines.x.shape)).found[0].contact.force
    return floors._QuickTips([quick_flanks(known, plain[:, :, i], 5, 1) for i in range(2)], trials)


def nine(tip):
    return np.append(tip, np.zeros(5))


def test_what_the_quick_way_leaves_is_near_to_what_is_left(tips):
    trials = tips.trials
    left = [trials.value(trials.of_numbers(nine(one)).peak_to_peak) for one in TIPS]
    np.testing.assert_allclose(tips.straight(TIPS).left, left, rtol=0.1)
    np.testing.assert_allclose(tips.scale(), np.repeat([1.0 * 2000.0 / 900.0, 0.8], 2))


def test_slopes_are_those_of_differences_and_nearby_forces_change_nothing(tips):
    here = tips.straight(TIPS)
    step = 1e-6 * TIPS[0]
    for k in range(4):
        ahead = TIPS.copy()
        ahead[:, k] += step[k]
        beside = tips.straight(ahead, here)
        np.testing.assert_allclose(beside.te, tips.straight(ahead).te, rtol=1e-12)
        moved = (beside.te - here.te) / step[k]
        np.testing.assert_allclose(here.slope[..., k], moved, atol=2e-5 * np.abs(moved).max() + 1e-12)


def test_reliefs_loaded_few_at_a_time_and_at_some_positions_are_the_same(tips, monkeypatch):
    whole = tips.straight(TIPS)
    monkeypatch.setattr(floors, "_HELD", 1)
    for one, other in zip(vars(tips.straight(TIPS, whole)).values(), vars(whole).values(), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-11, atol=1e-18)
    quick, load, apart = next(tips.cases())
    at = slice(1, None, 3)
    approach, force, growth = quick.contact(tips.gaps(TIPS)[:, at] + apart[at], load, at)
    np.testing.assert_allclose(approach, whole.te[:, at, 0], rtol=1e-12)
    np.testing.assert_allclose(force.sum(axis=2), load, rtol=1e-9)
    np.testing.assert_allclose(growth.sum(axis=2), 1.0, rtol=1e-9)
    assert (growth[force == 0.0] == 0.0).all()


def least_of_programme(te, slope, scale, size):
    """Of the largest deviation from the middle of every case within a region of trust [um]."""
    positions, cases = te.shape
    grown = np.moveaxis(slope * np.maximum(size, 1e-30), 1, 0) * scale[:, None, None] * 1e6
    off = (te.T * scale[:, None] * 1e6).ravel()
    middles, ones = np.repeat(np.eye(cases), positions, axis=0), np.ones((cases * positions, 1))
    rows = np.vstack([np.hstack([sign * grown.reshape(-1, 4), -sign * middles, -ones]) for sign in (1.0, -1.0)])
    within = [(-1.0, 1.0)] * 4 + [(None, None)] * (cases + 1)
    return linprog(np.eye(5 + cases)[-1], rows, np.concatenate([-off, off]), bounds=within).fun


@pytest.mark.parametrize("held", [False, True])
def test_most_steps_lead_nearly_to_the_least_of_the_linear_programme(tips, held):
    rng, scale = np.random.default_rng(0), tips.scale()
    starts = np.stack([rng.uniform(*ends, 12) for ends in ((2e-6, 30e-6), (1.5e-3, 8e-3)) * 2], axis=1)
    here = tips.straight(starts)
    reach = 0.3 * starts * np.array([0.0 if held else 1.0, 1.0] * 2)
    step = floors._least(here, scale, -reach, reach)
    assert (np.abs(step) <= reach * (1.0 + 1e-9)).all()

    def largest(te):
        return 0.5 * (np.ptp(te, axis=1) * scale).max(axis=1) * 1e6

    each = zip(here.te, here.slope, reach, strict=True)
    least = np.array([least_of_programme(te, slope, scale, size) for te, slope, size in each])
    before, after = largest(here.te), largest(here.te + np.einsum("cpkn,cn->cpk", here.slope, step))
    assert (after >= least * (1.0 - 1e-9)).all()
    assert np.median((before - after) / (before - least)) > 0.9


def test_the_best_first_all_unlike_within_the_box_and_below_what_a_grid_has(tips, monkeypatch):
    monkeypatch.setattr(floors, "_AMOUNTS", 3)
    monkeypatch.setattr(floors, "_LENGTHS", 5)
    one = floors._QuickTips(tips.at_loads[1:], replace(
        tips.trials, loads=LOADS[1:], weights=None, scatter=normal_scatter(0.0, 1)
    ))  # fmt: skip
    found = valley_floors(one.at_loads, one.trials, BOX)
    numbers = np.array(found)[:, :4]
    assert ((numbers >= LOW) & (numbers <= HIGH)).all()
    assert not np.array(found)[:, 4:].any()
    left = one.straight(numbers).left
    assert (np.diff(left) >= 0.0).all()
    assert left[0] < 0.75 * one.straight(floors._scanned(one, LOW, HIGH)).left.min()
    at = np.log(np.maximum(numbers, 0.02 * (HIGH - LOW)))
    apart = np.abs(at[:, None] - at[None]).max(axis=2) + np.eye(len(at))
    assert apart.min() > 0.02


def test_lengths_that_are_given_stay(tips, monkeypatch):
    monkeypatch.setattr(floors, "_AMOUNTS", 3)
    low, high = (np.where(np.arange(9) % 2 == 1, np.where(np.arange(9) < 4, 3e-3, 0.0), one) for one in BOX)
    found = np.array(valley_floors(tips.at_loads, tips.trials, (low, high)))
    assert (found[:, [1, 3]] == 3e-3).all()
    assert (found[:, [0, 2]] <= 30e-6).all()
