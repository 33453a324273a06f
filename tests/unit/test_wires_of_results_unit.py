"""Small parts of results by what they stand for: teeth that stand back, the heaviest pair, loads over a surface."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane.moved_outlines import _half_width, _removed
from fegear.contact.wide.loaded import LoadedFlanks
from fegear.contact.wide.loaded_pair import LoadedWidePair, _between, _without_edges
from fegear.dynamics.train import single_tooth
from fegear.dynamics.train.single_tooth import heaviest_pair, summed_harmonics
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack
from fegear.results.helical import double_helical
from fegear.results.planetary import planet_motion
from fegear.results.rating import rated_methods

TOOTH = Tooth(20, BasicRack(1.0, 1.25, 0.25))


# ---- outlines in mesh ------------------------------------------------------------------------------------------------
def engagement(member, spacing, removal=0.0):
    gear = SimpleNamespace(tooth=TOOTH, asymmetric=False)
    none = SimpleNamespace(removal=lambda roll: np.full(np.shape(roll), removal))
    other = SimpleNamespace(removal=lambda roll: np.full(np.shape(roll), 99.0))
    own = (none, other, np.array(spacing), np.array([7.0, 8.0, 9.0]))
    if member == "driven":
        own = (*own[1::-1], *own[:1:-1])
    return SimpleNamespace(
        pair=SimpleNamespace(gear=lambda of: gear if of == member else None), driver_relief=own[0],
        driven_relief=own[1], driver_spacing=own[2], driven_spacing=own[3],
    )  # fmt: skip


@pytest.mark.parametrize("member", ["driver", "driven"])
def test_a_tooth_that_stands_back_is_turned_about_the_centre_and_its_fillets_hold_on_to_the_body(member):
    root, form, tip = TOOTH.root_radius, TOOTH.form_radius, TOOTH.involute_tip_radius
    radii = np.array([root, 0.5 * (root + form), form, tip])
    points = np.stack([0.02 * radii, np.sqrt(1.0 - 0.02**2) * radii])  # off the flanks
    spacing = [1e-3, -2e-3, 3e-3]
    found = _removed(engagement(member, spacing), member, points, [-1, 0, 1, 2, 3])
    for t, pair in enumerate((-1, 0, 1, 2, 3)):
        turn = spacing[(-pair) % 3] / TOOTH.base_radius
        share = np.array([0.0, 0.5, 1.0, 1.0])
        np.testing.assert_allclose(found[t], turn * share * np.stack([-points[1], points[0]]), atol=1e-15)
    assert not _removed(engagement(member, []), member, points, [0, 1]).any()


@pytest.mark.parametrize("member", ["driver", "driven"])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_relief_is_taken_off_both_flanks_along_their_normals(member, side):
    radius = np.linspace(TOOTH.form_radius * 1.001, TOOTH.involute_tip_radius, 4)
    half = TOOTH.half_thickness_angle(radius)
    points = np.stack([side * radius * np.sin(half), radius * np.cos(half)])
    found = _removed(engagement(member, [], 2e-3), member, points, [0, 1])
    assert found.shape == (2, 2, 4)
    np.testing.assert_allclose(np.hypot(*found[0]), 2e-3, rtol=1e-9)
    # Inward, along the line that is tangent to the base circle.
    normal = found[0] / 2e-3
    lever = points[0] * normal[1] - points[1] * normal[0]
    np.testing.assert_allclose(np.abs(lever), TOOTH.base_radius, rtol=1e-6)
    assert (np.sign(normal[0]) == -side).all()
    inside = np.stack([0.0 * radius, radius])
    assert not _removed(engagement(member, [], 2e-3), member, inside, [0])[0].any()


def test_half_widths_are_the_source_s_own_where_none_follows_the_load_and_hertzian_elsewhere():
    contacts = SimpleNamespace(
        radius_driver=np.array([[1.0]]), radius_driven=np.array([[2.0]]), x=np.zeros((1, 1)),
        relative_radius=np.array([[5.0]]),
    )  # fmt: skip
    state = SimpleNamespace(grid=SimpleNamespace(contacts=contacts), loads=np.array([[[30.0]]]))
    for member, radius in (("driver", 1.0), ("driven", 2.0)):
        source = SimpleNamespace(reference_half_width=lambda at, member=member: (member, at.tolist()))
        law = SimpleNamespace(
            hertz="none", source=lambda of, member=member, source=source: source if of == member else None
        )
        found = _half_width(SimpleNamespace(compliance=law), state, member)
        assert found == (member, [[radius]])
    for hertz, load in (("load-dependent", 30.0), ("linear", 70.0)):
        law = SimpleNamespace(
            hertz=hertz, nominal_load=70.0, half_width=lambda of, radius: (of.tolist(), radius.tolist())
        )
        assert _half_width(SimpleNamespace(compliance=law), state, "driver") == ([[load]], [[5.0]])


# ---- tooth forces ----------------------------------------------------------------------------------------------------
def test_the_heaviest_pair_is_the_one_that_an_error_presses_most(monkeypatch):
    asked = []

    def pair_at(excitation, x, pitch, number):
        asked.append((excitation, float(x[0]), float(x[-1]), pitch, number))
        return np.full(x.shape, 2.0), np.full(x.shape, 0.1 * number)

    monkeypatch.setattr(single_tooth, "tooth_pair_at", pair_at)

    class Error:
        pitches = 4

        def __call__(self, places):
            return np.where((places >= 2.0) & (places < 2.5), 5.0, 1.0)  # within the base pitch of pair 2

    pair = SimpleNamespace(x_start=0.0, x_end=1e-3, base_pitch=2e-3)
    mesh = SimpleNamespace(error=Error(), pair=pair, excitation="springs")
    data = SimpleNamespace(meshes=[None, mesh], errors=[SimpleNamespace(pitches=1), Error()])
    assert heaviest_pair(data, 1) == 2
    assert asked == [("springs", 0.0, 1e-3, 2e-3, number) for number in range(4)]
    data.meshes[1] = SimpleNamespace(error=SimpleNamespace(pitches=1), pair=pair, excitation="springs")
    assert heaviest_pair(data, 1) == 0
    assert summed_harmonics(data, 10) == 64  # 256 lines, four pitches
    assert summed_harmonics(data, 100) == 100


# ---- loads over a surface --------------------------------------------------------------------------------------------
def test_places_of_a_surface_hold_the_pitch_point_where_it_lies_between_and_keep_off_the_ends():
    found = _between(-1.0, 3.0, 5)
    np.testing.assert_allclose(found, np.sort([*np.linspace(-0.996, 2.996, 5), 0.0]))
    beyond = _between(1.0, 3.0, 5)
    np.testing.assert_allclose(beyond, np.linspace(1.002, 2.998, 5))


def lines():
    """Two roll positions, a line each: stations of which both ends stand at an edge, or all."""
    z = np.array([[0.0, 1.0, 2.0, 4.0], [0.0, 1.0, 2.0, 4.0]])
    at_edge = np.array([[True, False, False, True], [True, True, True, True]])
    return SimpleNamespace(
        roll=np.array([0.1, 0.2]), z=z, at_edge=at_edge, at=lambda p: [slice(0, 4)], low=-2.0, high=4.0
    )


def test_beside_edges_a_load_is_that_of_the_station_next_to_them():
    load = np.zeros((2, 4, 2))
    load[:, :, 1] = [[90.0, 10.0, 20.0, 80.0], [90.0, 10.0, 20.0, 80.0]]
    found = _without_edges(SimpleNamespace(lines=lines(), line_load=load), 1)
    np.testing.assert_array_equal(found, [[10.0, 10.0, 20.0, 20.0], [90.0, 10.0, 20.0, 80.0]])
    assert load[0, 0, 1] == 90.0  # what was solved stays


def test_a_surface_shows_line_loads_over_path_and_face_and_none_below_zero():
    asked = []

    def spread(x, z, load):
        asked.append((x, z, load))
        return np.subtract.outer(z, x)

    pair = SimpleNamespace(x_start=-3.0, x_end=5.0)
    found = SimpleNamespace(lines=lines(), line_load=np.ones((2, 4, 2)), spread=spread)
    shown = LoadedWidePair.flank_load(SimpleNamespace(found=found, at=1), pair)
    ((x, z, load),) = asked
    assert (x[0], x[-1]) == pytest.approx((-3.0 + 8e-3, 5.0 - 8e-3))
    assert (z[0], z[-1]) == pytest.approx((-2.0 + 6e-3, 4.0 - 6e-3))
    assert 0.0 in x
    assert 0.0 in z
    assert load.shape == (2, 4)
    assert (len(x), len(z)) == (122, 42)
    np.testing.assert_array_equal(shown.line_load, np.maximum(np.subtract.outer(z, x), 0.0))
    assert (shown.x is x, shown.z is z, shown.over_face, shown.outside) == (True, True, True, 0.0)


def test_just_beyond_the_limits_of_smooth_flanks_stands_the_pressure_at_the_limit():
    """Of line load and width factor where the clearance is nil: 2/pi sqrt(w/f), no less than what is there."""
    load = np.array([[[10.0], [20.0], [40.0], [80.0]]])
    factor = np.array([[2.0, 4.0, 4.0, 5.0]])
    own = np.array([[[1.0], [2.0], [3.0], [99.0]]])
    smooth = np.array([[False, True, True, False]])
    clearance = np.array([[-1.0, 3.0, 2.0, -2.0]])
    flanks = SimpleNamespace(
        smooth=smooth, pressure=own, long=np.ones((1, 4), dtype=bool), line_load=load,
        lines=SimpleNamespace(panel=np.ones((1, 3)), clearance=lambda pair, room: clearance),
        pair=SimpleNamespace(driver=SimpleNamespace(module=2e-3)), known=SimpleNamespace(width_factor=factor),
    )  # fmt: skip
    found = LoadedFlanks.smooth_pressure.func(flanks)
    low = 2.0 / math.pi * math.sqrt((20.0 - 0.75 * 10.0) / (4.0 - 0.75 * 2.0))  # three quarters of the way
    high = 2.0 / math.pi * math.sqrt(60.0 / 4.5)
    np.testing.assert_allclose(found[0, :, 0], [low, 2.0, 3.0, high])
    flanks.lines.panel = np.array([[0.0, 1.0, 1.0]])  # of another line
    np.testing.assert_allclose(LoadedFlanks.smooth_pressure.func(flanks)[0, :, 0], [0.0, 2.0, 3.0, high])
    flanks.long = np.array([[True, True, True, False]])
    np.testing.assert_allclose(LoadedFlanks.smooth_pressure.func(flanks)[0, :, 0], [0.0, 2.0, 3.0, 0.0])


# ---- motions of a set ------------------------------------------------------------------------------------------------
def test_motions_of_a_set_that_do_not_repeat_are_named_with_their_speeds():
    speed = np.array([10.0, 20.0, 30.0])
    data = SimpleNamespace(
        motion=np.array(["periodic", "chaotic", "not settled"]),
        speed=speed * math.pi / 30.0,
        apart=np.array([0.0, 0.1, 0.3]),
    )
    seen = SimpleNamespace(data=data, name="P")
    assert planet_motion._odd(seen).startswith(
        "Set P: non-periodic motion at 2 speeds: 20 rpm chaotic, 30 rpm not settled;"
    )
    assert planet_motion._apart(seen) == "Set P: loss of contact at 2 of 3 speeds, longest at 30 rpm."


def test_motions_of_a_set_are_forecast_by_planets_and_speeds(monkeypatch):
    part = SimpleNamespace(count=4, speeds=SimpleNamespace(array=np.zeros(7)))
    monkeypatch.setattr(planet_motion, "planetary_part", lambda scene, name: part if name == "P" else None)
    found = planet_motion._forecast(None, "P")
    assert found.settings == {"speeds": 7, "planets": 4}
    assert found.seconds == pytest.approx(planet_motion._SECONDS * 28)
    part.speeds = None
    assert planet_motion._forecast(None, "P").seconds == 0.0


def test_only_what_finite_elements_say_of_a_rating_has_errors_and_each_method_says_its_own():
    """Made up: of AGMA the gears stand in another order than in the pair, and nothing is estimated."""

    def rating(first, **more):
        names = "contact_stress", "contact_safety", "bending_stress", "bending_safety"
        return SimpleNamespace(**{name: (first + k, first + k + 0.5) for k, name in enumerate(names)}, **more)

    agma = SimpleNamespace(members=("driven", "driver"), contact=(1, 2), S_H=(3, 4), bending=(5, 6), S_F=(7, 8))
    off = SimpleNamespace(bending_error=(0.1, 0.2), contact_error=0.05, replacement=SimpleNamespace(K_Hbeta=1.2))
    found = {"formula": rating(10), "by_computed": rating(20), "spectrum": None, "spectrum_computed": rating(30)}
    data = SimpleNamespace(**found, computed=off, agma=agma)
    asked = SimpleNamespace(
        conditions=SimpleNamespace(edition=2019, geometry=SimpleNamespace(members=("driver", "driven")))
    )
    found = {method.ending: (method, said) for method, said in rated_methods.methods(data, asked)}
    assert list(found) == ["", "_computed", "_agma", "_spectrum_computed"]
    assert [ending for ending, (method, _) in found.items() if method.estimated] == ["_computed"]
    assert found["_computed"][1] == {
        "contact_stress": (20, 20.5), "contact_safety": (21, 21.5), "bending_stress": (22, 22.5),
        "bending_safety": (23, 23.5), "contact_error": (0.05, 0.05), "bending_error": (0.1, 0.2),
    }  # fmt: skip
    assert found["_agma"][1] == {
        "contact_stress": (2, 1),
        "contact_safety": (4, 3),
        "bending_stress": (6, 5),
        "bending_safety": (8, 7),
    }
    assert found["_spectrum_computed"][1] == {"contact_safety": (31, 31.5), "bending_safety": (33, 33.5)}


def test_gears_at_end_2_are_those_that_are_named_or_mirror_those_at_end_1(monkeypatch):
    monkeypatch.setattr(double_helical, "solid_solution_of", lambda upstream, gear: (upstream, gear))
    monkeypatch.setattr(double_helical, "_mirror", lambda solved, other, work: ("of", solved, other, work))
    asked = SimpleNamespace(gears=("p", "w"), second=("q", 7))
    assert double_helical._gears(asked, "known", "work") == [
        [("known", "p"), ("known", "w")], [("known", "q"), ("of", ("known", "w"), 7, "work")],
    ]  # fmt: skip
