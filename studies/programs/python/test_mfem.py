"""PyMFEM, the Poisson equation of its first example, with elements of degree 2: third order in L2, second in H1."""
import math

import mfem.ser as mfem


class Exact(mfem.PyCoefficient):
    def EvalValue(self, x):
        return math.sin(math.pi * x[0]) * math.sin(math.pi * x[1])


class Gradient(mfem.VectorPyCoefficient):
    def EvalValue(self, x):
        return [math.pi * math.cos(math.pi * x[0]) * math.sin(math.pi * x[1]),
                math.pi * math.sin(math.pi * x[0]) * math.cos(math.pi * x[1])]


class Load(mfem.PyCoefficient):
    def EvalValue(self, x):
        return 2 * math.pi**2 * math.sin(math.pi * x[0]) * math.sin(math.pi * x[1])


def test_order(convergence):
    def errors(n):
        mesh = mfem.Mesh.MakeCartesian2D(n, n, mfem.Element.TRIANGLE)
        space = mfem.FiniteElementSpace(mesh, mfem.H1_FECollection(2, 2))
        fixed = mfem.intArray()
        space.GetEssentialTrueDofs(mfem.intArray([1] * mesh.bdr_attributes.Max()), fixed)
        b = mfem.LinearForm(space)
        load, exact, gradient = Load(), Exact(), Gradient(2)
        b.AddDomainIntegrator(mfem.DomainLFIntegrator(load))
        b.Assemble()
        a = mfem.BilinearForm(space)
        one = mfem.ConstantCoefficient(1.0)
        a.AddDomainIntegrator(mfem.DiffusionIntegrator(one))
        a.Assemble()
        u = mfem.GridFunction(space)
        u.Assign(0.0)
        A, B, X = mfem.SparseMatrix(), mfem.Vector(), mfem.Vector()
        a.FormLinearSystem(fixed, u, b, A, X, B)
        mfem.PCG(A, mfem.GSSmoother(A), B, X, 0, 2000, 1e-26, 0.0)
        a.RecoverFEMSolution(X, b, u)
        return {"L2": u.ComputeL2Error(exact), "H1": u.ComputeGradError(gradient)}
    convergence.study(errors, n=[4, 8, 16, 32], order={"L2": 3, "H1": 2})
