/* Eq. (22) by the table of a law: a roller rolls on by RODAS (Hairer and Wanner, order 4, L-stable, exact Jacobian),
 * which takes as many steps of its own as a tolerance needs, however long or short the time that it is asked for.
 * State: V and the slip omega - V, which would drown in the rounding of omega and V.  Sliding, sticking and reversal
 * are no events, for the slope of Q is continuous at the end of stick, and below the speed `rest` the law is smooth.
 */
#ifndef VR_ROLL_H
#define VR_ROLL_H
#include <stddef.h>
#ifndef VR_LAW_H
#include "vr_law.h"
#endif

typedef struct {
  const vr_law *law;
  double kappa, mu, gamma, j;
  double force, torque; /* on the axis, over P and P R */
  double rest;          /* far below the speeds of interest: below it creep counts from it, a thousandth of it is rest;
                           0: set by the first call, to 1e-9 of the speeds then */
  double V, slip, x;    /* state and way; 0 at rest */
  double step;          /* to try: 0 at the start */
  long steps, rejected;
} vr_roller;

/* Steps that one call may take: some seconds; a motion of the examples needs 1e2 to 1e4. */
#define VR_MOST_STEPS 1000000L

/* what vr_roll gives back */
enum {
  VR_DONE = 0,
  VR_STUCK = 1,  /* the steps fell to rounding or are more than VR_MOST_STEPS, or the state left the range of doubles:
                    it is that of the last step */
  VR_REFUSED = 2 /* a number that is NaN, infinite or out of range: nothing has changed */
};

/* Speed from which creep counts, and its slope over V: |V|, but below `rest` a polynomial that meets it with two
 * slopes and stays above 3/8 rest.  Without it Q, a function of slip/V, would jump where V turns. */
static inline double vr_creep_speed(double V, double rest, double *slope) {
  double u = V / rest;
  if (!(fabs(u) < 1.0)) return *slope = V < 0.0 ? -1.0 : 1.0, fabs(V);
  *slope = (3.0 - u * u) * u / 2.0;
  return rest * (3.0 + u * u * (6.0 - u * u)) / 8.0;
}

/* The contact near rest too: at V = 0, force and slopes are finite.  Slopes: dQ_domega at fixed V as ever; of Q over V
 * at fixed slip, unlike in vr_contact_slopes.  Below `rest` the moments without traction, and the
 * asymmetry of a cover, are in proportion to V; the slopes leave the change of the latter out. */
static inline void vr_contact_near_rest(const vr_law *law, double kappa, double mu, double V, double slip, double rest,
                                        vr_state *s, vr_slopes *d) {
  double bend, speed = vr_creep_speed(V, rest, &bend), part = V / speed, more = (1.0 - part * bend) / speed;
  double slope, delta_0 = vr_free_creep(law, kappa, speed, &slope);
  vr_solve(law, kappa, mu, speed, (slip - V * delta_0) / speed, delta_0, part, s, d);
  d->dQ_dV = (d->dQ_dV + d->dQ_domega) * bend;
  if (law->creep) d->dQ_dV -= (delta_0 + V * slope * bend) * d->dQ_domega; /* d(V delta_0)/dV */
  d->dM_half_space_dV = part * bend * d->dM_half_space_dV + more * s->M_half_space;
  d->dM_cylinder_dV = part * bend * d->dM_cylinder_dV + more * s->M_cylinder;
  d->dM_dV = d->dM_half_space_dV + d->dM_cylinder_dV;
  s->M_half_space *= part, s->M_cylinder *= part, s->M *= part;
  vr_shear(law, kappa, mu, kappa * speed, kappa * bend, s, d);
}

/* dV/dt and d(slip)/dt at y = (V, slip), and their slopes where J is not NULL */
static inline void vr_rates(const vr_roller *r, const double y[2], double f[2], double (*J)[2]) {
  double a = 1.0 + 1.0 / r->j, b = 1.0 / r->j, g = r->gamma;
  vr_state s;
  vr_slopes d;
  vr_contact_near_rest(r->law, r->kappa, r->mu, y[0], y[1], r->rest, &s, &d);
  f[0] = g * (s.Q - s.M_half_space + r->force);
  f[1] = g * (-a * s.Q - b * s.M_cylinder + s.M_half_space - r->force + b * r->torque);
  if (!J) return;
  J[0][0] = g * (d.dQ_dV - d.dM_half_space_dV), J[0][1] = g * (d.dQ_domega - d.dM_half_space_domega);
  J[1][0] = g * (-a * d.dQ_dV - b * d.dM_cylinder_dV + d.dM_half_space_dV);
  J[1][1] = g * (-a * d.dQ_domega - b * d.dM_cylinder_domega + d.dM_half_space_domega);
}

/* One step of RODAS from y and x, of which J holds the slopes at y and f the rates; error: of V and slip. */
static inline void vr_step(const vr_roller *r, double step, const double f[2], double (*J)[2], double y[2], double *x,
                           double error[2]) {
  static const double A[6][5] = {{0.0}, {1.544}, {0.9466785280815826, 0.2557011698983284},
    {3.314825187068521, 2.896124015972201, 0.9986419139977817},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1.0}};
  static const double C[6][5] = {{0.0}, {-5.6688}, {-2.430093356833875, -0.2063599157091915},
    {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
    {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
    {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054}};
  double y0[2] = {y[0], y[1]}, k[6][3], g[2], way;
  double d = 4.0 / step, a = d - J[0][0], e = d - J[1][1], det = a * e - J[0][1] * J[1][0];
  int i, n, m;
  for (i = 0; i < 6; i++) {
    for (n = 0; n < 2; n++)
      for (g[n] = f[n], y[n] = y0[n], m = 0; m < i; m++) y[n] += A[i][m] * k[m][n];
    if (i) vr_rates(r, y, g, NULL);
    for (n = 0; n < 2; n++)
      for (m = 0; m < i; m++) g[n] += C[i][m] * k[m][n] / step;
    k[i][0] = (e * g[0] + J[0][1] * g[1]) / det, k[i][1] = (a * g[1] + J[1][0] * g[0]) / det;
    for (way = y[0], m = 0; m < i; m++) way += C[i][m] * k[m][2] / step;
    k[i][2] = (way + k[i][0]) / d; /* of x' = V */
  }
  for (m = 0; m < 5; m++) *x += A[5][m] * k[m][2];
  *x += k[5][2];
  for (n = 0; n < 2; n++) y[n] += k[5][n], error[n] = k[5][n];
}

/* Error of a step over what `rtol` allows: of V over the larger speed, of the slip over itself or the band of stick. */
static inline double vr_error(const vr_roller *r, double rtol, const double y[2], const double error[2]) {
  double size = fmax(fmax(fabs(r->V), fabs(y[0])), r->rest), band = 0.5 * r->mu / r->kappa * size; /* delta_star V */
  double of_V = error[0] / (rtol * size), of_slip = error[1] / (rtol * fmax(fmax(fabs(r->slip), fabs(y[1])), band));
  return sqrt(0.5 * (of_V * of_V + of_slip * of_slip));
}

static inline int vr_finite(double value) { return fabs(value) < HUGE_VAL; }
static inline int vr_positive(double value) { return value > 0.0 && value < HUGE_VAL; }

/* On by a time >= 0, with local errors of at most rtol: VR_DONE, VR_STUCK or VR_REFUSED */
static inline int vr_roll(vr_roller *r, double time, double rtol) {
  double t = 0.0, h = r->step > 0.0 ? r->step : 1e-6 * time, f[2] = {0.0}, J[2][2] = {{0.0}};
  const long most = r->steps + r->rejected + VR_MOST_STEPS;
  int fresh = 1;
  if (!(vr_finite(time) && time >= 0.0 && rtol > 0.0 && rtol < 1.0)) return VR_REFUSED;
  if (!(vr_positive(r->kappa) && vr_positive(r->mu) && vr_positive(r->gamma))) return VR_REFUSED;
  if (!(vr_positive(r->j) && r->rest >= 0.0 && vr_finite(r->force) && vr_finite(r->torque))) return VR_REFUSED;
  if (!(vr_finite(r->V) && vr_finite(r->slip) && vr_finite(r->x) && vr_finite(r->step))) return VR_REFUSED;
  double rest = r->rest > 0.0 ? r->rest : 1e-9 * fmax(fabs(r->V) + fabs(r->slip),
                                                      r->gamma * (fabs(r->force) + fabs(r->torque)) * time) + 1e-300;
  if (!vr_finite(rest)) return VR_REFUSED;
  r->rest = rest;
  while (t < time) {
    if (r->force == 0.0 && r->torque == 0.0 && fabs(r->V) + fabs(r->slip) <= 1e-3 * r->rest) {
      r->V = r->slip = 0.0; /* at rest, where nothing drives it */
      return VR_DONE;
    }
    if (r->steps + r->rejected >= most) return VR_STUCK;
    int last = t + h >= time * (1.0 - 1e-14);
    double step = last ? time - t : h, y[2] = {r->V, r->slip}, x = r->x, error[2];
    if (fresh) vr_rates(r, y, f, J), fresh = 0;
    vr_step(r, step, f, J, y, &x, error);
    double ratio = vr_error(r, rtol, y, error); /* NaN where it left the range of doubles */
    double factor = ratio >= 0.0 ? fmin(fmax(0.9 * pow(ratio, -0.25), 0.2), 5.0) : 0.2;
    if (ratio <= 1.0) {
      t = last ? time : t + step, r->V = y[0], r->slip = y[1], r->x = x, fresh = 1, r->steps++;
      h = last ? fmax(h, step * fmin(factor, 1.0)) : step * factor;
    } else {
      h = step * fmin(factor, 0.9), r->rejected++;
      if (!(t + h > t && h > 1e-300)) return VR_STUCK;
    }
  }
  r->step = h;
  return VR_DONE;
}
#endif
