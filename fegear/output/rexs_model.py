"""The case as a REXS model, with what a run of it found."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING

import numpy as np

from fegear.exchange.rexs.written import Found
from fegear.exchange.rexs.written_gearbox import model_text
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from fegear.output.export_formats import Request, Written
    from fegear.studies.comparison.compare import Side


def written_rexs(request: Request) -> Written:
    """Write ``<case>.rexs``, and say what it leaves out."""
    date = datetime.now(UTC).isoformat(timespec="seconds")
    text, left_out = model_text(request.scene, date, *(() if request.results is None else (_found(request.results),)))
    path = request.folder / f"{file_name(request.scene.name)}.rexs"
    path.write_text(text, "utf-8")
    return [path], left_out


def _found(results: Side) -> Found:
    """What a run found: numbers that are known, and of tables the columns of such and of names."""
    tables = {
        name: {one.name: one.si for one in table.columns if one.si.dtype.kind != "f" or bool(np.isfinite(one.si).all())}
        for name, table in results.tables.items()
    }
    return Found({name: value.si for name, value in results.values.items() if np.isfinite(value.si)}, tables)
