"""W. D. Mark, NASA CR-3626, Eqs. 2.38 to 2.59: determinants of the four-square rig beside fegear's elimination."""

import math
from dataclasses import replace
from pathlib import Path

import mpmath
import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError
from fegear.dynamics.train.four_square import FourSquare, relative_difference
from fegear.dynamics.train.increments import dynamic_increments
from fegear.dynamics.train.peaks import increment_peaks
from fegear.dynamics.train.train import Body, Damper, Mesh, Shaft, Torque, Train

CASE = Path(__file__).parents[2] / "cases" / "sources" / "mark_fig14_17.toml"
R, C1, C2 = 0.0417693, 1.26312e-8, 2.10520e-9
I1, I2, I3 = 0.004112, 0.0008010, 0.002994


def damping(zeta_1=0.1, zeta_3=0.5):
    """(5.6) to (5.9)."""
    c1 = 2 * zeta_1 * math.sqrt(I1 * R**2 * (1 / C1 + 1 / C2))
    return c1, c1 / 2, c1 / 2, 2 * zeta_3 * math.sqrt(I3 * R**2 / C2) - c1 / 2


def rig(zeta_3=0.5, sense=-1.0, inertia=(I1, I2, I3)):
    c1, c2, c3, ca = damping(zeta_3=zeta_3)
    return Train(
        bodies=tuple(Body(name, value) for name, value in zip("123", inertia, strict=True)),
        meshes=(
            Mesh("I", "1", "2", R, R, 28, 28, 1 / C1),
            Mesh("II", "3", "1", sense * R, sense * R, 35, 35, 1 / C2),
        ),
        dampers=(Damper("1", None, c1), Damper("2", None, c2), Damper("3", None, c3), Damper("3", "2", ca)),
        torques=(Torque("2", 1615.0 * R), Torque("3", -1615.0 * R)) if sense < 0 else (),
    )


def by_cramer(constants, omega):
    """D, N_1,I + N_2,I and N_1,II + N_2,II as determinants of (2.39) and (2.40), in 40 digits."""
    with mpmath.workdps(40):
        s, mp = mpmath.mpc(0, omega), mpmath.mpf
        (i1, i2, i3), (c1, c2, c3, ca) = (tuple(map(mp, part)) for part in (constants.inertia, constants.damping))
        r, k1, k2 = mp(constants.radius), *map(mp, constants.stiffness)
        a, b = r * r * k1, r * r * k2
        elements = [
            [i1 * s**2 + c1 * s + a + b, a, b],
            [a, i2 * s**2 + (c2 + ca) * s + a, -ca * s],
            [b, -ca * s, i3 * s**2 + (c3 + ca) * s + b],
        ]
        excited = ([r * k1, r * k1, 0], [-r * k2, 0, -r * k2])

        def replaced(column, by):
            return mpmath.det(mpmath.matrix([[by[i] if j == column else row[j] for j in range(3)]
                                             for i, row in enumerate(elements)]))  # fmt: skip

        return (
            complex(mpmath.det(mpmath.matrix(elements))),
            *(complex(replaced(0, by) + replaced(1, by)) for by in excited),
        )


@pytest.mark.parametrize("omega", [3.0, 700.0, 1.4e4, 2.2e4, 3e5])
def test_printed_polynomials_are_cramers_determinants(omega):
    """(2.55) and (2.56) as printed, (2.57) as derived anew, with constants of the rig and with others."""
    for constants in (
        FourSquare.of(rig()),
        FourSquare((1e-3, 2e-3, 5e-4), (3.0, 0.4, 1.7, 20.0), 0.05, (9e7, 2e8)),
        FourSquare((1e-3, 2e-3, 5e-4), (0.0, 0.0, 0.0, 0.0), 0.05, (9e7, 2e8)),
    ):
        d, own, cross = by_cramer(constants, omega)
        assert complex(constants.determinant(omega)) == pytest.approx(d, rel=1e-11)
        # written out in its elements it is the small rest of products of springs
        a, b = constants.springs
        written_out = complex(constants.determinant_of_elements(omega))
        assert written_out == pytest.approx(d, rel=1e-9, abs=1e-14 * a * b * (a + b))
        assert [complex(n) for n in constants.numerators(omega)] == pytest.approx([own, cross], rel=1e-11)


@pytest.mark.parametrize("zeta_3", [0.5, 0.1])
def test_determinants_give_what_elimination_gives(zeta_3):
    omega, train = 2 * np.pi * np.geomspace(1e-3, 1e5, 81), rig(zeta_3)
    q, constants = dynamic_increments(train, omega), FourSquare.of(train)
    printed, cross = constants.as_printed(omega)
    assert relative_difference(constants.own_by_ratio(omega), q[0, 0]).max() < 1e-12
    assert relative_difference(cross, q[0, 1]).max() < 1e-12
    # as printed Q_I,I is a difference that cancels: digits go like the frequency
    lost = relative_difference(printed, q[0, 0])
    assert 1e-12 < lost.max() < 1e-8
    assert lost[omega > 2 * np.pi * 100.0].max() < 1e-12


def test_the_excitation_of_mesh_ii_enters_with_a_minus():
    """The two meshes close on loads of opposite sense; with one sense the other sign."""
    omega = 2 * np.pi * np.array([50.0, 2000.0, 9000.0])
    plus, minus = (FourSquare.of(rig(sense=s)) for s in (1.0, -1.0))
    assert (plus.sense, minus.sense) == (-1, 1)
    for sense, constants in ((1.0, plus), (-1.0, minus)):
        q = dynamic_increments(rig(sense=sense), omega)
        np.testing.assert_allclose(constants.as_printed(omega)[1], q[0, 1], rtol=1e-12)


def test_random_rigs():
    rng = np.random.default_rng(8)
    omega = 2 * np.pi * np.geomspace(0.1, 1e5, 25)
    for _ in range(20):
        inertia = 10.0 ** rng.uniform(-4, -1, 3)
        train = replace(rig(inertia=tuple(inertia)), dampers=tuple(
            Damper(a, b, c) for (a, b), c in zip([("1", None), ("2", None), ("3", None), ("2", "3")],
                                                 10.0 ** rng.uniform(-2, 2, 4), strict=True)
        ))  # fmt: skip
        q, constants = dynamic_increments(train, omega), FourSquare.of(train)
        assert relative_difference(constants.own_by_ratio(omega), q[0, 0]).max() < 1e-10
        assert relative_difference(constants.as_printed(omega)[1], q[0, 1]).max() < 1e-10


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"bodies": (Body("1", I1), Body("2", I2), Body("3", I3), Body("4", 1.0)),
          "shafts": (Shaft("s", "3", "4", 1e4),)}, "4 bodies and 1 shafts"),
        ({"dampers": (Damper("1", "2", 3.0),)}, "a damper between 1 and 2"),
        ({"meshes": (Mesh("I", "1", "2", R, R, 28, 28, 1 / C1, damping=2.0),
                     Mesh("II", "3", "1", -R, -R, 35, 35, 1 / C2))}, "damping in mesh I"),
        ({"meshes": (Mesh("I", "1", "2", R, R, 28, 28, 1 / C1),
                     Mesh("II", "3", "1", -2 * R, -2 * R, 35, 35, 1 / C2))}, "mesh II with other base radii"),
    ],
)  # fmt: skip
def test_another_train_is_refused(change, words):
    with pytest.raises(InputError, match="requires Mark's test rig \\(three bodies, two") as refusal:
        FourSquare.of(replace(rig(), **{"torques": ()} | change))
    assert words in str(refusal.value)


def test_a_case_prints_them_and_refuses_them_of_another_train():
    found = fegear.run(CASE, {"dynamics.frequencies": {"start": "1 Hz", "stop": "20 kHz", "count": 40}}, cache=None)
    table = {column.head: column.values for column in found.tables["dynamic_increments_determinants"].columns}
    q = np.array([table["Q_I_I_re"] + 1j * table["Q_I_I_im"], table["Q_I_II_re"] + 1j * table["Q_I_II_im"]])
    constants, omega = FourSquare.of(rig()), 2 * np.pi * table["frequency [Hz]"]
    # inertias and dampings of the case are those in SI, which are rounded
    np.testing.assert_allclose(np.abs(constants.own_by_ratio(omega)), np.abs(q[0]), rtol=2e-4)
    np.testing.assert_allclose(constants.as_printed(omega)[1], q[1], rtol=1e-3)
    for name in ("I_I", "I_II"):
        assert found.values[f"determinants_difference_{name}"].value < 1e-13
    other = CASE.parents[1] / "lin_dynamic_factor.toml"
    with pytest.raises(InputError, match=r"dynamics\.determinants"):
        fegear.run(other, {"dynamics.determinants": True, "results": ["dynamic-increments"]})


def peaks(zeta_3):
    """Peaks of |Q_I,I| and |Q_I,II| [Hz], from 500 Hz on."""
    train, omega = rig(zeta_3), 2 * np.pi * np.geomspace(500.0, 2e4, 400)
    found = increment_peaks(train, omega, dynamic_increments(train, omega))
    return tuple([p.frequency for p in found if (p.mesh, p.source) == at] for at in ((0, 0), (0, 1)))


def test_the_second_resonance_is_a_peak_that_wanders_with_a_damping_that_is_not_in_print():
    """ "Choice of a smaller value for zeta_3 shows a second resonance in the approximate neighborhood of 2000 Hz"."""
    wandering = {0.5: 1487.8, 0.3: 1922.8, 0.25: 2094.3, 0.2: 2282.9, 0.15: 2417.2, 0.1: 2374.3}
    for zeta_3, frequency in wandering.items():
        own, cross = peaks(zeta_3)
        assert own == pytest.approx([frequency, own[-1]], abs=0.06)
        assert 3660.0 < own[-1] < 3690.0
        assert len(cross) == 1  # Fig. 15 never shows a second one
        assert 3510.0 < cross[0] < 3540.0


def test_a_peak_is_a_maximum_between_the_frequencies_that_are_asked_for():
    """One body on a spring, damped to ground: |Q| has its peak where (w/w0)^2 = (1 + sqrt(1 + 8 zeta^2)) / 2."""
    k, zeta = 2e8, 0.2
    inertia = 0.01
    natural = R * math.sqrt(k / inertia)
    train = Train(
        bodies=(Body("a", inertia), Body("b", 1e9)),
        meshes=(Mesh("m", "a", "b", R, R, 20, 20, k),),
        dampers=(Damper("a", None, 2 * zeta * natural * inertia),),
    )
    omega = np.linspace(0.3, 3.0, 12) * natural
    (peak,) = increment_peaks(train, omega, dynamic_increments(train, omega))
    assert 2 * math.pi * peak.frequency == pytest.approx(
        natural * math.sqrt(0.5 + 0.5 * math.sqrt(1 + 8 * zeta**2)), rel=1e-6
    )
    free = replace(train, dampers=())
    assert increment_peaks(free, omega, dynamic_increments(free, omega)) == ()
