"""The heat equation on (0, 1) by FEniCSx: linear elements, Crank-Nicolson, with the solution (2 - sin(8 t)) sin(pi x)."""
import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem.petsc import LinearProblem
from mpi4py import MPI
from ufl import dot, dx, grad, sin


def errors(cells, steps):
    domain = mesh.create_unit_interval(MPI.COMM_SELF, cells)
    space = getattr(fem, "functionspace", None) or fem.FunctionSpace  # as the release has it
    V = space(domain, ("Lagrange", 1))
    shape = sin(ufl.pi * ufl.SpatialCoordinate(domain)[0])
    t, dt = fem.Constant(domain, 0.0), fem.Constant(domain, 1 / steps)
    exact = (2 - sin(8 * t)) * shape
    source = (ufl.pi**2 * (2 - sin(8 * t)) - 8 * ufl.cos(8 * t)) * shape

    ends = mesh.locate_entities_boundary(domain, 0, lambda x: np.full(x.shape[1], True))
    zero = fem.dirichletbc(0.0, fem.locate_dofs_topological(V, 0, ends), V)
    u, v = ufl.TrialFunction(V), ufl.TestFunction(V)
    old = fem.Function(V)
    old.interpolate(lambda x: 2 * np.sin(np.pi * x[0]))
    half = lambda u: 0.5 * dt * dot(grad(u), grad(v)) * dx
    a, load = u * v * dx + half(u), (old + dt * source) * v * dx - half(old)
    problem = LinearProblem(a, load, bcs=[zero], petsc_options={"ksp_type": "preonly", "pc_type": "lu"})
    for step in range(steps):
        t.value = (step + 0.5) / steps
        old.x.array[:] = problem.solve().x.array
    t.value = 1.0
    norm = lambda form: fem.assemble_scalar(fem.form(form)) ** 0.5
    error = old - exact
    return norm(error**2 * dx(degree=6)), norm(dot(grad(error), grad(error)) * dx(degree=6)), len(old.x.array) * steps


# For the harness:
import json
import sys

l2, h1, work = errors(int(sys.argv[1]), int(sys.argv[2]))
print(json.dumps({"errors": {"L2": l2, "H1": h1}, "work": work}))
