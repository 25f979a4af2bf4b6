#include <locograph/common/check_option.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/camera_noise.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

/// G. Steele, D. Lea and C. Flood, "Fast splittable pseudorandom number generators", 2014.
std::uint64_t mixed(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ull;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebull;
  return bits ^ (bits >> 31);
}

/// The number `counter` of a stream of random numbers.
std::uint64_t drawn(std::uint64_t stream, std::uint64_t counter) {
  return mixed(stream + 0x9e3779b97f4a7c15ull * (counter + 1));
}

/// 16 of the bits, in [0, 1).
double share(std::uint64_t bits, int which) {
  return 0x1.0p-16 * static_cast<double>(bits >> (16 * which) & 0xffff);
}

/// About normal, variance 1: four even numbers in [0, 1) have a sum of mean 2 and variance 1/3.
double about_normal(std::uint64_t bits) {
  const double sum = share(bits, 0) + share(bits, 1) + share(bits, 2) + share(bits, 3);
  return std::sqrt(3.0) * (sum + 2.0 * 0x1.0p-16 - 2.0);
}

constexpr int kSquare = 8;

bool is_share(double value) { return value >= 0.0 && value <= 1.0; }

}  // namespace

CameraNoise CameraNoise::none() {
  return {.at_zero_m = 0.0,
          .per_m2 = 0.0,
          .lost = 0.0,
          .lost_squares = 0.0,
          .edge = 0.05,
          .flying_at_edge = 0.0,
          .lost_at_edge = 0.0,
          .baseline_m = 0.0};
}

void CameraNoise::validate() const {
  const auto is_size = [](double value) { return value >= 0.0 && std::isfinite(value); };
  check_option(is_size(at_zero_m), "at_zero_m", "metres, 0 or more");
  check_option(is_size(per_m2), "per_m2", "a number, 0 or more");
  check_option(is_share(lost), "lost", "0 to 1");
  check_option(is_share(lost_squares), "lost_squares", "0 to 1");
  check_option(edge > 0.0 && std::isfinite(edge), "edge", "a positive number");
  check_option(is_share(flying_at_edge), "flying_at_edge", "0 to 1");
  check_option(is_share(lost_at_edge), "lost_at_edge", "0 to 1");
  check_option(flying_at_edge + lost_at_edge <= 1.0, "flying_at_edge", "1 with lost_at_edge");
  check_option(is_size(baseline_m), "baseline_m", "metres, 0 or more");
}

void add_noise(const CameraNoise& noise, const DepthCamera& camera, std::uint64_t seed,
               std::span<const float> depth_m, DepthImage& image) {
  const int width = camera.width, height = camera.height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (depth_m.size() != pixels)
    throw Error(std::to_string(depth_m.size()) + " depths",
                std::to_string(width) + " x " + std::to_string(height));
  image.width = width;
  image.height = height;
  image.depth_mm.resize(pixels);
  const std::uint64_t of_pixels = mixed(seed ^ 1), of_edges = mixed(seed ^ 2),
                      of_squares = mixed(seed ^ 3), of_losses = mixed(seed ^ 4);
  const double disparity = camera.fx * noise.baseline_m;  // times depth, pixels
  const bool has_edges = noise.flying_at_edge + noise.lost_at_edge > 0.0;
  const int squares = (width + kSquare - 1) / kSquare;
  for (int v = 0; v < height; ++v) {
    const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(width);
    double hidden_from = std::numeric_limits<double>::infinity();  // in the second image
    for (int u = width - 1; u >= 0; --u) {
      const std::size_t at = row + static_cast<std::size_t>(u);
      image.depth_mm[at] = 0;
      const double met = depth_m[at];
      if (!std::isfinite(met)) continue;
      if (disparity > 0.0) {
        const double second = u - disparity / met;
        if (second >= hidden_from || second < -0.5) continue;
        hidden_from = second;
      }
      if (share(drawn(of_losses, at), 0) < noise.lost) continue;
      const std::uint64_t square =
          static_cast<std::uint64_t>(v / kSquare) * static_cast<std::uint64_t>(squares) +
          static_cast<std::uint64_t>(u / kSquare);
      if (share(drawn(of_squares, square), 0) < noise.lost_squares) continue;
      double seen = met;
      if (has_edges) {
        // The neighbour whose depth is most unlike, as a ratio.
        double other = met, unlike = 1.0 + noise.edge;
        const auto look = [&](bool inside, std::size_t neighbour) {
          if (!inside) return;
          const double its = depth_m[neighbour];
          const double ratio = its > met ? its / met : met / its;
          if (!(ratio > unlike)) return;
          unlike = ratio;
          other = its;
        };
        const std::size_t below = static_cast<std::size_t>(width);
        look(u > 0, at - 1);
        look(u + 1 < width, at + 1);
        look(v > 0, at - below);
        look(v + 1 < height, at + below);
        if (other != met) {
          const std::uint64_t bits = drawn(of_edges, at);
          const double fate = share(bits, 0);
          if (fate < noise.lost_at_edge) continue;
          if (fate < noise.lost_at_edge + noise.flying_at_edge) {
            const double part = share(bits, 1);
            seen = 1.0 / ((1.0 - part) / met + part / other);
          }
        }
      }
      seen += (noise.at_zero_m + noise.per_m2 * seen * seen) * about_normal(drawn(of_pixels, at));
      if (seen < camera.range_min_m || seen > camera.range_max_m) continue;
      image.depth_mm[at] = static_cast<std::uint16_t>(std::min(1000.0 * seen + 0.5, 65535.0));
    }
  }
}

std::uint64_t noise_seed(std::uint64_t seed, int camera, double time_s) {
  const std::uint64_t of_camera = drawn(mixed(seed), static_cast<std::uint64_t>(camera));
  return drawn(of_camera, std::bit_cast<std::uint64_t>(time_s + 0.0));
}

}  // namespace locograph
