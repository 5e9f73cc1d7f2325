# NAME.py N: T_t = T_xx on (0, 1) with T = 0 at both ends, by OpenFOAM's laplacianFoam on N cells, with steps of 1/(5 N).
# The last line that it prints is its answer: errors against the exact solution exp(-pi^2 t) sin(pi x), and values, by name.
import json
import math
import os
import subprocess
import sys
import tempfile

n = int(sys.argv[1])
end, steps = 0.1, n // 2
centres = [(i + 0.5) / n for i in range(n)]
start = " ".join(repr(math.sin(math.pi * x)) for x in centres)
files = {
    "system/blockMeshDict": f"""
vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1));
blocks (hex (0 1 2 3 4 5 6 7) ({n} 1 1) simpleGrading (1 1 1));
boundary (ends {{ type patch; faces ((0 4 7 3) (1 2 6 5)); }}
          sides {{ type empty; faces ((0 1 5 4) (3 7 6 2) (0 3 2 1) (4 5 6 7)); }});""",
    "system/controlDict": f"""
application laplacianFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {end};
deltaT {end / steps!r}; writeControl timeStep; writeInterval {steps}; writePrecision 16; timePrecision 12;""",
    "system/fvSchemes": """
ddtSchemes { default CrankNicolson 1; } gradSchemes { default Gauss linear; } divSchemes { default none; }
laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } snGradSchemes { default corrected; }""",
    "system/fvSolution": """
solvers { T { solver PCG; preconditioner DIC; tolerance 1e-14; relTol 0; } } SIMPLE { nNonOrthogonalCorrectors 0; }""",
    "constant/transportProperties": "DT DT [0 2 -1 0 0 0 0] 1;",
    "0/T": f"""
dimensions [0 0 0 1 0 0 0]; internalField nonuniform List<scalar> ({start});
boundaryField {{ ends {{ type fixedValue; value uniform 0; }} sides {{ type empty; }} }}""",
}
# Where the environment of OpenFOAM is not set, that of Debian's package; `env` in the study file sets another.
environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
with tempfile.TemporaryDirectory() as case:
    for path, text in files.items():
        os.makedirs(os.path.dirname(os.path.join(case, path)), exist_ok=True)
        kind = "volScalarField" if path == "0/T" else "dictionary"
        with open(os.path.join(case, path), "w") as file:
            file.write(f"FoamFile {{ version 2.0; format ascii; class {kind}; object {os.path.basename(path)}; }}\n{text}\n")
    for program in ["blockMesh", "laplacianFoam"]:
        subprocess.run([program], cwd=case, stdout=subprocess.DEVNULL, check=True, env=environment)
    with open(os.path.join(case, str(end), "T")) as file:
        values = file.read().split("List<scalar>")[1].split("(")[1].split(")")[0].split()

T = [float(value) for value in values]
exact = [math.exp(-math.pi**2 * end) * math.sin(math.pi * x) for x in centres]
error = max(abs(one - other) for one, other in zip(T, exact))
print(json.dumps({"errors": {"max": error}, "values": {"middle": (T[n // 2 - 1] + T[n // 2]) / 2}}))
