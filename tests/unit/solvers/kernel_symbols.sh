#!/usr/bin/env bash
# kernel_symbols.sh LIBRARY: the source that is compiled for AVX-512 must define one name for others, its table, and no
# function that another source has too: the linker might take this one for all, and the program would die on other
# processors (docs/decisions/0018).
set -euo pipefail
symbols=$(nm -C --defined-only "$1" | sed -n '/^kernels_avx512/,/^$/p' | grep -E '^[0-9a-f]+ ')
shared=$(grep -vE '^[0-9a-f]+ [a-z] ' <<< "$symbols" | cut -d' ' -f3- || true)
if [ "$shared" != "sage::kAvx512Kernels" ]; then
  printf 'kernels_avx512 shares more than its table:\n%s\n' "$shared"
  exit 1
fi
# Weak and unique symbols have small letters as well: v, w, u.
if grep -E '^[0-9a-f]+ [uvw] ' <<< "$symbols"; then exit 1; fi
