"""Which spring or inertia explains measured natural frequencies: changed trains are recognised, shares are energies."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.dynamics.train.measured_modes import beside_modes
from fegear.dynamics.train.modes import modes
from fegear.dynamics.train.one_cause import one_cause
from fegear.dynamics.train.train import Body, Mesh, Shaft, Torque, Train


def train(inputs=2.0e4, tooth=3.0e8, outputs=6.0e4, wheel=0.02):
    return Train(
        (Body("motor", 0.02), Body("pinion", 0.0012), Body("wheel", wheel), Body("brake", 0.05)),
        (Shaft("input", "motor", "pinion", inputs), Shaft("output", "wheel", "brake", outputs)),
        (Mesh("I", "pinion", "wheel", 0.03, 0.06, 20, 40, tooth),),
        (), (Torque("motor", 100.0), Torque("brake", 200.0)),
    )  # fmt: skip


def measured(changed):
    return modes(changed).frequencies[1:]


def causes(frequencies, of=None):
    plain = of or train()
    return one_cause(plain, beside_modes(np.asarray(frequencies), modes(plain).frequencies[1:]))


@pytest.mark.parametrize(
    ("changed", "name", "factor", "words"),
    [
        ({"inputs": 1.6e4}, "shaft input", 0.8, "Shaft input 20 % softer explains all three measured frequencies"),
        ({"outputs": 9.0e4}, "shaft output", 1.5, "Shaft output 50 % stiffer explains all three"),
        ({"tooth": 2.1e8}, "mesh I", 0.7, "Mesh I 30 % softer explains all three"),
        ({"wheel": 0.026}, "inertia of wheel", 1.3, "Inertia of wheel 30 % larger explains all three"),
    ],
)
def test_the_part_that_was_changed_is_named(changed, name, factor, words):
    """Also with 0.2 % of error in the frequencies."""
    exact = measured(train(**changed))
    for frequencies, room in ((exact, 1e-4), (exact * (1.0 + 2e-3 * np.array([1.0, -1.0, 0.5])), 2e-2)):
        found = causes(frequencies)
        assert found.part[0] == name
        assert found.factor[0] == pytest.approx(factor, rel=room)
        assert found.left[0] <= 2.5e-3
        assert (np.diff(found.rms) >= -1e-6).all()
    assert causes(exact).said.startswith(words)
    assert causes(exact).said.endswith(".")


def test_every_spring_together_and_no_single_one():
    soft = causes(measured(train(0.9 * 2e4, 0.9 * 3e8, 0.9 * 6e4)))
    assert (soft.part[0], round(soft.factor[0], 4)) == ("every spring", 0.9)
    two = causes(measured(train(inputs=1.2e4, tooth=4.5e8, outputs=8.0e4)))
    assert not two.explaining.size
    assert two.said.startswith("No single spring or inertia explains the measured frequencies (deviations of up to ")
    assert "): nearest " in two.said
    assert two.part[0].capitalize() not in two.said
    assert str(two.part[0]) in two.said
    assert causes(1.004 * measured(train())).said == ""


def test_one_frequency_determines_no_cause():
    found = causes([0.95 * measured(train())[0]])
    assert found.said.startswith("One frequency does not determine the cause: ")
    assert " or " in found.said


def test_shares_are_those_of_the_energy_and_sum_to_one():
    plain = train()
    found, own = causes(measured(train(inputs=1.6e4))), modes(plain)
    share = dict(zip(found.part.tolist(), found.shares, strict=True))
    assert share["mesh I"] == pytest.approx(own.mesh_energy[1:, 0], abs=1e-6)
    springs = [share[name] for name in ("mesh I", "shaft input", "shaft output")]
    assert np.sum(springs, axis=0) == pytest.approx(1.0, abs=1e-6)
    assert np.sum([one for name, one in share.items() if "inertia" in name], axis=0) == pytest.approx(1.0, abs=1e-6)
    assert share["every spring"] == pytest.approx(1.0, abs=1e-6)


def test_two_bodies_on_a_shaft_have_one_closed_form():
    """f = sqrt(k (1/J_a + 1/J_b)) / (2 pi): k follows from the frequency."""
    of = Train((Body("a", 0.3), Body("b", 0.7)), (Shaft("s", "a", "b", 5e4),))
    natural = math.sqrt(5e4 * (1.0 / 0.3 + 1.0 / 0.7)) / (2.0 * math.pi)
    found = causes([0.9 * natural], of)
    at = found.part.tolist().index("shaft s")
    assert found.factor[at] == pytest.approx(0.81, rel=1e-6)
    inertia = dict(zip(found.part.tolist(), found.factor, strict=True))["inertia of a"]
    stiff = replace(of, bodies=(Body("a", 0.3 * inertia), Body("b", 0.7)))
    assert modes(stiff).frequencies[1] == pytest.approx(0.9 * natural, rel=1e-6)


def test_a_frequency_that_is_none_of_the_train_is_named():
    """Of three two agree; a changed mesh, which moves one frequency only, stays the cause."""
    computed = measured(train())
    found = causes(computed * np.array([1.002, 8.0, 0.999]))
    assert found.said.startswith(f"Without {8.0 * computed[1]:.4g} Hz both other measured frequencies agree with the ")
    assert " within 0.20 %: it is probably no natural frequency of this train (" in found.said
    assert found.others == pytest.approx(2e-3, rel=1e-6)
    assert causes(measured(train(tooth=2.1e8))).said.startswith("Mesh I 30 % softer explains")
    two = causes(computed[:2] * np.array([1.0, 1.3]))
    assert (two.foreign, two.others) == (0.0, 0.0)
