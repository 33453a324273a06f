"""Two gears in mesh, in a script."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fegear.base.errors import InputError, shown
from fegear.base.solution_cache import SolutionCache
from fegear.case.pair import PairPart
from fegear.case.reading import build_scene
from fegear.results.pair.root_stress_history import table_names
from fegear.workbench.gear import Described, Gear
from fegear.workbench.given import name_of, table, taken, working_folder
from fegear.workbench.quantities import Length, brief
from fegear.workbench.results import Results
from fegear.workbench.signature import takes_keys_of

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping
    from pathlib import Path

    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.unloaded.pair import HelicalPair
    from fegear.geometry.pair import GearPair, Member

_MEMBERS: tuple[Member, ...] = ("driver", "driven")


@takes_keys_of(PairPart)
class Pair(Described):
    """Two gears in mesh by the keys of ``[pair.NAME]`` of a case file, every one of them; it never changes.

    Parameters
    ----------
    driver, driven : Gear
        The gear that pushes and the one that is pushed; the same one twice where a gear meshes with its like.
    centre_distance : str, quantity or float, optional
        By default the one that the profile shifts give without backlash.
    compliance : str or mapping
        Where tooth compliances come from: ``"fe"`` (finite elements), ``"weber-banaschek"``, ``"cornell"``,
        ``"potential-energy"``, ``"potential-energy-simplified"`` (tooth without fillet), or a mapping as in a case.
    name : str
        In names of results.
    load_distribution : mapping, optional
        How finely its flanks are divided where it is loaded with its width, as the table ``[load_distribution]`` of a
        case file: ``{"positions": 24, "panels": 16}``.
    **keys
        All others of a case file, as there: ``width``, ``root_stress``, ``misalignment``, ``axial_offset``,
        ``iso_6336``, ``lubricant``, ...; the signature of ``fegear.Pair`` has each, ``help(fegear.Pair)`` what it is.

    Attributes
    ----------
    known : SolutionCache
        What has been solved for it; the questions about it recall from there and keep there.

    Raises
    ------
    InputError
        If the gears cannot mesh: key, value, rule, remedy.
    """

    def __init__(
        self,
        driver: Gear,
        driven: Gear,
        centre_distance: Length | None = None,
        *,
        compliance: str | Mapping[str, Any] = "fe",
        name: str = "I",
        load_distribution: Mapping[str, Any] | None = None,
        **keys: Any,
    ) -> None:
        for role, gear in (("driver", driver), ("driven", driven)):
            if not isinstance(gear, Gear):
                raise InputError(role, shown(gear), "must be a fegear.Gear", f'set {role} = fegear.Gear(20, "3 mm")')
        self.driver, self.driven = driver, driven
        self.name = name_of(name)
        source = {"source": compliance} if isinstance(compliance, str) else table(compliance, "compliance")
        given = {} if centre_distance is None else {"centre_distance": centre_distance}
        self._keys: dict[str, Any] = taken({**given, "compliance": source, **keys}, f"pair.{self.name}")
        self._divided = table(load_distribution, "load_distribution")
        self.known = SolutionCache()
        self._scene  # noqa: B018  (a pair that cannot be is refused where it is described)

    @property
    def names(self) -> tuple[str, str]:
        """Names of driver and driven in the results; different gears of one name are called driver and driven."""
        if self.driver.name == self.driven.name and self.driver != self.driven:
            return "driver", "driven"
        return self.driver.name, self.driven.name

    def document(self, **load: Any) -> dict[str, Any]:
        """Its gears and itself as the tables of a case file, with the keys of its load."""
        driver, driven = self.names
        gears = {driver: self.driver.keys, driven: self.driven.keys}
        pair = {"driver": driver, "driven": driven, **self.keys, **taken(load, f"pair.{self.name}")}
        wide = not self.driver.is_spur or pair.get("width", "plane") != "plane"
        if wide and pair["compliance"] == {"source": "fe"}:
            del pair["compliance"]  # gears with a width are solved so, and know no other source
        divided = {"load_distribution": self._divided} if self._divided else {}
        return {"gear": gears, "pair": {self.name: pair}, **divided}

    def spec(self, **keys: Any) -> PairSpec:
        """What the mechanics takes of it, with the effects that its description calls for.

        `fegear.contact.load.load` makes a loaded pair of it and of both gears solved.

        Parameters
        ----------
        **keys
            Its load, and whatever else of ``[pair.NAME]``: ``torque="90 N*m"``.
        """
        from fegear.case.built.pair_spec import pair_spec

        document = {"results": ["geometry"], "effects": {"start": "described"}, **self.document(**keys)}
        return pair_spec(build_scene(document, self.name, working_folder(), bare_si=True), self.name)

    @property
    def is_spur(self) -> bool:
        """Whether its teeth are straight."""
        return self.name in self._scene.spur_pairs

    @property
    def is_wide(self) -> bool:
        """Whether it is loaded with its width: helical pairs are, spur ones by their key ``width``."""
        return self.name in self._scene.wide_pairs

    @property
    def geometry(self) -> GearPair:
        """The pair of the geometry package, spur or helical, in SI throughout."""
        return self._scene.pairs[self.name]

    @property
    def flanks(self) -> HelicalPair:
        """The flanks of the pair with errors and modification, for tooth contact analysis.

        Raises
        ------
        InputError
            If the gears are described without a helix angle; one of zero is enough.
        """
        if self.name not in self._scene.helical_pairs:
            raise InputError(
                "helix_angle", "(not given)", "is required for tooth contact analysis",
                'specify both gears with normal_module, helix_angle = "0 deg" and hand = "spur"',
            )  # fmt: skip
        return self._scene.helical_pairs[self.name]

    def export(self, folder: str | os.PathLike[str], formats: str | list[str] = "dxf") -> list[Path]:
        """Write drawings and meshes of both gears, as ``fegear export`` does; see `Results.export`."""
        return self.data.export(folder, formats)

    def relieved(self, design: Results, shape: str = "designed") -> Pair:
        """The pair with a relief that `fegear.relief` or `fegear.flank_design` found for it.

        Parameters
        ----------
        design : Results
            Of `fegear.relief` or `fegear.flank_design` for this pair.
        shape : str
            ``"designed"``, the relief of the tables (plane teeth only), or ``"linear"`` or ``"parabolic"``: the tip
            reliefs that a shop can grind, also by their names in tables, ``"linear tip relief"``. Of `flank_design` a
            design of its grinding table, ``"profile-and-lead"``: lead and twist are replaced, too, where it has any.

        Returns
        -------
        Pair
            Its gears carry the relief in place of their own.

        Raises
        ------
        InputError
            If the design has no such relief.
        """
        from fegear.results.relief.applied_design import MODIFIED

        if not isinstance(design, Results):
            raise InputError("design", shown(design), "is not a relief design", "pass the result of fegear.relief")
        if not isinstance(shape, str):
            raise InputError("shape", shown(shape), "must be a text", 'for example "linear"')
        shape = shape.removesuffix(" tip relief")
        labels = table_names(design.scene, self.name)
        flanks = {member: _flank_keys(design, self.name, member, labels[member], shape) for member in _MEMBERS}
        replaced = MODIFIED if any(flank.keys() - {"relief"} for flank in flanks.values()) else ("relief",)
        driver, driven = (
            Gear.of(name, {**{k: v for k, v in gear.keys.items() if k not in replaced}, **flank})
            for name, gear, flank in zip(_apart(self.names), (self.driver, self.driven), flanks.values(), strict=True)
        )
        keys = {key: value for key, value in self.keys.items() if key != "compliance"}
        made = Pair(driver, driven, compliance=self.keys["compliance"], name=self.name,
                    load_distribution=self._divided, **keys)  # fmt: skip
        made.known = self.known  # relief changes no tooth shape: they are solved already
        return made

    def __eq__(self, other: object) -> bool:
        """Whether two pairs are described alike."""
        if not isinstance(other, Pair):
            return False
        described, others = (
            (one.name, one.driver, one.driven, one._keys, one._divided) for one in (self, other)  # noqa: SLF001  (two of one class)
        )  # fmt: skip
        return described == others

    def __hash__(self) -> int:
        """By its names: pairs that are alike have one place in a set."""
        return hash((self.name, self.driver.name, self.driven.name))

    def __repr__(self) -> str:
        """As it was described."""
        divided = {"load_distribution": self._divided} if self._divided else {}
        given = "".join(f", {key}={brief(value)}" for key, value in {**self.keys, "name": self.name, **divided}.items())
        return f"Pair({self.driver!r}, {self.driven!r}{given})"

    def _repr_html_(self) -> str:
        """Show the gears and the pair's data in a notebook."""
        from fegear.workbench.drawn_gears import pair_html

        return pair_html(self.data)


def _apart(names: tuple[str, str]) -> tuple[str, str]:
    """Names of two gears that were one and no longer are."""
    return names if names[0] != names[1] else ("driver", "driven")


def _flank_keys(design: Results, pair: str, member: Member, label: str, shape: str) -> dict[str, Any]:
    """One gear's flank modifications as a case file has them, in SI."""
    names = list(design.tables.keys())
    if shape == "designed" and f"relief_{label}" in names:
        table = design.tables[f"relief_{label}"]
        places, removals = table.column("roll_angle").si.tolist(), table.column("relief").si.tolist()
        return {"relief": {"table": {"roll_angles": places, "removals": removals}}}
    if f"grindable_{pair}" not in names:  # teeth with a width
        return _ground_over_face(design, pair, label, shape)
    ground = design.tables[f"grindable_{pair}"]
    rows = (ground["shape"] == shape) & (ground["gear"] == member)
    if not rows.any():
        known = ", ".join(f'"{one}"' for one in ["designed", *dict.fromkeys(ground["shape"].tolist())])
        raise InputError("shape", f'"{shape}"', "is not one of the designed reliefs", f"choose from {known}")
    amount, start = (float(ground.column(key).si[rows][0]) for key in ("amount", "start_roll_angle"))
    return {"relief": {"tip": {"amount": amount, "start_roll_angle": start, "shape": shape}}}


def _ground_over_face(design: Results, pair: str, label: str, shape: str) -> dict[str, Any]:
    """One gear's modifications of the grinding table, where the design has no relief by theory."""
    from fegear.results.relief.applied_design import EXACT, designs_of, keys_of_design

    tables = {table.name: table for table in design.tables}
    known = [one for one in designs_of(tables, pair) if one != EXACT]
    chosen = shape if shape in known else f"{shape} tip relief"
    if chosen not in known:
        words = ", ".join(f'"{one.removesuffix(" tip relief")}"' for one in known)
        remedy = f"choose from {words}" if words else "pass the result of fegear.relief"
        raise InputError("shape", f'"{shape}"', "is not one of the designed reliefs", remedy)
    driver, driven = design.scene.case.pair[pair].driver, design.scene.case.pair[pair].driven
    keys = keys_of_design(tables, pair, (driver, driven), chosen)
    return dict(keys[label.removeprefix(f"{pair}_")])
