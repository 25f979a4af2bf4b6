#pragma once
/// Covers of meshes that earlier runs have fitted, in a folder of the user's.
///
///     if (auto known = cached_fit(mesh.corners(), options)) capsules = *known;
///     else cache_fit(mesh.corners(), options, capsules = fit(mesh, options));
///
/// The folder is $LOCOGRAPH_CACHE, else $XDG_CACHE_HOME/locograph, else $HOME/.cache/locograph;
/// none where LOCOGRAPH_CACHE is set and empty. Files are named by what was fitted: the corners'
/// bits, the options and the version of the method. What cannot be read, written or understood is
/// as if it were not there. Deleting the folder is always safe. Thread-safe.

#include <locograph/robots/mesh_fit.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace locograph {

std::optional<std::vector<Capsule>> cached_fit(const std::vector<Eigen::Vector3d>& corners,
                                               const MeshFitOptions& options);
void cache_fit(const std::vector<Eigen::Vector3d>& corners, const MeshFitOptions& options,
               const std::vector<Capsule>& capsules);

}  // namespace locograph
