#include <dlfcn.h>
#include <locograph/core/plugin.h>
#include <locograph/core/plugin_library.h>

#include <algorithm>
#include <cstring>
#include <memory>

namespace locograph {
namespace {

std::string value_text(const PluginAbiField& field) {
  return field.text != nullptr ? field.text : std::to_string(field.number);
}

std::string last_error() {
  const char* text = dlerror();
  return text == nullptr ? "unknown reason" : text;
}

/// Closes the library unless it was kept.
using Handle = std::unique_ptr<void, int (*)(void*)>;

Handle open(const std::filesystem::path& library, int mode) {
  const std::string path = std::filesystem::absolute(library).string();
  Handle handle(dlopen(path.c_str(), RTLD_LOCAL | mode), &dlclose);
  if (!handle) {
    throw Error(library.string(), 0, "cannot be loaded: " + last_error(),
                "a shared library with a locograph plug-in");
  }
  return handle;
}

void register_types(const std::filesystem::path& library, const PluginRecord& record,
                    TypeRegistry& types) {
  // Into a copy: a library that fails half-way leaves nothing behind.
  TypeRegistry extended = types;
  try {
    record.register_types(extended);
  } catch (const Error& error) {
    throw Error(library.string(), 0, error.what(), "");
  } catch (const std::exception& error) {
    throw Error(library.string(), 0, std::string("failed to register its types: ") + error.what(),
                "");
  } catch (...) {
    throw Error(library.string(), 0, "failed to register its types",
                "exceptions derived from std::exception, if any");
  }
  types = std::move(extended);
}

}  // namespace

std::vector<std::string> abi_differences(const PluginRecord& theirs) {
  if (std::memcmp(theirs.magic, kPluginMagic, sizeof kPluginMagic) != 0) {
    return {"its record is not one of a locograph plug-in"};
  }
  if (theirs.abi_version != kPluginAbiVersion) {
    return {"plug-in ABI version " + std::to_string(theirs.abi_version) + " instead of " +
            std::to_string(kPluginAbiVersion)};
  }
  const PluginRecord ours = plugin_record(nullptr);
  std::vector<std::string> differences;
  for (std::uint32_t i = 0; i < ours.field_count; ++i) {
    const PluginAbiField& mine = ours.fields[i];
    const PluginAbiField* end = theirs.fields + theirs.field_count;
    const PluginAbiField* found = std::find_if(
        theirs.fields, end,
        [&mine](const PluginAbiField& field) { return std::strcmp(field.name, mine.name) == 0; });
    const std::string expected = value_text(mine);
    const std::string value = found == end ? "nothing" : value_text(*found);
    if (value != expected) {
      differences.push_back(std::string(mine.name) + " " + value + " instead of " + expected);
    }
  }
  if (differences.empty() && theirs.register_types == nullptr) {
    differences.push_back("it has no function that registers types");
  }
  return differences;
}

void load_plugin(const std::filesystem::path& library, TypeRegistry& types) {
  std::error_code ignored;  // as of names longer than paths may be
  if (!std::filesystem::is_regular_file(library, ignored)) {
    throw Error(library.string(), 0,
                std::filesystem::exists(library, ignored) ? "is not a file" : "does not exist",
                "a shared library with a locograph plug-in");
  }
  // Lazily: a library built differently may miss symbols, but its record says more than that.
  Handle handle = open(library, RTLD_LAZY);
  using EntryPoint = const PluginRecord* (*)();
  const auto entry = reinterpret_cast<EntryPoint>(dlsym(handle.get(), kPluginEntryPoint));
  if (entry == nullptr) {
    throw Error(library.string(), 0, std::string("has no entry point '") + kPluginEntryPoint + "'",
                "LOCOGRAPH_PLUGIN(…) in one of its sources");
  }
  const PluginRecord* record = entry();
  if (record == nullptr) throw Error(library.string(), 0, "has no record", "LOCOGRAPH_PLUGIN(…)");
  const std::vector<std::string> differences = abi_differences(*record);
  if (!differences.empty()) {
    std::string text;
    for (const std::string& one : differences) text += (text.empty() ? "" : "; ") + one;
    throw Error(library.string(), 0, "was not built for this program: " + text,
                "a plug-in built with the same locograph, compiler and Eigen");
  }
  handle.reset();
  handle = open(library, RTLD_NOW | RTLD_NODELETE);
  record = reinterpret_cast<EntryPoint>(dlsym(handle.get(), kPluginEntryPoint))();
  register_types(library, *record, types);
}

std::filesystem::path find_plugin(const std::string& name,
                                  const std::vector<std::filesystem::path>& folders) {
  std::error_code ignored;
  if (std::filesystem::exists(name, ignored) || name.find('/') != std::string::npos) return name;
  std::string places;
  for (const std::filesystem::path& folder : folders) {
    for (const std::string& file : {name, name + ".so", "lib" + name + ".so"}) {
      if (std::filesystem::is_regular_file(folder / file, ignored)) return folder / file;
    }
    places += (places.empty() ? "" : ", ") + folder.string();
  }
  throw Error("plug-in '" + name + "' is not to be found",
              places.empty() ? "a path" : "a path, or the name of a library in " + places);
}

}  // namespace locograph
