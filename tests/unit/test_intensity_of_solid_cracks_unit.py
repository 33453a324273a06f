"""Stress intensity along a crack's front of a 3D tooth: sums over functions of the face and their derivatives."""

from __future__ import annotations

from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.fem.solid.odd import odd_solid
from fegear.fem.solid.odd.odd_solid import DERIVATIVES, MODES, OddSolid

FUNCTIONS, PLACES, BANDS = 4, 5, 2


@pytest.fixture
def gear(monkeypatch):
    rng = np.random.default_rng(6)
    values = rng.normal(size=(DERIVATIVES, FUNCTIONS, PLACES))
    rows = rng.normal(size=(2 * MODES * DERIVATIVES * FUNCTIONS, BANDS))

    def loads(pressed, flank, face):
        assert (pressed, flank, face.count) == ("pressed", "flank of 3", FUNCTIONS)
        return "loads"

    monkeypatch.setattr(odd_solid, "loads_of", loads)

    class Window:
        missing = ()

        def front(self, near, other, given):
            assert (near, other, given) == (7, 8, "loads")
            return self.rows

    window = Window()
    window.rows = rows
    face = Space(count=FUNCTIONS, values=lambda z: values[0], derivatives=lambda z, order: values[order])
    return Space(face=face, flank_of=lambda j: f"flank of {j}", _on_face=lambda zeta: np.array(zeta), window=window,
                 rows=rows, along=values, _window=lambda i, j: {(2, 3): (window, 7, 8)}.get((i, j)))  # fmt: skip


def test_intensities_are_those_of_the_first_ring_and_err_by_what_another_says(gear):
    value, error = OddSolid.stress_intensity(gear, 2, 3, "pressed", [0.0] * PLACES)
    shaped = gear.rows.reshape(2, MODES, DERIVATIVES, FUNCTIONS, BANDS)
    expected = np.zeros((2, MODES, PLACES, BANDS))
    for ring in range(2):
        for mode in range(MODES):
            for z in range(PLACES):
                for d in range(DERIVATIVES):
                    for k in range(FUNCTIONS):
                        expected[ring, mode, z] += shaped[ring, mode, d, k] * gear.along[d, k, z]
    np.testing.assert_allclose(value, expected[0], rtol=1e-12)
    np.testing.assert_allclose(error, np.abs(expected[0] - expected[1]), rtol=1e-9)


def test_a_tooth_without_a_crack_or_without_its_rows_has_none(gear):
    with pytest.raises(RangeError, match="has no crack"):
        OddSolid.stress_intensity(gear, 2, 4, "pressed", [0.0])
    gear.window.rows = np.zeros((0, BANDS))
    with pytest.raises(RangeError, match="has no crack"):
        OddSolid.stress_intensity(gear, 2, 3, "pressed", [0.0] * PLACES)


def test_what_is_missing_is_coupled_as_ordinary_teeth_and_stressed_by_none():
    window = Space(missing=(7,), coupling=lambda near, other: ("odd", near, other))
    ordinary = Space(compliance={-1: "ordinary -1", 2: "ordinary 2"})

    def solved(found):
        return Space(ordinary=ordinary, _window=lambda i, j: found)

    assert OddSolid.coupling(solved(None), 3, 1) == "ordinary 2"
    assert OddSolid.coupling(solved((window, 5, 6)), 2, 3) == ("odd", 5, 6)
    assert OddSolid.coupling(solved((window, 7, 6)), 2, 3) == "ordinary -1"
    assert OddSolid.coupling(solved((window, 6, 7)), 2, 3) == "ordinary -1"
