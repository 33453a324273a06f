"""What a sweep shows of its points: which values move, maps, curves, lines through all points, and sentences."""

import math

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.engine.processes import Failure
from fegear.engine.value import Value
from fegear.studies import swept as shown
from fegear.studies.sweep import Axis, Point, SweepResults, read_axis, sweep_case
from fegear.studies.swept import Swept, is_geometric, sweep_figures, swept_values, varying


def results_of(axes, points=()):
    return SweepResults("two", "", tuple(axes), tuple(points), 0.0, 0, (0, 0, 0.0))


def value(name, numbers, unit="um", error=None):
    return Swept(name, unit, "", np.asarray(numbers, dtype=float), error)


@pytest.mark.parametrize(
    ("text", "geometric"),
    [
        ("k=1:1000:4:log", True), ("k=1:2:3", False), ("k=1,2,4", True), ("k=2,2.0000002,2.0000004", False),
        ("k=1.0,2.0,4.001", False), ("k=1,2", False), ("k=-1,-2,-4", False), ("k=a,b,c", False), ("k=0,1,2", False),
    ],
)  # fmt: skip
def test_an_axis_is_logarithmic_where_its_values_grow_by_a_factor(text, geometric):
    assert is_geometric(read_axis(text)) is geometric


def test_values_that_stay_need_no_picture():
    assert [one.name for one in varying([
        value("same", [1.0, 1.0 + 1e-13, math.nan]), value("moves", [1.0, 1.0 + 1e-11]), value("one", [1.0, math.nan]),
        value("zero", [0.0, 1e-13]), value("small", [0.0, 3e-12]),
    ])] == ["moves", "small"]  # fmt: skip


def test_values_are_gathered_by_name_with_the_clauses_that_all_points_share():
    def point(te, error, meaning, more=()):
        return Point((Value("I.te", te * 1e-6, "um", error, meaning), *more), (), ())

    points = [
        point(3.0, None, "largest, at x = 1 mm, of all"), Failure("InputError", "no"),
        point(5.0, 0.25e-6, "largest, at x = 2 mm, of all", (Value("n", 2.0),)),
    ]  # fmt: skip
    te, n = swept_values(results_of([read_axis("k=1,2,3")], points))
    np.testing.assert_allclose(te.number, [3.0, math.nan, 5.0])
    np.testing.assert_allclose(te.error, [math.nan, math.nan, 0.25])
    assert te.meaning == "largest, of all"
    assert (te.head, te.error_head, n.head, n.error_head) == ("I.te [um]", "I.te_error [um]", "n", "n_error")
    assert n.error is None
    np.testing.assert_allclose(n.number, [math.nan, math.nan, 2.0])
    assert list(shown.failures(results_of([], points))) == ["", "InputError: no", ""]


def test_a_map_has_its_first_axis_across_and_gaps_where_points_failed():
    axes = [read_axis("gear.a.teeth=20,25"), read_axis("gear.b.shift=0:0.4:3")]
    numbers = [0.0, 1.0, 2.0, 10.0, 11.0, math.nan]
    points = [*[Point((), (), ())] * 5, Failure("InputError", "no")]
    tiles, curves, lines = sweep_figures(results_of(axes, points), [value("te", numbers)])
    (view,) = tiles.views
    (panel,) = view.panels
    (item,) = panel.items
    np.testing.assert_array_equal(item.x, [20.0, 25.0])
    np.testing.assert_array_equal(item.y, [0.0, 0.2, 0.4])
    np.testing.assert_array_equal(item.z, [[0.0, 10.0], [1.0, 11.0], [2.0, math.nan]])
    assert (panel.x.label, panel.y.label, view.key) == ("gear.a.teeth", "gear.b.shift", "sweep_te")
    # Curves run along the longest axis, one for each value of the other.
    (panel,) = curves.views[0].panels
    assert panel.x.label == "gear.b.shift"
    assert [one.name for one in panel.items] == ["teeth = 20", "teeth = 25"]
    np.testing.assert_array_equal(panel.items[1].y, [10.0, 11.0, math.nan])
    assert curves.views[0].key == ""  # the map has its picture
    # A line for each point from its place to its values, low at the bottom.
    (panel,) = lines.views[0].panels
    names = [one.name for one in panel.items]
    assert names[0] == "0 to 1.83 um"
    assert names[-1] == "9.17 to 11 um"
    assert panel.x.categories == (
        "teeth\n20 to 25", "shift\n0 to 0.4", "te\n0 to 11",
    )  # fmt: skip
    assert (panel.y.hidden, panel.y.limits, panel.height) == (True, (-0.05, 1.05), 1.2)
    low = panel.items[0]
    np.testing.assert_allclose(low.y, [0.0, 0.0, 0.0, math.nan, 0.0, 0.5, 1.0 / 11.0, math.nan])
    np.testing.assert_allclose(low.x, [0.0, 1.0, 2.0, math.nan] * 2)
    assert low.notes[:5] == ("teeth: 20", "shift: 0.0", "te: 0 um", "", "teeth: 20")
    assert sum(one.y.size for one in panel.items) == 5 * 4  # the failed point has none


def test_one_axis_has_curves_of_their_own_and_words_have_places():
    axis = read_axis("k=1:5:5:mm")
    number, error = np.array([1.0, 2.0, math.nan, 4.0, 7.0]), np.full(5, 0.1)
    (curves,) = sweep_figures(results_of([axis], [Point((), (), ())] * 5), [value("te", number, error=error)])
    (view,) = curves.views
    (panel,) = view.panels
    assert view.key == "sweep_te"
    assert [(mark.axis, mark.at, mark.label) for mark in panel.marks] == [("x", 3.0, "no result")]
    np.testing.assert_array_equal(panel.items[0].error, error)
    assert (panel.x.label, panel.x.unit, panel.items[0].markers) == ("k", "mm", True)
    words = read_axis("k=fe,cornell")
    (curves,) = sweep_figures(results_of([words], [Point((), (), ())] * 2), [value("te", [1.0, 2.0])])
    (panel,) = curves.views[0].panels
    np.testing.assert_array_equal(panel.items[0].x, [0.0, 1.0])
    assert panel.x.categories == ("fe", "cornell")
    long = Axis("k", tuple(range(40)), tuple(map(float, range(40))))
    (curves,) = sweep_figures(results_of([long], [Point((), (), ())] * 40), [value("te", np.arange(40.0))])
    assert not curves.views[0].panels[0].items[0].markers
    assert sweep_figures(results_of([read_axis("k=1:1:1")]), [value("te", [1.0])]) == ()
    assert sweep_figures(results_of([axis]), []) == ()
    many = [value(f"v{k}", np.arange(5.0) + k) for k in range(10)]
    _, lines = sweep_figures(results_of([axis], [Point((), (), ())] * 5), many)
    assert len(lines.views) == 8  # more cannot be read beside each other
    assert len(lines.views[0].panels[0].x.categories) == 9


def test_a_family_of_curves_is_drawn_over_the_first_axis_too_where_it_is_longer():
    axes = [read_axis("a.x=0:3:4"), read_axis("b.y=p,q")]
    numbers = np.arange(8.0)
    curves, lines = sweep_figures(results_of(axes, [Point((), (), ())] * 8), [value("te", numbers)])
    (panel,) = curves.views[0].panels
    assert [one.name for one in panel.items] == ["y = p", "y = q"]
    np.testing.assert_array_equal(panel.items[0].y, [0.0, 2.0, 4.0, 6.0])
    assert [one.role for one in panel.items] == ["series:0", "series:1"]
    assert curves.views[0].key == "sweep_te"
    assert lines.views[0].panels[0].x.categories[1] == "y\np to q"
    assert shown.picture_name(value("I.te of p/q", [1.0])) == "sweep_I.te_of_p_q"


def test_groups_of_failures_and_remarks_are_told_largest_first():
    axis = read_axis("k=1:6:6")
    points = [
        Failure("InputError", "1.5 mm is too thin"), Point((), (), ("Gear a: 3 % off.",)),
        Failure("RangeError", "off the flank at 3"), Failure("RangeError", "off the flank at 4.5e-3"),
        Point((), (), ("Gear a: 7 % off.", "Once.")), Failure("RangeError", "off the flank at -6"),
    ]  # fmt: skip
    found = results_of([axis], points)
    assert [(one.kind, one.members) for one in found.failed()] == [("RangeError", (2, 3, 5)), ("InputError", (0,))]
    assert found.grouped_failures() == [
        "3 of 6 points failed (RangeError), the first at k = 3: off the flank at 3",
        "1 of 6 points failed (InputError), the first at k = 1: 1.5 mm is too thin",
    ]
    assert found.remarks() == ["2 of 6 points, the first of them: Gear a: 3 % off.", "Once."]
    two = results_of([read_axis("a=1:2:2"), read_axis("b=x,y,z")])
    assert [two.place(k) for k in (0, 2, 3, 5)] == ["a = 1, b = x", "a = 1, b = z", "a = 2, b = x", "a = 2, b = z"]


def test_ends_of_axes_are_said_only_where_there_is_a_middle_and_eight_sentences_at_most():
    axes = [read_axis("k=1:3:3"), read_axis("w=p,q")]

    def line(numbers, name="I.te_peak_to_peak", error=None):
        return shown.best_lines(results_of(axes), [value(name, numbers, error=error)])

    (middle,) = line([3, 3, 1, 2, 3, 3])
    assert middle == "Minimum I.te_peak_to_peak: 1 um at k = 2, w = p."
    (end,) = line([1, 3, 3, 3, 3, 3])
    assert end.endswith("at k = 1, w = p; at the limit of the range of k.")
    (last,) = line([3, 3, 3, 3, 3, 1])
    assert last.endswith("at k = 3, w = q; at the limit of the range of k.")
    (alike,) = line([3, 3, 1, 1.15, 1.25, 3], error=np.full(6, 0.1))
    assert "; 1 other point equal within the estimated errors." in alike
    (more,) = line([3, 3, 1, 1.15, 1.19, 3], error=np.full(6, 0.1))
    assert "; 2 other points equal within the estimated errors." in more
    many = [value(f"p{k}.K_Hbeta", [3, 3, 1, 2, 3, 3]) for k in range(12)]
    assert len(shown.best_lines(results_of(axes), many)) == 8
    for name in ("unloaded_te_peak_to_peak", "largest_root_tension", "largest_hertz_pressure", "K_Hbeta"):
        assert line([3, 3, 1, 2, 3, 3], f"I.{name}")[0].startswith("Minimum")
    for name in ("S_F", "S_H"):
        assert line([3, 3, 9, 2, 3, 3], f"I.{name}")[0].startswith("Maximum")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("k=0,5:1:3", "START:STOP:COUNT"), ("k=1.5,2,5", "may contain a decimal comma .2,5."),
        ("k=1 mm,2", "mixes numbers with and without units"),
        ("k=1,5 um,2,6 um", "mixes numbers with and without units"), ("k=inf:1:3", "START:STOP:COUNT"),
        ("k=1:2:1000001", "must be 1 to 1000000"), ("k=1e400:2:3", "must have finite ends"),
    ],
)  # fmt: skip
def test_axes_that_can_be_misread_are_refused(text, words):
    with pytest.raises(InputError, match=words):
        read_axis(text)


def test_values_of_an_axis_are_what_a_user_would_have_written():
    assert read_axis("k=0:0.3:4").values == (0.0, 0.1, 0.2, 0.3)
    assert read_axis("k=-0.3:0.3:7").values == (-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3)
    assert [math.copysign(1.0, x) for x in read_axis("k=-0.1:0.1:3").values] == [-1.0, 1.0, 1.0]
    assert read_axis("k=1234567.25:1234567.75:3").values == (1234567.25, 1234567.5, 1234567.75)
    assert read_axis("k=1e-9:3e-9:3").values == (1e-9, 2e-9, 3e-9)
    assert read_axis("k=1:3:3:mm").numbers == (1.0, 2.0, 3.0)
    assert read_axis("k=1 mm, 2 mm").numbers == (1.0, 2.0)
    assert read_axis("k=1 mm, 2 cm").unit == ""


def test_a_sweep_of_more_points_than_memory_holds_is_refused(tmp_path):
    case = tmp_path / "a.toml"
    case.write_text('results = ["geometry"]\n[gear.a]\nteeth = 20\nmodule = "2 mm"\n')
    axes = [read_axis("gear.a.teeth=20:319:300"), read_axis("gear.a.profile_shift=0:0.5:334")]
    with pytest.raises(InputError, match=r"300 x 334 = 100,200"):
        sweep_case(case, axes)
