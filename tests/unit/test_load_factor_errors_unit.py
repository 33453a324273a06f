"""Errors of the root factors of solved flanks: what two solutions share by chance is not stated as certain."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.results.pair.load_factors import _OF_LOAD, FlankLoadFactorsData


def factors(face, transverse):
    return SimpleNamespace(face=face, transverse=transverse)


def off(factor, coarse, by_load=0.0037):
    loaded = SimpleNamespace(
        at=1, error=SimpleNamespace(face_load_factor=np.array([9.0, by_load * 1.25])),
        stated=SimpleNamespace(face_load_factor=np.array([7.0, 1.25])),
    )  # fmt: skip
    root = {"driver": factors(1.0, 1.1), "driven": factors(1.2, 1.0)}
    return FlankLoadFactorsData.off(SimpleNamespace(loaded=loaded, root=root, coarse=coarse), factor)


def test_the_root_factor_of_the_face_errs_by_a_part_of_what_the_load_over_it_does():
    """Of a spur pair K_Fbeta was 7e-5 off where 1e-5 was stated, for both solutions agreed by chance."""
    alike = {"driver": factors(1.0 - 1e-5, 1.1017), "driven": factors(1.2, 1.0)}
    assert off("face", alike) == pytest.approx(_OF_LOAD * 0.0037)
    assert off("face", alike, by_load=0.0) == pytest.approx(1e-5)
    assert off("transverse", alike) == pytest.approx(0.0017)
    assert off("face", {"driver": factors(1.01, 1.1), "driven": factors(1.25, 1.0)}) == pytest.approx(0.05)
    assert off("face", {"driver": None, "driven": None}) is None
