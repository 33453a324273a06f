"""Diameters of drafted shafts for their deflection: tilts by the formula of a beam, by the gearbox itself, and room."""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from fegear.case.built.shafts import gearbox_of
from fegear.case.drafts import stages
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.first_size import with_teeth_of_ratio
from fegear.case.drafts.stiff_shafts import Ends, MeshOnShaft, collar, permissible, sections, stiff_diameters, tilts
from fegear.case.drafts.text import draft
from fegear.case.reading import build_scene
from fegear.contact.wide.on_shafts import EvenForces, load_gearbox

ENDS = Ends(0.02, 0.01, (0.005, 0.805), 0.01)


def test_the_tilt_under_a_force_and_a_moment_is_that_of_a_beam_on_two_supports():
    at, thick, span = 0.2, 0.02, 0.8  # slender, with seats as thick as itself: shear and steps change nothing
    bending = 206e9 * math.pi / 64.0 * thick**4
    force = MeshOnShaft(0.005 + at, 1000.0, 0.0, 0.0, 0.03, 1.0, 0.02)
    found = tilts([force], ENDS, thick, 1.0)[0] / force.face
    assert found == pytest.approx(1000.0 * at * (span - at) * (span - 2.0 * at) / (3.0 * bending * span), rel=2e-3)
    # a couple alone turns its place by M (l^2 - 3 a b) / (3 E I l); a small radial force says that it counts
    couple = MeshOnShaft(0.005 + at, 0.0, 1e-9, 500.0, 0.03, 1.0, 0.02)
    found = abs(tilts([couple], ENDS, thick, 1.0)[0]) / couple.face
    assert found == pytest.approx(15.0 * (span**2 - 3.0 * at * (span - at)) / (3.0 * bending * span), rel=2e-3)


def test_a_force_in_the_middle_tilts_nothing_and_axial_forces_follow_the_sense_of_rotation():
    middle = MeshOnShaft(0.405, 1000.0, 300.0, 0.0, 0.03, 1.0, 0.02)
    assert tilts([middle], ENDS, 0.03, 1.0)[0] == pytest.approx(0.0, abs=1e-12)
    helical = middle._replace(axial=200.0)
    one, other = (tilts([helical], ENDS, 0.03, sense)[0] for sense in (1.0, -1.0))
    assert one == pytest.approx(-other)
    assert abs(one) > 1e-7


def test_shafts_much_thicker_than_their_seats_have_a_collar():
    assert collar(0.02, 0.025) == 0.0
    assert collar(0.02, 0.026) == pytest.approx(0.023)
    for thick in (0.023, 0.05):
        assert sum(long for long, _ in sections(ENDS, thick)) == pytest.approx(ENDS.length)
    assert [across for _, across in sections(ENDS, 0.05)] == pytest.approx([0.02, 0.023, 0.05, 0.023, 0.02])


def test_the_shaft_that_tilts_most_grows_until_both_open_little_enough_or_there_is_no_room():
    pinion = MeshOnShaft(0.205, 1000.0, 300.0, 0.0, 0.03, 1.0, 0.02)
    wheel = pinion._replace(side=-1.0)
    shafts = [([pinion], ENDS), ([wheel], ENDS)]

    def opened(thick):
        return sum(abs(tilts(*one, d, 1.0)[0]) for one, d in zip(shafts, thick, strict=True))

    found = stiff_diameters(shafts, [0.023, 0.03], [0.2, 0.2])
    assert opened(found) <= permissible(pinion) < opened([d - 1e-3 for d in found])
    assert stiff_diameters(shafts, [0.023, 0.03], [0.025, 0.03]) == pytest.approx((0.025, 0.03))
    assert stiff_diameters(shafts, found, [0.2, 0.2]) == found


@pytest.mark.dear("60")
@pytest.mark.parametrize("ratio", ["11", "60"])
def test_drafted_shafts_open_what_is_permissible_by_the_gearbox_itself(monkeypatch, ratio):
    most = {}

    def kept(placed, thick, room):
        found = stiff_diameters(placed, thick, room)
        for n, (meshes, _) in enumerate(placed[:-1]):
            full = all(found[k] + 1e-3 > room[k] for k in (n, n + 1))
            most[n] = math.inf if full else permissible(meshes[-1])
        return found

    monkeypatch.setattr(stages, "stiff_diameters", kept)
    kind, given, _ = with_teeth_of_ratio(None, {"ratio": ratio})
    case = tomllib.loads(draft(Answers(kind, given), "box"))
    box = gearbox_of(build_scene(case, "box", Path()))
    (state,) = load_gearbox(box, [EvenForces(mesh.even / mesh.load) for mesh in box.meshes], [1.0])
    bent = [shares.over_face[3] for shares, _ in box.misalignment(state.bent, state.forces)]
    assert len(most) == len(bent)
    assert any(math.isfinite(one) for one in most.values())
    for n, opened in enumerate(bent):
        assert abs(opened) <= 1.15 * most[n]
    assert np.abs(bent).max() < 15e-6
