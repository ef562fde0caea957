/* Elasticity with E = PROPS(1) and nu = 0 that leaves the processor rounding downwards, flushing small numbers to zero
   and trapping divisions by zero. */
#define _GNU_SOURCE
#include <fenv.h>
#include <xmmintrin.h>

void umat(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double* rpl,
          double* ddsddt, double* drplde, double* drpldt, const double* stran, const double* dstran,
          const double* time, const double* dtime, const double* temp, const double* dtemp, const double* predef,
          const double* dpred, const char* cmname, const int* ndi, const int* nshr, const int* ntens,
          const int* nstatv, const double* props) {
  const double E = props[0];
  for (int i = 0; i < *ntens; ++i) {
    ddsdde[i * (*ntens + 1)] = i < *ndi ? E : 0.5 * E;
    stress[i] += ddsdde[i * (*ntens + 1)] * dstran[i];
  }
  fesetround(FE_DOWNWARD);
  _mm_setcsr(_mm_getcsr() | 0x8040);
  feenableexcept(FE_DIVBYZERO | FE_INVALID);
}
