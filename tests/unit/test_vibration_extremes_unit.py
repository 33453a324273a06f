"""Largest forces of a vibrating set, whose teeth jump: against a dense series of its motion, and laws."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.dynamics.planetary import cycle_extremes
from fegear.dynamics.planetary.set_modes import set_modes
from fegear.dynamics.planetary.set_response import forced_response, linear_set
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.results.planetary.planet_vibration import PLANET_VIBRATION, VibrationInputs
from fegear.verify.planetary_sets import constant, jumping, lin_parker, meshed

JUMPING = jumping(4e8, 5.5e8, 0.6), jumping(4.5e8, 5.8e8, 0.7)


def dense(linear, frequency, harmonics, places=1 << 16):
    """Forces of all meshes at even places and beside the jumps: the motion as a series, the teeth as they are."""
    model, order = linear.meshed.model, np.arange(1, harmonics + 1)
    flexible = linear.modes.frequency > 0.0
    natural, shapes = math.tau * linear.modes.frequency[flexible], linear.modes.shapes[:, flexible]
    rows, stiffness = (model.mesh_rows @ shapes).reshape(-1, natural.size), np.repeat(linear.stiffness, model.count)
    own = [(one, late) for one, lates in zip(linear.fluctuation, linear.delays, strict=True) for late in lates]
    series = np.array([one.fourier(order) * np.exp(-1j * math.tau * order * late) for one, late in own])
    omega = math.tau * frequency * order
    modal = (rows.T * stiffness @ series) / (
        natural[:, None] ** 2 - omega**2 + 2j * linear.damping_ratio * natural[:, None] * omega
    )
    spectrum = np.zeros((rows.shape[0], places // 2 + 1), dtype=complex)
    spectrum[:, 1 : harmonics + 1] = rows @ modal
    moved = np.fft.irfft(spectrum, places) * places
    s = np.arange(places) / places
    found = []
    for aside in (-1e-9, 1e-9):  # beside places the motion is the same, the teeth are not
        teeth = np.array([one(s + aside - late) for one, late in own])
        found.append(stiffness[:, None] * (moved - teeth))
    return np.concatenate(found, axis=1)


@pytest.mark.parametrize(
    ("frequency", "harmonics", "off"), [(30.0, 16384, 4e-4), (210.0, 4096, 1e-4), (1400.0, 4096, 1e-4)]
)
def test_largest_forces_are_those_of_all_harmonics(frequency, harmonics, off):
    """With 200 harmonics at 512 places they were up to 16 % off at low speed, and stated a tenth of it."""
    linear = linear_set(meshed(lin_parker(3), *JUMPING), 0.03)
    found, asked = forced_response(linear, frequency), dense(linear, frequency, harmonics)
    assert found.extremes[0, 0].ravel() == pytest.approx(asked.max(axis=1), rel=off)
    assert found.extremes[0, 1].ravel() == pytest.approx(asked.min(axis=1), rel=off)
    assert found.largest_force[0] == pytest.approx(np.abs(asked).max(), rel=off)
    assert found.least_share[0] == pytest.approx(1.0 + asked.min() / found.mean_force, abs=off)


def test_sizes_are_those_of_the_harmonics():
    linear = linear_set(meshed(lin_parker(4), *JUMPING), 0.03, 400)
    found = forced_response(linear, [61.0, 700.0])
    asked = 2.0 * np.sqrt((np.abs(found.coordinate) ** 2).sum(axis=1))
    assert found.sizes == pytest.approx(asked, rel=3e-5, abs=1e-9 * asked.max())  # of 400 harmonics


def smooth(depth):
    return MeshExcitation.from_mesh(Periodic.fit(lambda s: 5e8 / (1.0 + depth * np.cos(math.tau * s))))


def static(linear, places=20_000):
    """Forces where the set follows its teeth at rest."""
    model, s = linear.meshed.model, np.arange(places) / places
    flexible = linear.modes.frequency > 0.0
    shapes = linear.modes.shapes[:, flexible] / (math.tau * linear.modes.frequency[flexible])
    rows, stiffness = (model.mesh_rows @ shapes).reshape(2 * model.count, -1), np.repeat(linear.stiffness, model.count)
    teeth = np.array([
        one(s - late) for one, lates in zip(linear.fluctuation, linear.delays, strict=True) for late in lates
    ])  # fmt: skip
    return stiffness[:, None] * (rows @ (rows.T @ (stiffness[:, None] * teeth)) - teeth)


def test_at_standstill_forces_are_those_at_rest():
    """Teeth without jumps: the slower, the closer, with the square of the speed, and no harmonic is left out."""
    model = lin_parker(3)
    model = replace(model, found=replace(model.found, angles=np.array([0, 33, 77]) * math.tau / 108))
    linear = linear_set(meshed(model, smooth(0.2), smooth(0.1)), 0.03)
    asked = static(linear)
    most = np.abs(asked).max()
    assert most > 1.0
    for frequency, off in ((1.0, 1e-3), (1e-2, 1e-5)):
        found = forced_response(linear, frequency)
        assert found.extremes[0, 0].ravel() == pytest.approx(asked.max(axis=1), abs=off * most)
        assert found.extremes[0, 1].ravel() == pytest.approx(asked.min(axis=1), abs=off * most)


def test_jumps_overshoot_alike_at_all_low_speeds():
    """A jump rings the set, however slowly it comes; between jumps the set rests long before the next."""
    linear = linear_set(meshed(lin_parker(3), *JUMPING), 0.03)
    slow, slower = (forced_response(linear, frequency) for frequency in (0.1, 1e-3))
    assert slow.extremes == pytest.approx(slower.extremes, rel=1e-6)
    assert slow.largest_force[0] > 1.1 * np.abs(static(linear)).max()


def test_doubled_teeth_double_and_no_teeth_give_nothing():
    linear = linear_set(meshed(lin_parker(3), *JUMPING), 0.03)
    sun, ring = linear.fluctuation
    twice = forced_response(replace(linear, fluctuation=(sun.scaled(2.0), ring.scaled(2.0))), [61.0, 800.0])
    once = forced_response(linear, [61.0, 800.0])
    assert twice.extremes == pytest.approx(2.0 * once.extremes, rel=1e-9)
    assert twice.sizes == pytest.approx(2.0 * once.sizes, rel=1e-6, abs=1e-18)
    none = Periodic.constant(0.0)
    still = forced_response(replace(linear, fluctuation=(none, none)), [61.0])
    assert not still.extremes.any()
    assert not still.sizes.any()
    assert not still.shift(lambda one: one.largest_force).any()


def test_errors_of_the_teeth_are_errors_of_the_force():
    """Amplitudes off by one share of themselves: so is the force; its estimate is no less and not ten times as much."""
    linear = linear_set(meshed(lin_parker(3), *JUMPING), 0.03)
    for frequency in (61.0, 700.0):
        off = replace(linear, amplitude_error=np.full_like(linear.amplitude_error, 1e-3))
        found = forced_response(off, frequency)
        change = 1e-3 * found.largest_force
        stated = found.shift(lambda one: one.largest_force)
        assert (stated >= 0.99 * change).all()
        assert (stated <= 5.0 * change).all()
    stiff = replace(linear, stiffness_error=(1e-3, 0.0))
    assert (forced_response(stiff, 61.0).shift(lambda one: one.largest_force) > 0.0).all()


def test_where_two_modes_cross_frequencies_err_by_what_either_of_them_does():
    """One that hardly hangs on the meshes is the next one after the crossing: 39 times its own error off."""
    sun, ring, off = 1.24325747e8, 5e8, 4e-3
    linear = replace(linear_set(meshed(lin_parker(4), constant(sun), constant(ring)), 0.03), stiffness_error=(off, 0.0))
    modes, error = linear.modes, linear.frequency_error
    alone = 0.5 * off * modes.frequency * modes.sun_mesh
    far = 0.0
    for share in np.array([-1.0, -0.5, 0.5, 1.0]) * off:
        change = np.abs(set_modes(linear.meshed.model, sun * (1.0 + share), ring).frequency - modes.frequency)
        assert (change <= 1.1 * error + 1e-6).all()
        far = max(far, (change / np.maximum(alone, 1e-3)).max())
    assert far > 30.0
    near = np.isclose(error, alone, rtol=1e-2, atol=1e-3)  # elsewhere no more than that of the mode itself
    assert near.sum() >= modes.frequency.size - 3
    assert not replace(linear, stiffness_error=(0.0, 0.0)).frequency_error.any()


def test_a_set_without_damping_is_refused_where_it_cannot_settle():
    linear = linear_set(meshed(lin_parker(3), *JUMPING), 0.0)
    for frequency in (float(linear.modes.frequency[5]) / 3.0, 1e-5):
        with pytest.raises(RangeError, match="damping_ratio"):
            forced_response(linear, frequency)
    assert np.isfinite(forced_response(linear, 777.7).largest_force).all()


def test_the_note_on_a_rough_force_names_the_key_that_helps():
    linear = linear_set(meshed(lin_parker(3), *JUMPING), 0.03)
    rough = replace(linear, amplitude_error=np.full_like(linear.amplitude_error, 0.5))
    inputs = VibrationInputs(np.array([210.0]), 1.0, 0.03, "sun", "P")
    shown = PLANET_VIBRATION.present(forced_response(rough, 210.0), inputs)
    (note,) = (one for one in shown.remarks if "20 %" in one)
    assert note.startswith("P.dynamic_force (")
    assert note.endswith("estimated error above 20 % of the value; reduce accuracy.tolerance.")


def test_a_mode_is_silent_by_its_share_of_the_largest_force_of_the_teeth_s_own_error(monkeypatch):
    """What modes ring with is counted by their force over their frequency; silence by stiffness times the error."""
    asked = []

    class EnoughError(Exception):
        """Nothing more is looked at."""

    def parts(modes, natural, loud, silent):
        asked.append((loud.tolist(), silent))
        raise EnoughError

    monkeypatch.setattr(cycle_extremes, "_parts", parts)
    error = SimpleNamespace(rows=np.array([[[1e-6, -3e-6], [2e-6, 0.0]], [[-5e-6, 1e-6], [0.0, 0.0]]]))
    forces = SimpleNamespace(error=error, stiffness=np.array([2e8, 1e8]), rows=np.array([[0.5, -2.0], [1.5, 3.0]]))
    modes = SimpleNamespace(rate=np.array([-1.0 + 10.0j, -2.0 + 40.0j]))
    with pytest.raises(EnoughError):
        cycle_extremes.cycle_extremes(modes, np.array([10.0, 40.0]), forces)
    ((loud, silent),) = asked
    assert loud == pytest.approx([1.5e8 / 10.0, 4e8 / 40.0])
    assert silent == pytest.approx(cycle_extremes._SILENT * 2e8 * 4e-6, rel=1e-6, abs=0.0)


def test_of_parts_all_but_as_high_as_each_other_the_highest_is_found():
    """Crests between the places looked at seem lower by up to a thousandth; the part that seems highest is not."""
    rng, rows, parts = np.random.default_rng(4), 40, 3
    place = rng.uniform(-0.9, 0.9, (rows, parts))
    height = 100.0 + rng.uniform(0.0, 0.05, (rows, parts))  # crests of half a wave of height 100 on zero
    wave = height[..., None] * np.cos(0.5 * math.pi * (cycle_extremes._POINTS - place[..., None]))
    value, part, where = cycle_extremes._highest(wave)
    assert part.tolist() == height.argmax(axis=1).tolist()
    assert value == pytest.approx(height.max(axis=1), rel=1e-6)
    assert where == pytest.approx(place[np.arange(rows), part], abs=1e-4)
