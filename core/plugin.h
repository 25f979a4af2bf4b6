#pragma once
/// What a plug-in library includes: one macro that makes it loadable by load_plugin().
///
///     void register_types(locograph::TypeRegistry& types) {
///       types.add_edge<EdgeRange>();
///     }
///     LOCOGRAPH_PLUGIN(register_types)
///
/// Build it with locograph_add_plugin() of the CMake package (doc/custom_types.md). The macro
/// exports the library's only entry point, `extern "C" locograph_plugin`. It returns a record in
/// plain C that says how the library was compiled; load_plugin() compares it with its own before
/// anything of C++ crosses the boundary.

#include <locograph/core/graph.h>
#include <locograph/core/type_registry.h>

#include <cstdint>

#if !defined(LOCOGRAPH_VERSION) || !defined(LOCOGRAPH_HEADERS)
#error "build plug-ins by locograph_add_plugin() of the CMake package"
#endif

namespace locograph {

/// Raised when PluginRecord changes; everything else that may differ is one of its fields.
inline constexpr std::uint32_t kPluginAbiVersion = 1;
inline constexpr char kPluginMagic[8] = {'L', 'O', 'C', 'O', 'P', 'L', 'U', 'G'};
inline constexpr const char* kPluginEntryPoint = "locograph_plugin";

/// One property of a build. Text, or a number where text is null.
struct PluginAbiField {
  const char* name;
  const char* text;
  long long number;
};

/// What the entry point returns. The first two members never change.
struct PluginRecord {
  char magic[8];
  std::uint32_t abi_version;
  std::uint32_t field_count;
  const PluginAbiField* fields;
  void (*register_types)(TypeRegistry&);
};

#define LOCOGRAPH_TEXT(x) LOCOGRAPH_TEXT_OF(x)
#define LOCOGRAPH_TEXT_OF(x) #x
#if defined(__clang__)
#define LOCOGRAPH_COMPILER "Clang " LOCOGRAPH_TEXT(__clang_major__)
#elif defined(__GNUC__)
#define LOCOGRAPH_COMPILER "GCC " LOCOGRAPH_TEXT(__GNUC__)
#else
#define LOCOGRAPH_COMPILER "unknown"
#endif
#if defined(_GLIBCXX_RELEASE)
#define LOCOGRAPH_STANDARD_LIBRARY "libstdc++ " LOCOGRAPH_TEXT(_GLIBCXX_RELEASE)
#define LOCOGRAPH_STRING_ABI _GLIBCXX_USE_CXX11_ABI
#else
#define LOCOGRAPH_STANDARD_LIBRARY "unknown"
#define LOCOGRAPH_STRING_ABI 0
#endif
#if defined(_GLIBCXX_DEBUG)
#define LOCOGRAPH_DEBUG_CONTAINERS 1
#else
#define LOCOGRAPH_DEBUG_CONTAINERS 0
#endif
#if defined(EIGEN_DEFAULT_TO_ROW_MAJOR)
#define LOCOGRAPH_ROW_MAJOR 1
#else
#define LOCOGRAPH_ROW_MAJOR 0
#endif

/// How the including file is compiled. Internal linkage: each side must see its own.
static constexpr PluginAbiField kPluginAbi[] = {
    {"locograph version", LOCOGRAPH_VERSION, 0},
    {"hash of the headers", LOCOGRAPH_HEADERS, 0},
    {"compiler", LOCOGRAPH_COMPILER, 0},
    {"standard library", LOCOGRAPH_STANDARD_LIBRARY, 0},
    {"_GLIBCXX_USE_CXX11_ABI", nullptr, LOCOGRAPH_STRING_ABI},
    {"_GLIBCXX_DEBUG", nullptr, LOCOGRAPH_DEBUG_CONTAINERS},
    {"Eigen version",
     LOCOGRAPH_TEXT(EIGEN_WORLD_VERSION) "." LOCOGRAPH_TEXT(EIGEN_MAJOR_VERSION) "." LOCOGRAPH_TEXT(
         EIGEN_MINOR_VERSION),
     0},
    {"EIGEN_MAX_ALIGN_BYTES", nullptr, EIGEN_MAX_ALIGN_BYTES},
    {"EIGEN_MAX_STATIC_ALIGN_BYTES", nullptr, EIGEN_MAX_STATIC_ALIGN_BYTES},
    {"EIGEN_DEFAULT_TO_ROW_MAJOR", nullptr, LOCOGRAPH_ROW_MAJOR},
    {"dual numbers of ceres/jet.h", nullptr, LOCOGRAPH_HAS_DUAL},
    {"sizeof(void*)", nullptr, sizeof(void*)},
    {"sizeof(Eigen::Index)", nullptr, sizeof(Eigen::Index)},
    {"sizeof(Error)", nullptr, sizeof(Error)},
    {"sizeof(FieldReader)", nullptr, sizeof(FieldReader)},
    {"sizeof(FieldWriter)", nullptr, sizeof(FieldWriter)},
    {"sizeof(Parameters)", nullptr, sizeof(Parameters)},
    {"sizeof(RobustKernel)", nullptr, sizeof(RobustKernel)},
    {"sizeof(Scratch)", nullptr, sizeof(Scratch)},
    {"sizeof(Evaluation)", nullptr, sizeof(Evaluation)},
    {"sizeof(CompiledEdges)", nullptr, sizeof(CompiledEdges)},
    {"sizeof(CompiledEdges::Slot)", nullptr, sizeof(CompiledEdges::Slot)},
    {"sizeof(ActiveVertex)", nullptr, sizeof(ActiveVertex)},
    {"sizeof(EdgeData<6>)", nullptr, sizeof(detail::EdgeData<6>)},
    {"sizeof(WeightedEdgeData<6>)", nullptr, sizeof(detail::WeightedEdgeData<6>)},
    {"sizeof(EdgePool)", nullptr, sizeof(EdgePool)},
    {"sizeof(VertexPool)", nullptr, sizeof(VertexPool)},
    {"sizeof(Graph)", nullptr, sizeof(Graph)},
    {"sizeof(TypeRegistry)", nullptr, sizeof(TypeRegistry)},
};

/// The record of the including file.
[[maybe_unused]] static constexpr PluginRecord plugin_record(
    void (*register_types)(TypeRegistry&)) {
  PluginRecord record{};
  for (int i = 0; i < 8; ++i) record.magic[i] = kPluginMagic[i];
  record.abi_version = kPluginAbiVersion;
  record.field_count = sizeof kPluginAbi / sizeof kPluginAbi[0];
  record.fields = kPluginAbi;
  record.register_types = register_types;
  return record;
}

/// Makes a library a plug-in; once in each library, outside of any namespace. REGISTER is a
/// void(locograph::TypeRegistry&); what it throws becomes an Error of load_plugin().
#define LOCOGRAPH_PLUGIN(REGISTER)                                                         \
  extern "C" __attribute__((visibility("default"))) const locograph::PluginRecord*         \
  locograph_plugin() {                                                                     \
    static constexpr locograph::PluginRecord record = locograph::plugin_record(&REGISTER); \
    return &record;                                                                        \
  }

}  // namespace locograph
