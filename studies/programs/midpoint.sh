#!/bin/sh
# The midpoint rule for the integral of exp(x y) over the unit square, with n square cells: their edge is the step.
errors() {
    awk -v n="$1" 'BEGIN {
        m = int(sqrt(n) + 0.5)
        h = 1 / m
        for (i = 0; i < m; i++) for (j = 0; j < m; j++) sum += h * h * exp((i + 0.5) * h * (j + 0.5) * h)
        exact = term = 1
        for (k = 1; k < 20; k++) { term /= k; exact += term / (k + 1) ^ 2 }
        error = sum - exact
        printf "{\"errors\": {\"integral\": %.15e}, \"h\": %.15e, \"work\": %d}\n", error < 0 ? -error : error, h, n
    }'
}

# For the harness:
errors "$1"
