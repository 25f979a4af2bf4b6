#pragma once
/// Descriptions of files for `locograph info`, as JSON objects.
///
///     print_result(describe_graph("sphere.g2o", graph_types()), as_json);
///
/// Every function throws Error for a file it cannot read.

#include <locograph/apps/output.h>
#include <locograph/core/type_registry.h>

#include <filesystem>

namespace locograph {

/// Any kind of file: by extension, and by content where the extension says nothing. types: of graph
/// files.
Json describe_file(const std::filesystem::path& path, const TypeRegistry& types);

/// Unknown tags and indefinite information matrices are counted, not refused.
Json describe_graph(const std::filesystem::path& path, const TypeRegistry& types);
/// A URDF, with the SRDF of the same name beside it if there is one.
Json describe_robot(const std::filesystem::path& path);
Json describe_map(const std::filesystem::path& path);
Json describe_obstacles(const std::filesystem::path& path);

}  // namespace locograph
