# SuiteSparse 5.12 in Debian ships no CMake package: the libraries that the solvers call, as one target.
find_path(SUITESPARSE_INCLUDE_DIR umfpack.h PATH_SUFFIXES suitesparse REQUIRED)
add_library(sage_suitesparse INTERFACE)
target_include_directories(sage_suitesparse SYSTEM INTERFACE ${SUITESPARSE_INCLUDE_DIR})
foreach(lib umfpack cholmod klu btf amd colamd camd ccolamd suitesparseconfig)
  find_library(SUITESPARSE_${lib} ${lib} REQUIRED)
  target_link_libraries(sage_suitesparse INTERFACE ${SUITESPARSE_${lib}})
endforeach()
