"""The one law of contacts: its tangent is the slope of its approach, and other units of load change nothing."""

import numpy as np
import pytest

from fegear.contact.contact_law import LINEAR, ContactLaw, logarithm
from fegear.contact.plane.edge_law import EdgeContacts
from fegear.formulas.palmgren import EXPONENT

C = np.array([[4.0, 5.0, 6.0], [3.5, 4.5, 5.5]])
EDGES = EdgeContacts(np.array([[-9.0, -1.2, -0.4], [0.3, 1.5, -np.inf]]), np.full((2, 3), 0.1), np.full((2, 3), 0.2))
LAWS = {
    "linear": LINEAR,
    "logarithm": ContactLaw(np.full((2, 3), 0.3), 2.0),
    "corners": ContactLaw(np.full((2, 3), 0.3), 2.0, EDGES),
    "power": ContactLaw(power=0.7),
    "both": ContactLaw(np.full((2, 3), 0.2), 3.0, EDGES, 0.4),
}


@pytest.mark.parametrize("name", LAWS)
def test_the_tangent_is_the_slope_of_the_approach_and_its_line_meets_it(name):
    law, w = LAWS[name], np.array([[0.5, 1.0, 2.0], [4.0, 0.3, 3.0]])
    step = 1e-6 * w
    slope = (law.secant(C, w + step) * (w + step) - law.secant(C, w - step) * (w - step)) / (2.0 * step)
    assert law.tangent(C, w) == pytest.approx(slope, rel=1e-8)
    line, height = law.linearised(C, w, np.full(w.shape, 0.25))
    assert line * w + height == pytest.approx(law.secant(C, w) * w + 0.25, rel=1e-13)


@pytest.mark.parametrize("name", LAWS)
def test_shares_of_a_load_follow_the_same_law(name):
    law, total = LAWS[name], np.array([[7.0, 90.0]] * 3)
    less, of_shares = law.in_shares(total)
    share = np.array([[0.2, 0.5, 1.0], [0.9, 0.1, 0.7]])[:, :, None] + np.zeros(2)
    whole = law.each(lambda values: values[..., None]).secant(C[:, :, None], share * total) + np.zeros(2)
    assert of_shares.secant(C[:, :, None] - less, share) == pytest.approx(whole, rel=1e-13)


def test_the_whole_law_by_hand():
    law, w = LAWS["both"], np.full((2, 3), 5.0)
    psi = EDGES.law(np.sqrt(w / 3.0))[0]
    wanted = C - 0.1 * (np.log(5.0 / 3.0) - 2.0 * psi) + 0.4 * 5.0 ** (EXPONENT - 1.0)
    assert law.secant(C, w) == pytest.approx(wanted, rel=1e-14)
    assert logarithm(w / 3.0, 0.0) == pytest.approx(np.log(w / 3.0), rel=1e-15)


def test_some_contacts_have_the_law_of_all():
    law, w, some = LAWS["both"], np.full((2, 3), 5.0), np.array([2, 0])
    assert (law.at(some).secant(C[:, some], w[:, some]) == law.secant(C, w)[:, some]).all()
    assert LINEAR.is_linear
    assert not LAWS["power"].is_linear
