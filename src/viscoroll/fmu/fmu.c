/* FMU of a cylinder and the rows of its contact law.  __init__.py writes model.h, which selects the model and the version
 * of the standard.
 *
 * ContactElement: v, omega, load -> force, torque, moments.  It has no states: model exchange, with all slopes.
 * Roller: drive force and torque -> v, omega, x.  Its states are v, slip and x in model exchange; in co-simulation it
 * controls its own step size (vr_roll.h), so that a communication step may have any length.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h" /* FMI_VERSION, ROLLER, TOKEN; n_NAME, the reference of every variable, COUNT, NAMES, KINDS, START;
                        L0: contact length at rest, in m, that the law of a cover is for, 0 of others */
#include "law.h"
#include "vr_roll.h"
#if FMI_VERSION == 3
#include "fmi3Functions.h"
typedef fmi3LogMessageCallback logger;
#else
#include "fmi2Functions.h"
typedef fmi2CallbackLogger logger;
#endif

enum { OK = 0, ERROR = 3 }; /* as in both versions */
/* Modes of an instance, as in both versions; model exchange has the third and the fourth, co-simulation the fifth. */
enum { INSTANTIATED = 1, INITIALIZATION = 2, EVENT = 4, CONTINUOUS = 8, STEP = 16, TERMINATED = 32 };
enum { RUNNING = EVENT | CONTINUOUS | STEP, INITIALIZED = INITIALIZATION | RUNNING | TERMINATED };
enum { BEGINNING = INSTANTIATED | INITIALIZATION }; /* in which the states are those of the start */
/* in which values may be read: of version 3 in every mode */
enum { GETTING = FMI_VERSION == 3 ? INSTANTIATED | INITIALIZED : INITIALIZED };
/* kinds of variables: computed, input, parameter above 0 that may change between steps, parameter of the start alone */
enum { COMPUTED, INPUT, TUNABLE, FIXED };
#if ROLLER
enum { STATES = 3, FIRST_STATE = n_v, FIRST_RATE = n_der_v };
#else
enum { STATES = 0, FIRST_STATE = 0, FIRST_RATE = 0 };
#endif

typedef struct {
  double x[COUNT], d[4][3]; /* slopes of the rates, or of force, torque and moments */
  double step;              /* trial length of the next step of vr_roll, in T_ref; 0: none yet */
  double stop;              /* end of the experiment that the tool has announced, in s; infinite for none */
  int exchange, stale;      /* whether the tool integrates; whether x has changed since the last evaluate() */
  int mode;
  char name[128];
  void *environment;
  logger log;
} instance;

static void reset(instance *m) {
  memcpy(m->x, START, sizeof START), m->step = 0.0, m->stale = 1, m->stop = HUGE_VAL, m->mode = INSTANTIATED;
}

static int tell(const instance *m, const char *text) {
#if FMI_VERSION == 3
  if (m->log) m->log(m->environment, fmi3Error, "logStatusError", text);
#else
  if (m->log) m->log(m->environment, m->name, fmi2Error, "logStatusError", text);
#endif
  return ERROR;
}

static int refuse(const instance *m, const char *what, double value, const char *allowed) {
  char text[200];
  snprintf(text, sizeof text, "%s = %g: must be %s", what, value, allowed);
  return tell(m, text);
}

/* OK if the mode is one of the allowed ones, else ERROR, which names both. */
static int in_mode(const instance *m, int allowed, const char *call) {
  static const char *const names[] = {"instantiated", "initialization", "event", "continuous-time", "step",
                                      "terminated"};
  char text[200];
  if (m->mode & allowed) return OK;
  int n = snprintf(text, sizeof text, "%s is refused in the mode", call);
  for (int k = 0; k < 6; k++)
    if (m->mode == 1 << k) n += snprintf(text + n, sizeof text - n, " %s: the mode must be", names[k]);
  for (int k = 0, first = 1; k < 6; k++)
    if (allowed & 1 << k) n += snprintf(text + n, sizeof text - n, first ? " %s" : " or %s", names[k]), first = 0;
  return tell(m, text);
}

/* Change the mode from one of the allowed ones. */
static int change_mode(instance *m, int allowed, int mode, const char *call) {
  return in_mode(m, allowed, call) ? ERROR : (m->mode = mode, OK);
}

/* A new instance; NULL, which the log explains, for another token or for what the FMU has not: other says it, or is NULL.
 */
static instance *create(const char *name, const char *token, void *environment, logger log, int exchange,
    const char *other) {
  instance *m = (instance *)calloc(1, sizeof *m);
  if (!m) return NULL;
  snprintf(m->name, sizeof m->name, "%s", name ? name : "");
  m->environment = environment, m->log = log, m->exchange = exchange;
  reset(m);
  if (!token || strcmp(token, TOKEN)) other = "GUID or token: must be " TOKEN ", that of modelDescription.xml";
  else if (!ROLLER && !exchange) other = "co-simulation is not available: use model exchange";
  return other ? (tell(m, other), free(m), NULL) : m;
}

/* R/l0, Eq. (4) */
static double kappa_of(const double *x) { return sqrt(x[n_E_prime] * x[n_R] * x[n_width] / (32.0 * x[n_load])); }

static int in_range(const instance *m) {
  for (int n = 1; n < COUNT; n++) {
    if (KINDS[n] && !isfinite(m->x[n])) return refuse(m, NAMES[n], m->x[n], "finite");
    if (KINDS[n] == TUNABLE && !(m->x[n] > 0.0)) return refuse(m, NAMES[n], m->x[n], "> 0");
  }
  for (int n = FIRST_STATE; n < FIRST_STATE + STATES; n++)
    if (!isfinite(m->x[n])) return refuse(m, NAMES[n], m->x[n], "finite");
#if !ROLLER
  if (!(m->x[n_load] > 0.0)) return OK; /* no contact */
#endif
  double l0 = m->x[n_R] / kappa_of(m->x);
  char text[120];
  snprintf(text, sizeof text, "%.9g, at which the law of the cover holds; set R, load, width and E_prime so", L0);
  return L0 > 0.0 && !(fabs(l0 - L0) <= 1e-9 * L0) ? refuse(m, "contact length at rest, in m,", l0, text) : OK;
}

#if ROLLER
/* the dimensionless roller at the values of an instance; its unit of time is T_ref */
static vr_roller roller(const instance *m) {
  const double *x = m->x, P = x[n_load], T = x[n_T_ref], R = x[n_R], unit = T / R;
  double rest = x[m->exchange ? n_v_smooth : n_v_min] * unit;
  vr_roller r = {&law, kappa_of(x), x[n_mu], P * T * T / (x[n_mass] * R), x[n_inertia], x[n_drive_force] / P,
                 x[n_drive_torque] / (P * R), rest, x[n_v] * unit, x[n_slip] * unit, x[n_x] / R, m->step, 0, 0};
  return r;
}

static int evaluate(instance *m) {
  double *x = m->x, P = x[n_load], R = x[n_R], per = 1.0 / x[n_T_ref], f[2], J[2][2];
  vr_roller r = roller(m);
  const double y[2] = {r.V, r.slip}, J_axis = x[n_inertia] * x[n_mass] * R * R;
  vr_rates(&r, y, f, J);
  vr_state s;
  vr_slopes d;
  vr_contact_near_rest(&law, r.kappa, r.mu, r.V, r.slip, r.rest, &s, &d);
  x[n_der_v] = f[0] * R * per * per, x[n_der_slip] = f[1] * R * per * per, x[n_der_x] = x[n_v];
  x[n_omega] = (x[n_v] + x[n_slip]) / R, x[n_traction] = s.Q * P, x[n_rolling_moment] = s.M * P * R;
  x[n_stick_share] = s.beta;
  memset(m->d, 0, sizeof m->d);
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 2; k++) m->d[i][k] = J[i][k] * per;
  m->d[2][0] = 1.0;
  m->d[3][0] = 1.0 / x[n_mass], m->d[3][1] = R / J_axis;
  return OK;
}

static double slope(const instance *m, unsigned unknown, unsigned known) {
  int state = known >= n_v && known <= n_x, force = known == n_drive_force, torque = known == n_drive_torque;
  if (!state && !force && !torque) return NAN;
  if (unknown == n_omega) return known == n_v || known == n_slip ? 1.0 / m->x[n_R] : 0.0;
  if (unknown >= n_v && unknown <= n_x) return unknown == known;
  if (unknown < n_der_v || unknown > n_der_x) return NAN;
  if (state) return m->d[unknown - n_der_v][known - n_v];
  if (unknown == n_der_v) return force ? m->d[3][0] : 0.0;
  return unknown == n_der_slip ? (force ? -m->d[3][0] : m->d[3][1]) : 0.0;
}

static int start(instance *m) {
  double *x = m->x;
  x[n_v] = x[n_v0], x[n_slip] = x[n_omega0] * x[n_R] - x[n_v0], x[n_x] = 0.0, m->stale = 1;
  return in_range(m);
}

static int advance(instance *m, double h) {
  if (in_range(m)) return ERROR;
  double *x = m->x, unit = x[n_R] / x[n_T_ref];
  vr_roller r = roller(m);
  if (!(x[n_rtol] >= 1e-12 && x[n_rtol] <= 1e-2)) return refuse(m, "rtol", x[n_rtol], "in [1e-12, 0.01]"); /* as of roll */
  switch (vr_roll(&r, h / x[n_T_ref], x[n_rtol])) {
  case VR_STUCK: return refuse(m, "rtol", x[n_rtol], "larger, as the steps become too short or too many with it");
  case VR_REFUSED: return refuse(m, "communicationStepSize", h, "one by which all speeds and distances stay finite");
  }
  x[n_v] = r.V * unit, x[n_slip] = r.slip * unit, x[n_x] = r.x * x[n_R], m->step = r.step, m->stale = 1;
  return OK;
}

/* Nominal values, to which the tool's tolerances are relative.  v: the speed at the start, or the speed at which
 * friction stops the cylinder within one radius.  slip: its value at full slip and v_smooth.  x: the radius. */
static double nominal(const instance *m, size_t state) {
  const double *x = m->x, own = sqrt(x[n_mu] * x[n_load] * x[n_R] / x[n_mass]);
  if (state == 0) return fmax(fmax(fabs(x[n_v0]), fabs(x[n_omega0] * x[n_R])), own);
  return state == 1 ? 0.5 * x[n_mu] / kappa_of(x) * x[n_v_smooth] : x[n_R];
}
#else
/* Below v_min the law is evaluated at v_min with the same slip, and the moments without traction are proportional to v:
 * the slopes stay finite, and without traction there is no moment at rest. */
static int evaluate(instance *m) {
  double *x = m->x, P = x[n_load], R = x[n_R], unit = x[n_T_ref] / R, floor = copysign(fmax(fabs(x[n_v]), x[n_v_min]),
      x[n_v]);
  memset(m->d, 0, sizeof m->d), memset(x + n_force, 0, (COUNT - n_force) * sizeof *x);
  if (!(P > 0.0)) return OK; /* no contact */
  double kappa = kappa_of(x), V = floor * unit, slip = (x[n_omega] * R - x[n_v]) * unit, keep = x[n_v] / floor;
  vr_state s;
  vr_slopes d;
  double delta_0_V, delta_0 = vr_free_creep(&law, kappa, V, &delta_0_V);
  vr_solve(&law, kappa, x[n_mu], V, (slip - keep * V * delta_0) / V, delta_0, 1.0, &s, &d);
  int slow = fabs(keep) < 1.0;
  /* by the load over P: Q is a function of kappa V and kappa^2 slip, kappa M of kappa V,
      and kappa goes like load^(-1/2) */
  double Q_P = -0.5 * (V * (d.dQ_dV + d.dQ_domega) + 2.0 * slip * d.dQ_domega);
  double h_P = 0.5 * keep * (s.M_half_space - V * d.dM_half_space_dV),
      c_P = 0.5 * keep * (s.M_cylinder - V * d.dM_cylinder_dV);
  if (law.creep) Q_P = h_P = c_P = 0.0; /* its law holds at one kappa */
  if (slow) d.dM_half_space_dV = s.M_half_space / V, d.dM_cylinder_dV = s.M_cylinder / V;
  s.M_half_space *= keep, s.M_cylinder *= keep;
  if (slow) d.dQ_dV = -(1.0 + delta_0) * d.dQ_domega;
  else if (law.creep) d.dQ_dV -= (delta_0 + fabs(V) * delta_0_V) * d.dQ_domega;
  vr_shear(&law, kappa, x[n_mu], kappa * fabs(V), slow ? 0.0 : V < 0.0 ? -kappa : kappa, &s, &d);
  double Mh = s.M_half_space, Mc = s.M_cylinder, Q_V = d.dQ_dV, h_V = d.dM_half_space_dV, c_V = d.dM_cylinder_dV;
  double Q_o = d.dQ_domega, h_o = d.dM_half_space_domega, c_o = d.dM_cylinder_domega;
  const double value[4] = {s.Q - Mh, -s.Q - Mc, Mh, Mc}, by_V[4] = {Q_V - h_V, -Q_V - c_V, h_V, c_V};
  const double by_omega[4] = {Q_o - h_o, -Q_o - c_o, h_o, c_o}, by_P[4] = {Q_P - h_P, -Q_P - c_P, h_P, c_P};
  for (int n = 0; n < 4; n++) { /* force, torque, moment_half_space, moment_cylinder */
    double arm = n ? R : 1.0;
    x[n_force + n] = P * arm * value[n];
    m->d[n][0] = P * arm * unit * by_V[n], m->d[n][1] = P * arm * x[n_T_ref] * by_omega[n];
    m->d[n][2] = arm * (value[n] + by_P[n]);
  }
  x[n_contact_length] = s.lam * R / kappa, x[n_contact_shift] = 0.5 * s.epsilon * s.lam * R / kappa;
  x[n_stick_share] = s.beta, x[n_creep_max] = s.delta_star, x[n_traction] = s.Q * P;
  return OK;
}

static double slope(const instance *m, unsigned unknown, unsigned known) {
  if (known < n_v || known > n_load || unknown < n_force || unknown > n_moment_cylinder) return NAN;
  return m->d[unknown - n_force][known - n_v];
}

static int start(instance *m) { return in_range(m); }
static int advance(instance *m, double h) { return ERROR; } /* not for co-simulation */
static double nominal(const instance *m, size_t state) { return 1.0; }
#endif

static int update(instance *m, const char *call) {
  if (in_mode(m, GETTING, call)) return ERROR;
  if (m->stale && m->mode & BEGINNING && start(m)) return ERROR;
  if (m->stale && (in_range(m) || evaluate(m))) return ERROR;
  for (int n = 1; m->stale && n < COUNT; n++)
    if (!isfinite(m->x[n])) return refuse(m, NAMES[n], m->x[n], "finite; an input or a parameter is too large or small");
  m->stale = 0;
  return OK;
}

static int set(instance *m, const unsigned r[], size_t n, const double y[]) {
  static const int modes[] = {[INPUT] = INSTANTIATED | INITIALIZATION | RUNNING,
                              [TUNABLE] = INSTANTIATED | INITIALIZATION | EVENT | STEP,
                              [FIXED] = INSTANTIATED | INITIALIZATION};
  for (size_t i = 0; i < n; i++) {
    if (r[i] >= COUNT || !KINDS[r[i]]) return refuse(m, "value reference", r[i], "that of an input or a parameter");
    if (in_mode(m, modes[(int)KINDS[r[i]]], NAMES[r[i]])) return ERROR;
  }
  for (size_t i = 0; i < n; i++) {
    m->x[r[i]] = y[i], m->stale = 1;
  }
  return OK;
}

static int get(instance *m, const unsigned r[], size_t n, double y[]) {
  if (update(m, "get values")) return ERROR;
  for (size_t i = 0; i < n; i++) {
    if (r[i] >= COUNT) return refuse(m, "value reference", r[i], "that of a variable");
    y[i] = m->x[r[i]];
  }
  return OK;
}

/* Product of the derivatives of the unknowns u by the knowns k with a seed; adjoint: of the transpose. */
static int slopes(instance *m, const unsigned u[], size_t nu, const unsigned k[], size_t nk, const double seed[],
    double s[], int adjoint) {
  if (in_mode(m, INITIALIZED, "get derivatives") || update(m, "get derivatives")) return ERROR;
  memset(s, 0, (adjoint ? nk : nu) * sizeof *s);
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nk; j++) {
      double d = slope(m, u[i], k[j]);
      if (!isfinite(d)) return refuse(m, "derivative", d, "that of a rate or an output by a state or an input");
      s[adjoint ? j : i] += d * seed[adjoint ? i : j];
    }
  return OK;
}

/* OK if a tool hands over as many values as there are. */
static int count(const instance *m, size_t n, size_t other) {
  char text[40];
  snprintf(text, sizeof text, "%d", (int)other);
  return n == other ? OK : refuse(m, "number of values", n, text);
}
static int states(instance *m, double y[], size_t n) {
  if (in_mode(m, INITIALIZED & ~STEP, "get states") || count(m, n, STATES)) return ERROR;
  if (m->stale && m->mode & BEGINNING && start(m)) return ERROR;
  return memcpy(y, m->x + FIRST_STATE, n * sizeof *y), OK;
}
static int set_states(instance *m, const double y[], size_t n) {
  if (in_mode(m, CONTINUOUS, "set states") || count(m, n, STATES)) return ERROR;
  return memcpy(m->x + FIRST_STATE, y, n * sizeof *y), m->stale = 1, OK;
}
static int rates(instance *m, double y[], size_t n) {
  if (in_mode(m, INITIALIZED & ~STEP, "get rates") || count(m, n, STATES) || update(m, "get rates")) return ERROR;
  return memcpy(y, m->x + FIRST_RATE, n * sizeof *y), OK;
}
static int nominals(const instance *m, double y[], size_t n) {
  if (count(m, n, STATES) || in_range(m)) return ERROR;
  for (size_t i = 0; i < n; i++) y[i] = nominal(m, i);
  return OK;
}
static int at(instance *m, double t) {
  return isfinite(t) ? (m->x[n_time] = t, OK) : refuse(m, "time", t, "finite");
}
/* The experiment begins at t and, where the tool has said so, ends at stop. */
static int plan(instance *m, double t, int ends, double stop) {
  if (in_mode(m, INSTANTIATED, "start of the experiment")) return ERROR;
  if (ends && !(stop >= t)) return refuse(m, "stopTime", stop, "at or after the start");
  return at(m, t) ? ERROR : (m->stop = ends ? stop : HUGE_VAL, OK);
}
static int set_time(instance *m, double t) { return in_mode(m, EVENT | CONTINUOUS, "set time") ? ERROR : at(m, t); }
static int leave_initialization(instance *m) {
  if (in_mode(m, INITIALIZATION, "leave initialization") || start(m)) return ERROR;
  return m->mode = m->exchange ? EVENT : STEP, OK;
}
/* Take a communication step of length h from t.  t must be the end of the last step, to 1e-3 of h and the rounding of
 * the tool's sums. */
static int step(instance *m, double t, double h) {
  const double now = m->x[n_time], part = 1e-3 * h + 1e-9 * fmax(fabs(t), fabs(now));
  char text[80];
  if (in_mode(m, STEP, "doStep")) return ERROR;
  if (!(h >= 0.0 && h < HUGE_VAL)) return refuse(m, "communicationStepSize", h, "finite and >= 0");
  snprintf(text, sizeof text, "%g, the end of the last step", now);
  if (!(fabs(t - now) <= part)) return refuse(m, "currentCommunicationPoint", t, text);
  snprintf(text, sizeof text, "at most stopTime = %g", m->stop);
  if (t + h > m->stop + part) return refuse(m, "end of the step", t + h, text);
  return advance(m, h) ? ERROR : at(m, t + h);
}

/* The complete state of an instance: time, parameters, inputs, states, the trial step, the announced end and the mode.
 * token: of the FMU, so that the state of another FMU is refused. */
typedef struct {
  char token[64];
  double x[COUNT], step, stop;
  int mode;
} snapshot;

static int save(instance *m, void **state) {
  snapshot *s = *state ? (snapshot *)*state : (snapshot *)calloc(1, sizeof *s);
  if (!s) return refuse(m, "memory for a state, in bytes,", sizeof *s, "available");
  snprintf(s->token, sizeof s->token, "%s", TOKEN);
  memcpy(s->x, m->x, sizeof s->x), s->step = m->step, s->stop = m->stop, s->mode = m->mode;
  *state = s;
  return OK;
}
static int restore(instance *m, const void *state) {
  const snapshot *s = (const snapshot *)state;
  if (!s) return refuse(m, "FMU state", 0.0, "one that the tool has taken or deserialized before");
  if (s->mode & (m->exchange ? STEP : EVENT | CONTINUOUS))
    return tell(m, "the FMU state is of another interface, co-simulation in place of model exchange or the reverse");
  memcpy(m->x, s->x, sizeof m->x), m->step = s->step, m->stop = s->stop, m->mode = s->mode, m->stale = 1;
  return OK;
}
static int release(void **state) {
  if (state) free(*state), *state = NULL;
  return OK;
}
static int serialize(instance *m, const void *state, char bytes[], size_t size) {
  if (!state || size < sizeof(snapshot)) return refuse(m, "bytes of a state", size, "as many as the size function returns");
  return memcpy(bytes, state, sizeof(snapshot)), OK;
}
static int deserialize(instance *m, const char bytes[], size_t size, void **state) {
  if (size != sizeof(snapshot) || strncmp(bytes, TOKEN, sizeof((snapshot *)0)->token))
    return refuse(m, "number of bytes", size, "that of a state which this FMU has serialized");
  snapshot *s = (snapshot *)malloc(sizeof *s);
  if (!s) return refuse(m, "memory for a state, in bytes,", size, "available");
  return memcpy(s, bytes, sizeof *s), *state = s, OK;
}

#include "stubs.h" /* the other functions of the standard, which refuse */
#if FMI_VERSION == 3
typedef fmi3ValueReference ref;
const char *fmi3GetVersion(void) { return "3.0"; }
fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String path, fmi3Boolean visible,
    fmi3Boolean on, fmi3InstanceEnvironment e, fmi3LogMessageCallback log) { return create(name, token, e, log, 1, NULL); }
fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String path, fmi3Boolean visible,
    fmi3Boolean on, fmi3Boolean events, fmi3Boolean early, const ref r[], size_t n, fmi3InstanceEnvironment e,
    fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update) {
  (void)update;
  return create(name, token, e, log, 0, events ? "eventModeUsed: must be false: co-simulation has no event mode" :
      n ? "requiredIntermediateVariables: must be none" : NULL);
}
void fmi3FreeInstance(fmi3Instance c) { free(c); }
fmi3Status fmi3Reset(fmi3Instance c) { return reset(c), fmi3OK; }
fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean has, fmi3Float64 tolerance, fmi3Float64 t0,
    fmi3Boolean ends, fmi3Float64 t1) {
  return plan(c, t0, ends, t1) ? ERROR : change_mode(c, INSTANTIATED, INITIALIZATION, "enter initialization");
}
fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return leave_initialization(c); }
fmi3Status fmi3EnterEventMode(fmi3Instance c) { return change_mode(c, CONTINUOUS, EVENT, "enter event mode"); }
fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) {
  return change_mode(c, EVENT, CONTINUOUS, "enter continuous-time mode");
}
fmi3Status fmi3Terminate(fmi3Instance c) { return change_mode(c, RUNNING, TERMINATED, "terminate"); }
fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String names[]) { return fmi3OK; }
fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) {
  return in_mode(c, INITIALIZATION | EVENT, "evaluate discrete states");
}
fmi3Status fmi3SetFloat64(fmi3Instance c, const ref r[], size_t n, const fmi3Float64 y[], size_t ny) {
  return count(c, ny, n) ? ERROR : set(c, r, n, y);
}
fmi3Status fmi3GetFloat64(fmi3Instance c, const ref r[], size_t n, fmi3Float64 y[], size_t ny) {
  return count(c, ny, n) ? ERROR : get(c, r, n, y);
}
fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const ref u[], size_t nu, const ref k[], size_t nk,
    const fmi3Float64 seed[], size_t ns, fmi3Float64 s[], size_t n) {
  return count(c, ns, nk) || count(c, n, nu) ? ERROR : slopes(c, u, nu, k, nk, seed, s, 0);
}
fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const ref u[], size_t nu, const ref k[], size_t nk,
    const fmi3Float64 seed[], size_t ns, fmi3Float64 s[], size_t n) {
  return count(c, ns, nu) || count(c, n, nk) ? ERROR : slopes(c, u, nu, k, nk, seed, s, 1);
}
fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n) { return *n = STATES, fmi3OK; }
fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n) { return *n = 0, fmi3OK; }
fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 y[], size_t n) { return states(c, y, n); }
fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 y[], size_t n) { return set_states(c, y, n); }
fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 y[], size_t n) { return rates(c, y, n); }
fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 y[], size_t n) { return nominals(c, y, n); }
fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 t) { return set_time(c, t); }
fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *ends, fmi3Boolean *nominals,
    fmi3Boolean *values, fmi3Boolean *timed, fmi3Float64 *t) {
  return *again = *ends = *nominals = *values = *timed = 0, in_mode(c, EVENT, "update discrete states");
}
fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean no_state, fmi3Boolean *event, fmi3Boolean *ends) {
  return *event = *ends = 0, in_mode(c, CONTINUOUS, "completed integrator step");
}
fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 t, fmi3Float64 h, fmi3Boolean no_state, fmi3Boolean *event,
    fmi3Boolean *ends, fmi3Boolean *early, fmi3Float64 *last) {
  int status = step(c, t, h);
  return *event = *ends = *early = 0, *last = ((instance *)c)->x[n_time], status;
}
fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *s) { return save(c, s); }
fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState s) { return restore(c, s); }
fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *s) { return release(s); }
fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState s, size_t *n) { return *n = sizeof(snapshot), fmi3OK; }
fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState s, fmi3Byte bytes[], size_t n) {
  return serialize(c, s, (char *)bytes, n);
}
fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t n, fmi3FMUState *s) {
  return deserialize(c, (const char *)bytes, n, s);
}
#else
typedef fmi2ValueReference ref;
const char *fmi2GetVersion(void) { return "2.0"; }
const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String path,
    const fmi2CallbackFunctions *f, fmi2Boolean visible, fmi2Boolean on) {
  return create(name, token, f ? f->componentEnvironment : NULL, f ? f->logger : NULL, type == fmi2ModelExchange, NULL);
}
void fmi2FreeInstance(fmi2Component c) { free(c); }
fmi2Status fmi2Reset(fmi2Component c) { return reset(c), fmi2OK; }
fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has, fmi2Real tolerance, fmi2Real t0, fmi2Boolean ends,
    fmi2Real t1) { return plan(c, t0, ends, t1); }
fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  return change_mode(c, INSTANTIATED, INITIALIZATION, "enter initialization");
}
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return leave_initialization(c); }
fmi2Status fmi2EnterEventMode(fmi2Component c) { return change_mode(c, CONTINUOUS, EVENT, "enter event mode"); }
fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
  return change_mode(c, EVENT, CONTINUOUS, "enter continuous-time mode");
}
fmi2Status fmi2Terminate(fmi2Component c) { return change_mode(c, RUNNING, TERMINATED, "terminate"); }
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String names[]) { return fmi2OK; }
fmi2Status fmi2SetReal(fmi2Component c, const ref r[], size_t n, const fmi2Real y[]) { return set(c, r, n, y); }
fmi2Status fmi2GetReal(fmi2Component c, const ref r[], size_t n, fmi2Real y[]) { return get(c, r, n, y); }
fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const ref u[], size_t nu, const ref k[], size_t nk,
    const fmi2Real seed[], fmi2Real s[]) { return slopes(c, u, nu, k, nk, seed, s, 0); }
fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real y[], size_t n) { return states(c, y, n); }
fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real y[], size_t n) { return set_states(c, y, n); }
fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real y[], size_t n) { return rates(c, y, n); }
fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real y[], size_t n) { return nominals(c, y, n); }
fmi2Status fmi2SetTime(fmi2Component c, fmi2Real t) { return set_time(c, t); }
fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *e) {
  return memset(e, 0, sizeof *e), in_mode(c, EVENT, "new discrete states");
}
fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean no_state, fmi2Boolean *event, fmi2Boolean *ends) {
  return *event = *ends = 0, in_mode(c, CONTINUOUS, "completed integrator step");
}
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real h, fmi2Boolean no_state) { return step(c, t, h); }
fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *s) { return save(c, s); }
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate s) { return restore(c, s); }
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *s) { return release(s); }
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate s, size_t *n) { return *n = sizeof(snapshot), fmi2OK; }
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate s, fmi2Byte bytes[], size_t n) {
  return serialize(c, s, bytes, n);
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t n, fmi2FMUstate *s) {
  return deserialize(c, bytes, n, s);
}
#endif
