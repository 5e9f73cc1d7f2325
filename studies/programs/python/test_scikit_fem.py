"""scikit-fem, `tests/test_convergence.py`: linear triangles for the Poisson equation; there two slopes of two refinements each."""
import numpy as np
from skfem import Basis, ElementTriP1, Functional, LinearForm, MeshTri, condense, solve
from skfem.models.poisson import laplace

def test_order(convergence):
    def errors(n):
        grid = np.linspace(0, 1, n + 1)
        basis = Basis(MeshTri.init_tensor(grid, grid), ElementTriP1(), intorder=6)
        exact = lambda x: np.sin(np.pi * x[0]) * np.sin(np.pi * x[1])
        load = LinearForm(lambda v, w: 2 * np.pi**2 * exact(w.x) * v).assemble(basis)
        u = solve(*condense(laplace.assemble(basis), load, D=basis.get_dofs()))
        return {"L2": Functional(lambda w: (w["u"] - exact(w.x)) ** 2).assemble(basis, u=u) ** 0.5}
    convergence.study(errors, order={"L2": 2})
