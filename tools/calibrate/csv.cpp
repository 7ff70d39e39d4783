#include "tools/calibrate/csv.hpp"

#include <charconv>
#include <cmath>
#include <numbers>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

constexpr std::size_t kMostRows = 200'000, kMostColumns = 64;

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t' || s.front() == '"')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r' || s.back() == '"'))
    s.remove_suffix(1);
  return s;
}

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> out;
  for (;;) {
    const std::size_t comma = line.find(',');
    out.emplace_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return out;
    line.remove_prefix(comma + 1);
  }
}

struct Unit {
  std::string_view suffix;
  double factor;
};
constexpr Unit kUnits[] = {{"_um", 1e-3},   {"_mm", 1}, {"_m", 1e3}, {"_deg", std::numbers::pi / 180},
                           {"_mrad", 1e-3}, {"_rad", 1}};

}  // namespace

std::string to_string(const CsvError& error, std::string_view file) {
  std::string out(file);
  if (error.line > 0) out += ":" + std::to_string(error.line);
  return out + ": " + error.what;
}

Result<Csv, CsvError> Csv::parse(std::string_view text) {
  Csv csv;
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> cells = split(line);
    if (cells.size() > kMostColumns) return Error<CsvError>({number, "more than 64 columns"});
    if (csv.columns_.empty()) {
      for (const std::string& cell : cells) {
        Column column{cell, 0};
        for (const Unit& unit : kUnits)
          if (column.unit == 0 && cell.size() > unit.suffix.size() && cell.ends_with(unit.suffix))
            column = {cell.substr(0, cell.size() - unit.suffix.size()), unit.factor};
        csv.columns_.push_back(column);
      }
      continue;
    }
    if (cells.size() != csv.columns_.size())
      return Error<CsvError>({number, std::to_string(cells.size()) + " values; the header has " +
                                          std::to_string(csv.columns_.size()) + " columns"});
    if (csv.cells_.size() == kMostRows) return Error<CsvError>({number, "more than 200000 lines"});
    csv.cells_.push_back(std::move(cells));
    csv.lines_.push_back(number);
  }
  if (csv.columns_.empty())
    return Error<CsvError>({0, "no header; expected names with units, such as measured_mm"});
  if (csv.cells_.empty()) return Error<CsvError>({0, "a header but no measurements"});
  return csv;
}

std::optional<std::size_t> Csv::find(std::string_view name) const {
  for (std::size_t k = 0; k < columns_.size(); ++k)
    if (columns_[k].name == name) return k;
  return std::nullopt;
}

Result<double, CsvError> Csv::number(std::size_t row, std::size_t column) const {
  const std::string& cell = cells_[row][column];
  double value = 0;
  const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (code != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value) ||
      std::abs(value) > 1e7)
    return Error<CsvError>({lines_[row], columns_[column].name + ": found \"" +
                                             std::string(cut_text(cell, 40)) + "\"; expected a number"});
  return value;
}

Result<double, CsvError> Csv::quantity(std::size_t row, std::string_view name) const {
  const auto column = find(name);
  if (!column)
    return Error<CsvError>({0, "no column " + std::string(name) + "_mm (or _um, _m, _deg, _mrad, _rad)"});
  if (columns_[*column].unit == 0)
    return Error<CsvError>(
        {0, "column " + std::string(name) + " does not say its unit: name it " + std::string(name) + "_mm"});
  auto value = number(row, *column);
  if (!value) return value;
  return *value * columns_[*column].unit;
}

Result<double, CsvError> Csv::plain(std::size_t row, std::string_view name) const {
  const auto column = find(name);
  if (!column) return Error<CsvError>({0, "no column " + std::string(name)});
  return number(row, *column);
}

std::string Csv::word(std::size_t row, std::string_view name) const {
  const auto column = find(name);
  return column ? cells_[row][*column] : std::string();
}

}  // namespace kinebus
