// The paper's first experiment by a library: elements of degree p in space, and in time CVODE of SUNDIALS.
//
//     u' = v, phi' = w
//     M v' = -K ((1 + N) u + zeta v) + C (phi + zeta w) - g(u(1)) e,      N = beta + rho u^T K u
//     M w' = -(K + M)(phi + zeta w) + C^T (u + zeta v) + a C theta
//     M theta' = -K theta - a C^T w
//
// Everything is built here from formulas: nothing of the solver that this program checks is used. CVODE gets the
// right-hand side, multiplied by M^{-1}, its exact dense Jacobian, and the distances to the obstacles. Where contact
// begins or ends the right-hand side has a kink: there CVODE stops and starts anew. cvode.toml says how to compile.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <utility>
#include <vector>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

using Vector = std::vector<double>;
using Matrix = std::vector<Vector>;

const double rho = 1, beta = 0, a = 0.017, epsilon = 1e-3, lower = -0.01, upper = 0.1;

// The Legendre polynomials P_0 ... P_m at x, m >= 1.
Vector legendre(int m, double x) {
    Vector p = {1, x};
    for (int k = 1; k < m; k++) p.push_back(((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1));
    return p;
}

// Points and weights of the Gauss rule on (-1, 1): the zeros of P_m, by Newton's method.
std::vector<std::pair<double, double>> gauss(int m) {
    std::vector<std::pair<double, double>> points;
    for (int k = 0; k < m; k++) {
        double x = std::cos(M_PI * (k + 0.75) / (m + 0.5)), slope = 1;
        for (int pass = 0; pass < 20; pass++) {
            const Vector p = legendre(m, x);
            slope = m * (x * p[m] - p[m - 1]) / (x * x - 1);
            x -= p[m] / slope;
        }
        points.push_back({x, 2 / ((1 - x * x) * slope * slope)});
    }
    return points;
}

// Piecewise polynomials of degree p that vanish at x = 0. The basis: hat functions, that of x = 1 last; then on each
// element the integrated Legendre polynomials (P_m - P_{m-2}) / (2m - 1), m = 2 ... p.
struct Space {
    Vector nodes;
    int degree, elements = nodes.size() - 1, size = elements * degree;

    // The number of an element's function. 0 and 1 are its hat functions; -1: that of x = 0, which is not in the basis.
    int number(int element, int m) const { return m < 2 ? element + m - 1 : elements + element * (degree - 1) + m - 2; }

    // A function on (-1, 1), or its derivative, as coefficients of P_0 ... P_p.
    Vector coefficients(int m, bool derivative) const {
        Vector c(degree + 1);
        if (derivative) c[std::max(m - 1, 0)] = m < 2 ? m - 0.5 : 1;
        else if (m < 2) c[0] = 0.5, c[1] = m - 0.5;
        else c[m] = 1.0 / (2 * m - 1), c[m - 2] = -c[m];
        return c;
    }

    // M; with derivatives of both K; with derivatives of the rows alone C.
    Matrix products(bool rows, bool columns) const {
        Matrix matrix(size, Vector(size));
        for (int e = 0; e < elements; e++)
            for (int i = 0; i <= degree; i++)
                for (int j = 0; j <= degree; j++) {
                    const Vector left = coefficients(i, rows), right = coefficients(j, columns);
                    double sum = 0;
                    for (int k = 0; k <= degree; k++) sum += left[k] * right[k] * 2 / (2 * k + 1);
                    const int row = number(e, i), column = number(e, j);
                    if (row >= 0 && column >= 0)
                        matrix[row][column] += std::pow((nodes[e + 1] - nodes[e]) / 2, 1 - rows - columns) * sum;
                }
        return matrix;
    }

    // The projection (3.6) of a function with its derivative: equal at the nodes, closest in the derivative.
    template <class F, class Derivative> Vector project(F f, Derivative derivative) const {
        Vector y(size);
        for (int e = 0; e < elements; e++) {
            const double half = (nodes[e + 1] - nodes[e]) / 2;
            y[number(e, 1)] = f(nodes[e + 1]);
            for (auto [x, weight] : gauss(degree + 20)) {
                const Vector p = legendre(degree, x);
                for (int m = 2; m <= degree; m++)
                    y[number(e, m)] += (m - 0.5) * weight * half * derivative(nodes[e] + half * (1 + x)) * p[m - 1];
            }
        }
        return y;
    }
};

// M^{-1} B for a positive definite M.
Matrix solve(Matrix m, Matrix b) {
    const int n = m.size();
    for (int k = 0; k < n; k++)
        for (int i = 0; i < n; i++) {
            const double factor = i == k ? 1 - 1 / m[k][k] : m[i][k] / m[k][k];
            for (int j = n - 1; j >= k; j--) m[i][j] -= factor * m[k][j];
            for (int j = b[i].size() - 1; j >= 0; j--) b[i][j] -= factor * b[k][j];
        }
    return b;
}

// y' = A y - (N - beta) B u - g(u(1)) r, y = (u, phi, v, w, theta). In the rows of v, B = M^{-1} K and r = M^{-1} e.
struct Beam {
    Space space;
    int n = space.size, tip = space.elements - 1, unknowns = 5 * n;
    Matrix linear, axial, stiffness;        // A, B, K: column by column
    Vector end;                             // r
    double obstacle = 0, compliance = 0;    // g(u) = compliance (u - obstacle)

    Beam(const Space& on, double zeta) : space(on), linear(unknowns, Vector(unknowns)) {
        const Matrix m = space.products(false, false), k = space.products(true, true), c = space.products(true, false);
        Matrix right(3 * n, Vector(unknowns)), tips(n, Vector(1)), held = m;
        auto add = [&](int row, int column, double factor, const Matrix& of, bool transposed = false) {
            for (int i = 0; i < n; i++)
                for (int j = 0; j < n; j++)
                    right[row * n + i][column * n + j] += factor * (transposed ? of[j][i] : of[i][j]);
        };
        add(0, 0, -1 - beta, k), add(0, 2, -zeta, k), add(0, 1, 1, c), add(0, 3, zeta, c);
        add(1, 1, -1, k), add(1, 3, -zeta, k), add(1, 1, -1, m), add(1, 3, -zeta, m);
        add(1, 0, 1, c, true), add(1, 2, zeta, c, true), add(1, 4, a, c);
        add(2, 4, -1, k), add(2, 3, -a, c, true);
        // theta(1) = 0 stays what it is.
        right[2 * n + tip] = Vector(unknowns);
        for (int i = 0; i < n; i++) held[tip][i] = held[i][tip] = i == tip;
        for (int row = 0; row < 3; row++) {
            const Matrix part = solve(row < 2 ? m : held, Matrix(&right[row * n], &right[row * n] + n));
            for (int i = 0; i < n; i++)
                for (int j = 0; j < unknowns; j++) linear[j][(row + 2) * n + i] = part[i][j];
        }
        for (int i = 0; i < 2 * n; i++) linear[2 * n + i][i] = 1;
        stiffness = axial = k;
        const Matrix inverse = solve(m, k);
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) axial[j][i] = inverse[i][j];
        tips[tip][0] = 1;
        for (const Vector& row : solve(m, tips)) end.push_back(row[0]);
    }

    // N - beta, with K u and B u.
    double force(const double* u, Vector& ku, Vector& bu) const {
        ku = bu = Vector(n);
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++) ku[i] += stiffness[j][i] * u[j], bu[i] += axial[j][i] * u[j];
        double sum = 0;
        for (int i = 0; i < n; i++) sum += rho * ku[i] * u[i];
        return sum;
    }

    void rates(const double* y, double* dy) const {
        Vector ku, bu;
        const double stretch = force(y, ku, bu), contact = compliance * (y[tip] - obstacle);
        std::fill(dy, dy + unknowns, 0);
        for (int j = 0; j < unknowns; j++)
            for (int i = 0; i < unknowns; i++) dy[i] += linear[j][i] * y[j];
        for (int i = 0; i < n; i++) dy[2 * n + i] -= stretch * bu[i] + contact * end[i];
    }

    void jacobian(const double* y, SUNMatrix matrix) const {
        Vector ku, bu;
        const double stretch = force(y, ku, bu);
        for (int j = 0; j < unknowns; j++) {
            double* column = SM_COLUMN_D(matrix, j);
            std::copy(linear[j].begin(), linear[j].end(), column);
            for (int i = 0; i < n && j < n; i++)
                column[2 * n + i] -= stretch * axial[j][i] + 2 * rho * bu[i] * ku[j] + (j == tip) * compliance * end[i];
        }
    }

    Vector start() const {
        auto u = space.project([](double x) { return 0.01 * x * (x - 2); }, [](double x) { return 0.02 * (x - 1); });
        auto v = space.project([](double x) { return 20 * x * (x - 1) * (x - 1); },
                               [](double x) { return 20 * (x - 1) * (3 * x - 1); });
        auto theta = space.project([](double x) { return x < 1 ? std::sin(M_PI * x) : 0; },
                                   [](double x) { return M_PI * std::cos(M_PI * x); });
        Vector y;
        for (const Vector& field : {u, Vector(n), v, Vector(n), theta}) y.insert(y.end(), field.begin(), field.end());
        return y;
    }
};

int must(int flag) {
    if (flag < 0) throw std::runtime_error("CVODE failed with flag " + std::to_string(flag));
    return flag;
}

// y at t = 1, with this relative and absolute tolerance.
Vector integrate(Beam beam, double tolerance) {
    SUNContext context;
    must(SUNContext_Create(nullptr, &context));
    Vector values = beam.start();
    N_Vector y = N_VMake_Serial(beam.unknowns, values.data(), context);
    SUNMatrix matrix = SUNDenseMatrix(beam.unknowns, beam.unknowns, context);
    SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
    void* cvode = CVodeCreate(CV_BDF, context);
    auto rates = [](realtype, N_Vector y, N_Vector dy, void* beam) {
        return static_cast<Beam*>(beam)->rates(N_VGetArrayPointer(y), N_VGetArrayPointer(dy)), 0;
    };
    auto jacobian = [](realtype, N_Vector y, N_Vector, SUNMatrix matrix, void* beam, N_Vector, N_Vector, N_Vector) {
        return static_cast<Beam*>(beam)->jacobian(N_VGetArrayPointer(y), matrix), 0;
    };
    auto gaps = [](realtype, N_Vector y, realtype* gaps, void* beam) {
        const double u = N_VGetArrayPointer(y)[static_cast<Beam*>(beam)->tip];
        return gaps[0] = u - lower, gaps[1] = u - upper, 0;
    };
    must(CVodeInit(cvode, rates, 0, y)), must(CVodeSStolerances(cvode, tolerance, tolerance));
    must(CVodeSetUserData(cvode, &beam)), must(CVodeSetMaxNumSteps(cvode, 1000000));
    must(CVodeSetLinearSolver(cvode, solver, matrix)), must(CVodeSetJacFn(cvode, jacobian));
    must(CVodeRootInit(cvode, 2, gaps)), must(CVodeSetNoInactiveRootWarn(cvode));
    realtype t;
    while (must(CVode(cvode, 1, y, &t, CV_NORMAL)) == CV_ROOT_RETURN) {
        int crossed[2];
        must(CVodeGetRootInfo(cvode, crossed));
        beam.compliance = crossed[0] < 0 || crossed[1] > 0 ? 1 / epsilon : 0;
        beam.obstacle = crossed[0] ? lower : upper;
        must(CVodeReInit(cvode, t, y));
    }
    CVodeFree(&cvode), SUNLinSolFree(solver), SUNMatDestroy(matrix), N_VDestroy(y), SUNContext_Free(&context);
    return values;
}

// For the harness:
int main(int words, char** word) {
    const int n = words < 2 ? 0 : std::atoi(word[1]);
    if (n < 1) return std::fprintf(stderr, "expected a number of elements >= 1\n"), 2;
    Vector nodes;
    for (int i = 0; i <= n; i++) nodes.push_back(double(i) / n);
    // u(1, 1) by dG in time, on one element of degree 32 and on two of degree 26: they agree in these digits.
    const Beam beam({nodes, 2}, 0.1);
    const double u = integrate(beam, 1e-11)[beam.tip], known = -0.011764243809983;
    std::printf("{\"errors\": {\"u(1, 1)\": %.9e}, \"work\": %d}\n", std::abs(u - known), 10 * n);
}
