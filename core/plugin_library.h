#pragma once
/// Loads plug-ins: shared libraries that add vertex, edge and parameter types to a registry.
///
///     TypeRegistry types = standard_types();
///     load_plugin(find_plugin("range", {"/opt/robot/lib/locograph"}), types);
///     Graph graph = read_graph("beacons.g2o", types);      // with types of librange.so
///
/// A library is written with <locograph/core/plugin.h>. Before anything of C++ crosses the boundary
/// its record is compared with ours: version, compiler, standard library, Eigen, alignment, sizes
/// of the classes that cross. Loading runs the library's static initialisers, as any loading does.
///
/// A library that was accepted stays loaded until the process ends, because graphs, parameters and
/// exceptions made of its code may outlive every registry. One that was refused is unloaded, and
/// the registry is as it was before.

#include <locograph/core/type_registry.h>

#include <filesystem>
#include <string>
#include <vector>

namespace locograph {

struct PluginRecord;

/// Adds the types of a library. Throws Error naming the file when it is missing, is no shared
/// library, has no entry point, was built differently (every difference is named), registers a tag
/// that is taken, or throws.
void load_plugin(const std::filesystem::path& library, TypeRegistry& types);

/// The file of a plug-in. `name` is a path, or the name of a file NAME, NAME.so or libNAME.so in
/// one of the folders. Throws Error, with all places looked at, when there is none.
std::filesystem::path find_plugin(const std::string& name,
                                  const std::vector<std::filesystem::path>& folders);

/// What differs between a library's record and ours, one text each; empty: it fits.
std::vector<std::string> abi_differences(const PluginRecord& theirs);

}  // namespace locograph
