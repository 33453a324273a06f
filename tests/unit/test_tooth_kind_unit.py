"""How near to the fillet's end a flank is loaded: above a crack's mouth, unless that is in the other fillet."""

from __future__ import annotations

from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.fem.plane.odd import tooth_kind as module
from fegear.fem.plane.odd.tooth_kind import _ABOVE_MOUTH, MARGIN, CrackedSector, ToothKind, tooth_kind


class LoadedError(Exception):
    """The flank is about to be loaded."""


@pytest.mark.parametrize(
    ("mouth", "back", "margin"),
    [
        (None, False, MARGIN),
        (0.5, False, MARGIN),
        (1.0 - 0.9 * MARGIN, False, _ABOVE_MOUTH * 0.9 * MARGIN),
        (1.0 - 1.02 * MARGIN, False, _ABOVE_MOUTH * 1.02 * MARGIN),
        (1.0 - 1.04 * MARGIN, False, MARGIN),
        (1.0 - 0.9 * MARGIN, True, MARGIN),
    ],
)
def test_a_flank_is_loaded_down_to_above_the_mouth_of_a_crack(monkeypatch, mouth, back, margin):
    sector = Space()
    if mouth is not None:
        sector = object.__new__(CrackedSector)
        for name, value in (("mouth", mouth), ("back", back)):
            object.__setattr__(sector, name, value)
    odd = Space(tooth=Space(side=1), mesh="mesh", sector=sector)

    def fillet(mesh, elasticity, name, side):
        assert (mesh, elasticity, side) == ("mesh", "elasticity", 1)
        return Space(length={"fillet": 1.0, "back_fillet": 9.0}[name])

    def flank(mesh, elasticity, tooth, given):
        assert (mesh, elasticity, tooth) == ("mesh", "elasticity", odd.tooth)
        raise LoadedError(given)

    monkeypatch.setattr(module, "fillet_strain", fillet)
    monkeypatch.setattr(module, "loaded_flank", flank)
    with pytest.raises(LoadedError) as told:
        tooth_kind(odd, "elasticity", 0.3, "strain")
    assert told.value.args[0] == pytest.approx(margin)


def kind(mouth=0.5, back=False, cracked=True):
    arc = np.linspace(0.0, 1.0, 6)
    return Space(
        fillets={side: Space(arc=arc, length=1.0) for side in ("tension", "compression")}, cracked=cracked, back=back,
        mouth=mouth, flank=Space(roll_squared=np.array([0.1, 0.2, 0.7]), base_radius=12.0),
    )  # fmt: skip


@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize("side", ["tension", "compression"])
def test_a_fillet_in_which_a_crack_starts_has_two_pieces(side, back):
    found = ToothKind.pieces(kind(back=back), side)
    if back != (side == "compression"):
        ((start, curve, points),) = found
        assert (start, curve.length, points) == (0.0, 1.0, slice(None))
        assert (curve.side, curve.base_radius) == (side, 12.0)
        return
    (start, below, first), (mouth, above, second) = found
    assert (start, mouth, below.length, above.length) == (0.0, 0.5, 0.5, 0.5)
    np.testing.assert_allclose(below.arc, [0.0, 0.2, 0.4])
    np.testing.assert_allclose(above.arc, [0.1, 0.3, 0.5])
    assert (first, second) == (slice(0, 3), slice(3, None))
    assert len(ToothKind.pieces(kind(back=back, cracked=False), side)) == 1
