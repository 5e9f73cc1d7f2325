import sys

import numpy as np

import @NAME@ as library

face = sys.argv[1] if len(sys.argv) > 1 else ""
@SETTINGS@sys.stdin.readline()
points = np.array([[float(word) for word in line.split()[:@V@]] for line in sys.stdin]).T
x = points[:@D@]
@TIME@names, functions = {
@CALLS@}[face]
print(names)
rows = np.concatenate([np.reshape(function(x@T@), (-1, x.shape[1])) for function in functions])
for row in rows.T:
    print(" ".join(repr(float(value)) for value in row))
