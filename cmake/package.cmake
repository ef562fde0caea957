# The Debian packages: scripts/package makes them, scripts/check_package tries them.  sagefe is everything but the package of
# Python, which is python3-sagefe and needs sagefe for the modules that are loaded on use.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sagefe)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")  # first line of both descriptions
set(CPACK_PACKAGE_CONTACT "The SAGE developers <maintainers@users.noreply.example>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL sagefe)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_SAGEFE_PACKAGE_NAME sagefe)
set(CPACK_DEBIAN_SAGEFE_PACKAGE_SECTION science)
set(CPACK_DEBIAN_SAGEFE_DESCRIPTION
    "sagefe computes stresses, displacements, forces in structures, seepage and factors of safety of soil in plane strain and axisymmetry. Plug-ins add laws and elements; they need g++, cmake and libeigen3-dev.")
set(CPACK_DEBIAN_SAGEFE_PACKAGE_SUGGESTS "python3-sagefe, g++, cmake, libeigen3-dev, libgtest-dev, gfortran, python3-numpy, libgmsh4.8, paraview")
if(TARGET sage_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-sagefe)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION
      "The package sagefe of Python reads decks, makes models of arrays, steps through analyses and returns results as numpy arrays.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "sagefe (= ${PROJECT_VERSION}), ${SAGE_PYTHON_NEEDS}, python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-meshio, python3-scipy")
  # Compile the files of Python when they are installed, and remove what was compiled.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/python3-sagefe/postinst
                                                ${CMAKE_CURRENT_LIST_DIR}/python3-sagefe/prerm)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
endif()
include(CPack)
