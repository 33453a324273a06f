"""A tooth by itself: its lowest natural frequency, and what the load of one passage makes of it."""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from fegear.case.reading import build_scene
from fegear.design.loading import LoadingFunction, Ramp, tooth_response
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.formulas.tooth_vibration import lowest_frequency, tooth_frequency
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.results.catalogue import STAGES


def timoshenko(depth):
    """Lowest frequency of a uniform cantilever of length, E and density 1 and nu = .3: root of its determinant."""
    area, inertia, shear = depth, depth**3 / 12.0, 1.0 / 2.6 / 1.2

    def determinant(omega):
        # w'' k A G - k A G theta' + omega^2 A w = 0,  E I theta'' + k A G (w' - theta) + omega^2 I theta = 0
        a, b = shear * area, omega**2
        system = np.array(
            [
                [0.0, 1.0, 1.0 / a, 0.0],
                [0.0, 0.0, 0.0, 1.0 / inertia],
                [-b * area, 0.0, 0.0, 0.0],
                [0.0, -b * inertia, -1.0, 0.0],
            ]
        )  # fmt: skip  (w, theta, shear force, bending moment)' = system (...)
        value, vector = np.linalg.eig(system)
        carried = np.real(vector @ np.diag(np.exp(value)) @ np.linalg.inv(vector))
        return np.linalg.det(carried[2:, 2:])

    euler = 1.8751040687119611**2 * math.sqrt(inertia / area)
    return brentq(determinant, 0.6 * euler, 1.05 * euler) / (2.0 * math.pi)


@pytest.mark.parametrize("depth", [0.02, 0.2, 0.6])
def test_a_uniform_tooth_is_timoshenko_s_cantilever(depth):
    node, weight = leggauss(64)
    found = lowest_frequency(0.5 * (node + 1.0), np.full(64, depth), 0.5 * weight, 1.0, 1.0 / 2.6, 1.0)
    assert found == pytest.approx(timoshenko(depth), rel=1e-4)


@pytest.mark.parametrize(
    ("teeth", "band"), [(20, (58276.0, 65640.0)), (28, (59903.0, 67097.0)), (60, (58895.0, 65806.0))]
)
def test_a_tooth_has_the_frequency_of_seven_teeth_meshed_in_their_body(teeth, band):
    """Modes of seven sectors in plane strain by scikit-fem (quadratic triangles, ends and bore held)."""
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25))
    gear = Gear(tooth, 3.175e-3, 0.7 * tooth.root_radius * 3.175e-3, 25.4e-3)
    assert band[0] < tooth_frequency(gear) < band[1]
    assert tooth_frequency(gear) == pytest.approx(tooth_frequency(gear, 200), rel=2e-5)


LOADS = {
    "steep": LoadingFunction(1.4, 1.0, 0.3, Ramp(1.5, 7)),
    "smooth": LoadingFunction(1.4, 1.0, 0.3, Ramp(0.5)),
    "jump": LoadingFunction(1.0, 1.0),
    "three pairs": LoadingFunction(2.3, 1.0, 0.0, Ramp(), Ramp(), 0.6),
}


@pytest.mark.dear("three pairs-11.2", "steep-11.2")
@pytest.mark.parametrize("order", [0.7, 3.3, 11.2])
@pytest.mark.parametrize("load", LOADS)
def test_a_tooth_answers_a_passage_as_an_oscillator_does(load, order):
    function, omega = LOADS[load], 2.0 * math.pi * order
    solved = solve_ivp(
        lambda x, y: [y[1], omega**2 * (float(function.fraction(x)) - y[0])], (function.x_start, function.x_end),
        [0.0, 0.0], rtol=1e-9, atol=1e-11, max_step=0.01, dense_output=True,
    )  # fmt: skip
    found = tooth_response(function, [order])
    left = math.hypot(solved.y[0, -1], solved.y[1, -1] / omega)
    assert found.residual[0] == pytest.approx(left, abs=1e-6)
    y = solved.sol(np.linspace(function.x_start, function.x_end, 8001))[0]
    assert found.largest[0] == pytest.approx(y.max(), rel=1e-5)
    assert order < 5.0 or found.residual[0] <= found.envelope[0] * 1.05


def found(document):
    scene = build_scene(document, "case", Path())
    return run_plan(scene, make_plan(scene, STAGES))


def test_a_case_says_what_its_teeth_do_at_a_speed():
    gear = {"teeth": 28, "module": "3 mm", "face_width": "20 mm"}
    document = {
        "results": ["loading-spectrum"], "gear": {"a": gear, "b": gear | {"teeth": 35}},
        "pair": {"I": {"driver": "a", "driven": "b", "load": "3 kN"}},
        "loading": {"pair": "I", "slopes": [0.5, 1.0, 2.0], "speed": "20000 rpm"},
    }  # fmt: skip
    results = found(document)
    table, values = results.tables["loading_tooth_vibration_I"], {v.name: v for v in results.values}
    driver = np.array([one == "driver" for one in table["gear"]])
    frequency = values["I.tooth_frequency_driver"].value
    assert table["order"][driver] == pytest.approx(frequency / (20000 / 60 * 28))
    assert (np.diff(table["largest"][driver]) > 0.0).all()  # a steeper start shakes more
    assert any(": single tooth response without damping," in remark for remark in results.remarks)
    document["loading"]["tooth_frequency"] = "50 kHz"
    results = found(document)
    assert {v.name: v.value for v in results.values}["I.tooth_frequency_driven"] == pytest.approx(50e3)
