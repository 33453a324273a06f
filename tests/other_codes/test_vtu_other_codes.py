"""Files for ParaView are what VTK itself reads: every kind of element, packed or not."""

import numpy as np
import pytest
import pyvista

from fegear.fem.plane.imported_mesh import write_vtu

POINTS = 300
#: VTK's numbers of the quadratic triangle, wedge and hexahedron.
KINDS = {6: 22, 15: 26, 20: 25}


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("nodes", [(6,), (15, 20)])
def test_vtk_reads_points_elements_and_fields(nodes, single, tmp_path):
    rng = np.random.default_rng(7)
    points = rng.random((2 if nodes == (6,) else 3, POINTS))
    elements = tuple(rng.integers(0, POINTS, (n, 40 + n)) for n in nodes)
    fields = {"displacement": rng.random((POINTS, 3)), 'a "quoted" <name>': rng.random(POINTS)}
    empty = np.empty((20, 0), dtype=np.int64)
    write_vtu(tmp_path / "a.vtu", points, (*elements, empty), fields, remark="Flanks as generated.", single=single)
    read = pyvista.read(tmp_path / "a.vtu")
    kept = np.float32 if single else np.float64
    assert (read.points[:, : points.shape[0]] == points.T.astype(kept)).all()
    for block in elements:
        assert (read.cells_dict[KINDS[block.shape[0]]] == block.T).all()
    assert read.n_cells == sum(block.shape[1] for block in elements)
    for name, values in fields.items():
        assert (read[name] == values.astype(kept)).all()
