# One interface target that every target of the project links: warnings, sanitizers, processor.
# Indices are signed or unsigned as their source has them, without casts (decision 0101): clang counts that to -Wconversion.
add_library(sage_options INTERFACE)
target_compile_options(sage_options INTERFACE -Wall -Wextra -Wconversion -Wno-sign-conversion -Wshadow -Wpedantic -Werror)
# GCC 12 false positives: string concatenation (-Wrestrict, -Wstringop-*), AVX-512 intrinsics
# (-Wuninitialized) and inlined Eigen products (the others).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(sage_options INTERFACE -Wno-restrict -Wno-uninitialized -Wno-maybe-uninitialized -Wno-array-bounds
                                                -Wno-stringop-overflow -Wno-stringop-overread)
endif()
# The compiler looks for garbage of its own when it holds so much (kB) and then twice that: up to a sixth of its time
# with the defaults, for some 200 MB.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(sage_options INTERFACE --param=ggc-min-heapsize=524288 --param=ggc-min-expand=100)
endif()
if(SAGE_NATIVE)
  # The instruction set that this machine shares with most others of the last ten years, so that results do not change from one to
  # the next. Not -march=native: with it GCC 12.2 stored constant lists {x, x, x, 0} as {x, x, x, x} on a machine tested
  # here; its SLP vectoriser is at fault and stays off (Eigen's own vectors do not need it).
  include(CheckCXXSourceRuns)
  check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") ? 0 : 1; }"
                        SAGE_HAVE_AVX2)
  if(SAGE_HAVE_AVX2)
    target_compile_options(sage_options INTERFACE -march=x86-64-v3)
  endif()
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(sage_options INTERFACE -fno-tree-slp-vectorize)
endif()
if(NOT (SAGE_NATIVE AND SAGE_HAVE_AVX2))
  # How others would pass vectors of four doubles (sage/core/four.hpp) is of no account: all is compiled alike.  A precompiled header
  # forgets the pragma that says so.
  target_compile_options(sage_options INTERFACE -Wno-psabi)
endif()
# Checked string calls, stack protector, relocations read-only before main(): docs/decisions/0009. Libraries whose loops decide
# the run time have no stack protector; they define its macro all the same, or GCC would refuse the precompiled header.
include(CheckLinkerFlag)
check_linker_flag(CXX -Wl,-z,relro,-z,now SAGE_HAVE_RELRO)
if(NOT SAGE_SANITIZE AND CMAKE_BUILD_TYPE STREQUAL "Release")
  target_compile_options(sage_options INTERFACE -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2
    "$<IF:$<BOOL:$<TARGET_PROPERTY:SAGE_HOT>>,-fno-stack-protector;-D__SSP_STRONG__=3,-fstack-protector-strong>")
  if(SAGE_HAVE_RELRO)
    target_link_options(sage_options INTERFACE -Wl,-z,relro,-z,now)
  endif()
endif()
if(SAGE_SANITIZE)
  target_compile_options(sage_options INTERFACE -fsanitize=${SAGE_SANITIZE} -fno-omit-frame-pointer
                                                -fno-sanitize-recover=all $<$<BOOL:$<TARGET_PROPERTY:SAGE_HOT>>:-O2>)
  target_link_options(sage_options INTERFACE -fsanitize=${SAGE_SANITIZE})
  # Every test is a program with all its libraries and their checks: GNU's linker takes three times as long.  Modules stay as the
  # release has them: tests know where their sections lie.
  check_linker_flag(CXX -fuse-ld=lld SAGE_HAVE_LLD)
  if(SAGE_HAVE_LLD)
    target_link_options(sage_options INTERFACE "$<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-fuse-ld=lld>")
  endif()
  # Two fifths of the time to build are checks at every access to a member, in Eigen above all.  A null pointer stops a program
  # of the address sanitizer by itself, and so does an access beyond an object; addresses that are not aligned are found by
  # scripts/fuzz, whose build with clang has all checks.
  if(SAGE_SANITIZE MATCHES "undefined" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(sage_options INTERFACE -fno-sanitize=null,alignment,object-size)
  endif()
endif()
if(SAGE_COVERAGE)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "SAGE_COVERAGE needs clang: scripts/coverage says why")
  endif()
  # This build measures; warnings are the business of the others.
  target_compile_options(sage_options INTERFACE -w -fprofile-instr-generate -fcoverage-mapping)
  target_link_options(sage_options INTERFACE -fprofile-instr-generate)
endif()

# sage_target(NAME [HOT] [TOGETHER n] SOURCES ... [COLD ...] LINKS ...): one library a folder.
# HOT: its loops decide the run time.  The compiler spends most of its time on headers and on the same templates in
# each source, so with SAGE_UNITY it takes sources together: so many at a time as TOGETHER says, or those of COLD in a
# room that has others whose loops count; what is inlined in those must not depend on a file's neighbours.
function(sage_target name)
  cmake_parse_arguments(ARG "HOT" "TOGETHER" "SOURCES;COLD;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES} ${ARG_COLD})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                            $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/sagefe>)
  target_link_libraries(${name} PUBLIC ${ARG_LINKS} PRIVATE $<BUILD_INTERFACE:sage_options> ${ARG_PRIVATE_LINKS})
  # The layout of fixed-size Eigen types must not depend on more of the processor's flags than it has to.
  # Nor must the blocks of its products depend on the caches of the machine; asking for them takes longer than a small product.
  target_compile_definitions(${name} PUBLIC EIGEN_MAX_ALIGN_BYTES=32 EIGEN_NO_CPUID)
  # Without AVX Eigen would align what it has on the stack less than what it allocates, and its stableNorm() mixes both.
  if(NOT (SAGE_NATIVE AND SAGE_HAVE_AVX2))
    target_compile_definitions(${name} PUBLIC EIGEN_MAX_STATIC_ALIGN_BYTES=32)
  endif()
  # Eigen aligns them as AVX wants only where it is on.  And a program of one's own that makes one of the elements'
  # templates too hands the linker a second one, which may take the place of the first: both must be the same.
  if(SAGE_NATIVE AND SAGE_HAVE_AVX2)
    target_compile_options(${name} INTERFACE $<INSTALL_INTERFACE:-march=x86-64-v3>)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${name} INTERFACE $<INSTALL_INTERFACE:-fno-tree-slp-vectorize>)
  endif()
  target_compile_features(${name} PUBLIC cxx_std_20)
  string(REPLACE "sage_" "" export_name ${name})
  if(name STREQUAL "sage_core")
    # Eigen, libfmt and the library headers that many files include, parsed once.
    target_precompile_headers(sage_core PRIVATE <Eigen/Core> <algorithm> <array> <cmath> <filesystem> <fmt/format.h>
                                                <functional> <map> <memory> <optional> <set> <span> <string> <string_view>
                                                <unordered_map> <variant> <vector>)
  else()
    target_precompile_headers(${name} REUSE_FROM sage_core)
  endif()
  # Installed libraries go into shared objects of others too (docs/decisions/0014).
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${export_name} SAGE_HOT ${ARG_HOT} POSITION_INDEPENDENT_CODE ON)
  if(ARG_TOGETHER AND SAGE_UNITY)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${ARG_TOGETHER})
  elseif(ARG_COLD AND SAGE_UNITY)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    set_source_files_properties(${ARG_COLD} PROPERTIES UNITY_GROUP cold)
  endif()
  add_library(sagefe::${export_name} ALIAS ${name})
  set_property(GLOBAL APPEND PROPERTY SAGE_TARGETS ${name})
endfunction()

# sage_install(NAME RUNTIME|LIBRARY FOLDER [COMPONENT]): a program or module, without the search path that it has in the build tree.
function(sage_install name kind folder)
  set(component ${CMAKE_INSTALL_DEFAULT_COMPONENT_NAME})
  if(ARGC GREATER 3)
    set(component ${ARGV3})
  endif()
  install(TARGETS ${name} ${kind} DESTINATION ${folder} COMPONENT ${component})
  set(prefix "\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/")
  if(IS_ABSOLUTE ${folder})
    set(prefix "\$ENV{DESTDIR}")
  endif()
  install(CODE "file(RPATH_REMOVE FILE \"${prefix}${folder}/$<TARGET_FILE_NAME:${name}>\")" COMPONENT ${component})
endfunction()
