#pragma once
/// Descriptions of files for `locograph info`, as JSON objects.
///
///     print_result(describe_graph("sphere.g2o", graph_types()), as_json);
///
/// Every function throws Error for a file it cannot read.

#include <locograph/apps/output.h>
#include <locograph/core/type_registry.h>
#include <locograph/world/link_pairs.h>

#include <filesystem>
#include <string>

namespace locograph {

/// Any kind of file: by content, and by extension where the content says nothing. types: of graph
/// files.
Json describe_file(const std::filesystem::path& path, const TypeRegistry& types);

/// Unknown tags and indefinite information matrices are counted, not refused.
Json describe_graph(const std::filesystem::path& path, const TypeRegistry& types);
/// A URDF, with the SRDF of the same name beside it if there is one.
Json describe_robot(const std::filesystem::path& path);
/// Which pairs of the robot's links meet in random postures, and which of them the SRDF switches
/// off. robot: a URDF, or the name of a robot that comes along.
Json describe_link_pairs(const std::string& robot, const LinkPairOptions& options);
Json describe_map(const std::filesystem::path& path);
Json describe_obstacles(const std::filesystem::path& path);
/// Files that it names and that are not there are listed, not refused.
Json describe_scenario(const std::filesystem::path& path);
/// Without the robot: whether its links exist stays open.
Json describe_contacts(const std::filesystem::path& path);
/// Bundle adjustment in the large.
Json describe_bal(const std::filesystem::path& path);

}  // namespace locograph
