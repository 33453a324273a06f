"""What results say or take in cases that are seldom: each by a number or a sentence that follows without them."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.case.odd_tooth import ENDS
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.results import forecasts
from fegear.results.gear import crack_shown
from fegear.results.gear.crosscheck_answer import said_of_helical, said_of_single_contact, said_of_stiffness
from fegear.results.gear.crosscheck_iso import IsoPair
from fegear.results.pair import mesh_stiffness_revolution, root_stress_of_teeth
from fegear.results.planetary.compound_set import _answer
from fegear.results.relief.relief_over_face_sheet import _figure, _grind
from fegear.results.relief.tolerance_data import Sampled
from fegear.results.shafts import shaft_speeds
from fegear.results.shafts.at_glance import BearingAtGlance
from fegear.results.shafts.gearbox_changes import _advised, _changed_to
from fegear.results.sizing import estimated
from fegear.results.sizing.sizing_sheet import _failed
from fegear.results.train.torque_ripple import MeshSwing
from fegear.shafts.bearing_seat import BearingSeat
from fegear.shafts.larger_bearing import BearingChange, LargerBearing


# ---- shafts ----------------------------------------------------------------------------------------------------------
def bearing(name, d, outer, width, revolutions, count=1):
    return LargerBearing(name, d * 1e-3, outer * 1e-3, width * 1e-3, d == 25, revolutions, count)


def test_a_bearing_to_change_to_is_said_with_what_differs_from_the_present_6205():
    """6205: 25 x 52 x 15 mm; it lasts 1000 h or 60 million revolutions, one of 90 million 1500 h."""
    seat = BearingSeat(length=16e-3)
    now = BearingAtGlance("A", "s", 1.0, 0.0, 60e6, 1000.0 * 3600.0, 0.9, designation="6205", seat=seat)
    assert _changed_to(now, bearing("6305", 25, 62, 17, 90e6)) == (
        "6305 instead of 6205 (outside diameter 62 mm, width 17 mm, seat longer than 16 mm): 1500 h by its tabulated C"
    )
    assert _changed_to(now, bearing("same", 25, 52, 15, 60e6)) == "same instead of 6205: 1000 h by its tabulated C"
    assert _changed_to(now, bearing("wide", 30, 52, 16, 30e6)) == (
        "wide instead of 6205 (bore 30 mm, width 16 mm): 500 h by its tabulated C"
    )
    longest, thicker = bearing("30205", 25, 52, 15, 45e6, 2), bearing("6206", 30, 62, 16, 120e6)
    none = "no tabulated bearing that fits this seat lasts"
    near = " (longest life 750 h with two 30205 face to face)"
    thick = "; on a thicker shaft 6206 (bore 30 mm, outside diameter 62 mm, width 16 mm): 2000 h"
    for change, said in (
        (BearingChange(None, None, None), none),
        (BearingChange(None, longest, None), none + near),
        (BearingChange(None, None, thicker), none + thick),
        (BearingChange(None, longest, thicker), none + near + thick),
        (BearingChange(bearing("same", 25, 52, 15, 60e6), longest, thicker),
         "same instead of 6205: 1000 h by its tabulated C"),
    ):  # fmt: skip
        assert _advised(now, change) == said


@pytest.mark.parametrize("known", [0, 1, 2])
@pytest.mark.parametrize("sense", [1, -1])
def test_shafts_turn_as_one_pair_s_speed_says_before_it_and_behind_it(monkeypatch, known, sense):
    """Two external stages and one internal one: 100 rad/s, -50, 25 and 10 where the first shaft turns forward."""

    def mesh(k, driver, driven, side):
        gears = SimpleNamespace(driver=SimpleNamespace(teeth=driver), driven=SimpleNamespace(teeth=driven), side=side)
        of = sense * (-1 if k == 1 else 1)
        return SimpleNamespace(pair=f"p{k}", shafts=(f"s{k}", f"s{k + 1}"), found=gears, sense=of)

    meshes = (mesh(0, 20, 40, 1), mesh(1, 18, 36, 1), mesh(2, 20, 50, -1))
    spins = [100.0, 50.0, 25.0]
    monkeypatch.setattr(shaft_speeds, "mesh_places", lambda _scene: meshes)
    monkeypatch.setattr(shaft_speeds, "pair_speed", lambda _scene, pair: spins[known] * (pair == f"p{known}"))
    scene = SimpleNamespace(case=SimpleNamespace(shaft=dict.fromkeys(["s0", "s1", "s2", "s3", "alone"])))
    found = shaft_speeds.speeds_of_shafts(scene)
    assert [found[f"s{k}"] for k in range(4)] == pytest.approx([sense * one for one in (100.0, -50.0, 25.0, 10.0)])
    assert math.isnan(found["alone"])


# ---- crosscheck ------------------------------------------------------------------------------------------------------
def test_a_pair_without_finite_elements_has_the_mesh_stiffness_over_its_width():
    """20 N/(mm um) over 15 mm are 300 N/um; a ratio goes before it."""

    def said(**mean):
        one = SimpleNamespace(**{"iso": None, "fe": None, "face_width": None, "ratio_to_fe": None} | mean)
        return said_of_stiffness(SimpleNamespace(data=SimpleNamespace(pairs={}), key="I", one=one))

    (alone,) = said(iso=20e9, face_width=15e-3)
    assert "of ISO 6336-1 20 N/(mm µm), over the face width 300 N/µm" in alone
    assert said(iso=20e9) == said(face_width=15e-3) == []
    (both,) = said(iso=20e9, fe=16e9, face_width=15e-3, ratio_to_fe=1.25)
    assert "c_gamma_alpha 20 / 16 N/(mm µm)" in both
    assert both.endswith("= 1.25.")


def test_of_virtual_teeth_those_that_have_a_ratio_are_said():
    def said(*ratios, pairs=()):
        rows = [
            SimpleNamespace(role=role, ratio_to_fe=one) for role, one in zip(("driver", "driven"), ratios, strict=True)
        ]
        return said_of_helical(
            SimpleNamespace(data=SimpleNamespace(pairs=pairs), key="I", one=SimpleNamespace(rows=rows))
        )

    assert said(math.nan, math.nan) == []
    assert said(1.1, 1.2, pairs=("I",)) == []
    for ratios, wanted in (((1.1, math.nan), "FE driver 1.10"), ((1.1, 1.234), "FE driver 1.10, driven 1.23")):
        assert said(*ratios)[0].rstrip(".").endswith(wanted)


def test_formulas_at_single_contact_are_said_once_for_each_gear():
    def of_gear(role):
        ratio = [1.05, math.nan] if role == "driver" else [math.nan, math.nan]
        return SimpleNamespace(formula=np.array(["iso-6336-3", "agma-908"]), ratio_to_fe=ratio, radius=[30e-3])

    def said(rows):
        one = SimpleNamespace(single_contact=rows, check=SimpleNamespace(gears=("a", "b")))
        return said_of_single_contact(SimpleNamespace(key="I", one=one))

    assert said(None) == []
    sentences = said(SimpleNamespace(of_gear=of_gear))
    assert len(sentences) == 1  # nothing is known of gear b
    assert sentences[0].startswith("Pair I, a loaded at its outer point of single pair contact (HPSTC, diameter 60 mm)")
    assert sentences[0].endswith("1.05.")


def test_a_pair_without_helical_teeth_has_no_stiffness_of_them():
    asked, none = SimpleNamespace(helical=None), SimpleNamespace(stiffness=None)
    found = IsoPair(asked, none)
    assert (found.stiffness, found.single, found.face_width, found.under) == (None, None, None, "")
    helical = SimpleNamespace(pair=SimpleNamespace(face_width=17e-3), applied_load=2e5, load_factor=1.25)
    single = SimpleNamespace(value=SimpleNamespace(single=14e9))
    found = IsoPair(SimpleNamespace(helical=helical), SimpleNamespace(stiffness=single))
    assert (found.single, found.face_width) == (14e9, 17e-3)
    assert "200 N/mm" in found.under


# ---- sets, reliefs, trains -------------------------------------------------------------------------------------------
def test_a_set_without_a_drive_has_its_smallest_and_largest_ratio():
    def answer(*ratios):
        rows = [SimpleNamespace(ratio=one, remark=said) for one, said in ratios]
        asked = SimpleNamespace(drive=None)
        return list(
            _answer(SimpleNamespace(name="P", data=SimpleNamespace(asked=asked, data=SimpleNamespace(ratios=rows))))
        )

    (said,) = answer((-4.0, ""), (1.5, ""), (3.0, ""), (99.0, "turns freely"))
    assert "ratios from 1.5 to 4 (absolute values)" in said
    assert answer((99.0, "turns freely")) == []


@pytest.mark.parametrize(
    ("ends", "figure"), [((120.0,), "relief_candidates_I"), ((40.0, 120.0), "relief_over_torque_I")]
)
def test_reliefs_for_several_torques_are_drawn_over_them(ends, figure):
    seen = SimpleNamespace(name="I", data=SimpleNamespace(ends=ends, shapes=()))
    assert _figure(seen) == figure
    assert list(_grind(seen)) == []  # nothing was asked to be ground


def test_a_force_that_swings_below_zero_is_lost_contact():
    swing = MeshSwing("m", 20.0, -30.0, "here", 40.0)
    assert (swing.reduction, swing.share, swing.lost) == (30.0, 2.0, True)
    assert not MeshSwing("m", 30.0, -30.0, "here", 40.0).lost
    still = MeshSwing("m", 0.0, -30.0, "here", 40.0)
    assert (still.share, still.lost) == (None, False)


def test_equal_draws_are_one_class_about_their_value_and_others_fill_classes_of_one_width():
    for value in (2.0, -2.0):
        middles, shares = Sampled("te_peak_to_peak", "free", np.array([value, np.nan, value]), 1.0, None).histogram
        half = 0.5 * (middles[1] - middles[0])
        assert [middles[0] - half, middles[-1] + half] == pytest.approx([value - 1e-3, value + 1e-3])
        assert sorted(shares)[-2:] == [0.0, 1.0]
        assert abs(middles[np.argmax(shares)] - value) <= 1.001 * half
    values = np.random.default_rng(3).normal(5.0, 1.0, 400)
    middles, shares = Sampled("te_peak_to_peak", "free", values, 1.0, None).histogram
    assert shares.sum() == pytest.approx(1.0)
    assert middles @ shares == pytest.approx(values.mean(), abs=0.05)
    step = np.diff(middles)
    assert np.ptp(step) < 1e-9
    # Freedman and Diaconis: twice the range of the middle half over the cube root of the number, or a little less
    width = 2.0 * np.subtract(*np.quantile(values, [0.75, 0.25])) / 400 ** (1.0 / 3.0)
    assert 0.9 * width < step[0] <= width
    assert middles[0] - 0.5 * step[0] == pytest.approx(values.min())
    assert middles[-1] + 0.5 * step[0] == pytest.approx(values.max())


# ---- sizing ----------------------------------------------------------------------------------------------------------
def test_a_large_front_shows_its_first_by_the_criteria_and_others_evenly_along_it():
    count, first = 5 * estimated.MOST_SHOWN, 7
    place = np.random.default_rng(1).permutation(count)
    costs = np.column_stack([place, count - place]).astype(float)  # all of them on the front
    behind = costs + 2.0 * count
    rows = np.arange(10, 10 + 2 * count)
    every = np.full((10 + 2 * count, 2), np.inf)
    every[rows] = np.concatenate([costs, behind])
    shown = estimated.shown_rows(every, rows, first, compared=False)
    found = every[shown, 0]
    assert len(shown) == estimated.MOST_SHOWN
    assert (np.diff(found) > 0.0).all()
    assert found[:first].tolist() == list(range(first))
    assert found[-1] == count - 1
    steps = np.diff(found[first:])
    assert np.ptp(steps) <= 1.0
    small = estimated.shown_rows(every, rows[:5], first, compared=False)
    assert set(small) == set(rows[:5])


def test_who_has_no_transmission_error_is_said_by_number_or_as_the_present_design():
    def said(*failed):
        return [str(one) for one in _failed(SimpleNamespace(data=SimpleNamespace(failed=failed)))]

    assert said() == []
    assert said((3, "no room.")) == ["No transmission error by FE for variant 3: no room."]
    assert said((0, "no room."), (4, "other.")) == [
        "No transmission error by FE for present design (and 1 more): no room."
    ]


# ---- revolutions -----------------------------------------------------------------------------------------------------
def test_faces_of_cracks_that_may_close_are_those_of_their_teeth_in_meshing_order(monkeypatch):
    """Tooth 3 of 20 of a driving gear is the 17th to mesh, tooth 5 of a driven one the 5th; tooth 0 is open."""

    class Odd:
        def __init__(self, teeth, closing):
            middle, fine = (lambda number: number - 2), SimpleNamespace(closing={one - 2 for one in closing})
            self.influence = SimpleNamespace(gear=SimpleNamespace(teeth=teeth), from_middle=middle, fine=fine)

    monkeypatch.setattr(mesh_stiffness_revolution, "OddCompliance", Odd)
    monkeypatch.setattr(
        mesh_stiffness_revolution,
        "faces_in_mesh",
        lambda engagement, over, member, known, number: (over, member, number),
    )
    sources = {"driver": Odd(20, {17, 18}), "driven": Odd(31, {5, 17})}

    def faces(**changed):
        of = sources | changed
        loaded = SimpleNamespace(engagement=SimpleNamespace(compliance=SimpleNamespace(source=of.get)))
        asked = SimpleNamespace(cracked=(("driver", (0, 3)), ("driven", (5, 8))))
        return list(mesh_stiffness_revolution._faces(asked, loaded, "over"))

    assert faces() == [("over", "driver", 17), ("over", "driven", 5)]
    assert faces(driver=None) == [("over", "driven", 5)]


@pytest.mark.parametrize(("member", "wanted"), [("driver", [0, 4, 3, 2, 1]), ("driven", [0, 1, 2, 3, 4])])
def test_stresses_of_teeth_stand_in_meshing_order_over_their_median(member, wanted):
    """A tooth's own number times 10 MPa, and 50 for tooth 0: the median is 30."""
    largest = np.array([50.0, 10.0, 20.0, 30.0, 40.0])
    found = SimpleNamespace(teeth=5, member=member, largest=largest, largest_error=0.1 * largest)
    rows = root_stress_of_teeth.by_tooth(found, "a")
    assert rows.gear == "a"
    # row n is the n-th tooth to mesh; its number is the way round that it is
    assert np.argsort(rows.tooth).tolist() == list(range(5))
    of_tooth = [largest[one] for one in wanted]
    assert rows.root_tension.tolist() == of_tooth
    assert rows.root_tension_change == pytest.approx([one / 30.0 - 1.0 for one in of_tooth])
    assert rows.root_tension_error.tolist() == pytest.approx([0.1 * one for one in of_tooth])
    bare = SimpleNamespace(**vars(found) | {"largest_error": None})
    assert root_stress_of_teeth.by_tooth(bare, "a").root_tension_error is None


def test_the_stress_of_cracked_teeth_is_said_to_be_that_of_the_fillet_beside_the_crack():
    """Of five teeth of a driven gear number 1 is relieved by its crack; 3 is cracked on its other side."""
    largest = np.array([30.0, 3.0, 30.0, 30.5, 30.0])
    found = SimpleNamespace(teeth=5, member="driven", largest=largest, largest_error=None)
    rows = root_stress_of_teeth.by_tooth(found, "a", (1, 3))
    assert rows.relieved == (1,)
    assert rows.beside_cracks.tooth.tolist() == [1]
    assert rows.beside_cracks.root_tension.tolist() == [3.0]
    assert rows.clause.startswith("; tooth 1: fillet beside the crack")
    seen = SimpleNamespace(name="I", data=SimpleNamespace(stress=[rows]))
    (note,) = root_stress_of_teeth.beside_cracks(seen)
    assert "cracked tooth 1 of gear a" in note
    assert "(-90 %)" in note
    assert "stress-intensity" in note
    ordinary = root_stress_of_teeth.by_tooth(found, "a")
    assert (ordinary.beside_cracks, ordinary.clause) == (None, "")
    assert list(root_stress_of_teeth.beside_cracks(SimpleNamespace(data=SimpleNamespace(stress=[ordinary])))) == []
    both = root_stress_of_teeth.by_tooth(
        SimpleNamespace(**vars(found) | {"largest": largest - [0, 0, 0, 9, 0]}), "a", (1, 3)
    )
    assert "; teeth 1, 3: " in both.clause


@pytest.mark.parametrize(("listed", "said"), [((1, 31), 0), ((7, 31), 1), ((7, 5), 2), ((20, 31), 0)])
def test_fewer_rows_than_teeth_are_explained(listed, said):
    gears = {"driver": SimpleNamespace(teeth=20), "driven": SimpleNamespace(teeth=31)}
    stress = [SimpleNamespace(tooth=np.arange(n), gear=name) for n, name in zip(listed, "ab", strict=True)]
    data = SimpleNamespace(stress=stress, pair=SimpleNamespace(gear=gears.get), base_pitches=7)
    notes = list(root_stress_of_teeth.not_listed(SimpleNamespace(name="I", data=data)))
    assert len(notes) == said
    assert not said or "gear a is listed for 7 of its 20 identical teeth: the meshing repeats after 7" in notes[0]
    assert said < 2 or "gear b is listed for 5 of its 31" in notes[1]


# ---- cracks as they are shown, trains without damping ----------------------------------------------------------------
@pytest.mark.parametrize("member", ["driver", "driven"])
@pytest.mark.parametrize("load", [2000.0, 0.0])
def test_a_crack_is_shown_under_the_whole_load_at_the_outer_end_of_single_contact(monkeypatch, member, load):
    """Where the pair's own curvature radius says it is; without a load 100 N/mm in the middle of the involute."""
    one, other = (
        Gear(Tooth(z, BasicRack(1.0, 1.25, 0.25), x), 3e-3, 5e-3, face_width=20e-3) for z, x in ((20, 0.2), (41, 0.0))
    )
    pair = GearPair(one, other)
    gear = pair.gear(member)
    monkeypatch.setattr(crack_shown, "odd_teeth_of", lambda _scene, name: SimpleNamespace(name=name, member=member))
    cracks = [SimpleNamespace(crack=None), SimpleNamespace(crack=SimpleNamespace(**dict.fromkeys(ENDS), used=1))]
    setattr(cracks[1].crack, ENDS[1], 0.5e-3)
    part = SimpleNamespace(driver="driver", driven="driven", normal_load=lambda meshed: load if meshed is pair else 1.0)
    scene = SimpleNamespace(
        case=SimpleNamespace(gear={member: SimpleNamespace(odd_tooth=cracks)}, pair={"I": part}),
        gears={member: gear}, plane_pairs=["I"], pairs={"I": pair},
    )  # fmt: skip
    found = crack_shown._inputs(scene, member)
    assert (found.places, found.ends) == ((1,), (ENDS[1],))
    if not load:
        assert found.radius == pytest.approx(0.5 * sum(gear.involute_radii))
        assert (found.load, found.pair) == (1e5, "")
        return
    ends = pair.x_start + pair.base_pitch, pair.x_end - pair.base_pitch
    radii = [float(np.hypot(gear.base_radius, pair.flank_curvature_radius(np.array([x]), member)[0])) for x in ends]
    assert found.radius == pytest.approx(max(radii))  # the outer one of both ends of single contact
    assert (found.load, found.pair) == (2000.0 / 20e-3, "I")


@pytest.mark.parametrize(("shaft", "mesh", "undamped"), [
    ({"damping": 1.0}, {"damping_ratio": 0.1}, False), ({"damping_ratio": 0.1}, {"damping": 1.0}, False),
    ({"rigid": True}, {"damping": 1.0}, False), ({}, {"damping": 1.0}, True), ({"damping": 1.0}, {}, True),
    ({}, {}, True),
])  # fmt: skip
def test_a_train_without_damping_anywhere_is_known(shaft, mesh, undamped):
    def part(given):
        return SimpleNamespace(**{"rigid": False, "damping": None, "damping_ratio": None} | given)

    damped = part({"damping": 1.0})
    train = SimpleNamespace(shaft={"a": damped, "b": part(shaft)}, mesh={"m": damped, "n": part(mesh)})
    assert forecasts.has_undamped(SimpleNamespace(case=SimpleNamespace(train=train))) is undamped
    assert forecasts.has_undamped(SimpleNamespace(case=SimpleNamespace(train=None))) is False
    sizes = forecasts.sizes(SimpleNamespace(case=SimpleNamespace(train=SimpleNamespace(mesh="ab", body="abc"))))
    assert sizes == (2, 3)
