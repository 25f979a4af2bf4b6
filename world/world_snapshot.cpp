#include <locograph/world/distance_view.h>
#include <locograph/world/point_kernels.h>
#include <locograph/world/world_snapshot.h>
#include <locograph/world/world_solids.h>

#include <utility>

namespace locograph {

WorldSnapshot::WorldSnapshot(World world, double stamp_s, WorldFiles files,
                             DistanceFieldOptions view)
    : world_(std::move(world)),
      stamp_s_(stamp_s),
      files_(std::move(files)),
      view_(std::move(view)) {
  view_.validate();
  point_kernels();  // chosen before anything is asked, for choosing allocates
}

WorldSnapshot::WorldSnapshot(World world, WorldDistance seen, double stamp_s)
    : world_(std::move(world)), stamp_s_(stamp_s) {
  std::call_once(distance_made_, [&] { distance_.emplace(std::move(seen)); });
  point_kernels();
}

WorldSnapshot::~WorldSnapshot() = default;

const WorldDistance& WorldSnapshot::distance() const {
  std::call_once(distance_made_, [this] { distance_.emplace(distance_view(world_, view_)); });
  return *distance_;
}

std::shared_ptr<const WorldSolids> WorldSnapshot::solids() const {
  std::call_once(solids_made_, [this] { solids_ = std::make_shared<const WorldSolids>(world_); });
  return solids_;
}

}  // namespace locograph
