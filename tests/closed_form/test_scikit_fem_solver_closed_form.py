"""`accuracy.solver = "scikit-fem"`: a sector assembled, condensed and solved by scikit-fem, the ring closed as ever."""

import math
import sys
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csr_array

from fegear.base.errors import FegearError, InputError
from fegear.fem.plane.condensation import condense
from fegear.fem.plane.elasticity import assemble
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.scikit_fem_solver import between_kept
from fegear.fem.plane.settings import MeshSettings, settings_at
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear_body import GearBody
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.rack import BasicRack
from fegear.geometry.rim_support import RimSupport

#: Of the largest value of a kind.
SAME = 1e-10
RING = InternalTooth(24, PinionCutter(12, 0.0, 1.2, tip_radius=0.2), profile_shift=0.0, tip_radius=11.5)


def random_gear(seed: int) -> dict:
    """What a plane gear is solved for: external ones, every fifth a ring, held, on pins or in a spline."""
    random = np.random.default_rng(seed)
    nu, plane = random.uniform(0.0, 0.45), ("strain", "stress")[int(random.integers(2))]
    settings = settings_at(random.uniform(-4.5, -2.0))
    if seed % 5 == 4:
        support = (None, RimSupport(5, 1.5, 0.1), RimSupport())[seed // 5 % 3]
        tooth, outer = RING, RING.root_radius + random.uniform(0.5, 3.0)
    else:
        shift = random.uniform(-0.2, 0.6)
        tooth = Tooth(int(random.integers(12, 90)), BasicRack(1.0, 1.25, random.uniform(0.1, 0.35)), shift)
        support, outer = None, tooth.root_radius * random.uniform(0.3, 0.9)
    return {"tooth": tooth, "radius": outer, "nu": nu, "plane": plane, "settings": settings, "support": support}


def both(gear: dict, order: int) -> tuple[Influence, Influence]:
    mesh = mesh_sector(gear["tooth"], gear["radius"], replace(gear["settings"], order=order))
    one, other = (
        solve_influence(
            gear["tooth"], mesh, gear["nu"], gear["plane"],
            order=order, two_orders=True, support=gear["support"], solver=solver,
        )
        for solver in ("condensed", "scikit-fem")
    )  # fmt: skip
    return one, other


def apart(one: Influence, other: Influence) -> float:
    """Largest difference of compliances, and of stresses, over the largest of their kind."""
    found = []
    for kind in ("compliance", "stress"):
        a, b = getattr(one, kind), getattr(other, kind)
        assert a.keys() == b.keys()
        found.append(max(np.abs(a[k] - b[k]).max() for k in a) / max(np.abs(v).max() for v in a.values()))
    return max(found)


@pytest.mark.dear("4-4")
@pytest.mark.parametrize(
    "seed", [0, 4, *(pytest.param(i, marks=pytest.mark.dear) for i in range(1, 20) if i not in (0, 4))]
)
@pytest.mark.parametrize("order", [3, 4])
def test_influence_functions_of_twenty_gears_are_those_of_the_nested_dissection(seed, order):
    one, other = both(random_gear(seed), order)
    assert apart(one, other) < SAME
    assert apart(one.lower, other.lower) < SAME


def test_the_assembled_sector_is_the_sum_of_its_elements_and_its_motions_are_those_of_every_unknown():
    tooth = Tooth(12)
    mesh = mesh_sector(tooth, 0.5 * tooth.root_radius, MeshSettings().scaled(5.0))
    for order in (2, 3, 4):
        plain = assemble(mesh, 0.3, "strain", order)
        whole = assemble(mesh, 0.3, "strain", order, "scikit-fem")
        summed = np.zeros((plain.size, plain.size))
        for dofs, matrix in zip(plain.element_dofs, plain.stiffness, strict=True):
            summed[np.ix_(dofs, dofs)] += matrix
        assert np.abs(whole.whole.toarray() - summed).max() < 1e-11 * np.abs(summed).max()
        held, kept = np.unique(plain.edge_dofs["bore"]), np.unique(plain.edge_dofs["flank"])[::-1]
        a, b = (condense(each, kept, held, expandable=True) for each in (plain, whole))
        assert np.abs(a.stiffness - b.stiffness).max() < SAME * np.abs(a.stiffness).max()
        moved = np.random.default_rng(3).standard_normal((kept.size, 2))
        assert np.abs(a.expand(moved) - b.expand(moved)).max() < SAME * np.abs(moved).max()
        assert (b.expand(moved)[kept] == moved).all()


def called_of_scikit_fem(work) -> Counter:
    """Functions of scikit-fem that were called, by name, as Python's profiler sees them."""
    found: Counter = Counter()

    def note(frame, event, _argument):
        if event == "call" and "skfem" in frame.f_code.co_filename:
            found[frame.f_code.co_name] += 1

    sys.setprofile(note)
    try:
        work()
    finally:
        sys.setprofile(None)
    return found


def test_scikit_fem_assembles_condenses_and_solves_and_otherwise_does_not():
    gear = random_gear(0)
    mesh = mesh_sector(gear["tooth"], gear["radius"], replace(gear["settings"], order=3))
    called = {
        solver: called_of_scikit_fem(
            lambda s=solver: solve_influence(gear["tooth"], mesh, gear["nu"], gear["plane"], order=3, solver=s)
        )
        for solver in ("condensed", "scikit-fem")
    }
    assert all(called["scikit-fem"][name] for name in ("asm", "condense", "solve"))
    assert not any(called["condensed"][name] for name in ("asm", "condense", "solve"))


@pytest.mark.parametrize(
    ("angle", "body"),
    [
        pytest.param(15.0, None, marks=pytest.mark.dear),
        pytest.param(0.0, GearBody(5.2, 3.2, (-0.3, 0.3), (-0.8, 0.8)), marks=pytest.mark.dear),
        pytest.param(10.0, GearBody(5.2, 3.2, (-0.2, 0.4), (-0.6, 0.9), lean=0.2), marks=pytest.mark.dear),
    ],
)
def test_solid_gears_are_those_of_the_nested_dissection(angle, body):
    """Without a body, on a web in the middle (mirrored halves), on an inclined web (sheared functions)."""
    tooth, width = Tooth(16, BasicRack(1.0, 1.25, 0.25)), 0.6 if body is None else 2.0
    settings = SolidSettings(least_degree=4).scaled(2.0)
    tau = math.tan(math.radians(angle)) / (0.5 * tooth.teeth)
    one, other = (
        solve_solid(
            tooth, tau, width, 0.3, 0.3 * tooth.root_radius,
            replace(settings, section=replace(settings.section, solver=solver)), body=body,
        )
        for solver in ("condensed", "scikit-fem")
    )  # fmt: skip
    for kind in ("compliance", "displacement"):
        a, b = getattr(one, kind), getattr(other, kind)
        assert max(np.abs(a[k] - b[k]).max() for k in a) < SAME * max(np.abs(v).max() for v in a.values())


def test_what_nothing_holds_is_refused():
    free = csr_array(np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]]))
    with pytest.raises(FegearError, match="cannot be factored"):
        between_kept(free, np.array([0]), np.zeros(0, dtype=np.int64))


def test_unknown_solvers_are_refused_by_their_key():
    with pytest.raises(InputError, match=r"accuracy\.solver"):
        MeshSettings(solver="multigrid")


def test_the_basis_numbers_components_of_nodes_one_after_the_other():
    gear = random_gear(1)
    mesh = mesh_sector(gear["tooth"], gear["radius"], replace(gear["settings"], order=4))
    elements = sector_elements(mesh, 4)
    for components in (2, 3):
        numbered = elements.vector_basis(components).dofs.element_dofs.T
        assert (numbered[:, ::components] == components * elements.element_nodes).all()
