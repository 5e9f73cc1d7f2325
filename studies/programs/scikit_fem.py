"""-div((1 + x y) grad u) + u = f on the unit square by quadratic elements of scikit-fem. f and u are in diffusion.py, which is written by
convergence-study manufacture diffusion.toml --language python --out ."""
import numpy as np
from skfem import Basis, BilinearForm, ElementTriP2, LinearForm, MeshTri, condense, solve
from skfem.helpers import dot, grad

import diffusion


def errors(cells):
    grid = np.linspace(0, 1, cells + 1)
    basis = Basis(MeshTri.init_tensor(grid, grid), ElementTriP2(), intorder=6)
    operator = BilinearForm(lambda u, v, w: (1 + w.x[0] * w.x[1]) * dot(grad(u), grad(v)) + u * v)
    load = LinearForm(lambda v, w: diffusion.source_balance(w.x) * v)
    edge, values = basis.get_dofs(), diffusion.exact_u(basis.doflocs)
    u = solve(*condense(operator.assemble(basis), load.assemble(basis), x=values, D=edge))

    fine = Basis(basis.mesh, ElementTriP2(), intorder=10)
    x, uh = fine.global_coordinates().value, fine.interpolate(u)
    return diffusion.error_u_L2(x, fine.dx, uh.value), diffusion.error_u_H1(x, fine.dx, uh.grad), basis.N


# For the harness:
import json
import sys

l2, h1, unknowns = errors(int(sys.argv[1]))
print(json.dumps({"errors": {"L2": l2, "H1": h1}, "work": int(unknowns)}))
