/* Eq. (22) by the table of a law: a roller rolls on by RODAS (Hairer and Wanner, order 4, L-stable, exact Jacobian).
 * State: V and the slip omega - V, which would drown in the rounding of omega and V.  Sliding, sticking and reversal are no
 * events, for the slope of Q is continuous at the end of stick.
 */
#ifndef VR_ROLL_H
#define VR_ROLL_H
#ifndef VR_LAW_H
#include "vr_law.h"
#endif

typedef struct {
  const vr_law *law;
  double kappa, mu, gamma, j;
  double force, torque; /* on the axis, over P and P R */
  double rest;          /* below this speed errors count as at it; > 0 where the motion comes to rest */
  double V, slip, x;    /* state and way; from rest start at a V that does not matter, not 0 */
  double step;          /* to try: 0 at the start */
  long steps, rejected;
} vr_roller;

/* dV/dt and d(slip)/dt at y = (V, slip), and their slopes where J is not NULL */
static inline void vr_rates(const vr_roller *r, const double y[2], double f[2], double (*J)[2]) {
  double a = 1.0 + 1.0 / r->j, b = 1.0 / r->j, g = r->gamma;
  vr_state s;
  vr_slopes d;
  if (J) vr_contact_slopes(r->law, r->kappa, r->mu, y[0], y[1], &s, &d);
  else s = vr_contact(r->law, r->kappa, r->mu, y[0], y[1]);
  f[0] = g * (s.Q - s.M_half_space + r->force);
  f[1] = g * (-a * s.Q - b * s.M_cylinder + s.M_half_space - r->force + b * r->torque);
  if (!J) return;
  double Q_slip = d.dQ_domega, Q_V = d.dQ_dV + Q_slip; /* at fixed V, slip */
  J[0][0] = g * (Q_V - d.dM_half_space_dV), J[0][1] = g * Q_slip;
  J[1][0] = g * (-a * Q_V - b * d.dM_cylinder_dV + d.dM_half_space_dV), J[1][1] = -g * a * Q_slip;
}

/* On by a time; 0, or 1 where the step fell below 1e-14 of it */
static inline int vr_roll(vr_roller *r, double time, double rtol) {
  static const double A[6][5] = {{0.0}, {1.544}, {0.9466785280815826, 0.2557011698983284},
    {3.314825187068521, 2.896124015972201, 0.9986419139977817},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1.0}};
  static const double C[6][5] = {{0.0}, {-5.6688}, {-2.430093356833875, -0.2063599157091915},
    {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
    {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
    {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054}};
  double t = 0.0, h = r->step > 0.0 ? r->step : 1e-6 * time, f[2] = {0.0}, J[2][2] = {{0.0}}, k[6][3], y[2], g[2], way;
  int fresh = 1, i, n, m;
  while (t < time) {
    if (r->force == 0.0 && r->torque == 0.0 && fabs(r->V) + fabs(r->slip) < 1e-3 * r->rest) return 0; /* at rest */
    int last = t + h >= time * (1.0 - 1e-14);
    double step = last ? time - t : h, y0[2] = {r->V, r->slip};
    if (fresh) vr_rates(r, y0, f, J), fresh = 0;
    double d = 4.0 / step, a = d - J[0][0], e = d - J[1][1], det = a * e - J[0][1] * J[1][0];
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
    for (way = r->x + k[5][2], m = 0; m < 5; m++) way += A[5][m] * k[m][2];
    y[0] += k[5][0], y[1] += k[5][1];
    double size = fmax(fmax(fabs(y0[0]), fabs(y[0])), r->rest) + 1e-300, band = 0.5 * r->mu / r->kappa * size; /* delta_star V */
    double w0 = rtol * size, w1 = rtol * fmax(fmax(fabs(y0[1]), fabs(y[1])), band);
    double error = sqrt(0.5 * (k[5][0] / w0 * (k[5][0] / w0) + k[5][1] / w1 * (k[5][1] / w1)));
    double factor = error > 0.0 ? fmin(fmax(0.9 * pow(error, -0.25), 0.2), 5.0) : 5.0;
    if (error <= 1.0) {
      t = last ? time : t + step, r->V = y[0], r->slip = y[1], r->x = way, fresh = 1, r->steps++;
      h = last ? fmax(h, step * fmin(factor, 1.0)) : step * factor;
    } else {
      h = step * fmin(factor, 0.9), r->rejected++;
      if (!(h > 1e-14 * time)) return 1;
    }
  }
  r->step = h;
  return 0;
}
#endif
