#pragma once
/// What the examples of all headers take for granted. header_examples.awk puts each into a member
/// function of a class of its header's, in_FOLDER::FILE_h::Examples; FOLDER_context.h has the
/// objects that it uses. run_examples.cpp runs them all, each with a context of its own, in an
/// empty folder of its own.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace locograph::documentation {

/// What an example may return.
struct Anything {
  Anything() = default;
  Anything(int) {}
};

struct Example {
  enum Kind { kRuns, kThrows, kNotRun };

  const char* header;
  int number;  ///< in its header, from 1
  Kind kind;
  const char* reason;  ///< why it is not run
  void (*run)();
};

/// Of all folders, in no order.
inline std::vector<Example>& all_examples() {
  static std::vector<Example> all;
  return all;
}

struct Registration {
  explicit Registration(std::initializer_list<Example> examples) {
    all_examples().insert(all_examples().end(), examples);
  }
};

/// A file in the folder of the example.
inline void write_example_file(const std::filesystem::path& file, std::string_view text) {
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace locograph::documentation
