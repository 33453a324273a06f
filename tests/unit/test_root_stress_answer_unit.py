"""What a study of root-stress formulas answers: for loads that ratings have, the others apart; the study is made up."""

from types import SimpleNamespace

import numpy as np

from fegear.results.gear.root_stress_study import _closest


def said(position, **ratios):
    rows = SimpleNamespace(
        load_position=np.tile(position, len(ratios)), formula=np.repeat(list(ratios), len(position)),
        ratio_to_fe=np.concatenate(list(ratios.values())),
    )  # fmt: skip
    return list(_closest(SimpleNamespace(data=SimpleNamespace(rows=rows, formulas=dict.fromkeys(ratios)))))


def test_loads_near_the_form_circle_are_told_apart_and_do_not_decide_which_formula_is_closest():
    """The range was one over all loads: 0.427 to 1.15 for ISO 6336."""
    position = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    assert said(position, heywood=[0.9, 1.0, 0.9, 0.92, 0.94], iso=[0.4, 0.7, 1.0, 1.05, 1.1]) == [
        f"{name}: root stress {upper}, for loads on the upper half of the flank; on its lower half from {lower}."
        for name, upper, lower in (
            ("iso", "1.05 of FE (median), from 1 to 1.1", "0.4 to 0.7"),
            ("heywood", "0.92 of FE (median), from 0.9 to 0.94", "0.9 to 1"),
        )
    ]


def test_a_formula_without_answers_on_one_half_has_no_range_there_and_one_without_any_no_sentence():
    position, none = np.array([0.2, 0.8]), [np.nan, np.nan]
    assert said(position, a=[np.nan, 1.1], b=[0.8, np.nan], c=none) == [
        "a: root stress 1.1 of FE (median), from 1.1 to 1.1, for loads on the upper half of the flank.",
        "b: root stress 0.8 of FE (median), from 0.8 to 0.8, for loads on the lower half of the flank.",
    ]
