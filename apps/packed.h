#pragma once
/// Arrays of numbers as base64 text, the way a scene carries them (doc/scene_format.md).
///
///     json["triangles"] = packed_floats({0.0f, 1.0f, 0.5f});
///     json["edges"] = packed_ints({0, 1, 1, 2});
///
/// Little-endian.

#include <cstdint>
#include <string>
#include <vector>

namespace locograph {

std::string packed_floats(const std::vector<float>& values);
std::string packed_ints(const std::vector<std::int32_t>& values);
std::string packed_shorts(const std::vector<std::int16_t>& values);
std::string packed_bytes(const std::vector<std::uint8_t>& values);

}  // namespace locograph
