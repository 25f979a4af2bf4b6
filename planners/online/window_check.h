#pragma once
/// How far the constraints of a window are violated, read off its edges: what the local planner
/// acts on between two cycles. (The verdict on a plan is the feasibility checker's, which shares no
/// code with this.)

#include <locograph/core/workspace.h>

#include <string>
#include <vector>

namespace locograph {

struct WindowViolation {
  std::string constraint;  ///< empty: all hold
  double worst = 0.0;      ///< beyond what is allowed, in the constraint's unit
  std::string unit;
  int at_vertex = -1;  ///< slot of the first vertex of the edge
  bool any() const { return !constraint.empty(); }
};

/// An edge that is violated, as pool number and index in the compiled pool.
struct ViolatedEdge {
  int pool;
  int k;
};

/// The constraint that is violated most, relative to what is allowed; all violated edges go to
/// `edges`. The workspace must have been evaluated at its state.
WindowViolation check_window(Workspace& workspace, std::vector<ViolatedEdge>& edges);

}  // namespace locograph
