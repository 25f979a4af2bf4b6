#include <locograph/apps/output.h>
#include <locograph/apps/plot_series.h>
#include <locograph/robots/statics.h>

#include <algorithm>

namespace locograph {
namespace {

constexpr std::size_t kNamedLines = 6;

}  // namespace

void add_lines(PlotScript& plot, const std::string& prefix, const std::vector<double>& time_s,
               std::vector<Series> series) {
  std::stable_sort(series.begin(), series.end(),
                   [](const Series& a, const Series& b) { return a.peak > b.peak; });
  const char* colors[kNamedLines] = {"'#c8372d'", "'#2f6fb5'", "'#3a9a5b'",
                                     "'#d98a1f'", "'#7a4fa3'", "'#1b9aaa'"};
  std::string command;
  for (std::size_t k = series.size(); k-- > 0;) {
    std::string rows;
    for (std::size_t i = 0; i < series[k].values.size(); ++i) {
      rows += short_number(time_s[i]) + ' ' + short_number(series[k].values[i]) + '\n';
    }
    const std::string name = prefix + std::to_string(k);
    plot.data(name, rows);
    const bool named = k < kNamedLines;
    command += (command.empty() ? "plot $" : ", $") + name + " with lines linewidth " +
               (named ? "1.8" : "0.8") + " linecolor " + (named ? colors[k] : "'#c0c4c8'") +
               (named ? " title " + PlotScript::label(series[k].name) : " notitle");
  }
  plot.line(command.empty() ? "plot 0 notitle" : command);
}

std::vector<Series> force_shares(const Robot& robot, const Motion& motion) {
  const double weight_N = robot.total_mass() * standard_gravity().norm();
  std::vector<Series> all;
  for (std::size_t i = 0; i < motion.wrenches.size(); ++i) {
    for (std::size_t c = 0; c < motion.wrenches[i].size(); ++c) {
      const Stance& stance = motion.stances[static_cast<std::size_t>(motion.stance_from[i])];
      const std::string& name = stance.contacts[c].name();
      auto found = std::ranges::find(all, name, &Series::name);
      if (found == all.end()) {
        found = all.insert(all.end(), {name, std::vector<double>(motion.wrenches.size(), 0.0)});
      }
      found->values[i] = motion.wrenches[i][c].head<3>().norm() / weight_N;
      found->peak = std::max(found->peak, found->values[i]);
    }
  }
  return all;
}

Series series_of(const std::string& name, std::vector<double> values) {
  Series series{name, std::move(values)};
  for (const double value : series.values) series.peak = std::max(series.peak, value);
  return series;
}

std::vector<Series> torque_shares(const Robot& robot, std::span<const Eigen::VectorXd> torques) {
  std::vector<Series> all;
  if (torques.empty()) return all;
  for (int j = 0; j < robot.active_joint_count(); ++j) {
    const Joint& joint = robot.active_joint(j);
    if (!std::isfinite(joint.max_effort) || !(joint.max_effort > 0.0)) continue;
    std::vector<double> values;
    for (const Eigen::VectorXd& moment : torques) {
      values.push_back(std::abs(moment[j]) / joint.max_effort);
    }
    all.push_back(series_of(joint.name, std::move(values)));
  }
  return all;
}

double highest(const std::vector<Series>& all, double at_least) {
  for (const Series& series : all) at_least = std::max(at_least, series.peak);
  return at_least;
}

std::vector<int> mark_stance_changes(PlotScript& plot, const Motion& motion) {
  constexpr int kFirstTag = 10;
  std::vector<int> tags;
  for (std::size_t i = 1; i < motion.stance_from.size(); ++i) {
    if (motion.stance_from[i] == motion.stance_from[i - 1]) continue;
    tags.push_back(kFirstTag + static_cast<int>(tags.size()));
    const std::string time = short_number(motion.time_s[i]);
    plot.line("set arrow " + std::to_string(tags.back()) + " from " + time + ", graph 0 to " +
              time + ", graph 1 nohead back linewidth 0.7 linecolor '#d0d4d8'");
  }
  return tags;
}

void limit_line(PlotScript& plot, int tag, double at) {
  plot.line("set arrow " + std::to_string(tag) + " from graph 0, first " + short_number(at) +
            " to graph 1, first " + short_number(at) +
            " nohead linewidth 1.4 dashtype 2 linecolor '#202428'");
}

void add_panel(PlotScript& plot, const std::string& title, const std::string& ylabel,
               const std::string& prefix, const std::vector<double>& time_s,
               const std::vector<Series>& series, double at_least) {
  plot.line("set title '" + title + "'");
  plot.line("set ylabel '" + ylabel + "'");
  plot.line("set yrange [0:" + short_number(1.1 * highest(series, at_least)) + "]");
  add_lines(plot, prefix, time_s, series);
}

}  // namespace locograph
