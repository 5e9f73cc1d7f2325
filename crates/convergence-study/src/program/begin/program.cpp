// NAME.cpp: -u'' = pi^2 sin(pi x) on (0, 1) with u(0) = u(1) = 0, by central differences on N cells.
// What it prints is its answer: an error against the exact solution sin(pi x), and a value, by name.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

int main(int, char **arguments) {
    const double pi = std::acos(-1.0);
    const int n = std::atoi(arguments[1]);
    const double h = 1.0 / n;
    std::vector<double> u(n + 1), ratio(n + 1), right(n + 1);
    // Elimination for -u[i-1] + 2 u[i] - u[i+1] = h^2 f[i].
    for (int i = 1; i < n; ++i) {
        const double pivot = 2 - ratio[i - 1];
        ratio[i] = 1 / pivot;
        right[i] = (h * h * pi * pi * std::sin(pi * i * h) + right[i - 1]) / pivot;
    }
    for (int i = n - 1; i > 0; --i) u[i] = right[i] + ratio[i] * u[i + 1];
    double error = 0;
    for (int i = 0; i <= n; ++i) error = std::max(error, std::abs(u[i] - std::sin(pi * i * h)));
    std::printf("max = %.16e\nmiddle = %.16e\n", error, u[n / 2]);
}
