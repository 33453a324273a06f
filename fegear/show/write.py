"""Write everything that a run leaves behind into one folder."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.show.dataset import write_dataset
from fegear.show.folder import SUMMARY, files_in
from fegear.show.summary import write_summary
from fegear.show.tables import write_table

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.scene.run import Results


def write_results(results: Results, folder: Path) -> None:
    """Write tables, dataset and summary.

    Parameters
    ----------
    results : Results
    folder : Path
        An empty folder.
    """
    tables = folder / "tables"
    tables.mkdir()
    for table in results.tables:
        write_table(tables, table)
    write_dataset(folder / "results.nc", results)
    write_summary(folder / SUMMARY, results, [*files_in(folder), SUMMARY])
