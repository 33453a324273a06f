"""What is kept on disk comes back bit for bit or not at all, and the store stays within its size."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from fegear.base import store as store_module
from fegear.base.cache_keys import content_key
from fegear.base.plain import pack, unpack
from fegear.base.solution_cache import Account, Codec, SolutionCache, cache_on_disk
from fegear.base.store import Store, cache_folder
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack

COARSE = MeshSettings().scaled(2.0)

plain = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**70), 2**70)
    | st.floats(allow_nan=False)
    | st.text()
    | hnp.arrays(st.sampled_from([np.float64, np.int32, np.bool_]), hnp.array_shapes(min_dims=0, min_side=0)),
    lambda inner: st.lists(inner) | st.lists(inner).map(tuple) | st.dictionaries(st.text() | st.integers(), inner),
    max_leaves=12,
)


def same(a, b) -> bool:
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    if isinstance(a, (list, tuple)):
        return type(a) is type(b) and len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, dict):
        return list(a) == list(b) and all(same(a[k], b[k]) for k in a)
    return type(a) is type(b) and repr(a) == repr(b)


@given(plain)
def test_packed_data_come_back_bit_for_bit(value):
    assert same(unpack(pack(value)), value)


def test_memory_order_and_special_floats_survive():
    a = np.asfortranarray(np.arange(12.0).reshape(3, 4))
    special = np.array([np.nan, np.inf, -0.0, 5e-324])
    found = unpack(pack({"a": a, "special": special, "texts": np.array(["ä", "bcd"]), "nan": float("nan")}))
    assert found["a"].flags.f_contiguous
    assert found["special"].tobytes() == special.tobytes()
    assert list(found["texts"]) == ["ä", "bcd"]
    assert np.isnan(found["nan"])


@pytest.mark.parametrize("value", [object(), {1, 2}, np.array([object()]), lambda: 0])
def test_nothing_but_plain_data_is_packed(value):
    with pytest.raises(TypeError):
        pack(value)
    with pytest.raises(TypeError):
        content_key(value)


@given(st.binary(max_size=64))
def test_foreign_bytes_are_no_packed_data(data):
    try:
        found = unpack(data)
    except ValueError:
        return
    assert same(unpack(pack(found)), found)  # a few short ones are well formed by chance


def test_keys_tell_content_apart_and_nothing_else():
    tooth = Tooth(20, BasicRack())
    assert content_key(tooth, 1.0) == content_key(Tooth(20, BasicRack()), 1.0)
    assert content_key({"a": 1, "b": 2}) == content_key({"b": 2, "a": 1})
    assert content_key(-0.0) == content_key(0.0)
    different = [1, 1.0, "1", True, None, [1], {"1": 1}, np.array([1]), np.array([1.0]), tooth, Tooth(21, BasicRack())]
    assert len({content_key(item) for item in different}) == len(different)


def test_damaged_entries_are_ignored_and_replaced(tmp_path):
    store = Store(tmp_path)
    key = content_key("x")
    store.write(key, b"payload")
    (place,) = tmp_path.rglob("*.entry")
    whole = place.read_bytes()
    for damaged in (b"", whole[:-1], whole[:20], whole[:-1] + b"X", b"other" + whole):
        place.write_bytes(damaged)
        assert store.read(key) is None
    store.write(key, b"payload")
    assert store.read(key) == b"payload"
    assert store.read(content_key("y")) is None


def test_an_entry_of_another_key_is_not_taken_for_this_one(tmp_path):
    """Somebody renamed or copied it: whole, but the answer to another question."""
    store = Store(tmp_path)
    one, other = content_key("one"), content_key("other")
    store.write(one, b"payload")
    store.write(other, b"of the other")
    places = {path.stem: path for path in tmp_path.rglob("*.entry")}
    places[other].write_bytes(places[one].read_bytes())
    assert store.read(other) is None
    assert store.read(one) == b"payload"
    cache = SolutionCache(store)
    codec = Codec(bytes, bytes)
    assert cache.solve(other, lambda: b"made again", codec).source == "computed"


def test_what_nobody_waits_for_is_written_later_and_is_the_same(tmp_path):
    store, codec = Store(tmp_path), Codec(bytes, bytes)
    cache = SolutionCache(store, at_leisure=True)
    keys = [content_key(i) for i in range(6)]
    for i, key in enumerate(keys):
        cache.solve(key, lambda i=i: bytes([i]), codec)
    assert [key in store for key in keys] == [True, True, False, False, False, False]  # no more than four wait
    assert cache.solve(keys[5], pytest.fail, codec).source == "memory"
    while cache.write_one():
        pass
    assert all(key in store for key in keys)
    assert SolutionCache(store).solve(keys[3], pytest.fail, codec)[::2] == (b"\x03", "disk")
    at_once = SolutionCache(store)
    at_once.solve(content_key("x"), lambda: b"x", codec)
    assert content_key("x") in store
    assert not at_once.write_one()


def test_the_store_drops_what_was_unused_for_longest(tmp_path):
    store = Store(tmp_path, limit=10_000)
    keys = [content_key(i) for i in range(12)]
    for age, key in enumerate(keys[:8]):
        store.write(key, bytes(1000))
        (place,) = tmp_path.rglob(f"{key}.entry")
        os.utime(place, (1e9 + age, 1e9 + age))
    assert store.read(keys[0]) is not None  # now it is the youngest
    for key in keys[8:]:
        store.write(key, bytes(1000))
    sizes = [path.stat().st_size for path in tmp_path.rglob("*.entry")]
    assert 5000 < sum(sizes) <= 10_000
    assert keys[0] in store
    assert keys[11] in store
    assert keys[1] not in store


def test_points_of_the_sweep_that_runs_are_never_dropped(tmp_path):
    """Nor by shapes, which are larger; points of earlier sweeps go first."""
    whole = Store(tmp_path, limit=40_000)
    old, new = ([content_key(kind, i) for i in range(20)] for kind in ("old", "new"))
    for key in old:
        whole.of_points().write(key, bytes(500))
        (place,) = tmp_path.rglob(f"{key}.entry")
        os.utime(place, (1e9, 1e9))
    points = whole.of_points()
    assert points.read(old[7]) is not None  # recalled by the sweep that runs: one of its points
    for i, key in enumerate(new):
        points.write(key, bytes(1000))
        whole.write(content_key("shape", i), bytes(9000))
    points.write(content_key("last"), bytes(1000))
    points._prune()
    assert all(key in points for key in new)  # twice the limit of points
    assert [i for i, key in enumerate(old) if key in points] == [7]
    assert sum(path.stat().st_size for path in tmp_path.glob("??/*.entry")) <= 40_000


def test_a_write_looks_at_the_other_entries_now_and_then_only(tmp_path, monkeypatch):
    looks, within = [], store_module._within
    monkeypatch.setattr(store_module, "_within", lambda folder: (looks.append(folder), within(folder))[1])
    store = Store(tmp_path, limit=1 << 25)
    for i in range(1000):
        store.write(content_key(i), bytes(1500))
    assert 1 <= len(looks) <= 20  # 1000 blocks of 4 KiB, a look for each half MiB


def test_the_limit_holds_for_entries_that_processes_write_one_each(tmp_path):
    sizes = []
    for i in range(300):
        Store(tmp_path, limit=1_000_000).write(content_key("one", i), bytes(9960))
        if i % 10 == 0:
            sizes.append(sum(path.stat().st_size for path in tmp_path.rglob("*.entry")))
    assert 950_000 < max(sizes) < 1_100_000  # 16 kB are between two looks on the average
    assert min(sizes[15:]) > 850_000


def test_scratch_files_of_killed_processes_are_cleared_away(tmp_path):
    store, scratch = Store(tmp_path, limit=10_000), tmp_path / "ab" / ".left"
    scratch.parent.mkdir()
    scratch.write_bytes(b"half an entry")
    store.write(content_key(0), bytes(1000))
    assert scratch.exists()
    os.utime(scratch, (1e9, 1e9))
    store.write(content_key(1), bytes(1000))
    assert not scratch.exists()


def test_the_cache_folder_can_be_chosen(monkeypatch, tmp_path):
    monkeypatch.setenv("FEGEAR_CACHE", str(tmp_path / "here"))
    assert cache_folder() == tmp_path / "here"
    monkeypatch.delenv("FEGEAR_CACHE")
    assert cache_folder().name == "fegear"


def numbers(gear: Gear, cache: SolutionCache | None = None) -> list[bytes]:
    """Every kind of number that a solution gives, solved or read afresh."""
    known = solve_gear(gear, COARSE, cache=cache)
    r = np.linspace(known.lowest_radius, known.highest_radius, 7)
    return [
        known.self_compliance(r, 2e-5).tobytes(),
        known.self_error(r, 2e-5).tobytes(),
        known.neighbour(1, r, r).tobytes(),
        known.neighbour_error(-1, r, r).tobytes(),
        *(known.largest_root_stress(0, side, r)[0].tobytes() for side in ("tension", "compression")),
        known.fillet_stress(1, "tension", r).tobytes(),
    ]


def test_a_shape_is_solved_once_and_read_bit_for_bit(tmp_path):
    gear, larger = (Gear(Tooth(20, BasicRack()), m, 5.0 * m, 1e-3) for m in (1e-3, 2e-3))
    fresh = numbers(gear)
    account = Account()

    def again(which: Gear) -> list[bytes]:
        """With an empty memory: only the disk knows what went before."""
        cache = cache_on_disk(tmp_path)
        found = numbers(which, cache)
        account.add(*cache.shapes.state)
        return found

    assert again(gear) == fresh
    assert (account.computed, account.from_disk) == (1, 0)  # and with it what shows the error
    assert again(gear) == fresh
    assert (account.computed, account.from_disk) == (1, 1)
    assert account.spared > 0.0
    again(larger)  # the same shape in another size
    assert (account.computed, account.from_disk) == (1, 2)
    for place in (tmp_path / "solutions").rglob("*.entry"):
        place.write_bytes(place.read_bytes()[:-5])
    assert again(gear) == fresh
    assert (account.computed, account.from_disk) == (2, 2)


def test_memory_gives_the_very_same_and_forgets_the_unused_first():
    cache, made = SolutionCache(most=2), []

    def solve(key: str) -> tuple[str, str]:
        found = cache.solve(key, lambda: (made.append(key), [key])[1])
        return found.source, found.value[0]

    assert [solve(key)[0] for key in ("a", "b", "a", "c", "a", "b")] == [
        "computed", "computed", "memory", "computed", "memory", "computed",
    ]  # fmt: skip
    assert made == ["a", "b", "c", "b"]
    assert cache.solve("b", list).value is cache.solve("b", list).value


def test_a_failure_is_not_remembered():
    cache = SolutionCache()
    with pytest.raises(ZeroDivisionError):
        cache.solve("a", lambda: 1 / 0)
    assert cache.solve("a", lambda: 1).source == "computed"


def test_what_a_stretch_of_work_uses_again_itself_is_not_counted_as_recalled():
    cache = SolutionCache()
    for _ in range(2):
        cache.solve("a", lambda: 1)
    assert cache.solutions.recalled == 0
    cache.begin()
    cache.solve("a", lambda: 1)
    assert cache.solutions.recalled == 1


def test_a_closed_pipe_is_an_error_after_meshing_too():
    program = (
        "import os\n"
        "from fegear.fem.plane.tooth_meshing import mesh_sector\n"
        "from fegear.fem.plane.settings import MeshSettings\n"
        "from fegear.geometry.external_tooth import Tooth\n"
        "mesh_sector(Tooth(20), 5.0, MeshSettings().scaled(3.0))\n"
        "reader, writer = os.pipe()\n"
        "os.close(reader)\n"
        "try:\n"
        "    os.write(writer, b'x')\n"
        "except BrokenPipeError:\n"
        "    print('told')\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.stdout == "told\n", done.stderr


def test_a_cache_that_cannot_be_written_costs_time_only(tmp_path):
    (tmp_path / "solutions").write_text("a file where the folder should be")
    gear, cache = Gear(Tooth(20, BasicRack()), 1e-3, 5e-3, 1e-3), cache_on_disk(tmp_path)
    assert len(numbers(gear, cache)) == 7
    assert (cache.shapes.computed, cache.shapes.recalled) == (1, 0)


@pytest.mark.parametrize(
    "change",
    [{"poisson_ratio": 0.31}, {"bore": 5.1e-3}, {"plane": "stress"}, {"shift": 0.1}, {"settings": COARSE.scaled(1.1)}],
)
def test_whatever_changes_the_solution_changes_the_key(change):
    from fegear.geometry.gear import Material

    def solve(poisson_ratio=0.3, bore=5e-3, plane="strain", shift=0.0, settings=COARSE):
        gear = Gear(Tooth(20, BasicRack(), shift), 1e-3, bore, 1e-3, Material(2e11, poisson_ratio, 7850.0), plane)
        solve_gear(gear, settings, estimate_error=False, cache=cache)

    cache = SolutionCache()
    solve()
    cache.begin()
    solve(**change)
    assert (cache.shapes.computed, cache.shapes.recalled) == (2, 0)
