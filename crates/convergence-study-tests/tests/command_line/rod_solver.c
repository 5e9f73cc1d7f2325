/* Heat in a rod by finite volumes in n cells and n steps of the trapezoidal rule; `solver N WRONG`
   plants a mistake: x_min, the slope at that face; time, the source at the old time; - none. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "rod.h"

/* The rows of dT/dt = A T + g in cells of width h. */
typedef struct {
    double below, at, above;
} Row;

static double conductivity(double x)
{
    return 0.3*(1.0 + x/4.0);
}

static Row row(int i, int n, double h, double first, double second)
{
    const double left = conductivity(i*h)/(h*h), right = conductivity((i + 1)*h)/(h*h);
    Row r = {left, -left - right, right};
    if (i == 0) {
        r.below = 0.0;
        r.at = -right - left*first;
        r.above = right - left*second;
    }
    if (i == n - 1) {
        r.at = -left;
        r.above = 0.0;
    }
    return r;
}

/* Source and boundary data; * t_source: the time of the source. */
static double given(int i, int n, double h, double value, double t, double t_source)
{
    const double x[] = {(i + 0.5)*h}, lower[] = {0.0}, upper[] = {2.0};
    double g = rod_source_T(x, t_source);
    if (i == 0) g -= conductivity(0.0)/(h*h)*value*rod_boundary_x_min_value(lower, t);
    if (i == n - 1) g += rod_boundary_x_max_flux(upper, t)/h;
    return g;
}

int main(int argc, char **argv)
{
    const int n = argc > 2 ? atoi(argv[1]) : 0;
    if (n < 2 || n > 1024) return 2;
    const double h = 2.0/n, dt = 1.0/n;
    /* The slope at x_min times h: first T[0] + second T[1] + value times the datum. */
    const int is_wrong = strcmp(argv[2], "x_min") == 0;
    const double first = is_wrong ? 1.0 : 3.0, second = is_wrong ? 0.0 : -1.0/3.0;
    const double value = is_wrong ? -1.0 : -8.0/3.0;
    static double T[1024], b[1024], c[1024];
    for (int i = 0; i < n; ++i) {
        const double x[] = {(i + 0.5)*h};
        T[i] = rod_initial_T(x);
    }
    for (int k = 0; k < n; ++k) {
        const double t = k*dt, later = (k + 1)*dt;
        const double t_source = strcmp(argv[2], "time") == 0 ? t : later;
        for (int i = 0; i < n; ++i) {
            const Row r = row(i, n, h, first, second);
            const double rate = (i > 0 ? r.below*T[i - 1] : 0.0) + r.at*T[i] + (i < n - 1 ? r.above*T[i + 1] : 0.0);
            b[i] = T[i] + dt/2.0*(rate + given(i, n, h, value, t, t) + given(i, n, h, value, later, t_source));
        }
        /* Elimination, then substitution. */
        for (int i = 0; i < n; ++i) {
            const Row r = row(i, n, h, first, second);
            const double below = -dt/2.0*r.below, above = -dt/2.0*r.above;
            const double pivot = 1.0 - dt/2.0*r.at - (i > 0 ? below*c[i - 1] : 0.0);
            c[i] = above/pivot;
            b[i] = (b[i] - (i > 0 ? below*b[i - 1] : 0.0))/pivot;
        }
        for (int i = n - 1; i >= 0; --i) T[i] = b[i] - (i < n - 1 ? c[i]*T[i + 1] : 0.0);
    }
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        const double x[] = {(i + 0.5)*h}, error = T[i] - rod_exact_T(x, 1.0);
        sum += h*error*error;
    }
    printf("L2 = %.12g\n", sqrt(sum));
    return 0;
}
