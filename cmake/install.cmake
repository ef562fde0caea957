# cmake --install build --prefix X: the program, its cases, and the libraries as the CMake package `sage`.
include(CMakePackageConfigHelpers)

set(SAGE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/sage)
set(SAGE_PACKAGE_TARGETS sage_fmt sage_core sage_layout sage_deck sage_model sage_analysis sage_output sage_elements sage_materials
                         sage_solvers)

install(TARGETS sagefe RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY legacy_inputs DESTINATION ${CMAKE_INSTALL_DATADIR}/sagefe)

# Headers keep their paths: #include "sage/core/law.hpp".  The module of library solvers is installed by solvers/.
foreach(folder sage elements materials solvers)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sagefe
          FILES_MATCHING PATTERN "*.hpp" PATTERN app EXCLUDE)
endforeach()

install(TARGETS ${SAGE_PACKAGE_TARGETS} EXPORT sageTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT sageTargets NAMESPACE sage:: DESTINATION ${SAGE_PACKAGE_DIR})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/sageConfig.cmake.in ${PROJECT_BINARY_DIR}/sageConfig.cmake
                              INSTALL_DESTINATION ${SAGE_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sageConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sageConfig.cmake ${PROJECT_BINARY_DIR}/sageConfigVersion.cmake
        DESTINATION ${SAGE_PACKAGE_DIR})
