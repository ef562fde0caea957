# cmake --install build --prefix X: the program, its cases, and the libraries as the CMake package `sagefe`.
include(CMakePackageConfigHelpers)

set(SAGE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/sagefe)
set(SAGE_PACKAGE_TARGETS sage_fmt sage_core sage_page sage_umat sage_layout sage_deck sage_layout_draft sage_model sage_exchange sage_mesh sage_section sage_model_file sage_builder sage_analysis sage_record sage_report
                         sage_draw sage_convergence sage_safety sage_bounds sage_sweep sage_compare sage_drive sage_app sage_commands
                         sage_elements sage_materials sage_solvers sage_conformance)

sage_install(sagefe RUNTIME ${CMAKE_INSTALL_BINDIR})
# Without the decks whose licence names no holder (NOTICE).
install(DIRECTORY legacy_inputs DESTINATION ${CMAKE_INSTALL_DATADIR}/sagefe PATTERN smith_griffiths EXCLUDE PATTERN quad4m EXCLUDE)
install(FILES LICENSE NOTICE CITATION.cff README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/sagefe)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/sagefe)
# The same as a site, where scripts/package has built it.
install(DIRECTORY ${PROJECT_BINARY_DIR}/site/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/sagefe/html OPTIONAL)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
file(READ ${PROJECT_SOURCE_DIR}/NOTICE notice)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/copyright CONTENT "@license@\n\n@notice@" @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/sagefe)
if(TARGET sage_python)
  install(FILES ${PROJECT_BINARY_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-sagefe COMPONENT python)
endif()
install(DIRECTORY sage/app/templates DESTINATION ${CMAKE_INSTALL_DATADIR}/sagefe)

# Headers keep their paths: #include "sage/core/law.hpp".  Those whose library is in the package, no others.
# The module of library solvers is installed by solvers/.
set(SAGE_PACKAGE_MODULES core math messages platform page umat deck layout_draft model exchange mesh section model_file builder analysis record draw convergence compare drive conformance)
list(TRANSFORM SAGE_PACKAGE_MODULES PREPEND sage/)
foreach(folder ${SAGE_PACKAGE_MODULES} elements materials solvers)
  install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sagefe/${folder} FILES_MATCHING PATTERN "*.hpp")
endforeach()

install(FILES ${PROJECT_BINARY_DIR}/generated/sage/core/header_hash.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sagefe/sage/core)

# Of the commands only the function that is the program: the others' headers need CLI11.
install(FILES sage/app/program.hpp sage/app/exit_codes.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sagefe/sage/app)

if(TARGET sage_suites)
  list(APPEND SAGE_PACKAGE_TARGETS sage_suites)
endif()
install(TARGETS ${SAGE_PACKAGE_TARGETS} EXPORT sagefeTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT sagefeTargets NAMESPACE sagefe:: DESTINATION ${SAGE_PACKAGE_DIR})
set(SAGE_HEADERS_DIR ${CMAKE_INSTALL_INCLUDEDIR}/sagefe)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/sagefeConfig.cmake.in ${PROJECT_BINARY_DIR}/sagefeConfig.cmake
                              INSTALL_DESTINATION ${SAGE_PACKAGE_DIR} PATH_VARS SAGE_HEADERS_DIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sagefeConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sagefeConfig.cmake ${PROJECT_BINARY_DIR}/sagefeConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/sagefePlugin.cmake ${CMAKE_CURRENT_LIST_DIR}/sagefeHeaderHash.cmake
        DESTINATION ${SAGE_PACKAGE_DIR})
