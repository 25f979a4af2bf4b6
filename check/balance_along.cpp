#include <locograph/check/balance_along.h>
#include <locograph/check/limits.h>

#include <algorithm>
#include <atomic>
#include <limits>

namespace locograph {
namespace {

/// Vertices and steps that one thread judges in a row.
constexpr std::size_t kPiece = 32;

}  // namespace

BalanceAlong::BalanceAlong(CheckContext& context)
    : context_(context),
      found_(context.vertices()),
      static_balance_("static_balance", "1", context.options.min_balance_margin, Worse::kLower,
                      context.vertices(), limits::kBalanceRounding),
      torque_limits_("torque_limits", "ratio", 1.0, Worse::kHigher, context.vertices(),
                     context.options.enforce_torque_limits
                         ? limits::kBalanceRounding
                         : std::numeric_limits<double>::infinity()) {}

void BalanceAlong::run(ThreadPool& threads) {
  if (!context_.robot.floating_base() || !(context_.robot.total_mass() > 0.0)) return;
  const auto in_pieces = [&](std::size_t count, const auto& judge) {
    std::atomic<std::size_t> next{0};
    threads.run(threads.size(), [&](int thread) {
      std::unique_ptr<BalanceWorker>& worker = workers_[static_cast<std::size_t>(thread)];
      for (std::size_t piece; (piece = next++) < count;) {
        if (worker == nullptr) worker = std::make_unique<BalanceWorker>(context_);
        judge(*worker, piece * kPiece);
      }
    });
  };
  workers_.resize(static_cast<std::size_t>(threads.size()));
  const std::size_t vertices = context_.vertices(), pieces = (vertices + kPiece - 1) / kPiece;
  for (const bool prove_nearby : {context_.options.prove_nearby, false}) {
    found_ = BalanceFindings(vertices);
    found_.prove_nearby = prove_nearby;
    // Nothing is known yet, and nothing of each other.
    in_pieces(pieces, [&](BalanceWorker& worker, std::size_t first) {
      worker.judge_vertices(first, first + 1, found_);
    });
    know(found_.at_vertices);
    in_pieces(pieces, [&](BalanceWorker& worker, std::size_t first) {
      worker.judge_vertices(first + 1, std::min(first + kPiece, vertices), found_);
    });
    know(found_.at_vertices);
    for (const double half_m : found_.half_m)
      found_.smallest_half_m = std::min(found_.smallest_half_m, half_m);
    in_pieces(pieces, [&](BalanceWorker& worker, std::size_t first) {
      worker.judge_steps(first, std::min(first + kPiece, vertices - 1), found_);
    });
    // Where a programme failed, all are to be seen.
    if (!prove_nearby || (all_verified(found_.at_vertices) && all_verified(found_.in_steps))) break;
  }
  for (const BalanceFindings::List& findings : found_.at_vertices) record(findings);
  tell();
  for (const BalanceFindings::List& findings : found_.in_steps) record(findings);
}

void BalanceAlong::know(const std::vector<BalanceFindings::List>& all) {
  for (const BalanceFindings::List& findings : all)
    for (const BalanceFinding& finding : findings) found_.known.add(finding);
}

bool BalanceAlong::all_verified(const std::vector<BalanceFindings::List>& all) {
  return std::ranges::all_of(all, [](const BalanceFindings::List& findings) {
    return std::ranges::all_of(findings, &BalanceFinding::verified);
  });
}

void BalanceAlong::record(const BalanceFindings::List& findings) {
  for (const auto& [certificate, stance, vertex, time_s, place, torques] : findings) {
    const auto limiting = [&certificate = certificate] { return certificate.limiting; };
    bool worst = static_balance_.add(certificate.margin, vertex, time_s, place, limiting);
    // A margin without wrenches that could be verified is no proof.
    if (!certificate.balanced && certificate.margin >= -limits::kBalanceRounding)
      worst = static_balance_.add(std::numeric_limits<double>::quiet_NaN(), vertex, time_s, place,
                                  [] { return std::string("the wrenches could not be verified"); });
    if (worst || !worst_) worst_ = certificate;
    if (!certificate.balanced || !torques) continue;
    torque_limits_.add(
        certificate.max_torque_ratio, vertex, time_s, place, [&certificate = certificate] {
          return std::string(
              certificate.max_torque_ratio == 0.0 ? "no joint that is loaded has a limit" : "");
        });
  }
}

void BalanceAlong::tell() const {
  if (!context_.options.on_balance) return;
  for (std::size_t i = 0; i < found_.wrenches.size(); ++i)
    if (!found_.wrenches[i].empty())
      context_.options.on_balance(static_cast<int>(i), found_.wrenches[i]);
}

void BalanceAlong::report(std::vector<Violation>& violations) const {
  std::string why = "no stance is known";
  if (!(context_.robot.total_mass() > 0.0)) why = "no link has a mass";
  if (!context_.robot.floating_base()) why = "the base is fixed to the world";
  violations.push_back(static_balance_.result(why));
  violations.push_back(
      torque_limits_.result(static_balance_.empty() ? why : "nothing balances the robot"));
}

std::optional<double> BalanceAlong::min_margin() const {
  if (static_balance_.empty()) return std::nullopt;
  return static_balance_.worst();
}

std::optional<double> BalanceAlong::max_torque_ratio() const {
  if (torque_limits_.empty()) return std::nullopt;
  return torque_limits_.worst();
}

}  // namespace locograph
