// Words of Klipper that begin a line, and macros: START_PRINT BED=60 HOTEND=210.

#include <algorithm>
#include <cmath>
#include <optional>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/number.hpp"
#include "gateway/gcode/words/parameters.hpp"

namespace kinebus::gcode {
namespace {

constexpr int kNoteForProse = 199999;
constexpr int kNoteForCommands = 200000;  // keys of notes: behind those of codes

struct Argument {
  std::string name;  ///< in lower case
  std::string_view text;
  std::optional<double> value;
};

/// KEY=value KEY="some text"; what is not of this form is passed over.
std::vector<Argument> arguments_of(std::string_view text) {
  std::vector<Argument> all;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == ' ' || text[at] == '\t') {
      ++at;
      continue;
    }
    std::size_t end = at;
    bool quoted = false;
    for (; end < text.size() && (quoted || (text[end] != ' ' && text[end] != '\t')); ++end)
      if (text[end] == '"') quoted = !quoted;
    const std::string_view part = text.substr(at, end - at);
    at = end;
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos || equals == 0) continue;
    Argument argument{in_lower_case(part.substr(0, equals)), part.substr(equals + 1), {}};
    if (argument.text.size() > 1 && argument.text.front() == '"' && argument.text.back() == '"')
      argument.text = argument.text.substr(1, argument.text.size() - 2);
    double value = 0;
    const char* const last = argument.text.data() + argument.text.size();
    if (parse_decimal(argument.text.data(), last, value) == last) argument.value = value;
    all.push_back(std::move(argument));
  }
  return all;
}

const Argument* find_argument(const std::vector<Argument>& all, std::string_view name) {
  for (const Argument& argument : all)
    if (argument.name == name) return &argument;
  return nullptr;
}

std::optional<double> number_of(const std::vector<Argument>& all, std::string_view name) {
  const Argument* const argument = find_argument(all, name);
  return argument == nullptr ? std::nullopt : argument->value;
}

/// "Start GCode begin": a comment that lacks its semicolon, which printers' firmware tells of and passes
/// over. What may be meant as a macro (NAME, NAME WORD=1) is not.
bool is_prose(std::string_view word, std::string_view rest) {
  const auto letters = [](std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) {
      const char small = in_lower_case(c);
      return (small >= 'a' && small <= 'z') || c == ' ';
    });
  };
  const bool has_small = std::any_of(word.begin(), word.end(), [](char c) { return c >= 'a' && c <= 'z'; });
  return has_small && letters(word) && !rest.empty() && letters(rest);
}

}  // namespace

/// A code that is unknown here and that the machine file has as a macro: [macro.G1009], #<p> for P.
bool Core::call_code_macro(std::string_view line) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  const auto digit = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  std::size_t at = 0;
  const auto skip = [&](auto what) {
    while (at < line.size() && what(line[at])) ++at;
  };
  skip(blank);
  if (at < line.size() && in_lower_case(line[at]) == 'n') {
    ++at;
    skip(digit);
    skip(blank);
  }
  const std::size_t begin = at;
  if (at >= line.size() || (in_lower_case(line[at]) != 'g' && in_lower_case(line[at]) != 'm')) return false;
  ++at;
  skip(digit);
  const std::string name = in_lower_case(line.substr(begin, at - begin));
  if (find_macro(name) == nullptr) return false;
  ParameterState named;
  for (;;) {
    skip(blank);
    if (at >= line.size() || line[at] == ';' || line[at] == '*' || line[at] == '(') break;
    const char letter = in_lower_case(line[at]);
    double value = 0;
    if (letter < 'a' || letter > 'z') return false;
    const char* const after = parse_decimal(line.data() + at + 1, line.data() + line.size(), value);
    if (after != nullptr) write_named(named, std::string(1, letter), value);
    at = after != nullptr ? static_cast<std::size_t>(after - line.data()) : at + 1;
  }
  if (state_.modal.ended) begin_program();
  if (announce_) announce();
  state_.modal.content_seen = true;
  call_ = {};
  call_.what = ProgramCall::What::kMacro;
  call_.column = static_cast<std::uint32_t>(begin) + 1;
  call_.name = name;
  call_.arguments = std::move(named.locals);
  return true;
}

bool Core::run_command() {
  using What = canonical::Thermal::What;
  const std::string name = in_lower_case(block_.command);
  const std::uint32_t column = block_.command_column;
  const std::vector<Argument> arguments = arguments_of(block_.text);
  if (find_macro(name) != nullptr) {
    call_ = {};
    call_.what = ProgramCall::What::kMacro;
    call_.column = column;
    call_.name = name;
    ParameterState named;
    for (const Argument& argument : arguments)
      if (argument.value && argument.name.size() <= ParameterState::kMaxNameLength && argument.name[0] != '_')
        write_named(named, argument.name, *argument.value);
    call_.arguments = std::move(named.locals);
    return true;
  }
  const auto noted = [&] {
    std::uint32_t key = 0;
    for (const char c : name) key = key * 31 + static_cast<unsigned char>(c);
    const std::string command(block_.command);
    note(static_cast<int>(key % 1'000'000'000U) + kNoteForCommands,
         say("%1 has no effect on this machine", command));
    return true;
  };
  if (name == "set_pressure_advance" && !options_.spindle)
    return set_pressure_advance(column, number_of(arguments, "advance"), number_of(arguments, "smooth_time"));
  if (name == "set_input_shaper") {
    std::vector<ShaperWord> words;
    words.reserve(arguments.size());
    for (const Argument& argument : arguments)
      words.push_back({argument.name, argument.text, argument.value});
    return set_input_shaper(column, words);
  }
  if (name == "bed_mesh_calibrate" || name == "bed_mesh_clear" || name == "bed_mesh_map" ||
      name == "bed_mesh_output" || name == "bed_mesh_profile")
    return mesh_word(name, [&](std::string_view key) -> std::optional<std::string_view> {
      const Argument* const argument = find_argument(arguments, key);
      return argument == nullptr ? std::nullopt : std::optional(argument->text);
    });
  if (harmless_command(name) || name == "set_pressure_advance") return noted();
  if (name.starts_with("exclude_object")) {
    const Argument* const which = find_argument(arguments, "name");
    if (const Argument* const shape = find_argument(arguments, "polygon")) add_to_print_area(shape->text);
    return object_command({name, which == nullptr ? std::string() : in_lower_case(which->text),
                           number_of(arguments, "current").value_or(0) != 0,
                           number_of(arguments, "reset").value_or(0) != 0});
  }
  if (name == "set_gcode_offset") {
    for (const Argument& argument : arguments)
      if (argument.name != "move" && argument.name != "move_speed" && argument.value.value_or(0) != 0)
        return fail(column, say("%1 is not supported: write G10 L2 P0 with the values", "SET_GCODE_OFFSET"));
    return noted();
  }
  if (name == "t?") {
    emit(canonical::Message{say("load the filament, then go on").english()});
    emit(canonical::Pause{false});
    return true;
  }
  if (name == "pause" || name == "cancel_print") {
    if (name == "pause") {
      emit(canonical::Pause{false});
    } else {
      emit(canonical::End{});
      state_.modal.ended = true;
    }
    return true;
  }
  if (name == "respond") {
    if (const Argument* text = find_argument(arguments, "msg"))
      emit(canonical::Message{std::string(text->text)});
    return true;
  }
  if (name == "set_velocity_limit") {
    canonical::Limits limits;
    const auto accel = number_of(arguments, "accel");
    if (!accel) return noted();
    if (!(*accel > 0)) return fail(column, say("an acceleration must be greater than 0"));
    limits.print_accel_mm_per_s2 = limits.travel_accel_mm_per_s2 = *accel;
    emit(limits);
    return true;
  }
  if (name == "turn_off_heaters") {
    const auto off = [this](What what, int index) {
      canonical::Thermal command;
      command.what = what;
      command.index = index;
      remember(command);
      emit(command);
    };
    for (int i = 0; i < options_.hotends; ++i) off(What::kHotend, i);
    off(What::kBed, 0);
    return true;
  }
  if (name == "set_heater_temperature") {
    const Argument* const which = find_argument(arguments, "heater");
    if (which == nullptr) return fail(column, say("%1 needs %2", std::string(block_.command), "HEATER="));
    const std::string device = in_lower_case(which->text);
    canonical::Thermal command;
    command.value = number_of(arguments, "target").value_or(0);
    if (command.value < 0) return fail(column, say("a target temperature cannot be below 0 deg C"));
    if (device == "heater_bed") {
      command.what = What::kBed;
    } else if (device.starts_with("extruder")) {
      command.what = What::kHotend;
      command.index = device.size() == 9 && device[8] >= '0' && device[8] <= '9' ? device[8] - '0' : 0;
      if (command.index >= options_.hotends)
        return fail(column, say("the machine has no such tool: the last is T%1", options_.hotends - 1));
    } else {
      return noted();
    }
    remember(command);
    emit(command);
    return true;
  }
  const std::string word(block_.command);
  if (!options_.spindle && rules_->dialect != Dialect::kKlipper && is_prose(word, block_.text)) {
    note(kNoteForProse,
         say("the line begins with no code and is passed over: %1", word + " " + std::string(block_.text)));
    return true;
  }
  return fail(
      column,
      say("%1 is unknown; a macro of the printer is written as [macro.%1] in the machine file", word));
}

}  // namespace kinebus::gcode
