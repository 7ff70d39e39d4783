#include "tools/card/card_session.hpp"

#include <fmt/format.h>

#include <charconv>
#include <sstream>
#include <string_view>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr LocalTime kPeriod = 500ms;

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return out + '"';
}

std::string axis_json(const Card::Axis& a) {
  return fmt::format(
      R"({{"drive": {}, "has_power": {}, "position_known": {}, "position_counts": {}, "run_ma": {}, "hold_ma": {}, )"
      R"("measured_ma": {}, "stage_celsius": {}, "supply_volts": {}, "error_code": {}}})",
      quoted(words_of(a.state)), a.state == cia402::State::kOperationEnabled, a.position_known,
      a.position_counts, a.run_ma, a.hold_ma, a.measured_ma, a.stage_celsius, a.supply_volts, a.error_code);
}

std::string state_json(const Card::State& s) {
  std::string switches, errors;
  for (const Card::Input& input : s.inputs)
    switches += fmt::format(R"({}{{"active": {}, "function": {}}})", switches.empty() ? "" : ", ",
                            input.active, quoted(words_of(input.function)));
  for (const std::uint16_t code : s.errors) errors += fmt::format("{}{}", errors.empty() ? "" : ", ", code);
  return fmt::format(
      R"({{"state": {{"name": {}, "serial": {}, "motors": [{}, {}], "switches": [{}], "errors": [{}]}}}})",
      quoted(s.name), s.serial, axis_json(s.axes[0]), axis_json(s.axes[1]), switches, errors);
}

std::vector<std::string> words_in(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::int64_t number_in(const std::string& word) {
  std::int64_t value = 0;
  const char* const end = word.data() + word.size();
  if (const auto [rest, error] = std::from_chars(word.data(), end, value);
      error != std::errc{} || rest != end)
    throw CardError(fmt::format("{} is no whole number", word));
  return value;
}

int axis_in(const std::string& word) {
  if (word != "A" && word != "B") throw CardError(fmt::format("motor {}; expected A or B", word));
  return word == "B" ? 1 : 0;
}

int current_in(const std::string& word) {
  constexpr std::int64_t kMost_ma = 5000;
  const std::int64_t ma = number_in(word);
  if (ma < 0 || ma > kMost_ma) throw CardError(fmt::format("{} mA; expected 0 .. {}", ma, kMost_ma));
  return static_cast<int>(ma);
}

struct Form {
  const char* verb;
  std::size_t words;
  const char* expected;
};
constexpr Form kForms[] = {{"current", 4, "current A|B RUN_MA HOLD_MA"},
                           {"on", 2, "on A|B"},
                           {"off", 2, "off A|B"},
                           {"jog", 4, "jog A|B COUNTS COUNTS_PER_S"},
                           {"stop", 1, "stop"},
                           {"tune", 2, "tune A|B"},
                           {"store", 1, "store"}};

void check_form(const std::vector<std::string>& words) {
  for (const Form& form : kForms) {
    if (words[0] != form.verb) continue;
    if (words.size() != form.words) throw CardError(fmt::format("expected: {}", form.expected));
    return;
  }
  std::string all;
  for (const Form& form : kForms) all += fmt::format("{}{}", all.empty() ? "" : ", ", form.expected);
  throw CardError(fmt::format("{} is no command; expected one of: {}", words[0], all));
}

}  // namespace

void CardSession::run() {
  tell_state();
  while (!lines_.ended()) {
    if (waiting_.empty())
      if (const auto line = lines_.next(told_ + kPeriod)) waiting_.push_back(*line);
    if (!waiting_.empty()) {
      const std::string line = waiting_.front();
      waiting_.pop_front();
      carry_out(line);
      tell_state();
    } else if (lines_.now() >= told_ + kPeriod) {
      tell_state();
    }
  }
}

void CardSession::tell_state() {
  try {
    lines_.tell(state_json(card_.state()));
  } catch (const CardError& error) {
    lines_.tell(fmt::format(R"({{"silent": {}}})", quoted(error.what())));
  }
  told_ = lines_.now();
}

void CardSession::carry_out(const std::string& line) {
  const std::vector<std::string> words = words_in(line);
  if (words.empty()) return;
  try {
    check_form(words);
    const std::string more = act(words);
    const std::string what = words.size() > 1 ? words[0] + " " + words[1] : words[0];
    lines_.tell(fmt::format(R"({{"done": {}{}}})", quoted(what), more));
  } catch (const CardError& error) {
    lines_.tell(fmt::format(R"({{"refused": {}}})", quoted(error.what())));
  }
}

std::string CardSession::act(const std::vector<std::string>& words) {
  const std::string& verb = words[0];
  if (verb == "stop") return {};  // nothing moves: while something does, stop_wanted() has it
  if (verb == "store") return card_.store(), std::string{};
  const int axis = axis_in(words[1]);
  if (verb == "current") card_.set_currents(axis, current_in(words[2]), current_in(words[3]));
  if (verb == "on" || verb == "off") card_.power(axis, verb == "on");
  if (verb == "jog") return jog(axis, number_in(words[2]), static_cast<double>(number_in(words[3])));
  if (verb != "tune") return {};
  const Card::Tuned tuned = card_.tune(axis);
  return fmt::format(R"(, "resistance_mohm": {}, "inductance_uh": {}, "encoder_offset": {})",
                     tuned.resistance_mohm, tuned.inductance_uh, tuned.encoder_offset);
}

std::string CardSession::jog(int axis, std::int64_t counts, double counts_per_s) {
  stopping_ = false;
  const std::int32_t at = card_.jog(axis, counts, counts_per_s, [this] { return stop_wanted(); });
  return fmt::format(R"(, "position_counts": {}, "stopped": {})", at, stopping_);
}

bool CardSession::stop_wanted() {
  while (const auto line = lines_.next(lines_.now())) {
    if (*line == "stop")
      stopping_ = true;
    else
      waiting_.push_back(*line);
  }
  if (lines_.ended()) stopping_ = true;
  if (lines_.now() >= told_ + kPeriod) tell_state();
  return stopping_;
}

}  // namespace kinebus
