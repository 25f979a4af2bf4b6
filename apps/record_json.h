#pragma once
/// What `info` and `check` tell of the record of a plan carried out.
///
///     const PlanFile file = load_plan("result.g2o");
///     if (file.plan.recorded) print_result(record_json(file), as_json);

#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>

namespace locograph {

/// `plan` is null where the record does not name one. Throws Error naming the file for a record
/// that lacks something.
Json record_json(const PlanFile& file);

}  // namespace locograph
