/* A law file by libnetcdf, for programs that choose the material when they run.  Link with -lnetcdf. */
#ifndef VR_LAW_NETCDF_H
#define VR_LAW_NETCDF_H
#include <netcdf.h>
#include <stdlib.h>
#ifndef VR_LAW_H
#include "vr_law.h"
#endif

enum { VR_NO_LAW = -1000 }; /* not a law file of schema 1, or no memory */

/* 0 and a law, or VR_NO_LAW, or an error of netCDF (nc_strerror tells it); vr_law_close frees the law */
static inline int vr_law_open(const char *path, vr_law *law) {
  static const char *names[VR_FUNCTIONS] = {"lam", "epsilon", "m_half_space", "m_cylinder", "N", "share", "press"};
  int id, d, v, n, schema = 0, e = nc_open(path, NC_NOWRITE, &id);
  size_t rows = 0, terms = 0, i;
  double *c = NULL, *one = NULL;
  if (e) return e;
  if (nc_get_att_int(id, NC_GLOBAL, "law_schema", &schema) || schema != 1) e = VR_NO_LAW;
  if (!e && !(e = nc_inq_dimid(id, "octave", &d))) e = nc_inq_dimlen(id, d, &rows);
  if (!e && !(e = nc_inq_dimid(id, "power", &d))) e = nc_inq_dimlen(id, d, &terms);
  if (!e && (terms != VR_TERMS || !rows)) e = VR_NO_LAW;
  if (!e) c = (double *)malloc(rows * terms * VR_FUNCTIONS * sizeof *c);
  if (!e) one = (double *)malloc(rows * terms * sizeof *one);
  if (!e && !(c && one)) e = VR_NO_LAW;
  for (n = 0; n < VR_FUNCTIONS && !e; n++) {
    if (!(e = nc_inq_varid(id, names[n], &v))) e = nc_get_var_double(id, v, one);
    for (i = 0; i < rows * terms && !e; i++) c[i * VR_FUNCTIONS + n] = one[i];
  }
  if (!e && !(e = nc_inq_varid(id, "e0", &v))) e = nc_get_var_int(id, v, &law->e0);
  if (!e && !(e = nc_inq_varid(id, "alpha", &v))) e = nc_get_var_double(id, v, &law->alpha);
  if (!e && !(e = nc_inq_varid(id, "fast_limit", &v))) e = nc_get_var_double(id, v, &law->limit[0][0]);
  law->creep = 0, law->rows = (int)rows, law->c = (const double(*)[VR_TERMS][VR_FUNCTIONS])c;
  free(one), nc_close(id);
  if (e) free(c), law->c = NULL;
  return e;
}
static inline void vr_law_close(vr_law *law) { free((void *)law->c), law->c = NULL; }
#endif
