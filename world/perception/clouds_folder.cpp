#include <locograph/common/control_characters.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/common/parse_number.h>
#include <locograph/common/ranges.h>
#include <locograph/common/suggestion.h>
#include <locograph/world/perception/clouds_folder.h>
#include <locograph/world/perception/depth_png.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace locograph {
namespace {

constexpr std::string_view kClouds = "clouds.csv", kColumns = "time_s,camera,file";
constexpr std::uintmax_t kMostListBytes = std::uintmax_t{64} << 20;

/// Without blanks around it.
std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) + 1 - first);
}

/// What stands before the next comma, and takes both away.
std::string_view next_column(std::string_view& text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const std::string_view column = trimmed(text.substr(0, comma));
  text.remove_prefix(std::min(comma + 1, text.size()));
  return column;
}

std::string in_quotes(std::string_view text) {
  return "'" + without_controls(text.substr(0, 80), "\\x") + "'";
}

/// By its name: what links lead to is the user's own affair.
bool leaves_its_folder(const std::filesystem::path& file) {
  const std::filesystem::path normal = file.lexically_normal();
  return normal.is_absolute() || *normal.begin() == "..";
}

void require_png_of(const DepthPng& png, const DepthCamera& camera, double stamp_s,
                    const std::string& file) {
  constexpr double kSameStamp_s = 1e-3, kSameLens = 0.01;
  const DepthImage& image = png.image;
  if (image.width != camera.width || image.height != camera.height) {
    throw Error(file, 0,
                std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels",
                std::to_string(camera.width) + " x " + std::to_string(camera.height) + " of " +
                    camera.name);
  }
  if (png.stamped && std::abs(image.stamp_s - stamp_s) > kSameStamp_s) {
    throw Error(file, 0, "its own stamp is " + std::to_string(image.stamp_s) + " s",
                std::to_string(stamp_s) + " s as in " + std::string(kClouds));
  }
  if (!png.camera) return;
  if (png.camera->name != camera.name) {
    throw Error(file, 0, "an image of the camera " + in_quotes(png.camera->name),
                in_quotes(camera.name) + " as in " + std::string(kClouds));
  }
  const auto lens = [](const DepthCamera& one) {
    return Eigen::Vector4d(one.fx, one.fy, one.cx, one.cy);
  };
  if ((lens(*png.camera) - lens(camera)).cwiseAbs().maxCoeff() > kSameLens) {
    throw Error(file, 0, "an image of another lens than that of " + camera.name,
                "its fx, fy, cx and cy");
  }
}

}  // namespace

CloudsFolder::CloudsFolder(const std::filesystem::path& folder, std::vector<DepthCamera> cameras)
    : folder_(folder), cameras_(std::move(cameras)) {
  if (cameras_.empty()) throw Error("clouds of a robot without cameras", "one camera or more");
  for (const DepthCamera& camera : cameras_) camera.validate();
  const std::string csv = (folder_ / kClouds).string();
  const std::string content = read_file(csv, kMostListBytes, "the list of clouds");
  int line = 0;
  for (std::string_view rest = content; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view text = trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++line;
    if (text.empty() || (line == 1 && text == kColumns)) continue;
    add_line(csv, line, text);
  }
  if (clouds_.empty()) throw Error(csv, 0, "lists no cloud", std::string(kColumns));
}

void CloudsFolder::add_line(const std::string& csv, int line, std::string_view text) {
  const std::string_view time = next_column(text), name = next_column(text), file = trimmed(text);
  if (time.empty() || name.empty() || file.empty()) {
    throw Error(csv, line, "not three columns", std::string(kColumns));
  }
  Cloud cloud;
  if (!parse_number(time, cloud.stamp_s) || !(std::abs(cloud.stamp_s) <= ranges::kTime_s)) {
    throw Error(csv, line, "time_s is " + in_quotes(time), "seconds, at most 1000000");
  }
  const auto camera = std::find_if(cameras_.begin(), cameras_.end(),
                                   [&](const DepthCamera& one) { return one.name == name; });
  if (camera == cameras_.end()) {
    std::vector<std::string> names;
    for (const DepthCamera& one : cameras_) names.push_back(one.name);
    throw Error(csv, line, "unknown camera " + in_quotes(name),
                "one of " + joined_names(names) + did_you_mean(name, names));
  }
  cloud.camera = static_cast<int>(camera - cameras_.begin());
  if (!clouds_.empty() && cloud.stamp_s < clouds_.back().stamp_s) {
    throw Error(csv, line, "time_s " + in_quotes(time) + " is before that of the line above",
                "ascending times");
  }
  for (auto other = clouds_.rbegin(); other != clouds_.rend(); ++other) {
    if (other->stamp_s < cloud.stamp_s) break;
    if (other->camera == cloud.camera) {
      throw Error(csv, line,
                  "a second image of " + in_quotes(name) + " at " + std::string(time) + " s",
                  "one of each camera at a time");
    }
  }
  cloud.file = std::filesystem::path(file);
  if (leaves_its_folder(cloud.file)) {
    throw Error(csv, line, "the file " + in_quotes(file) + " is outside of the folder",
                "a path in it");
  }
  if (cloud.file.extension() != ".pcd" && cloud.file.extension() != ".png") {
    throw Error(csv, line, "the file " + in_quotes(file) + " is of an unknown kind",
                ".pcd or .png");
  }
  std::error_code failed;
  if (!std::filesystem::is_regular_file(folder_ / cloud.file, failed)) {
    throw Error(csv, line, "there is no file " + in_quotes(file),
                "a cloud or an image in the folder");
  }
  clouds_.push_back(std::move(cloud));
}

std::vector<std::filesystem::path> CloudsFolder::files() const {
  std::vector<std::filesystem::path> files = {folder_ / kClouds};
  for (const Cloud& cloud : clouds_) files.push_back(folder_ / cloud.file);
  return files;
}

DepthImage CloudsFolder::load(int i) const {
  const Cloud& cloud = clouds_[static_cast<std::size_t>(i)];
  const DepthCamera& camera = cameras_[static_cast<std::size_t>(cloud.camera)];
  const std::filesystem::path path = folder_ / cloud.file;
  DepthImage image;
  if (path.extension() == ".png") {
    DepthPng png = load_depth_png(path);
    require_png_of(png, camera, cloud.stamp_s, path.string());
    image = std::move(png.image);
  } else {
    const PointCloud points = read_point_cloud(path);
    try {
      image = depth_image_of(points, camera);
    } catch (const Error& error) {
      throw Error(path.string(), 0, error.what(), "");
    }
  }
  image.stamp_s = cloud.stamp_s;
  image.camera = cloud.camera;
  remove_nearer_than_range(camera, image);
  return image;
}

}  // namespace locograph
