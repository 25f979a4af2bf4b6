#pragma once
/// Paths in the lines of a graph file: relative to it; `-` stands for none. A graph without a place
/// of its own, as one in a pipe, has absolute paths.
///
///     map = read_path(in);
///     write_path(out, map);

#include <locograph/core/fields.h>

#include <filesystem>

namespace locograph {

inline std::filesystem::path read_path(FieldReader& in) {
  const std::string word = in.word();
  if (word == "-") return {};
  const std::filesystem::path path(word);
  return path.is_absolute() ? path : in.where().folder / path;
}

/// The path as seen from the file being written.
inline std::string relative_to_file(const FieldWriter& out, const std::filesystem::path& path) {
  const std::filesystem::path absolute = std::filesystem::absolute(path);
  if (out.folder().empty()) return std::filesystem::weakly_canonical(absolute).generic_string();
  return std::filesystem::proximate(absolute, std::filesystem::absolute(out.folder()))
      .generic_string();
}

inline void write_path(FieldWriter& out, const std::filesystem::path& path) {
  out.word(path.empty() ? "-" : relative_to_file(out, path));
}

}  // namespace locograph
