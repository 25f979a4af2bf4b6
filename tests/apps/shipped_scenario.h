#pragma once
/// Scenarios that come along, as texts to be changed.
///
///     std::string text = shipped("standing_up");
///     runner.write("s.xml", with(text, "size=\"5 2\"", "size=\"5 12\""));
///     runner.write("t.xml", with(text, part(text, "<goal>", "</goal>"), ""));

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

namespace locograph::test {

inline std::string shipped(const std::string& scenario) {
  std::ifstream in(LOCOGRAPH_SOURCE_DIR "/planners/scenarios/" + scenario + ".xml");
  return std::string((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
}

/// The text with every `find` replaced.
inline std::string with(std::string text, const std::string& find, const std::string& replace) {
  std::size_t at = text.find(find);
  if (at == std::string::npos) ADD_FAILURE() << "no " << find;
  for (; at != std::string::npos; at = text.find(find, at + replace.size())) {
    text.replace(at, find.size(), replace);
  }
  return text;
}

/// From the first `from` up to and with the next `to`.
inline std::string part(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  return text.substr(begin, text.find(to, begin) + to.size() - begin);
}

/// Number of the line that `what` is first on.
inline std::string line_of(const std::string& text, const std::string& what) {
  const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(text.find(what));
  return std::to_string(1 + std::count(text.begin(), text.begin() + at, '\n'));
}

/// A <goal> of standing_up that is its start, with the left hand here.
inline std::string goal_on_all_fours(const std::string& left_hand) {
  const std::string contacts = part(shipped("standing_up"), "<contact", "</start>");
  return "<goal>" + with(with(contacts, "</start>", "</goal>"), "1.7 0.1 0", left_hand);
}

/// standing_up with these goals.
inline std::string standing_up_with(const std::string& goals) {
  const std::string text = shipped("standing_up");
  return with(text, part(text, "<goal>", "</goal>"), goals);
}

/// On a floor that nothing leads to, 50 m ahead.
inline std::string with_far_floor(const std::string& text) {
  return with(text, "</environment>",
              "<plane name=\"far\" center=\"51 0 0\" normal=\"0 0 1\" size=\"2 2\"/>\n"
              "</environment>");
}

}  // namespace locograph::test
