#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/core/plugin.h>
#include <locograph/core/plugin_library.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/standard_types.h>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

std::filesystem::path plugin(const std::string& name) {
  return std::filesystem::path(LOCOGRAPH_TEST_PLUGINS) / (name + ".so");
}

TypeRegistry types_with_toys() {
  TypeRegistry types = standard_types();
  load_plugin(plugin("toy_plugin"), types);
  return types;
}

/// A robot at (1, 2) that measures ranges in feet, all of them 0.25 m too long.
const char* const kToyGraph = R"(PARAMS_TOY_UNIT 3 0.3048
VERTEX_SE2 0 0.5 0.5 0.1
VERTEX_XY 1 4 0
VERTEX_XY 2 0 5
VERTEX_XY 3 -3 -1
VERTEX_XY 4 7 7
FIX 1 2 3 4
VERTEX_TOY_BIAS 9 0
EDGE_PRIOR_SE2 0 0 0 0.3 0 0 0 0 0 100
EDGE_TOY_RANGE 0 1 9 3 12.649446441810987 1
EDGE_TOY_RANGE 0 2 9 3 11.195136680342452 1
EDGE_TOY_RANGE 0 3 9 3 17.224409448818896 1
EDGE_TOY_RANGE 0 4 9 3 26.44438870048115 1
)";

Graph read(const std::string& text, const TypeRegistry& types) {
  return read_graph_text(text, "toy.g2o", {}, types);
}

std::string refusal(const std::filesystem::path& library) {
  TypeRegistry types = standard_types();
  const std::vector<std::string> before = types.tags();
  try {
    load_plugin(library, types);
  } catch (const Error& error) {
    EXPECT_EQ(types.tags(), before);
    EXPECT_EQ(error.file(), library.string());
    return error.what();
  }
  ADD_FAILURE() << "accepted: " << library;
  return "";
}

TEST(Plugin, AddsItsTypesToTheRegistryOnly) {
  const TypeRegistry types = types_with_toys();
  EXPECT_NE(types.vertex_type("VERTEX_TOY_BIAS"), nullptr);
  EXPECT_NE(types.edge_type("EDGE_TOY_RANGE"), nullptr);
  EXPECT_NE(types.parameter_type("PARAMS_TOY_UNIT"), nullptr);
  EXPECT_EQ(standard_types().edge_type("EDGE_TOY_RANGE"), nullptr);
}

TEST(Plugin, TakesPartInAGraphWithStandardTypesLoadedOptimisedAndSaved) {
  // The registry is gone when the graph is used: the library is not.
  Graph graph = read(kToyGraph, types_with_toys());
  const OptimiserResult result = optimise(graph, {}, *make_linear_solver("auto"));
  EXPECT_TRUE(result.converged);
  const SE2<double> pose = graph.vertex(graph.find<VertexSE2>(0)).pose();
  EXPECT_NEAR(pose.translation().x(), 1.0, 1e-6);
  EXPECT_NEAR(pose.translation().y(), 2.0, 1e-6);
  EXPECT_NEAR(graph.state(graph.slot_of(9))[0], 0.25, 1e-6);
  const std::string saved = write_graph_text(graph);
  EXPECT_EQ(write_graph_text(read(saved, types_with_toys())), saved);
}

TEST(Plugin, SharesVertexPoolsWithTheProgramWhicheverMadeThem) {
  // Without any vertex line the plug-in's edges make the vertices.
  Graph graph = read("PARAMS_TOY_UNIT 3 1\nEDGE_TOY_RANGE 0 1 9 3 2.5 1\n", types_with_toys());
  const VertexId<VertexSE2> robot = graph.find<VertexSE2>(0);
  const VertexId<VertexXY> point = graph.find<VertexXY>(1);
  EdgeSE2XY edge;
  edge.measurement = {1.5, 2.0};
  graph.add_edge(edge, robot, point);
  graph.add_edge(EdgePriorSE2(), robot);
  graph.vertex(point).state = Eigen::Vector2d(1.0, 1.0);
  graph.set_fixed(graph.add_vertex(7, VertexXY({1.0, 1.0})), true);
  EXPECT_EQ(graph.vertices_of<VertexXY>().size(), 2u);
  EXPECT_EQ(graph.vertex_pools().size(), 3u);
  const OptimiserResult result = optimise(graph, {}, *make_linear_solver("auto"));
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(graph.vertex(point).state.x(), 1.5, 1e-6);
}

TEST(Plugin, ThrowsErrorsThatTheProgramCatches) {
  const TypeRegistry types = types_with_toys();
  const auto line_of = [&types](const std::string& text) {
    try {
      read(text, types);
    } catch (const Error& error) {
      return error.line();
    }
    return -1;
  };
  EXPECT_EQ(line_of("\nPARAMS_TOY_UNIT 3 -1\n"), 2);
  EXPECT_EQ(line_of("VERTEX_TOY_BIAS 3 x\n"), 1);
  // bind() looks up a parameter that is missing, and one of a type of the program's.
  std::string other = kToyGraph;
  other.replace(0, other.find('\n'), "PARAMS_SE2OFFSET 3 0 0 0");
  EXPECT_EQ(line_of(other), 10);
  EXPECT_EQ(line_of(kToyGraph + std::string("EDGE_TOY_RANGE 0 4 9 5 1 1\n")), 14);
  EXPECT_EQ(line_of(kToyGraph), -1);
}

TEST(Plugin, LoadedTwiceIsADuplicateTagNamedWithItsLibrary) {
  TypeRegistry types = types_with_toys();
  const std::vector<std::string> before = types.tags();
  try {
    load_plugin(plugin("toy_plugin"), types);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), plugin("toy_plugin").string());
    EXPECT_NE(std::string(error.what()).find("PARAMS_TOY_UNIT is registered twice"),
              std::string::npos)
        << error.what();
  }
  EXPECT_EQ(types.tags(), before);
}

TEST(Plugin, ThatFailsWhileItRegistersLeavesNothingBehind) {
  EXPECT_NE(refusal(plugin("failing_plugin")).find("the moon is in the wrong phase"),
            std::string::npos);
}

TEST(Plugin, BuiltWithOtherAlignmentIsRefusedAndTheDifferencesNamed) {
  const std::string text = refusal(plugin("other_build_plugin"));
  EXPECT_NE(text.find("EIGEN_MAX_ALIGN_BYTES 16 instead of 64; EIGEN_MAX_STATIC_ALIGN_BYTES 16"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("compiler GCC"), std::string::npos) << text;
}

TEST(Plugin, WithoutAProperRecordIsRefused) {
  EXPECT_NE(refusal(plugin("no_entry_point")).find("no entry point 'locograph_plugin'"),
            std::string::npos);
  EXPECT_NE(refusal(plugin("foreign_record")).find("not one of a locograph plug-in"),
            std::string::npos);
  EXPECT_NE(refusal(plugin("other_abi_version")).find("ABI version 77 instead of 1"),
            std::string::npos);
}

TEST(Plugin, ThatIsNoSharedLibraryIsRefused) {
  EXPECT_NE(refusal("/nowhere/missing.so").find("does not exist"), std::string::npos);
  EXPECT_NE(refusal("/tmp").find("is not a file"), std::string::npos);
  const test::TemporaryFolder folder;
  EXPECT_NE(refusal(folder.write("text.so", "not an ELF file\n")).find("cannot be loaded"),
            std::string::npos);
}

TEST(Plugin, RecordIsComparedFieldByField) {
  const PluginRecord ours = plugin_record([](TypeRegistry&) {});
  EXPECT_TRUE(abi_differences(ours).empty());
  std::vector<PluginAbiField> fields(ours.fields, ours.fields + ours.field_count);
  PluginRecord theirs = ours;
  theirs.fields = fields.data();
  for (PluginAbiField& field : fields) {
    const PluginAbiField good = field;
    if (good.text != nullptr) {
      field.text = "3.1";
    } else {
      field.number += 1;
    }
    std::vector<std::string> differences = abi_differences(theirs);
    ASSERT_EQ(differences.size(), 1u) << good.name;
    EXPECT_EQ(differences[0].find(good.name), 0u) << differences[0];
    field = good;
    field.name = "something else";
    differences = abi_differences(theirs);
    ASSERT_EQ(differences.size(), 1u) << good.name;
    EXPECT_NE(differences[0].find("nothing instead of"), std::string::npos) << differences[0];
    field = good;
  }
  theirs.register_types = nullptr;
  EXPECT_EQ(abi_differences(theirs).size(), 1u);
}

TEST(Plugin, IsFoundByNameInTheFoldersGiven) {
  const std::vector<std::filesystem::path> folders = {"/nowhere", LOCOGRAPH_TEST_PLUGINS};
  EXPECT_EQ(find_plugin("toy_plugin", folders), plugin("toy_plugin"));
  EXPECT_EQ(find_plugin("toy_plugin.so", folders), plugin("toy_plugin"));
  EXPECT_EQ(find_plugin("./toy_plugin.so", folders), "./toy_plugin.so");
  try {
    find_plugin("toys", folders);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere, " LOCOGRAPH_TEST_PLUGINS),
              std::string::npos);
  }
}

TEST(TypeRegistry, RefusesTwoClassesOfOneNameUnderDifferentTags) {
  // As two libraries may bring them: pools could not tell them apart.
  TypeRegistry types;
  types.add_edge<EdgeSE2>();
  EXPECT_THROW(types.add_edge<EdgeSE2>(), Error);
  EXPECT_THROW(types.add_edge_alias<EdgeSE2XY>("OTHER"), Error);
  EXPECT_NO_THROW(types.add_edge_alias<EdgeSE2>("OTHER"));
}

}  // namespace
}  // namespace locograph
