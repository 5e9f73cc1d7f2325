"""The heat equation on the unit square by FEniCSx: linear elements, Crank-Nicolson, u = (2 - sin(8 t)) sin(pi x) sin(pi y)."""
import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem.petsc import LinearProblem
from mpi4py import MPI
from ufl import dot, dx, grad, sin


def errors(cells, steps):
    domain = mesh.create_unit_square(MPI.COMM_SELF, cells, cells)
    space = getattr(fem, "functionspace", None) or fem.FunctionSpace  # as the release has it
    V = space(domain, ("Lagrange", 1))
    x = ufl.SpatialCoordinate(domain)
    shape = sin(ufl.pi * x[0]) * sin(ufl.pi * x[1])
    t, dt = fem.Constant(domain, 0.0), 1 / steps
    exact = (2 - sin(8 * t)) * shape
    source = (2 * ufl.pi**2 * (2 - sin(8 * t)) - 8 * ufl.cos(8 * t)) * shape

    domain.topology.create_connectivity(1, 2)
    edge = fem.locate_dofs_topological(V, 1, mesh.exterior_facet_indices(domain.topology))
    zero = fem.dirichletbc(0.0, edge, V)
    u, v = ufl.TrialFunction(V), ufl.TestFunction(V)
    old = fem.Function(V)
    old.interpolate(lambda x: 2 * np.sin(np.pi * x[0]) * np.sin(np.pi * x[1]))
    half = lambda u: 0.5 * dt * dot(grad(u), grad(v)) * dx
    a, load = u * v * dx + half(u), (old + dt * source) * v * dx - half(old)
    problem = LinearProblem(a, load, bcs=[zero], petsc_options={"ksp_type": "preonly", "pc_type": "lu"})
    for step in range(steps):
        t.value = (step + 0.5) * dt
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
