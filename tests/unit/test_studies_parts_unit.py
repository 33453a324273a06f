"""Parts of the studies by themselves: what an effect changes, one setting at a time, references and what they miss."""

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.fourier import FourierSeries
from fegear.engine.named import Named
from fegear.engine.table import Column, Table
from fegear.studies import effects
from fegear.studies.cost import knobs, measure, study
from fegear.studies.cost.answers import Quantity
from fegear.studies.cost.ladder import ALONE, FlankConfiguration
from fegear.studies.cost.quantities import miss
from fegear.studies.cost.result import Seconds
from fegear.studies.effects import Measured, Switched


# ---- effects ---------------------------------------------------------------------------------------------------------
def curve(name, x, y, head="te", **more):
    start = {"te": "x", "dynamic_factor": "speed", "load": "x"}[head]
    return Table(name, (Column(start, np.array(x), "mm"), Column(head, np.array(y) * 1e-6, "um"), *more.values()))


def run(*tables, seconds=1.0):
    return Measured(SimpleNamespace(values=Named(()), tables=tables), seconds, {})


def switched(without, with_it, effect="hertz"):
    return Switched(effect, True, without, with_it)


def test_data_of_an_effect_go_with_it_when_it_is_switched_off():
    document = {
        "effects": {"hertz": "none"},
        "pair": {"I": {"load": 1, "misalignment": {"x": 1}}, "II": {"load": 2}},
        "train": {"balance": "b", "mesh": {"I": {"backlash": 1, "damping_ratio": 2}, "II": {"damping_ratio": 3}}},
    }
    off = effects.switch(document, "misalignment", on=False)
    assert off["pair"] == {"I": {"load": 1}, "II": {"load": 2}}
    assert off["train"] == document["train"]
    assert off["effects"]["hertz"] == "none"
    off = effects.switch(document, "contact_loss", on=False)
    assert off["train"] == {"balance": "b", "mesh": {"I": {"damping_ratio": 2}, "II": {"damping_ratio": 3}}}
    assert off["pair"] == document["pair"]
    for effect in ("misalignment", "contact_loss"):
        on = effects.switch(document, effect, on=True)
        assert {key: on[key] for key in ("pair", "train")} == {key: document[key] for key in ("pair", "train")}
        assert on["effects"][effect] == effects.EFFECTS[effect].on
    assert effects.switch({}, "relief", on=True) == {"effects": {"relief": effects.EFFECTS["relief"].on}}
    assert document["pair"]["I"]["misalignment"] == {"x": 1}  # the document stays as it is


def test_the_change_of_a_curve_is_taken_where_both_reach_and_over_its_largest_value():
    one = curve("transmission_error_I", [0.0, 1.0, 2.0, 3.0], [1.0, -4.0, 2.0, 50.0])
    other = curve("transmission_error_I", [0.0, 2.0], [1.0, 5.0])
    # At 0, 1 and 2: 1, 3 and 5 for 1, -4 and 2; at 3 the other has none. Over 50.
    assert effects._change(one, other, "x", "te") == pytest.approx(7.0 / 50.0)
    beyond = curve("transmission_error_I", [7.0, 8.0], [1.0, 5.0])
    assert effects._change(one, beyond, "x", "te") == 0.0
    nothing = curve("transmission_error_I", [0.0, 1.0], [0.0, 0.0])
    assert effects._change(nothing, other, "x", "te") == pytest.approx(3.0)  # um: over nothing it is the change itself
    ends = curve("transmission_error_I", [-1.0, 0.0, 2.0], [9.0, 1.5, 5.0])
    assert effects._change(ends, other, "x", "te") == pytest.approx(0.5 / 9.0)


def test_the_clearest_curve_is_of_the_first_kind_that_changes_and_changes_most():
    a = curve("transmission_error_I", [0.0, 1.0], [1.0, 2.0])
    a_off = curve("transmission_error_I", [0.0, 1.0], [1.0, 2.2])
    b, b_off = (curve("transmission_error_II", [0.0, 1.0], [1.0, y]) for y in (2.0, 2.5))
    d, d_same = (curve("dynamic_factor_I", [0.0, 1.0], [1.0, 2.0 + e], "dynamic_factor") for e in (0.0, 1e-9))
    load, load_off = (curve("load_sharing_I", [0.0, 1.0], [1.0, y], "load") for y in (2.0, 9.0))
    found = effects.clearest_curve(switched(run(load, a, b, d), run(b_off, load_off, d_same, a_off)))
    assert found == (b, b_off, "x", "te")
    found = effects.clearest_curve(switched(run(a, load), run(a, load_off)))
    assert found == (load, load_off, "x", "load")
    assert effects.clearest_curve(switched(run(a), run(a))) is None
    assert effects.clearest_curve(switched(run(a), run(b))) is None
    # One curve for each of several loads is none.
    many = [
        curve("transmission_error_I", [0.0, 1.0], [1.0, y], more=Column("total_load", np.ones(2), "N"))
        for y in (2.0, 3.0)
    ]
    assert effects.clearest_curve(switched(run(many[0]), run(many[1]))) is None


def test_the_figure_of_an_effect_shows_both_curves_the_change_and_the_seconds():
    before = curve("transmission_error_I", [0.0, 1.0, 2.0, 3.0], [1.0, 4.0, 2.0, 8.0])
    after = curve("transmission_error_I", [1.0, 3.0], [5.0, 7.0])
    found = switched(run(before, seconds=1.5), run(after, seconds=0.25))
    figure = effects.effect_figure(found, (before, after, "x", "te"), "A pair")
    assert figure.name == "effect_hertz"
    assert figure.title == "Effect of load-dependent contact width"
    curves, change, seconds = figure.panels
    assert [one.name for one in curves.items] == ["without", "with"]
    np.testing.assert_allclose(curves.items[0].y, [1.0, 4.0, 2.0, 8.0])
    np.testing.assert_allclose(curves.items[1].x, [1e3, 3e3])
    # With it less without, at the places of the first where the second reaches.
    np.testing.assert_allclose(change.items[0].y, [1.0, 4.0, -1.0])
    assert [list(bar.y) for bar in seconds.items] == [[1.5], [0.25]]
    assert seconds.x.categories == ("without: 1.5 s", "with: 0.25 s")
    none = effects.effect_figure(replace(found, effect="contact_loss"), None, "A pair")
    assert len(none.panels) == 1
    assert none.panels[0].title == "Contact loss\nA pair (no curve of this case changes)"


def test_a_table_in_markdown():
    assert effects._table(("a", "b"), [("1", "2"), ("3", "4")]) == "| a | b |\n|---|---|\n| 1 | 2 |\n| 3 | 4 |"


# ---- one setting at a time -------------------------------------------------------------------------------------------
def test_amplitudes_of_evenly_spaced_values_are_those_of_their_waves():
    t = np.arange(24) / 24.0
    values = 5.0 + 3.0 * np.cos(2.0 * np.pi * t) + 0.7 * np.sin(2.0 * np.pi * 4 * t)
    found = knobs._spectrum(values)
    assert found.size == 11
    np.testing.assert_allclose(found, [3.0, 0.0, 0.0, 0.7, *[0.0] * 7], atol=1e-12)


def test_an_error_of_amplitudes_is_over_the_largest_of_the_first_that_both_have():
    exact = FourierSeries(np.array([9.0, 2.0, 0.5, 0.25, 0.1, 0.1, 0.1, 0.1, 0.1, 0.4]), 1.0)
    amplitude = exact.amplitude
    off = amplitude.copy()
    off[1] += 0.3
    off[8] += 100.0  # the ninth is not looked at
    assert knobs._amplitudes(off, exact) == pytest.approx(0.3 / amplitude.max())
    assert knobs._amplitudes(off[:1], exact) == 0.0
    assert knobs._amplitudes(off[:2], exact) == pytest.approx(0.3 / amplitude.max())


def test_a_partial_sum_errs_by_what_it_leaves_out():
    """Of cos + 0.3 cos 3 the first harmonic alone spans 2 for 2.6."""
    x = np.linspace(0.0, 1.0, 33)
    series = FourierSeries(np.array([0.0, 0.5, 0.0, 0.15]), 1.0)
    whole = np.ptp(series.evaluate(np.linspace(0.0, 1.0, 4001)))
    best = SimpleNamespace(series=series, points=SimpleNamespace(x=x), peak_to_peak=whole)
    one = np.ptp(FourierSeries(np.array([0.0, 0.5]), 1.0).evaluate(np.linspace(0.0, 1.0, 4001)))
    assert knobs._partial(best, 1) == pytest.approx(1.0 - one / whole, rel=1e-6)
    assert knobs._partial(best, 3) == pytest.approx(0.0, abs=1e-12)


def test_even_positions_stand_in_the_middle_of_their_steps():
    asked = []

    def solve(grid, loads):
        assert loads == [70.0]
        return SimpleNamespace(transmission_error=grid[:, None] * 2.0, local_stiffness=grid[:, None] * 3.0)

    engagement = SimpleNamespace(
        pair=SimpleNamespace(x_start=-1.0, base_pitch=4.0), grid=lambda x: (asked.append(x), x)[1], solve=solve
    )
    te, stiffness = knobs._even(engagement, 70.0, 4)
    np.testing.assert_allclose(asked[0], [-0.5, 0.5, 1.5, 2.5])
    np.testing.assert_allclose(te, 2.0 * asked[0])
    np.testing.assert_allclose(stiffness, 3.0 * asked[0])


def test_a_number_of_things_goes_to_zero_by_its_inverse():
    found = knobs._counted("te", "harmonics", "at", (2, 4, 8, 16), lambda n: 3.0 / n**2, 1e-9)
    np.testing.assert_allclose(found.step, [0.5, 0.25, 0.125, 0.0625])
    np.testing.assert_allclose(found.settings, [2, 4, 8, 16])
    np.testing.assert_allclose(found.error, [0.75, 0.1875, 0.046875, 0.01171875])
    assert found.order.value == pytest.approx(2.0) if hasattr(found.order, "value") else found.order
    assert found.floor == 1e-9
    assert np.isnan(found.seconds).all()


def configuration(settings, family="ring"):
    return SimpleNamespace(settings=settings, family=family)


def test_edges_are_compared_under_the_narrowest_pressure_that_all_meshes_of_an_order_have():
    def of(order, *patches, family="ring"):
        return tuple(
            configuration(SimpleNamespace(order=order, patch_half_width=a, of=(order, patches)), family)
            for a in patches
        )

    meshes = [of(2, 0.2, 0.1), of(2, 0.4, 0.2, 0.3), of(3, 0.3), of(4, 0.1), of(4, 0.2), of(2, 0.1, family="sector"),
              (configuration(None),)]  # fmt: skip
    found = list(knobs._edge_groups(SimpleNamespace(meshes=meshes)))
    assert [[(one.settings.order, one.settings.patch_half_width) for one in group] for group in found] == [
        [(2, 0.2), (2, 0.2)],
        [(3, 0.3)],
    ]


# ---- pairs over their face -------------------------------------------------------------------------------------------
def flank(name):
    return SimpleNamespace(body=name)


QUANTITIES = tuple(Quantity(name, "I", "um", "x") for name in ("te-mean", "face-load-factor"))


@pytest.fixture
def wide(monkeypatch):
    """Bodies are names, answers made of them and of panels."""
    calls = []

    def solve(asked, one):
        calls.append(("solve", one.body))
        return one.body

    def load(asked, one, bodies):
        calls.append(("load", one.body, bodies))
        size = {"fine": 1.0, "coarse": 1.1}[bodies] * {"fine": 1.0, "coarse": 0.8}[one.body]
        return SimpleNamespace(
            mean_transmission_error=np.array([10.0 * size]), transmission_error=np.array([[1.0], [3.0 * size]]),
            face_load_factor=np.array([1.0 + size]),
        )  # fmt: skip

    monkeypatch.setattr(measure, "_solve_wide", solve)
    monkeypatch.setattr(measure, "_load", load)
    return calls


def test_the_reference_over_the_face_is_doubted_by_bodies_by_panels_and_by_both(wide):
    found = measure.Found(SimpleNamespace(quantities=QUANTITIES))
    measure.refer_flanks(found, SimpleNamespace(reference=flank("fine"), check=flank("coarse")))
    assert [one for one in wide if one[0] == "solve"] == [("solve", "fine"), ("solve", "coarse")]
    assert [one[1:] for one in wide if one[0] == "load"] == [
        ("fine", "fine"), ("coarse", "fine"), ("fine", "coarse"), ("coarse", "coarse"),
    ]  # fmt: skip
    assert {name: float(value[0]) for name, value in found.reference.items()} == {
        "te-mean": 10.0,
        "face-load-factor": 2.0,
    }
    # 0.8, 1.1 and 0.88: panels alone change most.
    assert found.floors["te-mean"] == pytest.approx(0.2)
    assert found.floors["face-load-factor"] == pytest.approx(0.1)


def test_configurations_over_the_face_are_compared_with_the_reference_and_charged_for_their_bodies(wide, monkeypatch):
    found = measure.Found(SimpleNamespace(quantities=QUANTITIES))
    found.reference = {"te-mean": np.array([10.0]), "face-load-factor": np.array([2.0])}
    counts = iter(range(100))
    asked = []

    def timed(work, repeat=True):
        asked.append(repeat)
        return work(), Seconds(float(next(counts)), 0.5)

    monkeypatch.setattr(measure, "timed", timed)
    group = flank("coarse"), flank("fine")
    measure.measure_flanks(found, group)
    assert asked == [False, True, True]
    assert wide == [("solve", "coarse"), ("load", "coarse", "coarse"), ("load", "fine", "coarse")]
    rows = [(one.configuration, one.quantity, one.value, one.solve.cpu, one.own.cpu) for one in found.rows]
    both = [(one, name) for one in group for name in ("te-mean", "face-load-factor")]
    assert [one[:2] for one in rows] == both
    assert [one[2] for one in rows] == pytest.approx([8.8, 1.88, 11.0, 2.1])
    assert [one[3:] for one in rows] == [(0.0, 1.0)] * 2 + [(0.0, 2.0)] * 2
    assert [one.miss.largest for one in found.rows] == pytest.approx([0.12, 0.06, 0.1, 0.05])


def test_only_pairs_over_their_face_are_loaded_over_it():
    with pytest.raises(TypeError, match="is not a 3D pair"):
        measure._flank(SimpleNamespace(label="a plane one"))


def test_the_largest_value_is_the_one_of_largest_size():
    assert measure.largest(np.array([1.0, -3.0, 2.0, math.nan])) == -3.0
    assert math.isnan(measure.largest(np.array([math.nan])))


def test_what_is_missed_is_relative_to_each_reference_but_for_c_1():
    values, reference = np.array([1.1, 3.0, math.nan, 0.5]), np.array([1.0, -2.0, 7.0, 0.5])
    found = miss("c_0", values, reference)
    assert found.largest == pytest.approx(2.5)
    assert found.rms == pytest.approx(math.sqrt((0.1**2 + 2.5**2) / 3.0))
    assert found.answered == 0.75
    assert miss("c_1", values, reference).largest == pytest.approx(5.0 / 7.0)


@dataclass(frozen=True)
class MeshOfFace:
    """Into what a face is divided."""

    source: str
    panels: int


@dataclass(frozen=True)
class WideCase:
    """What of a pair's spec a study changes."""

    face: MeshOfFace
    misalignment: bool
    wide: object = None
    neighbour_coupling: bool | None = None
    loads: tuple = (1.0, 2.0, 3.0)
    nominal: float = 70.0
    gaps: object = None

    def on(self, gaps):
        return replace(self, gaps=gaps)


@pytest.mark.parametrize("misaligned", [False, True])
@pytest.mark.parametrize(("carried", "coupled"), [(False, True), (True, False)])
def test_a_pair_is_loaded_as_its_case_has_it_but_for_panels_and_neighbours(misaligned, carried, coupled, monkeypatch):
    """At its nominal load; on shafts with the gaps of even loads, where the case moves its flanks with them."""
    case = WideCase(MeshOfFace("both", 9), misaligned)
    asked, loaded = SimpleNamespace(scene="scene", pair="I"), []
    monkeypatch.setattr(measure, "pair_spec", lambda *given, over_face: given == ("scene", "I") and over_face and case)
    monkeypatch.setattr(measure, "on_shafts", lambda *given: given == ("scene", "I") and carried)
    monkeypatch.setattr(measure, "gearbox_of", lambda scene: f"gearbox of {scene}")
    monkeypatch.setattr(measure, "gaps_of_even_loads", lambda *given: given)

    def load(spec, bodies, cache):
        loaded.append((spec, bodies, cache.__class__.__name__))
        return "first", "second", "flanks"

    monkeypatch.setattr(measure, "load_flanks", load)
    configuration = FlankConfiguration("solid" if coupled else "solid" + ALONE, panels=24)
    assert measure._load(asked, configuration, "bodies") == "flanks"
    ((spec, bodies, cache),) = loaded
    assert (bodies, cache) == ("bodies", "SolutionCache")
    assert spec.wide == MeshOfFace("both", 24)
    assert (spec.neighbour_coupling, spec.loads) == (coupled, (70.0,))
    assert spec.gaps == (("gearbox of scene", "I") if misaligned and carried else None)


def test_bodies_of_a_pair_are_made_of_its_gears_in_modules_and_slices_know_no_web(monkeypatch):
    tooth = SimpleNamespace(label="teeth")
    gear = SimpleNamespace(
        module=0.004, tooth=tooth, twist=5.0, face_width=0.03, bore_radius=0.01, body_in_modules="body",
        support_in_modules="support", material=SimpleNamespace(poisson_ratio=0.29),
    )  # fmt: skip
    scene = SimpleNamespace(case=SimpleNamespace(pair={"I": SimpleNamespace(driver="a", driven="b")}))
    monkeypatch.setattr(
        measure, "solid_gear_to_solve",
        lambda scene, name: SimpleNamespace(gear=gear, reach={"a": 2, "b": 3}[name]),
    )  # fmt: skip
    for body in ("thin-slices", "coupled-slices", "solid"):
        asked = []
        monkeypatch.setitem(
            measure._SOLVERS, body, lambda *given, asked=asked, **more: (asked.append((given, more)), len(asked))[1]
        )
        assert measure.solve_bodies(scene, "I", body, "settings") == {"driver": 1, "driven": 2}
        more = {"body": "body", "support": "support"} if body == "solid" else {}
        for (given, keys), reach in zip(asked, (2, 3), strict=True):
            assert given == (tooth, pytest.approx(0.02), pytest.approx(7.5), 0.29, pytest.approx(2.5), "settings")
            assert keys == {"reach": reach, **more}


# ---- what a cost study does, in order --------------------------------------------------------------------------------
def rung(label, formula=""):
    return SimpleNamespace(label=label, formula=formula)


@pytest.mark.parametrize(("pair", "width"), [("", None), ("I", None), ("I", 3)])
def test_a_study_of_plane_gears_goes_from_the_reference_to_formulas_meshes_tolerances_and_knobs(
    pair, width, monkeypatch
):
    done = []
    for name in ("measure_alone", "measure_meshes"):
        monkeypatch.setattr(study, name, lambda found, one, name=name: done.append((name, one)))
    monkeypatch.setattr(study, "refer", lambda found, ladder: "source")
    monkeypatch.setattr(study, "_warm_up", lambda asked, ladder: done.append(("warm", None)))
    monkeypatch.setattr(study, "ladder_knobs", lambda found, ladder, source: [("edges", source)])
    monkeypatch.setattr(study, "pair_knobs", lambda asked, source: [("pair", source)])
    monkeypatch.setattr(study, "solid_knobs", lambda asked, quick: [("solid", quick)])
    scene = SimpleNamespace(case=SimpleNamespace(stiffness=SimpleNamespace(face_positions=width)))
    asked = SimpleNamespace(pair=pair, scene=scene, gear="a", tabled=False)
    found = SimpleNamespace(asked=asked, knobs=[])
    one, two = rung("coarse"), rung("finer")
    ladder = SimpleNamespace(
        reference=rung("best"), others=[rung("tolerance"), rung("cornell", "cornell")], meshes=[(one, two), (two,)]
    )
    steps = study._steps(found, ladder, quick=True)
    titles = ["Warm-up", "Reference: best", "cornell", "coarse and 1 more", "finer", "tolerance",
              "Settings of the finite elements"]  # fmt: skip
    titles += ["Settings of load sharing and dynamics"] if pair else []
    titles += ["Settings of 3D gears"] if width else []
    assert [title for title, _ in steps] == titles
    for _, work in steps:
        work()
    assert done == [("warm", None), ("measure_alone", ladder.others[1]), ("measure_meshes", (one, two)),
                    ("measure_meshes", (two,)), ("measure_alone", ladder.others[0])]  # fmt: skip
    knobs_found = [("edges", "source")] + ([("pair", "source")] if pair else []) + ([("solid", True)] if width else [])
    assert found.knobs == knobs_found
    assert study._of_pair(SimpleNamespace(tabled=True), {"reference": "source"}).__class__.__name__ == "CaseTable"


def test_a_study_over_the_face_refers_once_and_measures_group_by_group(monkeypatch):
    done = []
    monkeypatch.setattr(study, "refer_flanks", lambda found, ladder: done.append("refer"))
    monkeypatch.setattr(study, "measure_flanks", lambda found, group: done.append(group))
    one, two, three = rung("slices"), rung("solid"), rung("solid alone")
    steps = study._flank_steps("found", SimpleNamespace(reference=rung("best"), meshes=[(one,), (one, two, three)]))
    assert [title for title, _ in steps] == ["Reference: best", "slices", "slices and 2 more"]
    for _, work in steps:
        work()
    assert done == ["refer", (one,), (one, two, three)]


@pytest.mark.parametrize(
    ("family", "source"),
    [("table", "CaseTable"), ("stress-formula", "StressFormula"), ("compliance-formula", "ComplianceFormula")],
)
def test_a_configuration_on_its_own_is_what_its_family_says(family, source, monkeypatch):
    recorded = []
    monkeypatch.setattr(measure, "_record", lambda found, one, known, seconds: recorded.append((known, one, seconds)))
    monkeypatch.setattr(measure, "_tolerance", lambda found, one: recorded.append(one))
    one = SimpleNamespace(family=family, formula="iso6336" if family == "stress-formula" else "cornell")
    measure.measure_alone("found", one)
    ((known, given, seconds),) = recorded
    assert (type(known).__name__, given, seconds) == (source, one, {})
    if family != "table":
        assert one.formula in vars(known).values()
    tolerance = SimpleNamespace(family="tolerance")
    measure.measure_alone("found", tolerance)
    assert recorded[1] is tolerance
