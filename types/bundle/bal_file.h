#pragma once
/// Reads the text files of "Bundle Adjustment in the Large" (Agarwal et al. 2010).
///
///     Graph graph = read_bal("problem-49-7776-pre.txt");
///     optimise(graph, options, *make_linear_solver("schur"));
///
/// The file: `cameras points observations`; for each observation `camera point x y`; nine numbers
/// for each camera (see camera_bal.h); three for each point. Cameras become VERTEX_CAMERA_BAL with
/// ids 0 … cameras − 1, points VERTEX_TRACKXYZ with the ids after, marked for elimination,
/// observations EDGE_PROJECT_BAL in the order of the file. Nothing is fixed: Levenberg-Marquardt's
/// damping holds the gauge. There is no packed form; unpack .bz2 and .gz first.

#include <locograph/core/graph.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace locograph {

/// Throws Error with file and line.
Graph read_bal(const std::filesystem::path& file);
/// `name` is what messages call it.
Graph read_bal_text(std::string_view text, const std::string& name);

/// Whether a text begins like a BAL file: three whole numbers on its first line that is not empty.
bool looks_like_bal(std::string_view text);

/// Marks the points (VERTEX_TRACKXYZ, VERTEX_INVERSE_DEPTH) of any graph for elimination where that
/// is likely to pay: there are more of them than of other vertices, and no edge ties two. Returns
/// how many were marked.
int mark_points_for_elimination(Graph& graph);

}  // namespace locograph
