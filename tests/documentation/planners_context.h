#pragma once
/// What the examples of planners/ take for granted.

#include <locograph/core/graph_file.h>
#include <locograph/planners/plan/scenario.h>

#include <filesystem>

namespace locograph::documentation::in_planners {

extern const std::filesystem::path data_folder;

}  // namespace locograph::documentation::in_planners
