/* What the module of utility routines calls in the program, in C: the module knows nothing else of it. */
#ifndef SAGE_UMAT_HOST_H
#define SAGE_UMAT_HOST_H

#include <stddef.h>

struct SageUmatHost {
  /* Leaves the routine under way; who: 0 XIT, 1 STOP, 2 EXIT. Returns where none is under way. */
  void (*leave)(int who, const char* words, size_t length);
  const char* (*folder)(void);
  const char* (*job)(void);
};

#define SAGE_UMAT_MODULE_VERSION "sage-umat-1"

#endif
