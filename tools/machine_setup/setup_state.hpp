#pragma once
// What the steps of a set-up share: the way to bus and person, the answers so far, the machine as it is known
// by now.

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/machine_setup/dialogue.hpp"
#include "tools/machine_setup/first_machine.hpp"
#include "tools/machine_setup/setup_answers.hpp"
#include "tools/machine_setup/usb_boards.hpp"
#include "tools/node_id/node_ids.hpp"

namespace kinebus {

/// The answer to a test that was passed over; asked for again the next time.
inline constexpr const char* kSkipped = "skipped";

/// The world around a set-up.
struct SetupHost {
  BusAccess bus;
  Dialogue::Io io;
  /// Somebody wants to end it: asked while something has power.
  std::function<bool()> interrupted;
  /// Writes the program into these nodes; `other_kind`: whatever kind of node each was before. False: it was
  /// told why not.
  std::function<bool(const std::string& image, const std::vector<std::uint8_t>& nodes, bool other_kind)>
      flash;
  std::function<UsbBoards()> usb;
  std::filesystem::path programs{};  ///< a folder that may have their images
};

struct SetupState {
  SetupHost& host;
  Dialogue& dialogue;
  SetupAnswers& answers;
  std::filesystem::path file;
  FirstMachine first{};
  MachineDescription machine{};
  std::map<std::uint8_t, std::uint32_t> serials{};  ///< of the nodes that were found, by id

  /// The machine as it is known now, in its file. Throws std::runtime_error when it cannot be written.
  void save() const;
  /// The step was done with this joint or device already ("motor.tower1"). Says so.
  bool done(const std::string& key, const std::string& what) const;
  /// An answer that is kept: asked for once, and shown afterwards.
  std::size_t kept_choice(const std::string& key, std::string_view question,
                          std::span<const SetupChoice> choices, std::optional<std::size_t> usual = {});
  bool kept_yes(const std::string& key, std::string_view question, bool usual);
  /// "MOTOR3 of the Octopus (node 2, axis B)"
  std::string connector_of(const JointDescription& joint) const;
};

// The steps, in their order. All may throw SetupInterrupted and CardError; whatever they gave power to is off
// when they end, in whatever way.
void ask_for_sensors(SetupState& state);
void give_ids(SetupState& state);
void offer_programs(SetupState& state);
void test_motors(SetupState& state);
void test_switches(SetupState& state);
void test_sensors(SetupState& state);
void test_heat(SetupState& state);

}  // namespace kinebus
