// TOML to MachineDescription.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machine_rules.hpp"
#include "gateway/description/machine_schema.hpp"
#include "gateway/description/toml_values.hpp"
#include "gateway/gcode/programs/recording.hpp"
#include "gateway/near_word.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

using machine_schema::Choice;
using machine_schema::Need;
using machine_schema::Range;

class Reader {
 public:
  Reader(const toml::table& root, std::string_view file) : file_(file) {
    levels_.push_back({&root, "", {}, {}, true, {}});
  }

  void finish() { end_table(); }
  MachineFileErrors take() { return std::move(errors_); }

  void text(std::string_view key, std::string& value, Need need) {
    const Sentence expected = say("a text");
    const toml::node* node = find(key, need, expected);
    if (node == nullptr) return;
    if (const auto* s = node->as_string())
      value = s->get();
    else
      wrong(key, *node, expected);
  }

  /// G-code, a line each.
  void program(std::string_view key, std::string& value) {
    text(key, value, Need::kRequired);
    const toml::node* node = level().table->get(key);
    if (node == nullptr || !node->is_string()) return;
    gcode::Recording recording;
    if (const auto lines = recording.add_macro(value); !lines)
      wrong(key, *node, say("G-code, a line each; line %1: %2", lines.error().line, lines.error().message));
  }

  void flag(std::string_view key, bool& value, Need need) {
    const Sentence expected = say("true or false");
    const toml::node* node = find(key, need, expected);
    if (node == nullptr) return;
    if (const auto* b = node->as_boolean())
      value = b->get();
    else
      wrong(key, *node, expected);
  }

  void number(std::string_view key, double& value, Range range, Need need, double unit = 1) {
    const Sentence expected = say("a number in %1", interval_text(range));
    if (const toml::node* node = find(key, need, expected))
      if (!take_number(*node, range, unit, value)) wrong(key, *node, expected);
  }

  void unless_zero(std::string_view key, double& value, Range range, double unit) {
    number(key, value, range, Need::kOptional, unit);
  }

  void numbers(std::string_view key, std::vector<double>& values, Range range, std::size_t most,
               double unit) {
    const Sentence expected = say("at most %1 numbers, each in %2", most, interval_text(range));
    const toml::node* node = find(key, Need::kOptional, expected);
    if (node == nullptr) return;
    const auto* array = node->as_array();
    if (array == nullptr || array->size() > most) return wrong(key, *node, expected);
    std::vector<double> read(array->size());
    for (std::size_t k = 0; k < read.size(); ++k)
      if (!take_number((*array)[k], range, unit, read[k])) return wrong(key, *node, expected);
    values = std::move(read);
  }

  template <typename T>
  void integer(std::string_view key, T& value, std::int64_t low, std::int64_t high, Need need) {
    const Sentence expected = say("a whole number in %1 .. %2", low, high);
    const toml::node* node = find(key, need, expected);
    if (node == nullptr) return;
    const auto* i = node->as_integer();
    if (i != nullptr && i->get() >= low && i->get() <= high)
      value = static_cast<T>(i->get());
    else
      wrong(key, *node, expected);
  }

  void optional_integer(std::string_view key, std::optional<std::uint32_t>& value) {
    std::uint32_t read = 0;
    if (level().table->contains(key)) {
      integer(key, read, 0, 0xFFFFFFFF, Need::kOptional);
      value = read;
    } else {
      level().known.insert(std::string(key));
    }
  }

  template <typename Duration>
  void duration(std::string_view key, Duration& value, std::int64_t low, std::int64_t high, Need need) {
    std::int64_t count = value.count();
    integer(key, count, low, high, need);
    value = Duration{static_cast<typename Duration::rep>(count)};
  }

  template <typename T>
  bool choice(std::string_view key, T& value, std::span<const Choice> choices, Need need) {
    std::string words;
    for (const Choice& c : choices) words += (words.empty() ? "\"" : " \"") + std::string(c.word) + "\"";
    const Sentence expected = say("one of %1", words);
    const toml::node* node = find(key, need, expected);
    if (node == nullptr) return need == Need::kOptional;
    if (const auto* s = node->as_string())
      for (const Choice& c : choices)
        if (c.word == s->get()) {
          value = static_cast<T>(c.value);
          return true;
        }
    wrong(key, *node, expected);
    return false;
  }

  void vector3(std::string_view key, Vector3& value, Range range, Need need, double unit = 1) {
    const Sentence expected = say("three numbers, each in %1", interval_text(range));
    if (const toml::node* node = find(key, need, expected))
      if (!take_numbers(*node, range, unit, value)) wrong(key, *node, expected);
  }

  void interval(std::string_view key, Interval& value, Range range, Need need, double unit = 1) {
    const Sentence expected = say("[least, most], least below most, in %1", interval_text(range));
    const toml::node* node = find(key, need, expected);
    if (node == nullptr) return;
    std::array<double, 2> ends{};
    if (take_numbers(*node, range, unit, ends) && ends[0] < ends[1])
      value = {ends[0], ends[1]};
    else
      wrong(key, *node, expected);
  }

  template <typename F>
  void table(std::string_view key, Need need, F&& content) {
    const Sentence expected = say("a table, [%1]", path(key));
    const toml::node* node = find(key, need, expected);
    if (node == nullptr) return;
    if (const auto* t = node->as_table()) {
      levels_.push_back({t, path(key), {}, {}, true, {}});
      content();
      end_table();
    } else {
      wrong(key, *node, expected);
    }
  }

  template <typename T, typename F>
  void table_unless_default(std::string_view key, T& value, F&& content) {
    table(key, Need::kOptional, [&] { content(value); });
  }

  template <typename F>
  void present(std::string_view key, bool& is_present, F&& content) {
    is_present = level().table->contains(key);
    table(key, Need::kOptional, content);
  }

  template <typename T, typename F>
  void optional_table(std::string_view key, std::optional<T>& value, F&& content) {
    table(key, Need::kOptional, [&] {
      value.emplace();
      content(*value);
    });
  }

  /// A table of tables, each of them named by its key, in the order of the names.
  template <typename T, typename F>
  void named_tables(std::string_view key, std::vector<T>& all, F&& content) {
    all.clear();
    table(key, Need::kOptional, [&] {
      constexpr std::size_t kMost = 32, kLongestName = 32;
      level().others =
          say("at most %1 tables with names of 1 .. %2 letters, digits, - and _", kMost, kLongestName);
      for (const auto& [name, node] : *level().table) {
        const std::string_view text = name.str();
        const bool plain = std::all_of(text.begin(), text.end(), [](char c) {
          return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                 c == '_';
        });
        if (!plain || text.empty() || text.size() > kLongestName || all.size() == kMost) continue;
        T& made = all.emplace_back();
        made.name = text;
        table(text, Need::kRequired, [&] { content(made); });
      }
    });
  }

  /// A key of earlier files: refused with what stands for it now.
  void retired(std::string_view key, const Sentence& instead) {
    level().known_before.insert(std::string(key));
    if (const toml::node* node = level().table->get(key)) wrong(key, *node, instead);
  }

  void node_ids(std::vector<NodeDescription>& nodes) {
    nodes.clear();
    level().others = say("a node id in 1 .. 126");
    for (const auto& [key, node] : *level().table) {
      const std::string_view text = key.str();
      unsigned id = 0;
      const auto end = std::from_chars(text.data(), text.data() + text.size(), id).ptr;
      if (end != text.data() + text.size() || id < 1 || id > 126 || std::to_string(id) != text) continue;
      nodes.push_back({.id = static_cast<std::uint8_t>(id), .vendor = {}, .product = {}, .serial = {}});
    }
    std::sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  }

  /// A key of older files: `expected`, a phrase, says what to do.
  void removed(std::string_view key, const char* expected) {
    level().removed.insert(std::string(key));
    if (const toml::node* node = find(key, Need::kOptional, {})) wrong(key, *node, say(expected));
  }

  /// What this table may hold is not known, because something before it was wrong.
  void leave_unjudged() {
    level().judged = false;
    failed_.insert(level().path);
  }

  void rule(const BrokenRule& broken) {
    // A rule about a value that could not be read would only confuse.
    for (const std::string& key : broken.keys)
      for (const std::string& failed : failed_)
        if (failed == key || failed.starts_with(key + ".") || key.starts_with(failed + ".")) return;
    errors_.push_back(
        {file_, line_of(broken.keys.front()), broken.keys.front(), broken.found, broken.expected});
  }

 private:
  struct Level {
    const toml::table* table;
    std::string path;
    std::set<std::string> known;
    std::set<std::string> removed;
    bool judged;
    Sentence others{};                        // what keys the table takes besides the known ones
    std::set<std::string> known_before = {};  // and are refused with what stands for them now
  };

  Level& level() { return levels_.back(); }
  std::string path(std::string_view key) {
    return level().path.empty() ? std::string(key) : level().path + "." + std::string(key);
  }

  const toml::node* find(std::string_view key, Need need, const Sentence& expected) {
    level().known.insert(std::string(key));
    const std::string full = path(key);
    const toml::node* node = level().table->get(key);
    if (node != nullptr) {
      lines_[full] = node->source().begin.line;
    } else if (need == Need::kRequired) {
      failed_.insert(full);
      errors_.push_back({file_, line_of(full), full, {}, expected});
    }
    return node;
  }

  void wrong(std::string_view key, const toml::node& node, const Sentence& expected) {
    failed_.insert(path(key));
    errors_.push_back({file_, node.source().begin.line, path(key), shown(node), expected});
  }

  /// Where a key is, or the nearest table around it that is in the file.
  std::uint32_t line_of(std::string key) const {
    for (;;) {
      if (const auto it = lines_.find(key); it != lines_.end()) return it->second;
      const std::size_t dot = key.rfind('.');
      if (dot == std::string::npos) return 1;
      key.resize(dot);
    }
  }

  void end_table() {
    const Level& l = level();
    if (l.judged)
      for (const auto& [key, node] : *l.table)
        if (!l.known.contains(std::string(key.str())) && !l.known_before.contains(std::string(key.str())))
          unknown(key, l);
    levels_.pop_back();
  }

  void unknown(const toml::key& key, const Level& l) {
    const std::string_view name = cut_text(key.str(), kMaxNameBytes);
    std::vector<std::string_view> keys;
    std::string all;
    for (const std::string& k : l.known) {
      if (l.removed.contains(k)) continue;
      all += (all.empty() ? "" : ", ") + k;
      keys.emplace_back(k);
    }
    const std::string_view nearest = near_word(keys, name);
    const std::string full = l.path.empty() ? std::string(name) : l.path + "." + std::string(name);
    Sentence expected = l.others;
    if (expected.empty()) expected = !nearest.empty() ? say("perhaps %1", nearest) : say("one of %1", all);
    errors_.push_back(
        {file_, key.source().begin.line, full, say("a key that does not exist"), std::move(expected)});
  }

  std::string file_;
  std::vector<Level> levels_;
  MachineFileErrors errors_;
  std::map<std::string, std::uint32_t> lines_;
  std::set<std::string> failed_;
};

}  // namespace

Result<MachineDescription, MachineFileErrors> parse_machine(std::string_view text, std::string_view name) {
  const auto control = std::find_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F;
  });
  if (control != text.end())
    return Error<MachineFileErrors>(
        {{std::string(name), static_cast<std::uint32_t>(1 + std::count(text.begin(), control, '\n')), "",
          say("a control character"), say("printable text, tabs and line ends")}});
  const toml::parse_result parsed = toml::parse(text, name);
  if (!parsed) {
    const toml::parse_error& e = parsed.error();
    return Error<MachineFileErrors>(
        {{std::string(name), e.source().begin.line, "",
          say("no valid TOML: %1", std::string(e.description())), Sentence::verbatim("TOML 1.0")}});
  }
  MachineDescription description;
  Reader reader(parsed.table(), name);
  machine_schema::visit_machine(reader, description);
  reader.finish();
  if (!description.joints.empty()) {
    machine_schema::connect_travel(description);
    for (const BrokenRule& broken : broken_rules(description)) reader.rule(broken);
  }
  MachineFileErrors errors = reader.take();
  if (errors.empty()) return description;
  std::stable_sort(errors.begin(), errors.end(),
                   [](const auto& a, const auto& b) { return a.line < b.line; });
  return Error<MachineFileErrors>(std::move(errors));
}

}  // namespace kinebus
