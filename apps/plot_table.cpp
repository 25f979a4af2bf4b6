#include <locograph/apps/csv.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plot.h>
#include <locograph/apps/statistics.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

namespace locograph {
namespace {

/// A table with a header line; lines that begin with # are left out.
struct Table {
  std::vector<std::string> header;
  std::vector<CsvRow> rows;

  int column(const std::string& name) const {
    const auto found = std::find(header.begin(), header.end(), name);
    return found == header.end() ? -1 : static_cast<int>(found - header.begin());
  }
};

Table read_table(const std::filesystem::path& file) {
  const std::string text = read_file(file, kMostInputBytes, "a table (.csv)"), name = file.string();
  CsvReader reader(text, name);
  Table table;
  while (std::optional<CsvRow> row = reader.next()) {
    if (row->fields.front().starts_with('#')) continue;
    if (table.header.empty()) {
      table.header = std::move(row->fields);
      continue;
    }
    if (row->fields.size() != table.header.size()) {
      reader.fail(row->line, counted(static_cast<long>(row->fields.size()), "field", "fields"),
                  std::to_string(table.header.size()) + " as in the header");
    }
    table.rows.push_back(std::move(*row));
  }
  if (table.rows.empty()) {
    throw Error(name, 0, "holds no rows", "a header line and one line for each run");
  }
  return table;
}

/// Nothing for a field that is empty or a word.
std::optional<double> number(const std::string& text, const std::filesystem::path& file, int line) {
  double value = 0.0;
  const std::from_chars_result parsed =
      std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ptr != text.data() + text.size() || text.empty()) return std::nullopt;
  if (parsed.ec != std::errc() || !std::isfinite(value)) {
    throw Error(file.string(), line, "'" + text + "' is not finite", "a finite number");
  }
  return value;
}

bool is_yes(const std::string& text) { return text == "true" || text == "1" || text == "yes"; }

/// How long planning took, not how long what was planned takes.
bool is_time(const std::string& name) {
  if (name == "duration_s") return false;
  return name.starts_with("time") || name.ends_with("_s") || name.ends_with("_time");
}

/// Where a table tells which runs succeeded, as campaigns or other programs call it; else -1.
int success_column(const Table& table) {
  const int solved = table.column("solved");
  return solved >= 0 ? solved : table.column("success");
}

/// The numbers of a column, sorted; of the successful runs only when the table tells.
std::vector<double> column_values(const Table& table, std::size_t column, int success,
                                  const std::filesystem::path& file) {
  std::vector<double> values;
  for (const CsvRow& row : table.rows) {
    if (success >= 0 && !is_yes(row.fields[static_cast<std::size_t>(success)])) continue;
    const std::optional<double> value = number(row.fields[column], file, row.line);
    if (value) values.push_back(*value);
  }
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

PlotScript plot_table(const std::filesystem::path& file) {
  const Table table = read_table(file);
  const int success = success_column(table);
  std::string boxes, tics;
  int count = 0;
  double highest = 0.0;
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    if (!is_time(table.header[c])) continue;
    const std::vector<double> values = column_values(table, c, success, file);
    if (values.empty()) continue;
    // Candlesticks: x, lower quartile, minimum, p95, upper quartile, median.
    boxes += std::to_string(++count);
    for (const double p : {0.25, 0.0, 0.95, 0.75, 0.50}) {
      boxes += ' ' + short_number(percentile(values, p));
    }
    boxes += '\n';
    tics +=
        (count > 1 ? ", " : "") + PlotScript::label(table.header[c]) + ' ' + std::to_string(count);
    highest = std::max(highest, percentile(values, 0.95));
  }
  if (count == 0) {
    throw Error(file.string(), 0, "no column of times with numbers",
                "columns named time…, …_time or …_s, and solved or success");
  }
  long solved = 0;
  for (const CsvRow& row : table.rows) {
    solved += success >= 0 && is_yes(row.fields[static_cast<std::size_t>(success)]) ? 1 : 0;
  }
  const long runs = static_cast<long>(table.rows.size());
  PlotScript plot(std::max(700, 320 + 150 * count), 520);
  std::string title = file.filename().string() + ": " + counted(runs, "run", "runs");
  if (success >= 0) {
    title +=
        ", " + std::to_string(solved) + " solved (" +
        short_number(std::round(1000.0 * static_cast<double>(solved) / static_cast<double>(runs)) /
                     10.0) +
        " %)";
  }
  plot.line("set multiplot title " + PlotScript::label(title));
  plot.line("set bmargin 4");
  plot.line("set tmargin 5");
  plot.line("set xtics font ',11'");
  if (success >= 0) {
    plot.line("set lmargin screen 0.09");
    plot.line("set rmargin screen 0.22");
    plot.line("set yrange [0:" + std::to_string(runs) + "]");
    plot.line("set xrange [-0.8:1.8]");
    plot.line("set ylabel 'runs (more solved is better)'");
    plot.line("set boxwidth 0.7");
    plot.line("set xtics ('solved' 0, 'failed' 1)");
    plot.data("solved", "0 " + std::to_string(solved) + '\n');
    plot.data("failed", "1 " + std::to_string(runs - solved) + '\n');
    plot.line(
        "plot $solved with boxes linecolor '#3a9a5b' notitle, $failed with boxes linecolor "
        "'#c8372d' notitle");
    plot.line("set lmargin screen 0.30");
  } else {
    plot.line("set lmargin screen 0.10");
  }
  plot.line("set rmargin screen 0.97");
  plot.line("set xrange [0.3:" + short_number(count + 0.7) + "]");
  plot.line("set yrange [0:" + short_number(highest > 0.0 ? 1.1 * highest : 1.0) + "]");
  plot.line("set ylabel 'time [s] (lower is better)'");
  plot.line("set xtics (" + tics + ")");
  plot.line("set boxwidth 0.4");
  plot.line("set key above horizontal right");
  plot.data("times", boxes);
  plot.line(
      "plot $times using 1:2:3:4:5 with candlesticks linecolor '#2f6fb5' linewidth 1.4 "
      "fillstyle solid 0.35 title 'quartiles; whiskers: least, p95' whiskerbars 0.5, "
      "$times using 1:6:6:6:6 with candlesticks linecolor '#202428' linewidth 2.2 "
      "title 'median'");
  plot.line("unset multiplot");
  return plot;
}

}  // namespace locograph
