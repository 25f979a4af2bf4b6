/// Runs the examples of all headers, or of those whose names begin with an argument:
///
///     header_examples [core/ world/octree.h…]
///
/// An example fails when it throws, unless FOLDER_context.h says that it does, and when a sanitizer
/// stops it. Standard input is empty.

#include <documentation/example_context.h>
#include <locograph/common/error.h>

#include <cstdio>
#include <exception>
#include <tuple>

#include "common/temporary_folder.h"

namespace locograph::documentation {
namespace {

bool is_wanted(const Example& example, const std::vector<std::string>& beginnings) {
  const std::string header = example.header;
  return beginnings.empty() || std::any_of(beginnings.begin(), beginnings.end(),
                                           [&](const auto& b) { return header.starts_with(b); });
}

/// Empty when it did what it should, otherwise what it did.
std::string failure_of(const Example& example) {
  const test::TemporaryFolder folder;
  std::filesystem::current_path(folder.path());
  try {
    example.run();
  } catch (const Error& error) {
    if (example.kind != Example::kThrows) return error.what();
    std::cout << "  throws: " << error.what() << '\n';
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
  return example.kind == Example::kThrows ? "throws nothing" : "";
}

int run_examples(const std::vector<std::string>& beginnings) {
  std::vector<Example>& all = all_examples();
  std::sort(all.begin(), all.end(), [](const Example& a, const Example& b) {
    return std::tuple(std::string_view(a.header), a.number) <
           std::tuple(std::string_view(b.header), b.number);
  });
  const std::filesystem::path home = std::filesystem::current_path();
  int run = 0, left_out = 0, failed = 0;
  for (const Example& example : all) {
    if (!is_wanted(example, beginnings)) continue;
    std::cout << example.header << ", example " << example.number << std::endl;
    if (example.kind == Example::kNotRun) {
      std::cout << "  not run: " << example.reason << '\n';
      ++left_out;
      continue;
    }
    ++run;
    const std::string failure = failure_of(example);
    std::filesystem::current_path(home);
    if (failure.empty()) continue;
    ++failed;
    std::cout << "  FAILED: " << failure << '\n';
  }
  std::cout << run << " examples run, " << failed << " failed, " << left_out << " not run\n";
  return failed == 0 && run > 0 ? 0 : 1;
}

}  // namespace
}  // namespace locograph::documentation

int main(int count, char** arguments) {
  if (std::freopen("/dev/null", "r", stdin) == nullptr) return 1;
  return locograph::documentation::run_examples({arguments + 1, arguments + count});
}
