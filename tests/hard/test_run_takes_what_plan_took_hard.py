"""A run refuses nothing that a plan took, but what only numbers can show: random pairs and trains, and drafted cases.

What a run may still refuse is a relief in units of Welbourn's Delta, a load under which a tooth would stiffen to
nothing, or a motion without damping at its resonance: sizes that are known when the teeth have been solved.
"""

import random
import re
import tomllib
from pathlib import Path

import pytest
from mutations import processor_seconds

from fegear.base.errors import FegearError, InputError
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.kinds import KINDS
from fegear.case.drafts.text import draft
from fegear.case.reading import build_scene
from fegear.case.text_file import toml_string
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

ONLY_NUMBERS = (
    "module (at most half the tooth thickness)",
    "stiffen",
    "resonance",
    "no damping",
    '. Set dynamics.method = "shooting" there.',
    "cannot be reached",
)
OF_PAIRS = (
    "geometry", "tooth-geometry-check", "load-sharing", "transmission-error", "loading-spectrum", "relief",
    "relief-chart", "relief-curves", "robustness", "rating", "flank-surface", "gear-mesh-power-loss",
    "root-stress-history", "flank-fracture", "crosscheck",
)  # fmt: skip
OF_TRAINS = (
    "gear-train", "natural-modes", "dynamic-increments", "mesh-force-spectrum", "tooth-force", "dynamic-root-stress",
    "tooth-friction",
)  # fmt: skip


def gear(dice, m, alpha):
    made = {
        "teeth": dice.choice([6, 8, 10, 12, 14, 17, 20, 24, 28, 33, 40, 57, 80, 120]), "module": f"{m} mm",
        "pressure_angle": f"{alpha} deg", "face_width": f"{m * dice.uniform(2, 20):.2f} mm",
    }  # fmt: skip
    optional = {
        "profile_shift": round(dice.uniform(-0.6, 0.9), 3),
        "rack": dice.choice([{"addendum": 0.8}, {"tip_radius": "full"}, "ISO 53 A", {"dedendum": 1.4}]),
        "bore_radius": f"{m * made['teeth'] * dice.uniform(0.05, 0.45):.2f} mm",
        "thickness_allowance": f"{m * dice.uniform(0, 60):.1f} um",
        "tip_radius_rounding": f"{m * dice.uniform(0.005, 0.1):.3f} mm",
        "tip_diameter": f"{m * (made['teeth'] + dice.uniform(1, 2.6)):.3f} mm",
        "spacing_errors": {"values": [f"{dice.randint(-9, 9)} um" for _ in range(made["teeth"])]},
        "tolerance_class": dice.randint(1, 11),
        "relief": dice.choice([
            {"tip": {"amount": f"{dice.choice([1, 5, 20, 80])} um", "length": f"{m * dice.uniform(0.1, 3):.3f} mm"}},
            {"tip": {"amount_over_delta": 1.0, "normalised_length": round(dice.uniform(0.1, 1.3), 2)}},
            {"root": {"amount": "5 um", "length": f"{0.5 * m:.3f} mm"}}, {"crowning": {"amount": "5 um"}},
        ]),
    }  # fmt: skip
    return made | {key: value for key, value in optional.items() if dice.random() < 0.25}


def pair_case(dice):
    """Two gears by formulas, with any of the results and effects, and a train now and then."""
    m = dice.choice([0.5, 1, 2, 3, 5, 10])
    alpha = dice.choice([14.5, 17.5, 20, 20, 22.5, 25])
    gears = {name: gear(dice, m, alpha) for name in ("a", "b")}
    for one in gears.values():
        one |= {"roughness": {"flank": "0.8 um", "root": "3 um"}}
        one |= {"strength": {"material": "case-hardened-steel", "case_depth": "0.6 mm", "core_hardness": "30 HRC"}}
    torque = f"{m**3 * gears['a']['teeth'] * dice.choice([0.005, 0.02, 0.05, 0.2, 1]):.4f} N*m"
    pair = {
        "driver": "a", "driven": "b", "torque": torque, "speed": f"{dice.choice([1, 100, 1500, 9000])} rpm",
        "lubricant": {"viscosity_40": "220 mm^2/s", "temperature": "70 degC"},
        "compliance": {"source": dice.choice(["weber-banaschek", "cornell", "potential-energy"])},
        "root_stress": {"source": dice.choice(["iso-6336-3", "heywood", "cornell", "agma-908", "dolan-broghamer"])},
    }  # fmt: skip
    if dice.random() < 0.2:
        middle = 0.5 * m * (gears["a"]["teeth"] + gears["b"]["teeth"])
        pair["centre_distance"] = f"{middle + m * dice.uniform(-0.1, 1.2):.3f} mm"
    has = {"relief", "spacing_errors"} & (set(gears["a"]) | set(gears["b"]))
    effects = {
        e: True for e in (*has, "contact_loss", "parametric", "friction", "corner_contact") if dice.random() < 0.4
    }
    results = [one for one in OF_PAIRS if dice.random() < 0.2]
    document = {"gear": gears, "pair": {"I": pair}, "effects": effects, "design": {}, "loading": {"pair": "I"}}
    for key, value in {
        "contact_ratio": round(dice.uniform(0.8, 2.4), 2), "slope": round(dice.uniform(0, 2.2), 2),
        "peak": dice.choice([0.5, 0.7, 1.0]), "grind": dice.choice([[], ["linear"], ["parabolic"]]),
        "centre": f"{m * dice.uniform(-2, 2):.2f} mm",
    }.items():  # fmt: skip
        if dice.random() < 0.25:
            document["design"][key] = value
    if dice.random() < 0.4:
        results += [one for one in OF_TRAINS if dice.random() < 0.35]
        document["train"] = {
            "body": {"one": {"gears": ["a"]}, "two": {"gears": ["b"]}}, "torque": {"one": torque}, "balance": "two",
            "mesh": {"I": {"driver": "one", "driven": "two", "damping_ratio": dice.choice([0.0, 0.08])}},
        }  # fmt: skip
        document["dynamics"] = {"speed": f"{dice.choice([10, 1000, 6000])} rpm", "harmonics": dice.choice([1, 8, 64])}
    return document | {"results": results or ["geometry"]}


def judge(document, seconds=30.0):
    """Empty where a run did what a plan promised, or the plan refused; else what the run said."""
    try:
        scene = build_scene(document, "case", Path())
        plan = make_plan(scene, STAGES)
    except FegearError:
        return None
    try:
        with processor_seconds(seconds):
            run_plan(scene, plan)
    except TimeoutError:
        return ""
    except FegearError as refusal:
        return "" if any(words in str(refusal) for words in ONLY_NUMBERS) else str(refusal)
    return ""


def judged(make, first, count):
    """Verdicts on so many cases that a plan takes."""
    found = []
    for seed in range(first, first + 100 * count):
        verdict = judge(make(random.Random(seed)))  # noqa: S311  (nobody guesses it)
        found += [] if verdict is None else [(seed, verdict)]
        if len(found) == count:
            break
    return found


@pytest.mark.dear
def test_a_sample_of_random_pairs_and_trains_runs_as_planned():
    found = judged(pair_case, 0, 12)
    assert len(found) == 12
    assert [one for one in found if one[1]] == []


@pytest.mark.long
@pytest.mark.parametrize("first", range(10_000, 110_000, 10_000))
def test_random_pairs_and_trains_run_as_planned(first):
    assert [one for one in judged(pair_case, first, 40) if one[1]] == []


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"pair.I.compliance.source": "potential-energy", "gear.a.bore_radius": "26 mm"}, "pair.I.compliance.source"),
        ({"results": ["relief"], "gear.a.teeth": 6, "gear.a.rack": {"addendum": 0.6}}, "pair.I"),
        ({"results": ["relief"], "design": {"contact_ratio": 0.8}}, "design.length"),
        ({"results": ["rating"], "gear.a.face_width": "3 mm"}, "gear.a.face_width"),
        ({"results": ["crosscheck"], "pair.I.load": "3 MN"}, "pair.I.load"),
        ({"gear.a.teeth": 8, "gear.a.pressure_angle": "14.5 deg", "gear.b.pressure_angle": "14.5 deg",
          "effects": {"corner_contact": True}}, "pair.I"),
    ],
    ids=["formula's range", "short teeth", "short design", "no class", "too wide a contact", "corners out of reach"],
)  # fmt: skip
def test_what_a_run_refused_is_refused_by_the_plan(change, key):
    document = tomllib.loads("""
        results = ["load-sharing"]
        effects = {}
        design = {}
        [gear.a]
        teeth = 21
        module = "3 mm"
        pressure_angle = "20 deg"
        face_width = "30 mm"
        strength = { material = "case-hardened-steel", core_hardness = "30 HRC" }
        [gear.b]
        teeth = 20
        module = "3 mm"
        pressure_angle = "20 deg"
        face_width = "30 mm"
        strength = { material = "case-hardened-steel", core_hardness = "30 HRC" }
        [pair.I]
        driver = "a"
        driven = "b"
        load = "100 N"
        speed = "1500 rpm"
        compliance = { source = "weber-banaschek" }
    """)
    for path, value in change.items():
        *above, name = path.split(".")
        table = document
        for step in above:
            table = table[step]
        table[name] = value
    with pytest.raises(InputError) as refusal:
        make_plan(build_scene(document, "case", Path()), STAGES)
    assert str(refusal.value).startswith(key)
    assert "corner_contact = true" not in str(refusal.value)


FOLLOWED = """
results = ["mode-tracking"]
[transmissibility.I]
mesh = { stiffness = "285 N/um", base_helix_angle = "30 deg", kappa = 0.4, mu = 0.2 }
[transmissibility.I.unity_ratio]
mass = "2.882 kg"
aspect_ratio = 0.3
alpha_y = 0.2
alpha_z = 0.5
alpha_theta = 0.4
[transmissibility.I.follow]
"""


@pytest.mark.parametrize(
    ("follow", "rule"),
    [
        ("alpha_y = { start = -0.4, stop = 0.1 }", "follow.alpha_y = -0.4: must not be negative"),
        ("aspect_ratio = { start = 0.0, stop = 1.0 }", "follow.aspect_ratio = 0.0: must be greater than zero"),
        ("alpha_z = { start = 0.1, stop = 1.0, responses = [-1.0] }", "follow.alpha_z = -1.0: must not be negative"),
        ("mu = { start = 0.1, stop = 0.3 }", "follow.mu = 0.1: must be finite and at least kappa^2"),
        ("kappa = { start = -0.5, stop = 0.3 }", "follow.kappa = -0.5: contradicts mesh.mu = 0.2, which must be"),
        ('base_helix_angle = { start = "0 deg", stop = "95 deg" }', "base_helix_angle = 95 deg: must be between"),
    ],
)  # fmt: skip
def test_ranges_in_which_no_model_can_be_built_are_refused_by_the_plan(follow, rule):
    scene = build_scene(tomllib.loads(FOLLOWED + follow), "case", Path())
    with pytest.raises(InputError, match=re.escape(rule)):
        make_plan(scene, STAGES)


WIDE = """
results = ["load-distribution"]
[gear.p]
teeth = 20
module = "3 mm"
face_width = "12 mm"
[gear.w]
teeth = 29
module = "3 mm"
face_width = "12 mm"
[pair.I]
driver = "p"
driven = "w"
load = "2 kN"
width = "slices"
[load_distribution]
positions = 8
[accuracy]
tolerance = 0.1
"""


@pytest.mark.dear
def test_data_that_no_effect_of_a_pair_with_a_width_uses_may_be_wrong():
    """Such data ended the run after its teeth had been solved, for the size of what is neglected."""
    document = tomllib.loads(WIDE)
    document["gear"]["p"] |= {"bias": {"amount": "5 um", "start_radius": "3 mm"}}
    scene = build_scene(document, "case", Path())
    remarks = " ".join(run_plan(scene, make_plan(scene, STAGES)).remarks)
    unsized = "relief is off; its influence cannot be estimated from the data specified"
    assert f"{unsized}: gear.p.bias = radius 3 mm" in remarks
    on = build_scene(document | {"effects": {"relief": True}}, "case", Path())
    with pytest.raises(InputError, match=r"gear\.p\.bias = radius 3 mm: lies inside the base circle"):
        make_plan(on, STAGES)
    document["gear"]["p"]["relief"] = {"tip": {"amount": "9 mm", "length": "1 mm"}}
    on = build_scene(document | {"effects": {"relief": True}}, "case", Path())
    with pytest.raises(InputError, match=r"gear\.p\.relief = 9000 um"):
        make_plan(on, STAGES)


def test_a_value_that_a_study_names_twice_is_one():
    """The tiles of gears that are the same could not be laid: numpy's words, after all had been solved."""
    lists = {"teeth": [17, 20, 17], "profile_shift": [0.0, 0.0], "load_position": [1.0, 0.1, 1.0]}
    document = {"results": ["root-stress-study"], "gear": {"a": {"teeth": 28, "module": "3 mm"}}, "study": lists}
    study = build_scene(document, "case", Path()).case.study
    assert (study.teeth, study.profile_shift, study.load_position) == ([17, 20], [0.0], [1.0, 0.1])


#: Answers that somebody might type; the plan refuses what makes no gears.
TYPED = {
    "teeth": ("8", "12", "17", "21", "53", "80"), "module": ("0.5 mm", "3 mm", "10 mm", "8 / inch"),
    "pressure_angle": ("14.5 deg", "20 deg", "25 deg"), "profile_shift": ("-0.3", "0", "0.25", "0.6"),
    "rack": ("A", "C", "D"), "helix_angle": ("8 deg", "25 deg"), "face_width": ("4 mm", "30 mm"),
    "torque": ("1 N m", "200 N m"), "speed": ("10 rpm", "3000 rpm"), "tip_relief": ("20 um",), "lead_error": ("10 um",),
}  # fmt: skip


def drafted(dice, kinds=tuple(KINDS)):
    """A case that `fegear new` writes, at the roughest tolerance; None where it refuses the answers."""
    kind = dice.choice(kinds)
    count = len(KINDS[kind].gears)
    given = {}
    for name in ("teeth", "module", *KINDS[kind].asks):
        if name in TYPED and dice.random() < 0.5:
            many = count if name == "teeth" else 1
            given[name] = " ".join(dice.choice(TYPED[name]) for _ in range(many))
    if "tip_relief" in given:
        given["relief_length"] = "2 mm"
    try:
        document = tomllib.loads(draft(Answers(kind, given), "case"))
    except FegearError:
        return {}
    return document | {"accuracy": {"tolerance": 1e-2}}


@pytest.mark.dear
def test_a_sample_of_what_new_writes_runs():
    found = judged(lambda dice: drafted(dice, ("gear", "pair", "relief", "ring")), 0, 6)
    assert len(found) == 6
    assert [one for one in found if one[1]] == []


@pytest.mark.long
@pytest.mark.parametrize("first", range(1000, 9000, 1000))
def test_what_new_writes_runs(first):
    assert [one for one in judged(drafted, first, 10) if one[1]] == []


def test_a_text_with_any_character_is_written_as_toml_that_reads_back():
    for text in ("a\x7fb", "\u0080", 'a"b\\', "\n\t\r\x00\x1f", "Räd 齿轮", "\u2028"):
        assert tomllib.loads(f"{toml_string(text)} = {toml_string(text)}") == {text: text}
