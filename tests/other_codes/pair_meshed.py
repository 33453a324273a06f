"""Two whole solid gears meshed for contact, with nothing of fegear but its plane outlines: see `pair_by_calculix.py`.

Quadratic hexahedra and wedges on explicit meshes of all teeth. The edges of the teeth in contact are finest along the
contact line and move up the flank with it from station to station, as the line of a helical pair does.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu

from fegear.fem.plane.boundary import Chain, sector_boundary
from fegear.fem.plane.gear_section import gear_section
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_inside
from fegear.fem.solid.extruded import extruded, planes_of
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

MM = 1e3
TEETH, HELIX, FACE, MODULE = 18, math.radians(12.0), 3e-3, 1e-3
#: Roll positions as shares of a base pitch after the start of the path.
POSITIONS = {"two whole lines": 0.25, "a line that ends at the tip": 0.02}
#: Finest edge on the contact line, half the width of the fine zone, growth beyond it; fillet edges [modules]; layers
#: from an end of the face, and inside it.
LEVELS = {
    "coarse": (0.065, 0.1, 0.6, 0.25, (0.25, 0.5), 0.75),
    "fillets": (0.065, 0.1, 0.6, 0.12, (0.25, 0.5), 0.75),
}
#: Only so near to the contact line, and over the whole of each edge that reaches there, the driven flank is watched for
#: contact [modules]: one and a half times the Hertzian half-width. Watching all of it takes more iterations.
STRIP = 0.075


def the_pair():
    """Two gears of 18 teeth, 12 degrees of helix, three modules wide."""
    tooth = Tooth(TEETH, BasicRack(1.0, 1.25, 0.25), 0.0, helix_angle=HELIX)
    bore = 0.5 * tooth.root_radius * MODULE
    gears = [Gear(tooth, MODULE, bore, FACE, Material(206.8e9, 0.3), hand=hand) for hand in ("right", "left")]
    return GearPair(*gears)


def lines_at(pair, share):
    """Roll position [m] and x(z) of the pairs in contact there, by number: functions of z [m]."""
    x0 = pair.x_start + share * pair.base_pitch
    slope = pair.driver.twist * pair.driver.base_radius
    found = {}
    for j in range(-2, 3):
        ends = x0 + j * pair.base_pitch + slope * 0.5 * FACE * np.array([-1.0, 1.0])
        if ends.max() > pair.x_start and ends.min() < pair.x_end:
            found[j] = lambda z, j=j: x0 + j * pair.base_pitch - slope * np.asarray(z)
    return x0, found


def _settings(root):
    """Of a tooth in contact, whose flank has its own edges."""
    return MeshSettings(
        root_edge_length=root, root_fraction=3.0 * root, flank_edge_length=0.3, tip_edge_length=0.3,
        junction_edge_length=0.2, back_edge_length=0.7, growth=0.7, tip_growth=0.7, side_growth=1.0,
        body_fraction=2.0, rim_fraction=1.0, order=2,
    )  # fmt: skip


#: Of all other teeth, and of the sides and the bore of all.
_OTHERS = MeshSettings(
    root_edge_length=0.5, root_fraction=2.0, flank_edge_length=0.8, tip_edge_length=0.6, junction_edge_length=0.6,
    back_edge_length=0.8, growth=0.7, tip_growth=0.7, side_growth=1.0, body_fraction=2.0, rim_fraction=1.0, order=2,
)  # fmt: skip


def _halved(chain):
    """Half as many edges along fillets, which never have fewer than four otherwise."""
    if not chain.name.endswith("fillet") or chain.middles.shape[1] % 2:
        return chain
    return Chain(chain.name, chain.vertices[:, ::2], chain.vertices[:, 1::2], chain.tangents[:, ::2])


def _nodes_up_flank(low, high, centre, fine, edges=None):
    """Arcs of the flank's vertices, finest about `centre`."""
    finest, half, growth, *_ = fine
    s = np.linspace(low, high, 4001)
    density = 1.0 / np.minimum(finest + growth * np.maximum(np.abs(s - centre) - half, 0.0), 0.35)
    count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(s))])
    edges = edges or max(4, round(float(count[-1])))
    nodes = np.interp(np.linspace(0.0, count[-1], edges + 1), count, s)
    nodes[0], nodes[-1] = low, high
    return nodes


def _on_involute(tooth, arc):
    """Points and tangents of the loaded flank at arcs from the base circle, tooth along +y."""
    rb = tooth.base_radius
    roll = np.sqrt(2.0 * np.asarray(arc) / rb)
    a = tooth.base_half_angle - roll
    foot = rb * np.stack([np.sin(a), np.cos(a)])
    tangent = np.stack([np.sin(a), np.cos(a)])
    # From the foot on the base circle along the generating line.
    return foot + rb * roll * np.stack([np.cos(a), -np.sin(a)]), tangent


def _arc_of_x(pair, member, x):
    return 0.5 * pair.flank_curvature_radius(x, member) ** 2 / pair.gear(member).base_radius / MODULE


@dataclass
class Body:
    """One meshed gear in its place."""

    member: str
    mesh: object
    centre: np.ndarray
    points: np.ndarray
    bore: np.ndarray
    teeth: dict  # pair number -> tooth number
    near: dict  # tooth number -> (layers, edges) whether a face of the flank is near the contact line


def body(pair, member, share, level):
    """Mesh of a gear, placed: the driven one about the origin, the driver above it with its teeth down."""
    gear, (x0, lines) = pair.gear(member), lines_at(pair, share)
    tooth, fine, z_teeth = gear.tooth, LEVELS[level], gear.teeth
    forward = 1 if member == "driver" else -1
    teeth = {j: forward * j for j in lines}
    low, high = (
        0.5 * tooth.base_radius * float(tooth.roll(r)) ** 2 for r in (tooth.form_radius, tooth.involute_tip_radius)
    )
    ends = sorted(float(_arc_of_x(pair, member, x)) for x in (pair.x_start, pair.x_end))

    def centre(j, place):
        return float(np.clip(_arc_of_x(pair, member, float(lines[j](place * MODULE))), *ends))

    counts = {j: _nodes_up_flank(low, high, centre(j, 0.0), fine).size - 1 for j in teeth}

    def arcs(j, place):
        return _nodes_up_flank(low, high, centre(j, place), fine, counts[j])

    coarse = [_halved(c) for c in sector_boundary(tooth, gear.bore_radius / MODULE, _OTHERS)]
    shared = {c.name: c for c in coarse if c.name in ("bore", "side_a", "side_b")}
    plain, sectors = mesh_inside(coarse, z_teeth), {}
    for j, k in teeth.items():
        at_tip = 0.06 if abs(centre(j, 0.0) - high) < 0.3 else 0.3
        chains = sector_boundary(
            tooth, gear.bore_radius / MODULE, replace(_settings(fine[3]), tip_edge_length=at_tip)
        )  # fmt: skip
        own = {c.name: _divided(tooth, c, arcs(j, 0.0)) for c in chains if c.name == "flank"} | shared
        sectors[k] = mesh_inside([own.get(c.name, c) for c in chains], z_teeth)
    first = -((z_teeth - 1) // 2)
    section = gear_section({k: sectors.get(k, plain) for k in range(first, first + z_teeth)})
    mesh = extruded(section, _stations(fine), gear.twist * MODULE)
    move, planes = _Morph(section), []
    for place, nodes in planes_of(mesh):
        wanted = [_slid(tooth, section, k, arcs(j, place)) for j, k in teeth.items()]
        moved = move(wanted)[:, nodes]
        s, c = math.sin(mesh.twist * place), math.cos(mesh.twist * place)
        planes.append(np.stack([c * moved[0] - s * moved[1], s * moved[0] + c * moved[1], np.full(nodes.size, place)]))
    points, middle = np.hstack(planes) * MODULE * MM, np.zeros(3)
    roll = float(pair.roll_angle(x0, member))
    points[:2] = _clockwise(roll - pair.working_pressure_angle - tooth.base_half_angle) @ points[:2]
    if member == "driver":
        middle[1] = pair.centre_distance * MM
        points[:2] = middle[:2, None] - points[:2]
    near = {
        k: np.array(
            [
                (arcs(j, z)[1:] > centre(j, z) - STRIP) & (arcs(j, z)[:-1] < centre(j, z) + STRIP)
                for z in 0.5 * (mesh.stations[1:] + mesh.stations[:-1])
            ]
        )
        for j, k in teeth.items()
    }
    mesh = replace(mesh, points=points)
    return Body(member, mesh, middle, points, mesh.nodes_of(section.edges("bore")), teeth, near)


def _clockwise(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, s], [-s, c]])


def _divided(tooth, flank, arcs):
    """The flank's chain with nodes at other arcs."""
    vertices, tangents = _on_involute(tooth, arcs)
    vertices[:, 0], vertices[:, -1] = flank.vertices[:, 0], flank.vertices[:, -1]
    return Chain("flank", vertices, _on_involute(tooth, 0.5 * (arcs[1:] + arcs[:-1]))[0], tangents)


def _stations(fine):
    """Ends of the layers; those of quarters of the face among them."""
    half = 0.5 * FACE / MODULE
    depth = half - np.cumsum(fine[4])
    inner = np.linspace(-depth[-1], depth[-1], round(2.0 * depth[-1] / fine[5]) + 1)
    stations = np.unique(np.round([-half, *-depth, *inner, *depth, half], 12))
    for quarter in (-0.5 * half, 0.0, 0.5 * half):
        stations[np.argmin(np.abs(stations - quarter))] = quarter
    return stations


def flank_edges(section, tooth_number):
    """Edges of a flank from its foot to its tip."""
    edges = section.boundaries["flank", tooth_number]
    return edges[:, np.argsort(np.hypot(*section.points[:, edges[2]]))]


def _slid(tooth, section, k, arcs):
    """Nodes of a flank and where they shall lie."""
    edges = flank_edges(section, k)
    places = _on_involute(tooth, np.concatenate([arcs, 0.5 * (arcs[1:] + arcs[:-1])]))[0]
    return np.concatenate([edges[0], edges[1, -1:], edges[2]]), _clockwise(2.0 * math.pi * k / section.teeth) @ places


class _Morph:
    """Slides the nodes of a section along their flanks; the inside follows as a stretched skin."""

    def __init__(self, section):
        p = section.points
        q, t = section.quadrilaterals, section.triangles
        halves = [q[[0, 1, 2]], q[[0, 2, 3]], q[[0, 1, 3]], q[[1, 2, 3]], t[:3], t[:3]]
        three = np.hstack(halves)
        a, b = p[:, three[1]] - p[:, three[0]], p[:, three[2]] - p[:, three[0]]
        area = np.maximum(0.5 * (a[0] * b[1] - a[1] * b[0]), 1e-9)
        side = [p[:, three[(i + 2) % 3]] - p[:, three[(i + 1) % 3]] for i in range(3)]
        rows, columns, values = [], [], []
        for i in range(3):
            for k in range(3):
                rows.append(three[i])
                columns.append(three[k])
                # Small elements are stiffer, so that they keep their shape.
                values.append((side[i] * side[k]).sum(axis=0) / (4.0 * area) / np.sqrt(area))
        count = p.shape[1]
        self.matrix = csc_matrix(
            coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (count, count))
        )
        corners = np.unique(three)
        outline = np.unique(np.concatenate([e.reshape(-1) for e in section.boundaries.values()]))
        self.free = np.setdiff1d(corners, outline)
        self.solver = splu(self.matrix[self.free][:, self.free])
        self.section = section
        pairs = [(q[i], q[(i + 1) % 4], q[4 + i]) for i in range(4)] + [
            (t[i], t[(i + 1) % 3], t[3 + i]) for i in range(3)
        ]
        self.middle = np.hstack([np.stack(x) for x in pairs])
        self.inside = ~np.isin(self.middle[2], outline)

    def __call__(self, wanted):
        p = self.section.points
        u = np.zeros_like(p)
        for ids, places in wanted:
            u[:, ids] = places - p[:, ids]
        corner = u.copy()
        u[:, self.free] = self.solver.solve(-(self.matrix[self.free] @ corner.T)).T
        a, b, m = self.middle[:, self.inside]
        u[:, m] = 0.5 * (u[:, a] + u[:, b])
        return p + u
