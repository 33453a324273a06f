"""Words that gear engineers type: each leads to the key that it means, or is told not to be possible."""

import tomllib
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.case import trade_words
from fegear.case.known_keys import keys_at
from fegear.case.model import Case
from fegear.case.nearest import nearest, other_number
from fegear.case.reading import build_scene, set_key
from fegear.case.refusal import meant
from fegear.case.train import BodyPart
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES

CASE = """
results = ["geometry"]
[gear.a]
teeth = 24
module = "3 mm"
rack = { addendum = 1.0 }
material = { density = "7850 kg/m^3" }
strength = { quality = "MQ" }
relief = { tip = { amount = "1 um", length = "1 mm" } }
[pair.I]
driver = "a"
driven = "a"
operation = { life = "1 h" }
"""


def said(path, value="1"):
    with pytest.raises(InputError) as refusal:
        set_key(tomllib.loads(CASE), path, value)
    return refusal.value.remedy


#: What is typed, and the key that is named first or what is told.
TYPED = {
    "study.pairs": '"samples" (number of random pairs or gears)',
    # strangers' words, which spelling led astray
    "gear.a.bohrungsdurchmesser": '"bore_diameter"',
    "gear.a.backlash": "use pair.NAME.normal_backlash (made by thickness_allowance of the gears",
    "gear.a.circular_tooth_thickness": '"tooth_thickness"',
    "gear.a.span_measurement": '"span" (with span_teeth)',
    "gear.a.measurement_over_pins": '"over_pins" (with ball_diameter)',
    "gear.a.dimension_over_balls": '"over_balls" (with ball_diameter)',
    "gear.a.crack": '"odd_tooth" ([[gear.NAME.odd_tooth]], one table for each tooth)',
    "gear.a.missing_tooth": "[[gear.NAME.odd_tooth]], with missing = true",
    "gear.a.spalling": "[[gear.NAME.odd_tooth]], with pits",
    "gear.a.tooth_pitch": '"circular_pitch"',
    "gear.a.base_pitch": '"module" (the base pitch over pi cos(alpha))',
    # English
    "gear.a.number_of_teeth": '"teeth"',
    "gear.a.outside_diameter": '"tip_diameter"',
    "gear.a.pitch_diameter": '"module" (the reference diameter over the number of teeth)',
    "gear.a.root_diameter": "use gear.NAME.cutter.root_diameter",
    "gear.a.addendum_modification": '"profile_shift"',
    "gear.a.crowning": '"lead"',
    "gear.a.profile_crowning": '"relief"',
    "gear.a.tip_relief": '"relief"',
    "gear.a.fillet_radius": "use gear.NAME.rack.tip_radius (in modules)",
    "gear.a.hob": '"rack"',
    "gear.a.youngs_modulus": "use gear.NAME.material.young_modulus",
    "gear.a.hardness": "use gear.NAME.strength.hardness",
    "gear.a.quality": '"tolerance_class"',
    "gear.a.runout": "gear.NAME.spacing_errors",
    "gear.a.wear": "wear is not computed; specify worn flanks as measured flanks (gear.NAME.measured)",
    "gear.a.temperature": "use gear.NAME.material.temperature (of the material, with modulus_over_temperature",
    "gear.a.herringbone": "use pair.NAME.double_helical (the gears are the half at end I",
    "gear.a.asymmetric": '"coast_pressure_angle" (pressure_angle is that of the drive flank',
    "gear.a.contact_ratio": "calculated from the gears, see geometry",
    "gear.a.torque": "use pair.NAME.torque",
    "gear.a.speed": "use pair.NAME.speed",
    "gear.a.material.youngs_modulus": '"young_modulus"',
    "gear.a.material.poisson": '"poisson_ratio"',
    "gear.a.rack.fillet_radius": '"tip_radius" (in modules)',
    "pair.I.center_distance": '"centre_distance"',
    "pair.I.pinion": '"driver"',
    "pair.I.wheel": '"driven"',
    "pair.I.kW": '"power" (with speed)',
    "pair.I.transmitted_power": '"power" (with speed)',
    "pair.I.tangential_force": '"load" (along the line of action',
    "pair.I.rpm": '"speed"',
    "pair.I.ratio": "use gear.NAME.teeth",
    "pair.I.backlash": '"normal_backlash"',
    "pair.I.Drehflankenspiel": '"circumferential_backlash"',
    "pair.I.Profilverschiebungssumme": '"shift_distribution" (with centre_distance)',
    "pair.I.mesh_stiffness": "use train.mesh.NAME.stiffness",
    "pair.I.crossed_axes": "only cylindrical gears on parallel axes are supported",
    "pair.I.rack": "use gear.NAME.rack",
    "pair.I.face_width": "use gear.NAME.face_width",
    "pair.I.lead_error": '"line_error"',
    "pair.I.oil": '"lubricant"',
    "pair.I.operation.service_factor": '"application_factor"',
    "pair.I.operation.lifetime": '"life"',
    # KISSsoft, ISO, DIN: symbols and German
    "gear.a.z": '"teeth"',
    "gear.a.mn": '"normal_module"',
    "gear.a.alpha_n": '"pressure_angle"',
    "gear.a.b": '"face_width"',
    "gear.a.Zähnezahl": '"teeth"',
    "gear.a.Profilverschiebung": '"profile_shift"',
    "gear.a.Schrägungswinkel": '"helix_angle"',
    "gear.a.Zahnbreite": '"face_width"',
    "gear.a.Kopfkreis": '"tip_diameter"',
    "gear.a.Bohrung": '"bore_diameter"',
    "gear.a.Zahnweite": '"span" (with span_teeth)',
    "gear.a.Zahndickenabmaß": '"thickness_allowance"',
    "gear.a.MdK": '"over_balls"',
    "gear.a.mt": '"transverse_module"',
    "gear.a.alpha_t": '"transverse_pressure_angle"',
    "gear.a.Flankenspiel": "use pair.NAME.normal_backlash",
    "gear.a.Kopfrücknahme": '"relief"',
    "gear.a.Zahnstange": "a rack has a table of its own, with its pinion: [rack.NAME]",
    "gear.a.Kegelrad": "only cylindrical gears on parallel axes are supported",
    "gear.a.rack.rhofP": '"tip_radius" (in modules)',
    "gear.a.rack.haP": '"addendum" (in modules)',
    "gear.a.strength.sigmaHlim": '"contact"',
    "gear.a.relief.tip.Ca": '"amount"',
    # columns of the grinding table
    "gear.a.relief.tip.start_diameter": '"start_radius" (half the diameter)',
    "gear.a.relief.tip.end_diameter": '"at_radius" (half the diameter)',
    "gear.a.relief.tip.length_on_path": '"length"',
    "design.limits.start_diameter": '"driver_start_diameter" (or driven_start_diameter)',
    "pair.I.Achsabstand": '"centre_distance"',
    "pair.I.Drehmoment": '"torque"',
    "pair.I.Drehzahl": '"speed"',
    "pair.I.operation.KA": '"application_factor"',
    "pair.I.operation.KHb": '"face_load_factor"',
    # AGMA
    "gear.a.Pnd": '"normal_diametral_pitch"',
    "gear.a.psi": '"helix_angle"',
    "gear.a.strength.sac": '"contact"',
    "gear.a.strength.sat": '"bending"',
    "pair.I.Wt": '"load"',
    "pair.I.C": '"centre_distance"',
    "pair.I.operation.Ko": '"application_factor"',
    "pair.I.operation.Km": '"face_load_factor"',
    # misspelt
    "gear.a.face_with": '"face_width"',
    "gear.a.teth": '"teeth"',
    "gear.a.profil_shift": '"profile_shift"',
}


@pytest.mark.parametrize("path", TYPED)
def test_a_word_of_the_trade_leads_to_what_it_means(path):
    remedy = said(path)
    assert remedy.removeprefix("did you mean ").startswith(TYPED[path]) or (
        TYPED[path] in remedy.partition("; known here")[0] and '"' not in TYPED[path]
    )


RESULTS = {
    "crack": "stress-intensity", "crack_growth": "crack-path", "Rissfortschritt": "crack-path",
    "contact-ratio": "geometry", "mesh_stiffness": "transmission-error", "te": "transmission-error",
    "bending-stress": "root-stress", "safety": "rating", "AGMA": "rating", "scuffing": "flank-surface",
    "Wirkungsgrad": "gear-mesh-power-loss", "Tragbild": "load-distribution", "eigenfrequencies": "natural-modes",
    "vibration": "dynamic-factor", "bearing-life": "shaft-deflection", "undercut": "tooth-geometry-check",
    "mass": "geometry", "tip-relief": "relief",
}  # fmt: skip


@pytest.mark.parametrize("word", [*RESULTS, "wear", "noise"])
def test_of_a_result(word, tmp_path):
    document = {"results": [word], "gear": {"a": {"teeth": 24, "module": "3 mm"}}}
    with pytest.raises(InputError) as refusal:
        make_plan(build_scene(document, "case", tmp_path), STAGES)
    wanted = f'did you mean "{RESULTS[word]}"' if word in RESULTS else "not "
    assert wanted in refusal.value.remedy


@cache
def rows(name):
    return getattr(trade_words, name)


def test_every_word_stands_once_and_every_key_that_is_named_exists():
    results = {result for entry in STAGES.entries for result in entry.results}
    for table in ("_OF_KEYS", "_OF_RESULTS"):
        words = Counter(word for words, _, _ in rows(table) for word in set(map(trade_words.plain, words.split())))
        assert [word for word, count in words.items() if count > 1] == []
        assert len(words) > 100
    for words, keys, how in rows("_OF_KEYS"):
        assert keys or how
        for key in keys:
            *above, name = key.split(".")
            known = keys_at(above) if above else list(Case.model_fields)
            assert not known or name in known, (words, key)
    for words, keys, how in rows("_OF_RESULTS"):
        assert set(keys) <= results, words
        assert keys or how


def test_no_word_hides_a_key_of_its_own_table():
    """A word may be a key elsewhere (`quality` of a strength), never where it is meant."""
    for words, keys, _ in rows("_OF_KEYS"):
        for key in keys:
            *above, name = key.split(".")
            if above:
                assert not set(words.split()) & (set(keys_at(above)) - {name}), words


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"gear": {"a": {"teeth": 30, "normal_module": "1 mm", "helix_angle": "30 deg", "hand": "double"}}},
         "set pair.NAME.double_helical; the gears are the half at end I, with its hand and face width"),
        ({"gear": {"a": {"teeth": 1001, "module": "1 mm"}}}, "a rack has a table of its own"),
        ({"planetary": {"P": {"sun": "a", "planet": ["a", "b"], "torque": "1 N m"}}},
         "stepped planets are groups with two gears in compound.NAME.planet"),
    ],
    ids=["herringbone", "rack", "stepped planet"],
)  # fmt: skip
def test_what_is_not_possible_is_said_of_values_too(change, told, tmp_path):
    with pytest.raises(InputError) as refusal:
        build_scene({"results": ["geometry"], **change}, "case", tmp_path)
    assert told in str(refusal.value)


@pytest.mark.parametrize(
    ("typed", "remedy"),
    [
        ("bore_diamter", 'did you mean "bore_diameter"'),
        ("pitch_diamter", 'did you mean "module"'),
        ("tip_diamter", 'did you mean "tip_diameter"'),  # a misspelt key stays one
    ],
)
def test_a_misspelt_word_of_the_trade_is_one(typed, remedy):
    known = ("ball_diameter", "bore_radius", "bore_diameter", "tip_diameter", "module", "teeth")
    assert nearest(typed, known, words=meant).startswith(remedy)


@pytest.mark.parametrize(
    ("table", "typed", "key"),
    [
        (["gear", "a"], "tooth", "teeth"),
        (["gear", "a"], "odd_teeth", "odd_tooth"),
        (["effects"], "odd_tooth", "odd_teeth"),
        (["stiffness"], "radius", "radii"),
        (["train", "body", "b"], "gear", "gears"),
        (["train"], "bodies", "body"),
        (["dynamics"], "Frequency", "frequencies"),
        (["gear", "a", "odd_tooth", "0"], "cracks", "crack"),
    ],
)
def test_a_key_in_the_other_number_is_named_first(table, typed, key):
    known = keys_at(table)
    assert nearest(typed, known, words=meant).startswith(f'did you mean "{key}"')


def test_names_in_one_number_only_have_none_and_tables_of_the_case_stay_tables():
    assert other_number("bias", ["bias", "gear"]) == ""
    assert other_number("class", ["clas", "glass"]) == ""
    assert other_number("radius", ["radiu"]) == ""
    assert nearest("gears", keys_at([]), words=meant).startswith("use gear.NAME (a table for each")


def test_a_body_of_gears_may_have_nothing_besides_and_one_of_nothing_may_not():
    body = BodyPart.model_validate({"inertia": "0 kg*m^2", "gears": ["a"]})
    assert body.inertia == 0.0
    case = {
        "results": ["geometry"], "gear": {"a": {"teeth": 24, "module": "3 mm"}},
        "train": {"body": {"m": {"inertia": "0 kg*m^2"}}},
    }  # fmt: skip
    with pytest.raises(InputError, match=r'must be greater than zero; replace it by gears = \["a"\]') as refused:
        build_scene(case, "case", Path())
    assert refused.value.key == "train.body.m.inertia"


def test_a_percentage_is_answered_with_the_share():
    pit = {"diameter": ["71 mm", "72 mm"], "face_share": "20 %"}
    case = {"results": ["geometry"], "gear": {"a": {"teeth": 24, "module": "3 mm", "odd_tooth": [{"pits": [pit]}]}}}
    with pytest.raises(InputError, match=r"must be a number; write it as a share, 0\.2\."):
        build_scene(case, "case", Path())
    pit["face_share"] = "a fifth"
    with pytest.raises(InputError, match=r"must be a number\.$"):
        build_scene(case, "case", Path())
