/* The paper's own method, as its Sect. 4 describes it: Eq. (22) in (V, omega), Eqs. (6) and (10)
 * solved by Brent-Dekker at every right-hand side, both from the GNU Scientific Library.
 *
 * Every right-hand side follows the scheme of Fig. 4: lam from Eq. (6), epsilon from (8),
 * delta_star from (9); then, by |delta| < delta_star, beta from (10) and Q from (17), or full
 * slip; M from (18).  The law is continuous there, so nothing is carried and nothing chatters.
 *
 * stdin:  adams|bdf  rtol  atol  most_evaluations  n  times, then `times` output times,
 *         then n lines  alpha kappa mu gamma j V0 omega0
 * stdout: for each motion a line  status evaluations seconds, then `times` lines  V omega
 *         (nan from where the integrator gave up)
 *
 * cc -O2 paper_method.c $(pkg-config --cflags --libs gsl) -o paper_method
 */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_roots.h>
#include <gsl/gsl_sf_bessel.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define ROOT_TOLERANCE 1e-14
#define MOST_BRENT_STEPS 100

typedef struct {
    double alpha, kappa, mu, gamma, j;
    double speed, zeta, creep, front; /* of the state at hand, for the residuals */
    gsl_root_fsolver *solver;
    long evaluations, most;
} Scene;

/* Left side of Eq. (6); the exponentials of the scaled functions are a common factor. */
static double equation_6(double lam, void *data)
{
    const Scene *s = data;
    double zeta = lam / (2.0 * s->kappa * s->speed), x = s->alpha * zeta;
    double i0 = gsl_sf_bessel_I0_scaled(x), i1 = gsl_sf_bessel_I1_scaled(x);
    double k0 = gsl_sf_bessel_K0_scaled(zeta), k1 = gsl_sf_bessel_K1_scaled(zeta);
    return (1.0 - lam * lam) * (i0 * k1 + k0 * i1) + 2.0 / zeta * (1.0 / s->alpha - 1.0) * lam * lam * i1 * k1;
}

/* Left side of Eq. (10) over K1(beta zeta), which is infinite at beta = 0. */
static double equation_10(double beta, void *data)
{
    const Scene *s = data;
    if (beta == 0.0)
        return s->front - s->creep;
    double z = beta * s->zeta, x = s->alpha * z;
    double i0 = gsl_sf_bessel_I0_scaled(x), i1 = gsl_sf_bessel_I1_scaled(x);
    double k = gsl_sf_bessel_K0_scaled(z) / gsl_sf_bessel_K1_scaled(z);
    return (s->front - beta - s->creep) * (i0 + i1 * k) + (1.0 / s->alpha - 1.0) / s->zeta * i1 * k;
}

/* Root in [low, high] of a function that falls from >= 0 to <= 0; an end where rounding spoils the sign is it. */
static double root(double (*function)(double, void *), Scene *s, double low, double high)
{
    gsl_function f = {function, s};
    if (function(low, s) <= 0.0)
        return low;
    if (function(high, s) >= 0.0)
        return high;
    gsl_root_fsolver_set(s->solver, &f, low, high);
    for (int i = 0; i < MOST_BRENT_STEPS; i++) {
        if (gsl_root_fsolver_iterate(s->solver) != GSL_SUCCESS)
            break;
        low = gsl_root_fsolver_x_lower(s->solver);
        high = gsl_root_fsolver_x_upper(s->solver);
        if (gsl_root_test_interval(low, high, 0.0, ROOT_TOLERANCE) == GSL_SUCCESS)
            break;
    }
    return gsl_root_fsolver_root(s->solver);
}

/* Q and M of Eqs. (17), (18) by the scheme of Fig. 4. */
static void contact(Scene *s, double V, double omega, double *Q, double *M)
{
    double slip = omega - V, sign = (slip > 0.0) - (slip < 0.0);
    *Q = s->mu * sign;
    *M = 0.0;
    s->speed = fabs(V);
    if (s->speed == 0.0)
        return;
    double lam = s->alpha > 1.0 ? root(equation_6, s, 1.0 / sqrt(s->alpha), 1.0) : 1.0;
    double lam2 = lam * lam, zeta = s->zeta = lam / (2.0 * s->kappa * s->speed);
    double k = gsl_sf_bessel_K0_scaled(zeta) / gsl_sf_bessel_K1_scaled(zeta);
    double epsilon = 0.5 * (1.0 / lam2 - 1.0) * k;
    *M = copysign(lam / s->kappa * (0.5 * epsilon * (1.0 - lam2) + 0.5 / zeta * (lam2 - 1.0 / s->alpha)), V);
    double delta = fabs(slip) / s->speed, delta_star = s->mu * lam * (1.0 + epsilon) / (2.0 * s->kappa);
    if (delta >= delta_star)
        return;
    s->front = 1.0 + epsilon;
    s->creep = 2.0 * delta * s->kappa / (s->mu * lam);
    double beta = root(equation_10, s, 0.0, 1.0);
    if (beta == 0.0)
        return;
    double ratio = gsl_sf_bessel_K1_scaled(beta * zeta) / gsl_sf_bessel_K0_scaled(beta * zeta);
    *Q *= 1.0 - beta * beta * lam2 - 2.0 * beta * lam2 * (s->front - beta - s->creep) * ratio;
}

static int rates(double t, const double y[], double dydt[], void *data)
{
    Scene *s = data;
    double Q, M;
    (void)t;
    if (++s->evaluations > s->most)
        return GSL_EBADFUNC;
    contact(s, y[0], y[1], &Q, &M);
    dydt[0] = s->gamma * (Q - 0.5 * M);
    dydt[1] = -s->gamma / s->j * (Q + 0.5 * M);
    return GSL_SUCCESS;
}

/* Difference Jacobian; the increment, 1e-7 of the speed, is a small part of the stick band. */
static int jacobian(double t, const double y[], double *dfdy, double dfdt[], void *data)
{
    double base[2], moved[2] = {0.0, 0.0}, at[2];
    int status = rates(t, y, base, data);
    for (int n = 0; n < 2 && status == GSL_SUCCESS; n++) {
        double step = 1e-7 * (fabs(y[n]) + 1e-300);
        at[0] = y[0], at[1] = y[1];
        at[n] += step;
        step = at[n] - y[n];
        status = rates(t, at, moved, data);
        for (int m = 0; m < 2; m++)
            dfdy[2 * m + n] = (moved[m] - base[m]) / step;
    }
    dfdt[0] = dfdt[1] = 0.0;
    return status;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

int main(void)
{
    char name[8];
    double rtol, atol;
    long most;
    int n, times;
    if (scanf("%7s %lf %lf %ld %d %d", name, &rtol, &atol, &most, &n, &times) != 6 || times < 1)
        return 2;
    double *t_out = malloc(times * sizeof *t_out), *out = malloc(2 * times * sizeof *out);
    for (int i = 0; i < times; i++)
        if (scanf("%lf", &t_out[i]) != 1)
            return 2;
    gsl_set_error_handler_off();
    const gsl_odeiv2_step_type *method = strcmp(name, "adams") ? gsl_odeiv2_step_msbdf : gsl_odeiv2_step_msadams;
    Scene s;
    s.solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    s.most = most;
    for (int i = 0; i < n; i++) {
        double y[2], t = 0.0;
        if (scanf("%lf %lf %lf %lf %lf %lf %lf", &s.alpha, &s.kappa, &s.mu, &s.gamma, &s.j, &y[0], &y[1]) != 7)
            return 2;
        s.evaluations = 0;
        double start = now(), first = 1e-6 * t_out[times - 1];
        gsl_odeiv2_system system = {rates, jacobian, 2, &s};
        gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&system, method, first, atol, rtol);
        int status = GSL_SUCCESS;
        for (int m = 0; m < times; m++) {
            if (status == GSL_SUCCESS && t_out[m] > t)
                status = gsl_odeiv2_driver_apply(driver, &t, t_out[m], y);
            out[2 * m] = status == GSL_SUCCESS ? y[0] : NAN;
            out[2 * m + 1] = status == GSL_SUCCESS ? y[1] : NAN;
        }
        gsl_odeiv2_driver_free(driver);
        printf("%d %ld %.9g\n", status, s.evaluations, now() - start);
        for (int m = 0; m < times; m++)
            printf("%.17g %.17g\n", out[2 * m], out[2 * m + 1]);
    }
    gsl_root_fsolver_free(s.solver);
    free(t_out);
    free(out);
    return 0;
}
