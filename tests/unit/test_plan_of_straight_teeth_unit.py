"""What a case that lacks a part is told besides: asymmetric, helical and 3D pairs have results of their own."""

from __future__ import annotations

from types import SimpleNamespace as Space

import pytest

from fegear.engine.plan import _straight


def scene(**given):
    usual = {"pairs": {"I": Space(asymmetric=False)}, "gears": {"p": 1}, "spur_gears": ("p",), "spur_pairs": ("I",),
             "wide_pairs": {}, "plane_pairs": {"I": 1}}  # fmt: skip
    return Space(**usual | given)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, ""),
        ({"pairs": {}, "gears": {}, "spur_gears": ()}, ""),
        ({"pairs": {"I": Space(asymmetric=True)}}, "teeth with equal flanks only; those of this case are asymmetric"),
        ({"pairs": {"I": Space(asymmetric=True), "II": Space(asymmetric=False)}}, ""),
        ({"spur_gears": (), "spur_pairs": ()}, "spur gears only; the gears of this case are helical"),
        ({"spur_pairs": ("I", "II", "III"), "wide_pairs": {"II": 1}, "plane_pairs": {}}, 'pair.II.width = "plane"'),
        ({"spur_pairs": ("I", "II"), "wide_pairs": {"II": 1}, "plane_pairs": {"I": 1}}, ""),
        ({"spur_pairs": ("I",), "wide_pairs": {"II": 1}, "plane_pairs": {}}, ""),
    ],
)
def test_a_case_is_told_what_results_are_about(given, said):
    found = _straight(scene(**given))
    assert said in found
    assert bool(found) == bool(said)
    assert not found or (found.startswith(" (possibly available for ") and found.endswith(")"))
