# One library target per folder of the house, all built alike.

# What nearly every source includes: read once for all folders, and once more for each that names
# headers of its own.
set(locograph_precompiled <Eigen/Dense> <locograph/common/eigen_instances.h>
    <algorithm> <filesystem> <memory> <span> <string> <vector>)

# locograph_folder(NAME [INTERFACE] SOURCES... [PUBLIC deps...] [PRIVATE deps...]
#                  [PRECOMPILE headers...])
# makes locograph::NAME out of the folder it is called in. Headers are included as
# <locograph/NAME/...>, in the build tree through a link, after installation for real.
function(locograph_folder name)
  cmake_parse_arguments(arg "INTERFACE" "" "SOURCES;PUBLIC;PRIVATE;PRECOMPILE" ${ARGN})
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include/locograph)
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/include/locograph/${name}
       SYMBOLIC)
  set(target locograph_${name})
  if(arg_INTERFACE)
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  else()
    add_library(${target} STATIC ${arg_SOURCES})
    set(scope PUBLIC)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:locograph_private_options>)
    if(arg_PRECOMPILE OR name STREQUAL "common")
      target_precompile_headers(${target} PRIVATE ${locograph_precompiled} ${arg_PRECOMPILE})
    else()
      target_precompile_headers(${target} REUSE_FROM locograph_common)
    endif()
    if(arg_PRIVATE)
      target_link_libraries(${target} PRIVATE ${arg_PRIVATE})
    endif()
  endif()
  add_library(locograph::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} ${scope} cxx_std_20)
  # The alignment of Eigen types is part of our ABI: pinned here, so that a user's -march cannot
  # change the layout of a vertex or an edge.
  target_compile_definitions(${target} ${scope}
    EIGEN_MAX_ALIGN_BYTES=64 EIGEN_MAX_STATIC_ALIGN_BYTES=64)
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  if(arg_PUBLIC)
    target_link_libraries(${target} ${scope} ${arg_PUBLIC})
  endif()
  install(TARGETS ${target} EXPORT locographTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/locograph/${name} FILES_MATCHING PATTERN "*.h"
          PATTERN models EXCLUDE PATTERN scenarios EXCLUDE PATTERN ompl_manifold.h EXCLUDE)
endfunction()

# locograph_test(NAME SOURCES... LINK targets... [PRECOMPILE headers...] [SHARDS n]): one GoogleTest
# program. Of a large one name the headers that most of its files need; the others share what
# gtest_instances has precompiled. For ctest it is one test, a long one n of them, not one for each
# case: a process for each of thousands of cases takes longer than the cases. Those that
# LOCOGRAPH_LEAVE_OUT_TESTS names are neither built with everything nor known to ctest.
function(locograph_test name)
  cmake_parse_arguments(arg "" "SHARDS" "SOURCES;LINK;PRECOMPILE" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LINK} gtest_instances locograph_private_options
    GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    LOCOGRAPH_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data"
    LOCOGRAPH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  if(arg_PRECOMPILE)
    target_precompile_headers(${name} PRIVATE <common/gtest_instances.h> ${locograph_precompiled}
      ${arg_PRECOMPILE})
  else()
    target_precompile_headers(${name} REUSE_FROM gtest_instances)
  endif()
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/bin)
  if(name IN_LIST LOCOGRAPH_LEAVE_OUT_TESTS)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    return()
  endif()
  if(NOT arg_SHARDS)
    set(arg_SHARDS 1)
  endif()
  foreach(shard RANGE 1 ${arg_SHARDS})
    math(EXPR index "${shard} - 1")
    set(test ${name})
    if(arg_SHARDS GREATER 1)
      set(test ${name}_${shard}_of_${arg_SHARDS})
    endif()
    add_test(NAME ${test} COMMAND ${name} --gtest_brief=1)
    set_tests_properties(${test} PROPERTIES TIMEOUT 9000
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${arg_SHARDS};GTEST_SHARD_INDEX=${index}")
  endforeach()
endfunction()

# locograph_benchmark(NAME SOURCES... LINK targets...): one Google Benchmark program.
function(locograph_benchmark name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LINK} locograph_private_options benchmark::benchmark)
  target_compile_definitions(${name} PRIVATE
    LOCOGRAPH_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data"
    LOCOGRAPH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/benchmarks)
  if(TARGET option_parser)
    target_precompile_headers(${name} REUSE_FROM option_parser)
  endif()
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/benchmarks/bin)
endfunction()

# What our own code is compiled with and nobody else's.
add_library(locograph_private_options INTERFACE)
target_compile_options(locograph_private_options INTERFACE -Wall -Wextra -Wpedantic)
# GCC 12 warns about Eigen's own fixed-size kernels once they are inlined, inside its own AVX-512
# headers where Eigen multiplies matrices of run-time size, and takes dual numbers of four parts for
# uninitialised where it copies them as vectors.
target_compile_options(locograph_private_options INTERFACE
  $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized -Wno-maybe-uninitialized -Wno-array-bounds
    -Wno-stringop-overread -Wno-stringop-overflow>)
# Of a type whose members are of this source alone: a unity build takes sources for headers.
if(CMAKE_UNITY_BUILD)
  target_compile_options(locograph_private_options INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
# Instrumented code makes GCC 12 see more uninitialised values than there are; Release decides.
if(LOCOGRAPH_WERROR AND NOT LOCOGRAPH_SANITIZE)
  target_compile_options(locograph_private_options INTERFACE -Werror)
endif()
if(LOCOGRAPH_NATIVE AND NOT LOCOGRAPH_SANITIZE AND NOT CMAKE_CROSSCOMPILING)
  # It would override the flags of sources that are compiled for several processors
  # (solvers/CMakeLists.txt).
  target_compile_options(locograph_private_options INTERFACE
    $<$<NOT:$<BOOL:$<TARGET_PROPERTY:LOCOGRAPH_PROCESSOR>>>:-march=native>)
endif()
target_compile_options(locograph_private_options INTERFACE -fno-math-errno)
if(LOCOGRAPH_SANITIZE)
  add_compile_options(-fsanitize=${LOCOGRAPH_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  # Four of UBSan's checks stand before every access in every inlined Eigen expression and make
  # nearly half of the build. AddressSanitizer sees such accesses, and Eigen asserts its alignment.
  if(LOCOGRAPH_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize=null,alignment,object-size,pointer-overflow)
  endif()
  add_link_options(-fsanitize=${LOCOGRAPH_SANITIZE})
endif()
