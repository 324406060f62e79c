/* The contact of a cylinder from atlas.nc and paper.nc, by netCDF's C library.

       cc -O2 read_tables.c -o read_tables $(pkg-config --cflags --libs netcdf) -lm
       ./read_tables [TABLES [CHECKS]]         default: data/tables docs/loading

   Exit code 1 where a value is further from its check value than is stated there. */

#include <math.h>
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>

static void try(int status) {
    if (status == NC_NOERR) return;
    fprintf(stderr, "netCDF: %s\n", nc_strerror(status));
    exit(2);
}

/* All values of a variable, the last dimension fastest, and how many. */
static double *read_values(int file, const char *name, int *count) {
    int variable, ndims, dims[NC_MAX_VAR_DIMS];
    size_t total = 1, length;
    try(nc_inq_varid(file, name, &variable));
    try(nc_inq_varndims(file, variable, &ndims));
    try(nc_inq_vardimid(file, variable, dims));
    for (int n = 0; n < ndims; n++) {
        try(nc_inq_dimlen(file, dims[n], &length));
        total *= length;
    }
    double *values = malloc(total * sizeof *values);
    if (!values) exit(2);
    try(nc_get_var_double(file, variable, values));
    if (count) *count = (int)total;
    return values;
}

/* An axis of a table in the coordinate in which it is interpolated. */
typedef struct { double *node; int count; } Axis;
/* The nodes around a point, from `first` on, and their weights. */
typedef struct { int first, count; double weight[6]; } Stencil;

static double same(double x) { return x; }
static double u_of_s(double s) { return 1.0 - sqrt(1.0 - s); }

static Axis read_axis(int file, const char *name, double (*map)(double)) {
    Axis axis;
    axis.node = read_values(file, name, &axis.count);
    for (int n = 0; n < axis.count; n++) axis.node[n] = map(axis.node[n]);
    return axis;
}

/* The polynomial through the six nodes around x; nodes are evenly spaced. */
static Stencil six_points(Axis axis, double x) {
    Stencil s = {.count = 6};
    double position = (x - axis.node[0]) / (axis.node[axis.count - 1] - axis.node[0]) * (axis.count - 1);
    s.first = (int)fmax(0.0, fmin(floor(position) - 2.0, axis.count - 6.0));
    for (int k = 0; k < 6; k++) {
        s.weight[k] = 1.0;
        for (int m = 0; m < 6; m++)
            if (m != k) s.weight[k] *= (position - s.first - m) / (k - m);
    }
    return s;
}

/* Linear between the two nodes around x. */
static Stencil two_points(Axis axis, double x) {
    Stencil s = {.count = 2};
    while (s.first < axis.count - 2 && axis.node[s.first + 1] < x) s.first++;
    s.weight[1] = (x - axis.node[s.first]) / (axis.node[s.first + 1] - axis.node[s.first]);
    s.weight[0] = 1.0 - s.weight[1];
    return s;
}

/* The node itself. */
static Stencil one_point(Axis axis, double x) {
    Stencil s = {.count = 1, .weight = {1.0}};
    while (s.first < axis.count - 1 && axis.node[s.first] < x) s.first++;
    return s;
}

/* values[a][b][c] over axes of which the last two have nb and nc nodes; a plane has nc = 1 and c = nothing. */
static const Stencil nothing = {.count = 1, .weight = {1.0}};
static double look_up(const double *values, Stencil a, Stencil b, int nb, Stencil c, int nc) {
    double sum = 0.0;
    for (int i = 0; i < a.count; i++)
        for (int j = 0; j < b.count; j++)
            for (int k = 0; k < c.count; k++)
                sum += a.weight[i] * b.weight[j] * c.weight[k] *
                       values[((size_t)(a.first + i) * nb + b.first + j) * nc + c.first + k];
    return sum;
}

typedef struct { double alpha, kappa, mu, V, delta; } State;
typedef struct { double beta, Q, M; } Contact;

/* For any kappa and mu: the steps of README.md. */
static Contact from_atlas(int file, State in) {
    static Axis alpha, kappa_V, u;
    static double *delta_star, *kappa_M, *beta, *Q_over_mu;
    if (!beta) {
        alpha = read_axis(file, "alpha", log);
        kappa_V = read_axis(file, "kappa_V", log);
        u = read_axis(file, "s", u_of_s);
        delta_star = read_values(file, "kappa_delta_star_over_mu", NULL);
        kappa_M = read_values(file, "kappa_M", NULL);
        beta = read_values(file, "beta", NULL);
        Q_over_mu = read_values(file, "Q_over_mu", NULL);
    }
    Stencil a = six_points(alpha, log(in.alpha)), v = six_points(kappa_V, log(in.kappa * fabs(in.V)));
    double s = fabs(in.delta) / (in.mu / in.kappa * look_up(delta_star, a, v, kappa_V.count, nothing, 1));
    Contact out = {0.0, in.mu, look_up(kappa_M, a, v, kappa_V.count, nothing, 1) / in.kappa};
    if (s < 1.0) {
        Stencil c = six_points(u, u_of_s(s));
        out.beta = look_up(beta, a, v, kappa_V.count, c, u.count);
        out.Q = in.mu * look_up(Q_over_mu, a, v, kappa_V.count, c, u.count);
    }
    if (in.V * in.delta < 0.0) out.Q = -out.Q;
    if (in.V < 0.0) out.M = -out.M;
    return out;
}

/* At the kappa and mu of the file and one of its alphas. */
static Contact from_paper(int file, State in) {
    static Axis V, delta, alpha;
    static double *beta, *Q, *M;
    if (!beta) {
        V = read_axis(file, "V", same);
        delta = read_axis(file, "delta", same);
        alpha = read_axis(file, "alpha", same);
        beta = read_values(file, "beta", NULL);
        Q = read_values(file, "Q", NULL);
        M = read_values(file, "M", NULL);
    }
    Stencil v = two_points(V, fabs(in.V)), d = two_points(delta, in.delta), a = one_point(alpha, in.alpha);
    double sign = in.V < 0.0 ? -1.0 : 1.0;
    Contact out = {
        look_up(beta, v, d, delta.count, a, alpha.count),
        sign * look_up(Q, v, d, delta.count, a, alpha.count),
        sign * look_up(M, v, a, alpha.count, nothing, 1),
    };
    return out;
}

/* How many states of a table are wrong. */
static int check(const char *tables, const char *checks, const char *name, Contact (*contact)(int, State)) {
    char path[4096], line[4096];
    int file, wrong = 0, rows = 0;
    snprintf(path, sizeof path, "%s/%s.nc", tables, name);
    try(nc_open(path, NC_NOWRITE, &file));
    snprintf(path, sizeof path, "%s/check_%s.csv", checks, name);
    FILE *csv = fopen(path, "r");
    if (!csv || !fgets(line, sizeof line, csv)) return perror(path), 1;
    while (fgets(line, sizeof line, csv)) {
        State in;
        Contact exact, allowed;
        if (sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &in.alpha, &in.kappa, &in.mu, &in.V, &in.delta,
                   &exact.beta, &exact.Q, &exact.M, &allowed.beta, &allowed.Q, &allowed.M) != 11)
            return fprintf(stderr, "%s: not eleven numbers: %s", path, line), 1;
        Contact found = contact(file, in);
        int good = fabs(found.beta - exact.beta) <= allowed.beta && fabs(found.Q - exact.Q) <= allowed.Q &&
                   fabs(found.M - exact.M) <= allowed.M;
        printf("%s %g %g %g %g %g: beta %.9f Q %.9f M %.9f %s\n", name, in.alpha, in.kappa, in.mu, in.V, in.delta,
               found.beta, found.Q, found.M, good ? "ok" : "WRONG");
        wrong += !good;
        rows++;
    }
    fclose(csv);
    try(nc_close(file));
    return rows ? wrong : 1;
}

int main(int argc, char **argv) {
    const char *tables = argc > 1 ? argv[1] : "data/tables", *checks = argc > 2 ? argv[2] : "docs/loading";
    int wrong = check(tables, checks, "atlas", from_atlas) + check(tables, checks, "paper", from_paper);
    return wrong ? 1 : 0;
}
