# NAME.sh N: -u'' = pi^2 sin(pi x) on (0, 1) with u(0) = u(1) = 0, by central differences on N cells.
# What it prints is its answer: an error against the exact solution sin(pi x), and a value, by name.
awk -v n="$1" 'BEGIN {
    pi = atan2(0, -1); h = 1 / n
    # Elimination for -u[i-1] + 2 u[i] - u[i+1] = h^2 f[i].
    for (i = 1; i < n; i++) {
        pivot = 2 - ratio[i - 1]; ratio[i] = 1 / pivot
        right[i] = (h^2 * pi^2 * sin(pi * i * h) + right[i - 1]) / pivot
    }
    for (i = n - 1; i > 0; i--) {
        u[i] = right[i] + ratio[i] * u[i + 1]
        error = u[i] - sin(pi * i * h); if (error < 0) error = -error
        if (error > max) max = error
    }
    printf "max = %.16e\nmiddle = %.16e\n", max, u[n / 2]
}'
