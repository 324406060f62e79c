/* A law file by libnetcdf, for programs that choose the material when they run.  Link with -lnetcdf. */
#ifndef VR_LAW_NETCDF_H
#define VR_LAW_NETCDF_H
#include <netcdf.h>
#include <stdlib.h>
#ifndef VR_LAW_H
#include "vr_law.h"
#endif

enum { VR_NO_LAW = -1000 }; /* not a law file of schema 1, or no memory */

/* Coefficients of `count` functions by name, (row, power, function), in new memory, or a null pointer; a name that the
 * file does not have leaves NaN where `skip` says so. */
static inline double *vr_read_functions(int id, const char *const *names, int count, size_t size, int skip, int *e) {
  double *c = (double *)malloc(size * (size_t)count * sizeof *c), *one = (double *)malloc(size * sizeof *one);
  size_t i;
  int n, v;
  if (!(c && one)) *e = VR_NO_LAW;
  for (n = 0; n < count && !*e; n++) {
    int known = nc_inq_varid(id, names[n], &v) == NC_NOERR;
    if (!known && n != skip) *e = VR_NO_LAW;
    if (known) *e = nc_get_var_double(id, v, one);
    for (i = 0; i < size && !*e; i++) c[i * (size_t)count + (size_t)n] = known ? one[i] : NAN;
  }
  free(one);
  return c;
}

/* 0 and a law, or VR_NO_LAW, or an error of netCDF (nc_strerror tells it); vr_law_close frees the law */
static inline int vr_law_open(const char *path, vr_law *law) {
  static const char *const names[VR_FUNCTIONS] = {"lam", "epsilon", "m_half_space", "m_cylinder", "N", "share", "press"};
  static const char *const shear[VR_CREEP_FUNCTIONS] = {"limit", "free_half_space", "free_cylinder",
    "excess_half_space", "excess_cylinder", "lam_Q", "epsilon_Q"};
  int id, d, v, n, cover, schema = 0, e = nc_open(path, NC_NOWRITE, &id);
  size_t rows = 0, terms = 0;
  double *c = NULL, *creep = NULL, l[19];
  if (e) return e;
  if (nc_get_att_int(id, NC_GLOBAL, "law_schema", &schema) || schema != 1) e = VR_NO_LAW;
  if (!e && !(e = nc_inq_dimid(id, "octave", &d))) e = nc_inq_dimlen(id, d, &rows);
  if (!e && !(e = nc_inq_dimid(id, "power", &d))) e = nc_inq_dimlen(id, d, &terms);
  if (!e && (terms != VR_TERMS || !rows)) e = VR_NO_LAW;
  cover = !e && nc_inq_varid(id, "limits", &v) == NC_NOERR; /* a layer of finite thickness, whose N is not known */
  if (cover) e = nc_get_var_double(id, v, l);
  if (!e) c = vr_read_functions(id, names, VR_FUNCTIONS, rows * terms, cover ? VR_N : -1, &e);
  if (!e && cover) creep = vr_read_functions(id, shear, VR_CREEP_FUNCTIONS, rows * terms, -1, &e);
  if (!e && !(e = nc_inq_varid(id, "e0", &v))) e = nc_get_var_int(id, v, &law->e0);
  if (!e && !cover && !(e = nc_inq_varid(id, "alpha", &v))) e = nc_get_var_double(id, v, &law->alpha);
  if (!e && !cover && !(e = nc_inq_varid(id, "fast_limit", &v))) e = nc_get_var_double(id, v, &law->limit[0][0]);
  if (!e && cover) { /* the limits of speed -> infinity in the form of half-spaces, and what they do not have */
    double L = l[0];
    law->alpha = 1.0 / (L * L);
    for (n = 0; n < 3; n++) law->limit[n][0] = 0.0, law->limit[n][1] = n ? 8.0 * l[16 + n] : 4.0 * l[8];
    for (n = 0; n < 7; n++) law->fast[2 * n] = l[1 + n], law->fast[2 * n + 1] = l[9 + n];
    law->fast[14] = l[1] / L, law->fast[15] = 2.0 * (l[9] * L - l[1] * l[8]) / (L * L * L), law->fast[16] = l[16];
  }
  law->rows = (int)rows, law->c = (const double(*)[VR_TERMS][VR_FUNCTIONS])c;
  law->creep = (const double(*)[VR_TERMS][VR_CREEP_FUNCTIONS])creep;
  nc_close(id);
  if (e) free(c), free(creep), law->c = NULL, law->creep = NULL;
  return e;
}
static inline void vr_law_close(vr_law *law) {
  free((void *)law->c), free((void *)law->creep), law->c = NULL, law->creep = NULL;
}
#endif
