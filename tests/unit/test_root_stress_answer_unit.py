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


START = "Root stress by formula over FE for loads on the"
UPPER, LOWER = (f"{START} {half} half of the flank, median (minimum to maximum):" for half in ("upper", "lower"))


def test_loads_near_the_form_circle_are_told_apart_and_do_not_decide_which_formula_is_closest():
    """The range was one over all loads: 0.427 to 1.15 for ISO 6336."""
    position = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    assert said(position, heywood=[0.9, 1.0, 0.9, 0.92, 0.94], **{"iso-6336-3": [0.4, 0.7, 1.0, 1.05, 1.1]}) == [
        f"{UPPER} ISO 6336-3 1.05 (1 to 1.1), Heywood 0.92 (0.9 to 0.94).",
        f"{LOWER} Heywood 0.95 (0.9 to 1), ISO 6336-3 0.55 (0.4 to 0.7).",
    ]


def test_a_formula_without_answers_on_one_half_has_no_range_there_and_one_without_any_none():
    position, none = np.array([0.2, 0.8]), [np.nan, np.nan]
    assert said(position, a=[np.nan, 1.1], b=[0.8, np.nan], c=none) == [
        f"{UPPER} a 1.1 (1.1 to 1.1).",
        f"{LOWER} b 0.8 (0.8 to 0.8).",
    ]


def test_every_formula_is_named_and_one_that_often_gives_no_value_comes_last():
    """Six formulas had a sentence each and only five were kept: the worst one was left out."""
    named = ("agma-908", "cornell", "cornell-trochoid", "heywood", "iso-6336-3", "dolan-broghamer")
    ratios = {name: [0.9 - 0.02 * i, 0.9] for i, name in enumerate(named)}
    (sentence,) = said(np.array([0.8, 1.0]), **(ratios | {"cornell": [1.0, np.nan]}))
    assert sentence.endswith(
        "Dolan and Broghamer 0.85 (0.8 to 0.9), Cornell 1 (1 to 1; no value at 50 % of the points)."
    )
    assert sentence.count("(") == 8  # one of the head, one of a name
