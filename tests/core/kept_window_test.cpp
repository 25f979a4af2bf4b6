#include <gtest/gtest.h>

#include <random>

#include "common/allocation_counter.h"
#include "core/dense_system.h"
#include "core/toy_types.h"

namespace locograph::test {
namespace {

int derived_count = 0, step_count = 0, spot_count = 0;
constexpr int kSpot = 5;

struct PlaceParameter : Parameter {
  double place = 0.0;
  explicit PlaceParameter(double at) : place(at) {}
  std::string_view tag() const override { return "PARAMS_PLACE"; }
  void read(FieldReader& in) override { read_field(in, place); }
  void write(FieldWriter& out) const override { write_field(out, place); }
};

/// A number whose sine is derived, and counted.
struct VertexSine : Vertex<1, 1> {
  struct Derived {
    double value = 0.0, sine = 0.0;
  };
  VertexSine() = default;
  explicit VertexSine(double at) { state[0] = at; }
  static void oplus(const double* s, const double* d, double* out) { out[0] = s[0] + d[0]; }
  Derived make_derived() const { return {}; }
  void derive(const double* s, Derived& derived) const {
    ++derived_count;
    derived = {s[0], std::sin(s[0])};
  }
  void read(FieldReader& in) { read_field(in, state); }
  void write(FieldWriter& out) const { write_field(out, state); }
};
LOCOGRAPH_REGISTER_VERTEX("SINE", VertexSine)

/// Error (1): the difference of two sines, and of the numbers.
struct SineStep : Edge<2, VertexSine, VertexSine> {
  static constexpr ConstraintKind kConstraint = ConstraintKind::kEquality;
  void error(const VertexSine::Derived& a, const VertexSine::Derived& b,
             Eigen::Ref<Eigen::Vector2d> e) const {
    ++step_count;
    e << b.sine - a.sine - 0.1, b.value - a.value;
  }
  void jacobians(const VertexSine::Derived& a, const VertexSine::Derived& b,
                 JacobianRef<SineStep, 0> ja, JacobianRef<SineStep, 1> jb) const {
    ja << -std::cos(a.value), -1.0;
    jb << std::cos(b.value), 1.0;
  }
};
LOCOGRAPH_REGISTER_EDGE("SINE_STEP", SineStep)

/// Error (1): how far a number is below a place that may be bound; a hinge.
struct SineSpot : WeightedEdge<1, VertexSine> {
  static constexpr bool kOneSided = true;
  std::shared_ptr<const PlaceParameter> own;
  void bind(const Parameters& parameters) { own = parameters.get<PlaceParameter>(kSpot); }
  void error(const VertexSine::Derived& q, Eigen::Ref<Eigen::Matrix<double, 1, 1>> e,
             const Bindings& bindings) const {
    ++spot_count;
    e[0] = std::max(0.0, bindings.get(kSpot, *own).place - q.sine);
  }
  void jacobians(const VertexSine::Derived& q, JacobianRef<SineSpot, 0> j, const Bindings&) const {
    j << -std::cos(q.value);
  }
};
LOCOGRAPH_REGISTER_EDGE("SINE_SPOT", SineSpot)

Bindings bound_to(double place) {
  Bindings bindings;
  bindings.set(kSpot, std::make_shared<const PlaceParameter>(place));
  return bindings;
}

/// A chain of numbers, each tied to the next two, beside it one of arms of one or two joints, and
/// a window of 8 of each that slides along it.
class KeptWindow : public testing::Test {
 protected:
  static constexpr int kLength = 30, kWindow = 8;
  static constexpr int kRaised = 6;  ///< a row of the step from the first to the second

  KeptWindow() {
    graph_.parameters().set(kSpot, std::make_shared<const PlaceParameter>(0.2));
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int i = 0; i < kLength; ++i) {
      ids_.push_back(graph_.add_vertex(i, VertexSine(number(engine))));
      slots_.push_back(ids_.back().slot);
      VertexJoints arm;
      arm.state.resize(1 + i % 2);
      for (double& joint : arm.state) joint = number(engine);
      arms_.push_back(graph_.add_vertex(kLength + i, arm).slot);
      if (i > 0) {
        graph_.add_edge(ToyMeet<Derivatives::kByHand>(), VertexId<VertexJoints>{arms_[i - 1]},
                        VertexId<VertexJoints>{arms_[i]});
      }
      SineSpot spot;
      spot.weights.setConstant(1, 2.0);
      graph_.add_edge(spot, ids_[i]);
      for (const int back : {1, 2}) {
        if (i < back) continue;
        SineStep step;
        step.information *= 3.0;
        graph_.add_edge(step, ids_[i - back], ids_[i]);
      }
    }
    move_to(2, false);
  }

  void compile(int begin, Problem& problem) {
    free_.assign(slots_.begin() + begin, slots_.begin() + begin + kWindow);
    free_.insert(free_.end(), arms_.begin() + begin, arms_.begin() + begin + kWindow);
    problem.compile(graph_, free_);
  }

  void move_to(int begin, bool keeps) {
    if (keeps) workspace_.keep();
    compile(begin, problem_);
    workspace_.allocate(problem_);
    workspace_.bind(bindings_);
    if (raised_) workspace_.constraint_rows()[kRaised].scale = 2.0;
    begin_ = begin;
    load();
  }

  /// Evaluates the state of the graph. All is as in a workspace that keeps nothing, to the bit.
  void load() {
    workspace_.load_state();
    derived_count = step_count = spot_count = 0;
    const Cost cost = workspace_.return_to_state();
    counted_ = {derived_count, step_count, spot_count};
    Problem problem;
    compile(begin_, problem);
    Workspace fresh;
    fresh.allocate(problem);
    fresh.bind(bindings_);
    if (raised_) fresh.constraint_rows()[kRaised].scale = 2.0;
    fresh.load_state();
    const Cost expected = fresh.evaluate(fresh.state());
    EXPECT_EQ(cost.chi2, expected.chi2);
    EXPECT_EQ(cost.robust, expected.robust);
    EXPECT_EQ(workspace_.constraint_errors(), fresh.constraint_errors());
    workspace_.linearise();
    fresh.linearise();
    EXPECT_TRUE(std::ranges::equal(workspace_.hessian(), fresh.hessian()));
    EXPECT_TRUE(std::ranges::equal(workspace_.gradient(), fresh.gradient()));
  }

  struct Counted {
    int derived, steps, spots;
  };
  /// In the window and held before it; ties; numbers of the window.
  static constexpr int kVertices = kWindow + 4, kSteps = 2 * kWindow + 3, kSpots = kWindow;

  void expect(const Counted& counted) const {
    EXPECT_EQ(counted_.derived, counted.derived);
    EXPECT_EQ(counted_.steps, counted.steps);
    EXPECT_EQ(counted_.spots, counted.spots);
  }

  Graph graph_;
  std::vector<VertexId<VertexSine>> ids_;
  std::vector<int> slots_, arms_, free_;
  Bindings bindings_ = bound_to(0.3);
  Problem problem_;
  Workspace workspace_;
  bool raised_ = false;
  int begin_ = 0;
  Counted counted_{};
};

TEST_F(KeptWindow, EvaluatesWhatEntersAlone) {
  expect({kVertices, kSteps, kSpots});
  move_to(3, true);  // costs are known edge by edge from here on
  expect({kVertices, kSteps, kSpots});
  for (int begin = 4; begin < 18; ++begin) {
    move_to(begin, true);
    expect({1, 2, 1});
  }
  move_to(20, true);
  expect({3, 6, 3});
  move_to(20, false);
  expect({kVertices, kSteps, kSpots});
}

TEST_F(KeptWindow, EvaluatesWhatReadsOtherBindings) {
  move_to(3, true);
  bindings_ = bound_to(-0.4);
  move_to(4, true);
  expect({1, 2, kSpots});
  bindings_ = bound_to(0.5);
  workspace_.bind(bindings_);
  derived_count = step_count = spot_count = 0;
  workspace_.return_to_state();
  counted_ = {derived_count, step_count, spot_count};
  expect({0, 0, kSpots});
  move_to(5, true);
  expect({1, 2, 1});
}

TEST_F(KeptWindow, EvaluatesWhatHasMoved) {
  move_to(3, true);
  graph_.vertex(ids_[7]).state[0] += 1e-15;
  move_to(4, true);
  expect({2, 2 + 4, 2});
  graph_.vertex(ids_[4]).state[0] = -0.0;
  move_to(5, true);  // held from here on
  expect({2, 2 + 2, 1});
}

TEST_F(KeptWindow, EvaluatesWhereRowsAreOthers) {
  move_to(3, true);
  raised_ = true;
  move_to(4, true);
  expect({1, 2 + 1, 1});
  raised_ = false;
  move_to(5, true);
  expect({1, 2 + 1, 1});
}

TEST_F(KeptWindow, EvaluatesWhatIsChangedOnceItIsLoaded) {
  move_to(3, true);
  for (const bool rows : {true, false}) {
    Problem problem;
    Workspace fresh;
    workspace_.keep();
    compile(4, problem_);
    compile(4, problem);
    for (Workspace* workspace : {&workspace_, &fresh}) {
      workspace->allocate(workspace == &fresh ? problem : problem_);
      workspace->bind(bindings_);
      workspace->load_state();
      if (rows) {
        workspace->constraint_rows()[kRaised].scale = 2.0;
      } else {
        workspace->step().assign(workspace->step().size(), 0.1);
        workspace->apply_step();
        workspace->accept_trial();
      }
    }
    EXPECT_EQ(workspace_.return_to_state().chi2, fresh.evaluate(fresh.state()).chi2);
  }
}

TEST_F(KeptWindow, ForgetsWhatHasNotBeenEvaluated) {
  move_to(3, true);
  workspace_.step().assign(workspace_.step().size(), 0.1);
  workspace_.apply_step();
  workspace_.evaluate(workspace_.trial());
  move_to(4, true);  // a trial that was refused
  expect({kVertices, kSteps, kSpots});
  move_to(5, true);
  workspace_.apply_step();
  workspace_.evaluate(workspace_.trial());
  workspace_.accept_trial();
  workspace_.store_state();
  move_to(6, true);
  expect({1, 2, 1});
}

TEST_F(KeptWindow, DoesNotAllocateOnceItHasItsMemory) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const auto slide = [&](int begin) {
    workspace_.keep();
    compile(begin, problem_);
    workspace_.allocate(problem_);
    workspace_.bind(bindings_);
    workspace_.load_state();
    workspace_.return_to_state();
  };
  for (int begin = 3; begin < 8; ++begin) slide(begin);
  const long before = allocation_count();
  for (int begin = 8; begin < 18; ++begin) slide(begin);
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace locograph::test
