"""Odd teeth of gears with a width: which solutions a pair reads, what is refused, what is said of cracks."""

from dataclasses import dataclass
from types import SimpleNamespace

import pytest

from fegear.base.errors import InputError
from fegear.case.built import odd_gears, odd_solid_teeth
from fegear.contact.wide import over_revolution
from fegear.engine.stage import Task
from fegear.results.gear import odd_solid_gear
from fegear.results.gear.odd_solid_gear import needs_odd_solid, odd_solid_of
from fegear.results.pair import odd_flanks


@pytest.fixture
def scene(monkeypatch):
    """Pair I: `p` with a cracked tooth drives `w` with a pit; both count."""
    for place in (odd_flanks,):
        monkeypatch.setattr(place, "odd_gears_in", lambda scene, name: ("p", "w"))
        monkeypatch.setattr(place, "reshaped_solid_gears", lambda scene: ("p", "q"))
        monkeypatch.setattr(place, "gear_name", lambda scene, name, member: {"driver": "p", "driven": "w"}[member])
    return SimpleNamespace(
        case=SimpleNamespace(effects=SimpleNamespace(misalignment=False, relief=True)), pairs={"I": "pair"}
    )


@pytest.mark.parametrize(("misalignment", "bent", "more"), [(True, True, 1), (True, False, 0), (False, True, 0)])
def test_a_pair_needs_its_odd_gears_its_ordinary_ones_and_shafts_that_bend(
    scene, monkeypatch, misalignment, bent, more
):
    scene.case.effects.misalignment = misalignment
    monkeypatch.setattr(odd_flanks, "on_shafts", lambda scene, name: bent)
    found = odd_flanks._needs(scene, "I")
    assert [task.subject for task in found[:2]] == ["p", "w"]
    assert [task.stage == odd_solid_gear.ODD_SOLID for task in found[:2]] == [True, False]
    assert found[2:] == (odd_flanks.SHAFTS,) * more


def test_both_gears_take_their_own_solutions_and_the_gaps_of_shafts(monkeypatch):
    asked = []
    monkeypatch.setattr(over_revolution, "revolving_flanks", lambda *given: asked.append(given) or "revolving")
    spec = SimpleNamespace(gears=("p", "w"), name="I", on=lambda gaps: SimpleNamespace(gears=("p", "w"), gaps=gaps))
    odd = SimpleNamespace(fine="fine p", coarse="coarse p")
    plain = SimpleNamespace(fine="fine w", coarse=None)
    monkeypatch.setattr(odd_flanks, "solid_solution_of", lambda upstream, gear: upstream[Task("solid-solution", gear)])
    upstream = {Task(odd_solid_gear.ODD_SOLID, "p"): odd, Task("solid-solution", "w"): plain}
    work = SimpleNamespace(cache="cache")
    fine, coarse = {"driver": "fine p", "driven": "fine w"}, {"driver": "coarse p", "driven": "fine w"}
    for estimates in (True, False):
        given = SimpleNamespace(spec=spec, estimates=estimates)
        assert odd_flanks._compute(given, upstream, work) == "revolving"
        assert asked.pop() == (spec, fine, coarse if estimates else None, "cache")
    upstream[odd_flanks.SHAFTS] = SimpleNamespace(gaps_of=lambda name: f"gaps of {name}")
    odd_flanks._compute(given, upstream, work)
    assert asked.pop()[0].gaps == "gaps of I"
    assert odd_solid_of(upstream, "p") is odd
    assert needs_odd_solid("p", "w", "p") == (Task(odd_solid_gear.ODD_SOLID, "p"), Task(odd_solid_gear.ODD_SOLID, "w"))


def test_flanks_of_odd_gears_have_their_teeth_and_others_stay(scene, monkeypatch):
    @dataclass(frozen=True)
    class Flank:
        gear: str
        odd: object = ()
        profiles: object = ()

    @dataclass(frozen=True)
    class Asked:
        spec: object
        neglected: bool = True

    @dataclass(frozen=True)
    class Spec:
        driver: Flank
        driven: Flank

        @property
        def both(self):
            return self.driver, self.driven

    monkeypatch.setattr(odd_flanks, "odd_gears_in", lambda scene, name: ("w",))
    monkeypatch.setattr(odd_flanks, "pair_spec", lambda scene, name: Spec(Flank("p"), Flank("w")))
    monkeypatch.setattr(
        odd_flanks, "odd_teeth_of", lambda scene, gear: SimpleNamespace(flanks=f"flanks {gear}", profiles="profiles")
    )
    monkeypatch.setattr(odd_flanks, "AskedOfTeeth", SimpleNamespace(of=lambda scene, spec, more: Asked(spec)))
    found = odd_flanks._inputs(scene, "I")
    assert not found.neglected
    assert found.spec == Spec(Flank("p"), Flank("w", "flanks w", "profiles"))


@pytest.mark.parametrize("relief", [True, False])
def test_profiles_of_single_teeth_are_built_where_reliefs_count_and_said_where_not(scene, monkeypatch, relief):
    built = []
    profile = SimpleNamespace(built_on=lambda flank, pair, member: built.append((pair, member)))
    for check in ("check_odd_teeth", "check_wide_pair", "check_odd_wide_pair"):
        monkeypatch.setattr(odd_flanks, check, lambda given, name, check=check: built.append((given is scene, name)))
    monkeypatch.setattr(
        odd_flanks, "odd_teeth_of", lambda scene, gear: SimpleNamespace(profiles=((3, profile),) * (gear == "w"))
    )
    scene.case.effects.relief = relief
    odd_flanks._check(scene, "I")
    assert built == [(True, "I")] * 3 + [("pair", "driven")] * relief
    flanks = SimpleNamespace(gear="p", profiles=()), SimpleNamespace(gear="w", profiles=("one",))
    seen = SimpleNamespace(asked=SimpleNamespace(spec=SimpleNamespace(both=flanks, relief=relief)))
    said = [str(one) for one in odd_flanks._remarks(seen)]
    assert [one.partition(":")[0] for one in said] == ["Gear w"] * (not relief)


def test_cracks_are_said_to_close_by_loads_on_their_tooth_or_on_the_next():
    cracks = ((3, SimpleNamespace(back=True)), (4, SimpleNamespace(back=False)))
    seen = SimpleNamespace(asked=SimpleNamespace(teeth=SimpleNamespace(name="p", cracks=cracks)))
    first, second = odd_solid_gear._open(seen)
    assert "loads on tooth 3 close its crack" in first
    assert "crack faces of tooth 4 is neglected" in second


@pytest.mark.parametrize(
    ("twist", "body", "apart"), [(0.0, None, True), (0.1, None, False), (0.0, True, True), (0.0, False, False)]
)
def test_each_odd_tooth_more_adds_a_third_of_a_gear_with_one(monkeypatch, twist, body, apart):
    @dataclass
    class Settings:
        panels: int = 3

    asked = []
    monkeypatch.setattr(odd_solid_gear, "solid_settings_of", lambda scene, name: Settings())
    monkeypatch.setattr(
        odd_solid_gear, "seconds_of_solid_gear", lambda settings, width, **more: asked.append((width, more)) or 10.0
    )
    web = None if body is None else SimpleNamespace(even=body)
    gear = SimpleNamespace(face_width=0.02, module=2e-3, body=web, flank_twist=twist)
    scene = SimpleNamespace(gears={"p": gear}, case=SimpleNamespace(gear={"p": SimpleNamespace(odd_tooth=[1])}))
    one = odd_solid_gear._forecast(scene, "p")
    assert asked == [(pytest.approx(10.0), {"apart": apart, "on_a_web": body is not None})]
    scene.case.gear["p"].odd_tooth = [1, 2, 3]
    assert one.settings == {"panels": 3}
    assert one.seconds == pytest.approx(18.0)
    assert odd_solid_gear._forecast(scene, "p").seconds - one.seconds == pytest.approx(2.0 * one.seconds / 3.0)


# ---- what a case may say ---------------------------------------------------------------------------------------------
def tooth(**keys):
    plain = dict.fromkeys(("hole", "keyway", "broken_at", "tip_diameter", "crack"))
    return SimpleNamespace(reshaped=True, **plain | keys)


@pytest.fixture
def case(monkeypatch):
    """Gear `p` drives `w` in I; whatever is asked for."""
    monkeypatch.setattr(odd_solid_teeth, "check_crack", lambda scene, name, n: scene.checked.append((name, n)))
    monkeypatch.setattr(odd_solid_teeth, "odd_gears_in", lambda scene, pair: scene.odd)
    gears = {name: SimpleNamespace(odd_tooth=[tooth()], internal=False, body=None) for name in "pw"}
    pairs = {"I": SimpleNamespace(driver="p", driven="w", width="solid", halves=1),
             "J": SimpleNamespace(driver="w", driven="x", width="solid", halves=1)}  # fmt: skip
    return SimpleNamespace(
        checked=[], odd=("p",), wide_pairs=("I",), pairs={"I": SimpleNamespace(total_contact_ratio=1.9)},
        case=SimpleNamespace(gear=gears, pair=pairs, effects=SimpleNamespace(corner_contact=False)),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("keys", "key"),
    [
        ({"hole": 1}, "hole"), ({"keyway": 1}, "keyway"), ({"broken_at": 0.02}, "broken_at"),
        ({"tip_diameter": 0.04}, "tip_diameter"),
        ({"crack": SimpleNamespace(crack_faces="closing")}, "crack.crack_faces"),
    ],
)  # fmt: skip
def test_what_only_plane_teeth_can_have_is_refused_by_its_own_key(case, keys, key):
    case.case.gear["p"].odd_tooth = [tooth(crack=SimpleNamespace(crack_faces="open")), tooth(**keys)]
    with pytest.raises(InputError) as refused:
        odd_solid_teeth.check_odd_solid_gear(case, "p")
    assert str(refused.value).startswith(f"gear.p.odd_tooth[1].{key} = ")
    if "tip_diameter" in keys:
        assert "40 mm" in str(refused.value)


def test_rings_holes_and_idlers_are_refused(case):
    part = case.case.gear["p"]
    odd_solid_teeth.check_odd_solid_gear(case, "p")
    assert case.checked == [("p", 0)]
    part.internal = True
    with pytest.raises(InputError, match="internal gears"):
        odd_solid_teeth.check_odd_solid_gear(case, "p")
    part.odd_tooth = [SimpleNamespace(**vars(tooth()) | {"reshaped": False})]
    odd_solid_teeth.check_odd_solid_gear(case, "p")
    part.body = SimpleNamespace(holes=None)
    odd_solid_teeth.check_odd_solid_gear(case, "p")
    part.body = SimpleNamespace(holes=1)
    with pytest.raises(InputError, match=r"body\.holes"):
        odd_solid_teeth.check_odd_solid_gear(case, "p")
    case.odd = ("w",)
    odd_solid_teeth.check_odd_solid_gear(case, "w")
    case.wide_pairs = ("I", "J")
    with pytest.raises(InputError, match="pairs I and J load opposite flanks"):
        odd_solid_teeth.check_odd_solid_gear(case, "w")


@pytest.mark.parametrize(
    ("ratio", "corner", "missing", "fits"),
    [(1.9, False, True, False), (2.0, False, True, True), (1.9, True, True, True), (1.9, False, False, True)],
)
def test_a_missing_tooth_needs_two_others_in_contact_or_corner_contact(case, monkeypatch, ratio, corner, missing, fits):
    flanks = ((1, SimpleNamespace(missing=False)), (2, SimpleNamespace(missing=missing)))
    monkeypatch.setattr(odd_solid_teeth, "odd_teeth_of", lambda scene, gear: SimpleNamespace(flanks=flanks))
    case.pairs["I"].total_contact_ratio, case.case.effects.corner_contact = ratio, corner
    if fits:
        odd_solid_teeth.check_odd_wide_pair(case, "I")
        assert case.checked == [("p", 0)]
    else:
        with pytest.raises(InputError, match=r"total contact ratio 1\.9"):
            odd_solid_teeth.check_odd_wide_pair(case, "I")


def test_slices_and_double_helical_pairs_have_no_odd_teeth(case):
    case.case.pair["I"].width = "slices"
    with pytest.raises(InputError, match="over a revolution"):
        odd_solid_teeth.check_odd_wide_pair(case, "I")
    case.case.pair["I"].width, case.case.pair["I"].halves = "solid", 2
    with pytest.raises(InputError, match=r"gear\.p\.odd_tooth"):
        odd_solid_teeth.check_odd_wide_pair(case, "I")
    case.odd = ()
    odd_solid_teeth.check_odd_wide_pair(case, "I")


def test_reshaped_gears_in_space_are_those_of_pairs_with_a_width():
    effects = SimpleNamespace(is_on=lambda name: True)
    gears = {name: SimpleNamespace(odd_tooth=teeth) for name, teeth in
             (("p", [tooth()]), ("w", [SimpleNamespace(reshaped=False)]), ("x", [tooth()]), ("y", []))}  # fmt: skip
    pairs = {"I": SimpleNamespace(driver="p", driven="w"), "J": SimpleNamespace(driver="p", driven="x")}
    scene = SimpleNamespace(case=SimpleNamespace(gear=gears, pair=pairs, effects=effects), gears=gears,
                            wide_pairs=("I",), plane_pairs=("J",), spur_gears=tuple(gears))  # fmt: skip
    assert odd_gears.odd_gears(scene) == ("p", "w", "x")
    assert odd_gears.reshaped_solid_gears(scene) == ("p",)
    assert odd_gears.reshaped_gears(scene) == ("p", "x")
    assert odd_gears.odd_gears_of(scene, "I") == ()
    assert odd_gears.odd_gears_of(scene, "J") == ("p", "x")
    effects.is_on = lambda name: False
    assert odd_gears.odd_gears(scene) == ()
