// Every fault of heat that the plant knows, in the middle of a print: when it is known, when power is off,
// how hot it gets, what the motion does, and whether the job goes on when it is mended. Prints the table.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "gateway/machine/tests/heat_printer.hpp"
#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kHot = 210, kBed = 50;

/// What breaks, and after how many seconds peers take the power, by their rules and arithmetic on this plant
/// (it cools by 1 K/s at 210 C and warms by 2 K/s of power that nobody asked for). Klipper: 4 readings of 300
/// ms; an error sum of 120 K s beyond 5 K; 2 K in 20 s. RepRapFirmware: more than 15 K away for 5 s; less
/// than 0.6 of the model's rise for 5 s after twice the dead time. Marlin: 4 K away for 40 s; 2 K in 20 s. 0:
/// their rules say no time.
struct Kind {
  const char* name;
  const char* breaks;  ///< of HeatPlant::command(), or of HeatFaults::act()
  const char* mends;
  double known_s, off_s;  ///< the claims
  double klipper_s = 0, reprap_s = 0, marlin_s = 0;
  MachineState motion = MachineState::kHeld;  ///< where it ends
  int heater = 0;                             ///< 1: the bed's
  bool heating = false;                       ///< on the way to the target instead of in the print
};

const std::vector<Kind>& kinds() {
  constexpr auto kHeld = MachineState::kHeld;
  static const std::vector<Kind> all{
      {"sensor open", "sensor 1 open", "sensor 1 ok", 0.5, 0.1, 1.2},
      {"sensor shorted", "sensor 1 short", "sensor 1 ok", 0.5, 0.1, 1.2},
      {"converter silent", "sensor 1 silent", "sensor 1 ok", 0.5, 0.1, 1.2},
      {"converter frozen", "sensor 1 frozen", "sensor 1 ok", 5.5, 5.5},
      {"sensor out of its hole", "sensor 1 loose", "sensor 1 ok", 1, 1, 5.5, 5.4, 40},
      {"heater out of its hole", "heater 1 loose", "heater 1 ok", 5, 5, 20.5, 20, 44},
      {"heater's wire off", "heater 1 open", "heater 1 ok", 5, 5, 20.5, 20, 44},
      {"MOSFET stuck on", "heater 1 stuck", "heater 1 ok", 5, 5, 0, 12.5},
      {"hot end's fan stands", "fan 1 stalled", "fan 1 ok", 4, 4},
      {"sensor open", "sensor 1 open", "sensor 1 ok", 0.5, 0.1, 1.2, 0, 0, kHeld, 0, true},
      {"sensor shorted", "sensor 1 short", "sensor 1 ok", 0.5, 0.1, 1.2, 0, 0, kHeld, 0, true},
      {"converter silent", "sensor 1 silent", "sensor 1 ok", 0.5, 0.1, 1.2, 0, 0, kHeld, 0, true},
      {"converter frozen", "sensor 1 frozen", "sensor 1 ok", 2, 2, 20, 8.2, 20, kHeld, 0, true},
      {"sensor out of its hole", "sensor 1 loose", "sensor 1 ok", 1, 1, 20, 8.2, 20, kHeld, 0, true},
      {"heater out of its hole", "heater 1 loose", "heater 1 ok", 5, 5, 20, 8.2, 20, kHeld, 0, true},
      {"heater's wire off", "heater 1 open", "heater 1 ok", 5, 5, 20, 8.2, 20, kHeld, 0, true},
      {"bed's sensor open", "sensor 2 open", "sensor 2 ok", 0.5, 0.1, 1.2, 0, 0, kHeld, 1},
      {"bed's sensor shorted", "sensor 2 short", "sensor 2 ok", 0.5, 0.1, 1.2, 0, 0, kHeld, 1},
      {"bed's sensor out of its hole", "sensor 2 loose", "sensor 2 ok", 5, 5, 0, 0, 0, kHeld, 1},
      {"heat node without power", "power off", "power on", 2, 0.1, 0, 0, 0, MachineState::kAlarm},
      {"switched off by another one", "stranger", "", 4, 1, 0, 0, 0, kHeld},
      {"emergency stop input", "button", "button out", 0.2, 0.2, 0, 0, 0, MachineState::kStopped},
  };
  return all;
}

struct Found {
  double known_s = -1, off_s = 0, hottest = 0, off_line_mm = 0;
  bool resumed = false;
};

class HeatFaults : public HeatPrinter {
 protected:
  bool node_lives() const { return node_powered; }
  /// Whether the block has power: a switch that is stuck gives it as long as the contactor lets it.
  bool heats(int heater) {
    if (!node_lives()) return false;
    return plant(heater).mosfet_stuck ? rig.nodes.heat_node(kHeat).contactor() : power(heater) > 0;
  }
  heat::ThermalPlant& plant(int heater) {
    heat::HeatPlant& all = rig.nodes.heat_plant(kHeat);
    return heater == 0 ? all.hot_end() : all.bed();
  }
  /// The models that tuning finds for this plant, as 1010h would have kept them.
  void measure() {
    constexpr std::array<std::array<std::uint32_t, 4>, 2> kModels{
        {{3006, 5340, 1423, 1998}, {234, 1527, 7806, 5202}}};
    for (std::uint8_t heater = 0; heater < kModels.size(); ++heater)
      for (std::uint16_t i = 0; i < kModels[heater].size(); ++i) {
        CanFrame write{.id = cob_id::kSdoRequest + kHeatId, .length = 8};
        write.data[0] = 0x23;
        put_u16_le(std::span(write.data).subspan(1), static_cast<std::uint16_t>(0x2218 + i));
        write.data[3] = static_cast<std::uint8_t>(heater + 1);
        put_u32_le(std::span(write.data).subspan(4), kModels[heater][i]);
        rig.stranger_sends(write);
        rig.run_for(20ms);
      }
  }
  void act(const std::string& what) {
    if (what == "power off" || what == "power on") {
      node_powered = what == "power on";
      rig.nodes.set_power(kHeat, rig.now, node_powered);
    } else if (what == "button" || what == "button out") {
      rig.nodes.set_input(2, rig.now, 7, what == "button");
    } else if (what == "stranger") {
      rig.stranger_sends({.id = cob_id::rpdo(1, kHeatId), .length = 8});
    } else if (!what.empty()) {
      EXPECT_EQ(breaks(what), "");
    }
  }
  void run(const Kind& kind, Found& found) {
    rig.run_for(100ms);
    measure();
    const std::string bed_first = kind.heating ? "" : "M140 S50\nM190 S50\n";
    ASSERT_TRUE(begin(bed_first + "M109 S210\nG4 S60\nG1 X70 F120\nG1 X-60 F3000\n")) << rig.story();
    ASSERT_TRUE(rig.run_until(
        [&] { return kind.heating ? plant(0).sensor() > 150 : rig.gateway->status().pose[kX] > 5; }, 900s))
        << rig.story();
    const Pose line = tool();
    const BusTime broken = rig.now;
    const auto since = [&](BusTime when) { return to_seconds(when - broken); };
    rig.events.clear();
    plant(kind.heater).forget_hottest();
    act(kind.breaks);
    BusTime powered = rig.now;
    double last_x = line[kX];
    rig.run_until(
        [&] {
          if (heats(kind.heater)) powered = rig.now;
          if (found.known_s < 0 && rig.told(MachineEvent::Kind::kAlarm)) found.known_s = since(rig.now);
          const Pose pose = tool();
          if (pose[kX] > last_x + 1e-4)
            found.off_line_mm =
                std::max({found.off_line_mm, std::abs(pose[kY] - line[kY]), std::abs(pose[kZ] - line[kZ])});
          last_x = std::max(last_x, pose[kX]);
          return rig.gateway->state() == kind.motion;
        },
        90s);
    EXPECT_EQ(rig.gateway->state(), kind.motion) << rig.story();
    rig.run_until(
        [&] {
          if (heats(kind.heater)) powered = rig.now;
          return false;
        },
        30s);
    found.off_s = since(powered);
    found.hottest = plant(kind.heater).hottest();
    act(kind.mends);
    // A switch that did not open is let in again on a cold block only.
    if (std::string(kind.breaks).find("stuck") != std::string::npos)
      rig.run_until([&] { return plant(kind.heater).block() < 45; }, 3600s);
    rig.run_for(20s);
    if (kind.motion != MachineState::kHeld) {
      ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
    }
    rig.run_for(2s);
    ASSERT_TRUE(rig.gateway->carry_out(command::Resume{})) << rig.story();
    rig.run_until(
        [&] {
          const Pose pose = tool();
          // On the line again and on its way.
          if (pose[kX] > last_x + 0.5)
            found.off_line_mm =
                std::max({found.off_line_mm, std::abs(pose[kY] - line[kY]), std::abs(pose[kZ] - line[kZ])});
          return rig.gateway->state() == MachineState::kReady;
        },
        900s);
    found.resumed = rig.gateway->state() == MachineState::kReady && std::abs(tool()[kX] + 60) < kOnTheLine &&
                    std::abs(hotend() - kHot) < 5;
    EXPECT_TRUE(found.resumed) << rig.story();
  }

  bool node_powered = true;
};

class EveryFaultOfHeat : public HeatFaults, public testing::WithParamInterface<std::size_t> {};

std::string seconds_of(double s) {
  char text[16];
  if (s <= 0) return "-";
  std::snprintf(text, sizeof text, "%.2f", s);
  return text;
}

TEST_P(EveryFaultOfHeat, TakesThePowerBeforeAnyPeerAndTheJobGoesOn) {
  const Kind& kind = kinds()[GetParam()];
  Found found;
  run(kind, found);
  if (GetParam() == 0)
    std::printf("%-28s %-8s %9s %7s %8s %9s %-8s %8s   %8s %8s %8s\n", "fault", "in", "known, s", "off, s",
                "hottest", "path, um", "motion", "resumed", "Klipper", "RRF", "Marlin");
  std::printf("%-28s %-8s %9s %7s %8.1f %9.2f %-8s %8s   %8s %8s %8s\n", kind.name,
              kind.heating ? "heating" : "print", seconds_of(found.known_s).c_str(),
              seconds_of(found.off_s).c_str(), found.hottest, 1000 * found.off_line_mm,
              std::string(to_string(kind.motion)).c_str(), found.resumed ? "yes" : "no",
              seconds_of(kind.klipper_s).c_str(), seconds_of(kind.reprap_s).c_str(),
              seconds_of(kind.marlin_s).c_str());
  EXPECT_GE(found.known_s, 0);
  EXPECT_LE(found.known_s, kind.known_s);
  EXPECT_LE(found.off_s, kind.off_s);
  EXPECT_LE(found.off_line_mm, kOnTheLine);
  EXPECT_LE(found.hottest, (kind.heater == 0 ? kHot : kBed) + 20);
  for (const double peer_s : {kind.klipper_s, kind.reprap_s, kind.marlin_s})
    EXPECT_TRUE(peer_s == 0 || found.off_s < peer_s) << peer_s;
}

INSTANTIATE_TEST_SUITE_P(Campaign, EveryFaultOfHeat, testing::Range<std::size_t>(0, kinds().size()));

}  // namespace
}  // namespace kinebus
