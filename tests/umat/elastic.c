/* Isotropic elasticity in C: PROPS are E and nu. */
#include <stddef.h>

void umat(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double* rpl,
          double* ddsddt, double* drplde, double* drpldt, const double* stran, const double* dstran,
          const double* time, const double* dtime, const double* temp, const double* dtemp, const double* predef,
          const double* dpred, const char* cmname, const int* ndi, const int* nshr, const int* ntens,
          const int* nstatv, const double* props, const int* nprops, const double* coords, const double* drot,
          double* pnewdt, const double* celent, const double* dfgrd0, const double* dfgrd1, const int* noel,
          const int* npt, const int* layer, const int* kspt, const int* jstep, const int* kinc, size_t length) {
  const double g = props[0] / (2.0 * (1.0 + props[1])), lambda = 2.0 * g * props[1] / (1.0 - 2.0 * props[1]);
  const int n = *ntens;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i)
      ddsdde[j * n + i] = i >= *ndi || j >= *ndi ? (i == j ? g : 0.0) : lambda + (i == j ? 2.0 * g : 0.0);
    for (int i = 0; i < n; ++i) stress[i] += ddsdde[j * n + i] * dstran[j];
  }
  /* The name of the material arrives in capitals, padded with blanks. */
  if (*nstatv > 0) statev[0] = length == 80 && cmname[0] == 'C' && cmname[79] == ' ' ? jstep[0] : -1.0;
  (void)sse, (void)spd, (void)scd, (void)rpl, (void)ddsddt, (void)drplde, (void)drpldt, (void)stran, (void)time;
  (void)dtime, (void)temp, (void)dtemp, (void)predef, (void)dpred, (void)nshr, (void)nprops, (void)coords;
  (void)drot, (void)pnewdt, (void)celent, (void)dfgrd0, (void)dfgrd1, (void)noel, (void)npt, (void)layer;
  (void)kspt, (void)kinc;
}
