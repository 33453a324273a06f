"""Contact lines of a helical pair as they are drawn: on lines made up."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.results.helical.contact_lines import LengthOverCycle, ShownLines
from fegear.results.helical.tooth_contact_shown import ShownContact


@pytest.fixture
def shown():
    phi = np.radians([[1.0, 1.5], [2.0, 2.5], [30.0, 30.5]])
    lines = SimpleNamespace(
        phi_1=phi, phi_2=0.5 * phi + 1e-6, z=np.arange(6.0).reshape(3, 2), r_1=10.0 + np.arange(6.0).reshape(3, 2),
        r_2=20.0 + np.arange(6.0).reshape(3, 2), u=np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]),
        v=np.array([[1.0, np.inf], [3.0, 4.0], [5.0, 6.0]]),
    )  # fmt: skip
    gears = (SimpleNamespace(face_width=0.02, form_radius=0.03, tip_radius=0.04),
             SimpleNamespace(face_width=0.03, form_radius=0.05, tip_radius=0.07))  # fmt: skip
    pair = SimpleNamespace(pinion=gears[0], gear=gears[1], axial_offset=0.004, ratio=0.5)
    return ShownLines(pair, lines, SimpleNamespace())


def test_lines_are_numbered_and_their_play_is_one_number(shown):
    assert shown.number.tolist() == [1, 1, 2, 2, 3, 3]
    assert shown.play == pytest.approx(1e-6, rel=1e-6, abs=0.0)
    assert shown.finite("u").tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    assert shown.finite("v") is None


def test_both_flanks_have_their_outline_and_the_first_and_last_line_their_angle(shown):
    pinion, gear = shown.flanks
    assert (pinion.which, gear.which) == ("pinion", "gear")
    assert pinion.z == pytest.approx([-0.01, 0.01, 0.01, -0.01, -0.01])
    assert gear.z == pytest.approx([-0.011, 0.019, 0.019, -0.011, -0.011])
    assert pinion.r == pytest.approx([0.03, 0.03, 0.04, 0.04, 0.03])
    assert gear.r == pytest.approx([0.05, 0.05, 0.07, 0.07, 0.05])
    for flank, radius in ((pinion, shown.lines.r_1), (gear, shown.lines.r_2)):
        assert [line.label for line in flank.lines] == ["φ_{1} = 1°", "", "φ_{1} = 30°"]
        for line, z, r in zip(flank.lines, shown.lines.z, radius, strict=True):
            assert line.z.tolist() == z.tolist()
            assert line.r.tolist() == r.tolist()


def test_a_cycle_ends_with_its_first_position_and_its_axis_has_room():
    found = SimpleNamespace(
        phi_1=np.array([0.0, 0.1, 0.2]), total=np.array([5e-3, 6e-3, 7e-3]), least=5e-3, largest=7e-3
    )
    over = LengthOverCycle(found)
    assert over.phi == pytest.approx([0.0, 0.1, 0.2, 0.3])
    assert over.total.tolist() == [5e-3, 6e-3, 7e-3, 5e-3]
    assert over.ends == pytest.approx((4.6, 7.4))
    found.least = found.largest = 10e-3
    assert LengthOverCycle(found).ends == pytest.approx((9.8, 10.2))
    found.least, found.largest = 0.1e-3, 7e-3
    assert LengthOverCycle(found).ends[0] == 0.0


@pytest.mark.parametrize(("kinds", "share", "changes"), [("sssss", 1.0, 1), ("ssees", 0.6, 2), ("sesee", 0.4, 4)])
def test_share_of_the_cycle_between_edges_is_known_to_a_position_for_each_change(kinds, share, changes):
    """The last position is beside the first: contact that begins and ends within the cycle changes twice."""
    names = {"s": "surface", "e": "edge"}
    mesh = SimpleNamespace(kind=np.array([names[one] for one in kinds]))
    found = ShownContact(SimpleNamespace(contact=SimpleNamespace(mesh=mesh)), None)
    assert found.surface_share == pytest.approx(share)
    assert found.surface_share_error == pytest.approx(changes / 5)
