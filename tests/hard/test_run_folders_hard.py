"""Folders of runs that were cut short, changed or exchanged: compare, export and a run into them say what is wrong.

Each mutation is drawn by its number, so that one that fails can be made again: `mutate(folder, seed)`.
"""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import fegear.cli
from fegear.base.errors import FegearError
from fegear.output.folder import RECORD, whole_or_nothing

CASE = """
results = ["geometry", "load-sharing", "gear-train"]
[gear.a]
teeth = 28
module = "3 mm"
bore_radius = "20 mm"
face_width = "10 mm"
rack = "ISO 53 C"
[pair.I]
driver = "a"
driven = "a"
load = "1000 N"
compliance = { source = "cornell" }
[train]
speeds = ["1000 rpm"]
"""

#: Seconds after which a command is taken to wait for ever.
_PATIENCE = 60
HOSTILE = (
    None, True, [], {}, "", "text", "1e999", "\ud800", "a\nb", -0.0, 1e308, 10**400, "@inf", "@nan", "@nest 30",
    "@nest 300", "@nest 90000", [[1], {"a": None}], {"value": 1.0}, {"value": 1.0, "unit": "mm", "error": []},
    {"value": "1", "unit": "mm", "error": None}, {"value": 1.0, "unit": "furlong", "error": None},
    {"value": 1.0, "unit": ["mm"], "error": None}, {"now": 1}, "../../x", "gear.a", 2**63, "teeth",
)  # fmt: skip
CELLS = (
    "", "nan", "inf", "-inf", "1e999", "text", '"', '""', '"a\nb"', "1_000", "\uff11\uff12", "0x10", "x" * 200_000,
    "1;2", "é", "-0", "1e-320", "+1", " 1 ",
)  # fmt: skip


def written(found: object) -> str:
    """JSON with what Python's writer does not write."""
    text = json.dumps(found)
    text = text.replace('"@inf"', "1e999").replace('"@nan"', "NaN")
    for depth in (30, 300, 90_000):
        text = text.replace(f'"@nest {depth}"', "[" * depth + "]" * depth)
    return text


def places(found: object, path: tuple = ()) -> list[tuple]:
    """Paths of all parts of a tree."""
    parts = found.items() if isinstance(found, dict) else enumerate(found) if isinstance(found, list) else ()
    return [path, *(place for key, part in parts for place in places(part, (*path, key)))]


def change_json(path: Path, draw: random.Random) -> str:
    found = json.loads(path.read_text("utf-8"))
    for _ in range(draw.choice((1, 1, 2, 5))):
        every = [place for place in places(found) if place]
        # results and inputs are read again: most changes there
        near = [place for place in every if place[0] in ("results", "inputs")] or every or [()]
        *way, last = draw.choice(near if draw.random() < 0.8 else every or [()]) or (None,)
        node = found
        for step in way:
            node = node[step]
        kind = draw.randrange(4)
        if last is None or not isinstance(node, (dict, list)):
            found = draw.choice(HOSTILE)
        elif kind == 0:
            del node[last]
        elif kind == 1 and isinstance(node, dict):
            node[draw.choice(("", "teeth", "results", "x" * 300, "now", "value"))] = node.pop(last)
        else:
            node[last] = draw.choice(HOSTILE)
        if not isinstance(found, (dict, list)):
            break
    path.write_text(written(found), "utf-8")
    return "JSON"


def change_table(path: Path, draw: random.Random) -> str:
    rows = [line.split(",") for line in path.read_text("utf-8").splitlines()]
    kind = draw.choice(("cell", "short", "long", "column", "head", "twice", "unit", "rows", "none", "heads", "shuffle"))
    i, j = draw.randrange(len(rows)), draw.randrange(len(rows[0]))
    if kind == "cell":
        for _ in range(draw.choice((1, 3, 30))):
            row = draw.choice(rows)
            row[draw.randrange(len(row))] = draw.choice(CELLS)
    elif kind == "short":
        rows[i] = rows[i][:j]
    elif kind == "long":
        rows[i] += ["1"] * draw.choice((1, 1000))
    elif kind == "column":
        rows = [row[:j] + row[j + 1 :] for row in rows]
    elif kind == "head":
        rows[0][j] = draw.choice(("", "x", "[mm]", "x [", "a [mm] [mm]", "x [furlong]", "z [mm]", '"', *CELLS))
    elif kind == "twice":
        rows[0][j] = rows[0][0]
    elif kind == "unit":
        rows[0][j] = rows[0][j].partition(" [")[0] + draw.choice((" [mm]", " [N]", " [rpm]", ""))
    elif kind == "rows":
        rows = rows[:1] + rows[draw.randrange(1, len(rows) + 1) :]
    elif kind == "none":
        rows = rows[1:]
    elif kind == "heads":
        rows = [[], *rows]
    else:
        body = rows[1:]
        draw.shuffle(body)
        rows[1:] = body
    path.write_text("\n".join(map(",".join, rows)) + draw.choice(("\n", "", "\n\n")), "utf-8")
    return f"table, {kind}"


def change_bytes(path: Path, draw: random.Random) -> str:
    data = path.read_bytes()
    at, to = sorted(draw.randrange(len(data) + 1) for _ in range(2))
    changed: dict[str, Callable[[], bytes]] = {
        "cut": lambda: data[:at],
        "without the middle": lambda: data[:at] + data[to:],
        "twice": lambda: data[:to] + data[at:],
        "noise": lambda: data[:at] + draw.randbytes(draw.choice((1, 3, 100))) + data[at:],
        "noise alone": lambda: draw.randbytes(200),
        "empty": lambda: b"",
        "UTF-16": lambda: data.decode().encode("utf-16"),
        "mark": lambda: b"\xef\xbb\xbf" + data,
        "carriage returns": lambda: data.replace(b"\n", b"\r"),
        "zeros": lambda: b"\0" * 100,
        "nests": lambda: b"[" * 100_000,
        "digits": lambda: b"9" * 100_000,
    }
    name = draw.choice(list(changed))
    path.write_bytes(changed[name]())
    return f"bytes, {name}"


def exchange(path: Path, draw: random.Random) -> str:
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink()
    kind = draw.choice(("pipe", "folder", "itself", "nowhere", "zeros", "gone", "file"))
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind in ("itself", "nowhere", "zeros"):
        path.symlink_to({"itself": path.name, "nowhere": "file not found", "zeros": "/dev/zero"}[kind])
    elif kind == "file":
        path.write_text("")
    return kind


def mutate(folder: Path, seed: int) -> str:
    """Change something in the folder of a run; returns what."""
    draw = random.Random(seed)  # noqa: S311  (no secret)
    tables = sorted((folder / "tables").iterdir())
    kind = draw.randrange(10)
    if kind < 4:
        path, change = folder / "summary.json", change_json
    elif kind < 6:
        path, change = draw.choice(tables), change_table
    elif kind < 8:
        path, change = draw.choice([folder / "summary.json", folder / RECORD, *tables]), change_bytes
    elif kind < 9:
        path, change = draw.choice([folder / "summary.json", folder / RECORD, folder / "tables", *tables]), exchange
    else:
        other = draw.choice(
            ("\n.csv", ".csv", "x" * 200 + ".csv", "ü.csv", "\udcff.csv", "a.csv\u202e.csv", "load.csv")
        )
        path = folder / "tables" / other
        path.write_text(draw.choice(("x,y\n1,2\n", "", "x [mm]\n", "text\na\nb\n")))
        return f"new file {other!r}"
    return f"{path.name}: {change(path, draw)}"


@pytest.fixture(scope="module")
def base(tmp_path_factory):
    """A run, with a table as that of a pair with a width for whom it is exported."""
    folder = tmp_path_factory.mktemp("base")
    (folder / "one.toml").write_text(CASE.replace(', "gear-train"', "").replace('[train]\nspeeds = ["1000 rpm"]\n', ""))
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setattr(sys, "argv", ["fegear", "run", "one.toml", "--no-plots", "-q", "--out", "one"])
        with pytest.raises(SystemExit):
            fegear.cli.main()
    (folder / "one" / "tables" / "load_over_face_I.csv").write_text(
        "z [mm],mean_line_load [N/mm]\n" + "".join(f"{z},{100 + z}\n" for z in range(-5, 6))
    )
    return folder


def command(monkeypatch, capsys, *arguments: object) -> tuple[int, str]:
    """Run the program in this process; whatever it raises but its end is a fault."""

    def give_up(*_: object) -> None:
        raise AssertionError("it waits for ever")

    monkeypatch.setattr(sys, "argv", ["fegear", *map(str, arguments)])
    before = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(_PATIENCE)
    try:
        with pytest.raises(SystemExit) as end:
            fegear.cli.main()
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
    return int(end.value.code or 0), capsys.readouterr().err


def try_one(seed: int, base: Path, folder: Path, monkeypatch, capsys) -> None:
    shutil.copytree(base / "one", folder / "two")
    said = f"seed {seed}: {mutate(folder / 'two', seed)}"
    monkeypatch.chdir(folder)
    both = [base / "one", folder / "two"]
    calls = (
        ("compare", *(both if seed % 2 else both[::-1]), "--no-plots", "-q", "--out", "cmp"),
        ("export", "two", "--format", "rexs", "--out", "exp", "-q"),
    )
    for call in calls:
        try:
            code, err = command(monkeypatch, capsys, *call)
        except BaseException as problem:
            raise AssertionError(f"{said}: {call[0]}: {type(problem).__name__}: {problem}") from problem
        assert code in (0, 1, 2), said
        assert "Traceback" not in err, said
        refused = [line for line in err.splitlines() if line.startswith("fegear: ")]
        assert (len(refused) == 1) == (code == 2), f"{said}: {call[0]} ends with {code}: {err}"
        for word in ("Error:", "codec", "<", "object has no", "NoneType", "unhashable", "not subscriptable"):
            assert word not in err, f"{said}: {err}"
    try:
        with whole_or_nothing(folder / "two") as scratch:
            (scratch / "summary.json").write_text("{}")
    except FegearError:
        pass  # a folder in the place of a file, for example


@pytest.mark.parametrize("seed", [*range(20), 1031, 1077, 1208, 1697, 1725])
def test_a_changed_run_folder_is_read_or_refused_in_a_sentence(seed, base, tmp_path, monkeypatch, capsys):
    try_one(seed, base, tmp_path, monkeypatch, capsys)


@pytest.mark.long
@pytest.mark.parametrize("hundred", range(10))
def test_a_thousand_changed_run_folders(hundred, base, tmp_path, monkeypatch, capsys):
    faults = []
    for seed in range(1000 + 100 * hundred, 1100 + 100 * hundred):
        (tmp_path / str(seed)).mkdir()
        try:
            try_one(seed, base, tmp_path / str(seed), monkeypatch, capsys)
        except AssertionError as fault:
            faults.append(str(fault))
        shutil.rmtree(tmp_path / str(seed), ignore_errors=True)
    assert not faults, "\n".join(faults)
