// Writes seeds and a dictionary for the fuzz target of graph files: `graph_seeds SEEDS DICTIONARY`.

#include <locograph/common/atomic_file.h>
#include <locograph/types/standard_types.h>

#include <cstdio>

#include "types/random_lines.h"

namespace locograph {
namespace {

std::string seed_of(test::RandomLines& lines, const TypeRegistry& types, const std::string& tag) {
  if (types.vertex_type(tag) != nullptr) return lines.vertex(tag, 0) + "\n";
  if (types.edge_type(tag) == nullptr) return lines.parameters();
  std::string text = lines.parameters();
  for (const std::string& line : lines.edge(tag, 0)) text += line + "\n";
  return text;
}

void write_seeds(const std::filesystem::path& folder, const std::filesystem::path& dictionary) {
  const TypeRegistry types = standard_types();
  test::RandomLines lines(types, 1);
  int number = 0;
  for (const std::string& tag : types.tags()) {
    write_file_atomically(folder / ("type_" + std::to_string(number++)),
                          seed_of(lines, types, tag));
  }
  std::string words;
  for (const std::string& tag : types.tags()) words += "\"" + tag + " \"\n";
  for (const char* word : {"FIX ", "||", "scalar 1", "diagonal ", " constraint equality",
                           " constraint inequality 0.1", "1e308"}) {
    words += "\"" + std::string(word) + "\"\n";
  }
  write_file_atomically(dictionary, words);
}

}  // namespace
}  // namespace locograph

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: graph_seeds SEEDS DICTIONARY\n", stderr);
    return 2;
  }
  locograph::write_seeds(arguments[1], arguments[2]);
  return 0;
}
