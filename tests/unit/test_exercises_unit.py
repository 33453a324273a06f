"""Answers of exercises: what a student computes by hand, from numbers of teeth, module, shifts and torque."""

import math
import re
from pathlib import Path

import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES
from fegear.results.exercises.pair import exercises_of_pair
from fegear.results.exercises.planetary_set import exercises_of_set
from fegear.results.exercises.rack import exercises_of_rack
from fegear.window.assemblies import assemblies_of
from fegear.window.drag_handles import hands_of

ALPHA = math.radians(20.0)


def pair_scene(driver, driven, **keys):
    helical = "helix_angle" in driver
    gear = {"normal_module" if helical else "module": "3 mm", "face_width": "30 mm"}
    gears = {"p": gear | driver, "w": gear | driven}
    pair = {"driver": "p", "driven": "w", "torque": "100 N*m", "speed": "900 rpm"}
    return build_scene({"title": "t", "results": ["geometry"], "gear": gears, "pair": {"I": pair | keys}}, "t", Path())


def answers(found):
    return {one.question: one.answer.replace("−", "-") for one in found}


def answer(found, word):
    (one,) = (said for question, said in answers(found).items() if word in question)
    return one


def numbers(text):
    return [float(one) for one in re.findall(r"-?\d+(?:\.\d+)?", text)]


def involute(angle):
    return math.tan(angle) - angle


def working_angle(value):
    low, high = 0.0, 1.2
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if involute(middle) < value else (low, middle)
    return low


def test_a_pair_with_profile_shifts_as_by_hand():
    found = exercises_of_pair(pair_scene({"teeth": 18, "profile_shift": 0.4}, {"teeth": 35, "profile_shift": 0.1}), "I")
    angle = working_angle(involute(ALPHA) + 2.0 * 0.5 * math.tan(ALPHA) / 53)
    a = 79.5 * math.cos(ALPHA) / math.cos(angle)
    assert f"= 79.5 mm; inv α_w = inv α + 2 (x₁ + x₂) tan α / (z₁ + z₂): α_w = {math.degrees(angle):.4g}°" in (
        answer(found, "centre distance"))  # fmt: skip
    assert f"a_w = a cos α / cos α_w = {a:.3f} mm without backlash." in answer(found, "centre distance")
    assert f"= 35/18 = {35 / 18:.4g}; n₂ = {900 * 18 / 35:.4g} rpm; T₂ = i T₁ = {100 * 35 / 18:.4g} N m" in (
        answer(found, "transmission ratio"))  # fmt: skip
    assert f"= {3 * math.pi * math.cos(ALPHA):.4g} mm:" in answer(found, "base pitch")

    bases = [0.5 * 3 * z * math.cos(ALPHA) for z in (18, 35)]
    tips = [0.5 * 3 * (z + 2.0 * (1.0 + x)) for z, x in ((18, 0.4), (35, 0.1))]
    roots = [math.sqrt(tip**2 - base**2) for tip, base in zip(tips, bases, strict=True)]
    ratio = (sum(roots) - a * math.sin(angle)) / (3 * math.pi * math.cos(ALPHA))
    assert answer(found, "contact ratio").endswith(f"= {ratio:.3f}.")

    curvatures = [base * math.tan(angle) for base in bases]
    ends = [roots[1] - curvatures[1], roots[0] - curvatures[0]]  # A and E from C
    at_a = 1.0 - 18 / 35 * (curvatures[1] + ends[0]) / (curvatures[0] - ends[0])
    at_e = 1.0 - 35 / 18 * (curvatures[0] + ends[1]) / (curvatures[1] - ends[1])
    sliding = answer(found, "specific sliding")
    assert f"driver {at_a:.3g} at A" in sliding
    assert f"and {at_e:.3g} at E" in sliding
    fastest = 900 * math.pi / 30 * (1 + 18 / 35) * max(ends) * 1e-3
    assert f"{fastest:.3g} m/s" in sliding

    tip_angle = math.acos(bases[0] / tips[0])
    thick = 2 * tips[0] * ((math.pi / 2 + 0.8 * math.tan(ALPHA)) / 18 + involute(ALPHA) - involute(tip_angle))
    assert f"driver {thick:.4g} mm = {thick / 3:.3g} m" in answer(found, "tip circle")

    tangential = 100e3 / (bases[0] / math.cos(angle))
    forces = answer(found, "forces")
    assert f"F_t = 2 T₁ / d_w1 = {tangential:.4g} N; F_r = F_t tan α_w = {tangential * math.tan(angle):.4g} N" in forces
    assert f"2 T₁ / d₁ = {100e3 / 27:.4g} N" in forces
    load, modulus = 100e3 / bases[0], 206.8e3 / (2.0 * (1.0 - 0.3**2))
    pressure = math.sqrt(load / 30 * modulus / math.pi * sum(1.0 / one for one in curvatures))
    assert f"= {pressure:.4g} MPa with one tooth pair" in answer(found, "Hertzian")


def test_undercut_has_the_rule_of_textbooks_beside_that_of_the_rack():
    found = answer(exercises_of_pair(pair_scene({"teeth": 11}, {"teeth": 35}), "I"), "undercut")
    sine = math.sin(ALPHA)
    assert f"Textbooks take h = 1: {1 - 11 * sine**2 / 2:.3f} (driver)" in found
    assert found.startswith("The driver gear is undercut: ")
    assert f"down to h = {1.25 - 0.25 * (1 - sine):.3f} modules" in found


def test_a_shortened_path_and_thinner_teeth_are_said_beside_the_formula():
    shaved = {"teeth": 11, "thickness_allowance": "90 um"}
    found = exercises_of_pair(pair_scene(shaved, {"teeth": 35}), "I")
    assert "because the path of contact begins at the root form circle of the driver gear, which is undercut." in (
        answer(found, "contact ratio")
    )
    assert "(fegear: " in answer(found, "tip circle")
    assert f"thinner teeth give {0.09 * math.cos(ALPHA):.4g} mm" in answer(found, "centre distance")


@pytest.mark.parametrize("wider", [0.0, 0.2])
def test_a_centre_distance_of_the_case_stands_beside_that_without_backlash(wider):
    keys = {"centre_distance": f"{79.5 + wider} mm"}
    found = answer(exercises_of_pair(pair_scene({"teeth": 18}, {"teeth": 35}, **keys), "I"), "centre distance")
    assert ("the case has 79.7 mm" in found) == (wider > 0.0)
    assert "x₁ + x₂ = 0" in found


def test_a_helical_pair_has_an_axial_force_and_no_pressure_of_a_spur_pair():
    gears = ({"teeth": z, "helix_angle": "18 deg", "hand": hand} for z, hand in ((18, "left"), (35, "right")))
    found = exercises_of_pair(pair_scene(*gears), "I")
    beta = math.radians(18.0)
    a = 3 * 53 / (2 * math.cos(beta))
    assert f"a = m_n (z₁ + z₂) / cos β / 2 = {a:.3f} mm" in answer(found, "centre distance")
    tangential = 100e3 / (0.5 * 3 * 18 / math.cos(beta))
    assert f"F_a = F_t tan β_w = {tangential * math.tan(beta):.4g} N" in answer(found, "forces")
    assert not [one for one in answers(found) if "Hertzian" in one]
    assert "overlap ratio " in answer(found, "contact ratio")


def test_helical_answers_have_the_quantities_of_their_sections():
    """Standard formulas in the transverse section, from normal module, angles and shifts."""
    gears = [{"teeth": z, "profile_shift": x, "helix_angle": "22 deg", "hand": hand}
             for z, x, hand in ((13, 0.0, "left"), (41, 0.3, "right"))]  # fmt: skip
    found = exercises_of_pair(pair_scene(*gears), "I")
    beta = math.radians(22.0)
    alpha_t = math.atan(math.tan(ALPHA) / math.cos(beta))
    m_t = 3.0 / math.cos(beta)
    angle = working_angle(involute(alpha_t) + 2.0 * 0.3 * math.tan(ALPHA) / 54)
    a = 27.0 * m_t * math.cos(alpha_t) / math.cos(angle)
    centre = answer(found, "centre distance")
    assert "inv α_wt = inv α_t + 2 (x₁ + x₂) tan α_n / (z₁ + z₂)" in centre
    assert f"a_w = a cos α_t / cos α_wt = {a:.3f} mm" in centre

    least = -13 * math.sin(alpha_t) ** 2 / (2.0 * math.cos(beta))
    undercut = answer(found, "undercut")
    assert "x_min = h - z sin²α_t / (2 cos β)" in undercut
    assert f"h = 1: {1.0 + least:.3f} (driver)" in undercut
    enough = float(re.search(r"profile_shift = (-?[\d.]+)", undercut)[1])
    assert enough == pytest.approx(1.25 - 0.25 * (1.0 - math.sin(ALPHA)) + least, abs=1.1e-4)

    tip = 0.5 * 13 * m_t + 3.0
    tip_angle = math.acos(0.5 * 13 * m_t * math.cos(alpha_t) / tip)
    arc = 2.0 * tip * (math.pi / 26 + involute(alpha_t) - involute(tip_angle))
    thick = arc * math.cos(math.atan(tip * math.tan(beta) / (0.5 * 13 * m_t)))
    assert answer(found, "tip circle").startswith(
        f"s_a = d_a ((π/2 + 2 x tan α_n) / z + inv α_t - inv α_at) cos β_a: driver {thick:.4g} mm"
    )


def test_a_ring_gear_has_the_contact_ratio_of_its_tip_circles():
    ring = {"teeth": 71, "internal": True, "tip_diameter": "208.2 mm",
            "cutter": {"teeth": 20, "addendum": 1.25, "tip_radius": 0.2}}  # fmt: skip
    found = exercises_of_pair(pair_scene({"teeth": 20, "profile_shift": 0.1}, ring), "I")
    angle = working_angle(involute(ALPHA) + 2.0 * 0.1 * math.tan(ALPHA) / (20 - 71))
    a = 76.5 * math.cos(ALPHA) / math.cos(angle)
    roots = [math.sqrt(tip**2 - (1.5 * z * math.cos(ALPHA)) ** 2) for tip, z in ((33.3, 20), (104.1, 71))]
    ratio = (roots[0] - roots[1] + a * math.sin(angle)) / (3 * math.pi * math.cos(ALPHA))
    assert f"= {ratio:.3f}" in answer(found, "contact ratio")
    assert "√(r_a1² - r_b1²) + a sin α_w - √(r_a2² - r_b2²)" in answer(found, "contact ratio")
    assert "tan α / (z₁ - z₂)" in answer(found, "centre distance")
    assert f"cos α_w = {a:.3f} mm" in answer(found, "centre distance")


def test_a_ring_gear_turns_the_same_way():
    ring = {"teeth": 71, "internal": True, "cutter": {"teeth": 20, "addendum": 1.25, "tip_radius": 0.2}}
    found = exercises_of_pair(pair_scene({"teeth": 20}, ring), "I")
    assert "the same sense of rotation" in answer(found, "transmission ratio")
    assert "a = m |z₁ - z₂| / 2 = 76.5 mm" in answer(found, "centre distance")
    assert "(ω₁ - ω₂) g" in answer(found, "specific sliding")


def set_scene(**keys):
    gear = {"module": "2 mm", "face_width": "20 mm"}
    part = {"sun": "s", "planet": "p", "ring_teeth": 74, "planets": 3, "fixed": "ring", "input": "sun",
            "torque": "140 N*m", "speed": "1500 rpm"} | keys  # fmt: skip
    document = {"title": "t", "results": ["planet-set"], "planetary": {"P": part},
                "gear": {"s": gear | {"teeth": 22}, "p": gear | {"teeth": 26}}}  # fmt: skip
    return build_scene(document, "t", Path())


def test_a_planetary_set_as_by_hand():
    found = exercises_of_set(set_scene(), "P")
    assert f"= 1 + z_r/z_s = {1 + 74 / 22:.4g}, 1500 rpm at the sun, {1500 / (1 + 74 / 22):.4g} rpm" in (
        answer(found, "Willis"))  # fmt: skip
    torques = numbers(answer(found, "torques").split("losses:")[1])
    assert torques == pytest.approx([140.0, 140 * 74 / 22, -140 * (1 + 74 / 22)], rel=1e-3)
    assert "(z_s + z_r) / N = 96/3 = 32" in answer(found, "assembled")
    assert f"{2 * 48 * math.sin(math.pi / 3) - 56:.4g} mm apart" in answer(found, "assembled")
    force = 140e3 / (3 * 22)
    assert f"= {force:.4g} N in each" in answer(found, "one planet")
    assert f"= {force / math.cos(ALPHA):.4g} N along" in answer(found, "one planet")


@pytest.mark.parametrize(
    ("fixed", "driving", "ratio"),
    [("ring", "carrier", 22 / 96), ("carrier", "sun", -74 / 22), ("sun", "ring", 96 / 74), ("sun", "carrier", 74 / 96)],
)
def test_formulas_of_all_fixed_members(fixed, driving, ratio):
    found = answer(exercises_of_set(set_scene(fixed=fixed, input=driving, mesh_efficiency=0.97), "P"), "Willis")
    assert f"= {ratio:.4g}, " in found
    assert "(efficiency 0.9" in answer(
        exercises_of_set(set_scene(fixed=fixed, input=driving, mesh_efficiency=0.97), "P"), "torques")  # fmt: skip


def test_the_page_hears_them_with_the_gears():
    scene = set_scene()
    assert [one["topic"] for one in assemblies_of(scene)["sets"]["P"]["exercises"]] == ["Planetary gear set"] * 4
    pair = pair_scene({"teeth": 18}, {"teeth": 35})
    assert {one["topic"] for one in hands_of(pair)["I"]["exercises"]} == {"Geometry", "Forces and stresses"}


def test_the_answer_of_a_set_has_what_the_exercise_asks():
    scene = set_scene(mesh_efficiency=0.98)
    results = run_plan(scene, make_plan(scene, STAGES), cache=SolutionCache())
    (said,) = results.outcomes[Task("planet-set", "P")].answer.sentences
    ratio = 1 + 74 / 22
    assert said.startswith(
        f"Set P, ring fixed: ratio sun to carrier {ratio:.4g}, efficiency 0.985; torques sun 140 N m, "
    )
    ring, carrier = numbers(said.split("torques")[1])[1:]
    assert 140 + ring + carrier == pytest.approx(0.0, abs=1.0)
    assert carrier == pytest.approx(-140 * ratio * (22 + 0.98 * 74) / (22 + 74), abs=1.0)


# ---- helical teeth, racks --------------------------------------------------------------------------------------------


def helical_pair(**keys):
    teeth = {"helix_angle": "20 deg", "face_width": "28 mm"}
    return pair_scene({"teeth": 18, "hand": "right", **teeth}, {"teeth": 35, "hand": "left", **teeth}, **keys)


def test_helical_teeth_as_by_hand():
    found = exercises_of_pair(helical_pair(), "I")
    beta = math.radians(20.0)
    module, angle = 3.0 / math.cos(beta), math.atan(math.tan(ALPHA) / math.cos(beta))
    said = answer(found, "transverse section")
    assert f"= {module:.4g} mm (as in fegear)" in said
    assert f"α_t = {math.degrees(angle):.4g}° (as in fegear)" in said
    assert f"driver {18 * module:.4g} mm, driven {35 * module:.4g} mm" in said
    said = answer(found, "overlap ratio, and")
    assert f"= {28.0 * math.sin(beta) / (3.0 * math.pi):.3f} (as in fegear)" in said
    assert "mesh cycle: as here" in said
    said = answer(found, "virtual spur gear")
    base = math.asin(math.sin(beta) * math.cos(ALPHA))
    for z in (18, 35):
        exact = z / (math.cos(base) ** 2 * math.cos(beta))
        assert f"= {z / math.cos(beta) ** 3:.4g} (fegear: {exact:.4g})" in said
    said = answer(found, "axial force")
    tangential = 100e3 / (9.0 * module)
    assert f"{tangential:.4g} N · tan 20° = {tangential * math.tan(beta):.4g} N with" in said
    assert f"= {tangential * math.tan(beta):.4g} N (as in fegear)" in said
    assert f"= {tangential * math.tan(beta) * 9e-3 * module:.4g} N m" in said


def test_an_overlap_ratio_between_integers_has_the_next_face_width_and_no_load_has_no_axial_force():
    teeth = {"helix_angle": "20 deg", "face_width": "35 mm"}
    scene = pair_scene({"teeth": 18, "hand": "right", **teeth}, {"teeth": 35, "hand": "left", **teeth}, torque=None)
    found = exercises_of_pair(scene, "I")
    assert f"the next with b = {2 * math.pi * 3.0 / math.sin(math.radians(20.0)):.4g} mm" in (
        answer(found, "overlap ratio, and"))  # fmt: skip
    assert not any("axial force on" in question for question in answers(found))


def test_spur_pairs_have_no_question_on_helical_teeth():
    spur = exercises_of_pair(pair_scene({"teeth": 18}, {"teeth": 35}), "I")
    assert not any(one.topic == "Helical teeth" for one in spur)


def rack_scene(helix=None, **keys):
    teeth = {"module": "2 mm"} if helix is None else {"normal_module": "2 mm", "helix_angle": helix, "hand": "right"}
    gear = {"teeth": 20, "profile_shift": 0.3, "bore_radius": "10 mm", "face_width": "20 mm", **teeth}
    rack = {"pinion": "p", "teeth": 12, "reference_height": "10 mm", "backlash": "40 um", "force": "2 kN", **keys}
    document = {"title": "t", "results": ["rack-geometry"], "gear": {"p": gear}, "rack": {"axis": rack}}
    return build_scene(document, "t", Path())


@pytest.mark.parametrize("helix", [None, "15 deg"])
def test_a_rack_as_by_hand(helix):
    beta = math.radians(15.0) if helix else 0.0
    angle, module = math.atan(math.tan(ALPHA) / math.cos(beta)), 2.0 / math.cos(beta)
    radius = 10.0 * module
    found = exercises_of_rack(rack_scene(helix), "axis")
    pitch = math.pi * module
    assert f"= {pitch:.4g} mm per tooth (as the pitch" in answer(found, "travel")
    assert f"= {20 * pitch:.4g} mm per revolution" in answer(found, "travel")
    said = answer(found, "distance")
    assert f"{radius + 0.6:.3f}".rstrip("0") in said
    assert "= 40.0 µm." in said
    tip, base = radius + 2.6, radius * math.cos(angle)
    clear = 0.02 / math.tan(angle)  # 40 µm of backlash
    ratio = (math.sqrt(tip**2 - base**2) - radius * math.sin(angle) + (2.0 - 0.6 - clear) / math.sin(angle)) / (
        pitch * math.cos(angle)
    )
    assert f"= {ratio:.3f} (as in fegear)" in answer(found, "contact ratio")
    shift = 1.0 - 10.0 * math.sin(angle) ** 2 / math.cos(beta)
    undercut = answer(found, "undercut")
    assert (
        f"h = 1: x_min = h - z sin²α{'_t' if helix else ''} / {'(2 cos β)' if helix else '2'} = {shift:.3f}" in undercut
    )
    assert "the pinion has x = 0.300 (fegear: it is not undercut" in undercut
    forces = answer(found, "torque does")
    assert f"= {2.0 * radius:.4g} N m" in forces
    assert f"= {2000.0 * math.tan(angle):.4g} N lifts" in forces
    assert ("along the axis" in forces) == bool(helix)
    if helix:
        assert f"= {2000.0 * math.tan(beta):.4g} N along the axis" in forces


def test_a_rack_without_force_or_mesh():
    assert not any("torque does" in one.question for one in exercises_of_rack(rack_scene(force=None), "axis"))
    assert exercises_of_rack(rack_scene(backlash=None, distance="15 mm"), "axis") == []


def test_an_undercut_pinion_is_said_and_the_page_hears_the_racks():
    scene = rack_scene(backlash="0 um")
    assert {one["topic"] for one in assemblies_of(scene)["racks"]["axis"]["exercises"]} == {"Rack and pinion"}
    scene.document["gear"]["p"] |= {"teeth": 14, "profile_shift": 0.0, "bore_radius": "5 mm"}
    scene = build_scene(scene.document, "t", Path())
    found = exercises_of_rack(scene, "axis")
    assert ", since the pinion is undercut)" in answer(found, "contact ratio")
    said = answer(found, "undercut")
    assert "(fegear: it is undercut; the flank of its tool is straight down to h = " in said
    enough = float(re.search(r"profile_shift = (-?[\d.]+) and more", said)[1])
    for shift, cut in ((enough, False), (enough - 2e-4, True)):
        scene.document["gear"]["p"]["profile_shift"] = shift
        assert build_scene(scene.document, "t", Path()).gears["p"].tooth.undercut == cut
