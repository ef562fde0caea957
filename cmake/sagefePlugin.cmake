# sage_add_plugin(NAME source ...): NAME.so, a library for `sagefe --plugin` (docs/manual/plugins.md).  Its names stay
# its own: of what it takes from the package's libraries it shows nothing to others.
function(sage_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE sagefe::elements sagefe::materials sagefe::core)
  set_target_properties(${name} PROPERTIES PREFIX "" SUFFIX ".so" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_options(${name} PRIVATE LINKER:--exclude-libs,ALL LINKER:--no-undefined)
endfunction()
