#pragma once
// What a person at emulated boards sees, and what hands do there, as lines of text in files: a test that sits
// elsewhere answers by what the motors really did.

#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {

/// In the file `seen`, a line for each change, with the boards' time in seconds, from power-up on:
///
///     3.41 motor 0 2 -1640     board 0's motor 2 has turned by so many counts
///     7.02 fan 0 1 on
///     8.20 cable out           of the first board's USB, where it has one; or in
///     9.50 warm 0 hotend 27.3  degrees Celsius, of the block itself
///
/// In the file `do`, which is put there whole (renamed) and goes when it is done, lines of
///
///     press BOARD INPUT high|low MS     the level at the pin while it is pressed, so long
///     heat BOARD sensor 1 generic_3950  another element is plugged in, or any command of heat_plant.hpp
///
/// Boards and inputs count from 0. A line of nonsense is answered in `seen`: "not understood: ...".
class Workbench {
 public:
  /// `folder` is there. Throws std::runtime_error when `seen` cannot be written.
  Workbench(EmulatedMachine& machine, const std::string& folder);
  /// To be called every millisecond or so.
  void look(BusTime now);
  void look_at_cable(BusTime now, bool plugged);

 private:
  struct Held {
    int board = 0, input = 0;
    bool level_after = false;
    BusTime until{0};
  };
  void look_at(BusTime now, int board);
  void note(BusTime now, int board, const char* what, double value);
  void do_what_is_asked(BusTime now);
  void change_heat(BusTime now, const std::string& line);
  void press(BusTime now, const std::string& line);
  void say(BusTime now, const std::string& words);

  struct Close {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };
  EmulatedMachine& machine_;
  std::string asked_;
  std::unique_ptr<std::FILE, Close> seen_;
  std::map<std::string, double> last_;  ///< as it was written last
  std::vector<Held> held_;
  bool plugged_ = false;
  BusTime next_{0};
};

}  // namespace kinebus::emulator
