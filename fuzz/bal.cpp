// Files of "Bundle Adjustment in the Large".

#include <locograph/types/bundle/bal_file.h>

#include <string_view>

#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  locograph::looks_like_bal(text);
  locograph::accept_or_refuse("fuzz.txt", [&] { locograph::read_bal_text(text, "fuzz.txt"); });
  return 0;
}
