// Makes an occupancy map out of the boxes in an obstacles file.
//
//     make_map boxes.xml 0.05 boxes.bt

#include <locograph/common/error.h>
#include <locograph/common/stop_signals.h>
#include <locograph/world/obstacles.h>
#include <locograph/world/octree.h>

#include <cstdlib>
#include <iostream>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: make_map OBSTACLES.xml RESOLUTION_M OUT.bt\n";
    return 2;
  }
  locograph::take_stop_signals();
  try {
    std::vector<locograph::Box> boxes;
    for (const locograph::Obstacle& obstacle : locograph::load_obstacles(argv[1])) {
      if (obstacle.shape != locograph::Obstacle::Shape::kBox) {
        throw locograph::Error(argv[1], 0, "obstacle '" + obstacle.name + "' is not a box",
                               "boxes only");
      }
      boxes.push_back({obstacle.world_from_obstacle, obstacle.size});
    }
    locograph::save_octree(*locograph::octree_from_boxes(boxes, std::atof(argv[2])), argv[3]);
  } catch (const locograph::Error& error) {
    std::cerr << "make_map: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
