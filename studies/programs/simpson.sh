#!/bin/sh
# Simpson's rule for the integral of sqrt(1 + x) over (0, 1), with n double cells.
errors() {
    awk -v n="$1" 'BEGIN {
        h = 1 / n
        for (i = 0; i < n; i++) sum += h / 6 * (sqrt(1 + i * h) + 4 * sqrt(1 + (i + 0.5) * h) + sqrt(1 + (i + 1) * h))
        error = sum - 2 / 3 * (2 * sqrt(2) - 1)
        printf "{\"errors\": {\"integral\": %.15e}, \"work\": %d}\n", error < 0 ? -error : error, 3 * n
    }'
}

# For the harness: n is in the object on standard input.
read -r case
errors "$(printf '%s' "$case" | sed 's/.*"n": \([0-9]*\).*/\1/')"
