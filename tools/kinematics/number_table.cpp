#include "tools/kinematics/number_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

constexpr std::size_t kMostRows = 200'000, kLongestLine = 10'000;
constexpr double kLargest = 1e7;

std::vector<std::string> words_of(const std::string& line) {
  constexpr const char* kBetween = " \t\r,";
  std::vector<std::string> words;
  const std::size_t end = std::min(line.find('#'), line.size());
  for (std::size_t at = line.find_first_not_of(kBetween); at < end;
       at = line.find_first_not_of(kBetween, at)) {
    const std::size_t stop = std::min(line.find_first_of(kBetween, at), end);
    words.push_back(line.substr(at, stop - at));
    at = stop;
  }
  return words;
}

Result<double, std::string> number_of(const std::string& word) {
  const char *begin = word.data(), *end = begin + word.size();
  if (word.size() > 1 && *begin == '+' && word[1] != '-') ++begin;
  double value = 0;
  const auto [stop, code] = std::from_chars(begin, end, value);
  const std::string found = "found \"" + std::string(cut_text(word, 40)) + "\"; expected a number";
  if (code != std::errc{} || stop != end || !std::isfinite(value)) return Error<std::string>(found);
  if (std::abs(value) > kLargest) return Error<std::string>(found + " in -1e7 .. 1e7");
  return value;
}

/// The columns that the words of a first line name; none: it is a row of values.
Result<std::optional<std::vector<std::size_t>>, std::string> header_of(const std::vector<std::string>& words,
                                                                       const NumberColumns& columns) {
  std::vector<std::size_t> order;
  for (const std::string& word : words) {
    const auto known = std::find(columns.names.begin(), columns.names.end(), word);
    if (known != columns.names.end()) {
      const auto index = static_cast<std::size_t>(known - columns.names.begin());
      if (std::find(order.begin(), order.end(), index) != order.end())
        return Error<std::string>("column " + word + " stands twice");
      order.push_back(index);
    }
  }
  if (order.empty()) return std::optional<std::vector<std::size_t>>{};
  if (order.size() != words.size())
    return Error<std::string>("a column that is not known; expected " + columns.list());
  for (std::size_t k = 0; k < columns.least; ++k)
    if (std::find(order.begin(), order.end(), k) == order.end())
      return Error<std::string>("no column " + columns.names[k] + "; expected " + columns.list());
  return std::optional(order);
}

Result<std::vector<double>, std::string> values_of(std::span<const std::string> words,
                                                   std::span<const std::size_t> order,
                                                   const NumberColumns& columns) {
  std::vector<double> values(columns.names.size(), 0.0);
  for (std::size_t k = 0; k < words.size(); ++k) {
    const auto value = number_of(words[k]);
    if (!value)
      return Error<std::string>("value " + std::to_string(k + 1) + " (" + columns.names[order[k]] +
                                "): " + value.error());
    values[order[k]] = *value;
  }
  return values;
}

std::vector<std::size_t> usual_order(std::size_t count) {
  std::vector<std::size_t> order(count);
  for (std::size_t k = 0; k < count; ++k) order[k] = k;
  return order;
}

std::string wrong_count(std::size_t count, const NumberColumns& columns) {
  return std::to_string(count) + (count == 1 ? " value" : " values") + "; expected " + columns.list();
}

}  // namespace

std::string NumberColumns::list() const {
  std::string out = std::to_string(least);
  if (names.size() > least) out += " to " + std::to_string(names.size());
  out += ":";
  for (std::size_t k = 0; k < names.size(); ++k) out += k < least ? " " + names[k] : " [" + names[k] + "]";
  return out;
}

Result<NumberRow, std::string> number_row(std::span<const std::string> words, const NumberColumns& columns) {
  if (words.size() < columns.least || words.size() > columns.names.size())
    return Error<std::string>(wrong_count(words.size(), columns));
  auto values = values_of(words, usual_order(columns.names.size()), columns);
  if (!values) return Error<std::string>(values.error());
  return NumberRow{0, std::move(*values)};
}

Result<std::vector<NumberRow>, std::string> number_table(std::istream& in, const std::string& name,
                                                         const NumberColumns& columns) {
  std::vector<NumberRow> rows;
  std::optional<std::vector<std::size_t>> order;
  bool first = true;
  int number = 0;
  const auto wrong = [&](const std::string& what) {
    return Error<std::string>(name + ":" + std::to_string(number) + ": " + what);
  };
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.size() > kLongestLine) return wrong("a line of more than 10000 characters");
    const std::vector<std::string> words = words_of(line);
    if (words.empty()) continue;
    if (first) {
      first = false;
      auto header = header_of(words, columns);
      if (!header) return wrong(header.error());
      if (*header) {
        order = std::move(**header);
        continue;
      }
    }
    if (order ? words.size() != order->size()
              : words.size() < columns.least || words.size() > columns.names.size())
      return wrong(order ? std::to_string(words.size()) + " values; the header has " +
                               std::to_string(order->size()) + " columns"
                         : wrong_count(words.size(), columns));
    auto values = values_of(words, order ? *order : usual_order(columns.names.size()), columns);
    if (!values) return wrong(values.error());
    if (rows.size() == kMostRows) return wrong("more than 200000 rows");
    rows.push_back({number, std::move(*values)});
  }
  if (in.bad()) return Error<std::string>(name + ": cannot be read");
  if (rows.empty()) return Error<std::string>(name + ": no values; expected rows of " + columns.list());
  return rows;
}

}  // namespace kinebus
