"""Stage ``idler-root-stress``: root stress of teeth of an idler, which its mates bend to either side.

The fillet below the flank that the driving mate loads is pulled there, and pressed while the idler drives with its
other flank; both stand at one place. Asymmetric teeth are solved for either flank (`fegear.case.working_flanks`). The
planets of a set have `planet-root-stress`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, cast

from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.case.set_pairs import set_of_pair
from fegear.contact.plane.both_flanks import AlternatingStress
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Stage, Task
from fegear.results import forecasts
from fegear.results.pair.alternating_rows import ALTERNATING, ALTERNATING_VALUES

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry.pair import Member
    from fegear.results.pair.root_stress_history import RootStressData

#: What the rows are, by the role of the gear in the mesh that pulls the fillet.
_FILLETS: dict[Member, tuple[str, str]] = {
    "driven": ("driven_side", "fillet below the flank that its driver loads"),
    "driver": ("driving_side", "fillet below the flank with which it drives"),
}


@dataclass(frozen=True)
class Idler:
    """A gear between mates.

    Parameters
    ----------
    driven, driver : tuple of str
        Pairs in which it is driven, and in which it drives.
    name : str
    """

    driven: tuple[str, ...]
    driver: tuple[str, ...]
    name: str = field(compare=False)

    def pairs(self, role: Member) -> tuple[str, ...]:
        """Those in which it has a role."""
        return self.driven if role == "driven" else self.driver


def idlers(scene: Scene) -> dict[str, Idler]:
    """Gears that are driven in one loaded pair and drive in another; not those of planetary sets."""
    found: dict[str, dict[Member, list[str]]] = {}
    for name, part in scene.case.pair.items():
        loaded = part.normal_load(scene.pairs[name]) is not None
        if not loaded or part.driver == part.driven or set_of_pair(scene.case, name) is not None:
            continue
        roles: tuple[Member, Member] = ("driver", "driven")
        for role in roles:
            gear = getattr(part, role)
            found.setdefault(scene.written.get(gear, gear), {"driver": [], "driven": []})[role].append(name)
    return {
        gear: Idler(tuple(pairs["driven"]), tuple(pairs["driver"]), gear)
        for gear, pairs in found.items() if pairs["driven"] and pairs["driver"]
    }  # fmt: skip


def check_along_fillet(scene: Scene, pairs: Iterable[str]) -> None:
    """Refuse pairs whose root stress is not known along the fillet.

    Raises
    ------
    InputError
    """
    for pair in pairs:
        first = scene.case.pair[pair].root_stress.source[0]
        if first != "fe":
            raise InputError(f"pair.{pair}.root_stress.source", f'"{first}"', "gives no stress along the fillet",
                             'put "fe" first')  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    idler = idlers(scene)[name]
    for pair in (*idler.driven, *idler.driver):
        if pair in scene.wide_pairs:
            raise InputError(
                f"pair.{pair}.width", f'"{scene.width_of(pair)}"', 'is not supported by "idler-root-stress" (2D only)',
                'set width = "plane" (spur gears), or remove the result',
            )  # fmt: skip
    check_along_fillet(scene, (*idler.driven, *idler.driver))


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    idler = idlers(scene)[name]
    return tuple(Task("root-stress-history", pair) for pair in (*idler.driven, *idler.driver))


@dataclass(frozen=True)
class IdlerStress:
    """Stress at the most pulled places of both fillets of a tooth, by `_FILLETS`."""

    found: dict[str, AlternatingStress]


def _compute(asked: Idler, upstream: Upstream, _work: Work) -> IdlerStress:
    from fegear.contact.plane.both_flanks import alternating_stress, fillet_trace, with_errors

    roles: tuple[Member, Member] = ("driven", "driver")
    data = {
        (role, pair): cast("RootStressData", upstream[Task("root-stress-history", pair)])
        for role in roles for pair in asked.pairs(role)
    }  # fmt: skip
    traces = {
        (role, pair): fillet_trace(cast("LoadedPair", one.teeth).engagement, role, one.teeth.nominal)
        for (role, pair), one in data.items()
    }

    def bent(role: Member) -> AlternatingStress:
        """Of several mates with one role the one that pulls the fillet most, and the one that presses it most."""
        other: Member = "driver" if role == "driven" else "driven"
        pull = max(
            ((role, pair) for pair in asked.pairs(role)),
            key=lambda mesh: alternating_stress(traces[mesh], None)[0].highest,
        )
        by_mate = {
            (other, pair): alternating_stress(traces[pull], traces[other, pair])[0] for pair in asked.pairs(other)
        }
        press = min(by_mate, key=lambda mesh: by_mate[mesh].lowest)
        stress = [next(iter(data[mesh].found.stress[mesh[0]].values())) for mesh in (pull, press)]
        loads = [data[mesh].teeth.loads.index(data[mesh].teeth.nominal) for mesh in (pull, press)]
        return with_errors(by_mate[press], stress[0], stress[1], (loads[0], loads[1]))

    return IdlerStress({_FILLETS[role][0]: bent(role) for role in roles})


@dataclass(frozen=True)
class Fillet:
    """One fillet of an idler's tooth, and what it is."""

    found: AlternatingStress
    what: str
    fillet: str = shown("", "fillet of the tooth")


def _fillets(seen: Seen) -> dict[str, Fillet]:
    words = dict(_FILLETS.values())
    return {key: Fillet(one, words[key], key) for key, one in seen.data.found.items()}


def _bent(seen: Seen) -> str:
    ratios = " and ".join(f"{one.ratio:.3f}" for one in seen.data.found.values())
    return (
        f"Gear {seen.name}: alternating bending of the teeth, R = {ratios} below the driven and the driving flank "
        "(annex B of ISO 6336-3 takes -1.2 for idlers)."
    )


_SHEET = Sheet(
    tables=(
        Rows(
            "idler_root_stress_{name}", "Root stress of gear {name} over one revolution",
            (
                Cell("fillet", of=lambda seen: list(_fillets(seen).values())),
                *ALTERNATING,
                "place",
            ),
            of=lambda seen: list(seen.data.found.values()), printed=True,
        ),
    ),
    values=(
        Each(_fillets, *ALTERNATING_VALUES),
    ),
    remarks=(Remark(_bent),),
)  # fmt: skip


IDLER_ROOT_STRESS = Stage(
    subjects=lambda scene: tuple(idlers(scene)),
    needs=_needs,
    inputs=lambda scene, name: idlers(scene)[name],
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(Citation("mark", "root stress history of a tooth in mesh", "section 3, Appendix B")),
    forecast=lambda _scene, _name: forecasts.constant(0.3),
)
