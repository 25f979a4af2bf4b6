#pragma once
/// A diagnosis as JSON, with the ids of vertices.
///
///     json["diagnosis"] = diagnosis_json(diagnose(graph), graph);

#include <locograph/apps/output.h>
#include <locograph/core/diagnosis.h>

namespace locograph {

Json diagnosis_json(const Diagnosis& diagnosis, const Graph& graph);

}  // namespace locograph
