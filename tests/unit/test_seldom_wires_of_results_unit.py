"""Which of two gears, pairs, flanks or processes lines take that only whole long runs reach; by parts that differ."""

import os
import signal
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built import double_helical, gear_quality, odd_gears, odd_teeth, solid_influence, tooth_influence
from fegear.case.gear import GearPart
from fegear.design.fillet import fillet_design as search
from fegear.engine import processes
from fegear.engine.stage import Task
from fegear.output import drawn_mesh, picture_process
from fegear.results.helical.transmissibility import _with_full_matrix
from fegear.results.pair import fillet_design
from fegear.results.shafts import gearbox_scheme, lead_correction
from fegear.results.train import gear_train
from fegear.studies.cost import measure


def noted(found, returns=None):
    """A function that keeps what it is called with."""

    def call(*given, **named):
        found.append((*given, *named.values()))
        return returns

    return call


# ---- trains ----------------------------------------------------------------------------------------------------------
class Engaged:
    """Flanks that know whether they are those of the mate."""

    def __init__(self, name, turned=False):
        self.name, self.turned = name, turned

    def reversed(self):
        return Engaged(self.name, not self.turned)

    def unmodified(self):
        return Engaged(f"{self.name} without relief", self.turned)

    def __eq__(self, other):
        return (self.name, self.turned) == (other.name, other.turned)

    __hash__ = None


@pytest.fixture
def train(monkeypatch):
    """Two meshes of 300 and -500 N, the second of which its driven gear drives; springs say what they were asked."""
    teeth = {
        "I": SimpleNamespace(pair="p", back="b", width_ratio=1.0, odd=False, like=False, halves=1),
        "II": SimpleNamespace(pair="q", back="", width_ratio=2.0, odd=False, like=True, halves=1),
    }
    monkeypatch.setattr(gear_train, "build_train", lambda spec: spec)
    monkeypatch.setattr(gear_train, "static_forces", lambda _: np.array([300.0, -500.0]))
    monkeypatch.setattr(gear_train, "a_drives", lambda _: [True, False])
    monkeypatch.setattr(gear_train, "loaded_pair", lambda _, name: SimpleNamespace(engagement=Engaged(name), nominal=7))
    monkeypatch.setattr(gear_train, "assemble", lambda _, found: Assembled(found))
    monkeypatch.setattr("fegear.dynamics.train.mesh_excitation.mesh_excitation", Spring)
    monkeypatch.setattr("fegear.dynamics.train.back_flanks.leverage", lambda pair: {"P": 1.5, "Q": 0.5}[pair.name])
    monkeypatch.setattr("fegear.dynamics.train.back_flanks.back_flanks", lambda *given: given)
    monkeypatch.setattr(gear_train, "replace", lambda one, **more: SimpleNamespace(**vars(one) | more))
    spec = SimpleNamespace(meshes=[SimpleNamespace(pair=Engaged("P")), SimpleNamespace(pair=Engaged("Q"))])
    return SimpleNamespace(teeth=teeth, spec=spec)


class Spring:
    def __init__(self, engagement, load):
        self.asked, self.width = (engagement.name, engagement.turned, load), None

    def widened(self, width):
        self.width = width
        return self

    def total_stiffness(self):
        return self.asked


class Assembled:
    def __init__(self, found):
        self.meshes = [SimpleNamespace(spring=one) for one in found.values()]


def test_springs_of_a_train_are_of_the_flanks_that_push_and_its_back_flanks_of_the_torque(train):
    fractions = []
    made = gear_train.compute_train(train, {}, SimpleNamespace(progress=fractions.append))
    first, second = made.meshes
    assert (first.spring.asked, first.spring.width) == (("p", False, 300.0), 1.0)
    assert (second.spring.asked, second.spring.width) == (("q without relief", True, 250.0), 2.0)
    assert first.back == (Engaged("P"), ("b", False, 200.0))  # 300 N at 1.5 of the base radius
    assert second.back is None
    assert fractions == [0.5, 1.0]
    train.teeth["I"].back, train.teeth["II"].back = "", "c"
    made = gear_train.compute_train(train, {}, SimpleNamespace(progress=fractions.append))
    assert made.meshes[0].back is None
    assert made.meshes[1].back == (Engaged("Q", turned=True), ("c", True, 1000.0))


def test_a_reduced_model_has_no_frequencies_of_the_full_matrix():
    assert _with_full_matrix(SimpleNamespace(), SimpleNamespace()).size == 0


# ---- designs ---------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("other", [None, "driven"])
def test_a_fillet_is_designed_with_the_gears_of_its_own_pair_and_of_the_other(monkeypatch, other):
    monkeypatch.setattr(fillet_design, "loaded_pair", lambda _, name: SimpleNamespace(
        spec=f"spec {name}", pair=f"pair {name}", nominal=5.0))  # fmt: skip
    monkeypatch.setattr(fillet_design, "solution_of", lambda _, gear: f"solved {gear}")
    asked = []
    monkeypatch.setattr(search, "design_fillet", noted(asked, "design"))
    given = SimpleNamespace(
        name="I", solved={"driver": "a", "driven": "b"}, member="driver", alike=True, other="II", other_member=other,
        other_gears={"driver": "c", "driven": "a"}, limits="limits", objective="tension", tolerance=0.01, searches=3,
        waves=2,
    )  # fmt: skip
    found = fillet_design._compute(given, {}, SimpleNamespace(progress="progress"))
    ((own, *more, second),) = asked
    assert (own.spec, own.solved, own.member, own.alike) == ("spec I", ("solved a", "solved b"), "driver", True)
    assert more == ["limits", "tension", 0.01, "progress", 3, 2]
    if other is None:
        assert second is None
    else:
        assert (second.spec, second.solved, second.member, second.alike) == (
            "spec II", ("solved c", "solved a"), "driven", False
        )  # fmt: skip
    assert (found.pair, found.design) == ("pair I", "design")


def test_configurations_of_a_wide_pair_solve_its_bodies_as_they_say(monkeypatch):
    asked = []
    monkeypatch.setattr(measure, "solve_bodies", noted(asked, "bodies"))
    monkeypatch.setattr(measure, "_flank", lambda one: one)
    assert measure._solve_wide(SimpleNamespace(scene="scene", pair="I"),
                               SimpleNamespace(body="slices", solid="settings")) == "bodies"  # fmt: skip
    assert asked == [("scene", "I", "slices", "settings")]


# ---- cases -----------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("order", [("slices", "solid"), ("solid", "slices")])
def test_a_gear_that_pairs_want_in_slices_and_solid_is_named_with_both(monkeypatch, order):
    monkeypatch.setattr(solid_influence, "_widths", lambda *_: dict(zip(("I", "II"), order, strict=True)))
    with pytest.raises(InputError) as caught:
        solid_influence._source(SimpleNamespace(), "a")
    sliced, solid = ("I", "II") if order[0] == "slices" else ("II", "I")
    assert str(caught.value).startswith(f'pair.{sliced}.width = "slices": contradicts pair.{solid}.width')


@pytest.mark.parametrize(("teeth", "reach"), [(4, 1), (6, 2), (8, 2), (40, 2)])
def test_a_pinion_on_a_rack_knows_two_neighbours_where_it_has_so_many(teeth, reach):
    effects = SimpleNamespace(neighbour_coupling=True, corner_contact=False)
    case = SimpleNamespace(effects=effects, pair={}, rack={"r": SimpleNamespace(pinion="a")})
    scene = SimpleNamespace(case=case, pairs={}, gears={name: SimpleNamespace(teeth=teeth) for name in "ab"})
    assert tooth_influence.needed_reach(scene, "a") == reach
    assert tooth_influence.needed_reach(scene, "b") == 1
    effects.neighbour_coupling = False
    assert tooth_influence.needed_reach(scene, "a") == 1


def test_what_a_rim_that_is_not_held_all_round_leaves_out():
    def gear(kind, internal):
        return SimpleNamespace(support=kind and SimpleNamespace(kind=kind, free_teeth=3),
                               tooth=SimpleNamespace(internal=internal))  # fmt: skip

    def said(kind, internal):
        found = SimpleNamespace(gear=gear(kind, internal), fine=SimpleNamespace(pins=None))
        return tooth_influence.support_remarks("g", found)

    (arc,) = said("free_arc", False)
    assert "bore free below 3 teeth" in arc
    assert said(None, True) == said("web", True) == said("pins", False) == ()
    (ring,) = said("pins", True)
    assert "each planet-ring mesh is computed separately" in ring


def test_teeth_of_a_ring_on_pins_are_compared_by_their_own_numbers():
    """c_self of 6 and 14 is 40 % off its mean, root stresses of 3 and 5 are 25 %."""
    uneven = SimpleNamespace(deflection=np.array([6.0, 14.0]), root_tension=np.array([3.0, 5.0]))
    fine = SimpleNamespace(support=SimpleNamespace(pins=6), uneven=uneven, body=None)
    spread, alone = solid_influence.solid_support_remarks("g", SimpleNamespace(fine=fine))
    assert "its 6 pins" in spread
    assert "c_self -40 % to +40 % from the mean" in spread.replace("−", "-")
    assert "-25 % to +25 %" in spread.replace("−", "-")
    fine.uneven = None
    assert solid_influence.solid_support_remarks("g", SimpleNamespace(fine=fine)) == (alone,)
    fine.support = None
    assert solid_influence.solid_support_remarks("g", SimpleNamespace(fine=fine)) == ()


def test_gears_with_odd_teeth_that_drive_and_are_driven_are_known(monkeypatch):
    """a drives b, b drives c, and d stands alone."""
    pairs = {"I": SimpleNamespace(driver="a", driven="b"), "II": SimpleNamespace(driver="b", driven="c")}
    scene = SimpleNamespace(case=SimpleNamespace(pair=pairs, planetary={}), plane_pairs=("I", "II"))
    monkeypatch.setattr(odd_gears, "reshaped_gears", lambda _: ("a", "b", "c", "d"))
    assert odd_gears.loaded_on_both_flanks(scene) == ("b",)
    assert odd_teeth._is_planet(scene, "b") is False


def test_both_other_gears_of_a_double_helical_pair_are_checked(monkeypatch):
    checked, pairs = [], []
    others = {"driver": "c", "driven": None}
    monkeypatch.setattr(double_helical, "double_part", lambda *_: SimpleNamespace(others=others))
    monkeypatch.setattr("fegear.case.built.solid_influence.check_solid_gear", lambda _, gear: checked.append(gear))
    monkeypatch.setattr("fegear.case.built.pair_checks.check_wide_pair", lambda _, pair: pairs.append(pair))
    for name in ("double_to_load", "refuse_another_space", "refuse_pushed_off"):
        monkeypatch.setattr(double_helical, name, lambda *_: None)
    pair = SimpleNamespace(width="solid")
    scene = SimpleNamespace(case=SimpleNamespace(pair={"I": pair}))
    check = double_helical.check_double
    check(scene, "I")
    others["driven"] = "d"
    check(scene, "I")
    assert checked == ["c", "c", "d"]
    assert pairs == ["I", "I"]
    pair.width = "plane"
    with pytest.raises(InputError, match="contradicts double_helical"):
        check(scene, "I")


def test_relief_counts_in_a_rating_with_its_largest_amount_and_where_it_is_on():
    def found(amounts, *, on):
        scene = SimpleNamespace(case=SimpleNamespace(effects=SimpleNamespace(relief=on)))
        relief = SimpleNamespace(tip=[SimpleNamespace(amount=one) for one in amounts]) if amounts is not None else None
        said = []
        return gear_quality._tip_relief(scene, "a", SimpleNamespace(relief=relief), said), len(said)

    assert found([10e-6, 20e-6], on=True) == (20e-6, 0)
    assert found([20e-6, 10e-6], on=False) == (0.0, 1)
    assert found([0.0, None], on=False) == found(None, on=False) == found([], on=True) == (0.0, 0)


@pytest.mark.parametrize(
    ("teeth", "given", "largest", "tried"),
    [(60, 25, 40, [25]), (60, None, 40, []), (60, None, None, [30]), (8, None, None, [5])],
)
def test_a_ring_is_cut_by_its_own_cutter_the_largest_that_clears_or_one_of_half_its_teeth(
    monkeypatch, teeth, given, largest, tried
):  # fmt: skip
    asked = []

    def made(number):
        asked.append(number)
        return f"cut by {number}"

    monkeypatch.setattr("fegear.geometry.internal_interference.largest_cutter",
                        lambda _, z: largest and f"largest of {z}, {largest}")  # fmt: skip
    found = GearPart._cut(SimpleNamespace(teeth=teeth), given, made)
    assert asked == tried
    assert found == (f"cut by {tried[0]}" if tried else f"largest of {teeth}, {largest}")


def test_a_lead_is_corrected_where_a_pair_on_shafts_is_loaded_over_its_face(monkeypatch):
    monkeypatch.setattr(lead_correction, "needs_gears_of_meshes", lambda _, name: (Task("solid-gear", name),))
    assert lead_correction._needs(SimpleNamespace(), "a") == (
        lead_correction.LOADED_SHAFTS_TASK,
        Task("solid-gear", "a"),
    )
    monkeypatch.setattr(lead_correction, "fed_pairs", lambda _: ["I"])
    lead_correction._check(SimpleNamespace(), "a")
    monkeypatch.setattr(lead_correction, "fed_pairs", lambda _: [])
    with pytest.raises(InputError, match="requires a pair on shafts"):
        lead_correction._check(SimpleNamespace(), "a")


def test_shafts_side_by_side_stand_a_largest_centre_distance_apart():
    def data(*apart):
        meshes = [SimpleNamespace(found=SimpleNamespace(centre_distance=one)) for one in apart]
        return SimpleNamespace(gearbox=SimpleNamespace(meshes=meshes))

    assert gearbox_scheme._room(data(0.12, 0.3, 0.2)) == 0.3
    assert gearbox_scheme._room(data()) == 0.1


# ---- drawings --------------------------------------------------------------------------------------------------------
def test_pairs_of_a_wanted_gear_that_are_loaded_and_solved_are_drawn_at_each_point(monkeypatch):
    """I has the wanted gear, II has not, III is by a formula, IV has no load."""

    def pair(driver, driven, source="fe", loads=(1.0,)):
        return SimpleNamespace(driver=driver, driven=driven, compliance=SimpleNamespace(source=source),
                               all_loads=lambda _: loads)  # fmt: skip

    pairs = {"I": pair("a", "b"), "II": pair("c", "d"), "III": pair("a", "d", "iso"), "IV": pair("d", "a", loads=())}
    scene = SimpleNamespace(plane_pairs=tuple(pairs), case=SimpleNamespace(pair=pairs), pairs=dict.fromkeys(pairs),
                            name="case", neglects=True)  # fmt: skip
    ran, drawn, seen = [], [], []
    monkeypatch.setattr(drawn_mesh, "replace", lambda one, **more: SimpleNamespace(**vars(one) | more))

    def run(quiet, tasks, cache):
        ran.append((quiet.neglects, tasks, cache))
        data = {task: SimpleNamespace(data=SimpleNamespace(engagement=f"{task.stage} of {task.subject}", nominal=9.0))
                for task in tasks}  # fmt: skip
        return SimpleNamespace(outcomes=data)

    def drawings(name, engagement, load, inside):
        seen.append((name, engagement, load, inside.engagement))
        return [SimpleNamespace(letter=one) for one in "AB"]

    class Held:
        def __init__(self, *given):
            seen.append(given[1:])

        def __enter__(self):
            return self

        def __exit__(self, *_):
            return None

    monkeypatch.setattr(drawn_mesh, "make_plan", lambda _scene, _stages, tasks: tasks)
    monkeypatch.setattr(drawn_mesh, "run_plan", run)
    monkeypatch.setattr(drawn_mesh, "stress_drawings", drawings)
    monkeypatch.setattr(drawn_mesh, "loads_as_given", Held)
    monkeypatch.setattr(drawn_mesh, "write_drawing", lambda one, title, path: drawn.append((one.letter, title, path)))
    request = SimpleNamespace(scene=scene, gears=["b", "x"], folder=Path("to"), cache="cache")
    files, remarks = drawn_mesh.written_pdf(request)
    assert ran == [(False, [Task("loaded-pair", "I"), Task("stress-inside", "I")], "cache")]
    assert seen == [("I",), ("I", "loaded-pair of I", 9.0, "stress-inside of I")]
    assert files == [Path("to/mesh_I_A.pdf"), Path("to/mesh_I_B.pdf")]
    assert drawn == [("A", "case", files[0]), ("B", "case", files[1])]
    assert remarks == ()
    request.gears = ["d"]
    drawn_mesh.written_svg(request)
    assert {task.subject for task in ran[-1][1]} == {"II"}
    request.gears = ["x"]
    with pytest.raises(InputError, match='--format = "svg": requires a pair'):
        drawn_mesh.written_svg(request)


def test_a_picture_that_cannot_be_drawn_is_drawn_again_by_who_asked(monkeypatch):
    monkeypatch.setattr("fegear.output.draw_png.draw_pictures", lambda *given: iter(given))
    assert picture_process._pictures("figure", "folder", "svg") == ("figure", "folder", "svg")

    def fails(*_):
        raise RuntimeError("no font")

    monkeypatch.setattr("fegear.output.draw_png.draw_pictures", fails)
    assert picture_process._pictures("figure", "folder", "svg") is None


# ---- processes -------------------------------------------------------------------------------------------------------
def test_a_folder_of_a_process_is_removed_after_its_end(monkeypatch, tmp_path):
    (tmp_path / "scratch").mkdir()
    parents, slept = [os.getpid(), os.getpid(), 1], []
    monkeypatch.setattr(os, "fork", lambda: 0)
    monkeypatch.setattr(os, "getppid", lambda: parents.pop(0))

    def sleep(seconds):
        assert (tmp_path / "scratch").exists()
        slept.append(seconds)

    monkeypatch.setattr(processes.time, "sleep", sleep)
    processes._remove_after_the_end(str(tmp_path / "scratch"))
    assert not (tmp_path / "scratch").exists()
    assert len(slept) == 2
    (tmp_path / "scratch").mkdir()
    monkeypatch.setattr(os, "fork", lambda: 17)  # the process itself leaves it to its copy
    processes._remove_after_the_end(str(tmp_path / "scratch"))
    assert (tmp_path / "scratch").exists()


def test_a_process_that_serves_leaves_ctrl_c_to_its_parent_and_ends_with_it(monkeypatch, tmp_path):
    """The parent's end is what the connection waits for; then the folder goes, and the process with code 1."""
    from multiprocessing import connection

    kept = {name: signal.getsignal(name) for name in (signal.SIGINT, signal.SIGHUP)}
    told = []
    monkeypatch.setattr("multiprocessing.parent_process", lambda: SimpleNamespace(sentinel="its end"))
    monkeypatch.setattr(connection, "wait", lambda of: told.append(("waits", of)))
    monkeypatch.setattr(processes, "_remove_after_the_end", lambda folder: told.append(("removes", folder)))
    monkeypatch.setattr(os, "_exit", lambda code: told.append(("ends", code)))
    try:
        for scratch in (str(tmp_path), ""):
            processes.settle(scratch).join(5.0)
            assert signal.getsignal(signal.SIGINT) == signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
            removed = [("removes", scratch)] if scratch else []
            assert told == [("waits", ["its end"]), *removed, ("ends", 1)]
            told.clear()
    finally:
        for name, handler in kept.items():
            signal.signal(name, handler)


def test_a_process_begins_with_its_module_and_waits_for_its_parent_at_the_end(monkeypatch):
    told = []
    monkeypatch.setattr(
        processes, "settle", lambda folder: SimpleNamespace(join=lambda _: told.append(("left", folder)))
    )
    monkeypatch.setitem(sys.modules, "served_here", SimpleNamespace(serve=noted(told)))
    processes._begin("served_here", "connection", "folder")
    assert told == [("connection", "folder"), ("left", "folder")]
