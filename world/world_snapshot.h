#pragma once
/// A world as it is known at one time: immutable, stamped, shared by all that read it. A newer one
/// replaces it.
///
///     const auto snapshot =
///         std::make_shared<const WorldSnapshot>(load_world("hall.bt", ""), 12.5);
///     const double away_m = snapshot->distance().distance(point, time_s);  // what edges see
///     CollisionWorld exact(robot, snapshot->solids());                     // what a judge sees
///
/// Its views are made when they are first asked for, which any thread may do, and are then the same
/// objects for everybody. Who has no time to wait for one asks for it beforehand.

#include <locograph/world/distance_field.h>
#include <locograph/world/world.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

namespace locograph {

struct WorldSolids;

/// Where a world was read from; empty: nowhere.
struct WorldFiles {
  std::filesystem::path map = {}, obstacles = {};
  bool empty() const { return map.empty() && obstacles.empty(); }
};

class WorldSnapshot {
 public:
  /// view: of distance(). Throws Error for options out of range.
  explicit WorldSnapshot(World world, double stamp_s = 0.0, WorldFiles files = {},
                         DistanceFieldOptions view = {});
  /// seen: what distance() is to be, such as that of a window which cameras fill. The world's own
  /// map, if there is one, is for solids() alone.
  WorldSnapshot(World world, WorldDistance seen, double stamp_s = 0.0);
  ~WorldSnapshot();
  WorldSnapshot(const WorldSnapshot&) = delete;
  WorldSnapshot& operator=(const WorldSnapshot&) = delete;

  const World& world() const { return world_; }
  double stamp_s() const { return stamp_s_; }
  const WorldFiles& files() const { return files_; }

  /// See distance_view(), whose errors the call that makes it throws.
  const WorldDistance& distance() const;
  /// See world_solids.h; likewise.
  std::shared_ptr<const WorldSolids> solids() const;

 private:
  const World world_;
  const double stamp_s_;
  const WorldFiles files_;
  const DistanceFieldOptions view_;
  mutable std::once_flag distance_made_, solids_made_;
  mutable std::optional<const WorldDistance> distance_;
  mutable std::shared_ptr<const WorldSolids> solids_;
};

}  // namespace locograph
