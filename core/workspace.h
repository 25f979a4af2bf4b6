#pragma once
/// The numbers of a compiled problem: state, derived quantities, H, gradient, step. Allocated once.
///
/// See problem.h for the order of calls. linearise() uses the derived quantities of the last
/// evaluate(), so it is called on the state that was evaluated last: that is why an accepted trial
/// costs no second kinematics.

#include <locograph/core/problem.h>

namespace locograph {

class Workspace {
 public:
  /// Keeps memory that is large enough. The problem must outlive the workspace's use.
  void allocate(const Problem& problem);
  void load_state();         ///< graph → state()
  void store_state() const;  ///< state() → graph

  std::vector<double>& state() { return state_; }
  std::vector<double>& trial() { return trial_; }
  std::vector<double>& hessian() { return hessian_; }
  std::vector<double>& gradient() { return gradient_; }  ///< JᵀΩe
  std::vector<double>& step() { return step_; }
  std::vector<double>& damping() { return damping_; }

  /// trial = state ⊞ step.
  void apply_step();
  void accept_trial() { state_.swap(trial_); }

  /// Derives the quantities of `state` and sums the cost. Returns a non-finite cost for a state
  /// that cannot be evaluated.
  Cost evaluate(const std::vector<double>& state);
  /// Fills hessian() and gradient() at state(), which was evaluated last.
  Cost linearise();
  /// Error vector of edge k of pool p at the state evaluated last.
  void error(int pool, int k, double* error);

  /// The diagonal of H.
  void diagonal(std::vector<double>& diagonal) const;
  /// xᵀ H x.
  double quadratic_form(const std::vector<double>& x) const;

  const Problem& problem() const { return *problem_; }

 private:
  /// What a DerivedStore was made for.
  struct DerivedFor {
    const VertexPool* pool = nullptr;
    std::type_index type = typeid(void);
    std::vector<int> state_sizes;

    bool fits(const VertexPool& other, std::span<const ActiveVertex> active) const;
    void assign(const VertexPool& other, std::span<const ActiveVertex> active);
  };

  Evaluation evaluation(const std::vector<double>& state) {
    return {state.data(), derived_, &scratch_};
  }

  const Problem* problem_ = nullptr;
  std::vector<double> state_, trial_, hessian_, gradient_, step_, damping_;
  std::vector<std::unique_ptr<DerivedStore>> derived_;
  std::vector<DerivedFor> derived_for_;
  Scratch scratch_;
};

}  // namespace locograph
