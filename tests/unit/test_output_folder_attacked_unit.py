"""Nothing is lost in an output folder: not the user's own files, not results when a move fails or is killed."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.output.folder import default_folder, whole_or_nothing
from fegear.output.held_folder import HOLDER, claimed, folder_for
from fegear.output.new_for_old import JOURNAL, RECORD

ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}


def contents(folder: Path) -> dict[str, str]:
    """All files below a folder but fegear's record."""
    found = (p for p in sorted(folder.rglob("*")) if p.is_file() and p.name != RECORD)
    return {p.relative_to(folder).as_posix(): p.read_text() for p in found}


def write(target: Path, files: dict[str, str], *, summary: str | None = "{}", say=lambda sentence: None) -> None:
    """What a command does: some files, and a summary unless it is an export."""
    with whole_or_nothing(target, say=say) as scratch:
        for name, text in (files | ({} if summary is None else {"summary.json": summary})).items():
            (scratch / name).parent.mkdir(exist_ok=True)
            (scratch / name).write_text(text)


def test_a_foreign_summary_removes_nothing(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (tmp_path / "precious").write_text("outside")
    (out / "thesis.tex").write_text("mine")
    listed = {"files": ["thesis.tex", "../precious", str(tmp_path / "precious"), "summary.json"]}
    (out / "summary.json").write_text(json.dumps(listed))
    write(out, {"report.html": "new"})
    assert contents(out) == {
        "thesis.tex": "mine", "report.html": "new", "summary.json": "{}", "summary.kept.json": json.dumps(listed),
    }  # fmt: skip
    assert (tmp_path / "precious").read_text() == "outside"


@pytest.mark.parametrize("content", ["[]", "{", '{"files": 3}', '{"files": {"a": 1, "..": "x", "/etc/passwd": "x"}}'])
def test_a_record_that_is_not_ours_removes_nothing(tmp_path, content):
    out = tmp_path / "out"
    write(out, {"tables/a.csv": "first"})
    (out / RECORD).write_text(content)
    write(out, {"tables/b.csv": "second"})
    found = contents(out)
    assert (found["tables/a.csv"], found["tables/b.csv"]) == ("first", "second")


def test_a_file_that_the_user_put_or_changed_there_is_kept_and_said(tmp_path):
    out, said = tmp_path / "out", []
    out.mkdir()
    (out / "report.html").write_text("the user's own")
    write(out, {"report.html": "first", "tables/a.csv": "first"}, say=said.append)
    assert contents(out)["report.kept.html"] == "the user's own"
    assert len(said) == 1
    assert "report.html" in said[0]
    assert "report.kept.html" in said[0]
    (out / "tables" / "a.csv").write_text("with the user's remarks")
    write(out, {"report.html": "second", "tables/a.csv": "second"}, say=said.append)
    write(out, {"report.html": "third"}, say=said.append)
    assert len(said) == 2
    assert contents(out) == {
        "report.html": "third", "report.kept.html": "the user's own", "summary.json": "{}",
        "tables/a.kept.csv": "with the user's remarks",
    }  # fmt: skip


def test_an_export_leaves_the_results_beside_it(tmp_path):
    out = tmp_path / "out"
    write(out, {"report.html": "run"})
    for text in ("first", "second"):
        write(out, {"a.msh": text}, summary=None)
    assert contents(out) == {"report.html": "run", "summary.json": "{}", "a.msh": "second"}
    write(out, {"report.html": "again"})
    assert contents(out) == {"report.html": "again", "summary.json": "{}"}


@pytest.mark.parametrize("existing", [{}, {"a.csv": "old", "z.csv": "old", "gone.csv": "old"}])
@pytest.mark.parametrize("moves", range(5))
def test_a_move_that_fails_half_way_leaves_all_as_it_was(tmp_path, monkeypatch, existing, moves):
    out = tmp_path / "out"
    out.mkdir()
    (out / "report.html").write_text("the user's own")
    if existing:
        write(out, existing)
    before, replace = contents(tmp_path), Path.replace
    count = 0

    def failing(self, place):
        nonlocal count
        count += str(self).endswith((".csv", ".json")) and "new" in self.parts
        if count == moves + 1:
            count += 1
            raise OSError(errno.EIO, os.strerror(errno.EIO))
        return replace(self, place)

    monkeypatch.setattr(Path, "replace", failing)
    new = {"a.csv": "new", "m.csv": "new", "z.csv": "new", "t/b.csv": "new"}
    with pytest.raises(InputError, match="is not writable \\("):
        write(out, new)
    assert contents(tmp_path) == before
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


KILLED = """
import os, signal, sys
from pathlib import Path
from fegear.output.folder import whole_or_nothing
replace, left = Path.replace, int(sys.argv[2])
def killing(self, place):
    global left
    if "new" in self.parts:
        left -= 1
        if left < 0:
            os.kill(os.getpid(), getattr(signal, sys.argv[3]))
    return replace(self, place)
Path.replace = killing
with whole_or_nothing(Path(sys.argv[1])) as scratch:
    for name in ("a.csv", "b.csv", "summary.json"):
        (scratch / name).write_text("new")
    if left == 0:
        killing(scratch / "a.csv", scratch / "c.csv")
"""


def killed(out: Path, moves: int, by: str = "SIGKILL") -> int:
    program = [sys.executable, "-c", KILLED, str(out), str(moves), by]
    return subprocess.run(program, env=ENVIRONMENT, check=False, capture_output=True).returncode


@pytest.mark.dear("2")
@pytest.mark.parametrize("moves", [0, 2])
def test_what_a_killed_run_left_is_put_right_by_the_next(tmp_path, moves):
    out = tmp_path / "out"
    write(out, {"a.csv": "old", "gone.csv": "old"})
    before = contents(out)
    assert killed(out, moves) == -signal.SIGKILL
    assert len(list(tmp_path.iterdir())) == 2
    with contextlib.suppress(ZeroDivisionError), whole_or_nothing(out):
        assert contents(out) == before
        raise ZeroDivisionError
    assert contents(out) == before
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_the_next_run_beside_it_clears_what_a_killed_one_left(tmp_path):
    assert killed(tmp_path / "first", 0) == -signal.SIGKILL
    assert [p.name for p in tmp_path.iterdir()] == [".fegear-first"]
    write(tmp_path / "second", {})
    assert [p.name for p in tmp_path.iterdir()] == ["second"]


def test_two_runs_at_once_are_refused_with_the_holder(tmp_path):
    out = tmp_path / "out"
    program = (
        "import sys, time\nfrom pathlib import Path\nfrom fegear.output.folder import whole_or_nothing\n"
        "with whole_or_nothing(Path(sys.argv[1])) as scratch:\n"
        "    print('at it', flush=True)\n    sys.stdin.read()\n    (scratch / 'summary.json').write_text('{}')\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", program, str(out)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=ENVIRONMENT
    ) as other:
        assert other.stdout.readline() == b"at it\n"
        with pytest.raises(InputError, match=f"another run .process {other.pid} on"):
            write(out, {})
        write(tmp_path / "elsewhere", {})
        other.communicate(timeout=60)
    assert other.returncode == 0
    write(out, {"a.csv": ""})
    assert set(contents(out)) == {"a.csv", "summary.json"}


def test_folders_of_work_are_held_by_one_at_a_time(tmp_path):
    """Many processes at once: each sees the folder empty, so no two were ever in it together."""
    program = (
        "import sys, time\nfrom pathlib import Path\nfrom fegear.output.held_folder import HeldError, claimed\n"
        "done = 0\n"
        "while done < 20:\n"
        "    try:\n"
        "        with claimed(Path(sys.argv[1])) as folder:\n"
        "            (folder / 'mine').mkdir()\n"
        "            done += 1\n"
        "    except HeldError:\n"
        "        time.sleep(0.0005)\n"
    )
    work = str(folder_for(tmp_path, "x"))
    runs = [subprocess.Popen([sys.executable, "-c", program, work], env=ENVIRONMENT) for _ in range(3)]
    assert [run.wait(timeout=120) for run in runs] == [0, 0, 0]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.dear
def test_a_stop_request_clears_the_scratch_folder_away(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text('results = ["stiffness"]\naccuracy.tolerance = 1e-6\n[gear.a]\nteeth = 20\nmodule = "1 mm"\n')
    run = subprocess.Popen(
        [sys.executable, "-m", "fegear", "run", str(case), "--out", str(tmp_path / "out")],
        env=ENVIRONMENT, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    for _ in range(3000):
        if (tmp_path / ".fegear-out").is_dir():
            break
        time.sleep(0.02)
    run.terminate()
    _, said = run.communicate(timeout=60)
    assert run.returncode == 143
    assert said.endswith("fegear: stopped by SIGTERM; results of earlier runs are unchanged.\n")
    assert [p.name for p in tmp_path.iterdir()] == ["case.toml"]


def test_work_begun_ahead_holds_no_stopped_program_back():
    """A stop in the middle of an import can leave its lock taken; what still imports must not be waited for."""
    program = (
        "import _imp\nfrom fegear.output.report.page import begun\n"
        "_imp.acquire_lock()\nbegun(lambda: __import__('wave'))\nraise SystemExit(143)\n"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False, env=ENVIRONMENT, timeout=60).returncode == 143


@pytest.mark.dear
@pytest.mark.parametrize("number", ["SIGTERM", "SIGINT"])
@pytest.mark.parametrize(
    ("moment", "code", "left"),
    [("platform.node", 7, []), ("Path.rmdir", 0, ["out"])],
    ids=["between making the scratch folder and knowing of it", "half way through its removal"],
)
def test_a_stop_in_the_worst_moment_leaves_no_folder(tmp_path, moment, code, left, number):
    program = (
        "import os, platform, signal, sys\nfrom pathlib import Path\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # ignored in what a shell has put behind
        "from fegear.cli import _heed_requests_to_stop, _Stopped\n"
        "from fegear.output.folder import whole_or_nothing\n"
        "_heed_requests_to_stop()\n"
        f"real, seen = {moment}, []\n"
        "def stopped(*a, **k):\n"
        f"    seen.append(1)\n    os.kill(os.getpid(), signal.{number})\n    return real(*a, **k)\n"
        f"{moment} = stopped\n"
        "try:\n"
        "    with whole_or_nothing(Path(sys.argv[1])) as scratch:\n"
        "        (scratch / 'summary.json').write_text('{}')\n"
        "except (_Stopped, KeyboardInterrupt):\n    sys.exit(7 if seen else 8)\n"
        "sys.exit(0 if seen else 9)\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "out")], check=False, env=ENVIRONMENT, timeout=60
    )
    assert run.returncode == code
    assert [p.name for p in tmp_path.iterdir()] == left


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda out: (out / "tables").write_text(""), "tables is a file"),
        (lambda out: (out / "tables").symlink_to(out.parent), "tables is a link"),
        (lambda out: (out / "plots").symlink_to("nowhere"), "plots is a link"),
        (lambda out: (out / "report.html").mkdir(), "report.html is a folder"),
        (lambda out: (out / "summary.json" / "deep").mkdir(parents=True), "summary.json is a folder"),
    ],
)
def test_what_could_not_be_filled_is_refused_before_work_begins(tmp_path, make, word):
    out = tmp_path / "out"
    out.mkdir()
    make(out)
    begun = False
    with pytest.raises(InputError, match=word), whole_or_nothing(out):
        begun = True
    assert not begun
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_links_to_folders_are_followed_and_dangling_ones_refused(tmp_path):
    real = tmp_path / "deep" / "real"
    real.mkdir(parents=True)
    link = tmp_path / "link"
    link.symlink_to(real)
    write(link, {"a.csv": "1"})
    assert set(contents(real)) == {"a.csv", "summary.json"}
    assert link.is_symlink()
    link.unlink()
    link.symlink_to(tmp_path / "nowhere")
    with pytest.raises(InputError, match="is a link to something that does not exist"):
        write(link, {})
    link.unlink()
    link.symlink_to(link)
    with pytest.raises(InputError):
        write(link, {})


@pytest.mark.skipif(not os.access("/dev/shm", os.W_OK), reason="there is no second file system")  # noqa: S108
def test_a_folder_on_another_file_system_works(tmp_path):
    """A mount point: the scratch folder must lie in it, not beside it. Here it is its parent that lies elsewhere."""
    import tempfile

    from fegear.output.folder import _workplace

    assert _workplace(Path("/dev/shm"))[0] == Path("/dev/shm")  # noqa: S108
    with tempfile.TemporaryDirectory(dir="/dev/shm") as other:
        out = tmp_path / "out"
        out.symlink_to(other)
        for text in ("first", "second"):
            write(out, {"tables/a.csv": text})
        assert contents(Path(other)) == {"tables/a.csv": "second", "summary.json": "{}"}


def test_a_full_disk_is_one_sentence_and_the_old_results_stay(tmp_path):
    out = tmp_path / "out"
    write(out, {"a.csv": "old"})
    before = contents(tmp_path)

    def fill(scratch: Path) -> None:
        (scratch / "a.csv").write_text("new")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with pytest.raises(InputError, match="No space left on device"), whole_or_nothing(out) as scratch:
        fill(scratch)
    assert contents(tmp_path) == before


def test_a_journal_that_is_not_ours_does_no_harm(tmp_path):
    out, precious = tmp_path / "out", tmp_path / "precious"
    precious.write_text("x")
    write(out, {"a.csv": "old"})
    work = folder_for(tmp_path, "out")
    (work / "old").mkdir(parents=True)
    (work / HOLDER).write_text("")
    journal = {"made": {"../precious": "0" * 64, "a.csv": "0" * 64}, "kept": {"b.csv": "../precious", "c": "a.csv"}}
    (work / JOURNAL).write_text(json.dumps(journal))
    write(out, {"b.csv": "new"})
    assert precious.read_text() == "x"
    assert "b.csv" in contents(out)


def test_a_case_never_writes_into_the_folder_above():
    for stem in ("..", ".", "", "/", "a/../../b"):
        folder = default_folder(stem)
        assert folder.parent == Path("results")
        assert folder.name not in ("", ".", "..")
    assert default_folder("nasa_four_square", "_sweep") == Path("results/nasa_four_square_sweep")


def test_a_claim_of_a_folder_that_cannot_be_made_is_an_error(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="Not a directory"), claimed(folder_for(tmp_path / "file", "x")):
        pass


def hostile_scratch(mine: Path, work: Path, kind: str) -> None:
    """What stands where fegear wants to work: somebody else's, by one way or another."""
    if kind == "the folder is a link":
        work.symlink_to(mine)
    elif kind == "the folder is a link to a folder with a holder's file":
        (mine / HOLDER).write_text("{}")
        work.symlink_to(mine)
    elif kind == "the holder's file is a link":
        work.mkdir()
        (work / HOLDER).symlink_to(mine / "thesis.tex")
    elif kind == "the folder is somebody else's":
        mine.rename(work)
        mine.symlink_to(work)  # so that it is looked for in one place
    else:
        work.mkdir()
        (work / HOLDER).write_text("{}")
        (work / kind).symlink_to(mine)


@pytest.mark.parametrize(
    "kind",
    [
        "the folder is a link", "the folder is a link to a folder with a holder's file", "the holder's file is a link",
        "the folder is somebody else's", "new", "old",
    ],
)  # fmt: skip
def test_a_link_where_fegear_works_costs_nobody_a_file(tmp_path, kind):
    """`ln -s $PWD/mine .fegear-out` had a run empty the folder that the link leads to, with exit code 0."""
    out, mine = tmp_path / "out", tmp_path / "mine"
    for folder in (out, mine):
        folder.mkdir()
        (folder / "thesis.tex").write_text("three years")
    (mine / "figures").mkdir()
    (mine / "figures" / "a.csv").write_text("measured")
    hostile_scratch(mine, folder_for(tmp_path, "out"), kind)
    with contextlib.suppress(InputError):
        write(out, {"a.csv": "new"})
    write(tmp_path / "beside", {})  # which clears what others left
    assert {"thesis.tex": "three years", "figures/a.csv": "measured"}.items() <= contents(mine).items()
    assert contents(out)["thesis.tex"] == "three years"
    if kind not in ("new", "old"):
        with pytest.raises(InputError, match=r"is not writable .*; choose another folder with --out\.$"):
            write(out, {"a.csv": "new"})


def test_a_sweep_follows_no_link_where_it_works(tmp_path):
    """`sweep` emptied the folder behind the link, too, even where it then refused."""
    case, mine = tmp_path / "case.toml", tmp_path / "mine"
    case.write_text('results = ["geometry"]\n[gear.a]\nteeth = 20\nmodule = "1 mm"\n')
    mine.mkdir()
    (mine / "thesis.tex").write_text("three years")
    folder_for(tmp_path, "out").symlink_to(mine)
    command = [sys.executable, "-B", "-m", "fegear", "sweep", str(case), "--over", "gear.a.teeth=20,21", "--out", "out"]
    done = subprocess.run(
        command, cwd=tmp_path, env=ENVIRONMENT, capture_output=True, text=True, check=False, timeout=120
    )
    assert done.returncode == 2, done.stderr
    assert "choose another folder with --out." in done.stderr
    assert contents(mine) == {"thesis.tex": "three years"}


@pytest.mark.skipif(sys.platform != "linux", reason="limits of file sizes are set through the resource module")
def test_a_file_that_may_not_grow_is_one_sentence_and_the_old_results_stay(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text('results = ["geometry"]\n[gear.a]\nteeth = 20\nmodule = "1 mm"\n')
    out = tmp_path / "out"
    write(out, {"report.html": "old"})
    before = contents(out)
    program = (
        "import resource, sys\nresource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))\n"
        "from fegear.__main__ import main\nsys.argv[0] = 'fegear'\nmain()\n"
    )
    command = [sys.executable, "-B", "-c", program, "run", str(case), "--out", str(out), "--no-plots"]
    done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1].startswith("fegear: --out = ")
    assert "File too large" in done.stderr
    assert "Traceback" not in done.stderr
    assert contents(out) == before


@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT"])
def test_a_stop_request_that_comes_while_an_import_lets_go_of_its_lock_is_heard(name):
    """It was raised in a callback of a weak reference, printed and lost, and all later ones were ignored."""
    script = f"""
import signal, time, weakref
from fegear import cli
signal.signal(signal.SIGINT, signal.default_int_handler)  # background jobs ignore it
cli._heed_requests_to_stop()
class Lock: pass
code = compile("def ends(_): signal.raise_signal(signal.{name}); [None for _ in range(9)]",
               "<frozen importlib._bootstrap>", "exec")
exec(code)
try:
    lock = Lock()
    kept = weakref.ref(lock, ends)
    del lock
    for _ in range(200): time.sleep(0.05)
    print("went on")
except cli._Stopped as stopped:
    print(stopped.name)
except KeyboardInterrupt:
    print("SIGINT")
"""
    run = subprocess.run(
        [sys.executable, "-c", script], check=False, capture_output=True, text=True, env=ENVIRONMENT, timeout=60
    )
    assert (run.stdout, run.stderr) == (f"{name}\n", "")
