"""What a run found, in a script or a notebook: shown, turned into tables of other libraries, drawn, saved."""

from __future__ import annotations

import io
import tempfile
import textwrap
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import NOTEBOOK_EXTRA, PATH, InputError, MissingLibraryError, shown
from fegear.base.notes import counted, open_and_folded
from fegear.engine.html_table import html_table
from fegear.engine.named import Named
from fegear.engine.run import Results as Found
from fegear.engine.run import Silence
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.output.numbers import pretty_unit
from fegear.output.plane_state import plane_state
from fegear.output.report.blocks import value_cells
from fegear.output.spoken_values import answer_lines
from fegear.workbench.given import folder_of, texts
from fegear.workbench.mesh_curve import angles_of, curve_of, is_secant, load_number
from fegear.workbench.plots import Plots

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

    import pandas as pd
    import xarray as xr
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.workbench.mesh_curve import Kind
    from fegear.workbench.quantities import Torque


#: Sentences and values that the short form shows, values at least, and characters of a remark.
_FEW, _FEWEST, _CLAUSE = 12, 4, 140


def _by_name(data: xr.Dataset, names: dict[str, str]) -> xr.Dataset:
    """A dataset by the names of gears and pairs, which the file has in ASCII."""
    data = data.rename({plain: name for plain, name in names.items() if plain in {*data.variables, *data.dims}})
    for variable in data.variables.values():
        for attribute in ("ancillary_variables", "coordinates"):
            if attribute in variable.attrs:
                variable.attrs[attribute] = names.get(variable.attrs[attribute], variable.attrs[attribute])
    data.attrs.pop("fegear_names", None)
    return data


class Results(Found):
    """Everything that a run found: single values, tables, figures and remarks, each by its name.

    A number is in the unit that stands beside it; ``.si`` has it in SI, ``.quantity`` with the unit attached.

    Attributes
    ----------
    values, tables, figures : Named
        In order and by name: ``values["I.te_mean"]``, ``tables["transmission_error_I"]``.
    answer : RunAnswer
        What the wanted results come to: ``answer.sentences``, and ``answer.figure``, the key of one figure.
    remarks : tuple of str
        What the user should know: assumptions, neglected effects.
    scene : Scene
        The case with its gears and pairs.
    timings : mapping of Task to Timing
    """

    @classmethod
    def of(cls, found: Found) -> Results:
        """The same results with the handles of this class."""
        return cls(found.scene, found.plan, found.outcomes, found.timings)

    def __getitem__(self, name: str) -> Value | Table:
        """Return a single value or a table by its name.

        Raises
        ------
        UnknownNameError
            With the nearest name.
        """
        both: Named[Value | Table] = Named((*self.values, *self.tables))
        return both[name]

    def _ipython_key_completions_(self) -> list[str]:
        return [*self.values.keys(), *self.tables.keys()]

    def __repr__(self) -> str:
        """What the results come to, values, and what else there is."""
        lines = [f"  {line}" for line in answer_lines(self.answer)]
        few = max(_FEW - len(lines), _FEWEST)
        lines += [f"  {value!r}" for value in self.values[:few]]
        if len(self.values) > few:
            lines.append(f"  ... {len(self.values) - few} more in .values")
        shown, others = open_and_folded(self.notes())
        lines += [f"  Note: {textwrap.shorten(note, _CLAUSE, placeholder=' ...')}" for note in shown]
        if others:
            lines.append(f"  {counted(others)} in .notes()")
        return "\n".join([self._headline(), *lines])

    def _headline(self) -> str:
        found = {word: len(getattr(self, word)) for word in ("values", "tables", "figures")}
        found["notes"] = len(self.notes())
        counts = ", ".join(f"{count} {word if count > 1 else word[:-1]}" for word, count in found.items() if count)
        title = self.scene.case.title or self.scene.name
        plane = f" (2D, {state})" if (state := plane_state(self)) else ""
        return f"{title}{plane}: {counts} ({sum(self.seconds.values()):.2g} s)"

    def _repr_html_(self) -> str:
        """Show values with errors, the names of tables and figures, and the remarks in a notebook."""
        from html import escape

        rows = [(value.name, *value_cells(value), pretty_unit(value.unit), value.meaning) for value in self.values]
        parts = [f"<b>{escape(self._headline())}</b>"]
        parts += [f"<p>{escape(sentence)}</p>" for sentence in self.answer.sentences]
        if rows:
            parts.append(html_table(("value", "", "error", "unit", "meaning"), rows))
        for word, names in (("tables", self.tables.keys()), ("figures", self.figures.keys())):
            if names:
                parts.append(f"<p>{word}: {', '.join(f'<code>{escape(name)}</code>' for name in names)}</p>")
        shown, others = open_and_folded(self.notes())
        parts += [f"<p>{escape(note.kind.words)}: {escape(note)}</p>" for note in shown]
        if others:
            folded = "".join(f"<p>{escape(note.kind.words)}: {escape(note)}</p>" for note in others)
            parts.append(f"<details><summary>{counted(others)}</summary>{folded}</details>")
        return "".join(parts)

    def to_pandas(self) -> pd.DataFrame:
        """All single values: value, error, unit and meaning, by name.

        Raises
        ------
        MissingLibraryError
            If pandas is not installed.
        """
        made = self.values
        columns = {
            "name": [one.name for one in made],
            "value": [one.value for one in made],
            "error": [np.nan if one.error is None else one.error for one in made],
            "unit": [one.unit for one in made],
            "meaning": [one.meaning for one in made],
        }
        table = Table("values", tuple(Column(head, np.array(listed)) for head, listed in columns.items()))
        return table.to_pandas().set_index("name")

    def to_xarray(self, table: str = "") -> xr.Dataset:
        """All tables and values as one labelled dataset, as in ``results.nc``, or one table alone.

        Parameters
        ----------
        table : str, optional
            Name of a table. Its first column is the dataset's dimension, so that
            ``.sel(x=1.5, method="nearest")`` finds a row, unless the column does not rise or fall throughout.

        Raises
        ------
        MissingLibraryError
            If xarray is not installed.
        UnknownNameError
            With the nearest name of a table.
        """
        try:
            import xarray as xr
        except ImportError:
            raise MissingLibraryError(f"xarray is not installed; {NOTEBOOK_EXTRA}.") from None
        from fegear.output.dataset import plain_names, write_dataset

        first = self.tables[table].columns[0].name if table else ""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "results.nc"
            write_dataset(path, self)
            content = io.BytesIO(path.read_bytes())
        whole = _by_name(xr.load_dataset(content, engine="scipy"), plain_names(self))
        if not table:
            return whole
        prefix, indexed = f"{table}.", table in whole.indexes
        names = {f"{prefix}{column.name}": column.name for column in self.tables[table].columns}
        alone = whole[list(names)].drop_vars(table, errors="ignore").rename(names)
        for variable in alone.variables.values():
            if "ancillary_variables" in variable.attrs:
                variable.attrs["ancillary_variables"] = variable.attrs["ancillary_variables"].removeprefix(prefix)
        return alone.swap_dims({table: first}) if indexed else alone.rename_dims({table: "row"})

    def plot(self, *names: str) -> Plots:
        """Figures by name, or all: a notebook shows them; ``.show()`` opens them, ``.save(folder)`` writes them.

        Raises
        ------
        UnknownNameError
            With the nearest name.
        """
        return Plots(tuple(self.figures[name] for name in names) if names else tuple(self.figures))

    def mesh_stiffness(
        self, driver_angle: ArrayLike, pair: str = "", *, kind: Kind | None = None, torque: Torque | None = None,
        secant: bool = False,
    ) -> Array:  # fmt: skip
        """Mesh stiffness at rotations of the driver, for equations of motion: by default the tangent dF/dTE.

        The tangent is the column ``local_stiffness`` of the tables, for vibration about the loaded state. The column
        ``mesh_stiffness`` is the secant, for coordinates from the unloaded position and flanks without modifications;
        ``kind="secant"`` gives it. It is that of the pairs in contact, without the gaps that reliefs, deviations and
        tips off the line of action close first: load over transmission error includes them and is lower. The column
        ``te_0``, and the function `te_0`, have where it is without force: force = secant (deflection - te_0).

        Parameters
        ----------
        driver_angle : array_like
            [rad], or with a unit (``"5 deg"``, quantities of pint); any number of turns: zero where a tooth pair is at
            the pitch point, as `driver_angle` of the table ``transmission_error_<pair>``; of a revolution with odd
            teeth where the first teeth are.
        pair : str
            By default the only pair with a curve.
        kind : {"tangent", "secant"}, optional
            Slope dF/dTE (the default), or load over deflection.
        torque : torque, optional
            On the driver, one of several for which the run was made; the nominal one by default.
        secant : bool
            The same as ``kind="secant"``.

        Returns
        -------
        ndarray
            Periodic, straight between the rows of the table [N/m].

        Raises
        ------
        InputError
            If an angle cannot be read, the torque was not computed, or the results have neither "transmission-error"
            nor "mesh-stiffness-revolution" of that pair.
        """
        of_secant, curve = is_secant(kind, secant=secant), curve_of(self, pair)
        return curve.stiffness(angles_of(driver_angle), secant=of_secant, under=load_number(curve, torque))

    def transmission_error(self, driver_angle: ArrayLike, pair: str = "", *, torque: Torque | None = None) -> Array:
        """Transmission error at rotations of the driver [m], as `mesh_stiffness`."""
        curve = curve_of(self, pair)
        return curve.error(angles_of(driver_angle), under=load_number(curve, torque))

    def te_0(self, driver_angle: ArrayLike, pair: str = "", *, torque: Torque | None = None) -> Array:
        """Transmission error without force at rotations of the driver [m], as `mesh_stiffness`.

        ``mesh_stiffness(angle, kind="secant") * (transmission_error(angle) - te_0(angle))`` is the load at every angle.
        """
        curve = curve_of(self, pair)
        return curve.start(angles_of(driver_angle), under=load_number(curve, torque))

    def save(self, folder: str | os.PathLike[str], *, plots: bool = True) -> Path:
        """Write everything into a folder, as ``fegear run`` does: tables, dataset, pictures, report, summary.

        Parameters
        ----------
        folder : path
            Files of an earlier run in it are replaced; the others stay.
        plots : bool
            Whether to draw the pictures, too.

        Returns
        -------
        Path
            The folder.

        Raises
        ------
        InputError
            If the folder cannot be made or written to.
        """
        from fegear.output.folder import whole_or_nothing
        from fegear.output.run_files import write_results

        target = folder_of(folder)
        with whole_or_nothing(target, "folder") as scratch:
            write_results(self, scratch, Silence(), plots=plots)
        return target

    def save_tables(
        self, folder: str | os.PathLike[str], kinds: str | list[str] = "csv", names: str | Sequence[str] = ()
    ) -> list[Path]:
        """Write tables as CSV, for MATLAB or both, beside the files that a folder has.

        Parameters
        ----------
        folder : path
        kinds : str or list of str
            ``csv``, ``mat`` or both, separated by commas.
        names : str or list of str
            Of the tables; all of them by default.

        Returns
        -------
        list of Path
            The files.

        Raises
        ------
        InputError
            If there is no such kind, or the folder cannot be made or written to.
        """
        from fegear.output.tables import KINDS, table_bytes, table_file

        asked = [kind.strip() for given in texts(kinds, "kinds", "csv") for kind in given.split(",")]
        wanted = texts(names, "names", "transmission_error_I")
        for kind in asked:
            if kind not in KINDS:
                raise InputError("kinds", shown(kind), "is not a format of tables", 'use "csv", "mat" or "csv,mat"')
        tables, target = [self.tables[name] for name in wanted] or list(self.tables), folder_of(folder)
        made = []
        try:
            target.mkdir(parents=True, exist_ok=True)
            for table in tables:
                for kind in asked:
                    made.append(target / Path(table_file(table)).with_suffix(f".{kind}"))
                    made[-1].write_bytes(table_bytes(table, kind))
        except OSError as error:
            raise InputError("folder", shown(str(target), PATH), f"cannot be written ({error.strerror})") from None
        return made

    def apply(self, case: str | os.PathLike[str], relief: str = "", pair: str = "") -> Path:
        """Write a designed relief or lead correction into a case file, as ``fegear apply`` does.

        Parameters
        ----------
        case : path
            Its comments, order and form of the rest stay.
        relief : str
            Design of the grinding table, such as ``"linear"`` or ``"lead correction"``, or ``"exact"``; the best by
            default.
        pair : str
            By default the only pair with a design.

        Returns
        -------
        Path
            The case.

        Raises
        ------
        InputError
            If there is no such design, or the case is of other gears.
        """
        from fegear.case.text_file import read_file, write_file
        from fegear.results.relief.applied_design import applied_design

        path, tables = Path(case), dict(self.tables.items())
        file, source = read_file(path, "case"), f"results of {self.scene.name}"
        found = applied_design(file.text, path, self.scene.document, tables, source, relief, pair)
        write_file(path, file.written(found.text), "case")
        return path

    def export(
        self, folder: str | os.PathLike[str], formats: str | list[str] = "dxf", gears: tuple[str, ...] = ()
    ) -> list[Path]:
        """Write drawings and meshes of the gears, as ``fegear export`` does; a REXS model holds these results, too.

        Parameters
        ----------
        folder : path
        formats : str or list of str
            Names of `fegear.output.export_formats.FORMATS`, or of formats of other distributions, separated by commas.
        gears : tuple of str
            Names of gears; all of them by default.

        Returns
        -------
        list of Path
            The files.

        Warns
        -----
        UserWarning
            Of what the files leave out, relief in meshes for example.
        """
        from fegear.output.export import export_gears
        from fegear.output.folder import whole_or_nothing
        from fegear.studies.comparison.compare import side_of

        kinds, names, target = texts(formats, "formats", "dxf"), texts(gears, "gears", "pinion"), folder_of(folder)
        with whole_or_nothing(target, "folder") as scratch:
            written = export_gears(self.scene, scratch, tuple(names), ",".join(kinds), side_of(self, self.scene.name))
        for remark in written.remarks:
            warnings.warn(remark, stacklevel=2)
        return [target / name for name in written.files]
