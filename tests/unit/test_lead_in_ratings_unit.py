"""What lead of the gears makes of their flanks in the rows of ISO 6336-1, table 8, and shafts that open no gap."""

from types import SimpleNamespace

import pytest

from fegear.case.built import pair_alignment
from fegear.case.built.pair_alignment import _modification, opened_by_shafts


def lead(crowning=0.0, slope=0.0, end_relief=()):
    return SimpleNamespace(crowning=crowning, slope=slope, end_relief=end_relief)


@pytest.mark.parametrize(
    ("leads", "row"),
    [
        ((None, None), "none"),
        ((lead(), None), "none"),
        ((lead(crowning=1e-6), lead()), "crowned for manufacture"),
        ((None, lead(slope=1e-6)), "helix corrected"),
        ((lead(slope=-1e-6), lead(crowning=1e-6)), "helix corrected and crowned"),
        ((lead(end_relief=("one",)), None), "end relief"),
        ((lead(crowning=1e-6, end_relief=("one",)), None), "crowned for manufacture"),
    ],
)
@pytest.mark.parametrize("relief", [True, False])
def test_the_row_follows_from_the_leads_of_both_gears_while_they_count(leads, row, relief):
    said = []
    gear = {
        name: SimpleNamespace(lead_of=lambda flank, one=one: (one, "lead"))
        for name, one in zip("ab", leads, strict=True)
    }
    tooth = SimpleNamespace(working_flank=None)
    scene = SimpleNamespace(
        case=SimpleNamespace(gear=gear, effects=SimpleNamespace(relief=relief)),
        gears={name: SimpleNamespace(tooth=tooth) for name in "ab"},
    )
    given = any(one is not None for one in leads)
    assert _modification(scene, ("a", "b"), said) == (row if relief else "none")
    assert bool(said) == (given and not relief)
    if said:
        assert "effects.relief is off" in said[0]


def test_shafts_that_open_no_gap_misalign_nothing(monkeypatch):
    monkeypatch.setattr(pair_alignment, "gearbox_of", lambda scene: "box")
    monkeypatch.setattr(pair_alignment, "gaps_of_even_loads", lambda box, name: SimpleNamespace(given=False))
    assert opened_by_shafts(SimpleNamespace(pairs={"I": None}), "I") == 0.0
