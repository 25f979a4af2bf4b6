#pragma once
/// Writes a file whole or not at all: the one way out for everything that is saved.
///
///     check_output_path("plan.g2o");              // before a long job
///     write_file_atomically("plan.g2o", text);
///
/// The text goes to a temporary file beside the target and to the disk, then takes the target's
/// place: whenever the program is ended, by kill -9 or a power failure too, the target has its old
/// bytes or the new ones. A link stays, what it leads to is replaced; mode and, as far as the
/// program may, owner of the replaced file are kept. What is no regular file is written into: a
/// device (/dev/null), a pipe, an open file of this program (/dev/stdout); `-` is standard output.
///
/// A temporary file is called `.NAME.locograph-XXXXXX` and is locked while it is written; the next
/// write to NAME removes those that nobody holds a lock on any more. Of several writers the last
/// one wins.

#include <filesystem>
#include <string_view>

namespace locograph {

/// Throws Error with the reason of the system when that is not possible; then the target is as
/// before, unless it is no regular file.
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

/// Throws Error when a file could not be written at this path, as far as that can be told without
/// writing it: it is a folder, its folder is missing, or there is no permission.
void check_output_path(const std::filesystem::path& path);

/// Whether the path is `-`, /dev/stdout or another name of standard output.
bool is_standard_output(const std::filesystem::path& path);

/// The folder that paths in the file are best given relative to: where the file really is, links
/// followed; "" for what has no place of its own, as a pipe.
std::filesystem::path folder_of_output(const std::filesystem::path& path);

/// All of the text to an open file. name: for errors. Throws Error.
void write_to_descriptor(int descriptor, std::string_view text, const std::string& name);

}  // namespace locograph
