# HDF5 for result files, optional: defines the target sage_hdf5 where its library and header, and zlib's (which
# Debian's package of HDF5 brings), are there.
find_path(HDF5_SERIAL_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial)
find_library(HDF5_SERIAL_LIBRARY NAMES hdf5_serial hdf5)
find_package(ZLIB QUIET)
if(HDF5_SERIAL_INCLUDE_DIR AND HDF5_SERIAL_LIBRARY AND ZLIB_FOUND)
  add_library(sage_hdf5 INTERFACE)
  target_include_directories(sage_hdf5 SYSTEM INTERFACE ${HDF5_SERIAL_INCLUDE_DIR})
  target_link_libraries(sage_hdf5 INTERFACE ${HDF5_SERIAL_LIBRARY} ZLIB::ZLIB)
  message(STATUS "HDF5: ${HDF5_SERIAL_LIBRARY}")
else()
  message(STATUS "HDF5: not found, sagefe run --result is left out")
endif()
