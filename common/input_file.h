#pragma once
/// Reads a file whole, with a bound on its size: the one way in for every parser.
///
///     const std::string text = read_file("robot.urdf", 64 << 20, "a robot description (URDF)");
///     const std::string graph = read_input("-", kMostInputBytes, "a graph");  // standard input
///
/// A file that is no regular one is refused without being read: a named pipe that nobody writes
/// to would never end, a device would fill the memory. Errors name the file, what it is, and what
/// was expected.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace locograph {

/// A bound that public data sets stay far below.
constexpr std::uintmax_t kMostInputBytes = std::uintmax_t{2} << 30;

/// The content of a regular file, links followed. expected: what the file should be, for errors,
/// "an OctoMap file". Throws Error when the file cannot be opened, is no regular file, or has more
/// than max_bytes.
std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes = kMostInputBytes,
                      std::string_view expected = "a file");

/// As read_file(), also from a pipe: `-` is standard input, whatever it is; other paths may be
/// pipes, as /dev/stdin and the shell's <(command) are. Waits for who writes to the pipe; one that
/// nobody has open for writing is empty.
std::string read_input(const std::filesystem::path& path,
                       std::uintmax_t max_bytes = kMostInputBytes,
                       std::string_view expected = "a file");

/// The first max_bytes of a regular file, or all of a shorter one: enough to tell what it is.
std::string file_beginning(const std::filesystem::path& path, std::size_t max_bytes,
                           std::string_view expected = "a file");

/// What errno says, in the middle of a sentence: "no space left on device".
std::string errno_text(int error);

}  // namespace locograph
