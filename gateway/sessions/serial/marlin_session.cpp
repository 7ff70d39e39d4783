#include "gateway/sessions/serial/marlin_session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "gateway/gcode/codes.hpp"
#include "gateway/sessions/serial/line_control.hpp"

namespace kinebus {
namespace {

using serial::Code;
using serial::Line;
using serial::Urgent;

/// Lines kept; a host that waits for "ok" never has so many under way.
constexpr std::size_t kMostLines = 256;
constexpr std::size_t kMostOutput = 256U << 10U;
/// How often a waiting line is asked again.
constexpr LocalTime kPoll = std::chrono::milliseconds{4};
constexpr LocalTime kHeatReport = std::chrono::seconds{1};

bool halted_state(MachineState state) {
  return state == MachineState::kStopping || state == MachineState::kStopped || state == MachineState::kAlarm;
}

LocalTime seconds(double value) {
  return LocalTime{static_cast<std::int64_t>(std::clamp(value, 0.0, 3600.0) * 1e9)};
}

/// Lines that need the machine to be open for motion; all others are only modes and settings.
bool moves(std::string_view text) {
  const Code code = serial::code_of(text);
  if (code.letter == 'G') {
    static constexpr std::array kModal{15, 17, 18, 19, 20, 21, 40, 43, 49, 54, 55, 56, 57, 58,
                                       59, 61, 64, 68, 69, 80, 90, 91, 92, 93, 94, 98, 99};
    return std::find(kModal.begin(), kModal.end(), code.number) == kModal.end() ||
           text.find_first_of("XYZACEIJxyzaceij") != std::string_view::npos;
  }
  if (code.letter == 'M') {
    static constexpr std::array kCarriedOut{0, 1, 2, 30, 400};
    return std::find(kCarriedOut.begin(), kCarriedOut.end(), code.number) != kCarriedOut.end();
  }
  return code.letter != 'T' && code.letter != 0 && code.letter != '(' && code.letter != '#';
}

/// "ok" means that they are carried out, not only taken.
bool waits_for_end(const Code& code) {
  return code.is('G', 28) || code.is('G', 4) || code.is('M', 400) || code.is('M', 109) || code.is('M', 190) ||
         code.is('M', 0) || code.is('M', 1) || code.is('M', 2) || code.is('M', 30);
}

}  // namespace

MarlinSession::MarlinSession(Gateway& gateway, SerialFiles& files, Options options)
    : gateway_(gateway), files_(files), options_(std::move(options)) {
  say("start");
  say("echo:Kinebus gateway on a serial line, Marlin's dialect");
}

MarlinSession::~MarlinSession() {
  leave();
}

// Output
// -------------------------------------------------------------------------------------------------------

void MarlinSession::say(std::string_view line) {
  if (out_.size() - out_sent_ > kMostOutput) {
    // Nobody reads: what is old is of no use to the next who does.
    out_.clear();
    out_sent_ = 0;
    temperature_period_ = progress_period_ = LocalTime{0};
  }
  for (const char c : line) out_ += c == '\0' ? ' ' : c;
  out_ += '\n';
}

void MarlinSession::say_ok(const Line& line) {
  std::string text = "ok";
  if (line.number) text += " N" + std::to_string(*line.number);
  const std::size_t room = mine_ ? gateway_.line_room() : Gateway::kLineRoom;
  const std::size_t waiting = lines_.empty() ? 0 : lines_.size() - 1;
  text += " P" + std::to_string(room) + " B" +
          std::to_string(options_.line_buffer - std::min(options_.line_buffer, waiting));
  say(text);
}

std::span<const std::uint8_t> MarlinSession::next_bytes() {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(out_.data());
  return {begin + out_sent_, out_.size() - out_sent_};
}

void MarlinSession::on_bytes_sent(std::size_t count) {
  out_sent_ += std::min(count, out_.size() - out_sent_);
  if (out_sent_ < out_.size()) return;
  out_.clear();
  out_sent_ = 0;
}

// Input
// --------------------------------------------------------------------------------------------------------

bool MarlinSession::wants_bytes() const {
  return lines_.size() < kMostLines;
}

void MarlinSession::on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) {
  now_ = std::max(now_, now);
  reader_.on_bytes(now_, bytes);
  work(now_);
}

void MarlinSession::see_urgent(LocalTime now, Urgent what) {
  switch (what) {
    case Urgent::kNone:
      return;
    case Urgent::kEmergencyStop:
      lines_.clear();
      stop_waiting();
      halted_ = true;
      static_cast<void>(gateway_.stop());
      say("Error:Printer halted. kill() called!");
      return;
    case Urgent::kQuickStop:
      lines_.clear();
      stop_waiting();
      if (mine_) static_cast<void>(gateway_.cancel());
      mine_ = false;
      return;
    case Urgent::kGoOn:
      if (wait_ == Wait::kHeater) stop_waiting();
      if (gateway_.state() == MachineState::kHeld && may_command()) static_cast<void>(gateway_.resume());
      next_busy_ = now + options_.keep_alive;
      return;
  }
}

void MarlinSession::stop_waiting() {
  wait_ = Wait::kNone;
  homing_ = heats_ = false;
}

void MarlinSession::on_time(LocalTime now) {
  now_ = std::max(now_, now);
  reader_.on_time(now_);
  work(now_);
  report(now_);
}

LocalTime MarlinSession::next_deadline() const {
  LocalTime due = reader_.next_deadline();
  if (!lines_.empty()) due = std::min(due, now_ + kPoll);
  if (mine_ || file_runs_) due = std::min(due, now_ + std::chrono::milliseconds{50});
  if (temperature_period_ > LocalTime{0} || heats_) due = std::min(due, next_temperature_);
  if (progress_period_ > LocalTime{0}) due = std::min(due, next_progress_);
  if (client_ != 0 && idle())
    due = std::min(
        {due, last_line_ + options_.gone_after, has_control() ? last_command_ + options_.close_after : due});
  return due;
}

void MarlinSession::work(LocalTime now) {
  watch_others();
  while (auto line = reader_.next()) {
    ++counters_.lines;
    last_line_ = now;
    heard();
    if (lines_.empty()) next_busy_ = now + options_.keep_alive;
    const Urgent what = line->error.empty() && !line->repeated && writing_.empty()
                            ? serial::urgent(line->text)
                            : Urgent::kNone;
    see_urgent(now, what);
    lines_.push_back(std::move(*line));
  }
  while (!lines_.empty()) {
    const Done done = wait_ != Wait::kNone ? wait_over() : carry_out(lines_.front());
    if (done == Done::kWaiting) break;
    if (done == Done::kYes) say_ok(lines_.front());
    if (serial::changes_machine(serial::code_of(lines_.front().text))) last_command_ = now;
    lines_.pop_front();
    last_line_ = now;
    next_busy_ = now + options_.keep_alive;
  }
  if (!lines_.empty() && options_.keep_alive > LocalTime{0} && now >= next_busy_) {
    next_busy_ = now + options_.keep_alive;
    say(gateway_.state() == MachineState::kHeld ? "echo:busy: paused for user" : "echo:busy: processing");
  }
  if (mine_ && lines_.empty() && now - last_command_ >= options_.close_after && gateway_.lines_idle()) {
    gateway_.close_lines();
    mine_ = false;
  }
  come_and_go();
}

/// Others hold, cancel or stop what this session's lines move; its host is told.
void MarlinSession::watch_others() {
  const MachineState state = gateway_.state();
  if (file_runs_ && (state == MachineState::kReady || halted_state(state))) {
    file_runs_ = false;
    if (state == MachineState::kReady) say("Done printing file");
  }
  if (!mine_) return;
  const bool held = state == MachineState::kHeld || state == MachineState::kHolding;
  if (held != held_told_) say(held ? "//action:paused" : "//action:resumed");
  held_told_ = held;
  if (gateway_.lines_open()) return;
  // M2 and M30 end the program: the next line opens it again.
  const bool ended = state == MachineState::kReady || state == MachineState::kRunning;
  mine_ = false;
  if (ended) return;
  stop_waiting();
  dropped_ = true;
  if (!halted_) say("//action:cancel");
}

void MarlinSession::report(LocalTime now) {
  const LocalTime period = heats_ ? kHeatReport : temperature_period_;
  if (period > LocalTime{0} && now >= next_temperature_) {
    next_temperature_ = now + period;
    say(" " + temperatures());
  }
  if (progress_period_ > LocalTime{0} && now >= next_progress_) {
    next_progress_ = now + progress_period_;
    say(file_progress());
  }
}

void MarlinSession::on_closed(LocalTime now, std::string_view) {
  now_ = std::max(now_, now);
  lines_.clear();
  stop_waiting();
  // What was taken is still moved; then the machine rests, at a place of the path.
  if (mine_) gateway_.close_lines();
  mine_ = false;
  leave();
}

void MarlinSession::on_event(const MachineEvent& event) {
  switch (event.kind) {
    case MachineEvent::Kind::kMessage:
      say("echo:" + event.words);
      break;
    case MachineEvent::Kind::kProblem:
      if (file_runs_) say("echo:line " + std::to_string(event.line) + ": " + event.words);
      break;
    case MachineEvent::Kind::kAlarm:
      say("Error:" + event.words + (event.advice.empty() ? "" : " " + event.advice));
      break;
    case MachineEvent::Kind::kFinished:
      if (file_runs_) say("echo:" + event.words);
      break;
    case MachineEvent::Kind::kState:
      break;
  }
}

// Lines
// --------------------------------------------------------------------------------------------------------

MarlinSession::Done MarlinSession::refuse(std::string_view words) {
  ++counters_.refused;
  say("Error:" + std::string(words));
  return Done::kYes;
}

MarlinSession::Done MarlinSession::carry_out(const Line& line) {
  if (!line.error.empty()) {
    ++counters_.resends;
    say("Error:" + line.error);
    say("Resend: " + std::to_string(line.resend));
    say("ok");
    return Done::kSilent;
  }
  if (line.repeated) return Done::kYes;
  const Code code = serial::code_of(line.text);
  if (!writing_.empty() && !code.is('M', 29)) {
    write_line(line);
    return Done::kYes;
  }
  if (code.letter == 0 || code.letter == ';' || code.letter == '%') return Done::kYes;
  if (halted_ && !code.is('M', 999)) {
    if (!halted_state(gateway_.state())) {
      halted_ = false;  // others cleared it
    } else {
      if (serial::urgent(line.text) != Urgent::kNone) return Done::kYes;
      return refuse("Printer halted. M999 lifts the stop");
    }
  }
  if (serial::changes_machine(code) && !may_command()) return refuse(no_control());
  if (code.letter == 'M' && code.number >= 0) return carry_out_m(line, code.number);
  return to_machine(line);
}

MarlinSession::Done MarlinSession::query(const Line& line) {
  const auto answer = gateway_.text_line(line.text);
  if (!answer) return refuse(answer.error().words);
  if (!answer->empty()) say(*answer);
  return Done::kYes;
}

std::string MarlinSession::temperatures() const {
  const MachineStatus s = gateway_.status();
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "T:%.2f /%.2f B:%.2f /%.2f @:0 B@:0", s.hotend.actual_celsius,
                s.hotend.target_celsius, s.bed.actual_celsius, s.bed.target_celsius);
  return text.data();
}

MarlinSession::Done MarlinSession::carry_out_m(const Line& line, int number) {
  switch (number) {
    case 20:
    case 21:
    case 22:
    case 23:
    case 24:
    case 25:
    case 26:
    case 27:
    case 28:
    case 29:
    case 30:
    case 31:
    case 32:
    case 524:
      return file_code(line, number);
    case 105:
      say("ok " + temperatures());
      return Done::kSilent;
    case 108:
    case 112:
    case 410:
      return Done::kYes;  // seen when they came
    case 110:
      dropped_ = false;
      return Done::kYes;
    case 113:
      if (const auto s = serial::word(line.text, 'S')) options_.keep_alive = seconds(*s);
      return Done::kYes;
    case 114:
    case 119:
      return query(line);
    case 115: {
      if (const Done done = query(line); done != Done::kYes) return done;
      for (const char* capability :
           {"SERIAL_XON_XOFF:0", "EEPROM:0", "VOLUMETRIC:0", "AUTOREPORT_POS:0", "AUTOREPORT_TEMP:1",
            "PROGRESS:0", "PRINT_JOB:0", "AUTOLEVEL:0", "EMERGENCY_PARSER:1", "HOST_ACTION_COMMANDS:1",
            "PROMPT_SUPPORT:0", "SDCARD:1", "AUTOREPORT_SD_STATUS:1", "LONG_FILENAME:1",
            "THERMAL_PROTECTION:1", "BUSY_PROTOCOL:1", "ARCS:1"})
        say(std::string("Cap:") + capability);
      return Done::kYes;
    }
    case 118:
      say("echo:" + std::string(serial::argument(line.text)));
      return Done::kYes;
    case 155:
      temperature_period_ = seconds(serial::word(line.text, 'S').value_or(0));
      next_temperature_ = now_ + temperature_period_;
      return Done::kYes;
    case 17:
      if (gateway_.state() != MachineState::kOff) return Done::kYes;
      if (const auto begun = gateway_.bring_up(); !begun) return refuse(begun.error().words);
      wait_ = Wait::kBringUp;
      return Done::kWaiting;
    case 18:
    case 84:
      say("echo:the motors go on holding: a platform on vertical rails would fall");
      return Done::kYes;
    case 109:
    case 190:
      if (!mine_ && gateway_.state() != MachineState::kReady) return heat_and_wait(line, number == 190);
      return to_machine(line);
    case 999:
      if (!halted_state(gateway_.state())) {
        halted_ = false;
        return Done::kYes;
      }
      if (const auto cleared = gateway_.clear(); !cleared && gateway_.state() != MachineState::kStopping)
        return refuse(cleared.error().words);
      wait_ = Wait::kClear;
      return Done::kWaiting;
    default:
      break;
  }
  if (gcode::m_group(number) == gcode::MGroup::kUnknown) {
    say("echo:Unknown command: \"" + line.text + "\"");
    return Done::kYes;
  }
  return to_machine(line);
}

/// G-code: to the gateway, opened for lines when they move.
MarlinSession::Done MarlinSession::to_machine(const Line& line) {
  const Code code = serial::code_of(line.text);
  const bool opens = moves(line.text) || code.is('M', 109) || code.is('M', 190);
  if (code.is('G', 28)) dropped_ = false;
  if (!mine_ && opens) {
    if (dropped_)
      return refuse("the print was cancelled at the machine: nothing moves until G28 or a new print (M110)");
    const MachineState state = gateway_.state();
    if (code.is('G', 28) && state != MachineState::kReady) return home(line);
    if (state == MachineState::kOff || state == MachineState::kUnhomed)
      return refuse("home the machine first (G28)");
    // A move of this session's earlier lines, or of another client, is still being finished.
    if (state == MachineState::kMoving || (state == MachineState::kRunning && !file_runs_ &&
                                           !gateway_.lines_open() && gateway_.status().job == options_.name))
      return Done::kWaiting;
    if (const auto opened = gateway_.open_lines(options_.name); !opened) return refuse(opened.error().words);
    mine_ = true;
  }
  return feed(line);
}

MarlinSession::Done MarlinSession::feed(const Line& line) {
  if (mine_ && gateway_.line_room() == 0) return Done::kWaiting;
  if (!mine_ && gateway_.lines_open()) return refuse("another client's lines move the machine");
  if (const auto taken = gateway_.take_line(line.text, ++count_); !taken) return refuse(taken.error().words);
  const Code code = serial::code_of(line.text);
  if (!mine_ || !waits_for_end(code)) return Done::kYes;
  wait_ = Wait::kIdle;
  heats_ = code.is('M', 109) || code.is('M', 190);
  if (heats_) next_temperature_ = now_ + kHeatReport;
  return Done::kWaiting;
}

}  // namespace kinebus
