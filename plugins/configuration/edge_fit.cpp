#include <locograph/plugins/configuration/edge_fit.h>

namespace locograph::detail {

void refuse_rows(std::string_view tag, long rows, const std::string& expected) {
  throw Error(std::string(tag) + " with n = " + std::to_string(rows),
              "n = " + expected + " for its robot");
}

void refuse_robot(std::string_view tag) {
  throw Error(std::string(tag) + " meets configurations of different robots", "one robot");
}

}  // namespace locograph::detail
