# The heat equation T_t = T_xx on (0, 1) by OpenFOAM's laplacianFoam, with the solution exp(-pi^2 t) sin(pi x).
import json
import math
import os
import re
import subprocess
import sys
import tempfile

n = int(sys.argv[1])
steps, t_end = n // 4, 0.05
dt = t_end / steps
centres = [(i + 0.5) / n for i in range(n)]
HEAD = "FoamFile { version 2.0; format ascii; class %s; object %s; }\n"
MESH = """vertices ((0 0 0) (1 0 0) (1 0.1 0) (0 0.1 0) (0 0 0.1) (1 0 0.1) (1 0.1 0.1) (0 0.1 0.1));
blocks (hex (0 1 2 3 4 5 6 7) (%d 1 1) simpleGrading (1 1 1));
boundary (ends { type patch; faces ((0 4 7 3) (1 2 6 5)); }
          sides { type empty; faces ((0 1 5 4) (3 7 6 2) (0 3 2 1) (4 5 6 7)); });
"""
FILES = {
    "system/blockMeshDict": ("dictionary", MESH % n),
    "system/controlDict": ("dictionary", f"application laplacianFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {t_end!r};"
                           f" deltaT {dt!r}; writeControl timeStep; writeInterval {steps}; writePrecision 16; timePrecision 12;"),
    "system/fvSchemes": ("dictionary", "ddtSchemes { default CrankNicolson 1; } gradSchemes { default Gauss linear; } divSchemes { default none; }"
                         " laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } snGradSchemes { default corrected; }"),
    "system/fvSolution": ("dictionary", "solvers { T { solver PCG; preconditioner DIC; tolerance 1e-14; relTol 0; } } SIMPLE { nNonOrthogonalCorrectors 0; }"),
    "constant/transportProperties": ("dictionary", "DT DT [0 2 -1 0 0 0 0] 1;"),
    "0/T": ("volScalarField", "dimensions [0 0 0 1 0 0 0]; internalField nonuniform List<scalar> (%s);"
            " boundaryField { ends { type fixedValue; value uniform 0; } sides { type empty; } }" % " ".join(repr(math.sin(math.pi * x)) for x in centres)),
}
with tempfile.TemporaryDirectory() as case:
    for path, (kind, text) in FILES.items():
        os.makedirs(os.path.join(case, os.path.dirname(path)), exist_ok=True)
        with open(os.path.join(case, path), "w") as file:
            file.write(HEAD % (kind, os.path.basename(path)) + text)
    for program in ["blockMesh", "laplacianFoam"]:
        subprocess.run([program], cwd=case, stdout=subprocess.PIPE, check=True)
    last = max((name for name in os.listdir(case) if re.fullmatch(r"0\.\d+", name)), key=float)
    with open(os.path.join(case, last, "T")) as file:
        values = [float(word) for word in re.search(r"List<scalar>\s*\d*\s*\(([^)]*)\)", file.read()).group(1).split()]
exact = [math.exp(-math.pi**2 * float(last)) * math.sin(math.pi * x) for x in centres]
# For the harness:
errors = [abs(value - other) for value, other in zip(values, exact)]
print(json.dumps({"errors": {"L2": math.sqrt(sum(e * e for e in errors) / n), "max": max(errors)}}))
