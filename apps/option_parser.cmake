# How the command and the benchmarks read their arguments: CLI11, compiled once, and the headers that
# benchmarks share, precompiled once.
if(NOT TARGET option_parser)
  file(CREATE_LINK ${CMAKE_CURRENT_LIST_DIR} ${PROJECT_BINARY_DIR}/include/locograph/apps SYMBOLIC)
  add_library(option_parser STATIC ${CMAKE_CURRENT_LIST_DIR}/option_parser.cpp)
  target_include_directories(option_parser PUBLIC ${PROJECT_BINARY_DIR}/include)
  target_link_libraries(option_parser PRIVATE locograph_private_options locograph::common
    Eigen3::Eigen CLI11::CLI11 nlohmann_json::nlohmann_json)
  target_precompile_headers(option_parser PRIVATE ${locograph_precompiled} <iostream> <random>
    <nlohmann/json.hpp>)
endif()
