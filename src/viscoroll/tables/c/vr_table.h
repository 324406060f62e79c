/* The contact law of one scene with pressure and shear solved together, as a table of cubic splines.
 *
 * As vr_law.h, whose vr_state and vr_creepage it takes; of libm also cbrt.  The table holds for one coefficient of
 * friction, mu, and one ratio of thickness and contact length.  Q and M follow V in sign; V = 0 counts as V > 0.
 *
 *     vr_state s = vr_table_contact(&belt, kappa, V, slip);
 *     vr_slopes d = vr_table_slopes(&belt, kappa, V, slip);
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

/* number of the left end, and weights of value and slope at both ends of an interval: w[0], w[2] of its left one; d:
 * their derivatives over u of rows, over the place w of nodes */
typedef struct { int first; double w[4], d[4]; } vr_cubic;

/* weights at x = 0 ... count - 1 between nodes that are h apart; dx: derivative of x h */
static inline vr_cubic vr_cubic_at(double x, int count, double h, double dx) {
  vr_cubic c;
  double s, r;
  c.first = (int)fmin(fmax(x, 0.0), count - 1.5), s = x - c.first, r = 1.0 - s;
  c.w[0] = (1.0 + 2.0 * s) * r * r, c.w[1] = s * s * (3.0 - 2.0 * s), c.w[2] = s * r * r * h, c.w[3] = -s * s * r * h;
  c.d[1] = 6.0 * s * r * dx / h, c.d[0] = -c.d[1];
  c.d[2] = r * (1.0 - 3.0 * s) * dx, c.d[3] = s * (3.0 * s - 2.0) * dx;
  return c;
}

/* weights of the rows: linear in u below the first node, in 1/u beyond the last one */
static inline vr_cubic vr_rows_at(const vr_table *table, double u) {
  vr_cubic c = {0, {0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}};
  if (u > table->first && u < table->last) {
    double h = log(table->last / table->first) / (table->rows - 3);
    c = vr_cubic_at(log(u / table->first) / h, table->rows - 2, h, 1.0 / u), c.first++;
  } else if (u <= table->first) {
    c.w[1] = u / table->first, c.w[0] = 1.0 - c.w[1], c.d[1] = 1.0 / table->first, c.d[0] = -c.d[1];
  } else {
    c.first = table->rows - 2, c.w[0] = table->last / u, c.w[1] = 1.0 - c.w[0];
    c.d[1] = c.w[0] / u, c.d[0] = -c.d[1];
  }
  return c;
}

/* an edge by the weights w of a row, or its derivative by the weights d */
static inline double vr_edge(const vr_table *table, int row, const double w[4], int name) {
  const double *a = table->edges[row][name], *b = table->edges[row + 1][name];
  return w[0] * a[0] + w[1] * b[0] + w[2] * a[1] + w[3] * b[1];
}

/* where a state lies: rows and nodes around it, side of the middle creep, place w, 1 from the onset of full slip on,
 * and the derivatives of w in u at fixed creep and in the creep */
typedef struct { vr_cubic row, node; double side, w, dw_du, dw_dD; } vr_table_place;

static inline vr_table_place vr_table_at(const vr_table *table, double u, double D) {
  vr_table_place p;
  vr_cubic row = vr_rows_at(table, u);
  double middle = vr_edge(table, row.first, row.w, VR_MIDDLE), change = vr_edge(table, row.first, row.d, VR_MIDDLE);
  int onset = VR_ONSET + (D >= middle);
  double width = vr_edge(table, row.first, row.w, onset) - middle;
  p.row = row, p.side = D >= middle ? 1.0 : -1.0, p.w = (D - middle) / width, p.dw_dD = 1.0 / width;
  p.dw_du = -(change + fmin(p.w, 1.0) * (vr_edge(table, row.first, row.d, onset) - change)) / width;
  double root = cbrt(fmax(1.0 - p.w, 1e-24)), h = 2.0 / (table->nodes - 1);
  double t = fmax(sqrt(fmin(p.w, 1.0) * (1.0 + root) / (1.0 + root + root * root)), 1e-170);
  if (p.w >= 1.0) t = 1.0;
  p.node = vr_cubic_at((p.side * t + 1.0) / h, table->nodes, h, p.w < 1.0 ? p.side / (3.0 * t * root) : 0.0);
  return p;
}

/* a field by weights of rows and nodes, w or d of both */
static inline double vr_field(const vr_table *table, const vr_table_place *p, const double u[4], const double t[4],
                              int name) {
  double sum = 0.0;
  int r, n;
  for (r = 0; r < 2; r++)
    for (n = 0; n < 2; n++) {
      const double *f = table->fields[(name * table->rows + p->row.first + r) * table->nodes + p->node.first + n];
      sum += t[n] * (u[r] * f[0] + u[2 + r] * f[1]) + t[2 + n] * (u[r] * f[2] + u[2 + r] * f[3]);
    }
  return sum;
}

/* delta_star: half the distance of the creepages at which full slip begins; N is not known: NaN */
static inline vr_state vr_table_contact(const vr_table *table, double kappa, double V, double slip) {
  vr_state s;
  double u = kappa * fabs(V), D = 2.0 * kappa * vr_creepage(V, slip), sign = V < 0.0 ? -1.0 : 1.0;
  s.lam = s.epsilon = s.delta_star = s.delta_0 = s.beta = s.Q = s.M = s.M_half_space = s.M_cylinder = s.N = NAN;
  if (!(kappa > 0.0 && u <= 1e300 && fabs(slip) < HUGE_VAL && D == D)) return s;
  vr_table_place p = vr_table_at(table, u, D);
  const double *row = p.row.w, *node = p.node.w;
  double Q = vr_field(table, &p, row, node, VR_TABLE_Q), rest = vr_edge(table, p.row.first, row, VR_FREE_ROLLING);
  s.Q = sign * table->mu * (p.w >= 1.0 ? p.side : fmin(fmax(Q, -1.0), 1.0));
  s.M_half_space = sign * vr_field(table, &p, row, node, VR_TABLE_HALF_SPACE) / kappa;
  s.M_cylinder = sign * vr_field(table, &p, row, node, VR_TABLE_CYLINDER) / kappa;
  s.M = s.M_half_space + s.M_cylinder;
  s.lam = vr_field(table, &p, row, node, VR_TABLE_LAM), s.epsilon = vr_field(table, &p, row, node, VR_TABLE_EPSILON);
  s.beta = fmin(fmax(vr_field(table, &p, row, node, VR_TABLE_BETA), 0.0), 1.0);
  s.delta_0 = 0.5 * rest / kappa;
  s.delta_star = vr_edge(table, p.row.first, row, VR_ONSET + 1) - vr_edge(table, p.row.first, row, VR_ONSET);
  s.delta_star *= 0.25 / kappa;
  return s;
}

/* slopes of Q and M, as those of vr_contact_slopes; NaN where vr_table_contact gives NaN */
static inline vr_slopes vr_table_slopes(const vr_table *table, double kappa, double V, double slip) {
  enum { COUNT = 3 };
  double over_V[COUNT], over_omega[COUNT], u = kappa * fabs(V), delta = vr_creepage(V, slip);
  vr_slopes none = {NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  if (!(kappa > 0.0 && u <= 1e300 && fabs(slip) < HUGE_VAL && delta == delta)) return none;
  vr_table_place p = vr_table_at(table, u, 2.0 * kappa * delta);
  int n;
  for (n = 0; n < COUNT; n++) {
    double factor = n ? 1.0 / kappa : table->mu;
    int full = n == 0 && (p.w >= 1.0 || fabs(vr_field(table, &p, p.row.w, p.node.w, n)) >= 1.0);
    double by_w = full ? 0.0 : factor * vr_field(table, &p, p.row.w, p.node.d, n);
    double by_u = full ? 0.0 : factor * vr_field(table, &p, p.row.d, p.node.w, n);
    double by_delta = (V < 0.0 ? -2.0 : 2.0) * kappa * by_w * p.dw_dD;
    over_V[n] = kappa * (by_u + by_w * p.dw_du), over_omega[n] = 0.0; /* at fixed creepage */
    if (by_delta != 0.0) over_V[n] -= by_delta * (1.0 + delta) / V, over_omega[n] = by_delta / V;
  }
  vr_slopes d = {over_V[0], over_omega[0], over_V[1] + over_V[2], over_V[1], over_V[2], over_omega[1], over_omega[2]};
  return d;
}
#endif
