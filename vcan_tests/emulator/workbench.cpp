#include "vcan_tests/emulator/workbench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "vcan_tests/emulator/ebb_board.hpp"
#include "vcan_tests/emulator/octopus_board.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

constexpr BusTime kLook = 20ms;
// What an eye and a hand notice.
constexpr double kMove_counts = 100, kWarm_k = 0.25;
constexpr int kInputs = 7;
constexpr int kLongestPress_ms = 10'000;

/// nullptr: it heats nothing.
HeatedPlaces* heated_of(Chip& chip) {
  if (auto* const octopus = dynamic_cast<OctopusBoard*>(&chip)) return &octopus->heated();
  if (auto* const ebb = dynamic_cast<EbbBoard*>(&chip)) return &ebb->heated();
  return nullptr;
}

}  // namespace

Workbench::Workbench(EmulatedMachine& machine, const std::string& folder)
    : machine_(machine), asked_(folder + "/do"), seen_(std::fopen((folder + "/seen").c_str(), "w")) {
  if (!seen_) throw std::runtime_error(folder + "/seen cannot be written: expected a folder that is there");
}

void Workbench::look(BusTime now) {
  for (const Held& one : held_)
    if (now >= one.until) machine_.chip(one.board).set_input(one.input, one.level_after);
  std::erase_if(held_, [&](const Held& one) { return now >= one.until; });
  if (now < next_) return;
  next_ = now + kLook;
  for (int board = 0; board < machine_.node_count(); ++board) look_at(now, board);
  do_what_is_asked(now);
  static_cast<void>(std::fflush(seen_.get()));
}

void Workbench::look_at_cable(BusTime now, bool plugged) {
  if (plugged == plugged_) return;
  plugged_ = plugged;
  say(now, plugged ? "cable in" : "cable out");
}

void Workbench::look_at(BusTime now, int board) {
  Chip& chip = machine_.chip(board);
  auto* const octopus = dynamic_cast<OctopusBoard*>(&chip);
  auto* const ebb = dynamic_cast<EbbBoard*>(&chip);
  const int motors = octopus != nullptr ? 8 : ebb != nullptr ? 1 : 2;
  for (int motor = 0; motor < motors; ++motor) {
    const double turned = chip.true_counts(motor) - chip.start_counts(motor);
    double& last = last_.try_emplace(fmt::format("motor {} {}", board, motor), 0).first->second;
    if (std::abs(turned - last) < kMove_counts) continue;
    last = turned;
    say(now, fmt::format("motor {} {} {:.0f}", board, motor, turned));
  }
  const int fans = octopus != nullptr ? 6 : ebb != nullptr ? 2 : 0;
  for (int fan = 0; fan < fans; ++fan) {
    const bool on = octopus != nullptr ? octopus->fan_on(fan) : ebb->fan_on(fan);
    double& last = last_.try_emplace(fmt::format("fan {} {}", board, fan), 0).first->second;
    if (on == (last != 0)) continue;
    last = on ? 1 : 0;
    say(now, fmt::format("fan {} {} {}", board, fan, on ? "on" : "off"));
  }
  HeatedPlaces* const heated = heated_of(chip);
  if (heated != nullptr) note(now, board, "hotend", heated->hot_end().block());
  if (octopus != nullptr) note(now, board, "bed", heated->bed().block());
}

void Workbench::note(BusTime now, int board, const char* what, double value) {
  double& last = last_.try_emplace(fmt::format("warm {} {}", board, what), 0).first->second;
  if (std::abs(value - last) < kWarm_k) return;
  last = value;
  say(now, fmt::format("warm {} {} {:.2f}", board, what, value));
}

void Workbench::do_what_is_asked(BusTime now) {
  std::ifstream in(asked_);
  if (!in) return;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("heat "))
      change_heat(now, line);
    else
      press(now, line);
  std::error_code ignored;
  std::filesystem::remove(asked_, ignored);
}

void Workbench::change_heat(BusTime now, const std::string& line) {
  int board = -1, end = 0;
  const bool understood = std::sscanf(line.c_str(), "heat %d %n", &board, &end) == 1 && board >= 0 &&
                          board < machine_.node_count();
  HeatedPlaces* const heated = understood ? heated_of(machine_.chip(board)) : nullptr;
  if (heated == nullptr)
    return say(now, fmt::format("not understood: {}; expected heat BOARD COMMAND", line.substr(0, 60)));
  const std::string trouble = heated->plant().command(line.substr(static_cast<std::size_t>(end)));
  say(now, trouble.empty() ? line : "not understood: " + trouble);
}

void Workbench::press(BusTime now, const std::string& line) {
  std::istringstream words(line);
  std::string what, level, rest;
  int board = -1, input = -1, ms = 0;
  words >> what >> board >> input >> level >> ms;
  if (!words || words >> rest || what != "press" || board < 0 || board >= machine_.node_count() ||
      input < 0 || input >= kInputs || (level != "high" && level != "low") || ms < 1 || ms > kLongestPress_ms)
    return say(now,
               fmt::format("not understood: {}; expected press BOARD INPUT high|low MS", line.substr(0, 60)));
  const bool high = level == "high";
  machine_.chip(board).set_input(input, high);
  held_.push_back({board, input, !high, now + std::chrono::milliseconds{ms}});
  say(now, fmt::format("pressed {} {}", board, input));
}

void Workbench::say(BusTime now, const std::string& words) {
  fmt::print(seen_.get(), "{:.2f} {}\n", to_seconds(now), words);
}

}  // namespace kinebus::emulator
