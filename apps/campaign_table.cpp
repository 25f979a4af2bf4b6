#include <locograph/apps/campaign_table.h>
#include <locograph/apps/csv.h>
#include <locograph/apps/statistics.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <system_error>

namespace locograph {
namespace {

enum Column { kScenario, kPlanner, kOptions, kSeed, kSolved, kReason, kFirstQuantity };
constexpr std::size_t kColumns = kFirstQuantity + kCampaignQuantities.size();

std::vector<std::string> column_names() {
  std::vector<std::string> names = {"scenario", "planner", "options", "seed", "solved", "reason"};
  for (const CampaignQuantity& quantity : kCampaignQuantities) names.emplace_back(quantity.name);
  return names;
}

/// As few digits as give the same bits again.
std::string exact_number(const std::optional<double>& value) {
  if (!value) return "";
  std::array<char, 32> text{};
  return std::string(text.data(),
                     std::to_chars(text.data(), text.data() + text.size(), *value).ptr);
}

template <class Number>
std::optional<Number> number_in(const std::string& text) {
  Number value = {};
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The run in a row of as many fields as there are columns.
CampaignRun run_in(const CsvRow& row, const CsvReader& reader) {
  CampaignRun run;
  run.planner = row.fields[kPlanner];
  const std::optional<unsigned> seed = number_in<unsigned>(row.fields[kSeed]);
  if (!seed) reader.fail(row.line, "the seed '" + row.fields[kSeed] + "'", "a whole number");
  run.seed = *seed;
  const std::string& solved = row.fields[kSolved];
  if (solved != "true" && solved != "false") {
    reader.fail(row.line, "'" + solved + "' under solved", "true or false");
  }
  run.solved = solved == "true";
  run.reason = row.fields[kReason];
  for (std::size_t q = 0; q < kCampaignQuantities.size(); ++q) {
    const std::string& field = row.fields[kFirstQuantity + q];
    if (field.empty()) continue;
    run.values[q] = number_in<double>(field);
    if (!run.values[q] || !std::isfinite(*run.values[q])) {
      reader.fail(row.line, "'" + field + "' under " + kCampaignQuantities[q].name,
                  "a finite number, or nothing");
    }
  }
  return run;
}

}  // namespace

CampaignRun campaign_run(const Json& plan, unsigned seed, const std::string& planner) {
  try {
    CampaignRun run;
    run.seed = seed;
    run.solved = plan.at("success").get<bool>();
    run.reason = plan.at("reason").get<std::string>();
    run.planner = plan.value("planner", planner);
    for (std::size_t q = 0; q < kCampaignQuantities.size(); ++q) {
      const Json::json_pointer place(kCampaignQuantities[q].place);
      if (!plan.contains(place) || plan.at(place).is_null()) continue;
      const Json& told = plan.at(place);
      run.values[q] = told.is_boolean() ? (told.get<bool>() ? 1.0 : 0.0) : told.get<double>();
    }
    return run;
  } catch (const Json::exception& wrong) {
    throw Error(
        "the run with seed " + std::to_string(seed) + " printed something else: " + wrong.what(),
        "what `locograph plan --json` prints");
  }
}

const std::string& CampaignTable::planner() const {
  return runs_.empty() ? setting_.planner : runs_.begin()->second.planner;
}

void CampaignTable::add(CampaignRun run) {
  if (has(run.seed)) throw Error("a second run with seed " + std::to_string(run.seed));
  if (!runs_.empty() && run.planner != planner()) {
    throw Error("the planner of seed " + std::to_string(run.seed) + " is '" + run.planner + "'",
                "'" + planner() + "' as for the other runs");
  }
  const unsigned seed = run.seed;
  runs_.emplace(seed, std::move(run));
}

void CampaignTable::read(const std::filesystem::path& file) {
  const std::string text = read_file(file, kMostInputBytes, "a campaign's table (.csv)");
  const std::string name = file.string();
  if (text.empty()) return;
  CsvReader reader(text, name);
  const std::vector<std::string> names = column_names();
  const std::optional<CsvRow> header = reader.next();
  if (!header || header->fields != names) {
    std::string expected = csv_line(names);
    expected.pop_back();
    // Columns are only ever added, behind the others.
    const bool older = header && header->fields.size() < names.size() &&
                       header->fields.size() > kFirstQuantity &&
                       std::equal(header->fields.begin(), header->fields.end(), names.begin());
    if (older) {
      reader.fail(header->line,
                  "the table of an older version, without " + names[header->fields.size()],
                  "another file, or none, for the seeds to be run again");
    }
    reader.fail(header ? header->line : 1, "other columns than a campaign's", expected);
  }
  while (const std::optional<CsvRow> row = reader.next()) {
    if (row->fields.size() != kColumns) {
      reader.fail(row->line, counted(static_cast<long>(row->fields.size()), "field", "fields"),
                  std::to_string(kColumns) + " as in the header");
    }
    const auto require = [&](Column column, const std::string& asked) {
      if (row->fields[column] == asked) return;
      reader.fail(row->line, "a run with the " + names[column] + " '" + row->fields[column] + "'",
                  "'" + asked + "' as for this campaign, or another file");
    };
    require(kScenario, setting_.scenario);
    if (!setting_.planner.empty()) require(kPlanner, setting_.planner);
    require(kOptions, setting_.options);
    CampaignRun run = run_in(*row, reader);
    if (has(run.seed)) {
      reader.fail(row->line, "a second run with seed " + std::to_string(run.seed),
                  "one for a seed");
    }
    if (!runs_.empty()) require(kPlanner, planner());
    add(std::move(run));
  }
}

std::string CampaignTable::csv() const {
  std::string text = csv_line(column_names());
  for (const auto& [seed, run] : runs_) {
    std::vector<std::string> fields = {setting_.scenario,
                                       run.planner,
                                       setting_.options,
                                       std::to_string(seed),
                                       run.solved ? "true" : "false",
                                       run.reason};
    for (const std::optional<double>& value : run.values) fields.push_back(exact_number(value));
    text += csv_line(fields);
  }
  return text;
}

Json campaign_statistics(const std::vector<CampaignRun>& runs, std::size_t quantity) {
  std::vector<double> values;
  for (const CampaignRun& run : runs) {
    if (run.solved && run.values[quantity]) values.push_back(*run.values[quantity]);
  }
  if (values.empty()) {
    return {
        {"mean", nullptr}, {"std", nullptr}, {"p50", nullptr}, {"p95", nullptr}, {"max", nullptr}};
  }
  std::sort(values.begin(), values.end());
  const double count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {{"mean", mean},
          {"std", values.size() > 1 ? Json(std::sqrt(squares / (count - 1.0))) : Json(nullptr)},
          {"p50", percentile(values, 0.50)},
          {"p95", percentile(values, 0.95)},
          {"max", values.back()}};
}

}  // namespace locograph
