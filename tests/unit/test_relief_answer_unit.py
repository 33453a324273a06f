"""What to grind for a range of torques, in sentences; the designs are made up."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.design.held_relief import Robustness
from fegear.design.tip_relief.tip_tolerance import Decisive, TipTolerance
from fegear.engine.sheet.seen import Seen
from fegear.geometry.pair import MEMBERS
from fegear.geometry.relief import EndRelief
from fegear.results.relief.allowed_words import allowed_words, decisive_words
from fegear.results.relief.grinding import TIP, Grinding, tip_row
from fegear.results.relief.grinding_words import said_at, said_of_range, said_of_undefined
from fegear.results.relief.ground_tips import GroundTip, said_of_flat_optima, tip_numbers
from fegear.results.relief.recommended import recommended_design
from fegear.results.relief.relief_over_range import LeftOverRange
from fegear.results.relief.relief_robustness import as_designed

CLASS = "f_Hα of class 5, assumed"
LOAD = np.array([1000.0, 2000.0])


def left(values, most=None, finer=0, load=LOAD, share=None):
    numbers = (np.array(values, dtype=float) * 1e-6, np.zeros(2), None if most is None else np.array(most) * 1e-6)
    return LeftOverRange(0.05 * load, load, np.ones(2), *numbers, finer=finer, share=share)


def made(linear, parabolic, finer=0, grade=5, amounts=(6e-6, 6e-6), load=LOAD, single=0.8, share=None):
    """With linear reliefs to be ground."""
    rows = tuple(
        Grinding(
            "pw"[n], member, f"{shape} tip relief", TIP, shape, amounts[n], amount_tolerance=5e-6, start_diameter=0.06
        )
        for shape in ("linear", "parabolic") for n, member in enumerate(MEMBERS)
    )  # fmt: skip
    share = None if share is None else np.array(share)
    left_over = {
        "no relief": left((3.7, 7.0), load=load, share=share),
        "linear tip relief": left((1.2, 2.4), linear, finer, load, share),
        "parabolic tip relief": left((1.1, 2.5), parabolic, load=load),
        "linear tip relief for one load": left((3.9, single), load=load),
    }  # fmt: skip
    data = SimpleNamespace(for_range=True, grinding=rows, over_range=left_over, load=2000.0)
    asked = SimpleNamespace(tolerances=(TipTolerance(5e-6, None, 6e-6, CLASS if grade else "", grade),) * 2)
    return Seen(data, asked, "I")


def said(*linear_and_parabolic, **more):
    return list(said_of_range(made(*linear_and_parabolic, **more)))


def test_the_first_sentence_says_what_is_left_as_drawn_and_at_most_within_the_tolerances():
    first, _, single = said((3.3, 4.5), (3.5, 5.0))
    assert first.startswith("Pair I: grind 6 µm from d 60.0 mm on gear p and 6 µm from d 60.0 mm on gear w, linear: ")
    assert first.endswith(
        "7 -> 2.4 µm (within tolerances at most 4.5 µm) at 100 N m, 3.7 -> 1.2 µm (at most 3.3 µm) at 50 N m, "
        "peak to peak."
    )
    assert single.endswith(
        "designed for 100 N m only gives 3.9 µm peak-to-peak at 50 N m, more than without relief (3.7 µm)."
    )


def test_a_relief_for_one_load_that_leaves_as_much_as_none_is_not_said_to_leave_more():
    seen = made((3.3, 4.5), (3.5, 5.0))
    seen.data.over_range["linear tip relief for one load"] = left((3.7 * (1.0 + 1e-9), 0.8))
    assert not [one for one in said_of_range(seen) if "only gives" in one]


@pytest.mark.parametrize(
    ("grade", "amounts", "wide"),
    [
        (5, (3e-6, 6e-6), ("3 µm (± 5 µm) on gear p is less than its tolerance; specify finer tolerances, ± 2.5 µm "
                          "(f_Hα of class 3), a larger amount or no relief there.")),
        (None, (4e-6, 3e-6), ("4 µm (± 5 µm) on gear p and 3 µm (± 5 µm) on gear w are less than their tolerances; "
                             "specify finer tolerances, ± 2.5 µm, a larger amount or no relief there.")),
        (2, (3e-6, 6e-6), ("3 µm (± 5 µm) on gear p is less than its tolerance; specify a larger amount or no relief "
                          "there.")),
        (5, (5e-6, 6e-6), ""),
        (5, (1e-6, 6e-6), ""),  # below a quarter: cannot be ground
    ],
)  # fmt: skip
def test_an_amount_below_its_tolerance_is_said_with_what_to_do(grade, amounts, wide):
    """Nothing said it: ± 5 µm of 3 µm."""
    found = [one for one in said((3.3, 4.5), (3.5, 5.0), grade=grade, amounts=amounts) if "specify" in one]
    assert found == ([f"Pair I: {wide}"] if wide else [])


def test_the_first_sentence_has_what_the_rounded_numbers_leave_where_that_is_known():
    seen = made((3.3, 4.5), (3.5, 5.0))
    best = seen.data.over_range["linear tip relief"]
    seen.data.over_range["linear tip relief"] = replace(best, rounded=np.array([1.2345e-6, 2.3456e-6]))
    first, *_ = said_of_range(seen)
    assert first.endswith("at 50 N m, peak to peak (with the rounded numbers of the grinding table 2.35, 1.23 µm).")


def test_a_design_is_recommended_unless_tolerances_or_tiny_amounts_make_it_useless():
    def found(**more):
        data = made(*more.pop("most", ((3.3, 4.5), (3.5, 5.0))), **more).data
        return recommended_design(data.grinding, data.over_range)

    assert found() == "linear tip relief"
    assert found(amounts=(57e-9, 0.11e-6)) == ""
    assert found(amounts=(57e-9, 6e-6)) == "linear tip relief"
    lost = ((3.8, 7.1), (3.9, 7.2))
    assert found(most=lost, finer=2) == found(most=lost, finer=None) == ""
    assert recommended_design((), {}) == ""


def test_an_answer_for_a_spectrum_has_the_time_of_each_torque_and_the_mean_over_it():
    seen = made((3.3, 4.5), (3.5, 5.0), share=(0.6, 0.3))
    first, mean, *_ = said_of_range(seen)
    assert first.endswith(
        "transmission error over the load spectrum 7 -> 2.4 µm (within tolerances at most 4.5 µm) at 100 N m for 30 % "
        "of the time, 3.7 -> 1.2 µm (at most 3.3 µm) at 50 N m for 60 % of the time, peak to peak."
    )
    assert mean == (
        "Pair I: mean over the time under load 4.8 -> 1.6 µm; minimised: the maximum over the load spectrum of "
        "transmission error / torque times share of time."
    )


def test_the_torques_named_of_a_spectrum_are_its_ends_and_those_of_the_longest_times():
    values = np.ones(6)
    over = LeftOverRange(values, values, values, values, values, share=np.array([0.1, 0.1, 0.3, 0.05, 0.4, 0.05]))
    assert over.named == (5, 4, 2, 0)


def test_a_relief_far_below_its_tolerance_is_named():
    ordinary = said((3.3, 4.5), (3.5, 5.0))
    _, *rest = said((3.3, 4.5), (3.5, 5.0), amounts=(1.26e-6, 6e-6))
    wide = [one for one in rest if "is less than its tolerance" in one]
    assert len(wide) == 1
    assert [one for one in rest if one not in wide] == ordinary[1:]
    *_, faint, single = said((3.3, 4.5), (3.5, 5.0), amounts=(57e-9, 6e-6))
    assert single == ordinary[-1]
    assert faint == (
        "Pair I: 0.057 µm on gear p is below a quarter of its tolerance (± 5 µm) and cannot be ground; omit it, or set "
        "weights that emphasise the larger torques."
    )


def test_reliefs_that_nobody_can_grind_are_no_reliefs():
    """A range of torques from almost none on: its optimum is 0.1 um."""
    first, *further = said((3.3, 4.5), (3.5, 5.0), amounts=(57e-9, 0.11e-6), load=np.array([20.0, 2000.0]))
    assert first == (
        "Pair I: no tip relief needed from 1 N m to 100 N m: the optimum, 0.057 µm on gear p and 0.11 µm on gear w, is "
        "below a quarter of its tolerance (± 5 µm) and cannot be ground; transmission error without relief 7 µm at "
        "100 N m, 3.7 µm at 1 N m, peak to peak."
    )
    assert [" limit the relief" in one for one in further] == [True]
    first, *_ = said((3.3, 4.5), (3.5, 5.0), amounts=(57e-9, 6e-6))
    assert first.startswith("Pair I: grind 6 µm from d 60.0 mm on gear w, linear: ")


def test_the_maximum_is_with_the_profile_slope_of_a_gear_that_is_not_ground_which_is_said():
    slope = "and ± 10 % of the length, ± 5 µm profile slope on gear p at most 3.3 µm"
    _, within, *_ = said((3.3, 4.5), (3.5, 5.0), amounts=(0.0, 6e-6))
    assert slope in within
    assert not any("profile slope" in one for one in said((3.3, 4.5), (3.5, 5.0)))
    assert not any("profile slope" in one for one in said((3.3, 4.5), (3.5, 5.0), amounts=(57e-9, 6e-6)))
    assert not any("profile slope" in one for one in said(None, None, amounts=(0.0, 6e-6)))


@pytest.mark.parametrize("amount", [0.0, 12e-6])
def test_a_gear_that_is_not_ground_has_its_amount_only(amount):
    relief = EndRelief(amount, 0.2, 0.6, 1.0)
    gear = SimpleNamespace(base_radius=0.03)
    tip = SimpleNamespace(
        relief=relief, band=(relief, relief), gear=gear, member="driver", shape="linear", error=np.zeros(2),
        base_radius=0.03, start=0.2, start_radius_error=0.0, has_band=False,
    )  # fmt: skip
    row = tip_row(tip, "p", TipTolerance(4e-6, 0.5e-3, 0.0))
    assert (row.amount, row.member, row.shape) == (amount, "driver", "linear")
    numbers = np.array([row.amount_tolerance, row.start_diameter, row.end_diameter, row.length, row.length_tolerance])
    start, end = (0.06 * np.hypot(1.0, roll) for roll in (0.2, 0.6))
    expected = [4e-6, start, end, 0.03 * 0.4, 0.5e-3] if amount else [np.nan] * 5
    np.testing.assert_allclose(numbers, expected, rtol=1e-12)


@pytest.mark.parametrize("amount", [0.0, 12e-6])
def test_a_gear_that_is_not_ground_has_no_start_among_the_values(amount):
    """The summary said "driver.parabolic_tip_start = 11.95 deg" of a pinion that is not ground."""
    gear = SimpleNamespace(base_radius=0.03, tooth=SimpleNamespace(side=1.0))
    relief = EndRelief(amount, 0.2, 0.6, 1.0)
    ground = SimpleNamespace(driver=relief, driver_band=(relief, relief), error=np.zeros(4), undeviated=None)
    tip = GroundTip(ground, gear, None, None, "linear", "driver")
    seen = Seen(SimpleNamespace(tips=(tip,)), None, "I")
    names = [value.name for value in tip_numbers("tips", "{one.shape}_tip_").values(seen)]
    assert names == ["I.driver.linear_tip_amount", "I.driver.linear_tip_start"][: 2 if amount else 1]


@pytest.mark.parametrize(("low", "said"), [(10.4e-6, 1), (11.6e-6, 0)])
def test_amounts_of_a_flat_optimum_are_a_band(low, said):
    tip = SimpleNamespace(
        band=(SimpleNamespace(amount=low), SimpleNamespace(amount=12.8e-6 if said else low)), error=(1.2e-6, 0.0),
        relief=SimpleNamespace(amount=11.6e-6), shape="parabolic", member="driver", has_band=True,
    )  # fmt: skip
    sharp = SimpleNamespace(**{**vars(tip), "error": (1e-9, 0.0), "member": "driven"})
    seen = Seen(SimpleNamespace(tips=(tip, sharp)), SimpleNamespace(gears={"driver": "p", "driven": "w"}), "I")
    band = "10 to 13 µm on gear p with their best starts leave at most 1 % more than the minimum."
    assert list(said_of_flat_optima(seen)) == [f"Pair I: flat optimum of parabolic tip relief: {band}"][:said]


@pytest.mark.parametrize(("off", "said"), [(3.9e-6, 1), (0.5e-6, 0)])
def test_a_flat_optimum_of_the_maximum_within_tolerances_is_said_by_what_two_searches_differ(off, said):
    """13.4 ± 12 µm stood in the grinding table without a word."""
    tip = SimpleNamespace(
        error=(off, 0.0), relief=SimpleNamespace(amount=18.5e-6), shape="linear", member="driven", has_band=False,
        least_error=0.062e-6,
    )  # fmt: skip
    none = SimpleNamespace(**{**vars(tip), "member": "driver", "relief": SimpleNamespace(amount=0.0)})
    seen = Seen(SimpleNamespace(tips=(none, tip)), SimpleNamespace(gears={"driver": "p", "driven": "w"}), "I")
    words = (
        "Pair I: flat optimum of linear tip relief: 18.5 ± 3.9 µm on gear w is what two searches differ by, with "
        "maxima within the tolerances that differ by 0.062 µm."
    )
    assert list(said_of_flat_optima(seen)) == [words][:said]


WITHIN = f"Pair I: within ± 5 µm ({CLASS}) and ± 10 % of the length at most "


@pytest.mark.parametrize(
    ("linear", "parabolic", "finer", "grade", "words"),
    [
        ((2.0, 3.0), (1.9, 3.9), 0, 5, "2 µm at 50 N m (3.7 µm without relief)."),
        ((2.0, 3.0), (2.6, 3.9), 0, 5,
         "2 µm at 50 N m (3.7 µm without relief); parabolic tip relief 1.1 µm as drawn there, but at most 2.6 µm."),
        ((1.5, 5.9), (3.5, 4.5), 0, 5, "5.9 µm at 100 N m (7 µm without relief)."),
        ((4.3, 5.9), (4.2, 4.5), 2, 5,
         ("4.3 µm at 50 N m (3.7 µm without relief): to stay below that at every torque it needs ± 2.5 µm (f_Hα of "
         "class 3) and ± 10 % of the length.")),
        ((4.3, 5.9), (4.2, 4.5), 3, None,
         ("4.3 µm at 50 N m (3.7 µm without relief): to stay below that at every torque it needs ± 1.8 µm and ± 10 % "
         "of the length.")),
        ((4.3, 5.9), (4.2, 4.5), None, 5,
         "4.3 µm at 50 N m (3.7 µm without relief): no finer class keeps it below that at every torque."),
    ],
)  # fmt: skip
def test_the_second_sentence_says_what_tolerances_may_leave_and_which_would_do(linear, parabolic, finer, grade, words):
    within = said(linear, parabolic, finer, grade)[1]
    assert within == (WITHIN if grade else WITHIN.replace(f" ({CLASS})", "")) + words


@pytest.mark.parametrize(
    ("finer", "words"),
    [
        (2, "relief requires ± 2.5 µm (f_Hα of class 3) and ± 10 % of the length."),
        (None, "no finer class makes relief pay at every torque."),
    ],
)
def test_where_tolerances_take_more_than_the_gain_at_every_torque_the_first_sentence_says_so(finer, words):
    first, grind, single = said((4.3, 7.04), (4.2, 4.5), finer)
    assert first == (
        f"Pair I: within ± 5 µm ({CLASS}) and ± 10 % of the length the transmission error is smaller without relief "
        f"at every torque: 7 µm at 100 N m, with relief at most 7.04 µm; {words}"
    )
    assert grind.startswith("Pair I: without deviations grind 6 µm from d 60.0 mm on gear p and ")
    assert "only gives" in single
    assert said((4.3, 6.99), (4.2, 4.5), finer)[0].startswith("Pair I: grind ")


def test_no_relief_has_the_deviations_of_the_relief_that_it_is_compared_with():
    """More than an exact pair at every torque, but less than one with profile slopes within the same tolerance."""
    seen = made((4.3, 7.2), (4.4, 7.4))
    seen.data.over_range["no relief"] = replace(left((3.7, 7.0)), slopes=np.array([5.6e-6, 10.9e-6]))
    first, within, _ = said_of_range(seen)
    assert first.startswith("Pair I: grind 6 µm")
    assert within == (
        f"{WITHIN}4.3 µm at 50 N m (3.7 µm without relief, at most 5.6 µm with profile slopes within the same "
        "tolerance)."
    )
    assert recommended_design(seen.data.grinding, seen.data.over_range) == "linear tip relief"
    worse = made((5.8, 11.2), (5.9, 11.4), finer=2)
    worse.data.over_range["no relief"] = seen.data.over_range["no relief"]
    first, *_ = said_of_range(worse)
    lost = "smaller without relief at every torque: at most 10.9 µm at 100 N m, with relief at most 11.2 µm"
    assert lost in first
    assert recommended_design(worse.data.grinding, worse.data.over_range) == ""


def test_without_deviations_the_shape_that_is_best_as_drawn_is_named_with_its_numbers():
    """Parabolic relief leaves less within the tolerances, linear relief as drawn: 0.81 and 0.41 for 1.4 and 0.48 um."""
    seen = made((4.3, 7.3), (4.2, 7.1), finer=2)
    data = seen.data
    data.grinding = data.grinding[2:] + data.grinding[:2]  # the shape to be ground within the tolerances first
    data.over_range["linear tip relief"] = left((0.41, 0.81), (4.3, 7.3))
    data.over_range["parabolic tip relief"] = left((0.48, 1.4), (4.2, 7.1), finer=2)
    lost, grind, *_ = said_of_range(seen)
    assert lost.endswith(
        "7 µm at 100 N m, with parabolic tip relief at most 7.1 µm; parabolic tip relief requires ± 2.5 µm (f_Hα of "
        "class 3) and ± 10 % of the length."
    )
    assert grind == (
        "Pair I: without deviations grind 6 µm from d 60.0 mm on gear p and 6 µm from d 60.0 mm on gear w, linear: "
        "transmission error 7 -> 0.81 µm (within tolerances at most 7.3 µm) at 100 N m, 3.7 -> 0.41 µm (at most 4.3 "
        "µm) at 50 N m, peak to peak."
    )
    data.over_range["parabolic tip relief"] = left((0.48, 1.4), (4.2, 6.9))  # pays: what is to be ground as before
    assert "parabolic: transmission error 7 -> 1.4 µm" in next(iter(said_of_range(seen)))


@pytest.mark.parametrize(
    ("span", "single", "told"), [(10, 0.8, True), (9.9, 0.8, False), (200, 0.8, True), (200, 2.4, False)]
)
def test_small_torques_that_limit_the_relief_are_named_with_the_remedy(span, single, told):
    sentences = said((3.3, 4.5), (3.5, 5.0), load=np.array([2000.0 / span, 2000.0]), single=single)
    limits = [one for one in sentences if "limit the relief" in one]
    small = f"{100 / span:.4g}"
    words = (
        f"Pair I: torques down to {small} N m limit the relief: 2.4 µm at 100 N m, {single} µm with tip relief for "
        "that torque only; set weights that emphasise the larger torques."
    )
    assert limits == ([words] if told else [])
    assert not told or sentences[1] == words  # beside other results a design has room for two


def test_without_tolerances_nothing_is_said_of_them():
    first, single = said(None, None)
    assert "tolerances" not in first
    assert "only gives" in single


def test_tolerances_are_named_once_or_by_gear_and_of_ground_gears_only():
    p, w = (Grinding(gear, member, "", TIP, "linear", 6e-6) for gear, member in zip("pw", MEMBERS, strict=True))
    given, graded = TipTolerance(3e-6, 0.4e-3, 0.0), TipTolerance(6e-6, 0.4e-3, 0.0, "f_Hα of class 6")
    assert allowed_words((given, given), (p, w)) == "± 3 µm and ± 0.4 mm of length"
    assert allowed_words((given, graded), (w,)) == "± 6 µm (f_Hα of class 6) and ± 0.4 mm of length"
    assert allowed_words((given, graded), (p, w)) == (
        "± 3 µm on gear p, ± 6 µm (f_Hα of class 6) on gear w and ± 0.4 mm of length"
    )


@pytest.mark.parametrize(
    ("number", "size"),
    [("length", "0.19 mm"), ("amount", "190 µm"), ("slope", "190 µm"), ("profile_slope", "190 µm")],
)
def test_the_tolerance_that_matters_most_is_named_with_what_half_of_it_brings(number, size):
    gears, decisive = {"driver": "p", "driven": "w"}, Decisive("driven", number, 2.6e-6, 0.38e-3)
    name = {"slope": "helix slope", "profile_slope": "profile slope"}.get(number, number)
    assert decisive_words(1.2e-6, 3.26e-6, 150.0, decisive, gears) == (
        f"the tolerance of the {name} on gear w matters most: halved to ± {size}, at most 2.6 instead of 3.3 µm at "
        "150 N m"
    )
    assert decisive_words(1.2e-6, 3.26e-6, 150.0, replace(decisive, most=3.2e-6), gears) == (
        "no single tolerance decides: half of any one reduces the maximum at 150 N m by less than 5 %"
    )
    assert not decisive_words(3.2e-6, 3.26e-6, 150.0, decisive, gears)
    assert not decisive_words(1.2e-6, 3.26e-6, 150.0, decisive, {"driver": "p"})
    assert not decisive_words(1.2e-6, 3.26e-6, 150.0, None, gears)


@pytest.mark.parametrize(("most", "told"), [(7.2, True), (6.9, False)])
def test_at_one_torque_relief_that_is_worse_within_its_tolerances_is_not_to_be_ground_first(most, told):
    """Half of the torque counts for nothing: the relief is for the larger one."""
    rows = tuple(Grinding("pw"[n], one, "", TIP, "linear", 6e-6, start_diameter=0.06) for n, one in enumerate(MEMBERS))
    over = {"no relief": left((3.7, 7.0)), "linear tip relief": left((1.2, 2.4), (3.0, most), 2 if told else 0)}
    asked = SimpleNamespace(tolerances=(TipTolerance(5e-6, None, 6e-6, CLASS, 5),) * 2)
    seen = Seen(SimpleNamespace(grinding=rows, over_range=over, load=2000.0), asked, "I")
    first, *_ = said_at(seen, (1,), (1,))
    start = f"Pair I: within ± 5 µm ({CLASS}) and ± 10 % of the length the transmission error is smaller without relief"
    assert first.startswith(f"{start}: 7 µm at 100 N m, with relief at most 7.2 µm" if told else "Pair I: grind 6 µm")


def test_an_amount_below_its_error_has_no_defined_optimum():
    row = Grinding("p", "driver", "", TIP, "linear", 10e-6, 390e-6, amount_from=4e-6, amount_to=60e-6)
    well = Grinding("w", "driven", "", TIP, "linear", 10e-6, 9e-6)
    bare = Grinding("w", "driven", "", TIP, "linear", 10e-6)
    assert list(said_of_undefined(Seen(None, None, "I"), [row, well, bare])) == [
        "Pair I: no defined optimum on gear p: 10 µm has an estimated error of 390 µm; 4 to 60 µm are equally good."
    ]
    flat = replace(row, amount_from=10e-6, amount_to=10e-6)
    (only,) = said_of_undefined(Seen(None, None, "I"), [flat])
    assert only.endswith("error of 390 µm.")


def test_the_robustness_states_the_value_at_the_design_load_of_the_design():
    one = np.ones(1)
    found = Robustness(one, 0.0 * one, 0.0 * one, np.full((1, 1, 1), 2.8499e-6), 2.8499e-6)
    te = SimpleNamespace(peak_to_peak=2.850962e-6, effective_error=1e-6)
    assert as_designed(found, te, "peak_to_peak").nominal == 2.850962e-6
    assert as_designed(found, te, "effective_error").nominal == 1e-6
    assert as_designed(found, None, "peak_to_peak") is found


@pytest.mark.parametrize(
    ("every", "weights"),
    [((-1, 0), True), ((-1,), False), ((0,), False)],
)
def test_the_tolerance_that_decides_is_that_of_the_torque_at_which_most_is_left(every, weights):
    """Of 3.3 and 4.5 um at most, 3.7 and 7 um without relief, 50 N m counts most; one torque needs no weights."""
    seen = made((3.3, 4.5), (3.5, 5.0), amounts=(57e-9, 6e-6))
    best = seen.data.over_range["linear tip relief"]
    decisive = (Decisive("driver", "amount", 2e-6, 5e-6), Decisive("driven", "amount", 2.5e-6, 3e-6))
    seen.data.over_range["linear tip relief"] = replace(best, decisive=decisive)
    said_here = list(said_at(seen, every, every))
    (told,) = (one for one in said_here if "matters most" in one)
    at_50, at_100 = (
        "gear p matters most: halved to ± 2.5 µm, at most 2 instead of 3.3 µm at 50 N m",
        "gear w matters most: halved to ± 1.5 µm, at most 2.5 instead of 4.5 µm at 100 N m",
    )
    assert (at_100 if every == (-1,) else at_50) in told
    (faint,) = (one for one in said_here if "cannot be ground" in one and "omit it" in one)
    assert ("weights" in faint) is weights
