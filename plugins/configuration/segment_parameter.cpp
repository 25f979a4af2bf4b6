#include <locograph/common/ranges.h>
#include <locograph/plugins/configuration/segment_parameter.h>
#include <locograph/plugins/configuration/stance_parameter.h>

#include <cmath>

namespace locograph {

void SegmentParameter::read(FieldReader& in) {
  segment = in.integer();
  if (segment < 0) in.fail("segment " + std::to_string(segment), "0 or more");
  stance_number = in.integer();
  in.parameters()->get<StanceParameter>(stance_number);
  from_s = in.number();
  if (!(std::abs(from_s) <= ranges::kTime_s)) {
    in.fail("a segment from " + std::to_string(from_s) + " s", "a time within 1e6 s");
  }
  duration_s = in.number();
  if (!(duration_s > 0.0 && duration_s <= 2.0 * ranges::kTime_s)) {
    in.fail("a duration of " + std::to_string(duration_s) + " s", "more than 0 s, at most 2e6 s");
  }
  planner = in.word();
}

void SegmentParameter::write(FieldWriter& out) const {
  out.integer(segment);
  out.integer(stance_number);
  out.number(from_s);
  out.number(duration_s);
  out.word(planner);
}

}  // namespace locograph
