#pragma once
/// Reads and writes graphs in the `.g2o` text format.
///
///     ReadReport report;
///     Graph graph = read_graph("map.g2o", standard_types(), {}, &report);
///     write_graph(graph, "out.g2o");
///
/// One item a line: parameters, vertices (`TAG id fields…`), `FIX id…`, edges (`TAG ids… fields…
/// upper triangle of Ω row by row`; with run-time arity `TAG ids… || n …`, n the size of the
/// error). An edge that is another constraint than its type says ends in `constraint KIND`, KIND
/// none, equality or inequality, and one with a tolerance of its own in `constraint KIND tolerance`
/// (Graph::set_constraint). Lines may come in any order, be blank, be indented, and end in a `#`
/// comment. A file without any vertex gets them from its edges. Every mistake is an Error with file
/// and line; nothing is guessed. Numbers are written with 17 significant digits: reading them back
/// gives the same bits. Paths in parameters are relative to the file, behind links to it.

#include <locograph/core/graph.h>
#include <locograph/core/type_registry.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace locograph {

struct ReadOptions {
  /// Unknown tags and indefinite information matrices are reported instead of refused; the matrices
  /// are projected to the nearest positive semi-definite one.
  bool lenient = false;
  /// Called some hundred times with the fraction of the lines that are read, if it is not empty.
  std::function<void(double fraction)> progress = {};
};

struct ReadReport {
  int indefinite_information = 0;    ///< edges whose matrix was projected
  int first_indefinite_line = 0;     ///< 0: none
  std::vector<std::string> unknown;  ///< one message for each line with an unknown tag
  bool vertices_from_edges = false;  ///< the file had no vertex
};

Graph read_graph(const std::filesystem::path& path, const TypeRegistry& types,
                 const ReadOptions& options = {}, ReadReport* report = nullptr);
/// name: for messages; folder: what relative paths are relative to.
Graph read_graph_text(std::string_view text, const std::string& name,
                      const std::filesystem::path& folder, const TypeRegistry& types,
                      const ReadOptions& options = {}, ReadReport* report = nullptr);

/// As write_file_atomically(): the whole graph or nothing; `-` is standard output.
void write_graph(const Graph& graph, const std::filesystem::path& path);
/// folder: what paths are written relative to; empty: they are absolute.
std::string write_graph_text(const Graph& graph, const std::filesystem::path& folder = {});

}  // namespace locograph
