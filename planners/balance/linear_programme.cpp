#include <locograph/planners/balance/linear_programme.h>

#include <ClpSimplex.hpp>

namespace locograph {
namespace {

LinearAnswer answer_of(const ClpSimplex& simplex) {
  if (simplex.isProvenOptimal()) return LinearAnswer::kOptimal;
  return simplex.status() > 1 ? LinearAnswer::kUnsolved : LinearAnswer::kInfeasible;
}

}  // namespace

void LinearColumns::put(int row, double value) {
  if (value == 0.0) return;
  rows_.push_back(row);
  entries_.push_back(value);
}

void LinearColumns::end(double lower, double upper, double cost) {
  starts_.push_back(static_cast<int>(rows_.size()));
  lower_.push_back(lower);
  upper_.push_back(upper);
  costs_.push_back(cost);
}

LinearProgramme::LinearProgramme(Perturbation perturbation)
    : simplex_(std::make_unique<ClpSimplex>()) {
  simplex_->setLogLevel(0);
  simplex_->scaling(0);
  if (perturbation == Perturbation::kNone) simplex_->setPerturbation(102);
  simplex_->setPrimalTolerance(1e-9);
  simplex_->setDualTolerance(1e-9);
}

LinearProgramme::~LinearProgramme() = default;
LinearProgramme::LinearProgramme(LinearProgramme&&) noexcept = default;

void LinearProgramme::load(const LinearColumns& columns, const std::vector<double>& lower,
                           const std::vector<double>& upper) {
  corner_.clear();
  if (simplex_->statusExists() && simplex_->isProvenOptimal()) {
    const unsigned char* status = simplex_->statusArray();
    corner_.assign(status, status + simplex_->numberColumns() + simplex_->numberRows());
  }
  simplex_->loadProblem(static_cast<int>(columns.costs_.size()), static_cast<int>(lower.size()),
                        columns.starts_.data(), columns.rows_.data(), columns.entries_.data(),
                        columns.lower_.data(), columns.upper_.data(), columns.costs_.data(),
                        lower.data(), upper.data());
}

void LinearProgramme::set_cost(int column, double cost) { simplex_->objective()[column] = cost; }

std::span<double> LinearProgramme::entries(int column) {
  CoinPackedMatrix& matrix = *simplex_->matrix();
  return {matrix.getMutableElements() + matrix.getVectorStarts()[column],
          static_cast<std::size_t>(matrix.getVectorSize(column))};
}

LinearAnswer LinearProgramme::primal() {
  simplex_->primal();
  return answer_of(*simplex_);
}

LinearAnswer LinearProgramme::dual() {
  simplex_->allSlackBasis(true);
  simplex_->dual();
  return answer_of(*simplex_);
}

LinearAnswer LinearProgramme::dual_from_before() {
  const int size = simplex_->numberColumns() + simplex_->numberRows();
  if (static_cast<int>(corner_.size()) != size) return dual();
  simplex_->copyinStatus(corner_.data());
  simplex_->dual();
  return answer_of(*simplex_);
}

double LinearProgramme::value() const { return simplex_->objectiveValue(); }

std::span<const double> LinearProgramme::solution() const {
  return {simplex_->primalColumnSolution(), static_cast<std::size_t>(simplex_->numberColumns())};
}

std::span<const double> LinearProgramme::prices() const {
  return {simplex_->dualRowSolution(), static_cast<std::size_t>(simplex_->numberRows())};
}

}  // namespace locograph
