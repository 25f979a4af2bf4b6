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
# does not tell two states of the source tree apart. root: the folder of the folders of the headers;
# planning: whether what constraints on robots see is part of it.
macro(locograph_hash_plugin_headers root planning)
  set(locograph_hashed
    common/error core/block_products core/constraint core/edge core/edge_evaluation core/edge_line core/edge_pool
    core/fields core/parameters core/plugin core/robust_kernel core/row_label core/scratch
    core/type_registry core/typed_edge_pool core/vertex core/vertex_difference core/vertex_pool)
  if(${planning})
    list(APPEND locograph_hashed
      robots/collision_model robots/contact robots/contact_closure robots/contact_kind_table
      robots/robot robots/robot_state robots/wheel robots/wrench_cone
      world/distance_field world/distance_sample world/distance_source world/obstacles
      plugins/configuration/frame_parameter plugins/configuration/robot_parameters
      plugins/configuration/self_collision_shapes plugins/configuration/vertex_configuration
      plugins/configuration/contact_parameter plugins/configuration/stance_parameter
      plugins/static_balance/vertex_wrenches)
  endif()
  set(locograph_text "")
  foreach(locograph_header ${locograph_hashed})
    file(READ ${root}/${locograph_header}.h locograph_one)
    string(APPEND locograph_text "${locograph_one}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${root}/${locograph_header}.h)
  endforeach()
  string(SHA256 locograph_hash "${locograph_text}")
  string(SUBSTRING ${locograph_hash} 0 16 locograph_hash)
  set(LOCOGRAPH_PLUGIN_HEADERS "LOCOGRAPH_HEADERS=\"${locograph_hash}\"")
endmacro()
