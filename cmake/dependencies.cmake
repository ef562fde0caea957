find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt 9 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json 3 REQUIRED)
include(cmake/FindSuiteSparseLibs.cmake)
include(cmake/FindMumps.cmake)
include(cmake/FindHdf5Serial.cmake)

# libfmt from its headers, compiled once (cmake/fmt.cpp says why).
add_library(sage_fmt STATIC cmake/fmt.cpp)
target_include_directories(sage_fmt SYSTEM PUBLIC $<BUILD_INTERFACE:$<TARGET_PROPERTY:fmt::fmt,INTERFACE_INCLUDE_DIRECTORIES>>)
set_target_properties(sage_fmt PROPERTIES EXPORT_NAME fmt POSITION_INDEPENDENT_CODE ON)
find_package(GTest QUIET)  # for the suites of conformance and the tests
