# SPDX-License-Identifier: BSD-3-Clause
"""The stiffness matrix against scikit-fem's own form, and against what elasticity says about it."""

import numpy as np
import pytest
import skfem
from skfem.helpers import ddot, sym_grad, trace
from skfem.models.elasticity import linear_elasticity

from signorini import cores
from signorini.errors import InputError
from signorini.fem import assembly
from signorini.fem.assembly import Cells, stiffness
from signorini.fem.elasticity import isotropic, law_tensor


def distorted(mesh, amount=0.04):
    """Move all nodes by a smooth map: elements differ, none folds."""
    p = mesh.p
    return type(mesh)(p + amount * np.sin(3.0 * p[::-1] + np.arange(len(p))[:, None]), mesh.t)


TRI = distorted(skfem.MeshTri.init_tensor(np.linspace(0, 1, 4), np.linspace(0, 1, 3)))
QUAD = distorted(skfem.MeshQuad.init_tensor(np.linspace(0, 1, 4), np.linspace(0, 1, 3)))
TET = distorted(skfem.MeshTet.init_tensor(*[np.linspace(0, 1, 3)] * 3))
HEX = distorted(skfem.MeshHex.init_tensor(*[np.linspace(0, 1, 3)] * 3))
DISK = skfem.MeshTri2.init_circle(2)

ELEMENTS = {
    "tri3": (TRI, skfem.ElementTriP1()),
    "tri6": (TRI, skfem.ElementTriP2()),
    "tri10": (TRI, skfem.ElementTriP3()),
    "tri15": (TRI, skfem.ElementTriP4()),
    "tri6 curved": (DISK, skfem.ElementTriP2()),
    "quad4": (QUAD, skfem.ElementQuad1()),
    "quad8": (QUAD, skfem.ElementQuadS2()),
    "quad9": (QUAD, skfem.ElementQuad2()),
    "tet4": (TET, skfem.ElementTetP1()),
    "tet10": (TET, skfem.ElementTetP2()),
    "hex8": (HEX, skfem.ElementHex1()),
    "hex20": (HEX, skfem.ElementHexS2()),
    "hex27": (HEX, skfem.ElementHex2()),
}


def law(lam, mu, d, *, hoop=False):
    D = np.array([isotropic(*pair) for pair in np.broadcast(lam, mu)])
    return law_tensor(D[:, :4, :4] if d == 2 else D, hoop=hoop)


def cells_of(mesh, element, *, lame_lambda, lame_mu, hoop=False, **constants):
    """The coordinates of the nodes of a scalar scikit-fem element, a block of its cells, and their law."""
    basis = skfem.Basis(mesh, element)
    X, weights = basis.quadrature
    shape = [element.lbasis(X, i) for i in range(basis.element_dofs.shape[0])]
    cells = Cells(
        nodes=basis.element_dofs.T,
        shape_gradients=np.moveaxis(np.stack([dphi for _, dphi in shape]), 2, 0),
        shape_values=np.stack([phi for phi, _ in shape]).T,
        weights=weights,
        **constants,
    )
    return basis.doflocs.T, cells, law(lame_lambda, lame_mu, mesh.dim(), hoop=hoop)


def same(K, reference, tolerance=1e-14):
    return abs(K - reference).max() <= tolerance * abs(reference).max()


@pytest.mark.slow
@pytest.mark.parametrize("name", ELEMENTS)
def test_agrees_with_scikit_fem(name):
    mesh, element = ELEMENTS[name]
    points, cells, own = cells_of(mesh, element, lame_lambda=1.3, lame_mu=0.7)
    K = stiffness(points, cells, own)
    reference = linear_elasticity(1.3, 0.7).assemble(skfem.Basis(mesh, skfem.ElementVector(element)))
    assert K.has_sorted_indices
    assert K.indices.dtype == K.indptr.dtype == np.int32
    assert same(K, reference, 1e-13 if name == "tri15" else 1e-14)  # scikit-fem's quartic polynomials lose a digit


def test_constants_and_thickness_per_element():
    mesh, element = ELEMENTS["quad4"]
    lam, mu = np.random.default_rng(0).uniform(1, 2, (2, mesh.nelements))
    points, cells, own = cells_of(mesh, element, lame_lambda=lam, lame_mu=mu, material=np.arange(len(lam)), measure=2.5)
    basis = skfem.Basis(mesh, skfem.ElementVector(element))
    reference = linear_elasticity(lam[:, None], mu[:, None]).assemble(basis)
    assert same(stiffness(points, cells, own), 2.5 * reference)


def test_axisymmetric():
    mesh, element = ELEMENTS["quad9"]
    points, cells, own = cells_of(mesh.translated((0.3, 0.0)), element, lame_lambda=1.3, lame_mu=0.7, hoop=True)
    radius = np.einsum("qk,mk->mq", cells.shape_values, points[cells.nodes, 0])
    cells = cells._replace(measure=2 * np.pi * radius)

    @skfem.BilinearForm
    def ring(u, v, w):
        r = w.x[0]
        du, dv = sym_grad(u), sym_grad(v)
        hoop_u, hoop_v = u[0] / r, v[0] / r
        spread = (trace(du) + hoop_u) * (trace(dv) + hoop_v)
        return 2 * np.pi * r * (1.3 * spread + 2 * 0.7 * (ddot(du, dv) + hoop_u * hoop_v))

    reference = ring.assemble(skfem.Basis(mesh.translated((0.3, 0.0)), skfem.ElementVector(element)))
    assert same(stiffness(points, cells, own, axisymmetric=True), reference)


@pytest.mark.parametrize("name", ELEMENTS)
def test_rigid_motions_cost_nothing_and_constant_strains_their_energy(name):
    mesh, element = ELEMENTS[name]
    points, cells, own = cells_of(mesh, element, lame_lambda=1.3, lame_mu=0.7)
    K = stiffness(points, cells, own)
    d = points.shape[1]
    volume = stiffness(*cells_of(mesh, element, lame_lambda=1.0, lame_mu=0.0))
    stretch = np.zeros_like(points)
    stretch[:, 0] = points[:, 0]
    turn = np.zeros_like(points)
    turn[:, 0], turn[:, 1] = -points[:, 1], points[:, 0]
    for motion in [np.ones_like(points), turn]:
        assert np.abs(K @ motion.ravel()).max() <= 1e-13 * abs(K).max()
    energy = stretch.ravel() @ K @ stretch.ravel()
    assert energy == pytest.approx((1.3 + 2 * 0.7) * (stretch.ravel() @ volume @ stretch.ravel()), rel=1e-12)
    assert K.shape == (d * len(points),) * 2


def test_blocks_share_one_pattern():
    points, triangles, soft = cells_of(TRI, skfem.ElementTriP1(), lame_lambda=1.0, lame_mu=1.0)
    far, squares, stiff = cells_of(QUAD, skfem.ElementQuad1(), lame_lambda=2.0, lame_mu=0.5)
    shifted = squares._replace(nodes=squares.nodes + len(points), material=1)
    both = np.concatenate([soft, stiff])
    K = stiffness(np.concatenate([points, far, [[9.0, 9.0]]]), [triangles, shifted], both)
    n = 2 * len(points)
    assert same(K[:n, :n], stiffness(points, triangles, soft))
    assert same(K[n:-2, n:-2], stiffness(far, squares, stiff))
    assert K[:n, n:].nnz == 0
    assert np.diff(K.indptr)[-2:].tolist() == [0, 0]


@pytest.mark.parametrize("name", ["quad8", "hex8"])
def test_every_number_of_threads_gives_the_same_bits(name, monkeypatch):
    """Cells in any order, of which some have nodes of several shares; the first bad one is named whoever finds it."""
    mesh, element = ELEMENTS[name]
    points, cells, own = cells_of(mesh, element, lame_lambda=1.3, lame_mu=0.7)
    cells = cells._replace(nodes=np.random.default_rng(3).permutation(cells.nodes))
    alone = stiffness(points, cells, own)
    flat = cells._replace(nodes=np.where(np.arange(len(cells.nodes))[:, None] % 4 == 1, 0, cells.nodes))
    monkeypatch.setattr(assembly, "SHARED_CELLS", 2)
    for number in (1, 2, 3, 7):
        with cores.threads(number):
            shared = stiffness(points, cells, own)
            assert np.array_equal(shared.data, alone.data)
            assert np.array_equal(shared.indices, alone.indices)
            with pytest.raises(InputError, match="element 1 of block 0"):
                stiffness(points, flat, own)


def test_either_orientation():
    points, cells, own = cells_of(TRI, skfem.ElementTriP1(), lame_lambda=1.0, lame_mu=1.0)
    turned = cells._replace(nodes=cells.nodes[:, [1, 0, 2]])
    assert same(stiffness(points, turned, own), stiffness(points, cells, own))


def _bad(change):
    points, cells, own = cells_of(QUAD, skfem.ElementQuad1(), lame_lambda=1.0, lame_mu=1.0)
    return *change(points.copy(), cells), own


def _folded(points, cells):
    nodes = cells.nodes.copy()
    nodes[3, [0, 1]] = nodes[3, [1, 0]]
    return points, cells._replace(nodes=nodes)


def _flat(points, cells):
    points[cells.nodes[0]] = [[0, 0], [1, 1], [2, 2], [3, 3]]
    return points, cells


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (_folded, r"element 3 of block 0, around .* is folded or has no volume"),
        (_flat, "element 0 of block 0"),
        (lambda p, c: (p, c._replace(nodes=c.nodes + 1)), "names nodes 1 .. 12; there are 0 .. 11"),
        (lambda p, c: (p, c._replace(weights=c.weights[1:])), "do not fit points"),
    ],
)
def test_bad_elements_are_named(change, message):
    with pytest.raises(InputError, match=message):
        stiffness(*_bad(change))


def test_the_axis_is_watched():
    points, cells, own = cells_of(QUAD, skfem.ElementQuad1(), lame_lambda=1.0, lame_mu=1.0, hoop=True)
    with pytest.raises(InputError, match="reaches over the axis"):
        stiffness(points - [0.5, 0.0], cells, own, axisymmetric=True)
    with pytest.raises(InputError, match="needs shape_values"):
        stiffness(points, cells._replace(shape_values=np.empty((0, 0))), own, axisymmetric=True)
