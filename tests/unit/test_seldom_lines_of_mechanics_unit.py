"""Lines of contact, finite elements and the atlas that only long runs come to, each by a law or a number of its own."""

import math
import os
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import fegear.atlas.__main__ as atlas_program
from fegear.atlas.family import Family, Place
from fegear.atlas.shipped import shipped_atlas
from fegear.base import streams
from fegear.base.errors import ConvergenceError, FegearError, InputError, RangeError
from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.contact.measured_error import _one_way, measured_error
from fegear.contact.plane.fe_compliance import FiniteElementCompliance
from fegear.contact.plane.tooth_table import RootTable
from fegear.contact.rack import over_stroke
from fegear.contact.rack.rack_teeth import RackTeeth
from fegear.contact.unloaded.separation import Helix
from fegear.contact.wide import loaded_pair, over_revolution, spots, tip_edges
from fegear.contact.wide.loaded_pair import LoadedWidePair
from fegear.fem.plane.condensation import Condensed
from fegear.fem.plane.gauge import Grid
from fegear.fem.plane.odd import hole, keyway, odd_solution
from fegear.fem.plane.odd.cracked_sector import _folds
from fegear.fem.plane.odd.keyway import Keyway
from fegear.fem.plane.odd.odd_gear import OddGearInfluence
from fegear.fem.plane.odd.other_outline import OtherTip
from fegear.fem.plane.rack.straight_flank import StraightFlank
from fegear.fem.plane.root_stress import curves_apart, usually_apart
from fegear.fem.solid import dissection, step_model
from fegear.fem.solid.odd import odd_solid_solution
from fegear.fem.solid.odd.odd_solid import OddSolid
from fegear.fem.solid.slices import ThinLines
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack


# ---- atlas and base --------------------------------------------------------------------------------------------------
def test_a_family_has_the_gears_of_its_rack_only():
    gear = Family().gear(Place(31, 0.2, 1.0, 0.5))
    assert Family().has(gear)
    assert not Family(rounding=0.3).has(gear)


def test_an_atlas_counts_the_gears_that_were_solved_in_all_regions():
    atlas = shipped_atlas("A")
    assert len(atlas.pieces) > 1
    assert atlas.gears == sum(len(piece.solved.T) for piece in atlas.pieces) > 100


def test_an_atlas_is_built_from_the_command_line(tmp_path, monkeypatch, capsys):
    def built(rack, *, cache, progress):
        progress(3, 8)
        return SimpleNamespace(gears=8, save=lambda path: path.write_bytes(bytes(10**6)), rack=rack)

    monkeypatch.setattr(atlas_program, "built", built)
    monkeypatch.chdir(tmp_path)
    assert atlas_program.main(["C"]) == 0
    (made,) = tmp_path.iterdir()
    assert made.name == atlas_program.file_name("C")
    assert "3 gears solved, 8 wanted so far" in capsys.readouterr().err
    assert atlas_program.main(["C", "other.npz"]) == 0
    assert "other.npz: 8 gears, 1.00 MB" in capsys.readouterr().err
    for wrong in ([], ["Z"], ["C", "a", "b"]):
        assert atlas_program.main(wrong) == 2


def test_streams_that_are_closed_become_the_null_device(monkeypatch):
    opened, closed = [], {0, 2}

    def state(number):
        if number in closed:
            raise OSError

    known = {name: getattr(os, name) for name in ("devnull", "O_RDONLY", "O_WRONLY")}
    system = SimpleNamespace(fstat=state, open=lambda name, how: opened.append((name, how)), **known)
    monkeypatch.setattr(streams, "os", system)
    streams.open_streams()
    assert opened == [(os.devnull, os.O_RDONLY), (os.devnull, os.O_WRONLY)]


def test_a_stream_that_takes_no_more_ends_in_the_null_device(tmp_path):
    with (tmp_path / "full").open("w") as stream:
        streams.give_up(stream)
        stream.write("lost")
        stream.flush()
        assert os.fstat(stream.fileno()).st_rdev == Path(os.devnull).stat().st_rdev
    assert (tmp_path / "full").read_text() == ""
    streams.give_up(stream)  # closed by now: nothing happens


# ---- curves and traces -----------------------------------------------------------------------------------------------
def test_the_secant_starts_where_it_carries_the_load_asked_for():
    loads, te, stiffness = np.array([100.0, 400.0]), {1: 5e-6, None: 9e-6}, {1: 4e7, None: 8e7}
    curve = SimpleNamespace(
        loads=loads, at=1, error=lambda angle, under: np.full(2, te[under]),
        stiffness=lambda angle, *, secant, under: np.full(2, stiffness[under] if secant else math.nan),
    )  # fmt: skip
    assert ErrorOverPitch.start(curve, [0.0, 1.0]) == pytest.approx(np.full(2, 9e-6 - 400.0 / 8e7))
    curve.at = 0
    te[0], stiffness[0] = 6e-6, 5e7
    te[1] = 30e-6
    assert ErrorOverPitch.start(curve, [0.0, 1.0], under=1) == pytest.approx(np.full(2, 30e-6 - 400.0 / 4e7))


def test_samples_at_one_angle_are_one_and_a_trace_that_is_all_spikes_has_none():
    turned, te = _one_way(np.full(4, 0.3), np.arange(4.0), 0.1)
    assert (turned.tolist(), te.tolist()) == ([0.3], [0.0])
    angle = 2.0 * math.pi * np.arange(4000) / 2000
    smooth = 1e-6 * np.cos(20.0 * angle)
    some, many = smooth.copy(), smooth.copy()
    some[::400] += 1e-4  # few samples: none of the trace
    many[::7] += 1e-4  # a seventh: what was measured
    plain, few, all_of_them = (measured_error(angle, te, 20) for te in (smooth, some, many))
    assert np.ptp(few.te) == pytest.approx(np.ptp(plain.te), rel=0.02)
    assert np.ptp(all_of_them.te) > 2.0 * np.ptp(plain.te)


# ---- teeth in contact ------------------------------------------------------------------------------------------------
def test_what_lies_beyond_the_reach_of_a_solution_is_nothing():
    known = SimpleNamespace(
        reach=1, fillet_stress=lambda k, side, radius: np.full((5, len(radius)), 10.0 + k), tabulated={}
    )
    source = FiniteElementCompliance(known, None, 0.0, 1.0)
    r = np.ones(3)
    assert source.root_stress(4, 3, r, "tension").tolist() == [[11.0] * 3] * 5
    assert source.root_stress(3, 4, r, "tension").tolist() == [[9.0] * 3] * 5
    for i, j in ((2, 4), (4, 2), (9, 0)):
        assert source.root_stress(i, j, r, "tension").tolist() == [[0.0] * 3] * 5
        assert source.between(i, j, r[:, None], r).tolist() == [[0.0] * 3] * 3


def test_the_reach_of_a_table_is_that_of_its_farthest_tooth():
    table = RootTable(1.0, 0.0, 0.1, dict.fromkeys(range(-2, 3), np.zeros(1)), None)
    assert table.reach == 2


def test_a_stroke_that_is_off_the_path_shares_nothing():
    x = np.array([0.5, 0.7])

    @dataclass
    class Found:
        asked: Any = None

        def contacts(self, x, tooth):
            self.asked = x
            return SimpleNamespace(gap=np.full((3, len(x)), np.inf), x=np.zeros((3, len(x))))

    one = over_stroke.base_pitch(None, Found(), 100.0, 4, x)
    assert one.x.size == 0
    assert [np.shape(part) for part in vars(one).values() if isinstance(part, np.ndarray)][1] == (3, 0)


def test_compliance_of_a_rack_s_tooth_is_that_in_modules_over_young_s_modulus():
    asked = []

    def compliance(height, patch, half_width):
        asked.append((height.tolist(), patch, float(half_width)))
        return 3.0 + height

    tooth = SimpleNamespace(self_compliance=compliance, log_slope=0.6)
    rack = SimpleNamespace(module=2e-3, material=SimpleNamespace(young_modulus=2e11))
    teeth = SimpleNamespace(rack=rack, patch=0.1, solved=SimpleNamespace(loaded=lambda i: tooth))
    assert RackTeeth.self_compliance(teeth, 4, [1e-3, -2e-3], 4e-5) == pytest.approx([3.5 / 2e11, 2.0 / 2e11])
    assert asked == [([0.5, -1.0], 0.1, pytest.approx(0.02))]
    assert RackTeeth.log_slope.fget(teeth) == pytest.approx(0.6 / 2e11)


def test_helices_are_chosen_by_a_mask():
    helix = Helix(np.arange(3) * 1j, np.arange(3) * 2j)
    some = helix[np.array([True, False, True])]
    assert (some.w.tolist(), some.dw.tolist()) == ([0j, 2j], [0j, 4j])


def test_a_corner_that_does_not_exist_reaches_nowhere(monkeypatch):
    corners = [SimpleNamespace(exists=False), SimpleNamespace(exists=True, reach=3.0)]
    monkeypatch.setattr(tip_edges, "Meshing", lambda pair, corner_contact: SimpleNamespace(corners=corners))
    monkeypatch.setattr(tip_edges, "reach_of_corner", lambda gap, farthest, most: (farthest, most))
    rack = BasicRack(1.0, 1.25, 0.25)
    gears = [Gear(Tooth(z, rack), 1e-3, 0.3e-3 * z) for z in (20, 30)]
    pair = tip_edges.GearPair(*gears)
    found = tip_edges.edge_reach(pair, 2e-6)
    assert found == (0.0, (min(3.0, tip_edges.FARTHEST * pair.base_pitch), 2e-6))


@pytest.mark.parametrize("fails", [0, 1, 2])
def test_spots_are_averaged_over_the_first_part_of_their_width_at_which_stations_are_found(monkeypatch, fails):
    """Half of it, all of it, or the widest that the load could make: what is found belongs to what is given back."""

    @dataclass(frozen=True)
    class Known:
        width_factor: np.ndarray
        spot: Any = None

    width, tried = np.full((2, 1, 3), 4e-4), []

    def solved(known, gap, load, patience=None):
        tried.append(known.spot)
        if patience is not None and len(tried) <= 1 + fails:
            raise ConvergenceError("none")
        return "contact", known

    monkeypatch.setattr(spots, "solve_contact", solved)
    monkeypatch.setattr(spots, "_half_width", lambda known, contact: width)
    known, (_, of) = spots._own_width(Known(np.array([[1e-12, 4e-12], [2e-12, 2e-12]])), None, np.array([500.0]))
    assert of is known
    widest = np.cbrt(0.25 * 500.0 * np.array([[4e-12], [2e-12]]))
    np.testing.assert_allclose(tried[0], widest)
    expected = {0: 0.5 * 4e-4, 1: 4e-4}
    np.testing.assert_allclose(known.spot, expected[fails] * np.ones((2, 1)) if fails < 2 else widest)


def test_a_revolution_is_what_following_the_flanks_finds(monkeypatch):
    monkeypatch.setattr(over_revolution, "follow_flanks", lambda *given: SimpleNamespace(over=given))
    assert over_revolution.wide_over_revolution("flanks", 7, "told") == ("flanks", 7, "told")


def test_root_stress_of_one_gear_over_the_face_is_the_first_of_what_is_found(monkeypatch):
    def found(loaded, member, influence, kept):
        assert kept == {}
        return (loaded, member, influence), "other"

    monkeypatch.setattr(loaded_pair, "largest_over_face", found)
    assert LoadedWidePair.tooth_stress("pair", "driven", "solved") == ("pair", "driven", "solved")


def test_curves_are_apart_where_the_first_counts():
    """Above half, or a quarter, of its largest value: at most, and on average of squares."""
    values, others = np.array([[4.0, 2.0, 1.0, -9.0], [8.0, 3.0, 1.0, 4.0]]), np.zeros((2, 4))
    others[0], others[1] = values[0] + [0.1, -0.3, 5.0, 9.0], values[1] + [0.2, 9.0, 9.0, -0.4]
    assert curves_apart(values, others) == pytest.approx([0.3, 0.4])
    assert usually_apart(values, others, 0.5) == pytest.approx([math.sqrt(0.05), math.sqrt(0.1)])
    assert curves_apart(values, others, 0.25) == pytest.approx([5.0, 9.0])
    assert usually_apart(values, others, 0.25)[0] == pytest.approx(math.sqrt((0.01 + 0.09 + 25.0) / 3.0))


@pytest.mark.parametrize("direction", [0.0, 0.5, -0.5, 0.5 * math.pi, 2.5])
def test_a_turned_grid_reaches_as_far_as_its_corners(direction):
    grid = Grid(3e-3, 1e-3, direction)
    c, s = math.cos(direction), math.sin(direction)
    corners = np.array([[c, -s], [s, c]]) @ np.array([[1.5, 1.5, -1.5, -1.5], [0.5, -0.5, 0.5, -0.5]]) * 1e-3
    assert (grid.half, grid.half_across) == pytest.approx(tuple(corners.max(axis=1)))


# ---- sections --------------------------------------------------------------------------------------------------------
def test_forces_are_collected_as_motions_are_expanded():
    rng = np.random.default_rng(2)
    motions, at, forces = rng.normal(size=(9, 3)), rng.normal(size=(3, 2)), rng.normal(size=(9, 4))
    part = Condensed(np.arange(3), np.eye(3), 9, (), motions)
    np.testing.assert_allclose(part.expand(at).T @ forces, at.T @ part.collect(forces))


def test_cracks_that_turn_back_or_meet_themselves_are_found():
    straight = np.array([[0.0, 1.0, 2.0, 3.0], [0.0, 0.1, 0.0, 0.2]])
    assert not _folds(straight)
    assert _folds(np.array([[0.0, 1.0, 0.5], [0.0, 0.0, 0.3]]))
    assert _folds(np.array([[0.0, 1.0, 1.0], [0.0, 0.0, 1.0]]))  # a right angle is too much
    turns = np.radians([0.0, 70.0, 140.0, 210.0, 280.0, 350.0])
    loop = np.cumsum(np.column_stack([[0.0, 0.0], *(np.array([[np.cos(a)], [np.sin(a)]]) for a in turns)]), axis=1)
    assert (np.einsum("ci,ci->i", np.diff(loop)[:, :-1], np.diff(loop)[:, 1:]) > 0.0).all()
    assert _folds(loop)
    assert not _folds(loop[:, :4])


def test_a_keyway_seen_from_the_other_flank_is_on_the_other_side():
    assert Keyway(0.8, 0.3, 0.1).mirrored() == Keyway(0.8, 0.3, -0.1)


def test_a_lower_tip_is_that_of_the_tooth():
    ordinary = Tooth(20, BasicRack(1.0, 1.25, 0.25))
    tooth = OtherTip(ordinary.tip_radius - 0.2).tooth(ordinary)
    assert tooth.tip_radius == ordinary.tip_radius - 0.2
    assert (tooth.teeth, tooth.form_radius) == (20, ordinary.form_radius)
    with pytest.raises(InputError, match="tip_radius"):
        OtherTip(ordinary.tip_radius + 0.01).tooth(ordinary)


def test_what_is_recalled_knows_the_outline_of_its_shorter_teeth():
    @dataclass(frozen=True)
    class Kind:
        tooth: Any

    @dataclass(frozen=True)
    class Solved:
        odd: dict
        lower: Any = None

    ordinary = Tooth(20, BasicRack(1.0, 1.25, 0.25))
    radius = ordinary.tip_radius - 0.2
    lower = Solved({0: Kind(ordinary), 2: Kind(ordinary)})
    fine = Solved({0: Kind(ordinary), 2: Kind(ordinary)}, lower)
    found = odd_solution._with_teeth(fine, {2: OtherTip(radius), 0: "crack"}, ordinary)
    for one in (found, found.lower):
        assert one.odd[0].tooth is ordinary
        assert one.odd[2].tooth.tip_radius == radius
    assert found.lower.lower is None
    assert odd_solution._with_teeth(fine, {0: "crack"}, ordinary) is fine
    assert odd_solution._with_teeth(Solved(fine.odd), {2: OtherTip(radius)}, ordinary).lower is None


def test_errors_that_are_not_estimated_are_blank():
    fine = SimpleNamespace(
        lower=None, faces_under=lambda loads, patch: ("faces", patch), closed_intensity=lambda near, faces: (
            np.array([[8.0], [2.0]]), np.array([[7.0], [2.0]])),
    )  # fmt: skip
    gear = SimpleNamespace(
        fine=fine, gear=SimpleNamespace(module=4.0), _patch=1, _by_number=lambda i, loads: (0, loads),
        _near=lambda i, j: (i, j), _on_flank=lambda j, r: np.asarray(r), _half_width=lambda b: b,
    )  # fmt: skip
    value, error = OddGearInfluence.closed_intensity(gear, 3, {})
    assert value.tolist() == [[4.0], [1.0]]
    assert np.isnan(error).all()
    assert np.isnan(OddGearInfluence.root_stress_error(gear, 0, 1, "tension", [1.0, 2.0])).tolist() == [True, True]
    fine.lower = SimpleNamespace(
        faces_under=fine.faces_under, closed_intensity=lambda near, faces: (np.array([[5.0], [2.5]]), None)
    )
    assert OddGearInfluence.closed_intensity(gear, 3, {})[1].tolist() == [[(1.0 + 3.0) / 2.0], [0.25]]


@pytest.mark.parametrize("made", [hole, keyway])
def test_a_mesh_that_is_not_sound_is_made_finer_and_what_is_refused_for_another_reason_is_refused(monkeypatch, made):
    sizes, refused = [], []

    def mesh(*given):
        if refused:
            raise refused.pop(0)
        return "mesh"

    def edges(*given):
        sizes.append(given[-1])
        return [SimpleNamespace(vertices=np.zeros((2, 3))) for _ in range(3)]

    chains = [SimpleNamespace(vertices=np.zeros((2, 3))) for _ in range(9)]
    monkeypatch.setattr(made, "mesh_inside", mesh)
    monkeypatch.setattr(made, "sector_boundary", lambda *given, **how: chains)
    settings = SimpleNamespace(order=2, side_growth=1.0)
    tooth = SimpleNamespace(teeth=20)
    if made is hole:
        monkeypatch.setattr(hole, "bore_end", lambda *given: None)
        monkeypatch.setattr(hole, "_room", lambda *given: 3.0)
        monkeypatch.setattr(hole, "_edge", edges)
        monkeypatch.setattr(hole, "section_on", lambda mesh, *given: mesh)
        run = lambda: hole.holed_sector(tooth, 4.0, settings, "hole")  # noqa: E731
    else:
        monkeypatch.setattr(keyway, "refuse_keyway", lambda *given: None)
        monkeypatch.setattr(keyway, "joined_sectors", lambda *given: chains)
        monkeypatch.setattr(keyway, "_bore", edges)
        monkeypatch.setattr(keyway, "replace", lambda one, **new: SimpleNamespace(**new))
        run = lambda: keyway.keyed_patch(tooth, 4.0, settings, Keyway(0.8, 0.3))  # noqa: E731
    assert run() == "mesh"
    refused += [InputError("mesh", "it", "has folded triangles")] * 2
    sizes.clear()
    assert run() == "mesh"
    assert sizes == pytest.approx([1.0, made._FINER, made._FINER**2])
    refused += [InputError("mesh", "it", "has folded triangles")] * 99
    with pytest.raises(FegearError, match="it still has folded triangles"):
        run()
    refused[:] = [InputError("width", "it", "is too wide")]
    with pytest.raises(InputError, match="is too wide"):
        run()


def test_heights_off_a_rack_s_flank_are_refused_with_their_number():
    flank = SimpleNamespace(heights=(-1.0, 0.8), pressure_angle=0.4, flank_start=2.0)
    found = StraightFlank.arc_of_radius(flank, [-1.0, 0.8])
    assert found == pytest.approx([2.0, 2.0 + 1.8 / math.cos(0.4)])
    np.testing.assert_allclose(StraightFlank.radius_of_arc(flank, found), [-1.0, 0.8])
    for off in (-1.1, 0.9):
        with pytest.raises(RangeError, match=rf"height = {off} modules: is outside the flank, -1 to 0.8"):
            StraightFlank.arc_of_radius(flank, [0.2, off, 0.3])


# ---- gears in 3D -----------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("numbers", [[0], [3, 8, 9], [19, 0], [1, 18, 10], [0, 5, 10, 15], [2, 12], [7, 4, 1, 18, 15]])
def test_odd_teeth_form_groups_by_their_distance_round_the_gear(numbers):
    """Of twenty: two are of one group where no tooth between them answers to one of them only."""
    teeth, most = 20, 2 * odd_solid_solution.TOUCHED + 1
    groups = odd_solid_solution._groups(numbers, teeth)
    assert sorted(number for group in groups for number in group) == sorted(numbers)
    away = {frozenset((a, b)): min((a - b) % teeth, (b - a) % teeth) for a in numbers for b in numbers if a != b}
    for group in groups:
        for before, after in pairwise(group):
            assert 0 < (after - before) % teeth <= most
        for other in groups:
            assert other is group or not any(away[frozenset((a, b))] <= most for a in group for b in other)


def test_lines_that_do_not_stand_beside_each_other_have_no_points_in_common():
    zeta = np.array([-1.0, -0.4, 0.1, 0.1, 0.3, 0.9, 0.0, 0.05, 0.6])
    flank = SimpleNamespace(_line=SimpleNamespace(zeta=zeta))
    one, apart, beside = slice(0, 3), slice(3, 6), slice(6, 9)
    assert [part.size for part in ThinLines._points(flank, one, apart)] == [0, 0]
    z, weight = ThinLines._points(flank, one, beside)
    assert weight.sum() == pytest.approx(0.1)
    assert (weight @ z**3) == pytest.approx(0.1**4 / 4.0)
    z, weight = ThinLines._points(flank, apart, beside)
    assert (weight @ z) == pytest.approx(0.5 * (0.6**2 - 0.1**2))


def test_teeth_that_are_missing_answer_as_the_ordinary_ones_do():
    window = SimpleNamespace(missing=(1,), coupling=lambda near, other: ("odd", near, other))
    flank = SimpleNamespace(
        ordinary=SimpleNamespace(compliance={k: ("ordinary", k) for k in (-1, 0, 1)}),
        _window=lambda i, j: None if i > 5 else (window, i - 3, j - 3),
    )
    assert OddSolid.coupling(flank, 3, 2) == ("odd", 0, -1)
    assert OddSolid.coupling(flank, 4, 3) == ("ordinary", 1)
    assert OddSolid.coupling(flank, 3, 4) == ("ordinary", -1)
    assert OddSolid.coupling(flank, 7, 7) == ("ordinary", 0)


def test_the_largest_stress_of_an_odd_tooth_is_looked_for_below_the_contact_on_the_tooth_that_is_loaded():
    """Places along the face times contacts, each with the end of the search of its contact."""
    contacts, places = 2, 3
    stress = np.arange(4.0 * places * contacts).reshape(4, places, contacts)

    def largest(flat, sign, end):
        assert flat.shape == (4, places * contacts)
        return sign * flat.max(axis=0) + end, 10.0 * end

    kinds = {5: {"tension": SimpleNamespace(largest=largest), "compression": SimpleNamespace(largest=largest)}}
    gear = SimpleNamespace(
        fillet_stress=lambda i, j, side, pressed, zeta: (stress + (i - j), None), kind_of=lambda i: ("flank", kinds[i]),
        root_end=lambda k, side, pressed: np.array([0.25, 0.5]) + k,
    )  # fmt: skip
    for side, sign in (("tension", 1.0), ("compression", -1.0)):
        value, arc = OddSolid.largest_root_stress(gear, 5, 6, side, "pressed", np.zeros(places))
        end = np.array([0.25, 0.5]) - 1.0
        np.testing.assert_allclose(value, sign * (stress.max(axis=0) - 1.0) + end)
        np.testing.assert_allclose(arc, np.broadcast_to(10.0 * end, (places, contacts)))


def test_displacements_and_missing_teeth_are_those_of_the_window_where_there_is_one():
    window = SimpleNamespace(missing=(1,), moved=lambda near, other, side, loads: ("odd", near, other, side, loads))
    gear = SimpleNamespace(
        ordinary=SimpleNamespace(moved=lambda k, side, loads: ("ordinary", k, side, loads)),
        width=4.0,
        _window=lambda i, j: None if max(i, j) > 5 else (window, i - 3, j - 3),
    )
    assert OddSolid.moved(gear, 4, 2, "tension", "loads") == ("odd", 1, -1, "tension", "loads")
    assert OddSolid.moved(gear, 7, 5, "tension", "loads") == ("ordinary", 2, "tension", "loads")
    assert [OddSolid.is_missing(gear, tooth) for tooth in (3, 4, 5, 6)] == [False, True, False, False]
    assert OddSolid._on_face(gear, [-2.0, 2.0]).tolist() == [-2.0, 2.0]
    for off in (-2.001, 2.001):
        with pytest.raises(RangeError, match=rf"zeta = {off} modules: is outside the face width, -2 to 2"):
            OddSolid._on_face(gear, [0.0, off])


def test_a_section_that_is_meshed_as_a_whole_is_condensed_as_a_whole(monkeypatch):
    monkeypatch.setattr(dissection, "condense_whole", lambda *given, expandable: (given, expandable))
    section = SimpleNamespace(whole="whole")
    found = dissection.condense_solid(section, "face", "known", "kept", expandable=True)
    assert found == ((section, "whole", "face", "known", "kept"), True)


def test_surfaces_that_do_not_close_are_counted():
    """A cube's twelve edges lie on two faces each, the seam of a bore on none; without a face four are free."""
    faces = {1: (1, 2, 3, 4), 2: (5, 6, 7, 8), 3: (1, 5, 9, 10), 4: (2, 6, 10, 11), 5: (3, 7, 11, 12), 6: (4, 8, 12, 9)}

    def model(left, solids=1):
        return SimpleNamespace(model=SimpleNamespace(
            getEntities=lambda of: {3: [0] * solids, 2: left, 1: list(range(13))}[of],
            getBoundary=lambda one, oriented: [(1, edge) for edge in faces[one[0]]],
        ))  # fmt: skip

    assert step_model._closed(model(list(faces)), "a.step") == (6, 13)
    with pytest.raises(FegearError, match=r"a.step: .* \(4 free edges\)"):
        step_model._closed(model([1, 2, 3, 4, 5]), "a.step")
    with pytest.raises(FegearError, match=r"\(0 free edges\)"):
        step_model._closed(model(list(faces), 2), "a.step")
