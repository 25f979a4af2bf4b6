#pragma once
/// The cost that a trial has to undercut when the cost may rise for a few steps: the non-monotonic
/// test of Conn, Gould & Toint 2000, "Trust-Region Methods", algorithm 10.1.2 (Toint 1996).
///
///     ReferenceCost reference;
///     reference.start(cost, 5);
///     if (reference.quality(trial_cost, predicted) > 0.0) reference.accept(trial_cost, predicted);
///
/// A trial is as good as its decrease measured from the present cost, or from a reference of a few
/// steps ago against the sum of what the model has predicted since, whichever is better. After
/// `most_rises` steps without a new least cost, the highest cost since the least one becomes the
/// reference. With 0 only the present cost counts.

#include <algorithm>

namespace locograph {

class ReferenceCost {
 public:
  void start(double cost, int most_rises) {
    *this = {};
    most_rises_ = most_rises;
    present_ = least_ = reference_ = candidate_ = cost;
  }

  /// Gain ratio of a trial: actual over predicted decrease.
  double quality(double cost, double predicted) const {
    const double from_here = (present_ - cost) / predicted;
    if (most_rises_ == 0) return from_here;
    return std::max(from_here, (reference_ - cost) / (since_reference_ + predicted));
  }

  void accept(double cost, double predicted) {
    present_ = cost;
    since_reference_ += predicted;
    since_candidate_ += predicted;
    if (cost < least_) {
      least_ = candidate_ = cost;
      since_candidate_ = 0.0;
      rises_ = 0;
    } else {
      ++rises_;
      if (cost > candidate_) {
        candidate_ = cost;
        since_candidate_ = 0.0;
      }
    }
    if (rises_ == most_rises_) {
      reference_ = candidate_;
      since_reference_ = since_candidate_;
    }
  }

 private:
  int most_rises_ = 0, rises_ = 0;
  double present_ = 0.0, least_ = 0.0;
  /// A reference, the next one, and the decrease predicted since each.
  double reference_ = 0.0, candidate_ = 0.0;
  double since_reference_ = 0.0, since_candidate_ = 0.0;
};

}  // namespace locograph
