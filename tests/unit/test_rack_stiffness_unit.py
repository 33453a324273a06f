"""Compliance and root stress of the teeth of a rack: which teeth, made of what, and the sentence about them."""

from __future__ import annotations

from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.results.rack import rack_stiffness
from fegear.results.rack.rack_stiffness import BandsOnRackTooth, RackStiffness, ToothOfRack, _answer, _named_teeth

M, E = 4e-3, 2e11


@pytest.mark.parametrize(
    ("teeth", "named"), [(1, [0]), (2, [0, 1]), (3, [0, 1, 2]), (4, [0, 1, 3]), (9, [0, 4, 8]), (10, [0, 4, 9])]
)
def test_the_first_the_middle_and_the_last_tooth_are_named_each_once(teeth, named):
    assert _named_teeth(Space(teeth=teeth)) == named


class Loaded:
    """A tooth of which everything is a law of its number and the height."""

    def __init__(self, number, teeth, scale):
        self.number, self.scale = number, scale
        self.compliance = {k: None for k in (-1, 0, 1) if 0 <= number + k < teeth}

    def neighbour(self, k, watched, pressed, patch):
        assert watched == pressed
        assert patch == 0.3
        return self.scale * np.array([[(10.0 + k) * watched[0] + self.number]])

    def largest_root_stress(self, k, side, heights):
        assert k == 0
        return self.scale * (1.0 if side == "tension" else -2.0) * heights**2, "place"


def teeth_of(rack, scale):
    return Space(
        rack=rack, patch=0.3,
        solved=Space(loaded=lambda i: Loaded(i, rack.teeth, scale), flank=Space(heights=(-0.5, 1.0))),
        self_compliance=lambda i, heights, half: {0.02 * M: scale * (100.0 + i + heights)}[half],
    )  # fmt: skip


@pytest.mark.parametrize("estimated", [True, False])
def test_numbers_of_a_tooth_are_those_of_its_solution_with_what_another_one_changes(monkeypatch, estimated):
    rack = Space(module=M, material=Space(young_modulus=E), teeth=5)
    both = Space(fine=teeth_of(rack, 1.0), coarse=teeth_of(rack, 0.9) if estimated else None)
    monkeypatch.setattr(rack_stiffness, "rack_of", lambda upstream, name: {("up", "R"): both}[upstream, name])
    found = rack_stiffness._compute(Space(rack=rack, name="R"), "up", None)
    assert (list(found.teeth), found.bands) == (["1", "3", "5"], {})
    heights = np.linspace(-0.5 * M, M, 41)
    for key, one in found.teeth.items():
        i = int(key) - 1
        assert one.number == i + 1
        np.testing.assert_allclose(one.height, heights)
        np.testing.assert_allclose(one.own, 100.0 + i + heights)
        y = heights / M
        before, after = ((10.0 + k) * y + i for k in (-1, 1))
        np.testing.assert_allclose(one.before, before / E if i > 0 else np.full(41, np.nan))
        np.testing.assert_allclose(one.after, after / E if i < 4 else np.full(41, np.nan))
        np.testing.assert_allclose(one.tension, y**2 / M)
        np.testing.assert_allclose(one.compression, -2.0 * y**2 / M)
        np.testing.assert_allclose(one.own_error, 0.1 * one.own if estimated else np.full(41, np.nan))
        np.testing.assert_allclose(one.tension_error, 0.1 * one.tension if estimated else np.full(41, np.nan))


def test_bands_on_a_3d_tooth_have_places_over_height_and_face_and_errors_by_their_shares(monkeypatch):
    rack = Space(module=M, material=Space(young_modulus=E), teeth=4, face_width=20e-3)
    solutions = [
        Space(loaded=lambda i, name=name: (name, i), flank=Space(lowest_radius=-0.5, highest_radius=1.0))
        for name in ("fine", "coarse")
    ]

    class Both(list):
        fine = solutions[0]

    shape = (9, 5)
    grid = np.arange(45.0).reshape(shape) + 1.0

    class Numbers:
        def __init__(self, name, i):
            self.name = name
            self.compliance = {"c_self": grid + i, "c_prev": 2.0 * grid, "c_next": 3.0 * grid}
            self.root = {"tension": Space(value=-grid), "compression": Space(value=-5.0 * grid)}

        def apart(self, other):
            assert (self.name, other.name) == ("fine", "coarse")
            return {"c_self": 0.1 * grid, "root_tension": 0.2 + 0.0 * grid}

    def bands(fine, heights, places, half):
        assert fine[0] == "fine"
        np.testing.assert_allclose(heights, np.linspace(-0.5, 1.0, 11)[1:-1])
        np.testing.assert_allclose(places, [-2.5, -1.25, 0.0, 1.25, 2.5])
        assert half == 0.02
        return "bands"

    def numbers(solution, given, module):
        assert (given, module) == ("bands", M)
        return Numbers(*solution)

    monkeypatch.setattr("fegear.fem.solid.table.bands_of_table", bands)
    monkeypatch.setattr("fegear.fem.solid.table.band_numbers", numbers)
    monkeypatch.setattr("fegear.fem.solid.influence.SolidInfluence", lambda fine, coarse, more: Space(
        entry_shares={"contact": 0.5, "root_tension": 0.25}) if (fine[0], coarse[0], more) == ("fine", "coarse", {})
        else None)  # fmt: skip
    found = rack_stiffness._over_face(Space(rack=rack), Both(solutions))
    assert list(found.bands) == ["1", "2", "4"]
    for key, one in found.bands.items():
        i = int(key) - 1
        own = (grid + i) / (E * M)
        np.testing.assert_allclose(one.own, own.ravel())
        blank = np.full(45, np.nan)
        np.testing.assert_allclose(one.before, blank if i == 0 else (2.0 * grid / (E * M)).ravel())
        np.testing.assert_allclose(one.after, blank if i == 3 else (3.0 * grid / (E * M)).ravel())
        np.testing.assert_allclose(one.tension, -grid.ravel())
        np.testing.assert_allclose(one.compression, -5.0 * grid.ravel())
        np.testing.assert_allclose(one.own_error, (0.5 * 0.1 * grid * own).ravel())
        np.testing.assert_allclose(one.tension_error, (0.25 * 0.2 * grid).ravel())
        np.testing.assert_allclose(one.height.reshape(shape)[:, 0], np.linspace(-0.5, 1.0, 11)[1:-1] * M)
        np.testing.assert_allclose(one.position.reshape(shape)[3], [-10e-3, -5e-3, 0.0, 5e-3, 10e-3])
        middle = one.at_middle
        assert middle.number == i + 1
        np.testing.assert_allclose(middle.own, own[:, 2])


def plane(number, own):
    height = np.array([-2e-3, -1e-4, 3e-3])
    return ToothOfRack(number, height, np.array([9.0, own, 9.0]) * 1e-9, *[height] * 6)


def test_the_answer_is_on_the_reference_line_of_the_middle_tooth():
    teeth = {"1": plane(1, 0.06), "3": plane(3, 0.05), "5": plane(5, 0.055)}
    said = "Rack R: c_0 on the reference line 0.05 µm mm/N in the middle"
    assert list(_answer(Space(name="R", data=RackStiffness(teeth)))) == [
        f"{said}, 20 % and 10 % more at the first and the last tooth."
    ]
    alone = RackStiffness({"1": teeth["3"]})
    assert list(_answer(Space(name="R", data=alone))) == [f"{said}."]
    x = np.zeros(4)
    band = BandsOnRackTooth(2, np.array([2e-3, 1e-3, 1e-3, -3e-3]), np.array([0.0, 2e-3, 0.0, 0.0]),
                            np.array([1.0, 2.0, 3.0, 4.0]) * 1e-6, x, x, x, x, x, x)  # fmt: skip
    other = BandsOnRackTooth(1, band.height, band.position, 10.0 * band.own, x, x, x, x, x, x)
    seen = Space(name="R", data=RackStiffness(bands={"1": other, "2": band, "3": other}))
    (said,) = _answer(seen)
    assert said == (
        "Rack R: c_0 of a band at mid-face, 1 mm above the reference line, 3 µm/N in the middle of the rack."
    )
