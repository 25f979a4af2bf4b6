// Graph files with the types of types/ and, as fuzz_plan, those of robots. What was read has to
// survive being written.

#include <locograph/core/graph_file.h>
#include <locograph/types/standard_types.h>

#include <string_view>

#include "fuzz_target.h"
#ifdef LOCOGRAPH_FUZZ_ROBOTS
#include <locograph/plugins/robot_types.h>

#include "plugins/small_robot.h"
#endif

namespace {

struct Surroundings {
  locograph::FuzzFolder folder;
  locograph::TypeRegistry types = locograph::standard_types();

#ifdef LOCOGRAPH_FUZZ_ROBOTS
  Surroundings() {
    folder.write("cart.urdf", locograph::test::kCartUrdf);
    folder.write("cart.srdf", locograph::test::kCartSrdf);
    locograph::add_robot_types(types);
  }
#endif
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Surroundings around;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  locograph::Graph graph;
  // The first byte says how lenient to be; files begin with '#' or a tag.
  const locograph::ReadOptions options{.lenient = size > 0 && data[0] == '#'};
  const bool taken = locograph::accept_or_refuse("fuzz.g2o", [&] {
    graph =
        locograph::read_graph_text(text, "fuzz.g2o", around.folder.path(), around.types, options);
  });
  if (!taken) return 0;
  const std::string written = locograph::write_graph_text(graph, around.folder.path());
  if (written.empty()) return 0;  // lenient: nothing was of a known type
  const locograph::Graph again =
      locograph::read_graph_text(written, "written.g2o", around.folder.path(), around.types);
  if (again.vertex_count() != graph.vertex_count() || again.edge_count() != graph.edge_count()) {
    std::abort();
  }
  return 0;
}
