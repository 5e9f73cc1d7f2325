"""Poisson's equation on the unit square by quadratic elements of scikit-fem, with the solution sin(pi x) sin(pi y)."""
import numpy as np
from numpy import cos, pi, sin
from skfem import Basis, BilinearForm, ElementTriP2, Functional, LinearForm, MeshTri, condense, solve
from skfem.helpers import dot, grad


def errors(cells):
    mesh = MeshTri.init_tensor(np.linspace(0, 1, cells + 1), np.linspace(0, 1, cells + 1))
    basis = Basis(mesh, ElementTriP2(), intorder=4)
    stiffness = BilinearForm(lambda u, v, w: dot(grad(u), grad(v)))
    load = LinearForm(lambda v, w: 2 * pi**2 * sin(pi * w.x[0]) * sin(pi * w.x[1]) * v)
    u = solve(*condense(stiffness.assemble(basis), load.assemble(basis), D=basis.get_dofs()))

    fine = Basis(mesh, ElementTriP2(), intorder=8)
    x, y = fine.global_coordinates().value
    uh = fine.interpolate(u)
    gradient = np.array([pi * cos(pi * x) * sin(pi * y), pi * sin(pi * x) * cos(pi * y)])
    l2 = Functional(lambda w: (w.uh - sin(pi * x) * sin(pi * y)) ** 2).assemble(fine, uh=uh)
    h1 = Functional(lambda w: dot(grad(w.uh) - gradient, grad(w.uh) - gradient)).assemble(fine, uh=uh)
    return l2**0.5, h1**0.5, basis.N


# For the harness:
import json
import sys

l2, h1, unknowns = errors(int(sys.argv[1]))
print(json.dumps({"errors": {"L2": l2, "H1": h1}, "work": int(unknowns)}))
