// The advection equation u_t + u_x = 0 on (0, 1) by Lax and Wendroff's scheme, with the solution sin(2 pi (x - t)).
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

double exact(double x, double t) { return std::sin(2 * M_PI * (x - t)); }

// The L2 error at t = 1 with n cells, at Courant number 1/2.
double error(int n) {
    const double h = 1.0 / n, dt = h / 2, c = dt / h;
    std::vector<double> u(n + 1), next(n + 1);
    for (int i = 0; i <= n; i++) u[i] = exact(i * h, 0);
    for (int step = 0; step < 2 * n; step++) {
        const double t = (step + 1) * dt;
        for (int i = 1; i < n; i++)
            next[i] = u[i] - c / 2 * (u[i + 1] - u[i - 1]) + c * c / 2 * (u[i + 1] - 2 * u[i] + u[i - 1]);
        next[0] = exact(0, t);                         // inflow
        next[n] = u[n] - c * (u[n] - u[n - 1]);        // outflow: upwind
        u.swap(next);
    }
    double sum = 0;
    for (int i = 0; i <= n; i++) sum += h * std::pow(u[i] - exact(i * h, 1), 2);
    return std::sqrt(sum);
}

// For the harness:
int main(int, char** words) {
    const int n = std::atoi(words[1]);
    std::printf("{\"errors\": {\"L2\": %.15e}, \"work\": %.0f}\n", error(n), 2.0 * n * n);
}
