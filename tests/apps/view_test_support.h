#pragma once
/// What the tests of `locograph view` share: a planned drive, and what is inside a page.
///
///     TEST_F(ViewPlan, HasFiftyConfigurations) {
///       EXPECT_EQ(view(runner, "p.g2o")["plan"]["times"].size(), 50u);
///     }

#include <apps/command_runner.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace locograph {

inline const char kBox[] =
    "<obstacles version=\"1\">\n"
    "  <box name=\"box\" center=\"2 1.2 0.25\" size=\"0.4 0.4 0.5\"/>\n"
    "  <cylinder name=\"roller\" center=\"3 -2 0.3\" radius=\"0.2\" height=\"0.6\" repeat=\"9\">\n"
    "    <keyframe time=\"4\" position=\"3 2 0.3\"/>\n"
    "  </cylinder>\n"
    "</obstacles>\n";

inline std::filesystem::path viewer_template() {
  return std::filesystem::path(LOCOGRAPH_COMMAND).parent_path().parent_path() /
         "share/locograph/viewer/template.html";
}

#define LOCOGRAPH_NEEDS_VIEWER()                                               \
  if (!std::filesystem::is_regular_file(viewer_template())) {                  \
    GTEST_SKIP() << "the viewer is not built: " << viewer_template().string(); \
  }

/// The scene inside a page; throws unless it is JSON.
inline nlohmann::json scene_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"locograph-scene\">";
  const std::size_t at = page.find(begin);
  if (at == std::string::npos) throw std::runtime_error("no scene in the page");
  const std::size_t from = at + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

inline nlohmann::json view(const CommandRunner& runner, const std::string& arguments) {
  const Outcome outcome = runner.run("view " + arguments + " -o page.html");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return scene_of(runner.read("page.html"));
}

inline std::string bytes_of(const std::string& base64) {
  std::string bytes;
  std::uint32_t group = 0;
  int digits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    group = group << 6 | static_cast<std::uint32_t>(alphabet.find(c));
    if (++digits % 4 != 0) continue;
    for (int shift = 16; shift >= 0; shift -= 8) bytes += static_cast<char>(group >> shift & 255);
  }
  for (int left = digits % 4, k = 0; k + 1 < left; ++k) {
    bytes += static_cast<char>(group << 6 * (4 - left) >> (16 - 8 * k) & 255);
  }
  return bytes;
}

template <class T>
std::vector<T> unpack(const nlohmann::json& packed) {
  const std::string bytes = bytes_of(packed.get<std::string>());
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

class ViewPlan : public testing::Test {
 protected:
  void SetUp() override {
    LOCOGRAPH_NEEDS_VIEWER();
    const Outcome planned = runner.run("plan centauro_drive -o p.g2o");
    ASSERT_EQ(planned.exit_code, 0) << planned.err;
    runner.write("box.xml", kBox);
  }
  CommandRunner runner;
};

}  // namespace locograph
