#pragma once
/// The types that the commands know in a graph file, plug-ins (--plugin) included.
///
///     std::vector<std::string> plugins;
///     add_plugin_option(parser, plugins);
///     …
///     Graph graph = read_input_graph("plan.g2o", graph_types(plugins));
///
/// A plug-in is a path, or a bare name that is looked for in `lib/locograph` beside the folder of
/// the running program or beside one of those above it: build/lib/locograph for build/bin.

#include <locograph/apps/option_parser.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/type_registry.h>

#include <string>
#include <vector>

namespace locograph {

/// Throws Error for a plug-in that cannot be found or loaded.
TypeRegistry graph_types(const std::vector<std::string>& plugins = {});

/// What messages call an input: `stdin` for `-`, else the file.
std::string input_name(const std::string& input);
/// read_graph() of a file, or of standard input, `-`: then paths are relative to the folder that
/// the command runs in.
Graph read_input_graph(const std::string& input, const TypeRegistry& types,
                       const ReadOptions& options = {}, ReadReport* report = nullptr);

/// Adds `--plugin LIB.so`, which may be given many times. plugins must outlive the parsing.
void add_plugin_option(OptionParser& parser, std::vector<std::string>& plugins);

}  // namespace locograph
