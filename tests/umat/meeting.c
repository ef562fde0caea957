/* Unit stiffness. Under a strain of 0.002 a call waits for a second one that is under way at the same time, some
   seconds at most: STATEV(1) says whether it came. */
#include <sched.h>
#include <stdatomic.h>
#include <stddef.h>

static atomic_int inside, met;

void umat(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double* rpl,
          double* ddsddt, double* drplde, double* drpldt, const double* stran, const double* dstran,
          const double* time, const double* dtime, const double* temp, const double* dtemp,
          const double* predef, const double* dpred, const char* cmname, const int* ndi, const int* nshr,
          const int* ntens, const int* nstatv, const double* props, const int* nprops, const double* coords,
          const double* drot, double* pnewdt, const double* celent, const double* dfgrd0, const double* dfgrd1,
          const int* noel, const int* npt, const int* layer, const int* kspt, const int* jstep, const int* kinc,
          size_t length) {
  for (int i = 0; i < *ntens; ++i) {
    stress[i] += dstran[i];
    ddsdde[i * *ntens + i] = 1.0;
  }
  if (dstran[0] == 0.002) {
    if (atomic_fetch_add(&inside, 1) == 1) atomic_store(&met, 1);
    for (long i = 0; i < 3000000 && !atomic_load(&met); ++i) sched_yield();
    atomic_fetch_sub(&inside, 1);
  }
  statev[0] = atomic_load(&met);
  (void)sse, (void)spd, (void)scd, (void)rpl, (void)ddsddt, (void)drplde, (void)drpldt, (void)stran, (void)time;
  (void)dtime, (void)temp, (void)dtemp, (void)predef, (void)dpred, (void)cmname, (void)ndi, (void)nshr;
  (void)nstatv, (void)props, (void)nprops, (void)coords, (void)drot, (void)pnewdt, (void)celent, (void)dfgrd0;
  (void)dfgrd1, (void)noel, (void)npt, (void)layer, (void)kspt, (void)jstep, (void)kinc, (void)length;
}
