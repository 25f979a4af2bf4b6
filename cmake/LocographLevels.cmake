# Kernels that are compiled once for each level of x86-64 (common/simd_level.h chooses at run time),
# elsewhere once for the processor that everything is compiled for.
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(-march=x86-64-v4 LOCOGRAPH_X86_64_LEVELS)

# locograph_levels(FOLDER CHOOSERS sources... SOURCES kernels...)
# adds to locograph::FOLDER the kernels, each level in a namespace of its own: object libraries
# locograph_FOLDER_v2, _v3 and _v4, or _portable. The choosers' sources see LOCOGRAPH_X86_64_LEVELS
# where there are levels (common/level_table.h). Nothing is fused but what the kernels fuse. Source by source and without
# precompiled headers: they share names in unnamed namespaces, and must not share an inline function
# with anybody.
function(locograph_levels folder)
  cmake_parse_arguments(arg "" "" "CHOOSERS;SOURCES" ${ARGN})
  set(levels portable)
  if(LOCOGRAPH_X86_64_LEVELS)
    set(levels v2 v3 v4)
    set_source_files_properties(${arg_CHOOSERS} PROPERTIES
      COMPILE_DEFINITIONS LOCOGRAPH_X86_64_LEVELS=1)
  endif()
  foreach(level ${levels})
    set(processor)
    if(LOCOGRAPH_X86_64_LEVELS)
      set(processor -march=x86-64-${level})
    endif()
    set(target locograph_${folder}_${level})
    add_library(${target} OBJECT ${arg_SOURCES})
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON UNITY_BUILD OFF
                          LOCOGRAPH_PROCESSOR "${processor}")
    target_compile_features(${target} PRIVATE cxx_std_20)
    target_compile_definitions(${target} PRIVATE LOCOGRAPH_SIMD_NAMESPACE=simd_${level})
    target_compile_options(${target} PRIVATE -ffp-contract=off -fno-exceptions ${processor})
    target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/include)
    target_link_libraries(${target} PRIVATE locograph_private_options)
    target_sources(locograph_${folder} PRIVATE $<TARGET_OBJECTS:${target}>)
  endforeach()
endfunction()
