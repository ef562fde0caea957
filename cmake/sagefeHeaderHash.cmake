# cmake -DROOT=... -DOUT=... -P sagefeHeaderHash.cmake: writes OUT, a header with a hash of the headers in ROOT/sage/core, messages and platform, which are all
# that program and plug-in share (sage/core/plugin.hpp).
file(GLOB headers ${ROOT}/sage/core/*.hpp ${ROOT}/sage/messages/*.hpp ${ROOT}/sage/platform/*.hpp)
list(SORT headers)
foreach(header IN LISTS headers)
  get_filename_component(name ${header} NAME)
  if(NOT name STREQUAL "header_hash.hpp")
    file(SHA256 ${header} hash)
    string(APPEND all "${name} ${hash}\n")
  endif()
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 16 hash)
file(WRITE ${OUT} "// Of the headers in sage/core, messages and platform, written when they changed.\n#define SAGE_HEADER_HASH \"${hash}\"\n")
