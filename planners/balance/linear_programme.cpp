#include <locograph/planners/balance/linear_programme.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

constexpr double kFeasible = 1e-9, kOptimal = 1e-9;
/// Of a corner, by the matrix.
constexpr double kVerified = 1e-8;
/// Smaller entries of the dictionary are no pivots.
constexpr double kPivot = 1e-8;
/// Of a cost of one.
constexpr double kSteeper = 1e-3;
constexpr double kGolden = 0.6180339887498949;

}  // namespace

void LinearProgramme::resize(int rows, int columns) {
  const bool other = rows != rows_ || columns != columns_;
  rows_ = rows;
  columns_ = columns;
  matrix_.setZero(rows, columns);
  cost_.setZero(columns);
  lower_.resize(columns + rows);
  upper_.resize(columns + rows);
  lower_.head(columns).setZero();
  lower_.tail(rows).setConstant(-kNoBound);
  upper_.setConstant(kNoBound);
  built_ = false;
  if (other) start_afresh();
}

Eigen::MatrixXd& LinearProgramme::matrix() {
  built_ = false;
  return matrix_;
}

void LinearProgramme::bound_column(int column, double lower, double upper) {
  lower_[column] = lower;
  upper_[column] = upper;
}

void LinearProgramme::bound_row(int row, double lower, double upper) {
  bound_column(columns_ + row, lower, upper);
}

void LinearProgramme::start_afresh() {
  is_basic_.assign(static_cast<std::size_t>(columns_ + rows_), false);
  std::fill(is_basic_.begin() + columns_, is_basic_.end(), true);
  at_upper_.assign(is_basic_.size(), false);
  built_ = false;
}

/// The dictionary of the corner where is_basic_ says which variables are basic, or of one near it.
void LinearProgramme::build() {
  dictionary_ = matrix_;
  basic_.resize(static_cast<std::size_t>(rows_));
  free_.resize(static_cast<std::size_t>(columns_));
  for (int r = 0; r < rows_; ++r) basic_[static_cast<std::size_t>(r)] = columns_ + r;
  for (int c = 0; c < columns_; ++c) free_[static_cast<std::size_t>(c)] = c;
  slope_ = cost_;
  for (int place = 0; place < columns_; ++place) {
    if (!is_basic_[static_cast<std::size_t>(place)]) continue;
    int best = -1;
    double most = kPivot;
    for (int r = 0; r < rows_; ++r) {
      if (is_basic_[static_cast<std::size_t>(basic_[static_cast<std::size_t>(r)])]) continue;
      const double size = std::abs(dictionary_(r, place));
      if (size <= most) continue;
      most = size;
      best = r;
    }
    if (best >= 0) pivot(best, place);
  }
  std::fill(is_basic_.begin(), is_basic_.end(), false);
  for (const int variable : basic_) is_basic_[static_cast<std::size_t>(variable)] = true;
  built_ = true;
}

double LinearProgramme::rest_at(int variable) const {
  const bool up = at_upper_[static_cast<std::size_t>(variable)];
  const double bound = up ? upper_[variable] : lower_[variable];
  if (std::isfinite(bound)) return bound;
  const double other = up ? lower_[variable] : upper_[variable];
  return std::isfinite(other) ? other : 0.0;
}

/// What basic variables are, from those that are not.
void LinearProgramme::evaluate() {
  free_value_.resize(columns_);
  for (int place = 0; place < columns_; ++place) {
    const int variable = free_[static_cast<std::size_t>(place)];
    free_value_[place] = rest_at(variable);
    at_upper_[static_cast<std::size_t>(variable)] = free_value_[place] == upper_[variable];
  }
  basic_value_.noalias() = dictionary_ * free_value_;
}

void LinearProgramme::find_slopes() {
  slope_.resize(columns_);
  for (int place = 0; place < columns_; ++place) {
    const int variable = free_[static_cast<std::size_t>(place)];
    slope_[place] = variable < columns_ ? cost_[variable] : 0.0;
  }
  for (int r = 0; r < rows_; ++r) {
    const int variable = basic_[static_cast<std::size_t>(r)];
    if (variable < columns_ && cost_[variable] != 0.0) {
      slope_ += cost_[variable] * dictionary_.row(r).transpose();
    }
  }
}

bool LinearProgramme::feasible() const {
  for (int r = 0; r < rows_; ++r) {
    const int variable = basic_[static_cast<std::size_t>(r)];
    if (basic_value_[r] < lower_[variable] - kFeasible ||
        basic_value_[r] > upper_[variable] + kFeasible) {
      return false;
    }
  }
  return true;
}

/// Variables whose slope leads into their range go to its other end; where there is none the slope
/// is left out for the time being. All slopes are made a little steeper, each by something else, so
/// that dual() does not stall where many are zero; primal() has those of the costs. True: some
/// moved.
bool LinearProgramme::make_dual_feasible() {
  bool moved = false;
  for (int place = 0; place < columns_; ++place) {
    const int variable = free_[static_cast<std::size_t>(place)];
    const bool may_rise = free_value_[place] < upper_[variable];
    const bool may_fall = free_value_[place] > lower_[variable];
    if (may_rise && may_fall) {
      slope_[place] = 0.0;
      continue;
    }
    double& slope = slope_[place];
    bool up = may_fall;  // at its upper bound
    if ((may_rise && slope < -kOptimal) || (may_fall && slope > kOptimal)) {
      if (std::isfinite(upper_[variable] - lower_[variable])) {
        up = !up;
        at_upper_[static_cast<std::size_t>(variable)] = up;
        moved = true;
      } else {
        slope = 0.0;
      }
    }
    double whole;
    const double steeper = kSteeper * (0.5 + 0.5 * std::modf(kGolden * (variable + 1), &whole));
    slope += up ? -steeper : steeper;
  }
  return moved;
}

/// The variable of `place` becomes basic, that of `row` free.
void LinearProgramme::pivot(int row, int place) {
  const double entry = dictionary_(row, place);
  column_ = dictionary_.col(place);
  row_ = dictionary_.row(row).transpose() / entry;
  row_[place] = -1.0 / entry;
  column_[row] = 1.0;
  dictionary_.col(place).setZero();
  dictionary_.row(row).setZero();
  dictionary_.noalias() -= column_ * row_.transpose();
  const double slope = slope_[place];
  slope_[place] = 0.0;
  slope_ -= slope * row_;
  std::swap(basic_[static_cast<std::size_t>(row)], free_[static_cast<std::size_t>(place)]);
}

/// The variable of `place` goes by a step and becomes basic; that of `row`, then at a bound, free.
void LinearProgramme::exchange(int row, int place, double step, double bound) {
  basic_value_ += step * dictionary_.col(place);
  const double value = free_value_[place] + step;
  pivot(row, place);
  basic_value_[row] = value;
  free_value_[place] = bound;
}

/// From a corner where slopes lead out of all ranges to one that is feasible.
LinearAnswer LinearProgramme::dual() {
  const int most = 4 * (rows_ + columns_);
  for (int iteration = 0; iteration < most; ++iteration) {
    int row = -1;
    double furthest = kFeasible;
    for (int r = 0; r < rows_; ++r) {
      const int variable = basic_[static_cast<std::size_t>(r)];
      const double out =
          std::max(lower_[variable] - basic_value_[r], basic_value_[r] - upper_[variable]);
      if (out <= furthest) continue;
      furthest = out;
      row = r;
    }
    if (row < 0) return LinearAnswer::kOptimal;
    const int leaving = basic_[static_cast<std::size_t>(row)];
    const bool rises = basic_value_[row] < lower_[leaving];
    const double bound = rises ? lower_[leaving] : upper_[leaving];
    // How much it gains with each variable that may move the way it has to.
    const auto gain = [&](int place) {
      const int variable = free_[static_cast<std::size_t>(place)];
      const double entry = rises ? dictionary_(row, place) : -dictionary_(row, place);
      const bool may = entry > 0.0 ? free_value_[place] < upper_[variable]
                                   : free_value_[place] > lower_[variable];
      return may ? std::abs(entry) : 0.0;
    };
    double least = kNoBound;
    for (int place = 0; place < columns_; ++place) {
      const double size = gain(place);
      if (size > kPivot) least = std::min(least, (std::abs(slope_[place]) + kOptimal) / size);
    }
    int entering = -1;
    double largest = 0.0;
    for (int place = 0; place < columns_; ++place) {
      const double size = gain(place);
      if (size <= kPivot || size <= largest || std::abs(slope_[place]) > least * size) continue;
      largest = size;
      entering = place;
    }
    if (entering < 0) return LinearAnswer::kInfeasible;
    const double step = (bound - basic_value_[row]) / dictionary_(row, entering);
    exchange(row, entering, step, bound);
  }
  return LinearAnswer::kUnsolved;
}

/// From a corner that is feasible to the best one.
LinearAnswer LinearProgramme::primal() {
  const int most = 4 * (rows_ + columns_);
  for (int iteration = 0; iteration < most; ++iteration) {
    int entering = -1;
    double steepest = kOptimal;
    for (int place = 0; place < columns_; ++place) {
      const int variable = free_[static_cast<std::size_t>(place)];
      const double slope = slope_[place];
      const bool may = slope < 0.0 ? free_value_[place] < upper_[variable]
                                   : free_value_[place] > lower_[variable];
      if (!may || std::abs(slope) <= steepest) continue;
      steepest = std::abs(slope);
      entering = place;
    }
    if (entering < 0) return LinearAnswer::kOptimal;
    const double way = slope_[entering] < 0.0 ? 1.0 : -1.0;
    // How far each basic variable lets it go, with the tolerance or without.
    const auto room = [&](int r, double tolerance) {
      const int variable = basic_[static_cast<std::size_t>(r)];
      const double rate = way * dictionary_(r, entering);
      if (std::abs(rate) <= kPivot) return kNoBound;
      return rate > 0.0 ? (upper_[variable] + tolerance - basic_value_[r]) / rate
                        : (lower_[variable] - tolerance - basic_value_[r]) / rate;
    };
    double least = kNoBound;
    for (int r = 0; r < rows_; ++r) least = std::min(least, room(r, kFeasible));
    int row = -1;
    double largest = 0.0;
    for (int r = 0; r < rows_ && std::isfinite(least); ++r) {
      const double size = std::abs(dictionary_(r, entering));
      if (size <= largest || !(room(r, 0.0) <= least)) continue;
      largest = size;
      row = r;
    }
    const int variable = free_[static_cast<std::size_t>(entering)];
    const double own = upper_[variable] - lower_[variable];
    const double step = row < 0 ? kNoBound : std::max(0.0, room(row, 0.0));
    if (!std::isfinite(std::min(step, own))) return LinearAnswer::kUnsolved;
    if (own <= step) {
      basic_value_ += way * own * dictionary_.col(entering);
      free_value_[entering] = way > 0.0 ? upper_[variable] : lower_[variable];
      continue;
    }
    const int leaving = basic_[static_cast<std::size_t>(row)];
    const double bound = way * dictionary_(row, entering) > 0.0 ? upper_[leaving] : lower_[leaving];
    exchange(row, entering, way * step, bound);
  }
  return LinearAnswer::kUnsolved;
}

LinearAnswer LinearProgramme::run() {
  evaluate();
  find_slopes();
  if (!feasible()) {
    if (make_dual_feasible()) evaluate();
    if (const LinearAnswer answer = dual(); answer != LinearAnswer::kOptimal) return answer;
    find_slopes();
  }
  return primal();
}

/// Whether the corner is feasible and optimal by the matrix; sets solution_ and prices_.
bool LinearProgramme::verified() {
  solution_.setZero(columns_);
  prices_.setZero(rows_);
  std::fill(is_basic_.begin(), is_basic_.end(), false);
  for (int r = 0; r < rows_; ++r) {
    const int variable = basic_[static_cast<std::size_t>(r)];
    is_basic_[static_cast<std::size_t>(variable)] = true;
    if (variable < columns_) solution_[variable] = basic_value_[r];
  }
  for (int place = 0; place < columns_; ++place) {
    const int variable = free_[static_cast<std::size_t>(place)];
    at_upper_[static_cast<std::size_t>(variable)] = free_value_[place] == upper_[variable];
    if (variable < columns_) {
      solution_[variable] = free_value_[place];
    } else {
      prices_[variable - columns_] = slope_[place];
    }
  }
  const auto within = [&](int variable, double x) {
    return x >= lower_[variable] - kVerified && x <= upper_[variable] + kVerified;
  };
  row_.noalias() = cost_ - matrix_.transpose() * prices_;
  for (int c = 0; c < columns_; ++c) {
    const double x = solution_[c];
    if (!within(c, x)) return false;
    if (row_[c] > kVerified && x > lower_[c] + kVerified) return false;
    if (row_[c] < -kVerified && x < upper_[c] - kVerified) return false;
  }
  column_.noalias() = matrix_ * solution_;
  for (int r = 0; r < rows_; ++r) {
    if (!within(columns_ + r, column_[r])) return false;
  }
  return true;
}

LinearAnswer LinearProgramme::solve() {
  LinearAnswer answer = LinearAnswer::kUnsolved;
  // From the corner as it is, by the matrix again, and from the first corner.
  for (int attempt = 0; attempt < 3; ++attempt) {
    const bool fresh = !built_;
    if (attempt == 2) start_afresh();
    if (!built_) build();
    answer = run();
    if (answer == LinearAnswer::kOptimal && verified()) return answer;
    // What is infeasible is so from any corner, unless pivots before have blurred it.
    if (answer == LinearAnswer::kInfeasible && fresh) return answer;
    built_ = false;
  }
  return answer == LinearAnswer::kOptimal ? LinearAnswer::kUnsolved : answer;
}

}  // namespace locograph
