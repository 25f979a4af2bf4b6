#include <locograph/apps/packed.h>
#include <locograph/apps/scene.h>
#include <locograph/apps/scene_perception.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace locograph {
namespace {

/// A page of some 4 MB, whatever the plan.
constexpr int kMostTimes = 60;
constexpr int kMostPoints = 600000, kMostPointsOfACloud = 20000;
constexpr int kUnit_mm = 2;

const PlanFile& moving(const PlanFile& file) {
  if (!file.plan.stances_only) return file;
  throw Error(file.name, 0, "nothing moves between stances, so that cameras have no way",
              "a plan of a motion to --cameras or --clouds");
}

double time_of(const PlanFile& file, std::size_t i) {
  return file.graph.vertex(VertexId<VertexConfiguration>{file.plan.slots[i]}).time_s;
}

/// Of every how many-th configuration the page has what was seen.
std::size_t times_step(const PlanFile& file) {
  return (file.plan.slots.size() + kMostTimes - 1) / kMostTimes;
}

/// Of each square of pixels one is shown, of up to so many times so many.
constexpr int kMostAlong = 15;

int pixels_between(int square) { return (square + kMostAlong - 1) / kMostAlong; }

/// Which pixels of an image are shown, and what they show.
struct Thinned {
  std::vector<std::uint8_t> places;
  std::vector<std::int16_t> depths;
};

/// Of each square the pixel nearest to its middle that shows anything: clouds may be sparse.
Thinned thinned(const DepthImage& kept, const DepthImage& taken, int square) {
  const int between = pixels_between(square), along = (square + between - 1) / between;
  std::vector<int> order(static_cast<std::size_t>(along * along));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [along](int k) {
    const int du = 2 * (k % along) - along + 1, dv = 2 * (k / along) - along + 1;
    return du * du + dv * dv;
  });
  Thinned thinned;
  for (int v = 0; v < kept.height; v += square) {
    for (int u = 0; u < kept.width; u += square) {
      std::uint8_t place = 0;
      int depth_mm = 0;
      for (const int k : order) {
        const int column = u + between * (k % along), row = v + between * (k / along);
        if (column >= kept.width || row >= kept.height) continue;
        const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(kept.width) +
                        static_cast<std::size_t>(column);
        depth_mm = kept.depth_mm[at] - taken.depth_mm[at];
        if (depth_mm == 0) continue;
        place = static_cast<std::uint8_t>(k % along + kMostAlong * (k / along));
        break;
      }
      thinned.places.push_back(place);
      thinned.depths.push_back(static_cast<std::int16_t>(depth_mm / kUnit_mm));
    }
  }
  return thinned;
}

void append_varint(std::size_t number, std::vector<std::uint8_t>& bytes) {
  for (; number >= 128; number >>= 7)
    bytes.push_back(static_cast<std::uint8_t>(number & 127) | 128);
  bytes.push_back(static_cast<std::uint8_t>(number));
}

/// Runs of voxels that are alike, along x, then y, then z: three times their length, and one more
/// for free ones, two for occupied ones.
std::string packed_states(const LocalField& field) {
  const VoxelWindow& window = field.window();
  std::vector<std::uint8_t> bytes;
  std::size_t length = 0, state = 0;
  for (int k = 0; k < window.size.z(); ++k) {
    for (int j = 0; j < window.size.y(); ++j) {
      for (int i = 0; i < window.size.x(); ++i) {
        const Eigen::Vector3i index = window.first + Eigen::Vector3i(i, j, k);
        const std::size_t here = field.is_occupied(index) ? 2 : field.is_known(index) ? 1 : 0;
        if (here != state && length > 0) {
          append_varint(3 * length + state, bytes);
          length = 0;
        }
        state = here;
        ++length;
      }
    }
  }
  append_varint(3 * length + state, bytes);
  return packed_bytes(bytes);
}

Json indices_json(const Eigen::Vector3i& v) { return {v.x(), v.y(), v.z()}; }

Json map_json(const LocalField& field, double time_s) {
  return {{"time", rounded(time_s)},
          {"first", indices_json(field.window().first)},
          {"size", indices_json(field.window().size)},
          {"states", packed_states(field)}};
}

void append(Json more, Json& list) {
  for (Json& one : more) list.push_back(std::move(one));
}

}  // namespace

PerceptionScene::PerceptionScene(const PlanFile& file, const Judging& judging,
                                 const PerceptionChoice& choice)
    : file_(moving(file)),
      choice_(choice),
      eyes_(file, judging, choice, [this](const FilteredImage& image) { take(image); }),
      newest_(eyes_.perception().cameras().size()) {}

int PerceptionScene::square(const DepthCamera& camera) const {
  const std::size_t times = (file_.plan.slots.size() - 1) / times_step(file_) + 1;
  const double clouds = static_cast<double>(times * eyes_.perception().cameras().size());
  const double points = std::min<double>(kMostPointsOfACloud, kMostPoints / clouds);
  return static_cast<int>(std::ceil(std::sqrt(camera.width * camera.height / points)));
}

void PerceptionScene::take(const FilteredImage& image) {
  newest_[static_cast<std::size_t>(image.kept.camera)] = {image.world_from_optical, image.kept,
                                                          image.taken, true};
}

Json PerceptionScene::blank() const {
  const LocalMapOptions& map = eyes_.perception().options().map;
  Json cameras = Json::array();
  for (const DepthCamera& camera : eyes_.perception().cameras()) {
    const int pixels = square(camera);
    cameras.push_back({{"name", camera.name},
                       {"square", pixels},
                       {"between", pixels_between(pixels)},
                       {"columns", (camera.width + pixels - 1) / pixels},
                       {"rows", (camera.height + pixels - 1) / pixels},
                       {"focal", {rounded(camera.fx), rounded(camera.fy)}},
                       {"centre", {rounded(camera.cx), rounded(camera.cy)}},
                       {"range", rounded(std::min(camera.range_max_m, map.range_m))}});
  }
  Json json = {{"cameras", std::move(cameras)},
               {"resolution", map.resolution_m},
               {"unknown", choice_.unknown},
               {"clouds", Json::array()},
               {"maps", Json::array()}};
  if (std::isfinite(map.floor_top_m())) json["floor"] = rounded(map.floor_top_m());
  return json;
}

Json PerceptionScene::news(double time_s) {
  Json clouds = Json::array(), maps = Json::array();
  for (std::size_t i = 0; i < newest_.size(); ++i) {
    Cloud& cloud = newest_[i];
    if (!std::exchange(cloud.is_new, false)) continue;
    const Thinned points =
        thinned(cloud.kept, cloud.taken, square(eyes_.perception().cameras()[i]));
    clouds.push_back({{"camera", i},
                      {"stamp", rounded(cloud.kept.stamp_s)},
                      {"pose", pose_json(cloud.world_from_optical)},
                      {"places", packed_bytes(points.places)},
                      {"depths", packed_shorts(points.depths)}});
  }
  const std::shared_ptr<const LocalField>& field = eyes_.perception().field();
  if (field != shown_) maps.push_back(map_json(*field, time_s));
  shown_ = field;
  return {{"clouds", std::move(clouds)}, {"maps", std::move(maps)}};
}

Json PerceptionScene::along_plan(const std::function<void(double)>& on_progress) {
  Json json = blank();
  const WorldAt show = eyes_.world_at();
  const std::size_t count = file_.plan.slots.size(), step = times_step(file_);
  for (std::size_t i = 0; i < count; ++i) {
    show(static_cast<int>(i));
    if (on_progress) on_progress(static_cast<double>(i + 1) / static_cast<double>(count));
    if (i % step != 0 && i + 1 < count) continue;
    Json more = news(time_of(file_, i));
    append(std::move(more["clouds"]), json["clouds"]);
    append(std::move(more["maps"]), json["maps"]);
  }
  const Perception& perception = eyes_.perception();
  json["images"] = perception.images();
  json["blind_images"] = perception.blind();
  json["refused_images"] = eyes_.walk().refused();
  warn_of_unseen();
  return json;
}

void PerceptionScene::warn_of_unseen() const {
  const Perception& perception = eyes_.perception();
  const int refused = eyes_.walk().refused();
  const std::string from = short_number(time_of(file_, 0));
  const std::string to = short_number(time_of(file_, file_.plan.slots.size() - 1));
  if (perception.images() == 0) {
    throw Error((std::filesystem::path(choice_.clouds) / "clouds.csv").string(), 0,
                refused > 0 ? eyes_.walk().last_refusal() : "no cloud until the plan ends",
                "clouds of its time, " + from + " to " + to + " s");
  }
  if (refused > 0) {
    print_warning(counted(refused, "image", "images") +
                  " not used: " + eyes_.walk().last_refusal());
  }
  if (perception.blind() > 0) {
    print_warning(counted(perception.blind(), "image shows", "images show") + " nothing");
  }
  if (choice_.clouds.empty() || !std::isfinite(eyes_.next_stamp_s())) return;
  print_warning("clouds from " + short_number(eyes_.next_stamp_s()) +
                " s on are not shown: the plan ends at " + to + " s");
}

}  // namespace locograph
