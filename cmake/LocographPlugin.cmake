# locograph_add_plugin(NAME SOURCES...): a library that programs load at run time by load_plugin(),
# the locograph command by --plugin. One of its sources uses LOCOGRAPH_PLUGIN (core/plugin.h).
#
#   find_package(locograph REQUIRED COMPONENTS core types)
#   locograph_add_plugin(range range_plugin.cpp)     # makes range.so
#
# Links locograph::core and locograph::types; add what else it needs with target_link_libraries.
# Nothing but the entry point is exported, so that plug-ins cannot get into each other's way.
function(locograph_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE locograph::core locograph::types)
  target_compile_definitions(${name} PRIVATE ${LOCOGRAPH_PLUGIN_HEADERS})
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden
                                           VISIBILITY_INLINES_HIDDEN ON)
  if(NOT APPLE AND NOT MSVC)
    target_link_options(${name} PRIVATE -Wl,--exclude-libs,ALL)
  endif()
endfunction()

# Sets LOCOGRAPH_PLUGIN_HEADERS to a definition that says which headers a plug-in is compiled with: a
# hash of those whose classes and virtual functions cross the boundary. The version number alone
# does not tell two states of the source tree apart. common, core: the folders of the headers.
macro(locograph_hash_plugin_headers common core)
  set(locograph_text "")
  foreach(locograph_header ${common}/error.h ${core}/constraint.h ${core}/edge.h ${core}/edge_evaluation.h
          ${core}/edge_line.h ${core}/edge_pool.h ${core}/fields.h ${core}/parameters.h
          ${core}/plugin.h ${core}/robust_kernel.h ${core}/row_label.h ${core}/scratch.h
          ${core}/type_registry.h
          ${core}/typed_edge_pool.h ${core}/vertex.h ${core}/vertex_difference.h
          ${core}/vertex_pool.h)
    file(READ ${locograph_header} locograph_one)
    string(APPEND locograph_text "${locograph_one}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${locograph_header})
  endforeach()
  string(SHA256 locograph_hash "${locograph_text}")
  string(SUBSTRING ${locograph_hash} 0 16 locograph_hash)
  set(LOCOGRAPH_PLUGIN_HEADERS "LOCOGRAPH_HEADERS=\"${locograph_hash}\"")
endmacro()
