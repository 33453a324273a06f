"""Parts by what they stand for: teeth told apart, tips set up, tensions shown, reaches that close, levers, JSON."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.commands.terminal import Voice
from fegear.contact.unloaded.earliest import _choose
from fegear.contact.unloaded.reach import Bound
from fegear.contact.wide import over_revolution
from fegear.design.flanks import tip_bench
from fegear.design.tip_relief.search import _followed
from fegear.dynamics.compound.compound_modes import CompoundModel
from fegear.formulas.many.shared import ManyQualities
from fegear.studies.cost import measure
from fegear.verify import calculix


def test_teeth_in_a_base_pitch_are_told_apart_by_their_spacing_and_by_odd_flanks(monkeypatch):
    """Ten pitches on, pairs 0 and 1 are teeth 0 and 4 of a driver of five, 3 and 2 of a driven gear of seven."""
    monkeypatch.setattr(over_revolution, "like_cycle", lambda gears, lines, cycle: (gears, lines, cycle))
    teeth = {"driver": 5, "driven": 7}
    flanks = SimpleNamespace(
        gears="gears", pair=SimpleNamespace(gear=lambda member: SimpleNamespace(teeth=teeth[member]))
    )
    gaps = SimpleNamespace(
        driver_spacing=np.arange(10.0, 15.0), driven_spacing=np.empty(0), driver_odd=(), driven_odd=((3, "pitted"),)
    )
    found = over_revolution._teeth_in(flanks, gaps, "lines", np.array([0, 1]), 10)
    assert found == (("gears", "lines", 10), 10.0, 14.0, 3, -1)


def test_tips_are_tried_at_the_pair_s_positions_and_at_those_of_the_search(monkeypatch):
    asked = []
    monkeypatch.setattr(tip_bench, "edge_reach", lambda pair, gap: (pair, gap))
    monkeypatch.setattr(
        tip_bench,
        "roll_points",
        lambda pair, count, reach: asked.append((pair, count, reach)) or SimpleNamespace(x="x"),
    )
    monkeypatch.setattr(tip_bench, "FlankTrials", lambda *given: given)
    more = SimpleNamespace(lines="more lines")
    flanks = SimpleNamespace(pair="pair", most_gap=7.0, compliance=lambda load, x: asked.append((load, x)) or more)
    apart = SimpleNamespace(at=lambda pair, lines, loads: (pair, lines, loads.tolist()))
    known = SimpleNamespace(lines="few lines")
    found = tip_bench.tip_trials(flanks, known, apart, 300.0)
    assert asked == [("pair", tip_bench.SEARCHED, ("pair", 7.0)), (300.0, "x")]
    assert found.few[:3] == ("pair", known, ("pair", "few lines", [300.0]))
    assert found.more[:3] == ("pair", more, ("pair", "more lines", [300.0]))


def test_numbers_of_a_web_are_found_by_fegear_and_wanted_of_the_other_program():
    solution = SimpleNamespace(
        largest_root_stress=lambda tooth, side, load, at: (np.full((2, 1), 5.0 + load), None),
        deflection=lambda tooth, band, load: np.full((1, 1), 10.0 * band + load),
    )
    rows = list(calculix._web_tensions(solution, [0.0, 1.0], {"tension": [[5.0, 5.1], [6.0, 6.2]]}))
    assert [(one.found, one.wanted, one.scale) for one in rows] == [
        (5.0, 5.0, 5.1), (5.0, 5.1, 5.1), (6.0, 6.0, 6.2), (6.0, 6.2, 6.2)
    ]  # fmt: skip
    rows = list(calculix._web_deflections(solution, [1.0, 2.0], {"deflection": [[11.0, 22.0], [12.0, 23.0]]}, 0.1))
    assert [(one.found, one.wanted, one.scale) for one in rows] == [
        (11.0, 11.0, 11.0), (21.0, 22.0, 11.0), (12.0, 12.0, 23.0), (22.0, 23.0, 23.0)
    ]  # fmt: skip


@pytest.mark.parametrize(("length", "second"), [(0.0, Bound.GEAR_FACE_LOW), (1e-3, Bound.NONE)])
def test_where_the_reach_closes_both_its_ends_bound_the_contact(length, second):
    """A bracket closes on a jump: where the reach has no length left it ends between its own two ends."""

    def top(at):
        within = SimpleNamespace(
            lo=np.array([8e-3]), hi=np.array([8e-3 + length]), outside=np.array([0]),
            lo_bound=np.array([Bound.GEAR_FACE_LOW]), hi_bound=np.array([Bound.GEAR_TIP]),
        )  # fmt: skip
        return SimpleNamespace(within=within, z=np.array([at]), bound=np.array([Bound.GEAR_TIP]), slope=np.array([0.0]))

    flank = SimpleNamespace(gear=SimpleNamespace(face_width=0.02), s_tip=1.0, s_form=-1.0)
    candidates = [(np.array([s]), np.array([g]), top(s)) for s, g in ((0.1, 1.0), (0.2, 2.0), (0.15, 0.5))]
    found = _choose(candidates, flank, 1e-12)
    assert (found.phi_2[0], found.s[0]) == (2.0, 0.2)
    assert found.bounds[:, 0].tolist() == [Bound.GEAR_TIP, second]


def test_rotations_count_by_base_circles_by_pins_or_by_the_metre():
    of = SimpleNamespace(planets=[SimpleNamespace(carrier="c", radius=0.06)])
    gear = SimpleNamespace(name="sun", wheels=[SimpleNamespace(base_radius=0.02)])
    levers = [
        CompoundModel.lever(SimpleNamespace(of=of), one)
        for one in (gear, SimpleNamespace(name="c", wheels=[]), SimpleNamespace(name="flywheel", wheels=[]))
    ]
    assert levers == [0.02, 0.06, 1.0]


def test_what_programs_read_is_json_without_numbers_that_json_does_not_know(capsys):
    Voice(as_json=True).tell({"value": 1.5, "word": "µm"})
    assert capsys.readouterr().out == '{\n  "value": 1.5,\n  "word": "µm"\n}\n'
    with pytest.raises(ValueError, match="not JSON compliant"):
        Voice(as_json=True).tell({"value": math.nan})
    Voice().tell({"value": 1.5})
    assert capsys.readouterr().out == ""


def test_of_each_search_the_best_is_followed_though_others_lie_farther_apart(monkeypatch):
    """Two searches share the second of three candidates: the best of both, of the second search it is the best."""
    monkeypatch.setattr("fegear.design.tip_relief.search.apart", lambda p, values, limits, most: [0])
    p = np.diag([1.0, 2.0, 3.0, 4.0])[:3]
    of = np.array([[True, False], [True, True], [False, True]])
    followed, by = _followed(p, np.array([1.0, 2.0, 3.0]), of, SimpleNamespace(unit=np.ones(4)), 1)
    assert followed.tolist() == p[[0, 1]].tolist()
    assert by.tolist() == [[True, False], [True, True]]


@pytest.mark.parametrize(("family", "checked"), [("fe", True), ("compliance-formula", True), ("stress-formula", False)])
def test_a_formula_of_stress_has_no_compliance_to_be_right(monkeypatch, family, checked):
    looked = []
    monkeypatch.setattr(measure, "without_neighbours", lambda asked: "without neighbours")
    monkeypatch.setattr(measure, "answered", lambda asked, configuration: ())
    monkeypatch.setattr(measure, "_compliance_error", lambda found, asked, source: looked.append((asked, source)))
    measure._record(SimpleNamespace(asked="asked"), SimpleNamespace(family=family), "source", {})
    alone = "without neighbours" if family == "compliance-formula" else "asked"
    assert looked == ([(alone, "source")] if checked else [])


def test_qualities_without_a_favourable_contact_pattern_have_none_for_some_of_the_pairs_either():
    each = np.arange(6.0).reshape(2, 3)
    some = ManyQualities(6, each, each, each, (1.0, 1.0), (2.0, 2.0)).at(np.array([2, 0]))
    assert some.base_pitch.tolist() == [[2.0, 0.0], [5.0, 3.0]]
    assert some.helix_slope_5.size == 0
