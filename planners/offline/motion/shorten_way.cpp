#include <locograph/common/uniform.h>
#include <locograph/planners/offline/motion/shorten_way.h>

#include <algorithm>
#include <iterator>
#include <random>

namespace locograph {
namespace {

constexpr double kDenseWay = 0.15;
constexpr double kBetweenDense = 0.05;
constexpr double kSamePlace = 1e-8;
/// A middle that is brought back may be so much further away than a straight one.
constexpr double kMostBentMiddle = 0.75;
/// What a shorter way has to gain.
constexpr double kLeastGain = 1e-3;

bool append_joined(SegmentSpace& space, std::vector<Eigen::VectorXd>& way,
                   const Eigen::VectorXd& to, bool swinging) {
  const Eigen::VectorXd from = way.back();
  const double apart = space.distance(from, to);
  if (apart < kSamePlace) return true;
  if (apart <= kDenseWay) {
    if (!space.valid_between(from, to, kBetweenDense, swinging)) return false;
    way.push_back(to);
    return true;
  }
  Eigen::VectorXd middle = space.half_way(from, to);
  if (!space.project(middle)) return false;
  const double longer = std::max(space.distance(from, middle), space.distance(middle, to));
  return longer <= kMostBentMiddle * apart && space.valid(middle, swinging) &&
         append_joined(space, way, middle, swinging) && append_joined(space, way, to, swinging);
}

}  // namespace

bool join(SegmentSpace& space, std::vector<Eigen::VectorXd>& way, const Eigen::VectorXd& to,
          bool swinging) {
  const std::size_t before = way.size();
  if (append_joined(space, way, to, swinging)) return true;
  way.resize(before);
  return false;
}

double way_length(const SegmentSpace& space, const std::vector<Eigen::VectorXd>& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += space.distance(way[i - 1], way[i]);
  return length;
}

void shorten(SegmentSpace& space, std::vector<Eigen::VectorXd>& way, int attempts,
             std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (int attempt = 0; attempt < attempts && way.size() > 2; ++attempt) {
    std::size_t first = 0, last = way.size() - 1;
    if (attempt > 0) {
      const double end = static_cast<double>(way.size());
      const auto draw = [&] {
        return std::min(static_cast<std::size_t>(uniform(random, 0.0, end)), way.size() - 1);
      };
      first = draw();
      last = draw();
      if (first > last) std::swap(first, last);
      if (last - first < 2) continue;
    }
    const auto begin = way.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = way.begin() + static_cast<std::ptrdiff_t>(last) + 1;
    const double length = way_length(space, {begin, end});
    if (space.distance(*begin, *(end - 1)) > length - kLeastGain) continue;
    std::vector<Eigen::VectorXd> straight = {*begin};
    if (!join(space, straight, *(end - 1))) continue;
    if (way_length(space, straight) > length - kLeastGain) continue;
    std::vector<Eigen::VectorXd> shorter(way.begin(), begin);
    shorter.insert(shorter.end(), straight.begin(), straight.end());
    shorter.insert(shorter.end(), end, way.end());
    way = std::move(shorter);
  }
}

}  // namespace locograph
