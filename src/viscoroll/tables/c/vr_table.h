/* The contact law of one scene with pressure and shear solved together, as a table of cubic splines.
 *
 * As vr_law.h, whose vr_state and vr_creepage it takes; of libm also cbrt.  The table holds for one coefficient of
 * friction, mu, and one ratio of thickness and contact length.  Q and M follow V in sign; V = 0 counts as V > 0.
 *
 *     vr_state s = vr_table_contact(&belt, kappa, V, slip);
 */
#ifndef VR_TABLE_H
#define VR_TABLE_H

/* creeps 2 kappa delta: between the signs of slip, onset of full slip of negative and of positive sign, free rolling */
enum { VR_MIDDLE, VR_ONSET, VR_FREE_ROLLING = 3, VR_EDGES };
/* Q/mu, kappa M of both bodies, lam, epsilon, beta; others are not read */
enum { VR_TABLE_Q, VR_TABLE_HALF_SPACE, VR_TABLE_CYLINDER, VR_TABLE_LAM, VR_TABLE_EPSILON, VR_TABLE_BETA };

typedef struct {
  int rows, nodes;           /* rows: u = kappa |V| = 0, first ... last in equal ratios, infinite; nodes: t = -1 ... 1 */
  double mu, first, last;
  const double (*edges)[VR_EDGES][2]; /* of each row: value, slope over ln u */
  const double (*fields)[4]; /* of each field, row and node: value, slopes over ln u and t, the mixed one */
} vr_table;

/* number of the left end, and weights of value and slope at both ends of an interval: w[0], w[2] of its left one */
typedef struct { int first; double w[4]; } vr_cubic;

/* weights at x = 0 ... count - 1 between nodes that are h apart */
static inline vr_cubic vr_cubic_at(double x, int count, double h) {
  vr_cubic c;
  double y = fmin(fmax(x, 0.0), count - 1.5), s, r;
  c.first = (int)y, s = x - c.first, r = 1.0 - s;
  c.w[0] = (1.0 + 2.0 * s) * r * r, c.w[1] = s * s * (3.0 - 2.0 * s), c.w[2] = s * r * r * h, c.w[3] = -s * s * r * h;
  return c;
}

/* weights of the rows: linear in u below the first node, in 1/u beyond the last one */
static inline vr_cubic vr_rows_at(const vr_table *table, double u) {
  vr_cubic c = {0, {0.0, 0.0, 0.0, 0.0}};
  if (u > table->first && u < table->last) {
    double h = log(table->last / table->first) / (table->rows - 3);
    c = vr_cubic_at(log(u / table->first) / h, table->rows - 2, h), c.first++;
  } else if (u <= table->first) c.w[1] = u / table->first, c.w[0] = 1.0 - c.w[1];
  else c.first = table->rows - 2, c.w[0] = table->last / u, c.w[1] = 1.0 - c.w[0];
  return c;
}

static inline double vr_edge(const vr_table *table, vr_cubic u, int name) {
  const double *a = table->edges[u.first][name], *b = table->edges[u.first + 1][name];
  return u.w[0] * a[0] + u.w[1] * b[0] + u.w[2] * a[1] + u.w[3] * b[1];
}

static inline double vr_field(const vr_table *table, vr_cubic u, vr_cubic t, int name) {
  double sum = 0.0;
  int r, n;
  for (r = 0; r < 2; r++)
    for (n = 0; n < 2; n++) {
      const double *f = table->fields[(name * table->rows + u.first + r) * table->nodes + t.first + n];
      sum += t.w[n] * (u.w[r] * f[0] + u.w[2 + r] * f[1]) + t.w[2 + n] * (u.w[r] * f[2] + u.w[2 + r] * f[3]);
    }
  return sum;
}

/* delta_star: distance of the onset from free rolling, delta_0, on the side of the creepage; N is not known: NaN */
static inline vr_state vr_table_contact(const vr_table *table, double kappa, double V, double slip) {
  vr_state s;
  double u = kappa * fabs(V), D = 2.0 * kappa * vr_creepage(V, slip), sign = V < 0.0 ? -1.0 : 1.0;
  s.lam = s.epsilon = s.delta_star = s.delta_0 = s.beta = s.Q = s.M = s.M_half_space = s.M_cylinder = s.N = NAN;
  if (!(kappa > 0.0 && u <= 1e300 && fabs(slip) < HUGE_VAL && D == D)) return s;
  vr_cubic row = vr_rows_at(table, u), node;
  double middle = vr_edge(table, row, VR_MIDDLE), side = D >= middle ? 1.0 : -1.0;
  double w = (D - middle) / (vr_edge(table, row, VR_ONSET + (D >= middle)) - middle);
  double root = cbrt(1.0 - fmin(w, 1.0)), t = side * sqrt(1.0 - root * root);
  node = vr_cubic_at(0.5 * (t + 1.0) * (table->nodes - 1), table->nodes, 2.0 / (table->nodes - 1));
  double Q = vr_field(table, row, node, VR_TABLE_Q), rest = vr_edge(table, row, VR_FREE_ROLLING);
  s.Q = sign * table->mu * (w >= 1.0 ? side : fmin(fmax(Q, -1.0), 1.0));
  s.M_half_space = sign * vr_field(table, row, node, VR_TABLE_HALF_SPACE) / kappa;
  s.M_cylinder = sign * vr_field(table, row, node, VR_TABLE_CYLINDER) / kappa;
  s.M = s.M_half_space + s.M_cylinder;
  s.lam = vr_field(table, row, node, VR_TABLE_LAM), s.epsilon = vr_field(table, row, node, VR_TABLE_EPSILON);
  s.beta = fmin(fmax(vr_field(table, row, node, VR_TABLE_BETA), 0.0), 1.0);
  s.delta_0 = 0.5 * rest / kappa;
  s.delta_star = 0.5 * fabs(vr_edge(table, row, VR_ONSET + (D >= rest)) - rest) / kappa;
  return s;
}
#endif
