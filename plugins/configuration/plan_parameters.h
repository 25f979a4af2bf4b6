#pragma once
/// What a plan file says about itself: its format, and whose word it goes by.
///
///     PARAMS_PLAN 1 3                          (format version 3)
///     PARAMS_PLAN 1 3 stances_only             (transitions: nothing moves between configurations)
///     PARAMS_PLAN 1 3 incomplete               (the first part of a plan: the rest was not found)
///     PARAMS_PLAN 1 3 moved_contacts 0.05 3 1  (of the scenario's start and goals: ContactMoves)
///     PARAMS_PLAN 1 3 execution_margin 0.65 0.65 0.9 0.02 0.03 0.5
///                                              (that it keeps: ExecutionMargin, in its order)
///     PARAMS_PLAN 1 3 recorded                 (no plan: what was measured when one was carried
///     out) PARAMS_SCENARIO 3 centauro_drive         (made for this scenario: a name, or a file)
///     PARAMS_CONTACTS 4 ../standing.xml        (a posture for this contacts file)
///     PARAMS_RECORD 6 ../plan.g2o              (measured when this plan was carried out)
///
/// Version 3 has slopes in its configurations; version 2, which is read as well, says nothing of
/// them. Both say where the plan stands: PARAMS_CONTACT, PARAMS_STANCE and a stance in
/// every VERTEX_CONFIGURATION. Plans of version 1, which had PARAMS_WHEELS instead, are refused.

#include <locograph/core/parameters.h>
#include <locograph/plugins/configuration/execution_margin.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace locograph {

inline constexpr int kPlanFormat = 3, kOldestPlanFormat = 2;

inline constexpr int kMostDraws = 20;

/// The contacts of a scenario's start and goals moved at random, see
/// planners/task/task_stances.h.
struct ContactMoves {
  /// As far as tasks may be moved; others are other tasks.
  static constexpr double kFurthest_m = 10.0;
  double most_m = 0.0;  ///< 0: they stay; kFurthest_m at most
  std::uint64_t seed = 0;
  int draws = 1;  ///< of the start's contacts, up to kMostDraws; the last one counts
};

struct PlanParameter final : Parameter {
  /// The configurations are transitions of a plan of stances, in order; their times mean nothing.
  bool stances_only = false;
  /// It ends before its goal.
  bool incomplete = false;
  /// It is the record of a plan carried out (planners/plan/record.h).
  bool recorded = false;
  /// It was made for a start and goals that are those of its scenario so moved.
  ContactMoves moves;
  /// By its word, but for what its start and goals do not have.
  ExecutionMargin margin = ExecutionMargin::none();

  std::string_view tag() const override { return "PARAMS_PLAN"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

/// The scenario a plan was made for.
struct ScenarioParameter final : Parameter {
  /// A name that comes with locograph, or a path, which has a `/`; in a file it is relative to it.
  std::string scenario;

  std::string_view tag() const override { return "PARAMS_SCENARIO"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

/// The contacts file that a posture was found for.
struct ContactsParameter final : Parameter {
  std::filesystem::path file;

  std::string_view tag() const override { return "PARAMS_CONTACTS"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

/// The plan that a record is of.
struct RecordParameter final : Parameter {
  std::filesystem::path plan;  ///< empty: it had no file

  std::string_view tag() const override { return "PARAMS_RECORD"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

/// Fails at the line: it is one of a plan of format version 1.
[[noreturn]] void refuse_older_plan(const FieldReader& in, std::string_view tag);

}  // namespace locograph
