"""NGSolve, the Poisson equation of its first tutorial, with elements of degree 2: third order in L2."""
import ngsolve as ngs
from ngsolve.meshes import MakeStructured2DMesh

def test_order(convergence):
    def errors(n):
        space = ngs.H1(MakeStructured2DMesh(quads=False, nx=n, ny=n), order=2, dirichlet=".*")
        (u, v), exact = space.TnT(), ngs.sin(ngs.pi * ngs.x) * ngs.sin(ngs.pi * ngs.y)
        a = ngs.BilinearForm(ngs.grad(u) * ngs.grad(v) * ngs.dx).Assemble()
        f = ngs.LinearForm(2 * ngs.pi**2 * exact * v * ngs.dx).Assemble()
        solution = ngs.GridFunction(space)
        solution.vec.data = a.mat.Inverse(space.FreeDofs()) * f.vec
        return {"L2": ngs.sqrt(ngs.Integrate((solution - exact) ** 2, space.mesh, order=8))}
    convergence.study(errors, order=3)
