"""``fegear.run``: what ``fegear run`` does, from Python and without files."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from fegear.base.errors import InputError, shown
from fegear.base.one_thread import one_thread
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import Scene, build_scene, case_text, parse_document, read_document, set_key
from fegear.case.text_file import named_path
from fegear.engine.executor import Executor
from fegear.engine.plan import make_plan
from fegear.engine.run import Silence, Watcher, run_plan
from fegear.output.progress_bar import watcher
from fegear.results.catalogue import STAGES
from fegear.workbench.given import cache_of, table, taken, texts, working_folder
from fegear.workbench.results import Results


def run(
    case: str | os.PathLike[str] | Mapping[str, Any],
    changes: Mapping[str, Any] | None = None,
    *,
    results: str | Sequence[str] | None = None,
    progress: bool | None = None,
    scheduler: str | None = None,
    cache: SolutionCache | None = None,
) -> Results:
    """Compute what a case asks for.

    Parameters
    ----------
    case : path, TOML text or mapping
        A case file, its text (which has more than one line), or its tables as a mapping.
    changes : mapping of str to object, optional
        Keys of the case that are changed, ``{"pair.I.torque": "100 N*m", "gear.a.teeth": 30}``.
    results : str or sequence of str, optional
        What to ask for in place of the case's own ``results``.
    progress : bool, optional
        Whether a progress bar is shown; by default on a terminal and in a notebook.
    scheduler : str, optional
        Address of a running Dask scheduler; by default points are computed on this machine.
    cache : SolutionCache, optional
        Where results are recalled from and kept. By default nothing is recalled, so that the seconds of a run are its
        own; give the same cache to several runs, or ``fegear.base.solution_cache.cache_on_disk()``.

    Returns
    -------
    Results

    Raises
    ------
    InputError
        If the case cannot be read or anything in it breaks a rule: key, value, rule, remedy.

    Examples
    --------
    >>> import fegear
    >>> found = fegear.run("case.toml", {"pair.I.torque": "100 N*m"})
    >>> found.values["I.te_peak_to_peak"]
    >>> found.tables["transmission_error_I"].to_pandas()
    """
    wanted = table(changes, "changes") | ({} if results is None else {"results": texts(results, "results")})
    if scheduler is not None and not isinstance(scheduler, str):
        raise InputError("scheduler", shown(scheduler), "is not a valid address", 'for example "tcp://10.0.0.5:8786"')
    return run_scene(_scene(case, wanted), progress=progress, scheduler=scheduler, cache=cache_of(cache))


def run_scene(
    scene: Scene, *, progress: bool | None = None, scheduler: str | None = None, cache: SolutionCache | None = None
) -> Results:
    """Compute what a scene asks for; see `run`."""
    plan = make_plan(scene, STAGES)
    known = SolutionCache() if cache is None else cache
    with one_thread(), _watching(progress) as watching:
        return Results.of(run_plan(scene, plan, watching, cache=known, executor=Executor(scheduler)))


def _scene(case: str | os.PathLike[str] | Mapping[str, Any], changes: Mapping[str, Any]) -> Scene:
    name, folder, text = "case", working_folder(), ""
    if isinstance(case, str) and "\n" in case:
        document, text = parse_document(case, "(a text)"), case
    elif isinstance(case, (str, os.PathLike)):
        path = named_path(os.fspath(case), "case")
        document, name, folder, text = read_document(path), path.stem, path.parent, case_text(path)
    elif isinstance(case, Mapping):
        document = taken(case, "case")
    else:
        raise InputError(
            "case",
            shown(case),
            "is not a case",
            "specify the path of a case file, its text, or its tables as a mapping",
        )
    for key, value in changes.items():
        set_key(document, key, value, "changes")
    changed = "".join(f"# changed: {key} = {value}\n" for key, value in changes.items())
    return replace(build_scene(document, name, folder), text=changed + text if text else "")


@contextlib.contextmanager
def _watching(progress: bool | None) -> Iterator[Watcher]:
    """Who shows the progress: a bar on a terminal and in a notebook, no one elsewhere."""
    notebook = "ipykernel" in sys.modules
    if progress is False or (progress is None and not notebook and not sys.stderr.isatty()):
        yield Silence()
        return
    with watcher(sys.stderr, notebook=notebook) as watching:
        yield watching
