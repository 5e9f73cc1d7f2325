"""The codes of the gallery: what each needs, how it is run, and the one line that is a mistake."""

from dataclasses import dataclass, field


@dataclass
class Code:
    """A code of the gallery.

    name: of its page, heading: its name in words, solves: the problem in a few words
    program: the file below studies/programs whose line `old` becomes `new`, which is `mistake` in words
    commands: what a user types, in the folder of the program; the last one judges, and writes the folder `report`
    needs: a shell command that succeeds where the software is there
    """

    name: str
    heading: str
    solves: str
    program: str
    commands: list
    old: str
    new: str
    mistake: str
    needs: str = "true"
    debian: list = field(default_factory=list)
    pypi: list = field(default_factory=list)
    # Other files of its page.
    files: list = field(default_factory=list)
    # Folders that its commands are looked up in first.
    path_first: list = field(default_factory=list)
    is_test: bool = False
    is_shown: bool = True
    has_page: bool = True
    # What a test prints with its mistake, where that is no rate.
    sign: str = ""


def study(name, heading, solves, program, old, new, mistake, *, build=(), files=(), **more):
    """A code with a study file next to its program."""
    file = program.rsplit(".", 1)[0] + ".toml"
    commands = [*build, f"convergence-study study {file} --out report"]
    return Code(name, heading, solves, program, commands, old, new, mistake, files=[*files, file], **more)


def test(name, heading, solves, old, new, mistake, **more):
    """A code with a test for the pytest plugin."""
    file = f"test_{name.removesuffix('-test').replace('-', '_')}.py"
    commands = [f"pytest -q -p no:cacheprovider {file} --convergence-report report"]
    return Code(name, heading, solves, f"python/{file}", commands, old, new, mistake, is_test=True, **more)


MANUFACTURE = "convergence-study manufacture {folder}/manufactured/diffusion.toml --language {language} --out ."
DIFFUSION = "diffusion, k = 1 + x y, degree 2"
SUNDIALS = "-lsundials_cvode -lsundials_nvecserial -lsundials_sunlinsoldense -lsundials_sunmatrixdense"

CODES = [
    study("freefem", "FreeFEM", "Poisson, degree 2", "elements.edp",
          "qft=qf5pT", "qft=qf1pT", "a quadrature of one point", needs="command -v FreeFem++", debian=["freefem++"]),
    study("openfoam", "OpenFOAM", "heat by laplacianFoam, Crank-Nicolson", "foam.py",
          "CrankNicolson 1", "Euler", "implicit Euler", needs="command -v laplacianFoam", debian=["openfoam"]),
    Code("dealii", "deal.II", DIFFUSION, "dealii/solver.cc",
         [MANUFACTURE.format(folder="../..", language="c"), "cmake -S . -B build", "cmake --build build", "build/solver > table.txt",
          "convergence-study rates table.txt --order L2=3 --order H1=2 --out report"],
         "QGauss<2>(3), source", "QGauss<2>(1), source", "a load by one point", files=["../manufactured/diffusion.toml", "dealii/CMakeLists.txt"],
         needs="command -v cmake && ls /usr/share/cmake/deal.II", debian=["cmake", "libdeal.ii-dev"]),
    study("scikit-fem", "scikit-fem", DIFFUSION, "scikit_fem.py",
          "source_balance(w.x)", "source_balance(w.x.mean(2, keepdims=True))", "the source at the middle of each triangle",
          build=[MANUFACTURE.format(folder="..", language="python")], files=["../manufactured/diffusion.toml"], pypi=["scikit-fem"]),
    study("fenicsx", "FEniCSx", "heat, degree 1, Crank-Nicolson: h and dt apart", "heat.py",
          "(step + 0.5) / steps", "(step + 1) / steps", "a load of the wrong time", needs="/usr/bin/python3 -c 'import dolfinx'",
          debian=["python3-dolfinx"], path_first=["/usr/bin"]),
    test("ngsolve", "NGSolve", "Poisson, degree 2", "2 * ngs.pi", "1.99 * ngs.pi", "a load that is too small", pypi=["ngsolve"]),
    test("mfem", "PyMFEM", "Poisson, degree 2", "return 2 * math.pi", "return 1.99 * math.pi", "a load that is too small", pypi=["mfem", "numpy"]),
    test("fipy", "FiPy", "diffusion, finite volumes", "u.constrain(0, u", "u.constrain(1e-2, u", "a boundary value", pypi=["fipy"]),
    study("octave", "Octave", "heat, Crank-Nicolson", "conduction.m",
          "theta = 1/2", "theta = 1", "implicit Euler", needs="command -v octave-cli", debian=["octave"]),
    study("fortran", "Fortran", "y'' = -y, Numerov", "numerov.f90",
          "5 * h**2 / 12", "6 * h**2 / 12", "a wrong weight", build=["gfortran -O2 -o numerov numerov.f90"],
          needs="command -v gfortran", debian=["gfortran"]),
    study("cpp", "C++", "advection, finite differences, Lax-Wendroff", "advection.cpp",
          "exact(0, t); ", "exact(0, t - dt); ", "a boundary value of the step before", build=["c++ -O2 -o advection advection.cpp"],
          needs="command -v c++", debian=["g++"]),
    study("julia", "Julia", "pendulum, implicit midpoint rule", "midpoint-julia.jl",
          "u + h / 2 * mv, v", "u + h / 2 * v, v", "a half step with the old velocity", needs="command -v julia"),
    study("cvode", "SUNDIALS CVODE, C++", "the beam of this project, by another code", "cvode.cpp",
          "add(1, 4, a, c)", "add(1, 4, 0, c)", "heat that does not bend the beam", build=[f"c++ -O3 -o cvode cvode.cpp {SUNDIALS}"],
          needs="echo '#include <cvode/cvode.h>' | c++ -E -x c++ -", debian=["libsundials-dev"], has_page=False),
    study("simpson", "awk", "Simpson's rule", "simpson.sh",
          "sqrt(1 + (i + 1) * h)", "sqrt(1 + (i + 0.999) * h)", "a wrong end point", needs="command -v awk", has_page=False),
    study("pendulum", "Python", "pendulum, Runge-Kutta, without an exact solution", "pendulum.py",
          "2 * k2[i] + 2 * k3[i]", "3 * k2[i] + k3[i]", "wrong weights", has_page=False),
    study("midpoint", "awk, cells in the plane", "midpoint rule", "midpoint.sh",
          ", h, n", ", 1 / n, n", "a step that is not that of the errors", needs="command -v awk", is_shown=False, has_page=False),
    test("scikit-fem-test", "scikit-fem, its test", "Poisson, degree 1", "2 * np.pi", "1.99 * np.pi", "a load that is too small",
         pypi=["scikit-fem"], is_shown=False, has_page=False),
    test("scipy", "SciPy", "the orders of solve_ivp", "order=5", "order=4", "a claim that is too low", pypi=["scipy"], is_shown=False, has_page=False),
    test("py-pde", "py-pde", "Poisson", '{"value": 0}', '{"value": 1e-2}', "a boundary value", pypi=["py-pde"], is_shown=False, has_page=False),
    test("polaris", "polaris", "tables without an order", "[240, 120, 60], [4.0, 1.0, last]", "[240, 120, 60], [4.0, 1.0, 0.25]",
         "a table with an order", sign="DID NOT RAISE", is_shown=False, has_page=False),
]
