set(SAGEFE_HEADER_HASH_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/sagefeHeaderHash.cmake)

# sage_header_hash(TARGET FOLDER): the target sees FOLDER/sage/core/header_hash.hpp, written anew when a header of the
# interfaces (core, messages, platform) in SAGEFE_INCLUDE_DIR/sage has changed.
function(sage_header_hash target folder)
  file(GLOB headers ${SAGEFE_INCLUDE_DIR}/sage/core/*.hpp ${SAGEFE_INCLUDE_DIR}/sage/messages/*.hpp ${SAGEFE_INCLUDE_DIR}/sage/platform/*.hpp)
  list(REMOVE_ITEM headers ${SAGEFE_INCLUDE_DIR}/sage/core/header_hash.hpp)
  set(out ${folder}/sage/core/header_hash.hpp)
  set(command ${CMAKE_COMMAND} -DROOT=${SAGEFE_INCLUDE_DIR} -DOUT=${out} -P ${SAGEFE_HEADER_HASH_SCRIPT})
  add_custom_command(OUTPUT ${out} COMMAND ${command} DEPENDS ${headers} ${SAGEFE_HEADER_HASH_SCRIPT} VERBATIM)
  if(NOT EXISTS ${out})
    execute_process(COMMAND ${command})  # for what reads sources without a build
  endif()
  target_sources(${target} PRIVATE ${out})
  target_include_directories(${target} BEFORE PRIVATE ${folder})
endfunction()

# sage_add_plugin(NAME source ...): NAME.so, a library for `sagefe --plugin` (docs/manual/plugins.md).  Its names stay
# its own: of what it takes from the package's libraries it shows nothing to others.  It holds a hash of the headers that
# it is compiled with; sagefe rejects one built with other headers.
function(sage_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  sage_header_hash(${name} ${CMAKE_CURRENT_BINARY_DIR}/${name}_headers)
  target_link_libraries(${name} PRIVATE sagefe::elements sagefe::materials sagefe::core)
  set_target_properties(${name} PROPERTIES PREFIX "" SUFFIX ".so" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_options(${name} PRIVATE LINKER:--exclude-libs,ALL LINKER:--no-undefined)
endfunction()
