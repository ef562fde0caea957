/* A user material that never returns, without using processor time. */
#include <unistd.h>

void umat_(void) {
  for (;;) pause();
}
