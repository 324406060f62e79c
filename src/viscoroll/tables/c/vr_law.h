/* The contact law of viscoelastic cylinders that roll with partial slip, from the table of one material or pair, or of
 * a cover (a layer of finite thickness) at one ratio of thickness and contact length.
 *
 * C99 and C++, one header, no allocation, no state, thread safe; of libm: copysign, frexp, ldexp, log, log1p, sqrt, fabs,
 * fmin, fmax.
 * Dimensionless: V in R/T_ref, forces over the load P, moments over P R.  V and slip = omega - V have any sign.
 * All values are NaN where one of these is NaN or infinite, kappa or mu is not above 0, or kappa |V| is above 1e300.
 * Of a cover N is not known: it is NaN.
 *
 *     vr_state s = vr_contact(&rubber, kappa, mu, V, slip);
 *     vr_slopes d;
 *     vr_contact_slopes(&rubber, kappa, mu, V, slip, &s, &d);
 */
#ifndef VR_LAW_H
#define VR_LAW_H
#include <math.h>

enum { VR_TERMS = 24, VR_FUNCTIONS = 7 };
/* functions of kappa |V|, then of v = 1/F(eta) */
enum { VR_LAM, VR_EPSILON, VR_M_HALF_SPACE, VR_M_CYLINDER, VR_N, VR_SHARE, VR_PRESS };
/* what a cover has besides: L = 2 kappa delta_star/mu, f and g of half-space and cylinder, slopes of lam and epsilon in
 * Q; 2 kappa delta_0 is the sum of f, and g changes M of full slip and the onsets of full slip */
enum { VR_LIMIT, VR_FREE, VR_EXCESS = 3, VR_TILT = 5, VR_CREEP_FUNCTIONS = 7 };

typedef struct {
  int rows, e0;                /* row 0: x in [0, 2^e0); row n: x in [2^(e0+n-1), 2^(e0+n)); beyond: the fast limit */
  double alpha, limit[3][2];   /* sum J_j/T_j and sum J_j/T_j (ln 2 T_j - 0.5772...): of all, half-space, cylinder */
  const double (*c)[VR_TERMS][VR_FUNCTIONS]; /* coefficients of powers of t */
  const double (*creep)[VR_TERMS][VR_CREEP_FUNCTIONS]; /* of a cover, over kappa |V|; a null pointer of half-spaces */
  double fast[18]; /* of a cover as kappa |V| -> infinity, each with its factor of 1/(kappa |V|): lam and functions of
                      creep from the second on; share, with its factor of F; epsilon kappa |V|; unused */
} vr_law;

/* delta_0: creep of free rolling on a cover; 0 of half-spaces */
typedef struct { double lam, epsilon, delta_star, delta_0, beta, Q, M, M_half_space, M_cylinder, N; } vr_state;
/* over V at fixed omega, over omega at fixed V; at V = 0 those of Q, and of M of a cover, are not finite */
typedef struct {
  double dQ_dV, dQ_domega, dM_dV, dM_half_space_dV, dM_cylinder_dV, dM_half_space_domega, dM_cylinder_domega;
} vr_slopes;

typedef struct { int row; double t, dt_dx; } vr_place; /* polynomial and its argument; row -1: the fast limit */

static inline vr_place vr_at(const vr_law *law, double x) {
  int e;
  double m = frexp(x, &e);
  vr_place p;
  p.row = e - law->e0;
  if (p.row <= 0 || x == 0.0) p.row = 0, p.dt_dx = ldexp(1.0, -law->e0), p.t = x * p.dt_dx;
  else if (p.row >= law->rows) p.row = -1, p.t = p.dt_dx = 0.0;
  else p.t = 4.0 * m - 3.0, p.dt_dx = (p.t + 3.0) / x;
  return p;
}

/* values of the functions first to first + count - 1 at a place */
static inline void vr_values(const double c[VR_TERMS][VR_FUNCTIONS], double t, int first, int count, double *out) {
  double even[5] = {0.0}, odd[5] = {0.0}, q = t * t;
  int k, f;
  for (k = VR_TERMS - 2; k >= 0; k -= 2)
    for (f = 0; f < count; f++)
      even[f] = even[f] * q + c[k][first + f], odd[f] = odd[f] * q + c[k + 1][first + f];
  for (f = 0; f < count; f++) out[f] = even[f] + t * odd[f];
}

static inline double vr_slope(const double c[VR_TERMS][VR_FUNCTIONS], double t, int f) {
  double even = 0.0, odd = 0.0, q = t * t;
  int k;
  for (k = VR_TERMS - 1; k > 0; k -= 2) {
    odd = odd * q + k * c[k][f];
    if (k > 1) even = even * q + (k - 1) * c[k - 1][f];
  }
  return odd + t * even;
}

/* lam, epsilon, M_half_space/V, M_cylinder/V, N at u = kappa |V|; slope, if not NULL: d/du of the third and fourth */
static inline void vr_speed(const vr_law *law, double u, double out[5], double *slope) {
  vr_place p = vr_at(law, u);
  int f;
  if (p.row >= 0) {
    vr_values(law->c[p.row], p.t, VR_LAM, 5, out);
    for (f = 0; slope && f < 2; f++) slope[f] = vr_slope(law->c[p.row], p.t, VR_M_HALF_SPACE + f) * p.dt_dx;
    return;
  }
  double z = 0.5 / (u * sqrt(law->alpha)), half = 0.5 * law->alpha * z, ln = log(z);
  out[VR_LAM] = 1.0 / sqrt(law->alpha);
  out[VR_EPSILON] = half * (law->limit[0][1] - law->limit[0][0] * ln);
  for (f = 0; f < 2; f++) {
    const double *l = law->limit[f + 1];
    double m = l[1] - l[0] * (ln - 0.25);
    out[VR_M_HALF_SPACE + f] = half * z * m;
    if (slope) slope[f] = -half * z * (2.0 * m - l[0]) / u;
  }
  out[VR_N] = 0.25 * (law->alpha - 1.0) * z * z;
  if (law->creep)
    out[VR_LAM] = law->fast[0] + law->fast[1] / u, out[VR_EPSILON] = law->fast[16] / u, out[VR_N] = NAN;
}

/* the functions that a cover has besides at u = kappa |V|, and their slopes over u */
static inline void vr_creep(const vr_law *law, double u, double out[VR_CREEP_FUNCTIONS],
                            double slope[VR_CREEP_FUNCTIONS]) {
  vr_place p = vr_at(law, u);
  int k, f;
  for (f = 0; f < VR_CREEP_FUNCTIONS; f++) {
    if (p.row < 0) { /* L = L_1 + C/4u, as L_1 = alpha^-1/2 */
      double limit = f ? law->fast[2 * f] : 1.0 / sqrt(law->alpha);
      double change = (f ? law->fast[2 * f + 1] : 0.25 * law->limit[0][1]) / u;
      out[f] = limit + change, slope[f] = -change / u;
      continue;
    }
    for (out[f] = slope[f] = 0.0, k = VR_TERMS - 1; k >= 0; k--)
      slope[f] = slope[f] * p.t + out[f], out[f] = out[f] * p.t + law->creep[p.row][k][f];
    slope[f] *= p.dt_dx;
  }
}

/* delta_0 at a speed and its slope over |V|; 0 of half-spaces */
static inline double vr_free_creep(const vr_law *law, double kappa, double V, double *slope) {
  double f[VR_CREEP_FUNCTIONS], d[VR_CREEP_FUNCTIONS];
  *slope = 0.0;
  if (!law->creep || !(kappa * fabs(V) <= 1e300)) return 0.0;
  vr_creep(law, kappa * fabs(V), f, d);
  return *slope = 0.5 * (d[VR_FREE] + d[VR_FREE + 1]), 0.5 * (f[VR_FREE] + f[VR_FREE + 1]) / kappa;
}

/* r, the excess of a cover in units of mu L/2, and the asymmetry c of the onsets of full slip, with their slopes over u,
 * from its functions f at kappa |V| and their slopes e:  delta = delta_0 + delta_star (x + c x^2), |x| < 1 in partial
 * slip, where x takes the place of delta/delta_star of half-spaces */
typedef struct { double r, dr, c, dc; } vr_excess;

static inline vr_excess vr_excess_at(double mu, const double f[VR_CREEP_FUNCTIONS], const double e[VR_CREEP_FUNCTIONS]) {
  double of_L = 2.0 / (mu * f[VR_LIMIT]), n;
  vr_excess x;
  x.r = of_L * (f[VR_EXCESS] + f[VR_EXCESS + 1]);
  x.dr = of_L * (e[VR_EXCESS] + e[VR_EXCESS + 1]) - x.r * e[VR_LIMIT] / f[VR_LIMIT];
  n = 4.0 * x.r * x.r, n *= n * n;
  x.c = -x.r / (1.0 + n), x.dc = -x.dr * (1.0 - 5.0 * n) / ((1.0 + n) * (1.0 + n));
  return x;
}

/* Add what shear does on a cover at u = kappa |V| to lam, epsilon and M, and with d, where not NULL, to the slopes, of
 * which those of Q are known; du_dV: kappa with the sign of V. */
static inline void vr_shear(const vr_law *law, double kappa, double mu, double u, double du_dV, vr_state *s,
                            vr_slopes *d) {
  double f[VR_CREEP_FUNCTIONS], e[VR_CREEP_FUNCTIONS], M[2], M_Q[2], M_u[2], used = fabs(s->Q) / mu;
  int n;
  if (!law->creep || !(s->Q == s->Q)) return;
  vr_creep(law, u, f, e);
  vr_excess x = vr_excess_at(mu, f, e);
  double rest = 1.0 / (1.0 + x.r * x.r * x.r * x.r), k = sqrt(sqrt(rest)), dk = -k * rest * x.r * x.r * x.r * x.dr;
  for (n = 0; n < 2; n++) { /* half-space, cylinder */
    double a = n ? 1.0 / (2.0 * kappa + f[VR_FREE] + f[VR_FREE + 1]) : 0.5 / kappa, g = f[VR_EXCESS + n];
    double da = n ? -a * a * (e[VR_FREE] + e[VR_FREE + 1]) : 0.0, bracket = f[VR_FREE + n] + k * g * used;
    M[n] = -s->Q * a * bracket, M_Q[n] = -a * (bracket + k * g * used);
    M_u[n] = -s->Q * (da * bracket + a * (e[VR_FREE + n] + (k * e[VR_EXCESS + n] + dk * g) * used));
  }
  double along = du_dV < 0.0 ? -s->Q : s->Q; /* in the direction of V */
  s->lam += along * f[VR_TILT], s->epsilon += along * f[VR_TILT + 1];
  s->M_half_space += M[0], s->M_cylinder += M[1], s->M += M[0] + M[1];
  if (!d) return;
  d->dM_half_space_domega = M_Q[0] != 0.0 ? M_Q[0] * d->dQ_domega : 0.0;
  d->dM_cylinder_domega = M_Q[1] != 0.0 ? M_Q[1] * d->dQ_domega : 0.0;
  d->dM_half_space_dV += du_dV * M_u[0] + (M_Q[0] != 0.0 ? M_Q[0] * d->dQ_dV : 0.0);
  d->dM_cylinder_dV += du_dV * M_u[1] + (M_Q[1] != 0.0 ? M_Q[1] * d->dQ_dV : 0.0);
  d->dM_dV = d->dM_half_space_dV + d->dM_cylinder_dV;
}

/* eta/F and H/F^2 at v = 1/F; slope, if not NULL: d/dv of the second */
static inline void vr_stick(const vr_law *law, double v, double out[2], double *slope) {
  vr_place p = vr_at(law, v);
  if (p.row >= 0) {
    vr_values(law->c[p.row], p.t, VR_SHARE, 2, out);
    if (slope) *slope = vr_slope(law->c[p.row], p.t, VR_PRESS) * p.dt_dx;
    return;
  }
  double y = 1.0 / v, b = law->limit[0][1] - law->limit[0][0] * log(y);
  out[0] = 1.0 - 0.5 * law->alpha * y * b, out[1] = law->alpha * out[0] * out[0];
  if (slope) *slope = law->alpha * out[0] * (law->alpha * y) * y * (b - law->limit[0][0]);
  if (law->creep) out[0] = law->fast[14] + law->fast[15] / v;
}

/* (H/F^2 at v2 less that at v1)/(v2 - v1), v1 <= v2 < 2 v1, without cancellation */
static inline double vr_secant(const vr_law *law, double v1, double v2) {
  vr_place p[2];
  double part = 1.0, total = 0.0, to[2];
  int n, k;
  p[0] = vr_at(law, v1), p[1] = vr_at(law, v2), to[0] = p[1].t, to[1] = -1.0;
  if (p[1].row < 0) {
    double x = (v2 - v1) / v1, y1 = 1.0 / v1, y2 = 1.0 / v2, half = 0.5 * law->alpha;
    const double *l = law->limit[0];
    double slope = half * (l[1] - l[0] * (log(y1) + (x > 0.0 ? log1p(x) / x : 1.0)));
    double shares = 2.0 - half * (y1 * (l[1] - l[0] * log(y1)) + y2 * (l[1] - l[0] * log(y2)));
    return law->alpha * shares * slope * y1 * y2;
  }
  if (p[0].row != p[1].row) {
    double edge = ldexp(1.0, law->e0 + p[1].row - 1);
    part = fmin(fmax((edge - v1) / (v2 - v1), 0.0), 1.0), to[0] = 1.0;
  }
  for (n = 0; n < 2 && (n == 0 || p[0].row != p[1].row); n++) {
    const double(*c)[VR_FUNCTIONS] = law->c[p[n].row];
    double last = c[VR_TERMS - 1][VR_PRESS], sum = last;
    for (k = VR_TERMS - 2; k > 0; k--) last = last * p[n].t + c[k][VR_PRESS], sum = sum * to[n] + last;
    total += (n ? 1.0 - part : part) * sum * p[n].dt_dx;
  }
  return total;
}

/* a NaN for every value */
static inline void vr_nothing(vr_state *s, vr_slopes *d) {
  s->lam = s->epsilon = s->delta_star = s->beta = s->Q = s->M = s->M_half_space = s->M_cylinder = s->N = NAN;
  s->delta_0 = NAN;
  if (d) d->dQ_dV = d->dQ_domega = d->dM_dV = d->dM_half_space_dV = d->dM_cylinder_dV = NAN;
  if (d) d->dM_half_space_domega = d->dM_cylinder_domega = NAN;
}

/* The state at a creepage less that of free rolling, delta_0, which the caller has taken off, and the slopes at fixed
 * delta_0, without what shear does; the creepage may be infinite.  lean: factor of the asymmetry of a cover, 1 but near
 * rest.  d: the slopes, or a null pointer. */
static inline void vr_solve(const vr_law *law, double kappa, double mu, double V, double creepage, double delta_0,
                            double lean, vr_state *s, vr_slopes *d) {
  double u = kappa * fabs(V), f[5], m[2] = {0.0, 0.0}, a[2], b[2], p1, p2, q, delta = fabs(creepage);
  double sign = ((creepage > 0.0) - (creepage < 0.0)) * (V < 0.0 ? -1.0 : 1.0);
  if (!(kappa > 0.0 && mu > 0.0 && mu < HUGE_VAL && u <= 1e300 && delta >= 0.0)) {
    vr_nothing(s, d);
    return;
  }
  vr_speed(law, u, f, d ? m : (double *)0);
  double creep[VR_CREEP_FUNCTIONS] = {f[VR_LAM] * (1.0 + f[VR_EPSILON])}, slope[VR_CREEP_FUNCTIONS];
  if (law->creep) vr_creep(law, u, creep, slope);
  double L = creep[VR_LIMIT], bend = 0.0, turn = 1.0, D = 2.0 * kappa * delta / mu, w;
  if (law->creep) { /* D = L |x|; turn: d(x + c x^2)/dx; bend: slope of D over u at fixed creepage */
    vr_excess of = vr_excess_at(mu, creep, slope);
    of.c *= lean, of.dc *= lean;
    double side = creepage < 0.0 ? -1.0 : 1.0, part = D / L, x = HUGE_VAL;
    if (part < 1.0 + side * of.c) x = 2.0 * part / (1.0 + sqrt(1.0 + 4.0 * side * of.c * part));
    D = L * x, delta = 0.5 * mu * D / kappa, turn = 1.0 + 2.0 * side * of.c * x;
    bend = side * x * x * (of.c * slope[VR_LIMIT] - of.dc * L) / turn;
  }
  w = L - D;
  s->lam = f[VR_LAM], s->epsilon = f[VR_EPSILON], s->N = f[VR_N], s->delta_star = 0.5 * mu * L / kappa;
  s->delta_0 = delta_0;
  s->M_half_space = V * f[VR_M_HALF_SPACE], s->M_cylinder = V * f[VR_M_CYLINDER];
  s->M = V * (f[VR_M_HALF_SPACE] + f[VR_M_CYLINDER]);
  if (d) {
    d->dM_half_space_dV = f[VR_M_HALF_SPACE] + u * m[0], d->dM_cylinder_dV = f[VR_M_CYLINDER] + u * m[1];
    d->dM_dV = d->dM_half_space_dV + d->dM_cylinder_dV, d->dQ_dV = d->dQ_domega = 0.0;
    d->dM_half_space_domega = d->dM_cylinder_domega = 0.0;
  }
  s->beta = 0.0, s->Q = sign * mu;
  if (!(delta < s->delta_star && w > 0.0)) return; /* full slip */
  double v1 = 2.0 * u / L, v2 = fmin(2.0 * u / w, 1.7e308); /* beside full slip w may be 1e-16 */
  vr_stick(law, v2, b, d ? &p2 : (double *)0);
  if (D < 0.125 * L) q = D * ((2.0 * L - D) * b[1] - (2.0 * u * L / w) * vr_secant(law, v1, v2));
  else q = 1.0 - w * w * b[1];
  s->beta = fmin(b[0] * w / f[VR_LAM], 1.0), s->Q = sign * mu * fmin(q, 1.0);
  if (d) {
    vr_stick(law, v1, a, &p1);
    double A1 = a[1] - 0.5 * v1 * p1, A2 = b[1] - 0.5 * v2 * p2;
    d->dQ_domega = 4.0 * kappa * w * A2 / turn / fabs(V); /* then dQ_dV at fixed delta, and what delta changes */
    d->dQ_dV = sign * (V < 0.0 ? -2.0 : 2.0) * mu * kappa * w * (A2 * (p1 / A1 + bend) - p2);
    d->dQ_dV -= (1.0 + creepage) * d->dQ_domega;
  }
}

/* creepage at a speed; at V = 0 it is 0 or infinite */
static inline double vr_creepage(double V, double slip) {
  return V != 0.0 ? slip / V : slip == 0.0 ? 0.0 : slip == slip ? copysign(HUGE_VAL, slip) : NAN;
}

static inline void vr_contact_slopes(const vr_law *law, double kappa, double mu, double V, double slip,
                                     vr_state *s, vr_slopes *d) {
  double slope, delta_0 = vr_free_creep(law, kappa, V, &slope);
  double creepage = fabs(slip) < HUGE_VAL ? vr_creepage(V, slip) - delta_0 : NAN;
  vr_solve(law, kappa, mu, V, creepage, delta_0, 1.0, s, d);
  if (law->creep && d && d->dQ_domega > 0.0) /* d(V delta_0)/dV */
    d->dQ_dV -= (delta_0 + fabs(V) * slope) * d->dQ_domega;
  vr_shear(law, kappa, mu, kappa * fabs(V), V < 0.0 ? -kappa : kappa, s, d);
}

static inline vr_state vr_contact(const vr_law *law, double kappa, double mu, double V, double slip) {
  vr_state s;
  vr_contact_slopes(law, kappa, mu, V, slip, &s, (vr_slopes *)0);
  return s;
}
#endif
