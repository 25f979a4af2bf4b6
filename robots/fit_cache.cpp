#include <locograph/common/atomic_file.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/robots/fit_cache.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <sstream>

namespace locograph {
namespace {

constexpr std::uint64_t kMethod = 1;  // of fitting: to be changed with it
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 20;

/// Two sums of 64 bits each, by SplitMix64's finaliser.
struct Key {
  std::uint64_t first = 0x243f6a8885a308d3, second = 0x13198a2e03707344;

  void add(std::uint64_t value) {
    const auto mixed = [](std::uint64_t x) {
      x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
      x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
      return x ^ (x >> 31);
    };
    first = mixed(first ^ value);
    second = mixed(std::rotl(second, 23) + value);
  }
};

Key key_of(const std::vector<Eigen::Vector3d>& corners, const MeshFitOptions& options) {
  Key key;
  key.add(kMethod);
  key.add(std::bit_cast<std::uint64_t>(options.max_overshoot_m));
  key.add(static_cast<std::uint64_t>(options.max_shapes));
  key.add(options.spheres ? 1 : 0);
  key.add(corners.size());
  for (const Eigen::Vector3d& corner : corners) {
    for (int i = 0; i < 3; ++i) key.add(std::bit_cast<std::uint64_t>(corner[i]));
  }
  return key;
}

std::filesystem::path cache_folder() {
  if (const char* told = std::getenv("LOCOGRAPH_CACHE")) return told;
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0') {
    return std::filesystem::path(cache) / "locograph";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    return std::filesystem::path(home) / ".cache" / "locograph";
  }
  return {};
}

/// Empty: no cache.
std::filesystem::path file_of(const Key& key) {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty()) return {};
  char name[48];
  std::snprintf(name, sizeof name, "%016llx%016llx.fit", static_cast<unsigned long long>(key.first),
                static_cast<unsigned long long>(key.second));
  return folder / name;
}

}  // namespace

std::optional<std::vector<Capsule>> cached_fit(const std::vector<Eigen::Vector3d>& corners,
                                               const MeshFitOptions& options) {
  const std::filesystem::path file = file_of(key_of(corners, options));
  std::error_code ignored;
  if (file.empty() || !std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  try {
    std::istringstream text(read_file(file, kMostBytes, "a cached fit"));
    text.imbue(std::locale::classic());
    std::size_t count = 0;
    if (!(text >> count) || count == 0 || count > 100000) return std::nullopt;
    std::vector<Capsule> capsules(count);
    for (Capsule& capsule : capsules) {
      std::uint64_t bits[7];
      for (std::uint64_t& number : bits) {
        if (!(text >> std::hex >> number)) return std::nullopt;
      }
      for (int i = 0; i < 3; ++i) {
        capsule.from[i] = std::bit_cast<double>(bits[i]);
        capsule.to[i] = std::bit_cast<double>(bits[3 + i]);
      }
      capsule.radius = std::bit_cast<double>(bits[6]);
      const bool sound =
          capsule.from.allFinite() && capsule.to.allFinite() && std::isfinite(capsule.radius);
      if (!sound || capsule.radius < 0.0) return std::nullopt;
    }
    std::string end;
    if (!(text >> end) || end != "end") return std::nullopt;
    return capsules;
  } catch (const Error&) {
    return std::nullopt;
  }
}

void cache_fit(const std::vector<Eigen::Vector3d>& corners, const MeshFitOptions& options,
               const std::vector<Capsule>& capsules) {
  const std::filesystem::path file = file_of(key_of(corners, options));
  if (file.empty()) return;
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << capsules.size() << '\n' << std::hex;
  for (const Capsule& capsule : capsules) {
    for (const Eigen::Vector3d& end : {capsule.from, capsule.to}) {
      for (int i = 0; i < 3; ++i) text << std::bit_cast<std::uint64_t>(end[i]) << ' ';
    }
    text << std::bit_cast<std::uint64_t>(capsule.radius) << '\n';
  }
  text << "end\n";
  try {
    std::error_code failed;
    std::filesystem::create_directories(file.parent_path(), failed);
    if (!failed) write_file_atomically(file, text.str());
  } catch (const Error&) {
  }
}

}  // namespace locograph
