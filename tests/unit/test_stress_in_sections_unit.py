"""Root stress of helical teeth in sections of a moving picture: where each number stands; the stress is made up."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.results.pair import stress_in_mesh
from fegear.results.pair.stress_in_mesh import _along, _largest_over_face, _moments, _sections, _stress_over_face

PITCH, START = 1.0, 0.0
ROLL = np.array([0.1, 0.4, 0.7])
Z = np.array([-2.0, 0.0, 3.0])
PAIR = SimpleNamespace(driver=SimpleNamespace(module=2.0), x_start=START, base_pitch=PITCH)
#: Teeth that are followed: roll position and pair; pair 1 leaves before the last one.
TEETH = np.array([[0, 0], [1, 0], [2, 0], [0, 1], [1, 1]])
#: Points of both fillets, rising to the flank.
PLACE = {"tension": np.array([[0.1, 0.2, 0.3], [3.0, 3.5, 4.0]]), "compression": np.array([[-0.1, -0.3], [3.0, 4.0]])}


def value(side, point, z, tooth):
    """Of one point in one section of one tooth."""
    return (1.0 if side == "tension" else -1.0) * (1.0 + point + 10.0 * tooth + 0.25 * z)


class Rooted:
    pair, teeth = PAIR, TEETH
    solution = SimpleNamespace(fillets={side: SimpleNamespace(place=place) for side, place in PLACE.items()})

    def __init__(self, member, factor=1.0):
        self.member, self.factor = member, factor

    def along_fillets(self, side, force, z):
        assert np.ravel(force).tolist() == ["force"]  # that of the nominal load alone
        n = PLACE[side].shape[1]
        return self.factor * np.array(
            [[[value(side, p, at, t) for t in range(len(TEETH))] for at in z] for p in range(n)]
        )

    def stress(self, side, force, z):
        assert side == "tension"
        whole = self.along_fillets(side, force, z)
        return SimpleNamespace(value=whole.max(axis=0).T, radius=np.full((len(TEETH), len(z)), 3.25))


@pytest.fixture(autouse=True)
def placed(monkeypatch):
    """Teeth stand as far ahead as their pair's number."""
    monkeypatch.setattr(
        stress_in_mesh, "placed_in_mesh", lambda pair, member, points, j: points + (j if member == "driver" else -j)
    )


def test_sections_are_spread_over_the_face_and_hold_that_of_the_largest_stress():
    few = np.array([-1.0, 0.0, 1.0])
    np.testing.assert_array_equal(_sections(few, 0.0), [-1.0, 0.0, 1.0])
    places = np.linspace(-1.0, 1.0, 41)
    found = _sections(places, places[7])
    assert places[7] in found
    np.testing.assert_allclose(np.setdiff1d(found, places[7]), places[::2])  # every second of them
    many = np.linspace(0.0, 1.0, 121)
    found = _sections(many, 0.0)
    assert found.size == 25
    assert (found[0], found[-1]) == (0.0, 1.0)
    assert np.isin(found, many).all()
    assert _sections(np.array([0.0, 1.0]), 1.0).tolist() == [0.0, 1.0]


def test_teeth_take_what_they_felt_when_they_stood_there_and_nothing_where_none_followed_them():
    moments = _moments(ROLL, START, PITCH)
    pairs = np.arange(-1, 3)
    found = _along(Rooted("driven"), "force", Z, moments, pairs)
    number = {tuple(one): k for k, one in enumerate(TEETH.tolist())}
    for side in ("tension", "compression"):
        stress = found.stress[side]
        assert stress.shape == (3, moments.roll.size, 4, PLACE[side].shape[1])
        for m, (position, on) in enumerate(zip(moments.position.tolist(), moments.on.tolist(), strict=True)):
            for t, pair in enumerate(pairs.tolist()):
                # A base pitch on, the tooth of pair j stands where that of pair j + 1 stood.
                tooth = number.get((position, pair + on))
                for k, z in enumerate(Z):
                    points = range(PLACE[side].shape[1])
                    wanted = [0.0 if tooth is None else value(side, p, z, tooth) for p in points]
                    np.testing.assert_allclose(stress[k, m, t], wanted)
        np.testing.assert_allclose(found.places[side], [2.0 * PLACE[side] - j for j in pairs])


def test_the_largest_stress_stands_where_the_picture_has_it():
    moments = _moments(ROLL, START, PITCH)
    found = _largest_over_face(Rooted("driver"), "force", Z, moments)
    # The last tooth, pair 1 at the second position, at the highest place; a moment may be that of a pitch on or back.
    assert found.value == pytest.approx(value("tension", 2, 3.0, 4))
    assert (found.member, found.z, found.radius) == ("driver", 3.0, 3.25)
    shown = np.flatnonzero(moments.position == 1)[0]
    assert found.roll == moments.roll[shown]
    assert found.pair == 1 - moments.on[shown]
    # By its radius along the fillet, in metres: half a module up from 3 to 3.5 modules.
    up = np.hypot(*PLACE["tension"])
    share = (3.25 - 2.0 * up[0]) / (2.0 * (up[1] - up[0]))
    across = np.interp(3.25, 2.0 * up, 2.0 * PLACE["tension"][0])
    assert share < 0.0
    assert found.place[0] == pytest.approx(across + found.pair)


def test_both_gears_are_shown_with_the_teeth_that_feel_anything(monkeypatch):
    rooted = {"driver": Rooted("driver"), "driven": Rooted("driven", 3.0)}
    asked = []

    def roots(pair, member, lines, solution, *, coupling):
        asked.append((pair is PAIR, member, lines.roll is ROLL, solution, coupling))
        return rooted[member]

    lines = SimpleNamespace(roll=ROLL)
    force = np.zeros((1, 1, 2), dtype=object)
    force[0, 0, 1] = "force"
    loaded = SimpleNamespace(
        found=SimpleNamespace(pair=PAIR, lines=lines, contact=SimpleNamespace(force=force)), at=1, coupling=True,
        places_along=Z,
    )  # fmt: skip
    monkeypatch.setattr(stress_in_mesh, "loaded_flanks", lambda upstream, name: loaded if name == "I" else None)
    monkeypatch.setattr(
        stress_in_mesh, "solid_solution_of", lambda upstream, gear: SimpleNamespace(fine=f"solid {gear}")
    )
    monkeypatch.setattr("fegear.contact.wide.root_stress.rooted_lines", roots)
    found = _stress_over_face(SimpleNamespace(name="I", gears={"driver": "a", "driven": "b"}), None, None)
    assert asked == [(True, "driver", True, "solid a", True), (True, "driven", True, "solid b", True)]
    moments = _moments(ROLL, START, PITCH)
    np.testing.assert_array_equal(found.roll, moments.roll)
    assert found.largest.member == "driven"
    assert found.largest.value == pytest.approx(3.0 * value("tension", 2, 3.0, 4))
    np.testing.assert_array_equal(found.z, [-2.0, 3.0])  # every second one of them
    for member, factor in (("driver", 1.0), ("driven", 3.0)):
        stress = found.gears[member].stress["tension"]
        assert stress.shape[2] == found.pairs.size
        felt = (stress != 0.0).any(axis=(0, 1, 3))
        assert felt.all()
        assert stress.max() == pytest.approx(factor * value("tension", 2, 3.0, 4))
    # Pairs 0 and 1 at some position, counted back and on by whole base pitches.
    number = {tuple(one) for one in TEETH.tolist()}
    seen = {p - on for position, on in zip(moments.position.tolist(), moments.on.tolist(), strict=True)
            for q, p in number if q == position}  # fmt: skip
    assert set(found.pairs.tolist()) == seen
