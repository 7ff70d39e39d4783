// MachineDescription to TOML: the shortest numbers that read back as the same bits.

#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machine_schema.hpp"

namespace kinebus {
namespace {

using machine_schema::Choice;
using machine_schema::Need;
using machine_schema::Range;

/// Decimal x of the fewest digits with x * unit == value.
std::string decimal(double value, double unit) {
  char text[40];
  for (int digits = 1; digits <= 17; ++digits) {
    const auto end =
        std::to_chars(text, text + sizeof text, value / unit, std::chars_format::general, digits).ptr;
    double back = 0;
    std::from_chars(text, end, back);
    // Plain to_chars picks the shorter of 300 and 3e+02.
    if (back * unit == value) return {text, std::to_chars(text, text + sizeof text, back).ptr};
  }
  // Division and product may both round: one of the neighbours reads back.
  const double quotient = value / unit;
  for (const double towards : {-HUGE_VAL, HUGE_VAL}) {
    const double x = std::nextafter(quotient, towards);
    if (x * unit == value) return {text, std::to_chars(text, text + sizeof text, x).ptr};
  }
  return {text, std::to_chars(text, text + sizeof text, quotient).ptr};
}

/// TOML basic string.
std::string basic_string(std::string_view text) {
  std::string out(1, '"');
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", static_cast<unsigned>(static_cast<unsigned char>(c)));
      out += escape;
    } else {
      out += c;
    }
  }
  out += '"';
  return out;
}

std::string list(std::span<const double> values, double unit) {
  std::string out(1, '[');
  for (const double v : values) {
    if (out.size() > 1) out += ", ";
    out += decimal(v, unit);
  }
  out += ']';
  return out;
}

class Writer {
 public:
  std::string take() { return std::move(text_); }

  void text(std::string_view key, const std::string& value, Need) { line(key, basic_string(value)); }
  void program(std::string_view key, const std::string& value) { line(key, basic_string(value)); }
  void flag(std::string_view key, bool value, Need) { line(key, value ? "true" : "false"); }
  void number(std::string_view key, double value, Range, Need, double unit = 1) {
    line(key, decimal(value, unit));
  }
  void unless_zero(std::string_view key, double value, Range, double unit) {
    if (value != 0) line(key, decimal(value, unit));
  }
  void numbers(std::string_view key, const std::vector<double>& values, Range, std::size_t, double unit) {
    if (!values.empty()) line(key, list(values, unit));
  }
  template <typename T>
  void integer(std::string_view key, T value, std::int64_t, std::int64_t, Need) {
    line(key, std::to_string(static_cast<std::int64_t>(value)));
  }
  void optional_integer(std::string_view key, const std::optional<std::uint32_t>& value) {
    if (value) line(key, std::to_string(*value));
  }
  template <typename Duration>
  void duration(std::string_view key, Duration value, std::int64_t, std::int64_t, Need) {
    line(key, std::to_string(value.count()));
  }
  template <typename T>
  bool choice(std::string_view key, T value, std::span<const Choice> choices, Need) {
    for (const Choice& c : choices)
      if (c.value == static_cast<int>(value)) line(key, basic_string(c.word));
    return true;
  }
  void leave_unjudged() {}
  void removed(std::string_view, const char*) {}
  void vector3(std::string_view key, const Vector3& v, Range, Need, double unit = 1) {
    line(key, list(v, unit));
  }
  void interval(std::string_view key, const Interval& i, Range, Need, double unit = 1) {
    if (i.limited()) line(key, list(std::array{i.min, i.max}, unit));
  }
  template <typename F>
  void table(std::string_view key, Need need, F&& content) {
    const std::string outer = path_;
    if (!path_.empty()) path_ += '.';
    path_ += key;
    pending_ = "\n[";
    pending_ += path_;
    pending_ += "]\n";
    // A node without keys of its own still needs its table; groups of tables do not.
    if (need == Need::kRequired && !outer.empty()) flush();
    content();
    path_ = outer;
    pending_.clear();
  }
  template <typename T, typename F>
  void table_unless_default(std::string_view key, T& value, F&& content) {
    if (!(value == T{})) table(key, Need::kOptional, [&] { content(value); });
  }
  template <typename F>
  void present(std::string_view key, bool is_present, F&& content) {
    if (is_present) table(key, Need::kOptional, content);
  }
  template <typename T, typename F>
  void optional_table(std::string_view key, std::optional<T>& value, F&& content) {
    if (value) table(key, Need::kOptional, [&] { content(*value); });
  }
  template <typename T, typename F>
  void named_tables(std::string_view key, std::vector<T>& all, F&& content) {
    table(key, Need::kOptional, [&] {
      for (T& one : all) table(one.name, Need::kRequired, [&] { content(one); });
    });
  }
  void retired(std::string_view, const Sentence&) {}
  void node_ids(const std::vector<NodeDescription>&) {}

 private:
  void line(std::string_view key, const std::string& value) {
    flush();
    text_ += key;
    text_ += " = ";
    text_ += value;
    text_ += '\n';
  }
  void flush() {
    text_ += pending_;
    pending_.clear();
  }

  std::string text_, path_, pending_;
};

}  // namespace

std::string write_machine(const MachineDescription& description) {
  MachineDescription d = description;
  Writer writer;
  machine_schema::visit_machine(writer, d);
  return writer.take();
}

}  // namespace kinebus
