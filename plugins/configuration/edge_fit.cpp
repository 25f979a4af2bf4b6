#include <locograph/plugins/configuration/edge_fit.h>

#include <cstdio>

namespace locograph {

void require_margin(std::string_view tag, double margin, double least) {
  if (margin >= least && margin <= ranges::kCoordinate_m) return;
  char found[40], expected[60];
  std::snprintf(found, sizeof found, " with a margin of %.6g", margin);
  std::snprintf(expected, sizeof expected, "%.6g to %.6g", least, ranges::kCoordinate_m);
  throw Error(std::string(tag) + found, expected);
}

namespace detail {

void refuse_rows(std::string_view tag, long rows, const std::string& expected) {
  throw Error(std::string(tag) + " with n = " + std::to_string(rows),
              "n = " + expected + " for its robot");
}

void refuse_robot(std::string_view tag) {
  throw Error(std::string(tag) + " meets configurations of different robots", "one robot");
}

}  // namespace detail
}  // namespace locograph
