"""Random gearboxes as REXS models, turned, mirrored, scaled, and written from the other end: one misalignment."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest
from rexs_boxes import from_the_other_end, in_another_order, mirrored, random_box, rotated, scaled
from rexs_models import in_json, link, part, two_stages

from fegear.case.built.shafts import gearbox_of
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.exchange.rexs.model_to_case import case_of
from fegear.exchange.rexs.reading import model_of
from fegear.results.catalogue import STAGES

SEEDS = range(6)


def _scene(tree: dict, *results: str):
    found = tomllib.loads(case_of(model_of(in_json(tree), Path("model.rexs"))))
    return build_scene({**found, "results": list(results or ("misalignment",))}, "box", Path())


def _opened(tree: dict) -> np.ndarray:
    """What even loads open over the faces, by cause, a row for each mesh [m]; positive toward end I."""
    box = gearbox_of(_scene(tree))
    return np.array([shares.over_face for shares, _ in box.misalignment(box.under(box.even), box.even)])


@pytest.mark.dear
@pytest.mark.parametrize("seed", SEEDS)
def test_a_gearbox_written_otherwise_is_misaligned_alike(seed: int) -> None:
    tree = random_box(seed)
    straight = _opened(tree)
    small = 1e-9 * np.abs(straight).max()
    assert np.abs(straight[:, 0]).max() > 1e-6
    np.testing.assert_allclose(_opened(rotated(tree, seed)), straight, atol=small, rtol=0.0)
    np.testing.assert_allclose(_opened(from_the_other_end(tree)), straight, atol=small, rtol=0.0)
    np.testing.assert_allclose(_opened(in_another_order(tree, seed)), straight, atol=small, rtol=0.0)
    np.testing.assert_allclose(_opened(scaled(tree, 1.7)), 1.7 * straight, atol=2.0 * small, rtol=0.0)
    # In a mirror the driver turns the other way, so that ends I and II change places.
    np.testing.assert_allclose(_opened(mirrored(tree)), -straight, atol=small, rtol=0.0)


@pytest.mark.long
@pytest.mark.parametrize("seed", SEEDS)
def test_its_loads_over_the_face_are_alike(seed: int) -> None:
    def numbers(tree: dict) -> dict[str, float]:
        scene = _scene(tree, "misalignment", "load-distribution")
        values = run_plan(scene, make_plan(scene, STAGES)).values
        wanted = ("K_Hbeta", "shaft_misalignment")
        return {name: abs(one.value) for name, one in values.items() if name.split(".")[-1] in wanted}

    tree = random_box(seed)
    straight = numbers(tree)
    for other in (rotated(tree, seed), mirrored(tree), from_the_other_end(tree)):
        assert numbers(other) == pytest.approx(straight, rel=1e-9)


def test_torques_that_enter_at_two_places_twist_the_shaft_between_them() -> None:
    """All 160 N m were taken to enter where the first load stands."""
    second = part(35, "external_load", torque_around_u_axis=(60.0, "N m"), u_coordinate_on_shaft=(120.0, "mm"),
                  transmits_torque="true", defines_torque="true")  # fmt: skip

    def with_second(**changed: float) -> dict:
        tree = two_stages()
        parts = [_put_torque(one, changed.get("first")) if one["id"] == 31 else one for one in tree["components"]]
        more = _put_torque(second, changed.get("second"))
        links = [*tree["relations"], link(900, "assembly", assembly=3, part=35)]
        return {**tree, "components": [*parts, more], "relations": links}

    both = _opened(with_second())
    one, other = _opened(with_second(first=160.0, second=0.0)), _opened(with_second(first=0.0, second=160.0))
    # Shafts are linear: a part of the torque through either end opens that part of what all of it would.
    np.testing.assert_allclose(both, 0.625 * one + 0.375 * other, rtol=1e-9, atol=1e-15)
    assert abs(one[0, 0] - both[0, 0]) > 1e-7


def _put_torque(one: dict, torque: float | None) -> dict:
    if torque is None:
        return one
    kept = [a for a in one["attributes"] if a["id"] != "torque_around_u_axis"]
    new = part(0, "", torque_around_u_axis=(torque, "N m"))["attributes"]
    if not torque:  # a load that says nothing of a torque
        kept = [a for a in kept if a["id"] not in ("transmits_torque", "defines_torque")]
    return {**one, "attributes": [*kept, *new]}
