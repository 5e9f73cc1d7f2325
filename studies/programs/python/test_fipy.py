"""FiPy, finite volumes: steady diffusion with a source, as in `examples/diffusion/mesh1D.py`, which compares one mesh with the exact values."""
import numpy as np
from fipy import CellVariable, DiffusionTerm, Grid1D

def test_order(convergence):
    def error(n):
        u = CellVariable(mesh=Grid1D(nx=n, dx=1 / n))
        u.constrain(0, u.mesh.exteriorFaces)
        exact = CellVariable(mesh=u.mesh, value=np.sin(np.pi * u.mesh.cellCenters[0].value))
        (DiffusionTerm(coeff=1.0) + np.pi**2 * exact == 0).solve(u)
        return np.abs(u.value - exact.value).max()
    convergence.study(error, order=2)
