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
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden
                                           VISIBILITY_INLINES_HIDDEN ON)
  if(NOT APPLE AND NOT MSVC)
    target_link_options(${name} PRIVATE -Wl,--exclude-libs,ALL)
  endif()
endfunction()
